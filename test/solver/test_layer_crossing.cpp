// A crossing of the tanh layer against the closed form for constant N, balances of momentum, and the power series of
// the solver, which cross the layer in another way.
#include "solver/layer_crossing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/reference_scene.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "mechanics/system.h"

namespace vibratory_alignment {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();
constexpr double kLayerWidth = 2e-3, kCrossingTolerance = 1e-10;

/// A part that moves along the base alone, pressed on edge a1 with N = 1 and friction f: V = x' and
/// x'' = force - f tanh(x'/eps).
System sliding_system(double friction) {
  System system = make_system(test::scene_of(test::plain));
  system.phi.moves = system.y.moves = false;
  system.phi.inverse_inertia = system.y.inverse_inertia = 0.0;
  system.x = {true, 1.0, 1.0, 0.0, 0.0, 0.0};
  system.stiffness_x = system.stiffness_y = 100.0;
  system.damping_x = system.damping_y = 0.0;
  system.isotropic = true;
  system.recovery = false;
  system.friction = friction;
  system.regularization = kLayerWidth;
  system.tanh_saturation = 10.0;
  return system;
}

struct Slide {
  explicit Slide(double friction, double force, double share) : system(sliding_system(friction)) {
    start.x = 0.2;
    start.y = system.base_distance - 0.01;  // depth 0.01
    contacts[0] = {Phase::loaded, Face::bottom, Slip::regularized};
    start.vx = share * kLayerWidth;
    drives.count = 1;
    drives.direction[0] = Direction::x;
    drives.form[0] = DriveForm{};
    drives.form[0].constant = force;
  }

  System system;
  State start;
  ContactStates contacts{};
  DriveForms drives;
  SolverCounts counts;
};

/// Time from V = 0 to v eps, where V' = a - b tanh(V/eps).
double time_to(double v, double a, double b) {
  // ln(a cosh v - b sinh v), without overflow or cancellation
  const double log_term =
      std::abs(v) + std::log(0.5 * ((a - b) * std::exp(v - std::abs(v)) + (a + b) * std::exp(-v - std::abs(v))));
  return kLayerWidth * (a * v + b * (log_term - std::log(a))) / (a * a - b * b);
}

TEST(LayerCrossing, takes_the_time_of_the_closed_form) {
  for (const double friction : {0.01, 0.5, 0.9})
    for (const double from : {-10.0, -1.0, 0.0, 5.0})
      for (const double way : {1.0, -1.0}) {
        Slide slide(friction, way, way * from);
        LayerCrossing crossing(slide.system, kCrossingTolerance);
        ASSERT_TRUE(crossing.take(slide.start, slide.drives, slide.contacts, Site::a1, kForEver, slide.counts));
        const double duration = time_to(10.0, 1.0, friction) - time_to(from, 1.0, friction);
        EXPECT_NEAR(crossing.duration(), duration, 1e-13 * duration) << friction << ", " << from;
        EXPECT_NEAR(crossing.end().vx, way * 10.0 * kLayerWidth, 1e-14) << friction << ", " << from;
        EXPECT_EQ(crossing.end().y, slide.start.y);
        EXPECT_EQ(crossing.end().phi, slide.start.phi);
        // on the way
        for (const double v : {from + 0.1, 0.3, 3.0, 9.9}) {
          if (v < from) continue;
          const double t = time_to(v, 1.0, friction) - time_to(from, 1.0, friction);
          const ContactValues contact = crossing.contact_at(t);
          EXPECT_NEAR(crossing.at(t).vx, way * v * kLayerWidth, 1e-11) << friction << ", " << from << " at " << v;
          EXPECT_NEAR(contact.slip_velocity, way * v * kLayerWidth, 1e-11) << friction << ", " << from << " at " << v;
          EXPECT_NEAR(contact.tangential_force, -friction * std::tanh(way * v), 1e-8) << friction << " at " << v;
          EXPECT_NEAR(contact.normal_force, 1.0, 1e-13);
        }
      }
}

TEST(LayerCrossing, is_the_same_to_the_last_bit_in_the_mirror) {
  const Slide right(0.5, 1.0, -10.0), left(0.5, -1.0, 10.0);
  SolverCounts counts;
  LayerCrossing one(right.system, kCrossingTolerance), other(left.system, kCrossingTolerance);
  ContactStates mirrored{};
  mirrored[1] = right.contacts[0];
  State start = left.start;
  start.x = -start.x;
  ASSERT_TRUE(one.take(right.start, right.drives, right.contacts, Site::a1, kForEver, counts));
  ASSERT_TRUE(other.take(start, left.drives, mirrored, Site::a2, kForEver, counts));
  EXPECT_EQ(one.duration(), other.duration());
  EXPECT_EQ(one.end().x, -other.end().x);
  EXPECT_EQ(one.end().vx, -other.end().vx);
}

// V would come to rest where tanh(V/eps) = force/f, or comes near it; the part is about to be released; the layer ends
// here.
TEST(LayerCrossing, is_not_taken_where_v_does_not_go_through) {
  const auto taken = [](Slide slide) {
    LayerCrossing crossing(slide.system, kCrossingTolerance);
    return crossing.take(slide.start, slide.drives, slide.contacts, Site::a1, kForEver, slide.counts);
  };
  EXPECT_TRUE(taken(Slide(0.9, 1.0, -10.0)));
  EXPECT_FALSE(taken(Slide(1.0, 1.0, -10.0)));
  EXPECT_FALSE(taken(Slide(1.5, 1.0, -10.0)));
  EXPECT_FALSE(taken(Slide(1.5, 1.0, 0.0)));
  Slide lifted(0.5, 1.0, -10.0);
  lifted.start.y = lifted.system.base_distance;
  EXPECT_FALSE(taken(lifted));
  Slide leaving(0.5, 1.0, -10.0);
  leaving.start.vy = 2.0;  // undone in 0.005, and the crossing takes 0.04
  leaving.system.y = {true, 1.0, 1.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(taken(leaving));
}

TEST(LayerCrossing, is_not_taken_where_something_ends_it) {
  Slide slide(0.5, 1.0, -10.0);
  LayerCrossing crossing(slide.system, kCrossingTolerance);
  const auto taken = [&](double longest) {
    return crossing.take(slide.start, slide.drives, slide.contacts, Site::a1, longest, slide.counts);
  };
  ASSERT_TRUE(taken(kForEver));
  const double duration = crossing.duration();
  EXPECT_TRUE(taken(1.001 * duration));
  EXPECT_FALSE(taken(duration));
  EXPECT_FALSE(taken(0.2 * duration));
}

/// Runs R1 and hands every crossing to `look`.
template <typename Look>
int crossings_of_r1(double tolerance, Look look) {
  Scene scene = test::scene_of_reference(reference::caseR1Regularised());
  scene.solver.tolerance = tolerance;
  int count = 0;
  test::run(scene, [&](const Segment& g) {
    if (g.layer_crossing == nullptr) return;
    ++count;
    look(g);
  });
  return count;
}

// In nearly each of its 15 impacts.
TEST(LayerCrossing, takes_r1_through_the_layer_in_one_segment_an_impact) {
  for (const double tolerance : {1e-1, 1e-4, 1e-6}) {
    const int count = crossings_of_r1(tolerance, [](const Segment& g) {
      ASSERT_EQ(g.event_count, 1);
      EXPECT_EQ(g.events[0].kind, EventKind::slip);
    });
    EXPECT_GE(count, 12) << tolerance;
  }
}

// Newton's law, integrated: what the forces of a crossing, or of a part of it, add up to is the change of momentum, but
// for the tolerance of a step.
TEST(LayerCrossing, keeps_the_balance_of_momentum_by_its_quadrature) {
  Scene scene = test::scene_of_reference(reference::caseR1Regularised());
  const System system = make_system(scene);
  const int crossings = crossings_of_r1(1e-6, [&](const Segment& g) {
    for (const double from : {0.0, 0.3})
      for (const double to : {0.8, 1.0}) {
        const auto [count, time, weight] = g.layer_crossing->quadrature(from * g.duration, to * g.duration);
        double duration = 0.0, x = 0.0, y = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
          const State q = state_at(g, time[i]);
          const ContactValues contact = contact_at(g, 0, time[i]);
          const Load3 drive = drive_at(g, time[i]);
          const double c = std::cos(q.phi), s = std::sin(q.phi);
          duration += weight[i];
          // normal (-s, c), tangent (c, s) of the bottom
          x += weight[i] * (drive.x - system.x.stiffness * (q.x - system.x.anchor) - system.x.damping * q.vx -
                            contact.normal_force * s + contact.tangential_force * c);
          y += weight[i] * (drive.y - system.y.stiffness * (q.y - system.y.anchor) - system.y.damping * q.vy +
                            contact.normal_force * c + contact.tangential_force * s);
        }
        const State begin = state_at(g, from * g.duration), end = state_at(g, to * g.duration);
        EXPECT_NEAR(duration, (to - from) * g.duration, 1e-11 * g.duration);
        EXPECT_NEAR(x, system.x.inertia * (end.vx - begin.vx), 1e-9 * std::abs(end.vx - begin.vx) + 1e-13);
        EXPECT_NEAR(y, system.y.inertia * (end.vy - begin.vy), 1e-9 * std::abs(end.vy - begin.vy) + 1e-13);
      }
  });
  EXPECT_GE(crossings, 12);
}

// Sought on a grid: as large as any value of it, and not larger than the largest by more than the grid misses.
TEST(LayerCrossing, tells_the_largest_normal_force_and_bounds) {
  int inside = 0;
  crossings_of_r1(1e-4, [&](const Segment& g) {
    double most_force = 0.0;
    Load3 most;  // changes of the velocities
    constexpr int kPoints = 400;
    for (int i = 0; i <= kPoints; ++i)
      most_force = std::max(most_force, contact_at(g, 0, g.duration * i / kPoints).normal_force);
    for (int i = 0; i < kPoints; ++i) {
      const State one = state_at(g, g.duration * i / kPoints), next = state_at(g, g.duration * (i + 1) / kPoints);
      most.x = std::max(most.x, std::abs(next.vx - one.vx));
      most.y = std::max(most.y, std::abs(next.vy - one.vy));
      most.phi = std::max(most.phi, std::abs(next.omega - one.omega));
    }
    const double told = largest_normal_force(g, 0, 0.0, g.duration);
    EXPECT_GE(told, most_force * (1.0 - 1e-14));
    EXPECT_LE(told, most_force * (1.0 + 1e-4));
    EXPECT_LE(told, g.layer_crossing->most_normal_force());
    const Load3& bound = g.layer_crossing->most_acceleration();
    EXPECT_LE(most.x * kPoints / g.duration, bound.x);
    EXPECT_LE(most.y * kPoints / g.duration, bound.y);
    EXPECT_LE(most.phi * kPoints / g.duration, bound.phi);
    const double ends = std::max(contact_at(g, 0, 0.0).normal_force, contact_at(g, 0, g.duration).normal_force);
    inside += told > ends * (1.0 + 1e-6);
    EXPECT_NEAR(largest_normal_force(g, 0, 0.0, 0.0), contact_at(g, 0, 0.0).normal_force, 1e-12);
  });
  EXPECT_GT(inside, 0);
}

// The solver `auto` crosses as well; what it knows of the last step of the series, it does not know then. A part that
// goes on shaking along the base in lasting contact.
TEST(LayerCrossing, is_taken_by_auto) {
  const std::vector<std::string> settings = {"gripper.pressing_force=2.0",
                                             "base={stiffness: {y: 2.0e+4}, damping: {y: 30}}",
                                             "friction={coefficient: 0.05, regularization: 2.0e-4}",
                                             "excitation={amplitude: 1, frequency: 20, direction: x}",
                                             "gripper.stiffness.x=5",
                                             "trial.time_limit=8"};
  Scene scene = test::scene_of(test::plain, settings);
  std::array<State, 2> end;
  for (const bool automatic : {false, true}) {
    scene.solver.name = automatic ? "auto" : "event";
    scene.solver.tolerance = automatic ? 1e-4 : 1e-10;
    int crossings = 0;
    Simulation simulation(scene);
    while (simulation.advance()) crossings += simulation.segment().layer_crossing != nullptr;
    EXPECT_EQ(simulation.result().outcome, Outcome::time_limit);
    EXPECT_GT(crossings, automatic ? 10 : -1);
    end[automatic] = simulation.state();
  }
  EXPECT_NEAR(end[1].x, end[0].x, 1e-6);
  EXPECT_NEAR(end[1].vx, end[0].vx, 1e-6);
  EXPECT_NEAR(end[1].phi, end[0].phi, 1e-6);
}

// A crossing that is cut, as by a request to the node, goes on from there to the same end.
TEST(LayerCrossing, goes_on_where_it_is_cut) {
  Scene scene = test::scene_of_reference(reference::caseR1Regularised());
  scene.solver.tolerance = 1e-6;
  const auto end_of = [&](bool cut) {
    SimulationOptions options;
    options.until = 2.0;
    Simulation simulation(scene, options);
    int cuts = 0;
    while (simulation.advance()) {
      const Segment& g = simulation.segment();
      if (!cut || g.layer_crossing == nullptr || cuts == 3) continue;
      simulation.cut(g.start.value() + 0.4 * g.duration);
      ++cuts;
      EXPECT_TRUE(simulation.advance());
      EXPECT_NE(simulation.segment().layer_crossing, nullptr);
    }
    EXPECT_EQ(cuts, cut ? 3 : 0);
    return simulation.state();
  };
  const State whole = end_of(false), in_parts = end_of(true);
  EXPECT_NEAR(in_parts.x, whole.x, 1e-11);
  EXPECT_NEAR(in_parts.y, whole.y, 1e-11);
  EXPECT_NEAR(in_parts.phi, whole.phi, 1e-11);
}

}  // namespace
}  // namespace vibratory_alignment
