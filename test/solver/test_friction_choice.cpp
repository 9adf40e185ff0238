// The decision at V = 0: whatever FrictionChoice decides, the motion that follows must obey Coulomb's law, and its V'
// must be that of another method, since V' is unique. Where forces begin at zero or balance exactly, closed forms tell.
#include "solver/friction_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/friction_problem.h"
#include "../support/scenes.h"
#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

using test::friction_problem;
using test::FrictionProblem;
using test::Touch;
using test::touch_point;
using test::TouchPoint;

constexpr int kSeriesOrder = 16;

/// Truncation error of the steps that lead to a decision.
constexpr double kTolerance = 1e-11;

/// A soft base without damping, so that N = k d of a state at rest.
System soft_system(const std::vector<std::string>& settings = {}) {
  std::vector<std::string> all = {"base={stiffness: {x: 90, y: 130}}", "initial={x: 0.21, y: 0.95, phi: 0.0}"};
  all.insert(all.end(), settings.begin(), settings.end());
  System system = make_system(test::scene_of(test::plain, all));
  system.has_floor = true;
  return system;
}

DriveForms force(Direction direction, double constant, double slope = 0.0) {
  DriveForms drives;
  drives.count = 1;
  drives.direction[0] = direction;
  drives.form[0] = {};
  drives.form[0].constant = constant;
  drives.form[0].slope = slope;
  return drives;
}

/// What is decided for contacts at rest, and the motion that follows from it.
struct Decision {
  Decision(const System& system, const State& state, const DriveForms& drives, const std::vector<Touch>& touches,
           const Pins& pins = {}, double tolerance = kTolerance, bool unmoved = false) {
    SiteFlags at_rest{};
    for (const Touch& touch : touches) {
      mode.contacts[static_cast<std::size_t>(touch.site)] = {Phase::loaded, touch.face, Slip::none};
      at_rest[static_cast<std::size_t>(touch.site)] = true;
    }
    mode.pins = pins;
    FrictionChoice(system, tolerance).decide(state, drives, at_rest, mode, unmoved);
    MotionSeries series(system);
    motion.contacts = mode.contacts;
    series.expand_contact(state, drives, kSeriesOrder, motion);
    step =
        std::min({1.0, series_step(system, motion, 1e-15), pair_step(series.direction(motion), kSeriesOrder, 1e-15)});
  }

  Slip slip(Site site) const { return mode.contacts[static_cast<std::size_t>(site)].slip; }
  const SitePins& pins(Site site) const { return mode.pins[static_cast<std::size_t>(site)]; }

  const ContactSeries& series(Site site) const {
    int i = 0;
    while (motion.loaded[static_cast<std::size_t>(i)].site != site) ++i;
    return motion.loaded[static_cast<std::size_t>(i)];
  }
  double tangential_force(Site site, double t = 0.0) const {
    return value_at(series(site).tangential_force, kSeriesOrder - 1, t);
  }

  ContactMode mode;
  Segment motion;
  double step = 0.0;
};

/// Coulomb's law at time t of the motion: N, V by the model, T by the motion itself.
void expect_law(const System& system, const Decision& d, const Touch& touch, double t) {
  const TouchPoint p = touch_point(system, state_at(d.motion, t), touch);
  const double most = system.friction * p.normal_force, tangential = d.tangential_force(touch.site, t);
  const double digits = 1e-12 * (1.0 + most), still = 1e-15;
  EXPECT_GE(p.normal_force, 0.0);
  switch (d.slip(touch.site)) {
    case Slip::stick:
      EXPECT_LE(std::abs(tangential), most + digits) << "t = " << t;
      EXPECT_NEAR(p.slip, 0.0, still) << "t = " << t;
      break;
    case Slip::plus:
      EXPECT_NEAR(tangential, -most, digits) << "t = " << t;
      EXPECT_GE(p.slip, -still) << "t = " << t;
      break;
    case Slip::minus:
      EXPECT_NEAR(tangential, most, digits) << "t = " << t;
      EXPECT_LE(p.slip, still) << "t = " << t;
      break;
    default: ADD_FAILURE() << "nothing was decided";
  }
}

// ---------------------------------------------------------------------------------------------- random states at rest

struct ChoiceCase {
  std::string name;
  std::vector<Touch> touches;
};

std::ostream& operator<<(std::ostream& out, const ChoiceCase& c) { return out << c.name; }

const std::vector<ChoiceCase>& cases() {
  static const Touch edge{Site::a1, Face::bottom}, other_edge{Site::a2, Face::bottom}, side{Site::a2, Face::left_side};
  static const Touch corner{Site::b1, Face::top}, wall{Site::b1, Face::right_wall},
      other_wall{Site::b2, Face::left_wall};
  static const Touch floor{Site::b1_floor, Face::floor}, other_floor{Site::b2_floor, Face::floor};
  static const std::vector<ChoiceCase> all = {
      {"edge", {edge}},
      {"side", {side}},
      {"corner", {corner}},
      {"wall", {wall}},
      {"two_edges", {edge, other_edge}},
      {"edge_and_side", {edge, side}},
      {"edge_and_corner", {edge, corner}},
      {"edge_and_wall", {edge, other_wall}},
      {"wall_and_floor", {wall, floor}},
      {"both_corners_on_the_floor", {floor, other_floor}},
      {"wall_and_both_on_the_floor", {wall, floor, other_floor}},
      {"edge_side_and_wall", {edge, side, other_wall}},
      {"edge_and_both_corners", {edge, corner, {Site::b2, Face::top}}},
      {"edge_side_and_both_on_the_floor", {edge, side, floor, other_floor}},
  };
  return all;
}

/// A state at rest in which all contacts carry load; flat in a part of the cases, so that contacts hold the same
/// motion.
State random_state(System& system, const std::vector<Touch>& touches, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (;;) {
    const double phi = u(random) > 0.5 ? 0.0 : 0.3 * u(random);
    const State q{0.9 * u(random), 0.5 + 0.6 * u(random), phi, 0, 0, 0};
    system.floor_depth = 0.4 + 0.4 * u(random);
    bool loaded = true;
    for (const Touch& touch : touches) loaded = loaded && touch_point(system, q, touch).depth > 1e-3;
    if (loaded) return q;
  }
}

/// Forces of the size of the friction, in all directions.
DriveForms random_drives(double size, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  DriveForms drives;
  for (const Direction direction : {Direction::x, Direction::y, Direction::phi}) {
    const auto i = static_cast<std::size_t>(drives.count++);
    drives.direction[i] = direction;
    DriveForm& form = drives.form[i] = {};
    form.constant = size * u(random);
    form.slope = size * u(random);
    form.amplitude = size * u(random);
    form.frequency = 7.0;
    form.sin_phase = std::sin(0.4);
    form.cos_phase = std::cos(0.4);
  }
  return drives;
}

class FrictionChoiceOf : public testing::TestWithParam<ChoiceCase> {
 protected:
  /// How often contacts stuck and slid.
  int stuck_ = 0, slid_ = 0;

  void expect_the_law(System system, int problems, unsigned seed) {
    const std::vector<Touch>& touches = GetParam().touches;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0.05, 1.0);
    for (int i = 0; i < problems && !HasFailure(); ++i) {
      SCOPED_TRACE("problem " + std::to_string(i));
      system.friction = u(random);
      if (system.phi.moves) system.phi.inverse_inertia = 1.0 / (system.phi.inertia = u(random));
      const State q = random_state(system, touches, random);
      double size = 0.0;
      for (const Touch& touch : touches)
        size += 2.0 * u(random) * system.friction * touch_point(system, q, touch).normal_force;
      expect_the_law(system, q, random_drives(size, random));
    }
  }

 private:
  void expect_the_law(const System& system, const State& q, const DriveForms& drives) {
    const std::vector<Touch>& touches = GetParam().touches;
    const Decision d(system, q, drives, touches);
    const FrictionProblem problem = friction_problem(system, q, drives, touches);
    const FrictionProblem::Vector expected = problem.true_rates();
    FrictionProblem::Vector force{};
    double size = 1.0;
    for (std::size_t i = 0; i < touches.size(); ++i) {
      force[i] = d.tangential_force(touches[i].site);
      size += std::abs(problem.drift[i]);
    }
    const FrictionProblem::Vector of_forces = problem.rates(force);
    for (std::size_t i = 0; i < touches.size(); ++i) {
      const TouchPoint p = touch_point(system, q, touches[i]);
      const double rate = p.tx * d.motion.vx[1] + p.ty * d.motion.vy[1] + p.tangent_moment() * d.motion.omega[1];
      EXPECT_NEAR(rate, of_forces[i], 1e-11 * size);
      EXPECT_NEAR(rate, expected[i], 1e-7 * size);
      const double digits = 1e-11 * (1.0 + problem.limit[i]), still = 1e-11 * size;
      EXPECT_LE(std::abs(force[i]), problem.limit[i] + digits);
      switch (d.slip(touches[i].site)) {
        case Slip::stick:
          EXPECT_NEAR(rate, 0.0, still);
          ++stuck_;
          break;
        case Slip::plus:
          EXPECT_NEAR(force[i], -problem.limit[i], digits);
          EXPECT_GE(rate, -still);
          ++slid_;
          break;
        case Slip::minus:
          EXPECT_NEAR(force[i], problem.limit[i], digits);
          EXPECT_LE(rate, still);
          ++slid_;
          break;
        default: ADD_FAILURE() << "nothing was decided";
      }
      // and a moment later
      expect_law(system, d, touches[i], 1e-5 * d.step);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(contacts, FrictionChoiceOf, testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

TEST_P(FrictionChoiceOf, gives_the_motion_that_the_law_allows) {
  expect_the_law(soft_system(), 200, 31);
  EXPECT_GT(stuck_, 20);
  EXPECT_GT(slid_, 20);
}

TEST_P(FrictionChoiceOf, gives_it_with_the_tilt_locked) { expect_the_law(soft_system({"part.inertia=null"}), 100, 32); }

TEST_P(FrictionChoiceOf, gives_it_with_x_locked) { expect_the_law(soft_system({"gripper.stiffness.x=null"}), 100, 33); }

TEST_P(FrictionChoiceOf, gives_it_with_y_alone) {
  expect_the_law(soft_system({"gripper.stiffness.x=null", "part.inertia=null"}), 100, 34);
}

// ------------------------------------------------------------------------------------------- forces that begin at zero

const Touch edge{Site::a1, Face::bottom};

/// Comes down flat on the edge with speed 1 and touches now, the gripper's x and tilt relaxed: N = k t.
struct TouchingNow {
  explicit TouchingNow(const std::vector<std::string>& settings = {}) : system(soft_system(settings)) {
    system.x.anchor = q.x = 0.21;
    system.phi.anchor = 0.0;
    q.y = system.base_distance;
    q.vy = -1.0;
    pins[static_cast<std::size_t>(Site::a1)].normal = 1;
  }
  Decision decide(const DriveForms& drives) const { return Decision(system, q, drives, {edge}, pins); }

  System system;
  State q;
  Pins pins;
};

// N below zero by its last digits: friction would push the part on whichever way it slides. What is decided has to be
// the same for the mirror image, and V' to grow that way (hunt: wild seed 594748).
TEST(FrictionChoice, where_friction_pushes_either_way_the_mirror_image_is_decided_alike) {
  System right = soft_system({"part.inertia=null"}), left = right;
  const State at_right{0.21, right.base_distance + 1e-6, 0, 0, 0, 0}, at_left{-at_right.x, at_right.y, 0, 0, 0, 0};
  right.x.anchor = at_right.x;
  left.x.anchor = at_left.x;
  const Touch edge{Site::a1, Face::bottom}, mirrored{Site::a2, Face::bottom};
  const double friction = -right.friction * touch_point(right, at_right, edge).normal_force;
  ASSERT_GT(friction, 0.0);
  for (const double share : {0.9, 0.3, -0.3, -0.9}) {
    const Decision d = Decision(right, at_right, force(Direction::x, share * friction), {edge}),
                   image = Decision(left, at_left, force(Direction::x, -share * friction), {mirrored});
    const Slip slip = d.slip(Site::a1);
    ASSERT_TRUE(slip == Slip::plus || slip == Slip::minus) << share;
    EXPECT_EQ(image.slip(Site::a2), slip == Slip::plus ? Slip::minus : Slip::plus) << share;
    const double rate = d.series(Site::a1).slip_velocity[1];
    EXPECT_GT(slip == Slip::plus ? rate : -rate, 0.0) << share;
    EXPECT_EQ(image.series(Site::a2).slip_velocity[1], -rate) << share;
  }
}

// Locked tilt: x' holds still against a force s t while |s| t <= f k t. (Just beyond that higher powers soon matter.)
TEST(FrictionChoice, at_a_touch_without_damping_the_growth_of_the_forces_decides) {
  const TouchingNow part({"part.inertia=null"});
  const double critical = part.system.friction * part.system.stiffness_y;
  for (const double sign : {1.0, -1.0})
    for (const double share : {0.0, 0.5, 1.0 - 1e-9}) {
      const Decision d = part.decide(force(Direction::x, 0.0, sign * share * critical));
      EXPECT_EQ(d.slip(Site::a1), Slip::stick) << sign * share;
      EXPECT_NEAR(d.tangential_force(Site::a1, 1e-3), -sign * share * critical * 1e-3, 1e-12 * critical);
      if (std::abs(share - 1.0) > 0.1) expect_law(part.system, d, edge, 1e-3 * d.step);
    }
  for (const double sign : {1.0, -1.0})
    for (const double share : {1.0 + 1e-9, 2.0}) {
      const Decision d = part.decide(force(Direction::x, 0.0, sign * share * critical));
      EXPECT_EQ(d.slip(Site::a1), sign > 0.0 ? Slip::plus : Slip::minus) << sign * share;
      // V = (s - f k) t^2/2
      EXPECT_EQ(d.pins(Site::a1).slip, 2);
      EXPECT_NEAR(d.series(Site::a1).slip_velocity[2], sign * 0.5 * (share - 1.0) * critical, 1e-12 * critical);
      if (std::abs(share - 1.0) > 0.1) expect_law(part.system, d, edge, 1e-3 * d.step);
    }
}

TEST(FrictionChoice, at_a_touch_without_damping_a_force_that_is_there_already_wins) {
  const TouchingNow part({"part.inertia=null"});
  for (const double sign : {1.0, -1.0})
    for (const double size : {1e-6, 1.0}) {
      const Decision d = part.decide(force(Direction::x, sign * size));
      EXPECT_EQ(d.slip(Site::a1), sign > 0.0 ? Slip::plus : Slip::minus);
      EXPECT_EQ(d.pins(Site::a1).slip, 1);
    }
}

// A force that grows as t^2 is held, however large it will be: 1 - cos.
TEST(FrictionChoice, at_a_touch_without_damping_a_force_that_comes_later_loses) {
  const TouchingNow part({"part.inertia=null"});
  DriveForms late = force(Direction::x, 100.0);
  late.form[0].amplitude = -100.0;
  late.form[0].frequency = 2.0;
  late.form[0].sin_phase = 1.0;
  late.form[0].cos_phase = 0.0;
  const Decision d = part.decide(late);
  EXPECT_EQ(d.slip(Site::a1), Slip::stick);
  EXPECT_EQ(d.pins(Site::a1).hold_plus, 1);
  EXPECT_EQ(d.pins(Site::a1).hold_minus, 1);
  expect_law(part.system, d, edge, 1e-3 * d.step);
}

// Free tilt: N itself turns the part and drives V' = b r_x N/mu, T takes it back with G = 1 + b^2/mu. Both grow alike,
// so that it sticks for f >= (b r_x/mu)/(1 + b^2/mu).
TEST(FrictionChoice, at_a_flat_landing_the_lever_decides) {
  TouchingNow part;
  const double mu = part.system.phi.inertia, b = part.system.base_distance;
  const double critical = b * (part.system.slot_half_width - part.q.x) / (mu + b * b);
  for (const double share : {0.3, 1.0 - 1e-9}) {
    part.system.friction = share * critical;
    const Decision d = part.decide({});
    EXPECT_EQ(d.slip(Site::a1), Slip::plus) << share;
    EXPECT_EQ(d.pins(Site::a1).slip, 2);
    if (std::abs(share - 1.0) > 0.1) expect_law(part.system, d, edge, 1e-3 * d.step);
  }
  for (const double share : {1.0 + 1e-9, 1.5}) {
    part.system.friction = share * critical;
    const Decision d = part.decide({});
    EXPECT_EQ(d.slip(Site::a1), Slip::stick) << share;
    EXPECT_NEAR(d.series(Site::a1).tangential_force[1], -critical * part.system.stiffness_y, 1e-11);
    if (std::abs(share - 1.0) > 0.1) expect_law(part.system, d, edge, 1e-3 * d.step);
  }
}

// ------------------------------------------------------------------------------------------------- forces that balance

/// At rest on the edge with locked tilt, its springs relaxed but for the load N on the edge.
struct AtRest {
  AtRest() : system(soft_system({"part.inertia=null"})) {
    q = {0.21, system.base_distance - 0.02, 0.0, 0, 0, 0};
    system.x.anchor = q.x;
    load = touch_point(system, q, edge).normal_force;
    system.y.anchor = q.y - load;
  }
  System system;
  State q;
  double load = 0.0;
};

// An event has found T at +-f N, to the last digits or to what a step has cut off: from there on only its growth
// counts.
TEST(FrictionChoice, at_its_limit_a_contact_slides_if_the_force_grows) {
  const AtRest part;
  for (const double tolerance : {1e-15, 1e-11, 1e-8, 1e-5})
    for (const double side : {1.0, -1.0})
      for (const double error : {0.0, tolerance, -tolerance})
        for (const double growth : {0.1, 1.0, 1e3}) {
          SCOPED_TRACE(testing::Message()
                       << "tolerance " << tolerance << " side " << side << " error " << error << " growth " << growth);
          // T = side f N holds a force of the other sign
          const double limit = side * part.system.friction * part.load, drive = -limit * (1.0 + error);
          Pins pins;
          (side > 0.0 ? pins[0].hold_plus : pins[0].hold_minus) = 1;
          const Decision more(part.system, part.q, force(Direction::x, drive, -side * growth), {edge}, pins, tolerance);
          EXPECT_EQ(more.slip(Site::a1), side > 0.0 ? Slip::minus : Slip::plus);
          EXPECT_EQ(more.pins(Site::a1).slip, 2);
          const Decision less(part.system, part.q, force(Direction::x, drive, side * growth), {edge}, pins, tolerance);
          EXPECT_EQ(less.slip(Site::a1), Slip::stick);
          EXPECT_EQ(side > 0.0 ? less.pins(Site::a1).hold_plus : less.pins(Site::a1).hold_minus, 1);
        }
}

// The same when N falls under a constant T.
TEST(FrictionChoice, at_its_limit_a_contact_slides_if_the_load_falls) {
  AtRest part;
  for (const double side : {1.0, -1.0})
    for (const double up : {1e-6, 1.0}) {
      const double limit = side * part.system.friction * part.load;
      Pins pins;
      (side > 0.0 ? pins[0].hold_plus : pins[0].hold_minus) = 1;
      part.q.vy = up;
      const Decision lifted(part.system, part.q, force(Direction::x, -limit), {edge}, pins);
      EXPECT_EQ(lifted.slip(Site::a1), side > 0.0 ? Slip::minus : Slip::plus) << side << " " << up;
      part.q.vy = -up;
      const Decision pressed(part.system, part.q, force(Direction::x, -limit), {edge}, pins);
      EXPECT_EQ(pressed.slip(Site::a1), Slip::stick) << side << " " << up;
    }
}

// A part that is wedged between an edge and a side, at rest but for the last digits of its speeds; T of a2 has just
// reached f N. Whether it grows is rounding. It may hold or slide against that T, but not turn about and push the part.
TEST(FrictionChoice, a_contact_at_its_limit_does_not_slide_against_the_other_one) {
  const System system = make_system(test::scene_of(R"(
part: {half_width: 0.6533024798313821, base_distance: 0.606464783307624, inertia: 0.03447314207457151}
slot: {clearance: 0.053760219630686126}
gripper:
  stiffness: {x: 0.1532690170178522, phi: 0.01446321999063751}
  damping: {x: 0.0027129239407806365, y: 0.006295001295703382, phi: 0.0010618778660686629}
  anchor: {x: -0.1123281066147859, phi: 0.10745577120090494}
  pressing_force: 0.4733501863071037
base: {stiffness: {x: 33725.69987592612, y: 3917.319811071386}, damping: {x: 802.0392452938243, y: 86.67758180587734}}
contacts: [edges, corners]
friction: {coefficient: 0.7192450877245007}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.1123281066147859, y: 0.6369575016453559, phi: -0.11972245052446842}
trial: {time_limit: 1}
)"));
  const State q{0.055485408806291686,    0.20769353671458915,     -0.60876883028257556,
                -4.2303049458802797e-15, -9.1846301269691012e-16, 4.8563052595935271e-15};
  const std::vector<Touch> touches{{Site::a1, Face::right_side}, {Site::a2, Face::bottom}};
  Pins pins;
  pins[1].hold_plus = 1;
  const Decision d(system, q, {}, touches, pins, 1e-9, true);
  const double limit = system.friction * touch_point(system, q, touches[1]).normal_force;
  EXPECT_NEAR(d.tangential_force(Site::a2), limit, 1e-9 * limit);
  for (const Touch& touch : touches) expect_law(system, d, touch, 1e-5 * d.step);
}

/// Two edges under the bottom of a part with locked tilt: one motion, unequal loads.
struct OnTwoEdges {
  OnTwoEdges() : system(soft_system({"part.inertia=null"})) {
    q = {0.05, 0.7, 0.2, 0, 0, 0};
    system.x.anchor = q.x;
    system.y.anchor = q.y;
    system.x.damping = system.y.damping = 0.0;
    for (std::size_t i = 0; i < 2; ++i) limit[i] = system.friction * touch_point(system, q, touches[i]).normal_force;
  }
  /// A drive along the bottom that needs `total` of both.
  Decision hold(double total) const {
    return Decision(system, q, force(Direction::x, -total / std::cos(q.phi)), touches);
  }

  System system;
  State q;
  std::vector<Touch> touches{{Site::a1, Face::bottom}, {Site::a2, Face::bottom}};
  double limit[2] = {};
};

TEST(FrictionChoice, equal_contacts_share_equally_while_both_can) {
  const OnTwoEdges part;
  const double weak = std::min(part.limit[0], part.limit[1]);
  for (const double share : {0.0, 0.5, -0.5, 0.999999, -0.999999}) {
    const Decision d = part.hold(2.0 * share * weak);
    for (const Touch& touch : part.touches) {
      EXPECT_EQ(d.slip(touch.site), Slip::stick) << share;
      EXPECT_NEAR(d.tangential_force(touch.site), share * weak, 1e-12 * weak) << share;
    }
  }
}

TEST(FrictionChoice, the_strong_one_takes_what_the_weak_one_cannot) {
  const OnTwoEdges part;
  const double sum = part.limit[0] + part.limit[1];
  const std::size_t weak = part.limit[0] < part.limit[1] ? 0 : 1;
  ASSERT_LT(part.limit[weak], 0.4 * sum);
  for (const double share : {0.9, -0.9, 1.0 - 1e-9, -1.0 + 1e-9}) {
    const Decision d = part.hold(share * sum);
    const double total = d.tangential_force(Site::a1) + d.tangential_force(Site::a2);
    EXPECT_NEAR(total, share * sum, 1e-12 * sum);
    EXPECT_NEAR(d.motion.vx[1] * std::cos(part.q.phi) + d.motion.vy[1] * std::sin(part.q.phi), 0.0, 1e-12) << share;
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_LE(std::abs(d.tangential_force(part.touches[i].site)), part.limit[i] * (1.0 + 1e-12)) << share;
    EXPECT_EQ(d.slip(part.touches[1 - weak].site), Slip::stick) << share;
  }
}

TEST(FrictionChoice, both_slide_beyond_the_sum_of_their_limits) {
  const OnTwoEdges part;
  const double sum = part.limit[0] + part.limit[1];
  for (const double side : {1.0, -1.0})
    for (const double share : {1.0 + 1e-9, 1.5}) {
      const Decision d = part.hold(side * share * sum);
      for (const Touch& touch : part.touches)
        EXPECT_EQ(d.slip(touch.site), side > 0.0 ? Slip::minus : Slip::plus) << share;
      expect_law(part.system, d, part.touches[0], 1e-3 * d.step);
      expect_law(part.system, d, part.touches[1], 1e-3 * d.step);
    }
}

// Flat on the floor with both corners, turned by a moment: they hold the same motion now, but part with
// V_1 - V_2 = -2 a sin phi phi' = -a alpha^2 t^3. The one that stays is the one that can take the rest.
TEST(FrictionChoice, contacts_that_have_to_part_do_so_the_way_they_move) {
  System system = soft_system();
  const State q{0.0, system.base_distance - 0.43, 0.0, 0, 0, 0};
  system.floor_depth = 0.4;
  system.x.anchor = q.x;
  system.phi.anchor = 0.0;
  const Touch right{Site::b1_floor, Face::floor}, left{Site::b2_floor, Face::floor};
  for (const double push : {0.2, -0.2})
    for (const double moment : {0.5, -0.5}) {
      DriveForms drives = force(Direction::x, push);
      drives.count = 2;
      drives.direction[1] = Direction::phi;
      drives.form[1] = {};
      drives.form[1].constant = moment;
      const Decision d(system, q, drives, {right, left});
      // the need of the pair, with V = x' + phi' b; its sign decides
      const FrictionProblem problem = friction_problem(system, q, drives, {right, left});
      const bool right_stays = problem.drift[0] > 0.0;
      EXPECT_EQ(d.slip(Site::b1_floor), right_stays ? Slip::stick : Slip::minus);
      EXPECT_EQ(d.slip(Site::b2_floor), right_stays ? Slip::plus : Slip::stick);
      const double turn = d.motion.omega[1], cubic = system.half_width * turn * turn;
      ASSERT_GT(cubic, 1e-3);
      const Site leaves = right_stays ? Site::b2_floor : Site::b1_floor;
      EXPECT_EQ(d.pins(leaves).slip, 3);
      EXPECT_NEAR(d.series(leaves).slip_velocity[3], right_stays ? cubic : -cubic, 1e-9 * (1.0 + cubic));
      for (const Touch& touch : {right, left})
        for (const double share : {1e-3, 1e-2}) expect_law(system, d, touch, share * d.step);
    }
}

// ------------------------------------------------------------------------------------------- beside contacts that
// slide

TEST(FrictionChoice, the_others_keep_what_they_do) {
  const System system = soft_system();
  const Touch wall{Site::b2, Face::left_wall};
  std::mt19937 random(35);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int tried = 0;
  while (tried < 50) {
    State q{-0.1 + 0.1 * u(random), 0.85 + 0.1 * u(random), 0.1 * u(random),
            0.3 * u(random),        0.3 * u(random),        u(random)};
    const TouchPoint p = touch_point(system, q, edge);
    // V of the edge out
    q.vx -= p.slip * p.tx;
    q.vy -= p.slip * p.ty;
    if (touch_point(system, q, edge).normal_force < 0.1 || touch_point(system, q, wall).normal_force < 0.1) continue;
    ++tried;
    ContactMode mode;
    const Slip slip = touch_point(system, q, wall).slip > 0.0 ? Slip::plus : Slip::minus;
    mode.contacts[static_cast<std::size_t>(Site::a1)] = {Phase::loaded, Face::bottom, Slip::none};
    mode.contacts[static_cast<std::size_t>(Site::b2)] = {Phase::loaded, Face::left_wall, slip};
    SiteFlags at_rest{};
    at_rest[static_cast<std::size_t>(Site::a1)] = true;
    FrictionChoice(system, kTolerance).decide(q, force(Direction::x, u(random)), at_rest, mode);
    EXPECT_EQ(mode.contacts[static_cast<std::size_t>(Site::b2)].slip, slip);
    EXPECT_NE(mode.contacts[static_cast<std::size_t>(Site::a1)].slip, Slip::none);
    EXPECT_EQ(mode.pins[static_cast<std::size_t>(Site::b2)].slip, 0);
  }
}

}  // namespace
}  // namespace vibratory_alignment
