#include "model/nearest_word.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace vibratory_alignment {
namespace {

/// Longer ones are no names, and would take long.
constexpr std::size_t kLongestName = 60;

/// Levenshtein distance: insertions, deletions and replacements of one character that turn a into b.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
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

}  // namespace vibratory_alignment
