// cos and sin of the tilt against those of the library in extended precision.
#include "mechanics/tilt.h"

#include <gtest/gtest.h>

#include <limits>

namespace vibratory_alignment {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

TEST(Tilt, is_good_to_the_last_digits_at_any_angle) {
  for (int i = 0; i <= 200'000; ++i) {
    const double phi = i * 1e-5 * (i % 3 == 0 ? 1.0 : 0.37) * (i > 190'000 ? 5.0 : 1.0);
    const Tilt tilt = tilt_of(phi);
    const long double cos = std::cos(static_cast<long double>(phi)), sin = std::sin(static_cast<long double>(phi));
    ASSERT_LE(std::abs(tilt.cos - cos), kEpsilon) << phi;
    // of a small angle the sine keeps the angle's own digits
    ASSERT_LE(std::abs(tilt.sin - sin), kEpsilon * std::abs(sin)) << phi;
  }
}

TEST(Tilt, is_even_and_odd_to_the_last_bit_and_exact_when_upright) {
  EXPECT_EQ(tilt_of(0.0).cos, 1.0);
  EXPECT_EQ(tilt_of(0.0).sin, 0.0);
  for (const double phi : {1e-300, 1e-9, 0.1, kSmallTilt, std::nextafter(kSmallTilt, 1.0), 1.0, 3.0}) {
    EXPECT_EQ(tilt_of(-phi).cos, tilt_of(phi).cos) << phi;
    EXPECT_EQ(tilt_of(-phi).sin, -tilt_of(phi).sin) << phi;
  }
}

TEST(Tilt, of_what_is_not_a_number_is_none) {
  EXPECT_TRUE(std::isnan(tilt_of(std::numeric_limits<double>::quiet_NaN()).cos));
  EXPECT_TRUE(std::isnan(tilt_of(std::numeric_limits<double>::infinity()).sin));
}

}  // namespace
}  // namespace vibratory_alignment
