// `align sweep`: the trials of a study, to a table in a CSV file and a summary.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

/// Adds the options to `app`. The returned function runs the command; see errors.h for how it ends.
std::function<int()> set_up_sweep(CLI::App& app);

}  // namespace vibratory_alignment
