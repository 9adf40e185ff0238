// Finds the scene, study or facts file that is named on the command line.
#pragma once

#include <string>

namespace vibratory_alignment {

/// The file that `argument` names: a path to an existing file, or the name of a scene that comes with the package
/// ("fig2", "hard/grazing", with or without ".yaml"). Throws UsageError, with the names there are, if it is neither.
std::string find_scene(const std::string& argument);

/// The same for a study, in config/studies.
std::string find_study(const std::string& argument);

/// The same for a facts file, in config/paper.
std::string find_facts(const std::string& argument);

}  // namespace vibratory_alignment
