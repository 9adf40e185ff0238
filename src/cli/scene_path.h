// Finds the scene that is named on the command line.
#pragma once

#include <string>
#include <vector>

namespace vibratory_alignment {

/// The file that `argument` names: a path to an existing file, or the name of a scene that comes with the package
/// ("fig2", "hard/grazing", with or without ".yaml"). Throws UsageError, with the names there are, if it is neither.
std::string find_scene(const std::string& argument);

/// Names of the scenes that come with the package, sorted; empty when its config/scenes cannot be found.
std::vector<std::string> shipped_scenes();

}  // namespace vibratory_alignment
