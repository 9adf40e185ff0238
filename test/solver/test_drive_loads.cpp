// The loads of excitations within steps, against their waveforms written down once more; kinks fall where they may.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/numbers.h"
#include "solver/drive_loads.h"

namespace vibratory_alignment {
namespace {

using test::kPi;

double waveform(const Excitation& e, double t) {
  const double theta = std::fmod(e.frequency * t + e.phase, 2.0 * kPi);
  switch (e.waveform) {
    case Waveform::sine: return std::sin(theta);
    case Waveform::square: return theta < kPi ? 1.0 : -1.0;
    case Waveform::triangle: return 2.0 / kPi * std::asin(std::sin(theta));
    case Waveform::chirp: {
      const double rate = (e.end_frequency - e.frequency) / e.sweep_time, s = std::min(t, e.sweep_time);
      return std::sin(e.phase + e.frequency * s + 0.5 * rate * s * s + e.end_frequency * (t - s));
    }
  }
  return 0.0;
}

std::vector<Excitation> some() {
  Excitation sine, square, triangle, chirp;
  sine.amplitude = 0.7;
  sine.frequency = 11.0;
  sine.phase = 0.4;
  square = triangle = chirp = sine;
  square.waveform = Waveform::square;
  triangle.waveform = Waveform::triangle;
  triangle.direction = Direction::x;
  chirp.waveform = Waveform::chirp;
  chirp.direction = Direction::phi;
  chirp.end_frequency = 3.0;
  chirp.sweep_time = 0.7;
  return {sine, square, triangle, chirp};
}

TEST(DriveLoads, are_those_of_the_waveforms_whatever_the_step) {
  const std::vector<Excitation> e = some();
  for (const double h : {0.003, 0.0137, 0.1, 0.37, 0.71, 1.3}) {  // up to two periods and more
    DriveLoads loads(e, {});
    Instant now;
    for (int n = 0; n * h < 3.0; ++n) {
      loads.begin_step(now);
      for (const double share : {0.0, 0.21, 0.5, 0.83, 1.0}) {
        const double t = now.value() + share * h;
        const Load3 load = loads.at(share * h);
        const double square = std::abs(std::sin(11.0 * t + 0.4)) < 1e-9 ? 0.7 : 1e-12;  // either side of a jump
        EXPECT_NEAR(load.y, 0.7 * (waveform(e[0], t) + waveform(e[1], t)), 2.0 * square) << t;
        EXPECT_NEAR(load.x, 0.7 * waveform(e[2], t), 1e-12) << t;
        EXPECT_NEAR(load.phi, 0.7 * waveform(e[3], t), 1e-12) << t;
      }
      loads.pass(h);
      now = now + h;
    }
  }
}

TEST(DriveLoads, tell_of_kinks) {
  std::vector<Excitation> e = {some()[1]};
  e[0].phase = 0.0;
  e[0].frequency = kPi;  // jumps at 1, 2, 3 ...
  DriveLoads loads(e, {});
  loads.begin_step({});
  EXPECT_FALSE(loads.has_kink(0.9));
  EXPECT_TRUE(loads.has_kink(1.1));
  loads.pass(1.1);
  loads.begin_step({1.1, 0.0});
  EXPECT_EQ(loads.at(0.0).y, -0.7);
  EXPECT_FALSE(loads.has_kink(0.8));
  EXPECT_EQ(loads.at(0.95).y, 0.7);
}

TEST(DriveLoads, keep_the_phase_through_a_change) {
  std::vector<Excitation> e = {some()[0]};
  DriveLoads loads(e, {});
  loads.begin_step({});
  loads.pass(0.3);
  e[0].frequency = 5.0;
  loads.change(e, {0.3, 0.0});
  loads.begin_step({0.3, 0.0});
  EXPECT_NEAR(loads.at(0.2).y, 0.7 * std::sin(0.4 + 11.0 * 0.3 + 5.0 * 0.2), 1e-14);
}

}  // namespace
}  // namespace vibratory_alignment
