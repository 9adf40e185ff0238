// Rough logarithms and powers of two against the exact ones.
#include "mechanics/rough_log2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibratory_alignment {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// log2(1 + m) - m, of the digits after the leading one, is between 0 and 0.0861.
TEST(RoughLog2, is_too_small_by_a_tenth_at_most) {
  for (double exponent = -1020.0; exponent < 1023.0; exponent += 0.37) {
    const double missed = exponent - rough_log2(std::exp2(exponent));
    EXPECT_GE(missed, -1e-12) << exponent;
    EXPECT_LE(missed, 0.0861) << exponent;
  }
  EXPECT_EQ(rough_log2(0.0), -1023.0);
}

TEST(RoughLog2, powers_are_good_to_a_third_of_a_percent) {
  for (double exponent = -1022.0; exponent < 1024.0; exponent += 0.37)
    EXPECT_NEAR(rough_exp2(exponent) / std::exp2(exponent), 1.0, 3.3e-3) << exponent;
  for (const double exponent : {-1022.0, -3.0, 0.0, 1.0, 1023.0})
    EXPECT_EQ(rough_exp2(exponent), std::exp2(exponent)) << exponent;
}

TEST(RoughLog2, powers_beyond_all_numbers_are_infinite_or_tiny) {
  EXPECT_EQ(rough_exp2(1024.0), kInfinity);
  EXPECT_EQ(rough_exp2(kInfinity), kInfinity);
  for (const double exponent : {-1022.5, -1e300, -kInfinity}) EXPECT_EQ(rough_exp2(exponent), 0x1p-1022) << exponent;
  EXPECT_TRUE(std::isnan(rough_exp2(std::nan(""))));
}

}  // namespace
}  // namespace vibratory_alignment
