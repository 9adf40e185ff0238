#include "solver/bernstein.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace vibratory_alignment {
namespace {

using Numbers = decltype(BernsteinForm::b);

constexpr std::size_t kRows = kMaxOrder + 1;
using Table = std::array<std::array<double, kRows>, kRows>;

/// 1/C(n, k).
constexpr Table kInverseBinomial = [] {
  Table table{}, binomial{};
  for (std::size_t n = 0; n < kRows; ++n)
    for (std::size_t k = 0; k <= n; ++k) {
      binomial[n][k] = k == 0 || k == n ? 1.0 : binomial[n - 1][k - 1] + binomial[n - 1][k];
      table[n][k] = 1.0 / binomial[n][k];
    }
  return table;
}();

/// Numbers in blocks of four, of which every one becomes itself and the next one, times a factor, again and again:
/// after j turns the first n - j + 1 of n + 1 count. Blocks of a number that is known beforehand stay in registers: to
/// read from memory what has just been written across two blocks would take longer than the sums.
template <int kBlocks>
struct Neighbours {
  Quad block[kBlocks];

  VIBRATORY_ALIGNMENT_INLINE explicit Neighbours(const Numbers& numbers) {
    std::memcpy(block, numbers.data(), sizeof block);
  }

  /// Calls `row`(j, the block of the last number that counts) for j = 0 ... n; the first number that counts is
  /// block[0][0].
  template <typename Row>
  VIBRATORY_ALIGNMENT_INLINE void sum(int n, double factor, const Row& row) {
    int j = 0;
#pragma GCC unroll 12
    for (int last = kBlocks - 1; last >= 0; --last)
      for (; n - j >= 4 * last && j <= n; ++j) {
        row(j, block[last]);
#pragma GCC unroll 12
        for (int i = 0; i <= last; ++i) {
          const Quad after = i + 1 < kBlocks ? block[i + 1 < kBlocks ? i + 1 : i] : Quad{};
          const Quad next = __builtin_shuffle(block[i], after, QuadMask{1, 2, 3, 4});
          block[i] = factor * (block[i] + next);
        }
      }
  }
};

/// The coefficients of `form` from these differences at its start.
template <int kBlocks>
VIBRATORY_ALIGNMENT_INLINE void sum_differences(const Numbers& differences, BernsteinForm& form) {
  Neighbours<kBlocks> sums(differences);
  sums.sum(form.degree, 1.0,
           [&](int j, const Quad&) VIBRATORY_ALIGNMENT_INLINE_LAMBDA { form.b[j] = sums.block[0][0]; });
}

template <int kBlocks>
VIBRATORY_ALIGNMENT_INLINE void halve_blocks(const BernsteinForm& whole, BernsteinForm& left, BernsteinForm& right) {
  const int n = whole.degree;
  Quad ends[4 * kBlocks];
  Neighbours<kBlocks> means(whole.b);
  means.sum(n, 0.5, [&](int j, const Quad& last) VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    left.b[j] = means.block[0][0];
    ends[j] = last;
  });
  for (int j = 0; j <= n; ++j) right.b[j] = ends[n - j][j % 4];
}

/// Calls `body`(std::integral_constant) with the number of blocks of n + 1 numbers.
template <typename Body, int... kCounts>
VIBRATORY_ALIGNMENT_INLINE void with_blocks(int n, const Body& body, std::integer_sequence<int, kCounts...>) {
  const int blocks = n / 4;
  ((blocks == kCounts ? body(std::integral_constant<int, kCounts + 1>{}) : void()), ...);
}

constexpr int kMostBlocks = kMaxOrder / 4 + 1;

}  // namespace

/// With c_k = g_k/C(n, k), b_j = sum C(j, k) c_k: c are the differences of b at its start, from which sums make b.
void set_bernstein(const Series& g, int order, BernsteinForm& form) {
  form.degree = order;
  Numbers c;
  const auto& inverse = kInverseBinomial[static_cast<std::size_t>(order)];
  for (int k = 0; k <= order; ++k) c[k] = g[k] * inverse[k];
  std::fill(c.begin() + order + 1, c.begin() + order / 4 * 4 + 4, 0.0);
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    with_blocks(
        order, [&](auto blocks) VIBRATORY_ALIGNMENT_INLINE_LAMBDA { sum_differences<blocks>(c, form); },
        std::make_integer_sequence<int, kMostBlocks>());
  });
}

Range range_of(const BernsteinForm& form) {
  const auto [low, high] = std::minmax_element(form.b.begin(), form.b.begin() + form.degree + 1);
  return {*low, *high};
}

int sign_changes(const BernsteinForm& form) {
  std::uint64_t negative = 0, zero = 0;
  for (int j = 0; j <= form.degree; ++j) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &form.b[j], sizeof bits);
    negative |= (bits >> 63) << j;
    zero |= std::uint64_t{form.b[j] == 0.0} << j;
  }
  // those at the start count for nothing, others have the sign of what is before them
  int count = form.degree + 1;
  for (; (zero & 1) != 0; zero >>= 1, --count) negative >>= 1;
  for (; zero != 0; zero &= zero - 1) {
    const std::uint64_t it = zero & -zero;
    negative = (negative & ~it) | ((negative << 1) & it);
  }
  // where the sign of one and the next one differ: mostly nowhere, or once
  const std::uint64_t changes = count > 0 ? (negative ^ (negative >> 1)) & ((std::uint64_t{1} << (count - 1)) - 1) : 0;
  if ((changes & (changes - 1)) == 0) return changes == 0 ? 0 : 1;
  return __builtin_popcountll(changes);
}

double zero_of_coefficients(const BernsteinForm& form) {
  double before = 0.0;
  int last = 0;  // the last one that is not zero
  for (int j = 0; j <= form.degree; ++j) {
    const double b = form.b[j];
    if ((b < 0.0 && before > 0.0) || (b > 0.0 && before < 0.0))
      return (last + (j - last) * before / (before - b)) / form.degree;
    if (b == 0.0) continue;
    before = b;
    last = j;
  }
  return 1.0;
}

void halve(const BernsteinForm& whole, BernsteinForm& left, BernsteinForm& right) {
  left.degree = right.degree = whole.degree;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    with_blocks(
        whole.degree, [&](auto blocks) VIBRATORY_ALIGNMENT_INLINE_LAMBDA { halve_blocks<blocks>(whole, left, right); },
        std::make_integer_sequence<int, kMostBlocks>());
  });
}

}  // namespace vibratory_alignment
