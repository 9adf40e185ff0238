// Wedging and jamming in the slot (hard/wedging, hard/jamming), against Whitney's conditions.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../support/hard_scene.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

/// Places the part so that the corner B1 is `depth` below the edges and `squeeze` inside the right wall, and A2 as far
/// inside the left side: the tilt by bisection, x and y from it.
void place_askew(Scene& scene, double depth, double squeeze) {
  const double a = scene.part.half_width, b = scene.part.base_distance, l = scene.slot_half_width();
  double low = 0.0, high = 0.1;
  for (int i = 0; i < 80; ++i) {
    const double phi = 0.5 * (low + high), c = std::cos(phi), s = std::sin(phi);
    scene.initial.x = l + squeeze - a * c - b * s;
    scene.initial.y = b * c - a * s - depth;
    scene.initial.phi = phi;
    (a - (l + scene.initial.x) * c - *scene.initial.y * s < squeeze ? low : high) = phi;
  }
  // the springs are at ease there
  scene.gripper.anchor_x = scene.initial.x;
  scene.gripper.anchor_y = scene.initial.y;
}

/// tan of the angle between the line of both contacts and the more remote of the two normals.
double least_friction_to_wedge(const Scene& scene, double depth) {
  return std::tan(std::atan(depth / (2.0 * scene.slot_half_width())) + *scene.initial.phi);
}

/// Normal force of both contacts at the end, when it is at rest.
double squeeze_left(const Scene& scene) {
  double force = 0.0;
  const TrialResult result = test::run(scene, [&](const Segment& g) {
    force = 0.0;
    for (int i = 0; i < g.loaded_count; ++i)
      force += value_at(g.loaded[static_cast<std::size_t>(i)].normal_force, g.order, g.duration);
  });
  EXPECT_EQ(result.outcome, Outcome::jammed) << result.failure;  // at rest in the slot, squeezed or not
  return force;
}

TEST(Wedging, needs_a_depth_below_f_times_the_width) {
  for (const double depth : {0.1, 0.2, 0.35}) {
    Scene scene = test::hard_scene("wedging");
    place_askew(scene, depth, 1e-6);
    const double least = least_friction_to_wedge(scene, depth);
    EXPECT_NEAR(least, depth / 1.0, 1e-3) << depth;  // the width is 1
    for (const double share : {0.9, 0.998, 1.002, 1.1}) {
      scene.friction->coefficient = share * least;
      const double force = squeeze_left(scene);
      if (share < 1.0)
        EXPECT_EQ(force, 0.0) << depth << " " << share;
      else
        EXPECT_NEAR(force, 2.0, 1e-3) << depth << " " << share;  // 1e6 times 1e-6, twice
    }
  }
}

TEST(Wedging, scene_is_placed_askew) {
  const Scene scene = test::hard_scene("wedging");
  Scene placed = scene;
  place_askew(placed, 0.2, 1e-6);
  EXPECT_NEAR(placed.initial.x, scene.initial.x, 1e-15);
  EXPECT_NEAR(*placed.initial.y, *scene.initial.y, 1e-15);
  EXPECT_NEAR(*placed.initial.phi, *scene.initial.phi, 1e-15);
}

/// Pressed down with `press` and held askew by `moment`, at rest: N = moment/depth at both contacts.
Scene pressed_askew(double depth, double press, double moment) {
  Scene scene = test::hard_scene("jamming");
  place_askew(scene, depth, moment / depth / scene.base.stiffness_y);
  scene.gripper.anchor_y = *scene.initial.y - press;
  scene.gripper.anchor_phi = *scene.initial.phi + moment / scene.gripper.phi.stiffness;
  scene.trial.inserted_depth = depth + 0.01;
  return scene;
}

// Whitney without a side force: M/(r F) < L/(2 r f) lets it slide, which is 2 f M/L < F.
TEST(Jamming, needs_a_moment_of_l_over_2_f_times_the_force) {
  for (const double depth : {0.2, 0.3})
    for (const double moment : {1.0, 2.0}) {
      Scene scene = pressed_askew(depth, 1.0, moment);
      const double least = depth / (2.0 * moment);
      ASSERT_LT(1.1 * least, depth);  // it does not wedge
      for (const double share : {0.5, 0.99, 1.01}) {
        scene.friction->coefficient = share * least;
        const TrialResult result = test::run(scene);
        EXPECT_EQ(result.outcome, share < 1.0 ? Outcome::inserted : Outcome::jammed)
            << depth << " " << moment << " " << share;
      }
    }
}

TEST(Jamming, scene_is_placed_askew) {
  const Scene scene = test::hard_scene("jamming"), placed = pressed_askew(0.2, 1.0, 1.0);
  EXPECT_NEAR(placed.initial.x, scene.initial.x, 1e-15);
  EXPECT_NEAR(*placed.initial.y, *scene.initial.y, 1e-15);
  EXPECT_NEAR(*placed.initial.phi, *scene.initial.phi, 1e-15);
  EXPECT_NEAR(*placed.gripper.anchor_y, *scene.gripper.anchor_y, 1e-15);
  EXPECT_NEAR(placed.gripper.anchor_phi, scene.gripper.anchor_phi, 1e-15);
}

}  // namespace
}  // namespace vibratory_alignment
