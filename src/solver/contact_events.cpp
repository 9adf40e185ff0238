#include "solver/contact_events.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mechanics/site_rules.h"
#include "solver/base_recovery.h"
#include "solver/contact_point.h"
#include "solver/polynomial_roots.h"
#include "solver/series_noise.h"

namespace vibratory_alignment {
namespace {

/// Events closer together than this (relative to their time) are one.
constexpr double kCoincidence = 4e-16;

/// Rounding of a sliding velocity, relative to the speed of the part.
constexpr double kSlipRounding = 1e-13;

/// A sliding velocity this large, relative to the speed of the part, is not zero, nor is a sliding acceleration
/// relative to that of the part.
constexpr double kSurelySliding = 1e-8;

/// Rounding of a length relative to those that it is made of; and how many times as much that of steps adds up to.
constexpr double kLengthRounding = 3e-16, kAddedUp = 20.0;

/// A rate this small, relative to the speed of the part, may be what rounding has left.
constexpr double kRateRounding = 1e-12;

/// Times are compared with that of what has been found only up to rounding.
constexpr double kSurelyLater = 1.0 + 1e-12;

/// A step is looked along anew, up to the end that a contact sets it, where it is this much shorter.
constexpr double kShorter = 0.9;

/// How far beyond its limit T of a single contact that has stayed at it tells that it leaves it.
constexpr double kBeyondLimit = 1e-11;

/// The time at which a contact loads again: its first correction at most, as a share of it; how often it is corrected,
/// and the share of the one before that a correction may be.
constexpr double kMostReloadCorrection = 0.1, kMostOfLastCorrection = 0.5;
constexpr int kReloadCorrections = 4;

/// Factor on rounding below which V is taken as zero throughout.
constexpr double kRestAllowance = 10.0;

class Search {
 public:
  Search(const System& system, MotionSeries& series, Segment& segment, const Pins& pins, const Recoveries& recoveries,
         const DriveForms& drives, double tolerance, FoundEvents& found)
      : system_(system),
        series_(series),
        segment_(segment),
        pins_(pins),
        recoveries_(recoveries),
        drives_(drives),
        tolerance_(tolerance),
        order_(segment.order),
        duration_(segment.duration),
        bounds_(system, segment, pins, {segment.cos_phi[0], segment.sin_phi[0]}),
        found_(found) {
    bound_motion();
  }

  void run(const OutcomeGuards& outcomes) {
    for (int index = 0; index < segment_.loaded_count; ++index) guard_forces(segment_.loaded[index].site, index);
    if (found_.count > 0) found_at_forces_ = found_.time;
    for (int i = 0, end = site_end(system_); i < end; ++i) {
      const auto site = static_cast<Site>(i);
      if (!site_in_use(system_, site)) continue;
      switch (segment_.contacts[i].phase) {
        case Phase::loaded: guard_foot(site); break;
        case Phase::unloaded: guard_unloaded(site); break;
        case Phase::outside: guard_outside(site); break;
        case Phase::free: guard_free(site); break;
      }
    }
    if (outcomes.aligned) guard_depth(EventKind::aligned, system_.aligned_depth, true);
    if (outcomes.inserted) guard_depth(EventKind::inserted, system_.inserted_depth, false);
  }

 private:
  void offer(double time, EventKind kind, Site site, Face face = Face::none) {
    if (time == kNoRoot) return;
    const double slack = kCoincidence * time;
    if (found_.count > 0 && time > found_.time + slack) return;
    if (found_.count == 0 || time < found_.time - slack) {
      found_.time = time;
      found_.count = 0;
    }
    found_.time = std::min(found_.time, time);  // of coinciding ones: the mirror image offers them in another order
    if (found_.count == kMaxEvents) return;
    found_.events[found_.count++] = {kind, site, face};
  }

  /// Forces end most steps in contact: what is not certain as far as the step goes is looked for up to there only. True
  /// when that is shorter than before. All searches but for the forces are as long, and the mirror image finds the
  /// same.
  bool shorten() {
    if (!(found_at_forces_ > 0.0 && found_at_forces_ < kShorter * duration_)) return false;
    duration_ = kSurelyLater * found_at_forces_;
    bound_motion();
    return true;
  }

  void bound_motion() { bounds_.set(duration_, most_accelerations(system_, segment_, drives_, duration_)); }

  /// True when a site's point surely stays outside during the segment. `pinned`: face on which the point starts.
  bool stays_outside(Site site, const Region& region, Face pinned) {
    return bounds_.surely_outside(site, region, pinned) || (shorten() && bounds_.surely_outside(site, region, pinned));
  }

  Series condition_series(const RegionCondition& condition, Site site) {
    const PairSeries& p = series_.point(site, segment_);
    Series g;
    for (int k = 0; k <= order_; ++k) g[k] = condition.c1 * p[k][0] + condition.c2 * p[k][1];
    g[0] += condition.c0;
    return g;
  }

  /// Takes what is left of the base's deformation off a depth.
  void subtract_recovery(const Recovery& recovery, Series& g) const {
    if (recovery.deformation == 0.0) return;
    const Series u = deformation_series(system_, segment_, recovery);
    for (int k = 0; k <= order_; ++k) g[k] -= u[k];
  }

  void guard_limits(Site site, Face face) {
    MotionBounds::Point point = bounds_.point(site);
    const Region limits = face_limits(system_, face, point.p);
    for (int j = 0; j < limits.count; ++j) {
      const RegionCondition& limit = limits.conditions[j];
      if (bounds_.surely_holds(limit, point)) continue;
      if (shorten()) {
        point = bounds_.point(site);
        if (bounds_.surely_holds(limit, point)) continue;
      }
      const Series g = condition_series(limit, site);
      // at the very end of the face last digits of its powers are not where the foot begins to leave it
      const double rounding = length_rounding();
      const int zeros = std::abs(g[0]) <= rounding ? zeros_on_border(g, rounding) : 0;
      if (zeros > order_) continue;
      offer(first_fall(g, order_, duration_, zeros > 1 ? zeros : 0), EventKind::run_off, site, limit.face);
    }
  }

  /// A contact that slides in name only: at its friction limit, but held by another one. V is rounding.
  bool stays_at_rest(int loaded) {
    const Series& v = segment_.loaded[loaded].slip_velocity;
    if (std::abs(v[0]) > kSurelySliding * bounds_.speed() || std::abs(v[1]) > kSurelySliding * bounds_.acceleration())
      return false;
    if (!noise_) noise_ = series_noise(system_, segment_, duration_, kRestAllowance);
    double sum = 0.0, power = 1.0;
    for (int k = 0; k <= order_; ++k, power *= duration_) sum += std::abs(v[k]) * power;
    return sum <= noise_->slip_rate[loaded] * duration_ + kSlipRounding * bounds_.speed();
  }

  /// Normal force and friction of a loaded contact.
  void guard_forces(Site site, int loaded) {
    const ContactSeries& contact = segment_.loaded[loaded];
    // friction's events come before most releases, which then need not be searched for
    const SlipTimes slips = find_slips(site, loaded);
    double before = found_.count > 0 ? found_.time : kNoRoot;
    for (const double time : slips.time)
      if (time != kNoRoot && (before == kNoRoot || time < before)) before = time;
    const int zeros = zeros_of_force(site, contact.normal_force);
    const double release = fall_before(before, contact.normal_force, order_, zeros);
    // both limits of T at once: T is zero, and so is N, to the last digits
    const double both = slips.time[0] == slips.time[1] ? slips.time[0] : kNoRoot;
    if (both != kNoRoot) {
      offer(release == kNoRoot ? both : std::min(release, both), EventKind::release, site);
      return;
    }
    offer(release, EventKind::release, site);
    for (const double time : slips.time) offer(time, slips.kind, site);
  }

  /// The foot of a loaded contact. One that sticks stays where it is, at the very end of the face too, where the
  /// rounding or the error of a step would carry it beyond.
  void guard_foot(Site site) {
    const ContactState& state = segment_.contacts[static_cast<std::size_t>(site)];
    if (state.slip != Slip::stick) guard_limits(site, state.face);
  }

  /// first_fall() on the segment, unless it is surely later than the time `before`, if there is one.
  double fall_before(double before, const Series& g, int order, int zeros) const {
    if (before != kNoRoot && zeros == 0 && stays_above_zero(g, order, kSurelyLater * before)) return kNoRoot;
    return first_fall(g, order, duration_, zeros);
  }

  /// When friction or sliding of a contact reaches a limit, in the direction of t and against it.
  struct SlipTimes {
    EventKind kind = EventKind::slip;
    double time[2] = {kNoRoot, kNoRoot};
  };

  /// Zeros that a limit of friction or sliding starts with. The polynomials of an implicit step have them but for its
  /// error, which may be as large as what follows: where that leads away from the limit, it counts.
  int zeros_of_limit(const Series& g, int pinned) const {
    for (int k = 1; k < pinned && segment_.coarse; ++k)
      if (g[k] > 0.0) return k;
    return pinned;
  }

  SlipTimes find_slips(Site site, int loaded) {
    const ContactSeries& contact = segment_.loaded[loaded];
    const Slip slip = segment_.contacts[static_cast<std::size_t>(site)].slip;
    const SitePins& pins = pins_[static_cast<std::size_t>(site)];
    const double f = system_.friction, layer = system_.tanh_saturation * system_.regularization;
    SlipTimes times;
    Series g;
    switch (slip) {
      case Slip::none: break;
      case Slip::plus:
      case Slip::minus: {
        times.kind = EventKind::slip_reversal;
        const double sign = slip == Slip::plus ? 1.0 : -1.0;
        if (pins.slip > MotionSeries::kHeldPowers || stays_at_rest(loaded)) break;
        for (int k = 0; k <= order_; ++k) g[k] = sign * contact.slip_velocity[k];
        g[0] -= layer;
        times.time[0] = first_fall(g, order_, duration_, zeros_of_limit(g, pins.slip));
        break;
      }
      case Slip::stick:
        for (int i = 0; i < 2; ++i) {
          const double sign = i == 0 ? 1.0 : -1.0;
          for (int k = 0; k < order_; ++k) g[k] = f * contact.normal_force[k] - sign * contact.tangential_force[k];
          const double before = i == 0 ? kNoRoot : times.time[0];
          const int zeros = i == 0 ? pins.hold_plus : pins.hold_minus;
          if (zeros < MotionSeries::kHeldPowers) {
            times.time[i] = fall_before(before, g, order_ - 1, zeros_of_limit(g, zeros));
          } else if (segment_.loaded_count == 1) {
            // at its limit as far as the decision looked, and left by what comes after
            for (int k = 0; k < order_; ++k) g[k] += kBeyondLimit * f * contact.normal_force[k];
            times.time[i] = fall_before(before, g, order_ - 1, zeros_of_force(site, contact.normal_force));
          }
        }
        break;
      case Slip::regularized: {
        const Series& v = contact.slip_velocity;
        if (largest_size(v) < layer) break;
        for (int i = 0; i < 2; ++i) {
          const double sign = i == 0 ? 1.0 : -1.0;
          for (int k = 0; k <= order_; ++k) g[k] = -sign * v[k];
          g[0] += layer;
          times.time[i] = first_fall(g, order_, duration_, pins.slip > 0 && sign * v[0] > 0.0 ? pins.slip : 0);
        }
        break;
      }
    }
    return times;
  }

  /// Largest absolute value of a series during the segment, at most; not a number where a term is none.
  double largest_size(const Series& series) const {
    double size = 0.0;
    for (int k = order_; k >= 0; --k) size = size * duration_ + std::abs(series[k]);
    return size;
  }

  /// k(n) and h(n) that turn with the part fall off more slowly in the series than the motion by which the step is
  /// chosen, and what is cut off of cos phi and sin phi shows in d': the time at which a contact loads again is
  /// corrected by the states there. `g`: -(k d + h d').
  double reload_time(double found, Site site, Face face, const Series& g) const {
    const auto push_at = [&](double t) {
      const PlacedState placed(state_at(segment_, t));
      return contact_point(system_, placed, site, face, site_point(system_, placed, site)).push();
    };
    double slope = 0.0;
    for (int k = order_ - 1; k >= 1; --k) slope = slope * found + k * g[k];
    double time = found, push = push_at(found), step = push / slope;
    if (!(std::abs(step) <= kMostReloadCorrection * found)) return found;
    // the slope of what was cut off is not known: secants, whose steps have to fall
    for (int i = 0; i < kReloadCorrections && step != 0.0; ++i) {
      time += step;
      const double next = push_at(time), secant_step = next == 0.0 ? 0.0 : step * next / (push - next);
      if (!(std::abs(secant_step) <= kMostOfLastCorrection * std::abs(step))) {
        if (std::abs(next) > std::abs(push)) time -= step;
        break;
      }
      push = next;
      step = secant_step;
    }
    return std::min(time, segment_.duration);
  }

  void guard_unloaded(Site site) {
    const auto index = static_cast<std::size_t>(site);
    const Face face = segment_.contacts[index].face;
    const ContactFrame frame = contact_frame(system_, face);
    const RegionCondition depth{frame.sign * frame.n1, frame.sign * frame.n2, frame.offset, face};
    const Series d = condition_series(depth, site);
    offer(first_fall(d, order_, segment_.duration, 0), EventKind::close, site, face);
    // what would push: k d + h d', or where the base is still deformed the part catching up with it
    Series g;
    if (recoveries_[index].deformation > 0.0) {
      g = d;
      subtract_recovery(recoveries_[index], g);
      for (int k = 0; k <= order_; ++k) g[k] = -g[k];
      offer(first_fall(g, order_, segment_.duration, pins_[index].normal), EventKind::reload, site);
    } else {
      series_.push_series(segment_, face, d, g);
      for (int k = 0; k < order_; ++k) g[k] = -g[k];
      g[order_] = 0.0;
      // a push of last digits is none
      const bool is_none = pins_[index].normal == 1 && zeros_on_border(g, force_rounding(face)) > order_;
      const double time = is_none ? kNoRoot : first_fall(g, order_ - 1, segment_.duration, pins_[index].normal);
      offer(time > 0.0 ? reload_time(time, site, face, g) : time, EventKind::reload, site);
    }
    guard_limits(site, face);
  }

  /// Zeros that N starts with. Where rounding leaves a push instead of a single one, that is what it starts with: in a
  /// stiff damper it relaxes, and makes a slope of its own at which zero would fall.
  int zeros_of_force(Site site, const Series& normal_force) const {
    const auto index = static_cast<std::size_t>(site);
    const int pinned = pins_[index].normal;
    if (pinned != 1) return pinned;
    if (normal_force[0] > 0.0) return 0;
    // what the last digits of lengths, within the step, make of the powers is not where N begins to fall
    const double c = segment_.cos_phi[0], s = segment_.sin_phi[0];
    const Face face = segment_.contacts[index].face;
    const double stiffness = stiffness_of(system_, face, c, s), damping = damping_of(system_, face, c, s);
    const int zeros = zeros_on_border(normal_force, (stiffness + damping / duration_) * length_rounding());
    return zeros <= order_ && normal_force[zeros] > 0.0 ? zeros : pinned;
  }

  /// Lengths that the places of points are made of.
  double lengths() const {
    return std::abs(segment_.x[0]) + std::abs(segment_.y[0]) + system_.half_width + system_.base_distance +
           system_.slot_half_width;
  }

  /// Speed of the part's points at the start, at most.
  double speed_at_start() const {
    return std::abs(segment_.vx[0]) + std::abs(segment_.vy[0]) + std::abs(segment_.omega[0]) * lengths();
  }

  /// Last digits of k d + h d' at the start.
  double force_rounding(Face face) const {
    const double c = segment_.cos_phi[0], s = segment_.sin_phi[0];
    return stiffness_of(system_, face, c, s) * length_rounding() +
           damping_of(system_, face, c, s) * kLengthRounding * speed_at_start();
  }

  /// Last digits of lengths.
  double length_rounding() const { return kLengthRounding * lengths(); }

  /// Of a point that is said to be outside, but is inside from the start by the error of the steps before (by last
  /// digits only where it is on a border): conditions of its region that it is leaving, or moves along, count as zero.
  /// True if there are any.
  bool counts_as_leaving(const Region& region, double rounding, Conditions& conditions) const {
    const double added_up = kAddedUp * rounding;
    const auto known = conditions.zeros_at_start;
    const bool on_border =
        std::any_of(known.begin(), known.begin() + region.count, [](int zeros) { return zeros > 0; });
    const double most = on_border ? added_up : added_up + tolerance_ * (system_.half_width + system_.base_distance);
    bool any = false;
    for (int j = 0; j < region.count; ++j) {
      if (known[j] > 0 || conditions.g[j][0] > most) continue;
      const int zeros = zeros_on_border(conditions.g[j], added_up);
      if (zeros <= order_ && conditions.g[j][zeros] >= 0.0) continue;
      conditions.zeros_at_start[j] = zeros;
      any = true;
    }
    return any;
  }

  /// Zeros that a condition starts with on the border: its powers that are no more than last digits of lengths in the
  /// step. More than there are powers where all are: the point moves along the face.
  int zeros_on_border(const Series& g, double rounding) const {
    double power = duration_;
    int k = 1;
    for (; k <= order_ && std::abs(g[k]) * power <= rounding; ++k) power *= duration_;
    return k;
  }

  /// The same of a condition that lets a point in. One that leaves first, if by last digits only, comes back later,
  /// with a rate that pushes on a damper.
  int zeros_of_entry(const Series& g, double rounding) const {
    const int zeros = zeros_on_border(g, rounding);
    return zeros > order_ || g[1] >= -kRateRounding * speed_at_start() ? zeros : 1;
  }

  /// True when one of the conditions stays as it is.
  bool moves_along(const Conditions& conditions) const {
    return std::any_of(conditions.zeros_at_start.begin(), conditions.zeros_at_start.begin() + conditions.count,
                       [&](int zeros) { return zeros > order_; });
  }

  void guard_outside(Site site) {
    const auto index = static_cast<std::size_t>(site);
    const double rounding = length_rounding();
    for (int half = 0; half < region_count(site); ++half) {
      const Region region = site_region(system_, site, half);
      if (stays_outside(site, region, pins_[index].face)) continue;
      Conditions conditions;
      conditions.count = region.count;
      for (int j = 0; j < region.count; ++j) {
        const Face face = region.conditions[j].face;
        conditions.g[j] = condition_series(region.conditions[j], site);
        // where the base has not recovered yet, the point leaves its face inside the deformed base
        const bool recovering = recoveries_[index].deformation > 0.0 && recoveries_[index].face == face;
        if (recovering) subtract_recovery(recoveries_[index], conditions.g[j]);
        const bool pinned = pins_[index].face == face && !recovering;
        // of a condition that holds by no more than last digits its change decides
        const double at_start = conditions.g[j][0];
        const bool on_border = pinned || (at_start >= 0.0 && at_start <= rounding);
        const int zeros = on_border ? zeros_of_entry(conditions.g[j], rounding) : 0;
        // from a face that it has just left, by last digits only, a point comes back later; what enters by them and
        // turns at once does not, nor does a free point that these let out (guard_free())
        const bool leaves_first = pinned && zeros <= order_ && conditions.g[j][1] <= 0.0;
        conditions.zeros_at_start[j] = leaves_first ? 1 : zeros;
      }
      if (moves_along(conditions)) continue;
      Entry entry = first_entry(conditions, order_, duration_);
      if (entry.time == 0.0 && counts_as_leaving(region, rounding, conditions)) {
        if (moves_along(conditions)) continue;
        entry = first_entry(conditions, order_, duration_);
      }
      if (entry.time == kNoRoot) continue;
      const Face face = region.conditions[entry.last].face;
      const bool touches = is_called_for(system_, face) && (face != Face::floor || over_floor(site, entry.time));
      offer(entry.time, touches ? EventKind::touch : EventKind::enter, site, face);
    }
  }

  /// A corner reaches the floor only inside the slot (or while it touches a wall).
  bool over_floor(Site site, double time) {
    const Site corner = site == Site::b1_floor ? Site::b1 : Site::b2;
    if (segment_.contacts[static_cast<std::size_t>(corner)].on_wall()) return true;
    const Series across = condition_series({1.0, 0.0, 0.0, Face::none}, site);
    return is_in_slot(system_, value_at(across, order_, time));
  }

  void guard_free(Site site) {
    // free inside: until the point is outside again
    const Vec2 p = bounds_.start_point(site);
    const int half = region_count(site) == 2 && p.x < 0.0 ? 1 : 0;
    const Region region = site_region(system_, site, half);
    const double rounding = length_rounding();
    for (int j = 0; j < region.count; ++j) {
      const Series g = condition_series(region.conditions[j], site);
      const int zeros = std::abs(g[0]) <= rounding ? zeros_on_border(g, rounding) : 0;
      if (zeros > order_) continue;
      offer(first_fall(g, order_, segment_.duration, zeros), EventKind::leave, site, region.conditions[j].face);
    }
  }

  /// Both lower corners are where it is asked.
  void guard_depth(EventKind kind, double depth, bool between_walls) {
    // mostly one of them surely fails throughout
    if (bounds_.surely_misses(depth, between_walls) || (shorten() && bounds_.surely_misses(depth, between_walls)))
      return;
    Conditions conditions;
    conditions.count = 0;
    for (const Site site : {Site::b1, Site::b2}) {
      const ContactState& contact = segment_.contacts[static_cast<std::size_t>(site)];
      const Region region = insertion_region(system_, depth, between_walls, contact);
      for (int j = 0; j < region.count; ++j)
        conditions.g[conditions.count++] = condition_series(region.conditions[j], site);
    }
    offer(first_entry(conditions, order_, duration_).time, kind, Site::b1);
  }

  const System& system_;
  MotionSeries& series_;
  Segment& segment_;
  const Pins& pins_;
  const Recoveries& recoveries_;
  const DriveForms& drives_;
  double tolerance_;
  int order_;
  double duration_;
  MotionBounds bounds_;               ///< up to `duration_`
  double found_at_forces_ = 0.0;      ///< time of the first event of normal forces and friction, if there is one
  std::optional<SeriesNoise> noise_;  ///< once it has been asked for
  FoundEvents& found_;
};

}  // namespace

void find_events(const System& system, MotionSeries& series, Segment& segment, const Pins& pins,
                 const Recoveries& recoveries, const OutcomeGuards& outcomes, const DriveForms& drives,
                 double tolerance, FoundEvents& found) {
  Search(system, series, segment, pins, recoveries, drives, tolerance, found).run(outcomes);
}

}  // namespace vibratory_alignment
