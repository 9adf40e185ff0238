// A part that starts from its static equilibrium stays there, on one contact or on several that share the friction
// (mechanics/statics.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "mechanics/statics.h"
#include "model/number_text.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

std::string set(const char* key, double value) { return std::string(key) + "=" + number_text(value); }

/// Largest way that a place goes in the trial; `contacts`: most contacts that carry it.
double way_of(const Scene& scene, int& contacts) {
  Simulation simulation(scene, {});
  contacts = 0;
  double way = 0.0, start[3] = {};
  for (bool first = true; simulation.advance(); first = false) {
    const Segment& segment = simulation.segment();
    contacts = std::max(contacts, segment.loaded_count);
    const double end[] = {segment.end.x, segment.end.y, segment.end.phi},
                 begin[] = {segment.begin.x, segment.begin.y, segment.begin.phi};
    for (int i = 0; i < 3; ++i) {
      if (first) start[i] = begin[i];
      way = std::max(way, std::abs(end[i] - start[i]));
    }
  }
  return way;
}

// Nothing shakes it, and friction can hold what the gripper pulls.
TEST(Rest, lasts) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int on_one = 0, on_several = 0, slid = 0;
  for (int i = 0; i < 800; ++i) {
    const double x = 0.5 * u(random);
    const std::vector<std::string> settings = {"contacts=[edges, corners]",
                                               "base.stiffness={y: 300}",
                                               "friction.coefficient=0.9",
                                               "excitation.amplitude=0",
                                               "trial.time_limit=2",
                                               "initial.y=null",
                                               "initial.phi=null",
                                               set("initial.x", x),
                                               set("gripper.anchor.x", x + 0.5 * u(random)),
                                               set("gripper.anchor.phi", 0.3 * u(random)),
                                               set("gripper.pressing_force", std::pow(10.0, u(random)))};
    const Scene scene = test::scene_of(test::plain, settings);
    try {
      make_system(scene);
    } catch (const SceneError&) {
      continue;  // nothing to rest on
    }
    int contacts = 0;
    const double way = way_of(scene, contacts);
    if (way > 1e-3) {  // the pull is too strong: it slides off
      ++slid;
      continue;
    }
    EXPECT_LT(way, 1e-11) << i << " on " << contacts;
    ++(contacts > 1 ? on_several : on_one);
  }
  EXPECT_GT(on_one, 200);
  EXPECT_GT(on_several, 30);
  EXPECT_LT(slid, on_several);
}

}  // namespace
}  // namespace vibratory_alignment
