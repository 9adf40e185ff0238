// The checker itself: it passes a motion that keeps the laws, and finds every law that is broken in a doctored copy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "../support/scenes.h"
#include "segment_checks.h"
#include "trial/simulation.h"

namespace vibratory_alignment::hunt {
namespace {

bool is_loaded_throughout(const Segment& g) {
  if (g.loaded_count != 1 || g.duration == 0.0) return false;
  const auto force = [&](double share) { return value_at(g.loaded[0].normal_force, g.order, share * g.duration); };
  return std::min(force(0.0), force(1.0)) > 0.7 * force(0.5) && force(0.5) > 1.0;
}

bool slides_under_load(const Segment& g) {
  return g.loaded_count == 1 && g.duration > 0.0 && value_at(g.loaded[0].normal_force, g.order, 0.5 * g.duration) > 1.0;
}

bool ends_with_touch(const Segment& g) { return g.event_count > 0 && g.events[0].kind == EventKind::touch; }

class DoctoredSegment : public testing::Test {
 protected:
  Scene scene_ = test::scene_of(test::plain);
  System system_ = make_system(scene_);
  std::optional<Simulation> simulation_;  ///< what the segment came from: a flight's lies in its solver
  Segment segment_ = segment_where(slides_under_load);

  /// The first segment of a trial of the scene that `wanted` accepts.
  Segment segment_where(const std::function<bool(const Segment&)>& wanted) {
    simulation_.emplace(scene_);
    while (simulation_->advance())
      if (wanted(simulation_->segment())) return simulation_->segment();
    ADD_FAILURE() << "no such segment";
    return {};
  }

  void expect_broken(Invariant invariant) const {
    const std::optional<Fault> fault = check_segment(system_, {scene_.solver.tolerance, 1.0}, segment_);
    ASSERT_TRUE(fault);
    EXPECT_STREQ(to_string(fault->invariant), to_string(invariant));
  }
};

TEST_F(DoctoredSegment, is_found_nothing_in_before) {
  Simulation simulation(scene_);
  while (simulation.advance()) {
    const std::optional<Fault> fault = check_segment(system_, {scene_.solver.tolerance, 1.0}, simulation.segment());
    ASSERT_FALSE(fault) << fault->detail;
  }
}

TEST_F(DoctoredSegment, with_a_base_that_pulls) {
  segment_.loaded[0].normal_force = {-1e-6};
  expect_broken(Invariant::base_pushes);
}

TEST_F(DoctoredSegment, with_a_base_force_that_depth_and_rate_do_not_make) {
  segment_.loaded[0].normal_force[0] *= 1.0 + 1e-5;
  expect_broken(Invariant::base_pushes);
}

// At the end the last term is 0.3 % of all: three times what a series that is cut off may lack.
TEST_F(DoctoredSegment, with_a_base_force_whose_last_terms_are_too_large) {
  Series& force = segment_.loaded[0].normal_force;
  const double h = segment_.duration;
  double terms = 0.0;
  for (int k = segment_.order; k >= 0; --k) terms = terms * h + std::abs(force[static_cast<std::size_t>(k)]);
  force[static_cast<std::size_t>(segment_.order)] += 3e-3 * terms / std::pow(h, segment_.order);
  expect_broken(Invariant::base_pushes);
}

// What an implicit step passes over changes N by a factor of two at most, and is over at its end.
TEST_F(DoctoredSegment, with_more_base_force_than_an_implicit_step_passes_over) {
  scene_ = test::scene_of(test::plain, {"gripper.pressing_force=3", "initial={x: 0.21}"});
  system_ = make_system(scene_);
  const Segment before = segment_where(is_loaded_throughout);
  const auto check_with = [&](double share_amid, double share_at_end) {
    segment_ = before;
    segment_.coarse = true;
    Series& force = segment_.loaded[0].normal_force;
    const double h = before.duration, amid = share_amid * value_at(force, before.order, 0.5 * h);
    force[0] += share_at_end * value_at(force, before.order, h);
    force[1] += 4.0 * amid / h;
    force[2] -= 4.0 * amid / (h * h);
    return check_segment(system_, {scene_.solver.tolerance, 1.0}, segment_);
  };
  EXPECT_FALSE(check_with(0.8, 0.0));
  EXPECT_TRUE(check_with(1.2, 0.0));
  EXPECT_TRUE(check_with(0.0, 1e-3));
}

// An event may end it at once, before the time has moved on.
TEST_F(DoctoredSegment, of_an_implicit_step_that_ends_at_once) {
  scene_ = test::scene_of(test::plain, {"gripper.pressing_force=3", "initial={x: 0.21}"});
  system_ = make_system(scene_);
  segment_ = segment_where(is_loaded_throughout);
  segment_.coarse = true;
  segment_.duration = 1e-16;
  segment_.end = segment_.begin;
  segment_.loaded[0].normal_force[0] *= 1.5;
  segment_.start.high = 1.0;
  EXPECT_FALSE(check_segment(system_, {scene_.solver.tolerance, 1.0}, segment_));
  segment_.start.high = 0.0;
  expect_broken(Invariant::base_pushes);
}

// What rates are known to: their digits are those of the fastest motion, and with it of the force of the damper.
TEST_F(DoctoredSegment, is_judged_by_the_digits_of_the_fastest_motion) {
  segment_.loaded[0].normal_force[0] *= 1.0 + 1e-5;
  EXPECT_TRUE(check_segment(system_, {scene_.solver.tolerance, 1e3}, segment_));
  EXPECT_FALSE(check_segment(system_, {scene_.solver.tolerance, 1e9}, segment_));
}

TEST_F(DoctoredSegment, with_friction_beyond_the_cone) {
  for (double& c : segment_.loaded[0].tangential_force) c *= 1.0 + 1e-5;
  expect_broken(Invariant::friction_cone);
}

TEST_F(DoctoredSegment, with_friction_that_drives) {
  for (double& c : segment_.loaded[0].tangential_force) c *= -1.0;
  expect_broken(Invariant::friction_brakes);
}

TEST_F(DoctoredSegment, with_a_force_that_is_no_number) {
  segment_.loaded[0].tangential_force[static_cast<std::size_t>(segment_.order)] =
      std::numeric_limits<double>::quiet_NaN();
  expect_broken(Invariant::finite);
}

TEST_F(DoctoredSegment, with_a_state_that_is_no_number) {
  segment_.end.omega = std::numeric_limits<double>::infinity();
  expect_broken(Invariant::finite);
}

TEST_F(DoctoredSegment, with_an_impact_that_nobody_noticed) {
  segment_.loaded_count = 0;
  segment_.contacts = {};
  expect_broken(Invariant::no_passing);
}

TEST_F(DoctoredSegment, that_touches_what_it_is_inside_of) {
  segment_ = segment_where(ends_with_touch);
  EXPECT_FALSE(check_segment(system_, {scene_.solver.tolerance, 1.0}, segment_));
  segment_.end.y -= 1e-6;
  expect_broken(Invariant::no_passing);
}

// The edge is at the part's bottom, and so not inside the part; inside of its side it is.
TEST_F(DoctoredSegment, that_touches_a_face_far_away) {
  segment_ = segment_where(ends_with_touch);
  segment_.events[0].face = Face::right_side;
  expect_broken(Invariant::no_passing);
}

// A step of the series is wrong by a hundredth of the tolerance; after implicit steps its places are by all of it.
TEST_F(DoctoredSegment, whose_place_implicit_steps_have_made) {
  segment_ = segment_where(ends_with_touch);
  segment_.end.y -= 0.3 * scene_.solver.tolerance;
  expect_broken(Invariant::no_passing);
  EXPECT_FALSE(check_segment(system_, {scene_.solver.tolerance, 1.0, true}, segment_));
}

TEST_F(DoctoredSegment, a_flight_that_goes_through_the_base) {
  segment_ = segment_where([](const Segment& g) { return g.loaded_count == 0 && g.duration > 1e-3; });
  // straight down instead of its closed form
  const State& begin = segment_.begin;
  segment_.flight = nullptr;
  segment_.order = 1;
  segment_.end.y = begin.y - 0.5;
  segment_.x = {begin.x};
  segment_.y = {begin.y, -0.5 / segment_.duration};
  segment_.phi = {begin.phi};
  expect_broken(Invariant::no_passing);
}

}  // namespace
}  // namespace vibratory_alignment::hunt
