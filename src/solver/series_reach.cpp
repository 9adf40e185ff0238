#include "solver/series_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

/// What ends a step is worth more powers where it is at most so many times as far as the series hold.
constexpr double kFar = 1.35;

/// Powers by which series are made longer at a time, and in all.
constexpr int kMorePowers = 2, kMostMorePowers = 4;

/// Of a velocity: slower is at rest.
constexpr double kNoTurn = 1e-60;

/// Radians of the base that a step of straight motion goes: from a touch to beyond the release, and where nothing ends
/// it.
constexpr double kImpactRadians = 4.0, kRingRadians = 6.5;

/// Powers more for a step of a part that turns where nothing ends it: each costs as many products as it is high.
constexpr int kTurningPowers = 4;

/// Truncation error of a step outside the tanh layer, as a share of that of one in it: the former are few and long, and
/// leave about what they may, the latter are bound by the poles of the layer.
constexpr double kOuterShare = 0.1;

/// Terms this large leave no room for those of higher powers; and for those of twice as high ones.
constexpr double kLarge = 1e150, kLargeByFar = 1e100;

}  // namespace

SeriesReach::SeriesReach(const System& system, double tolerance, double force_tolerance)
    : system_(system),
      tolerance_(tolerance),
      outer_tolerance_(has_layer(system) ? std::max(kOuterShare * tolerance, kSmallestTolerance) : tolerance),
      force_tolerance_(force_tolerance),
      straight_{straight_series_order(outer_tolerance_, kImpactRadians),
                straight_series_order(outer_tolerance_, kRingRadians)},
      turning_{0, series_order(tolerance) + kTurningPowers} {}

/// tanh(V/eps) has poles at V = +-i pi/2 eps: no step may go beyond a part of the way to the nearest. Far from them it
/// nears +-1 as exp(-2|V|/eps), whose series shows its terms only within a few eps.
double SeriesReach::layer_step(const Segment& segment) const {
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[static_cast<std::size_t>(i)];
    if (slip_of(segment, contact) != Slip::regularized) continue;
    const double eps = system_.regularization;
    const double v0 = contact.slip_velocity[0], pole = 1.57 * eps;
    const double reach = std::min(0.6 * std::sqrt(v0 * v0 + pole * pole), 4.0 * eps);
    const double v1 = std::abs(contact.slip_velocity[1]), v2 = std::abs(contact.slip_velocity[2]);
    // v1 h + v2 h^2 = reach
    const double step = 2.0 * reach / (v1 + std::sqrt(v1 * v1 + 4.0 * v2 * reach));
    if (step < shortest) shortest = step;
  }
  return shortest;
}

double SeriesReach::time(const Segment& segment) const {
  if (!is_in_layer(segment)) return contact_step(system_, segment, outer_tolerance_, force_tolerance_);
  return std::min(contact_step(system_, segment, tolerance_, force_tolerance_), layer_step(segment));
}

int SeriesReach::next_order(const Segment& segment) {
  const int order = segment.order;
  const Orders orders = orders_for(segment);
  if (rings_ && order < orders.ring) return orders.ring;
  if (order < orders.impact) return orders.impact;
  last_time_ = time(segment);
  if (!may_go_on(segment)) return order;
  const double far = kFar * last_time_;
  // N of what goes on for radians may have swung back by then
  const bool near =
      far >= longest_ || ends_by(segment, far) || (order >= straight_.impact && ends_by(segment, last_time_));
  rings_ = !near;
  if (!near && order < orders.ring) return orders.ring;
  const bool room = more_ < kMostMorePowers && order + kMorePowers <= kMaxOrder - 2;
  if (!near || !room || ends_by(segment, last_time_)) return order;
  more_ += kMorePowers;
  return order + kMorePowers;
}

double SeriesReach::last_terms(const Segment& segment) {
  return std::abs(segment.vx[segment.order]) + std::abs(segment.vy[segment.order]) +
         std::abs(segment.omega[segment.order]);
}

/// Those of a single contact outside the tanh layer; of others none but those asked for.
SeriesReach::Orders SeriesReach::orders_for(const Segment& segment) const {
  if (segment.loaded_count != 1 || slip_of(segment, segment.loaded[0]) == Slip::regularized) return {};
  if (!(last_terms(segment) < kLargeByFar)) return {};
  const bool straight =
      !system_.phi.moves || std::all_of(segment.omega.begin(), segment.omega.begin() + segment.order + 1,
                                        [](double omega) { return std::abs(omega) < kNoTurn; });
  return straight ? straight_ : turning_;
}

/// True for a step that its series end, well within the range of numbers and outside the tanh layer: there steps are
/// short for other reasons, and many.
bool SeriesReach::may_go_on(const Segment& segment) const {
  return last_time_ < longest_ && last_terms(segment) < kLarge && !is_in_layer(segment);
}

bool SeriesReach::is_in_layer(const Segment& segment) {
  return std::any_of(segment.loaded.begin(), segment.loaded.begin() + segment.loaded_count,
                     [&](const ContactSeries& contact) { return slip_of(segment, contact) == Slip::regularized; });
}

/// True when a contact is released or reaches a limit of friction or sliding by then, as far as the series tell. Of T
/// of what sticks the last power is not known yet, and zero.
bool SeriesReach::ends_by(const Segment& segment, double time) const {
  const double layer = system_.tanh_saturation * system_.regularization;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[static_cast<std::size_t>(i)];
    const Slip slip = slip_of(segment, contact);
    const Series& limited = slip == Slip::stick ? contact.tangential_force : contact.slip_velocity;
    Pair value{};
    for (int k = segment.order; k >= 0; --k) value = value * time + Pair{contact.normal_force[k], limited[k]};
    const double normal_force = value[0];
    if (normal_force < 0.0) return true;
    if (slip == Slip::stick && std::abs(value[1]) > system_.friction * normal_force) return true;
    if (slip == Slip::plus && value[1] < layer) return true;
    if (slip == Slip::minus && value[1] > -layer) return true;
  }
  return false;
}

}  // namespace vibratory_alignment
