// Statics of the part on the base: heights of first touch from the outlines, equilibria from the balance of forces and
// from closed forms (MODEL.md "Free motion", "Settled readings").
#include "mechanics/statics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/cases.h"
#include "../support/scenes.h"
#include "mechanics/site_rules.h"
#include "model/number_text.h"

namespace vibratory_alignment {
namespace {

using test::plain;
using test::scene_of;

/// Deepest penetration of any contact that the scene calls for, from above; negative: the gap. Written from the
/// outlines.
double penetration(const System& s, double x, double y, double phi) {
  const double c = std::cos(phi), n = std::sin(phi);
  double deepest = -INFINITY;
  for (const double side : {1.0, -1.0}) {
    if (s.contacts.edges) {
      const double rx = side * s.slot_half_width - x, ry = -y, along = rx * c + ry * n, up = ry * c - rx * n;
      deepest = std::max(deepest, std::min({up + s.base_distance, s.half_width - along, s.half_width + along}));
    }
    const double bx = x + side * s.half_width * c + s.base_distance * n;
    const double by = y + side * s.half_width * n - s.base_distance * c;
    if (s.contacts.corners && std::abs(bx) >= s.slot_half_width) deepest = std::max(deepest, -by);
    if (s.has_floor && std::abs(bx) < s.slot_half_width) deepest = std::max(deepest, -s.floor_depth - by);
  }
  return deepest;
}

System system_of(const std::string& contacts) {
  System system = make_system(scene_of(plain));
  system.contacts.edges = contacts.find('e') != std::string::npos;
  system.contacts.corners = contacts.find('c') != std::string::npos;
  system.has_floor = system.contacts.walls = contacts.find('w') != std::string::npos;
  system.floor_depth = 0.4;
  return system;
}

// At y_touch something is touched, just above it nothing is, just below it the touch is real.
TEST(TouchHeight, is_where_the_first_contact_closes) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const std::string contacts : {"e", "c", "ec", "w", "ecw"}) {
    const System system = system_of(contacts);
    int found = 0;
    for (int i = 0; i < 400; ++i) {
      const double x = 0.9 * u(random), phi = (i % 3 == 0 ? 0.01 : 1.2) * u(random);
      const std::optional<double> y = touch_height(system, x, phi);
      if (!y) {
        // nothing to touch however far down: then only sides that are vertical or the slot's air are below
        for (double below = 2.0; below > -1.0; below -= 0.05)
          ASSERT_LE(penetration(system, x, below, phi), 0.0) << contacts;
        continue;
      }
      ++found;
      EXPECT_NEAR(penetration(system, x, *y, phi), 0.0, 1e-14) << contacts << " x " << x << " phi " << phi;
      for (const double above : {1e-9, 1e-4, 0.03, 0.5, 3.0})
        EXPECT_LT(penetration(system, x, *y + above, phi), 0.0) << contacts << " x " << x << " phi " << phi;
      EXPECT_GT(penetration(system, x, *y - 1e-9, phi), 0.0) << contacts << " x " << x << " phi " << phi;
    }
    EXPECT_GT(found, 100) << contacts;
  }
}

// Flat over the edge A1: y = b. Tilted: y cos phi = b - (l - x) sin phi.
TEST(TouchHeight, of_an_edge_on_the_bottom_face) {
  const System s = system_of("e");
  EXPECT_NEAR(*touch_height(s, 0.2, 0.0), s.base_distance, 1e-16);
  const double phi = 0.02;
  EXPECT_NEAR(*touch_height(s, 0.2, phi) * std::cos(phi), s.base_distance - (s.slot_half_width - 0.2) * std::sin(phi),
              1e-15);
}

// In the slot, flat: both edges pass beside the part.
TEST(TouchHeight, is_none_above_the_slot) {
  EXPECT_FALSE(touch_height(system_of("e"), 0.0, 0.0));
  EXPECT_FALSE(touch_height(system_of("c"), 0.0, 0.0));
  const System walls = system_of("w");
  EXPECT_NEAR(*touch_height(walls, 0.0, 0.0), walls.base_distance - walls.floor_depth, 1e-16);
}

TEST(TouchHeight, does_not_know_left_from_right) {
  std::mt19937 random(32);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const System system = system_of("ecw");
  for (int i = 0; i < 200; ++i) {
    const double x = 0.9 * u(random), phi = u(random);
    const auto y = touch_height(system, x, phi), mirrored = touch_height(system, -x, -phi);
    ASSERT_EQ(y.has_value(), mirrored.has_value());
    if (!y) continue;
    EXPECT_EQ(*y, *mirrored);
  }
}

TEST(PressingForce, sets_the_anchor_below_the_height_of_touch) {
  const Scene scene = scene_of(plain);
  const System s = make_system(scene);
  EXPECT_NEAR(s.y.anchor, *touch_height(s, scene.initial.x, *scene.initial.phi) - 0.27, 1e-16);
  // neither weight nor the height of the start is part of it
  const System heavy = make_system(scene_of(plain, {"weight=0.4", "initial.y=1.3"}));
  EXPECT_EQ(heavy.y.anchor, s.y.anchor);
}

TEST(PressingForce, without_a_height_of_touch_is_refused) {
  for (const char* setting : {"initial.x=0.0", "initial.x=0.01"})
    EXPECT_THROW(make_system(scene_of(plain, {setting, "initial.phi=0.0"})), SceneError);
  EXPECT_NO_THROW(make_system(
      scene_of(plain, {"initial.x=0.0", "initial.phi=0.0", "gripper.pressing_force=null", "gripper.anchor.y=0.5"})));
}

TEST(Equilibrium, without_anything_to_rest_on_is_refused) {
  EXPECT_THROW(make_system(scene_of(plain, {"initial.x=0.0", "initial.phi=0.0", "initial.y=null",
                                            "gripper.pressing_force=null", "gripper.anchor.y=0.5"})),
               SceneError);
}

/// Balance of all forces at rest, written from MODEL.md with every contact point by itself: x, y and moment.
/// Friction enters as one tangential force t at the contact. No walls: beside the slot a corner is on the top.
struct Balance {
  double x, y, moment;
  int loaded;
  double normal;
};
Balance balance(const System& s, const State& q, double t) {
  Balance b{-s.x.stiffness * (q.x - s.x.anchor), -(q.y - s.y.anchor) - s.weight,
            -s.phi.stiffness * (q.phi - s.phi.anchor), 0, 0};
  const double c = std::cos(q.phi), n = std::sin(q.phi);
  const auto push = [&](double px, double py, double nx, double ny, double depth) {
    const double force = (s.stiffness_y * ny * ny + s.stiffness_x * nx * nx) * depth;
    const double fx = force * nx + t * ny, fy = force * ny - t * nx;
    b.x += fx;
    b.y += fy;
    b.moment += (px - q.x) * fy - (py - q.y) * fx;
    b.normal = force;
    ++b.loaded;
  };
  for (const double side : {1.0, -1.0}) {
    const double ax = side * s.slot_half_width;
    const double along = (ax - q.x) * c - q.y * n, up = -q.y * c - (ax - q.x) * n;
    // the nearest face of the part
    const double bottom = up + s.base_distance, right = s.half_width - along, left = s.half_width + along;
    const double depth = std::min({bottom, right, left});
    if (s.contacts.edges && depth > 0.0) {
      if (depth == bottom)
        push(ax, 0.0, -n, c, depth);
      else if (depth == right)
        push(ax, 0.0, -c, -n, depth);
      else
        push(ax, 0.0, c, n, depth);
    }
    const double bx = q.x + side * s.half_width * c + s.base_distance * n;
    const double by = q.y + side * s.half_width * n - s.base_distance * c;
    if (s.contacts.corners && by < 0.0 && std::abs(bx) > s.slot_half_width) push(bx, by, 0.0, 1.0, -by);
  }
  return b;
}

Scene at_rest(const std::vector<std::string>& more) {
  std::vector<std::string> settings = {"initial.y=null", "initial.phi=null"};
  settings.insert(settings.end(), more.begin(), more.end());
  return scene_of(plain, settings);
}

TEST(Equilibrium, loads_vanish_without_friction) {
  for (const char* contacts : {"contacts=[edges]", "contacts=[edges, corners]"})
    for (const char* x : {"initial.x=0.21", "initial.x=0.4", "initial.x=-0.3", "initial.x=0.1"})
      for (const char* tilt : {"gripper.anchor.phi=0.02", "gripper.anchor.phi=-0.05"}) {
        const System s = make_system(at_rest({"friction=null", contacts, x, tilt, "weight=0.1"}));
        const Balance b = balance(s, s.start, 0.0);
        EXPECT_GE(b.loaded, 1);
        // the heights are found to the last digit: an error of 1e-16 times the base's stiffness
        EXPECT_NEAR(b.y, 0.0, 4e-12) << contacts << x << tilt;
        EXPECT_NEAR(b.moment, 0.0, 2e-12) << contacts << x << tilt;
      }
}

// On bases from soft to stiff, on one contact and, with corners on a soft base, pressed until more than one carries:
// what is left over is what the last digit of the height makes of the base's stiffness.
TEST(Equilibrium, is_found_to_the_last_digit_on_any_base) {
  int on_several = 0;
  for (const double stiffness : {30.0, 1e3, 1e6, 1e9, 1e12})
    for (const char* force : {"gripper.pressing_force=0.01", "gripper.pressing_force=3.0"})
      for (const char* x : {"initial.x=0.21", "initial.x=-0.3", "initial.x=0.12"}) {
        const System s = make_system(at_rest({"friction=null", "contacts=[edges, corners]", force, x,
                                              "base.stiffness={y: " + std::to_string(stiffness) + "}"}));
        const Balance b = balance(s, s.start, 0.0);
        ASSERT_GE(b.loaded, 1);
        on_several += b.loaded > 1;
        EXPECT_NEAR(b.y, 0.0, 2e-15 * (1.0 + stiffness * b.loaded)) << stiffness << force << x;
        EXPECT_NEAR(b.moment, 0.0, 1e-15 * (1.0 + stiffness * b.loaded)) << stiffness << force << x;
      }
  EXPECT_GT(on_several, 0);
}

// Also where the part lies on edges and corners at once, or hardly on an edge, off which it slips when it is pressed
// deeper.
TEST(Equilibrium, is_found_however_the_part_lies) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int found = 0, on_several = 0;
  for (int i = 0; i < test::cases_of(3000); ++i) {
    const auto set = [](const char* key, double value) { return std::string(key) + "=" + std::to_string(value); };
    const double stiffness = std::pow(10.0, 2.5 + u(random));
    try {
      const System s = make_system(
          at_rest({"friction=null", "contacts=[edges, corners]", set("initial.x", 0.5 * u(random)),
                   set("gripper.anchor.phi", 0.5 * u(random)), set("gripper.pressing_force", std::pow(10.0, u(random))),
                   "base.stiffness={y: " + std::to_string(stiffness) + "}"}));
      const Balance b = balance(s, s.start, 0.0);
      ++found;
      on_several += b.loaded > 1;
      EXPECT_NEAR(b.y, 0.0, 4e-15 * (1.0 + stiffness * b.loaded)) << i;
    } catch (const SceneError&) {
      // nothing to rest on, or it slips off
    }
  }
  EXPECT_GT(found, test::cases_of(2000));
  EXPECT_GT(on_several, test::cases_of(100));
}

// Of several heights at which it would be carried the part rests at the first one that it comes down to: so on an edge
// that it covers by hardly more than it is pressed into it, beyond which the edge is in its side and carries little.
TEST(Equilibrium, is_the_first_one_from_above) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto set = [](const char* key, double value) { return std::string(key) + "=" + std::to_string(value); };
  int found = 0, hardly_covered = 0;
  for (int i = 0; i < test::cases_of(2000); ++i) {
    const double stiffness = std::pow(10.0, 3.0 + u(random)), force = std::pow(10.0, u(random));
    const double covered = force / stiffness * std::pow(10.0, u(random));
    const bool is_level = i % 2 == 0;
    const Scene scene = scene_of(
        plain, {"friction=null", "contacts=[edges, corners]", "initial.y=null", set("initial.x", 0.083 + covered),
                set("initial.phi", is_level ? 0.0 : 0.3 * u(random)), set("gripper.pressing_force", force),
                "base.stiffness={y: " + std::to_string(stiffness) + "}"});
    try {
      const System s = make_system(scene);
      const double top = *touch_height(s, s.start.x, s.start.phi);
      State q = s.start;
      double way = force / (12.0 * stiffness);
      while (q.y = top - way, balance(s, q, 0.0).y < 0.0) way *= 1.01;
      EXPECT_GE(s.start.y, q.y - 1e-15) << i;
      ++found;
      hardly_covered += is_level && covered < 1.3 * way && covered > way;
    } catch (const SceneError&) {
      // nothing carries it
    }
  }
  EXPECT_GT(found, test::cases_of(1500));
  EXPECT_GT(hardly_covered, test::cases_of(50));
}

// One contact and set-valued friction: it carries the horizontal force too, as far as f N.
TEST(Equilibrium, friction_holds_the_part_in_place) {
  for (const char* x : {"initial.x=0.21", "initial.x=0.35", "initial.x=-0.3"}) {
    const System s = make_system(at_rest({x, "friction.coefficient=0.6"}));
    const Balance without = balance(s, s.start, 0.0);
    ASSERT_EQ(without.loaded, 1);
    // the T that makes the horizontal force vanish
    const double t = -without.x / std::cos(s.start.phi);
    ASSERT_LE(std::abs(t), 0.6 * without.normal);
    const Balance b = balance(s, s.start, t);
    EXPECT_NEAR(b.x, 0.0, 4e-12);
    EXPECT_NEAR(b.y, 0.0, 4e-12);
    EXPECT_NEAR(b.moment, 0.0, 2e-12);
  }
}

// Where a corner is exactly beside the base's edge, or an edge beside the end of the bottom, nothing carries, nor does
// the side of the part, less deep than the bottom: the press would let the part sink past to the anchor, where all is
// balanced in the air. Farther on the base carries: N = k d is what the spring has left of the press, f0 - d.
TEST(Equilibrium, is_not_where_a_face_ends) {
  const std::string part = R"(
part: {half_width: 0.5, base_distance: 0.75, inertia: 1}
slot: {clearance: 0.25}
gripper: {anchor: {x: 0, phi: 0}, pressing_force: 0.125}
base: {stiffness: {y: 100}}
contacts: [edges]
excitation: {amplitude: 1, frequency: 1}
initial: {x: 0.25}
trial: {time_limit: 1}
)";
  for (const char* contacts : {"contacts=[edges]", "contacts=[corners]"})
    for (const double x : {0.25, -0.25}) {
      const auto at = [&](double place) {
        return scene_of(part, {contacts, "initial.x=" + number_text(place), "initial.phi=0"});
      };
      for (const double beside : {1.0 - 1e-13, 1.0})
        EXPECT_THROW(make_system(at(beside * x)), SceneError) << contacts << " " << x;
      EXPECT_NEAR(make_system(at(1.1 * x)).start.y, 0.75 - 0.125 / 101.0, 1e-15) << contacts << " " << x;
    }
  for (const double x : {0.25, -0.25})  // deeper than the side is there
    EXPECT_THROW(make_system(scene_of(part, {"initial.x=" + number_text((1.0 + 1e-9) * x), "initial.phi=0"})),
                 SceneError);
  // turned by the other corner until this one comes over the base: there the moment changes its sign at once
  const std::string turned = R"(
part: {half_width: 0.2383, base_distance: 0.2, inertia: 1}
slot: {clearance: 4e-6}
gripper: {stiffness: {}, anchor: {x: 0, phi: 0}, pressing_force: 0.07}
base: {stiffness: {y: 1}}
contacts: [corners]
excitation: {amplitude: -0.4, frequency: 1}
initial: {x: -0.4}
trial: {time_limit: 2}
)";
  EXPECT_THROW(make_system(scene_of(turned)), SceneError);
}

// A base that is a hundred times as stiff along x: where the side of the tilted part becomes the face that an edge is
// nearest to, the lift jumps from less than the load to more, and nothing balances.
TEST(Equilibrium, is_not_where_the_forces_jump) {
  const std::string tilted = R"(
part: {half_width: 1, base_distance: 1}
slot: {clearance: 0.1}
gripper: {stiffness: {y: 1}, anchor: {phi: -1.0}, pressing_force: 1}
base: {stiffness: {x: 100, y: 1}}
contacts: [edges]
excitation: {amplitude: 0, frequency: 1}
initial: {x: 1.39, phi: -1.0}
trial: {time_limit: 3}
)";
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    const Scene scene = scene_of(tilted, {"initial.x=" + number_text(1.3 + 1e-3 * i)});
    try {
      const System system = make_system(scene);
      EXPECT_NEAR(static_load(system, system.start.x, system.start.y, system.start.phi).force_y, 0.0, 1e-12) << i;
    } catch (const SceneError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 100);
}

// R1: phi0 = f0 (l - x)/k_phi. There x_a = x, so friction makes the contact force vertical: moment f0 (l -
// x).
TEST(Equilibrium, of_r1_is_its_closed_form) {
  const Scene scene =
      scene_of(plain, {"initial.x=0.2", "gripper.anchor.x=0.2", "gripper.anchor.phi=0.0", "friction.coefficient=0.2",
                       "gripper.stiffness.phi=60", "gripper.pressing_force=0.2", "initial.y=null", "initial.phi=null",
                       "base.stiffness={y: 2500}"});
  const System s = make_system(scene);
  // the base gives way by F/k, and by that the axial spring unloads: F = f0 - F/k
  const double force = 0.2 / (1.0 + 1.0 / 2500.0);
  EXPECT_NEAR(s.start.y - s.y.anchor, force, 1e-14);
  EXPECT_NEAR(s.start.phi, force * (s.slot_half_width - 0.2) / 60.0, 1e-14);
}

// The regularised law gives no force at rest: the normal force alone, with its horizontal part, makes the moment.
TEST(Equilibrium, regularised_friction_holds_nothing) {
  const System smooth = make_system(at_rest({"friction.regularization=2.0e-3"}));
  const System none = make_system(at_rest({"friction=null"}));
  EXPECT_EQ(smooth.start.phi, none.start.phi);
  EXPECT_EQ(smooth.start.y, none.start.y);
  EXPECT_NEAR(balance(smooth, smooth.start, 0.0).moment, 0.0, 2e-12);
}

// What is given stays.
TEST(Equilibrium, leaves_what_the_scene_gives) {
  const System y_free = make_system(scene_of(plain, {"initial.y=null"}));
  EXPECT_EQ(y_free.start.phi, 0.02);
  EXPECT_NEAR(static_load(y_free, y_free.start.x, y_free.start.y, 0.02).force_y, 0.0, 4e-12);
  const System phi_free = make_system(scene_of(plain, {"initial.phi=null", "initial.y=0.91"}));
  EXPECT_EQ(phi_free.start.y, 0.91);
}

/// Why the scene has no start.
std::string refusal_of(const Scene& scene) {
  try {
    make_system(scene);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "none";
}

// Beyond the edges nothing is touched; a gripper that holds the part far above them leaves it no rest on the base.
TEST(Equilibrium, names_where_there_is_none_in_the_units_of_the_scene) {
  const auto refusal_in_si = [](std::vector<std::string> settings) {
    settings.insert(settings.end(), {"contacts=[edges]", "initial.phi=0.03"});
    return refusal_of(load_scene_file(std::string(SCENE_DIR) + "/gripper_si.yaml", settings));
  };
  const std::string beside = refusal_in_si({"initial.x=0.25"});
  EXPECT_NE(beside.find("x = 0.25 m, phi = 0.03 rad: nothing can be touched"), std::string::npos) << beside;
  const std::string above = refusal_in_si({"gripper.pressing_force=null", "gripper.anchor.y=0.5"});
  EXPECT_NE(above.find("x = 0.0008 m, phi = 0.03 rad: no static equilibrium"), std::string::npos) << above;
  const std::string plain_one = refusal_of(scene_of(plain, {"initial.x=7.5", "initial.y=null"}));
  EXPECT_NE(plain_one.find("x = 7.5, phi = 0.02 (dimensionless): nothing can be touched"), std::string::npos)
      << plain_one;
}

TEST(Equilibrium, velocities_of_locked_motions_are_none) {
  const System s = make_system(scene_of(plain, {"initial.vx=0.3", "initial.omega=0.4", "initial.vy=0.5",
                                                "part.inertia=null", "gripper.stiffness.x=null"}));
  EXPECT_EQ(s.start.vx, 0.0);
  EXPECT_EQ(s.start.omega, 0.0);
  EXPECT_EQ(s.start.vy, 0.5);
}

// Mirrored scenes rest in mirrored places, on however many contacts.
TEST(Equilibrium, is_mirrored_to_the_last_digit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int found = 0;
  for (int i = 0; i < test::cases_of(1000); ++i) {
    const double x = 0.5 * u(random), tilt = 0.3 * u(random), anchor = 0.3 * u(random),
                 force = std::pow(10.0, u(random));
    const auto mirrored = [&](double side) {
      const auto set = [](const char* key, double value) { return std::string(key) + "=" + number_text(value); };
      return at_rest({"contacts=[edges, corners]", "base.stiffness={y: 20}", set("initial.x", side * x),
                      set("gripper.anchor.x", side * anchor), set("gripper.anchor.phi", side * tilt),
                      set("gripper.pressing_force", force)});
    };
    if (refusal_of(mirrored(1.0)) != "none") {
      EXPECT_NE(refusal_of(mirrored(-1.0)), "none") << i;
      continue;
    }
    const System right = make_system(mirrored(1.0)), left = make_system(mirrored(-1.0));
    ++found;
    EXPECT_EQ(right.start.y, left.start.y) << i;
    EXPECT_EQ(right.start.phi, -left.start.phi) << i;
    EXPECT_EQ(right.y.anchor, left.y.anchor) << i;
  }
  EXPECT_GT(found, test::cases_of(500));
}

// Mirrored scenes rest in mirrored places.
TEST(Equilibrium, is_mirrored_with_the_scene) {
  const System right = make_system(at_rest({"initial.x=0.3", "gripper.anchor.x=0.25", "gripper.anchor.phi=0.01"}));
  const System left = make_system(at_rest({"initial.x=-0.3", "gripper.anchor.x=-0.25", "gripper.anchor.phi=-0.01"}));
  EXPECT_EQ(right.start.y, left.start.y);
  EXPECT_EQ(right.start.phi, -left.start.phi);
}

}  // namespace
}  // namespace vibratory_alignment
