// Where a point may touch: inside at the start it touches the nearest face, contacts end where their face ends, and
// only what the scene calls for is touched at all (MODEL.md "Contact", "Settled readings").
#include "mechanics/site_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::plain;
using test::scene_of;

System system_with(bool edges, bool corners, bool walls, bool floor = false) {
  System system = make_system(scene_of(plain));
  system.contacts = {edges, corners, walls};
  system.has_floor = floor;
  system.floor_depth = 0.4;
  return system;
}

ContactStates placed(const System& system, const State& state) {
  ContactStates contacts{};
  place_contacts(system, state, contacts);
  return contacts;
}

const ContactState& at(const ContactStates& contacts, Site site) { return contacts[static_cast<std::size_t>(site)]; }

// The nearest face, from the distances to all of them.
TEST(SiteRules, an_edge_inside_at_the_start_touches_the_nearest_face) {
  const System s = system_with(true, false, false);
  std::mt19937 random(41);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int seen[3] = {0, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    const State q{1.2 * u(random), 0.5 + 0.5 * u(random), u(random), 0, 0, 0};
    const ContactStates contacts = placed(s, q);
    for (const Site site : {Site::a1, Site::a2}) {
      const double rx = side_of(site) * s.slot_half_width - q.x, c = std::cos(q.phi), n = std::sin(q.phi);
      const double bottom = -q.y * c - rx * n + s.base_distance;
      const double right = s.half_width - (rx * c - q.y * n), left = s.half_width + (rx * c - q.y * n);
      const double least = std::min({bottom, right, left});
      if (std::abs(least) < 1e-12) continue;
      const ContactState& contact = at(contacts, site);
      if (least < 0.0) {
        EXPECT_EQ(contact.phase, Phase::outside);
        continue;
      }
      const Face nearest = least == bottom ? Face::bottom : least == right ? Face::right_side : Face::left_side;
      EXPECT_EQ(contact.face, nearest);
      EXPECT_EQ(contact.phase, Phase::loaded);
      ++seen[nearest == Face::bottom ? 0 : nearest == Face::right_side ? 1 : 2];
    }
  }
  for (const int count : seen) EXPECT_GT(count, 100);
}

// A corner at (x, -d): on top if it is deeper in the wall's direction, else at the wall.
TEST(SiteRules, a_corner_inside_at_the_start_touches_the_nearest_face) {
  const System s = system_with(false, true, true);
  const double l = s.slot_half_width;
  const auto corner_at = [&](double x, double y) {
    return placed(s, {x - s.half_width, y + s.base_distance, 0.0, 0, 0, 0});
  };
  EXPECT_EQ(at(corner_at(l + 0.02, -0.01), Site::b1).face, Face::top);
  EXPECT_EQ(at(corner_at(l + 0.01, -0.02), Site::b1).face, Face::right_wall);
  EXPECT_EQ(at(corner_at(l - 0.01, -0.02), Site::b1).phase, Phase::outside);
  EXPECT_EQ(at(corner_at(l + 0.01, 0.02), Site::b1).phase, Phase::outside);
  const auto left_at = [&](double x, double y) {
    return placed(s, {x + s.half_width, y + s.base_distance, 0.0, 0, 0, 0});
  };
  EXPECT_EQ(at(left_at(-l - 0.02, -0.01), Site::b2).face, Face::top);
  EXPECT_EQ(at(left_at(-l - 0.01, -0.02), Site::b2).face, Face::left_wall);
}

TEST(SiteRules, faces_that_are_not_called_for_are_not_touched) {
  const System s = system_with(false, true, false);
  const double l = s.slot_half_width;
  // nearer to where a wall would be: the top surface is the only face that is there
  const State q{l + 0.01 - s.half_width, -0.02 + s.base_distance, 0.0, 0, 0, 0};
  EXPECT_EQ(at(placed(s, q), Site::b1).face, Face::top);
  // with walls alone a corner is always at a wall
  EXPECT_EQ(at(placed(system_with(false, false, true), q), Site::b1).face, Face::right_wall);
  EXPECT_EQ(at(placed(s, q), Site::a1).phase, Phase::outside);
  EXPECT_FALSE(site_in_use(s, Site::a1));
  EXPECT_FALSE(is_called_for(s, Face::bottom));
  EXPECT_FALSE(is_called_for(s, Face::left_wall));
  EXPECT_TRUE(is_called_for(s, Face::top));
}

// Beside the slot there is no floor, unless the corner got there through the wall that it presses.
TEST(SiteRules, the_floor_is_touched_in_the_slot_and_through_its_walls) {
  const System s = system_with(false, true, true, true);
  const auto placed_at = [&](double corner_x) {
    const State q{corner_x - s.half_width, -s.floor_depth - 0.01 + s.base_distance, 0.0, 0, 0, 0};
    return placed(s, q);
  };
  const ContactStates within = placed_at(s.slot_half_width - 0.05);
  EXPECT_EQ(at(within, Site::b1).phase, Phase::outside);
  EXPECT_EQ(at(within, Site::b1_floor).phase, Phase::loaded);
  EXPECT_EQ(at(within, Site::b1_floor).face, Face::floor);
  // nearer to the wall than to the top surface
  const ContactStates behind = placed_at(s.slot_half_width + 0.3);
  EXPECT_EQ(at(behind, Site::b1).face, Face::right_wall);
  EXPECT_EQ(at(behind, Site::b1_floor).phase, Phase::loaded);
  EXPECT_EQ(at(behind, Site::b1_floor).face, Face::floor);
  // nearer to the top surface: below the floor's level, but in the base
  const ContactStates beside = placed_at(s.slot_half_width + 0.5);
  EXPECT_EQ(at(beside, Site::b1).face, Face::top);
  EXPECT_EQ(at(beside, Site::b1_floor).phase, Phase::free);
  EXPECT_EQ(at(beside, Site::b1_floor).face, Face::none);
}

// N = k d + h d' may be negative in a contact that lasts: then it carries nothing.
TEST(SiteRules, a_contact_that_opens_fast_starts_unloaded) {
  const System s = system_with(true, false, false);
  State q{0.2, s.base_distance - 1e-4, 0.0, 0, 0, 0};
  EXPECT_EQ(at(placed(s, q), Site::a1).phase, Phase::loaded);
  q.vy = 1e-4 * s.stiffness_y / s.damping_y * 0.99;
  EXPECT_EQ(at(placed(s, q), Site::a1).phase, Phase::loaded);
  q.vy *= 1.02;
  EXPECT_EQ(at(placed(s, q), Site::a1).phase, Phase::unloaded);
}

/// True where all limits of the face hold at the point.
bool within(const System& s, Face face, const Vec2& p, const Vec2& contact) {
  const Region limits = face_limits(s, face, contact);
  bool inside = true;
  for (int j = 0; j < limits.count; ++j) inside = inside && limits.conditions[j].value(p) > 0.0;
  return inside;
}

TEST(SiteRules, faces_end_where_the_bodies_do) {
  const System s = system_with(true, true, true, true);
  const double a = s.half_width, b = s.base_distance, l = s.slot_half_width, tiny = 1e-9;
  const auto edge = [&](Face face, double u, double w) { return within(s, face, {u, w}, {u, w}); };
  EXPECT_TRUE(edge(Face::bottom, a - tiny, -b + 0.01));
  EXPECT_FALSE(edge(Face::bottom, a + tiny, -b + 0.01));
  EXPECT_FALSE(edge(Face::bottom, -a - tiny, -b + 0.01));
  EXPECT_TRUE(edge(Face::right_side, a - 0.01, -b + tiny));
  EXPECT_FALSE(edge(Face::right_side, a - 0.01, -b - tiny));
  EXPECT_TRUE(edge(Face::left_side, -a + 0.01, 50.0));  // sides have no upper end
  EXPECT_FALSE(edge(Face::left_side, -a + 0.01, -b - tiny));
  // a corner on the top surface of its own side of the slot
  EXPECT_TRUE(within(s, Face::top, {l + tiny, -0.01}, {l + 0.1, -0.01}));
  EXPECT_FALSE(within(s, Face::top, {l - tiny, -0.01}, {l + 0.1, -0.01}));
  EXPECT_TRUE(within(s, Face::top, {-l - tiny, -0.01}, {-l - 0.1, -0.01}));
  EXPECT_FALSE(within(s, Face::top, {-l + tiny, -0.01}, {-l - 0.1, -0.01}));
  EXPECT_FALSE(within(s, Face::top, {50.0, -0.01}, {-l - 0.1, -0.01}));
  EXPECT_TRUE(within(s, Face::right_wall, {l + 0.01, -tiny}, {l + 0.01, -0.1}));
  EXPECT_FALSE(within(s, Face::right_wall, {l + 0.01, tiny}, {l + 0.01, -0.1}));
  EXPECT_EQ(face_limits(s, Face::floor, {0.0, -s.floor_depth - 0.01}).count, 0);
}

// The face named by a limit is the one through which the point is then outside: its condition of the region is what
// fails.
TEST(SiteRules, a_limit_names_the_condition_that_fails) {
  const System s = system_with(true, true, true, true);
  const auto expect_named = [&](Site site, int half, Face face, const Vec2& at_contact) {
    const Region limits = face_limits(s, face, at_contact), region = site_region(s, site, half);
    for (int j = 0; j < limits.count; ++j)
      for (int k = 0; k < region.count; ++k) {
        if (region.conditions[k].face != limits.conditions[j].face) continue;
        for (const Vec2& p : {Vec2{0.3, -0.2}, Vec2{-1.1, 0.4}, Vec2{0.77, -0.95}})
          EXPECT_EQ(region.conditions[k].value(p), limits.conditions[j].value(p));
      }
  };
  for (const Face face : {Face::bottom, Face::right_side, Face::left_side})
    expect_named(Site::a1, 0, face, {0.1, -0.9});
  for (const Face face : {Face::top, Face::right_wall}) expect_named(Site::b1, 0, face, {0.9, -0.01});
  for (const Face face : {Face::top, Face::left_wall}) expect_named(Site::b2, 1, face, {-0.9, -0.01});
}

// Inside by the region is inside by the depths of its faces.
TEST(SiteRules, conditions_of_a_region_are_the_depths_of_its_faces) {
  const System s = system_with(true, true, true, true);
  std::mt19937 random(42);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < kSiteCount; ++i) {
    const auto site = static_cast<Site>(i);
    for (int half = 0; half < region_count(site); ++half) {
      const Region region = site_region(s, site, half);
      for (int j = 0; j < region.count; ++j) {
        const Vec2 p{u(random), u(random)};
        EXPECT_NEAR(region.conditions[j].value(p), contact_frame(s, region.conditions[j].face).depth(p.x, p.y), 1e-16);
      }
    }
  }
}

}  // namespace
}  // namespace vibratory_alignment
