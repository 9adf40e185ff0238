// `align trial`: one trial from a scene file to a report, a CSV file and a bag.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

/// Adds the options of `align trial` to `app`. The returned function runs the trial; see errors.h for how it ends.
std::function<int()> set_up_trial(CLI::App& app);

}  // namespace vibratory_alignment
