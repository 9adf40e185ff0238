// Kinematics of a contact against their definitions (MODEL.md "Contact"): depths from the bodies' outlines, d' as the
// rate of the depth, V as the velocity of the part's material point, V' at constant velocities; by finite differences.
#include "mechanics/contact_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "../support/random_state.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::random_state;

System test_system() {
  System system = make_system(test::scene_of(test::plain));
  system.has_floor = true;
  system.floor_depth = 0.41;
  return system;
}

const std::vector<std::pair<Site, Face>>& contacts() {
  static const std::vector<std::pair<Site, Face>> all = {
      {Site::a1, Face::bottom},      {Site::a1, Face::right_side}, {Site::a1, Face::left_side},
      {Site::a2, Face::bottom},      {Site::a2, Face::right_side}, {Site::a2, Face::left_side},
      {Site::b1, Face::top},         {Site::b1, Face::right_wall}, {Site::b1, Face::left_wall},
      {Site::b2, Face::top},         {Site::b2, Face::right_wall}, {Site::b2, Face::left_wall},
      {Site::b1_floor, Face::floor}, {Site::b2_floor, Face::floor}};
  return all;
}

/// The state after time t with constant velocities.
State later(State s, double t) {
  s.x += t * s.vx;
  s.y += t * s.vy;
  s.phi += t * s.omega;
  return s;
}

/// Rate of f at t = 0, fourth order.
template <class Function>
double rate(Function f) {
  const double h = 1e-3;
  return (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h);
}

constexpr double kRateError = 1e-10;

/// The depth from the outlines: along e1, e2 of the part for edges, along x, y for corners.
double outline_depth(const System& s, const State& q, Site site, Face face) {
  const double c = std::cos(q.phi), n = std::sin(q.phi);
  const bool right = site == Site::a1 || site == Site::b1 || site == Site::b1_floor;
  if (site == Site::a1 || site == Site::a2) {
    const double ax = right ? s.slot_half_width : -s.slot_half_width;
    const double along = (ax - q.x) * c + (0.0 - q.y) * n;  // (A - C).e1
    const double up = -(ax - q.x) * n + (0.0 - q.y) * c;    // (A - C).e2
    if (face == Face::bottom) return up + s.base_distance;  // above the bottom face
    return face == Face::right_side ? s.half_width - along : along + s.half_width;
  }
  const double a = right ? s.half_width : -s.half_width;
  const double bx = q.x + a * c + s.base_distance * n, by = q.y + a * n - s.base_distance * c;  // C +- a e1 - b e2
  switch (face) {
    case Face::right_wall: return bx - s.slot_half_width;
    case Face::left_wall: return -s.slot_half_width - bx;
    case Face::floor: return -s.floor_depth - by;
    default: return -by;
  }
}

/// The direction in which the base pushes (MODEL.md).
Vec2 push_direction(const State& q, Face face) {
  const double c = std::cos(q.phi), s = std::sin(q.phi);
  switch (face) {
    case Face::bottom: return {-s, c};       // e2
    case Face::right_side: return {-c, -s};  // -e1
    case Face::left_side: return {c, s};     // e1
    case Face::right_wall: return {-1.0, 0.0};
    case Face::left_wall: return {1.0, 0.0};
    default: return {0.0, 1.0};
  }
}

/// Where the material point of the part that is at `point` now will be after time t.
Vec2 carried(const State& q, const Vec2& point, double t) {
  const double rx = point.x - q.x, ry = point.y - q.y;
  const double c = std::cos(q.omega * t), s = std::sin(q.omega * t);
  return {q.x + t * q.vx + rx * c - ry * s, q.y + t * q.vy + rx * s + ry * c};
}

class ContactFrameOf : public testing::TestWithParam<std::pair<Site, Face>> {};
INSTANTIATE_TEST_SUITE_P(every_site_and_face, ContactFrameOf, testing::ValuesIn(contacts()));

TEST_P(ContactFrameOf, depth_is_that_of_the_outlines) {
  const auto [site, face] = GetParam();
  const System system = test_system();
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const double depth = outline_depth(system, q, site, face);
    EXPECT_NEAR(contact_kinematics(system, q, site, face).depth, depth, 4e-16);
    const Vec2 p = site_point(system, q, site);
    EXPECT_NEAR(contact_frame(system, face).depth(p.x, p.y), depth, 4e-16);
  }
}

TEST_P(ContactFrameOf, normal_is_the_direction_in_which_the_base_pushes) {
  const auto [site, face] = GetParam();
  const System system = test_system();
  std::mt19937 random(12);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const ContactKinematics k = contact_kinematics(system, q, site, face);
    const Vec2 n = push_direction(q, face);
    EXPECT_NEAR(k.normal.x, n.x, 1e-16);
    EXPECT_NEAR(k.normal.y, n.y, 1e-16);
    // t = n turned by -90 degrees
    EXPECT_EQ(k.tangent.x, k.normal.y);
    EXPECT_EQ(k.tangent.y, -k.normal.x);
    // along n the part gets out
    State out = q;
    out.x += 1e-6 * n.x;
    out.y += 1e-6 * n.y;
    EXPECT_NEAR(contact_kinematics(system, out, site, face).depth, k.depth - 1e-6, 1e-15);
  }
}

TEST_P(ContactFrameOf, depth_rate_is_the_rate_of_the_depth) {
  const auto [site, face] = GetParam();
  const System system = test_system();
  std::mt19937 random(13);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const double expected = rate([&](double t) { return outline_depth(system, later(q, t), site, face); });
    EXPECT_NEAR(contact_kinematics(system, q, site, face).depth_rate, expected, kRateError);
  }
}

TEST_P(ContactFrameOf, slip_velocity_is_that_of_the_material_point) {
  const auto [site, face] = GetParam();
  const System system = test_system();
  std::mt19937 random(14);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const ContactKinematics k = contact_kinematics(system, q, site, face);
    const Vec2 point{q.x + k.lever.x, q.y + k.lever.y};
    const double vx = rate([&](double t) { return carried(q, point, t).x; });
    const double vy = rate([&](double t) { return carried(q, point, t).y; });
    EXPECT_NEAR(k.slip_velocity, vx * k.tangent.x + vy * k.tangent.y, kRateError);
    EXPECT_NEAR(k.depth_rate, -(vx * k.normal.x + vy * k.normal.y), kRateError);
  }
}

// The series use V = -s (t.P)' with P the coordinates of the touching point in the body that it touches.
TEST_P(ContactFrameOf, slip_velocity_is_the_rate_of_the_foot) {
  const auto [site, face] = GetParam();
  const System system = test_system();
  const ContactFrame frame = contact_frame(system, face);
  std::mt19937 random(15);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const double foot_rate = rate([&, site = site](double t) {
      const Vec2 p = site_point(system, later(q, t), site);
      return frame.t1() * p.x + frame.t2() * p.y;
    });
    EXPECT_NEAR(contact_kinematics(system, q, site, face).slip_velocity, -frame.sign * foot_rate, kRateError);
  }
}

TEST_P(ContactFrameOf, slip_rate_is_that_of_a_motion_without_acceleration) {
  const auto [site, face] = GetParam();
  const System system = test_system();
  std::mt19937 random(16);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const double expected = rate([&, site = site, face = face](double t) {
      return contact_kinematics(system, later(q, t), site, face).slip_velocity;
    });
    EXPECT_NEAR(contact_kinematics(system, q, site, face).slip_rate, expected, kRateError);
  }
}

// k(n) = C1 n_y^2 + C2 n_x^2, h(n) alike.
TEST_P(ContactFrameOf, both_base_springs_are_projected_on_the_normal) {
  const auto [site, face] = GetParam();
  const System s = test_system();
  std::mt19937 random(17);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const Vec2 n = push_direction(q, face);
    const double c = std::cos(q.phi), sine = std::sin(q.phi);
    EXPECT_NEAR(stiffness_of(s, face, c, sine), s.stiffness_y * n.y * n.y + s.stiffness_x * n.x * n.x, 1e-11);
    EXPECT_NEAR(damping_of(s, face, c, sine), s.damping_y * n.y * n.y + s.damping_x * n.x * n.x, 1e-13);
  }
}

// The paper's V, with the lever b - d that the settled reading asks for.
TEST(ContactFrame, slip_on_the_bottom_face_has_the_lever_b_minus_d) {
  const System system = test_system();
  std::mt19937 random(18);
  for (int i = 0; i < 50; ++i) {
    const State q = random_state(random);
    const ContactKinematics k = contact_kinematics(system, q, Site::a1, Face::bottom);
    const double v = q.vx * std::cos(q.phi) + q.vy * std::sin(q.phi) + q.omega * (system.base_distance - k.depth);
    EXPECT_NEAR(k.slip_velocity, v, 2e-15);
  }
}

// Departure 1 of MODEL.md: a bottom-face force N on a part tilted counter-clockwise pushes to the left, -N sin phi.
TEST(ContactFrame, bottom_face_force_pushes_against_the_tilt) {
  const ContactKinematics k = contact_kinematics(test_system(), {0.2, 0.9, 0.1, 0, 0, 0}, Site::a1, Face::bottom);
  EXPECT_LT(k.normal.x, 0.0);
  EXPECT_GT(k.normal.y, 0.0);
  // on the right of C it turns the part counter-clockwise
  EXPECT_GT(k.lever.x * k.normal.y - k.lever.y * k.normal.x, 0.0);
}

TEST(ContactFrame, the_two_of_a_pair_mirror_each_other) {
  const System system = test_system();
  const std::pair<Site, Site> sites[] = {{Site::a1, Site::a2}, {Site::b1, Site::b2}, {Site::b1_floor, Site::b2_floor}};
  const auto mirrored_face = [](Face face) {
    switch (face) {
      case Face::right_side: return Face::left_side;
      case Face::left_side: return Face::right_side;
      case Face::right_wall: return Face::left_wall;
      case Face::left_wall: return Face::right_wall;
      default: return face;
    }
  };
  std::mt19937 random(19);
  for (const auto& [site, face] : contacts()) {
    const auto pair = sites[static_cast<int>(site) / 2];
    const Site twin = site == pair.first ? pair.second : pair.first;
    const State q = random_state(random);
    const ContactKinematics one = contact_kinematics(system, q, site, face);
    const ContactKinematics other =
        contact_kinematics(system, {-q.x, q.y, -q.phi, -q.vx, q.vy, -q.omega}, twin, mirrored_face(face));
    EXPECT_EQ(one.depth, other.depth);
    EXPECT_EQ(one.depth_rate, other.depth_rate);
    EXPECT_EQ(one.slip_velocity, -other.slip_velocity);
    EXPECT_EQ(one.slip_rate, -other.slip_rate);
  }
}

}  // namespace
}  // namespace vibratory_alignment
