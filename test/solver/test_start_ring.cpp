// A trial that starts at rest on the base under a force that begins to grow: the base rings by the rate of that force,
// and once the part is released it flies with what the ring was then.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "../support/hard_scene.h"
#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

constexpr double kPress = 2.0, kPull = 4.0, kFrequency = 200.0, kStiffness = 1e10, kRingTolerance = 1e-9;

Scene pulled(double damping_ratio) {
  Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=0.005"});
  scene.initial.y.reset();
  scene.excitations[0].amplitude = kPull;
  scene.excitations[0].frequency = kFrequency;
  test::set_base(scene, kStiffness, damping_ratio);
  return scene;
}

struct Release {
  double time = 0.0, speed = 0.0;
};

/// z'' + h z' + k z = A sin(nu t) from rest about the static place, with the spring of the gripper (1) in k, up to
/// N = f0 - C z - H z' = 0.
Release expected_release(double damping_ratio) {
  const double damping = 2.0 * damping_ratio * std::sqrt(kStiffness), stiffness = kStiffness + 1.0;
  const std::complex<double> i(0.0, 1.0);
  const std::complex<double> driven = kPull / (stiffness - kFrequency * kFrequency + i * damping * kFrequency);
  // Im(driven exp(i nu t)) - Re(own exp(lambda t)), equal at the start in value and rate
  const double decay = 0.5 * damping, rate = std::sqrt(stiffness - decay * decay);
  const std::complex<double> lambda(-decay, rate);
  const double place = driven.imag(), speed = (i * kFrequency * driven).imag();
  const std::complex<double> own(place, (-decay * place - speed) / rate);
  const auto z = [&](double t) {
    return (driven * std::exp(i * kFrequency * t)).imag() - (own * std::exp(lambda * t)).real();
  };
  const auto z_rate = [&](double t) {
    return (i * kFrequency * driven * std::exp(i * kFrequency * t)).imag() -
           (lambda * own * std::exp(lambda * t)).real();
  };
  const auto force = [&](double t) { return kPress - kStiffness * z(t) - damping * z_rate(t); };
  const double step = 0.01 / rate;
  double before = 0.0;
  while (force(before + step) > 0.0) before += step;
  double after = before + step;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (before + after);
    (force(middle) > 0.0 ? before : after) = middle;
  }
  return {after, z_rate(after)};
}

// The ring of the place is a hundredth of the tolerance and less; that of the speed, which shows from the release on,
// is a hundred times the tolerance, unless the base has damped it by then.
TEST(StartRing, the_speed_of_a_release_is_that_of_the_ring) {
  for (const double damping_ratio : {0.0, 0.001, 0.01, 0.1})
    for (const char* solver : {"event", "implicit", "auto"}) {
      Scene scene = pulled(damping_ratio);
      scene.solver.name = solver;
      scene.solver.tolerance = kRingTolerance;
      Release release;
      test::run(scene, [&](const Segment& g) {
        for (int i = 0; i < g.event_count; ++i)
          if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release && release.time == 0.0)
            release = {g.end_time(), g.end.vy};
      });
      const Release expected = expected_release(damping_ratio);
      EXPECT_NEAR(release.speed, expected.speed, 2.0 * kRingTolerance) << solver << " " << damping_ratio;
    }
}

// A part in balance on its base that is thrown up with v rings by v sqrt(k) in N, and lifts off at
// sin omega t = f0/(v sqrt(k)), however small v, and however near to the balance N begins.
TEST(StartRing, a_speed_that_lifts_the_part_is_followed) {
  constexpr double kShare = 4.0;
  for (const char* solver : {"implicit", "auto"}) {
    Scene scene = pulled(0.0);
    scene.excitations.clear();
    scene.initial.vy = kShare * kPress / std::sqrt(kStiffness);
    scene.solver.name = solver;
    scene.solver.tolerance = 1e-4;
    double lifts = 0.0;
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.event_count; ++i)
        if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release && lifts == 0.0) lifts = g.end_time();
    });
    EXPECT_NEAR(lifts * std::sqrt(kStiffness), std::asin(1.0 / kShare), 1e-5) << solver;
  }
}

// What the base has damped by the end of the step is not followed.
TEST(StartRing, is_passed_over_where_the_base_damps_it) {
  constexpr double kBeforeRelease = 0.002;
  for (const char* solver : {"implicit", "auto"}) {
    Scene scene = pulled(0.1);
    scene.solver.name = solver;
    scene.solver.tolerance = kRingTolerance;
    EXPECT_LE(test::run(scene, {}, kBeforeRelease).counts.steps, 2) << solver;
  }
}

}  // namespace
}  // namespace vibratory_alignment
