// `align calibrate`: searches for the values that the paper leaves out.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

/// Declares the options of the subcommand; the function that is returned runs it and gives the exit status.
std::function<int()> set_up_calibrate(CLI::App& app);

}  // namespace vibratory_alignment
