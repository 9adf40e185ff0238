// A ball on a shaken table (hard/shaken_table): where the motion with one bounce a period begins, and where it doubles.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/numbers.h"
#include "../support/restitution.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

using test::kPi;

constexpr double kFrequency = 1000.0, kPeriod = 2.0 * kPi / kFrequency;

double restitution() { return test::linear_restitution(0.3); }
double least_gamma() { return kPi * (1.0 - restitution()) / (1.0 + restitution()); }
double doubling_gamma() {
  const double e = restitution();
  return std::hypot(least_gamma(), 2.0 * (1.0 + e * e) / std::pow(1.0 + e, 2));
}

/// Times between the last 20 touches as shares of the period. It starts 1 % off the motion that bounces once a period:
/// there it leaves with w T e/(1 + e) in the phase cos theta = least_gamma/gamma (where there is none: at its limit).
std::vector<double> last_flights(double gamma, const char* solver = "event") {
  Scene scene = test::hard_scene("shaken_table");
  scene.solver.name = solver;
  scene.excitations[0].amplitude = gamma;
  scene.excitations[0].phase = std::acos(std::min(1.0, least_gamma() / gamma));
  scene.initial.vy = 1.01 * kPeriod * restitution() / (1.0 + restitution());
  scene.trial.time_limit = 300.0 * kPeriod;
  std::vector<double> shares;
  double last = 0.0;
  for (const test::TimedEvent& e : test::events_of(scene, scene.trial.time_limit)) {
    if (e.event.kind != EventKind::touch) continue;
    shares.push_back((e.time - last) / kPeriod);
    last = e.time;
  }
  EXPECT_GT(shares.size(), 20u) << gamma;
  return shares.size() < 20 ? std::vector<double>() : std::vector<double>(shares.end() - 20, shares.end());
}

TEST(ShakenTable, thresholds_are_the_published_ones) {
  EXPECT_NEAR(least_gamma(), 1.1887, 1e-4);
  EXPECT_NEAR(doubling_gamma(), 1.6492, 1e-4);
}

TEST(ShakenTable, one_bounce_a_period_between_the_thresholds) {
  for (const double gamma : {1.01 * least_gamma(), 1.25, 1.4, 1.55, 0.99 * doubling_gamma()})
    for (const double share : last_flights(gamma)) EXPECT_NEAR(share, 1.0, 1e-4) << gamma;
}

TEST(ShakenTable, implicit_steps_bounce_once_a_period_too) {
  for (const double gamma : {1.25, 1.4, 1.55})
    for (const double share : last_flights(gamma, "implicit")) EXPECT_NEAR(share, 1.0, 1e-4) << gamma;
}

TEST(ShakenTable, no_such_motion_below) {
  for (const double share : {0.9, 0.99}) {
    double off = 0.0;
    for (const double flight : last_flights(share * least_gamma())) off = std::max(off, std::abs(flight - 1.0));
    EXPECT_GT(off, 0.1) << share;
  }
}

TEST(ShakenTable, period_doubles_above) {
  for (const double gamma : {1.01 * doubling_gamma(), 1.72}) {
    const std::vector<double> flights = last_flights(gamma);
    for (std::size_t i = 0; i + 2 < flights.size(); ++i) {
      EXPECT_NEAR(flights[i], flights[i + 2], 1e-3) << gamma;
      EXPECT_NEAR(flights[i] + flights[i + 1], 2.0, 1e-3) << gamma;
      EXPECT_GT(std::abs(flights[i] - flights[i + 1]), 0.01) << gamma;
    }
  }
}

}  // namespace
}  // namespace vibratory_alignment
