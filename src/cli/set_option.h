// The option --set KEY.PATH=VALUE ... of several commands.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vibratory_alignment {

/// `description` is for the help.
void add_set_option(CLI::App& app, std::vector<std::string>& settings, const std::string& description);

/// The words of a call with a --set of its own before each KEY.PATH=VALUE that follows another one: parsed so, the
/// first word that is no such setting can be a SCENE.
std::vector<std::string> with_set_before_each(const std::vector<std::string>& words);

}  // namespace vibratory_alignment
