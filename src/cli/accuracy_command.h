// `align accuracy`: what accuracy costs in time, for every solver, on one scene.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

/// Adds the options of `align accuracy` to `app`. The returned function runs the study; see errors.h for how it ends.
std::function<int()> set_up_accuracy(CLI::App& app);

}  // namespace vibratory_alignment
