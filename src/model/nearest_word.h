// What a misspelt name may have been meant for.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vibratory_alignment {

/// The word that a mistyped one most likely stands for: the first of those that the fewest insertions, deletions and
/// replacements of one character make of it, at most one, or a third of its length. None if no word is so near, nor for
/// more than 60 bytes.
std::optional<std::string> nearest_word(const std::string& mistyped, const std::vector<std::string>& words);

}  // namespace vibratory_alignment
