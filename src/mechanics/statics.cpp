#include "mechanics/statics.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

#include "mechanics/contact_frame.h"
#include "mechanics/height_breaks.h"
#include "mechanics/site_rules.h"
#include "mechanics/tilt.h"

namespace vibratory_alignment {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Sides have no upper end; a touch farther up them than this many sizes of the part is none that a scene means.
constexpr double kFarthestTouch = 100.0;

/// Force or moment left over in an equilibrium, relative to those that balance.
constexpr double kBalanced = 1e-6;

/// Secants after which a height is sought by other means; change of it that is rounding, relative to it.
constexpr int kMostSecants = 8;
constexpr double kLastDigits = 1e-15;

/// Shortest and longest way over which a height is sought: breaks farther down are of faces that hardly lean.
constexpr double kShortestWay = 1e-12, kLongestWay = 1e9;

/// How far beside a height what is there above or below it is looked at, beside the sizes that it is computed from.
constexpr double kBeside = 4e-15;

/// A contact takes its whole share of the horizontal force where its tangent is less steep than this (sine of the
/// angle to the vertical), so that nothing jumps where that is upright.
constexpr double kSteepTangent = 0.5;

/// y at which the edge at distance rx from C (along x) lies on the lower boundary of the part.
std::optional<double> edge_touch(const System& system, double rx, double phi) {
  const double a = system.half_width, b = system.base_distance;
  const auto [c, s] = tilt_of(phi);
  std::optional<double> highest;
  const auto offer = [&](double y) {
    if (std::abs(y) <= kFarthestTouch * (a + b) && (!highest || y > *highest)) highest = y;
  };
  const double slack = 1e-12 * (a + b);
  // w = ry c - rx s = -b on the bottom, if |u| <= a; faces up where c > 0
  if (c > 0.0) {
    const double ry = (rx * s - b) / c;
    if (std::abs(rx * c + ry * s) <= a + slack) offer(-ry);
  }
  // u = rx c + ry s = +-a on a side that faces down, if w >= -b
  for (const double side : {1.0, -1.0}) {
    if (side * s >= 0.0) continue;
    const double ry = (side * a - rx * c) / s;
    if (ry * c - rx * s >= -b - slack) offer(-ry);
  }
  return highest;
}

double moment_scale(const System& system, double phi) {
  return std::abs(system.phi.stiffness * (phi - system.phi.anchor)) +
         (std::abs(system.weight) + std::abs(system.start.y - system.y.anchor)) * system.slot_half_width;
}

double beside(const System& system, double x, double y) {
  return kBeside * (std::abs(x) + std::abs(y) + system.half_width + system.base_distance);
}

/// Root of a function on [low, high] whose ends differ in sign, to roundoff.
template <class Function>
double root_between(const Function& f, double low, double high) {
  std::uintmax_t evaluations = 200;
  const auto nothing_between = [](double a, double b) {
    const double middle = 0.5 * (a + b);
    return middle == a || middle == b;
  };
  const auto bracket = boost::math::tools::toms748_solve(f, low, high, nothing_between, evaluations);
  return 0.5 * (bracket.first + bracket.second);
}

/// Height at which the vertical forces balance: the highest one below `top`, where nothing is touched. None where they
/// jump over the balance, as another face becomes the nearest one.
std::optional<double> balanced_height(const System& system, double x, double phi, double top) {
  struct Height {
    double y, lift;
  };
  const auto at = [&](double y) { return Height{y, static_load(system, x, y, phi).force_y}; };
  Height high = at(top);
  const double load = -high.lift;
  if (load <= 0.0) return std::nullopt;
  // down from break to break until the part is pushed up; below the last one, by ways that double
  const HeightBreaks breaks(system, x, phi);
  const double most_stiffness = kSiteCount * std::max(system.stiffness_x, system.stiffness_y);
  double way = std::max(load / most_stiffness, kShortestWay);
  double reached = top;  // the last break
  const auto next = [&](double y) {
    reached = breaks.below(reached);
    if (reached > top - kLongestWay) return at(reached + std::min(beside(system, x, reached), 0.5 * (y - reached)));
    way *= 2.0;
    return at(y - way);
  };
  Height low = next(top);
  while (low.lift < 0.0) {
    if (way > kLongestWay) return std::nullopt;
    high = std::exchange(low, next(low.y));
  }
  const auto balanced = [&](double y) -> std::optional<double> {
    const double left = kBalanced * load + most_stiffness * beside(system, x, y);
    return std::abs(at(y).lift) <= left ? std::optional(y) : std::nullopt;
  };
  // the secant of the last two heights, or where it leads away the chord: between two breaks the forces grow in
  // proportion to depth, but for friction
  Height before = high, here = low;
  for (int i = 0; i < kMostSecants; ++i) {
    const auto root = [](const Height& a, const Height& b) { return b.y - b.lift * (b.y - a.y) / (b.lift - a.lift); };
    double y = root(before, here);
    if (!(y > low.y && y < high.y)) y = root(high, low);
    if (std::abs(y - here.y) <= kLastDigits * std::abs(y)) return balanced(y);
    before = std::exchange(here, at(y));
    (here.lift < 0.0 ? high : low) = here;
  }
  return balanced(root_between([&](double y) { return at(y).lift; }, low.y, high.y));
}

}  // namespace

std::optional<double> touch_height(const System& system, double x, double phi) {
  std::optional<double> highest;
  const auto offer = [&](std::optional<double> y) {
    if (y && (!highest || *y > *highest)) highest = y;
  };
  const double l = system.slot_half_width;
  for (const Site site : {Site::a1, Site::a2})
    if (system.contacts.edges) offer(edge_touch(system, side_of(site) * l - x, phi));
  State state;
  state.x = x;
  state.phi = phi;
  for (const Site site : {Site::b1, Site::b2}) {
    const Vec2 corner = site_point(system, state, site);
    if (system.contacts.corners && std::abs(corner.x) >= l) offer(-corner.y);
    if (system.has_floor && is_in_slot(system, corner.x)) offer(-corner.y - system.floor_depth);
  }
  return highest;
}

StaticLoad static_load(const System& system, double x, double y, double phi) {
  State state;
  state.x = x;
  state.y = y;
  state.phi = phi;
  const auto [c, s] = tilt_of(phi);
  ContactStates contacts{};
  place_contacts(system, state, contacts);
  // normal forces, and friction if it is whole; 0 where nothing is loaded
  struct Push {
    double x, y, moment, drag_x, drag_y, drag_moment;
  };
  std::array<Push, kSiteCount> pushes{};
  for (int i = 0; i < kSiteCount; ++i) {
    if (!contacts[i].touching()) continue;
    const auto site = static_cast<Site>(i);
    const Vec2 p = site_point(system, state, site, c, s);
    const ContactKinematics k = contact_kinematics(system, state, site, contacts[i].face, p, c, s);
    const double n = stiffness_of(system, contacts[i].face, c, s) * k.depth;
    if (n <= 0.0) continue;
    const double t = system.friction * n * std::clamp(k.tangent.x / kSteepTangent, -1.0, 1.0);
    pushes[i] = {n * k.normal.x,  n * k.normal.y,  n * cross(k.lever, k.normal),
                 t * k.tangent.x, t * k.tangent.y, t * cross(k.lever, k.tangent)};
  }
  // both sites of a pair first: the mirror image adds them up the other way
  const auto sum_of = [&pushes](double Push::*of) {
    double sum = 0.0;
    for (int i = 0; i < kSiteCount; i += 2) sum += pushes[i].*of + pushes[i + 1].*of;
    return sum;
  };
  double lift = sum_of(&Push::y);
  double force_y = lift - (y - system.y.anchor) * system.y.stiffness - system.weight;
  double moment = sum_of(&Push::moment) - system.phi.stiffness * (phi - system.phi.anchor);
  const double whole = sum_of(&Push::drag_x);
  if (system.x.moves && system.regularization == 0.0 && whole > 0.0) {
    const double force_x = sum_of(&Push::x) - system.x.stiffness * (x - system.x.anchor);
    const double share = std::clamp(-force_x / whole, -1.0, 1.0);
    const double drag = share * sum_of(&Push::drag_y);
    lift += drag;
    force_y += drag;
    moment += share * sum_of(&Push::drag_moment);
  }
  return {force_y, moment, lift};
}

bool find_equilibrium(System& system, std::optional<double> pressing_force, bool free_y, bool free_phi) {
  const double x = system.start.x;
  // y for a tilt: the anchor follows the touching height, then the vertical balance
  const auto settle_height = [&](double phi, double& y) {
    const std::optional<double> touch = touch_height(system, x, phi);
    if (pressing_force) {
      if (!touch) return false;
      system.y.anchor = *touch - *pressing_force;
    }
    if (!free_y) return true;
    if (!touch) return false;
    const std::optional<double> height = balanced_height(system, x, phi, *touch);
    if (height) y = *height;
    return height.has_value();
  };
  // at the end of a face the part may seem to touch, and sink beside it, along a side, to where the gripper presses no
  // more
  const auto is_on_base = [&] {
    const double y = system.start.y;
    return !free_y || static_load(system, x, y - beside(system, x, y), system.start.phi).lift > 0.0;
  };
  if (!free_phi) return settle_height(system.start.phi, system.start.y) && is_on_base();

  const auto moment = [&](double phi) {
    double y = system.start.y;
    return settle_height(phi, y) ? static_load(system, x, y, phi).moment : NAN;
  };
  // from the gripper's own tilt follow the moment until it changes sign
  const double begin = system.phi.anchor;
  const double first = moment(begin);
  if (std::isnan(first)) return false;
  // where the touching point changes the moment jumps, and its change of sign is no equilibrium
  const auto rests_at = [&](double phi) {
    system.start.phi = phi;
    return settle_height(phi, system.start.y) && is_on_base() &&
           std::abs(moment(phi)) <= kBalanced * moment_scale(system, phi);
  };
  if (first == 0.0) return rests_at(begin);
  // towards the side to which it turns the part; the same numbers for the mirrored scene
  const double direction = first > 0.0 ? 1.0 : -1.0;
  const auto turning = [&](double way) { return direction * moment(begin + direction * way); };
  double low = 0.0, high = 0.0, step = 1e-4;
  for (;;) {
    high = low + step;
    if (high > 0.5 * kPi) return false;
    const double value = turning(high);
    if (std::isnan(value)) return false;
    if (!(value > 0.0)) break;
    low = high;
    step = std::min(1.5 * step, 0.02);
  }
  return rests_at(begin + direction * root_between(turning, low, high));
}

}  // namespace vibratory_alignment
