// What a misspelt name may have been meant for.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vibratory_alignment {

/// The word that a mistyped one most likely stands for: the first of those that the fewest insertions, deletions,
/// replacements of one character and swaps of two neighbours make of it, at most one, or a third of its length. None if
/// no word is so near, nor for more than 60 bytes.
std::optional<std::string> nearest_word(const std::string& mistyped, const std::vector<std::string>& words);

/// That word, as the end of a message: ", did you mean WORD?". Empty if there is none.
std::string did_you_mean(const std::string& mistyped, const std::vector<std::string>& words);

}  // namespace vibratory_alignment
