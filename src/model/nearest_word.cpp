#include "model/nearest_word.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace vibratory_alignment {
namespace {

/// Longer ones are no names, and would take long.
constexpr std::size_t kLongestName = 60;

/// Insertions, deletions, replacements of one character and swaps of two neighbours that turn a into b, each character
/// being changed once (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  // distances of the beginnings of b from the beginning of a with i characters, and with one and two fewer
  std::vector<std::size_t> row(b.size() + 1), above(b.size() + 1), two_above(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), above[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::string> nearest_word(const std::string& mistyped, const std::vector<std::string>& words) {
  if (mistyped.size() > kLongestName) return std::nullopt;
  std::optional<std::string> best;
  std::size_t least = 1 + std::max<std::size_t>(1, mistyped.size() / 3);
  for (const std::string& word : words) {
    const std::size_t distance = edit_distance(mistyped, word);
    if (distance >= least) continue;
    least = distance;
    best = word;
  }
  return best;
}

std::string did_you_mean(const std::string& mistyped, const std::vector<std::string>& words) {
  const std::optional<std::string> meant = nearest_word(mistyped, words);
  return meant ? ", did you mean " + *meant + "?" : "";
}

}  // namespace vibratory_alignment
