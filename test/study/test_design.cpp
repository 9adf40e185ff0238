// The values of a study's trials: a function of the index, every point of the grid once, samples that fill the ranges.
#include "study/design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "study/scramble.h"
#include "study_text.h"

namespace vibratory_alignment {
namespace {

using test::study_of;

std::vector<double> numbers(const Study& study, std::size_t index) {
  std::vector<double> result;
  for (const VariedValue& value : values_at(study, index)) result.push_back(value.number);
  return result;
}

TEST(Grid, FirstDimensionChangesSlowest) {
  const Study study = study_of("vary: [{initial.x: [0.2, 0.3]}, {friction.coefficient: [0.1, 0.2, 0.3]}]");
  ASSERT_EQ(trial_count(study), 6u);
  EXPECT_EQ(varied_names(study), (std::vector<std::string>{"initial.x", "friction.coefficient"}));
  const double expected[6][2] = {{0.2, 0.1}, {0.2, 0.2}, {0.2, 0.3}, {0.3, 0.1}, {0.3, 0.2}, {0.3, 0.3}};
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(numbers(study, i), (std::vector<double>{expected[i][0], expected[i][1]}));
}

TEST(Grid, KeysOfOneEntryChangeTogether) {
  const Study study = study_of(
      "vary:\n  - {initial.x: [0.2, 0.3, 0.4], gripper.pressing_force: {from: 0.1, to: 0.5, count: 3}}\n"
      "  - trial.time_limit: [1, 2]");
  ASSERT_EQ(trial_count(study), 6u);
  EXPECT_EQ(numbers(study, 3), (std::vector<double>{0.3, 0.3, 2.0}));
  EXPECT_EQ(numbers(study, 4), (std::vector<double>{0.4, 0.5, 1.0}));
}

TEST(Grid, StepsAreEqualEndsExactAndDecimalsShort) {
  const Study study = study_of("vary: {gripper.pressing_force: {from: 0.1, to: 0.8, count: 15}}");
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_NEAR(numbers(study, i)[0], 0.1 + 0.05 * static_cast<double>(i), 1e-15);
    EXPECT_LE(values_at(study, i)[0].text.size(), 4u) << values_at(study, i)[0].text;
  }
  const Study odd = study_of("vary: {initial.x: {from: 0.12345678901234567, to: 0.2345678901234567, count: 4}}");
  EXPECT_EQ(numbers(odd, 0)[0], 0.12345678901234567);
  EXPECT_EQ(numbers(odd, 3)[0], 0.2345678901234567);
}

TEST(Grid, LogarithmicStepsHaveEqualRatios) {
  const Study study = study_of("vary: {base.stiffness.y: {from: 1.0e3, to: 1.0e9, count: 7, spacing: log}}");
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_NEAR(numbers(study, i)[0] / std::pow(10.0, 3.0 + static_cast<double>(i)), 1.0, 1e-14);
}

TEST(Grid, TextGivesBackTheNumber) {
  const Study study = study_of(
      "vary: [{initial.x: {from: 0.1, to: 0.7, count: 7}}, {initial.phi: {from: 0, to: 0.1}}]\nsamples: {count: 9}");
  for (std::size_t i = 0; i < trial_count(study); ++i)
    for (const VariedValue& value : values_at(study, i)) EXPECT_EQ(std::stod(value.text), value.number);
}

TEST(Grid, WordsListsMapsAndNullAreValuesToo) {
  const Study study = study_of(
      "vary: [{solver.name: [event, implicit]}, {contacts: [[edges], [edges, corners]]},"
      " {friction: [null, {coefficient: 0.1}]}]");
  // lists and maps of several lines come to one as well
  const Study lines =
      study_of("vary:\n  - contacts:\n    - - edges\n      - corners\n  - friction:\n    -\n      coefficient: 0.3\n");
  EXPECT_EQ(values_at(lines, 0)[0].text, "[edges, corners]");
  EXPECT_EQ(values_at(lines, 0)[1].text, "{coefficient: 0.3}");
  EXPECT_EQ(values_at(study_of("vary: {name: [short, \"of two\\nlines\"]}"), 1)[0].text.find('\n'), std::string::npos);
  const std::vector<VariedValue> last = values_at(study, 7);
  EXPECT_EQ(last[0].text, "implicit");
  EXPECT_EQ(YAML::Load(last[1].text)[1].Scalar(), "corners");
  EXPECT_EQ(YAML::Load(last[2].text)["coefficient"].Scalar(), "0.1");
  EXPECT_EQ(values_at(study, 0)[2].text, "null");
  for (const VariedValue& value : last) {
    EXPECT_TRUE(std::isnan(value.number));
    EXPECT_EQ(value.text.find('\n'), std::string::npos);
  }
}

TEST(Samples, AreTheSameAtEveryPointOfTheGrid) {
  const Study study = study_of(
      "vary: [{gripper.pressing_force: [0.1, 0.2]}, {excitation.phase: {from: 0, to: 6}}, {initial.x: {from: -1, to: "
      "1, as: offset}}]\n"
      "samples: {count: 5, seed: 3}");
  ASSERT_EQ(trial_count(study), 10u);
  EXPECT_EQ(varied_names(study)[2], "initial.x offset");
  for (std::size_t i = 0; i < 5; ++i) {
    const std::vector<double> a = numbers(study, i), b = numbers(study, i + 5);
    EXPECT_EQ(a[0], 0.1);
    EXPECT_EQ(b[0], 0.2);
    EXPECT_EQ(a[1], b[1]);
    EXPECT_EQ(a[2], b[2]);
    EXPECT_NE(a[1] / 6.0, (a[2] + 1.0) / 2.0);
  }
}

TEST(Samples, KeysOfOneEntryShareTheirCoordinate) {
  const Study study = study_of(
      "vary: [{initial.x: {from: 0.2, to: 0.4}, gripper.anchor.x: {from: 1, to: 3}}]\nsamples: {count: 7, method: "
      "random}");
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_NEAR((numbers(study, i)[0] - 0.2) / 0.2, (numbers(study, i)[1] - 1.0) / 2.0, 1e-14);
}

TEST(Samples, LogarithmicOnesLieEvenlyInTheLogarithm) {
  const Study study =
      study_of("vary: {base.stiffness.y: {from: 1.0e2, to: 1.0e10, spacing: log}}\nsamples: {count: 256}");
  std::set<int> parts;
  for (std::size_t i = 0; i < 256; ++i) parts.insert(static_cast<int>(32.0 * (std::log10(numbers(study, i)[0]) - 2.0)));
  EXPECT_EQ(parts.size(), 256u);
}

// What makes a digital net: 2^m points, one in each of 2^m equal parts of every coordinate...
TEST(Sobol, EveryCoordinateIsFilledEvenly) {
  for (const std::uint64_t seed : {0u, 1u, 77u})
    for (std::size_t coordinate = 0; coordinate < 12; ++coordinate)
      for (const std::size_t count : {std::size_t{16}, std::size_t{1024}}) {
        std::set<int> parts;
        for (std::size_t i = 0; i < count; ++i)
          parts.insert(
              static_cast<int>(static_cast<double>(count) * unit_sample(SampleMethod::sobol, seed, 12, i)[coordinate]));
        EXPECT_EQ(parts.size(), count) << "seed " << seed << ", coordinate " << coordinate;
      }
}

// ... and, for its first two coordinates, one in each of the 2^m rectangles of every shape 2^-j by 2^(j-m).
TEST(Sobol, FirstTwoCoordinatesFillEveryRectangle) {
  for (int m = 2; m <= 8; ++m)
    for (int j = 0; j <= m; ++j) {
      std::set<int> cells;
      for (std::size_t i = 0; i < (std::size_t{1} << m); ++i) {
        const std::vector<double> u = unit_sample(SampleMethod::sobol, 5, 2, i);
        cells.insert((static_cast<int>(std::ldexp(u[0], j)) << (m - j)) + static_cast<int>(std::ldexp(u[1], m - j)));
      }
      EXPECT_EQ(cells.size(), std::size_t{1} << m) << m << ' ' << j;
    }
}

// Published points of the sequence (Joe and Kuo): unshifted, in Gray-code order 0, 1/2, 3/4, 1/4, 3/8, ... The shift is
// an exclusive or, so differences from point 0 stay.
TEST(Sobol, IsTheSequenceOfSobol) {
  const double expected[6][3] = {{0, 0, 0},          {0.5, 0.5, 0.5},       {0.75, 0.25, 0.25},
                                 {0.25, 0.75, 0.75}, {0.375, 0.375, 0.625}, {0.875, 0.875, 0.125}};
  const auto bits = [](double u) { return static_cast<std::uint64_t>(std::ldexp(u, 53)); };
  const std::vector<double> origin = unit_sample(SampleMethod::sobol, 9, 3, 0);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(bits(unit_sample(SampleMethod::sobol, 9, 3, i)[c]) ^ bits(origin[c]), bits(expected[i][c]))
          << i << ' ' << c;
}

TEST(Sobol, SeedsShiftTheSequence) {
  EXPECT_NE(unit_sample(SampleMethod::sobol, 1, 2, 0), unit_sample(SampleMethod::sobol, 2, 2, 0));
  EXPECT_NE(unit_sample(SampleMethod::sobol, 1, 2, 0)[0], unit_sample(SampleMethod::sobol, 1, 2, 0)[1]);
}

// The seconds that a walk to such an index would take are days.
TEST(Sobol, StartsAnywhereAtOnce) {
  const std::size_t far = 900'000'000'000'000;
  const std::vector<double> u = unit_sample(SampleMethod::sobol, 1, 3, far);
  std::set<int> parts;
  const std::size_t block = far / 64 * 64;
  for (std::size_t i = 0; i < 64; ++i)
    parts.insert(static_cast<int>(64.0 * unit_sample(SampleMethod::sobol, 1, 3, block + i)[2]));
  EXPECT_EQ(parts.size(), 64u);
  EXPECT_GE(u[0], 0.0);
}

// splitmix64 with seed 0, as its authors' code gives it.
TEST(Random, ScrambleIsThatOfSplitmix64) {
  EXPECT_EQ(scrambled(1 * kSplitmixStride), 0xE220A8397B1DCDAFu);
  EXPECT_EQ(scrambled(2 * kSplitmixStride), 0x6E789E6AA1B965F4u);
  EXPECT_EQ(scrambled(3 * kSplitmixStride), 0x06C45D188009454Fu);
  EXPECT_EQ(unit_number(~std::uint64_t{0}), 1.0 - std::ldexp(1.0, -53));
}

// Means, and correlations of neighbours in index, coordinate and seed, within five standard deviations.
TEST(Random, NumbersAreIndependentAndEven) {
  constexpr std::size_t count = 20000;
  const auto at = [](std::uint64_t seed, std::size_t i, std::size_t c) {
    return unit_sample(SampleMethod::random, seed, 2, i)[c] - 0.5;
  };
  double mean = 0, square = 0, next = 0, other = 0, seeds = 0;
  for (std::size_t i = 0; i < count; ++i) {
    mean += at(1, i, 0);
    square += at(1, i, 0) * at(1, i, 0);
    next += at(1, i, 0) * at(1, i + 1, 0);
    other += at(1, i, 0) * at(1, i, 1);
    seeds += at(1, i, 0) * at(2, i, 0);
  }
  const double n = count, five = 5.0 / std::sqrt(n);
  EXPECT_NEAR(mean / n, 0.0, five * std::sqrt(1.0 / 12.0));
  EXPECT_NEAR(square / n, 1.0 / 12.0, five * std::sqrt(1.0 / 180.0));
  for (const double correlation : {next, other, seeds}) EXPECT_NEAR(correlation / n, 0.0, five / 12.0);
}

}  // namespace
}  // namespace vibratory_alignment
