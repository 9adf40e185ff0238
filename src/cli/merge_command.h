// `align merge`: the files of a study's shards become the file of the whole study.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

/// Adds the options of `align merge` to `app`. The returned function runs it; see errors.h for how it ends.
std::function<int()> set_up_merge(CLI::App& app);

}  // namespace vibratory_alignment
