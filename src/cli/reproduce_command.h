// `align reproduce`: the paper's figures and the ledger of its facts.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vibratory_alignment {

/// Adds the options of `align reproduce` to `app`. The returned function runs it; see errors.h for how it ends.
std::function<int()> set_up_reproduce(CLI::App& app);

}  // namespace vibratory_alignment
