// The power series of the motion must solve the equations of motion: at any time within the step its derivative is the
// right-hand side, built here from the contact kinematics (which have their own tests) at the state the series gives.
#include "solver/motion_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "../support/scenes.h"
#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

using test::plain;
using test::scene_of;

constexpr int kMotionOrder = 20;

struct Touch {
  Site site;
  Face face;
  Slip slip;
};

struct MotionCase {
  System system;
  DriveForms drives;
};

/// Soft base, so that a step is long enough for rounding not to blur the derivative.
MotionCase case_of(const std::vector<std::string>& settings = {}) {
  std::vector<std::string> all = {"base={stiffness: {x: 90, y: 130}, damping: {x: 1.1, y: 1.7}}", "weight=0.3"};
  all.insert(all.end(), settings.begin(), settings.end());
  MotionCase s{make_system(scene_of(plain, all)), {}};
  s.system.has_floor = true;
  s.system.floor_depth = 0.41;
  // one of each kind, one per direction
  DriveForm sine, line, chirp;
  sine.amplitude = 1.1;
  sine.frequency = 7.0;
  sine.sin_phase = std::sin(0.4);
  sine.cos_phase = std::cos(0.4);
  line.constant = 0.3;
  line.slope = -2.1;
  chirp = sine;
  chirp.amplitude = 0.7;
  chirp.rate = 3.0;
  s.drives.count = 3;
  s.drives.direction = {Direction::y, Direction::x, Direction::phi};
  s.drives.form = {sine, line, chirp};
  return s;
}

double drive_value(const DriveForm& f, double t) {
  const double angle = f.frequency * t + 0.5 * f.rate * t * t;
  return f.constant + f.slope * t + f.amplitude * (f.sin_phase * std::cos(angle) + f.cos_phase * std::sin(angle));
}

double derivative_at(const Series& series, int order, double t) {
  double value = 0.0;
  for (int k = order; k >= 1; --k) value = value * t + k * series[k];
  return value;
}

/// Places the contact's point inside its face and gives the state random velocities; N > 0.
State random_state(const System& system, const Touch& touch, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (;;) {
    State q{0.4 * u(random), 0.9 + 0.6 * u(random), 0.5 * u(random), 0.6 * u(random), 0.6 * u(random), u(random)};
    if (!system.x.moves) q.vx = 0.0;
    if (!system.phi.moves) q.omega = 0.0;
    const ContactKinematics k = contact_kinematics(system, q, touch.site, touch.face);
    // moved along the normal to a depth of 0.01 ... 0.05
    const double out = k.depth - (0.03 + 0.02 * u(random));
    q.x += out * k.normal.x;
    q.y += out * k.normal.y;
    const ContactKinematics now = contact_kinematics(system, q, touch.site, touch.face);
    const double c = std::cos(q.phi), s = std::sin(q.phi);
    if (stiffness_of(system, touch.face, c, s) * now.depth + damping_of(system, touch.face, c, s) * now.depth_rate >
        0.1)
      return q;
  }
}

/// Takes V out of a contact that is to stick.
State at_rest_along(const System& system, State q, const Touch& touch) {
  const ContactKinematics k = contact_kinematics(system, q, touch.site, touch.face);
  q.vx -= k.slip_velocity * k.tangent.x;
  q.vy -= k.slip_velocity * k.tangent.y;
  return q;
}

/// The step over which all series are cut off at 1e-15, as the solver takes it.
double step_of(const System& system, MotionSeries& series, Segment& g) {
  return std::min({series_step(system, g, 1e-15), pair_step(series.direction(g), g.order, 1e-15), 0.5});
}

/// Checks the segment's series against the equations of motion at times up to the step.
void expect_motion(const MotionCase& s, const Segment& g, double step, const std::vector<Touch>& touches) {
  const System& system = s.system;
  ASSERT_GT(step, 1e-5);
  for (const double share : {0.0, 0.31, 0.77}) {
    const double t = share * step;
    const State q = state_at(g, t);
    double fx = -system.x.stiffness * (q.x - system.x.anchor) - system.x.damping * q.vx;
    double fy = -(q.y - system.y.anchor) - system.y.damping * q.vy - system.weight;
    double m = -system.phi.stiffness * (q.phi - system.phi.anchor) - system.phi.damping * q.omega;
    for (int i = 0; i < s.drives.count; ++i) {
      const double value = drive_value(s.drives.form[i], t);
      (s.drives.direction[i] == Direction::x ? fx : s.drives.direction[i] == Direction::y ? fy : m) += value;
    }
    double size = 1.0 + std::abs(fx) + std::abs(fy) + std::abs(m);
    ASSERT_EQ(g.loaded_count, static_cast<int>(touches.size()));
    for (const Touch& touch : touches) {
      const ContactSeries* series = nullptr;
      for (int i = 0; i < g.loaded_count; ++i)
        if (g.loaded[i].site == touch.site) series = &g.loaded[i];
      ASSERT_NE(series, nullptr);
      const ContactKinematics k = contact_kinematics(system, q, touch.site, touch.face);
      // the law
      const double c = std::cos(q.phi), sine = std::sin(q.phi), f = system.friction;
      const double n =
          stiffness_of(system, touch.face, c, sine) * k.depth + damping_of(system, touch.face, c, sine) * k.depth_rate;
      double tangential = 0.0;
      switch (touch.slip) {
        case Slip::plus: tangential = -f * n; break;
        case Slip::minus: tangential = f * n; break;
        case Slip::regularized: tangential = -f * n * std::tanh(k.slip_velocity / system.regularization); break;
        case Slip::stick:  // found by the series; what it must do is keep V = 0
          tangential = value_at(series->tangential_force, g.order - 1, t);
          EXPECT_NEAR(k.slip_velocity, 0.0, 1e-13) << "t = " << t;
          break;
        default: break;
      }
      const double digits = 1e-12 * (1.0 + std::abs(n));
      EXPECT_NEAR(value_at(series->depth, g.order, t), k.depth, 1e-14);
      EXPECT_NEAR(value_at(series->normal_force, g.order, t), n, digits);
      EXPECT_NEAR(value_at(series->tangential_force, g.order - 1, t), tangential, 1e-10 * (1.0 + std::abs(n)));
      EXPECT_NEAR(value_at(series->slip_velocity, g.order, t), k.slip_velocity, 1e-13);
      const double px = n * k.normal.x + tangential * k.tangent.x, py = n * k.normal.y + tangential * k.tangent.y;
      fx += px;
      fy += py;
      m += k.lever.x * py - k.lever.y * px;
      size += std::abs(n);
    }
    // truncation: the last terms of the velocities, 1e-15 of the leading ones, times order / step
    const double speed = 1.0 + std::abs(q.vx) + std::abs(q.vy) + std::abs(q.omega);
    const double error = 1e-13 * size + 1e-14 * kMotionOrder * speed / step;
    EXPECT_NEAR(derivative_at(g.vx, g.order, t), fx * system.x.inverse_inertia, error);
    EXPECT_NEAR(derivative_at(g.vy, g.order, t), fy * system.y.inverse_inertia, error);
    EXPECT_NEAR(derivative_at(g.omega, g.order, t), m * system.phi.inverse_inertia, error * system.phi.inverse_inertia);
    EXPECT_NEAR(derivative_at(g.x, g.order + 1, t), q.vx, 1e-13);
    EXPECT_NEAR(derivative_at(g.y, g.order + 1, t), q.vy, 1e-13);
    EXPECT_NEAR(derivative_at(g.phi, g.order + 1, t), q.omega, 1e-13);
    EXPECT_NEAR(value_at(g.cos_phi, g.order, t), std::cos(q.phi), 1e-14);
    EXPECT_NEAR(value_at(g.sin_phi, g.order, t), std::sin(q.phi), 1e-14);
  }
}

void expect_contacts(const MotionCase& s, const State& start, const std::vector<Touch>& touches) {
  MotionSeries series(s.system);
  Segment segment;
  for (const Touch& touch : touches)
    segment.contacts[static_cast<std::size_t>(touch.site)] = {Phase::loaded, touch.face, touch.slip};
  series.expand_contact(start, s.drives, kMotionOrder, segment);
  expect_motion(s, segment, step_of(s.system, series, segment), touches);
}

const std::vector<std::pair<Site, Face>>& places() {
  static const std::vector<std::pair<Site, Face>> all = {{Site::a1, Face::bottom},    {Site::a1, Face::right_side},
                                                         {Site::a2, Face::left_side}, {Site::a2, Face::bottom},
                                                         {Site::b1, Face::top},       {Site::b1, Face::right_wall},
                                                         {Site::b2, Face::left_wall}, {Site::b2_floor, Face::floor}};
  return all;
}

class MotionSeriesAt : public testing::TestWithParam<std::pair<Site, Face>> {
 protected:
  void expect(Slip slip, const std::vector<std::string>& settings = {}) {
    const MotionCase s = case_of(settings);
    const Touch touch{GetParam().first, GetParam().second, slip};
    std::mt19937 random(71);
    for (int i = 0; i < 10; ++i) {
      State start = random_state(s.system, touch, random);
      if (slip == Slip::stick) start = at_rest_along(s.system, start, touch);
      expect_contacts(s, start, {touch});
      if (HasFailure()) return;
    }
  }
};
INSTANTIATE_TEST_SUITE_P(every_face, MotionSeriesAt, testing::ValuesIn(places()));

TEST_P(MotionSeriesAt, without_friction) { expect(Slip::none, {"friction=null"}); }
TEST_P(MotionSeriesAt, slips_forward) { expect(Slip::plus); }
TEST_P(MotionSeriesAt, slips_backward) { expect(Slip::minus); }
TEST_P(MotionSeriesAt, sticks) { expect(Slip::stick); }
TEST_P(MotionSeriesAt, with_regularised_friction) { expect(Slip::regularized, {"friction.regularization=0.5"}); }
TEST_P(MotionSeriesAt, on_an_isotropic_base) {
  const std::string base = "base={stiffness: {y: 130}, damping: {y: 1.7}}";
  for (const Slip slip : {Slip::plus, Slip::minus, Slip::stick}) expect(slip, {base});
  expect(Slip::none, {base, "friction=null"});
  expect(Slip::regularized, {base, "friction.regularization=0.5"});
}
TEST_P(MotionSeriesAt, on_an_isotropic_base_with_a_locked_tilt) {
  const std::string base = "base={stiffness: {y: 130}, damping: {y: 1.7}}", locked = "part.inertia=null",
                    tilted = "initial.phi=0.02";
  for (const Slip slip : {Slip::plus, Slip::stick}) expect(slip, {base, locked, tilted});
  expect(Slip::regularized, {base, locked, tilted, "friction.regularization=0.5"});
}
TEST_P(MotionSeriesAt, with_locked_motions) {
  expect(Slip::stick, {"part.inertia=null", "initial.phi=0.02"});
  expect(Slip::minus, {"gripper.stiffness.x=null"});
}

// With everything fixed but y there is nothing that T could do; with a locked x the tilt alone keeps V = 0.
TEST(MotionSeries, sticks_by_the_tilt_alone) {
  const MotionCase s = case_of({"gripper.stiffness.x=null"});
  std::mt19937 random(72);
  const Touch touch{Site::a1, Face::bottom, Slip::stick};
  for (int i = 0; i < 10; ++i) {
    State start = random_state(s.system, touch, random);
    start.vx = 0.0;
    const ContactKinematics k = contact_kinematics(s.system, start, touch.site, touch.face);
    start.omega -= k.slip_velocity / (k.lever.x * k.tangent.y - k.lever.y * k.tangent.x);
    expect_contacts(s, start, {touch});
  }
}

/// A state in which two contacts are loaded: Newton on the two depths with x and y.
State wedged(const System& system, const Touch& a, const Touch& b, double phi, std::mt19937& random) {
  std::uniform_real_distribution<double> u(0.02, 0.05), v(-0.1, 0.1);
  const double wanted_a = u(random), wanted_b = u(random);
  State q{0.0, 0.9, phi, 0, 0, 0};
  for (int i = 0; i < 50; ++i) {
    const ContactKinematics ka = contact_kinematics(system, q, a.site, a.face),
                            kb = contact_kinematics(system, q, b.site, b.face);
    const double ra = ka.depth - wanted_a, rb = kb.depth - wanted_b;
    const double det = ka.normal.x * kb.normal.y - ka.normal.y * kb.normal.x;
    q.x += (ra * kb.normal.y - rb * ka.normal.y) / det;
    q.y += (rb * ka.normal.x - ra * kb.normal.x) / det;
  }
  q.vx = v(random);
  q.vy = v(random);
  q.omega = v(random);
  return q;
}

TEST(MotionSeries, two_contacts_that_stick) {
  const MotionCase s = case_of();
  const Touch a{Site::a1, Face::bottom, Slip::stick}, b{Site::a2, Face::left_side, Slip::stick};
  std::mt19937 random(73);
  for (int i = 0; i < 10; ++i) {
    State start = wedged(s.system, a, b, 0.2 + 0.02 * i, random);
    // both V out: two of the three velocities follow from the third
    const ContactKinematics ka = contact_kinematics(s.system, start, a.site, a.face);
    const ContactKinematics kb = contact_kinematics(s.system, start, b.site, b.face);
    const double det = ka.tangent.x * kb.tangent.y - ka.tangent.y * kb.tangent.x;
    start.vx -= (ka.slip_velocity * kb.tangent.y - kb.slip_velocity * ka.tangent.y) / det;
    start.vy -= (kb.slip_velocity * ka.tangent.x - ka.slip_velocity * kb.tangent.x) / det;
    expect_contacts(s, start, {a, b});
  }
}

TEST(MotionSeries, one_sticks_while_the_other_slips) {
  const MotionCase s = case_of();
  const Touch a{Site::a1, Face::bottom, Slip::stick}, b{Site::a2, Face::left_side, Slip::plus};
  std::mt19937 random(74);
  for (int i = 0; i < 10; ++i)
    expect_contacts(s, at_rest_along(s.system, wedged(s.system, a, b, 0.2 + 0.02 * i, random), a), {a, b});
}

// The side of a part that leans by 1e-4 has 1e-8 of the damping along the other axis. N is k d + h d' to the last digit
// though h is 1e-8 of what it is made of.
TEST(MotionSeries, a_side_that_hardly_leans_into_a_strong_damper) {
  const MotionCase s = case_of({"base={stiffness: {x: 90, y: 130}, damping: {x: 0, y: 1e7}}", "friction=null"});
  Segment g;
  g.contacts[static_cast<std::size_t>(Site::a2)] = {Phase::loaded, Face::left_side, Slip::none};
  MotionSeries series(s.system);
  for (const double tilt : {1e-4, 3.1e-5, -2.3e-6}) {
    const State start{0.05, 0.7, tilt, -1e4, 0.0, 0.0};
    series.expand_contact(start, s.drives, kMotionOrder, g);
    const ContactKinematics k = contact_kinematics(s.system, start, Site::a2, Face::left_side);
    const double sine = std::sin(tilt), cosine = std::cos(tilt);
    const double force = (90.0 * cosine * cosine + 130.0 * sine * sine) * k.depth + 1e7 * sine * sine * k.depth_rate;
    EXPECT_NEAR(g.loaded[0].normal_force[0], force, 1e-14 * std::abs(force)) << tilt;
  }
}

/// Asks for so many powers more, in two turns.
struct GoesOn : OrderChoice {
  int turns = 0;
  int next_order(const Segment& segment) override {
    return ++turns == 1 ? segment.order + 2 : turns == 2 ? kMotionOrder : 0;
  }
};

void expect_equal(const Series& a, const Series& b, int order) {
  for (int k = 0; k <= order; ++k) EXPECT_EQ(a[k], b[k]) << "power " << k;
}

// Series that are asked for more powers while they are made are those that would have been made at once.
void expect_the_same_in_turns(const MotionCase& s, const State& start, const std::vector<Touch>& touches) {
  Segment at_once, in_turns;
  for (const Touch& touch : touches)
    at_once.contacts[static_cast<std::size_t>(touch.site)] = {Phase::loaded, touch.face, touch.slip};
  in_turns.contacts = at_once.contacts;
  MotionSeries series(s.system), other(s.system);
  series.expand_contact(start, s.drives, kMotionOrder, at_once);
  GoesOn choice;
  other.expand_contact(start, s.drives, kMotionOrder - 7, in_turns, &choice);
  EXPECT_EQ(choice.turns, 3);
  ASSERT_EQ(in_turns.order, kMotionOrder);
  expect_equal(in_turns.vx, at_once.vx, kMotionOrder);
  expect_equal(in_turns.vy, at_once.vy, kMotionOrder);
  expect_equal(in_turns.omega, at_once.omega, kMotionOrder);
  for (int i = 0; i < at_once.loaded_count; ++i) {
    expect_equal(in_turns.loaded[i].normal_force, at_once.loaded[i].normal_force, kMotionOrder);
    expect_equal(in_turns.loaded[i].tangential_force, at_once.loaded[i].tangential_force, kMotionOrder);
    expect_equal(in_turns.loaded[i].slip_velocity, at_once.loaded[i].slip_velocity, kMotionOrder);
  }
  for (const Site site : {Site::a1, Site::b2})
    for (int k = 0; k <= kMotionOrder; ++k)
      for (int i : {0, 1}) EXPECT_EQ(other.point(site, in_turns)[k][i], series.point(site, at_once)[k][i]) << k;
}

TEST_P(MotionSeriesAt, in_turns) {
  const std::string isotropic = "base={stiffness: {y: 130}, damping: {y: 1.7}}";
  for (const std::vector<std::string>& settings : {std::vector<std::string>{}, {isotropic}}) {
    const MotionCase s = case_of(settings);
    std::mt19937 random(79);
    for (const Slip slip : {Slip::plus, Slip::stick}) {
      const Touch touch{GetParam().first, GetParam().second, slip};
      const State start = random_state(s.system, touch, random);
      expect_the_same_in_turns(s, slip == Slip::stick ? at_rest_along(s.system, start, touch) : start, {touch});
    }
  }
}

TEST(MotionSeries, two_contacts_in_turns) {
  const Touch wall{Site::b1, Face::right_wall, Slip::plus}, floor{Site::b1_floor, Face::floor, Slip::minus};
  std::mt19937 random(80);
  const MotionCase s = case_of();
  expect_the_same_in_turns(s, wedged(s.system, wall, floor, 0.05, random), {wall, floor});
}

TEST(MotionSeries, wall_and_floor_at_once) {
  const MotionCase s = case_of();
  const Touch wall{Site::b1, Face::right_wall, Slip::plus}, floor{Site::b1_floor, Face::floor, Slip::minus};
  std::mt19937 random(75);
  for (int i = 0; i < 10; ++i) expect_contacts(s, wedged(s.system, wall, floor, 0.05, random), {wall, floor});
}

TEST(MotionSeries, edge_and_corner_at_once) {
  const MotionCase s = case_of({"friction.regularization=0.5"});
  const Touch edge{Site::a1, Face::bottom, Slip::regularized}, corner{Site::b1, Face::top, Slip::regularized};
  std::mt19937 random(76);
  for (int i = 0; i < 10; ++i) {
    State start = random_state(s.system, edge, random);
    start.phi = -0.001 * i;
    start.y = s.system.base_distance - 0.03;
    expect_contacts(s, start, {edge, corner});
  }
}

TEST(MotionSeries, flight) {
  const MotionCase s = case_of();
  std::mt19937 random(77);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 10; ++i) {
    MotionSeries series(s.system);
    Segment segment;
    series.expand_free({u(random), u(random), u(random), u(random), u(random), u(random)}, s.drives, kMotionOrder,
                       segment);
    expect_motion(s, segment, step_of(s.system, series, segment), {});
    if (testing::Test::HasFailure()) return;
  }
}

// Points and the force that would load again, in flight.
TEST(MotionSeries, points_and_push_of_an_unloaded_contact) {
  const MotionCase s = case_of();
  std::mt19937 random(78);
  for (const auto& [site, face] : places()) {
    const State start = random_state(s.system, {site, face, Slip::none}, random);
    MotionSeries series(s.system);
    Segment g;
    series.expand_free(start, s.drives, kMotionOrder, g);
    const auto& point = series.point(site, g);
    const ContactFrame frame = contact_frame(s.system, face);
    Series depth{}, push{};
    for (int k = 0; k <= g.order; ++k) depth[k] = frame.sign * (frame.n1 * point[k][0] + frame.n2 * point[k][1]);
    depth[0] += frame.offset;
    series.push_series(g, face, depth, push);
    const double step = std::min({step_of(s.system, series, g), pair_step(point, g.order, 1e-15), 0.1});
    for (const double share : {0.0, 0.4, 0.9}) {
      const State q = state_at(g, share * step);
      const ContactKinematics k = contact_kinematics(s.system, q, site, face);
      const double c = std::cos(q.phi), n = std::sin(q.phi);
      EXPECT_NEAR(value_at(depth, g.order, share * step), k.depth, 1e-14);
      EXPECT_NEAR(value_at(push, g.order - 1, share * step),
                  stiffness_of(s.system, face, c, n) * k.depth + damping_of(s.system, face, c, n) * k.depth_rate,
                  1e-11);
    }
  }
}

}  // namespace
}  // namespace vibratory_alignment
