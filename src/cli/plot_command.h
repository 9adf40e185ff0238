// `align plot`: draws a recorded trial as the paper draws its Fig. 2.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

/// Adds the options of `align plot` to `app`. The returned function draws; see errors.h for how it ends.
std::function<int()> set_up_plot(CLI::App& app);

}  // namespace vibratory_alignment
