// What a segment says of itself between its ends.
#include "solver/segment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// One contact in the tanh layer for a second: N = 2 - t, and T swings by 1 at V = 0.
Segment in_the_layer() {
  Segment g;
  g.duration = 1.0;
  g.order = 2;
  g.friction = 0.4;
  g.contacts[0] = {Phase::loaded, Face::bottom, Slip::regularized};
  g.loaded_count = 1;
  g.loaded[0].normal_force = {2.0, -1.0};
  g.loaded[0].tangential_force = {-1.0, 2.0};
  return g;
}

// The polynomial of T of an implicit step may overshoot the limit of friction, of which N has the right to tell.
TEST(Segment, friction_of_an_implicit_step_keeps_its_limit) {
  Segment g = in_the_layer();
  g.coarse = true;
  for (const double t : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
    const double limit = 0.4 * (2.0 - t);
    EXPECT_DOUBLE_EQ(contact_at(g, 0, t).tangential_force, std::clamp(2.0 * t - 1.0, -limit, limit)) << t;
  }
}

// Series are exact: what they say beyond the limit is not to be hidden.
TEST(Segment, friction_of_series_is_what_they_say) {
  EXPECT_DOUBLE_EQ(contact_at(in_the_layer(), 0, 1.0).tangential_force, 1.0);
}

// Where a contact sticks an event ends the step at the limit.
TEST(Segment, friction_of_a_contact_that_sticks_is_what_the_step_says) {
  Segment g = in_the_layer();
  g.coarse = true;
  g.contacts[0].slip = Slip::stick;
  EXPECT_DOUBLE_EQ(contact_at(g, 0, 1.0).tangential_force, 1.0);
}

}  // namespace
}  // namespace vibratory_alignment
