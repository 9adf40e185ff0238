#include "solver/implicit_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "mechanics/contact_frame.h"
#include "mechanics/tilt.h"

namespace vibratory_alignment {
namespace {

/// Steps shorter than this share of the longest are not tried.
constexpr double kShortest = 1e-14;

/// The first step after a jump of the forces is tried with so many times the last such step.
constexpr double kRestartGrowth = 2.0;

/// Longest step in radians of the fastest excitation: where all that moves is stiff, nothing but N shows that a longer
/// one is not resolved, and the error estimate filters it out.
constexpr double kLongestDrive = 1.5;

/// A motion of a rate that times the step is less than this is followed, not passed over; the step is short if it is
/// also shorter than this share of what the excitation allows.
constexpr double kResolved = 5.0, kShortForDrive = 0.3;

/// A ring is passed over where a step of this length, over 1/(lambda_0 rate), may do so; and where it is no faster than
/// what rounding of the coordinates leaves, times the second.
constexpr double kLongRing = 3.0, kRingOfRounding = 10.0;

/// Most change of a normal force by what is passed over, in place and speed, as a share of the smaller one of before
/// and after.
constexpr double kMostOverForce = 1.0;

/// ... of one from the start of the trial that the base has not damped by the end of the step: it goes on, and dry
/// friction that holds or slides later has it in N.
constexpr double kMostLastingOverForce = 1e-2;

/// Where a step would pass over more than it may, a shorter one is tried with this share of its length, which still
/// passes over the fast motion: it is so many times as long as that motion's rate asks for.
constexpr double kShorter = 0.2, kFarOver = 25.0;

/// A step whose equations do not converge is tried again with this share of its length.
constexpr double kRetry = 0.5;

/// Next length as a share of the one whose error is 1; least and most change of a length.
constexpr double kSafety = 0.8, kLeastGrowth = 0.1, kMostGrowth = 5.0;

/// Errors smaller than this share of the one allowed say nothing about their trend.
constexpr double kNegligible = 1e-2;

/// Amplitude of what a trial's first step may pass over, and how far its speed may lead once the part is released, as a
/// multiple of its tolerance, in lengths of the part.
constexpr double kPassedOver = 100.0;

/// Largest |u prod_j (1 - u/c_j)| in 0 <= u <= 1: what a missed speed of one makes of the places between the nodes c_j
/// of a step of one.
constexpr double kMostBetweenNodes = 0.12;

/// Of a chirp h is that of (f + |rate| h) h = kLongestDrive.
double longest_drive_step(const DriveForms& drives) {
  double longest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < drives.count; ++i) {
    const DriveForm& form = drives.form[static_cast<std::size_t>(i)];
    if (form.amplitude == 0.0) continue;
    const double frequency = std::abs(form.frequency), sweep = 4.0 * kLongestDrive * std::abs(form.rate);
    const double fastest = 0.5 * (frequency + std::sqrt(frequency * frequency + sweep));
    if (fastest > 0.0) longest = std::min(longest, kLongestDrive / fastest);
  }
  return longest;
}

/// Time in which the base alone answers: its period over 2 pi, or the time in which its damper stops the part.
double answer_time(double stiffness, double damping, double mobility) {
  return 1.0 / std::max(std::sqrt(stiffness * mobility), damping * mobility);
}

double most_mobility_of_mass(const System& system) {
  return std::max(system.x.inverse_inertia, system.y.inverse_inertia);
}

/// Of the part's farthest point.
double most_mobility(const System& system) {
  const double reach = system.half_width * system.half_width + system.base_distance * system.base_distance;
  return most_mobility_of_mass(system) + reach * system.phi.inverse_inertia;
}

/// At least: in the stiffer direction, at the part's farthest point.
double base_time(const System& system) {
  return answer_time(std::max(system.stiffness_x, system.stiffness_y), std::max(system.damping_x, system.damping_y),
                     most_mobility(system));
}

/// Of the undamped base, at most.
double natural_rate(const System& system) {
  return std::sqrt(std::max(system.stiffness_x, system.stiffness_y) * most_mobility(system));
}

/// At most: in the softer direction, where the part does not turn.
double slow_base_time(const System& system) {
  return answer_time(std::min(system.stiffness_x, system.stiffness_y), std::min(system.damping_x, system.damping_y),
                     most_mobility_of_mass(system));
}

/// Rate at which the base damps a motion of this mobility, at least.
double ring_decay(double stiffness, double damping, double mobility) {
  const double half = 0.5 * damping * mobility, square = stiffness * mobility, beyond = half * half - square;
  return beyond < 0.0 ? half : square / (half + std::sqrt(beyond));
}

/// The same for what the part can do on its loaded contacts: along a normal, on several also turn.
double slowest_ring_decay(const System& system, const State& state, const ContactStates& contacts) {
  const auto [c, s] = tilt_of(state.phi);
  double mobility = std::numeric_limits<double>::infinity();
  const auto add = [&](double of_axis) {
    if (of_axis > 0.0) mobility = std::min(mobility, of_axis);
  };
  add(system.x.inverse_inertia);
  add(system.y.inverse_inertia);
  const auto is_loaded = [](const ContactState& contact) { return contact.phase == Phase::loaded; };
  if (std::count_if(contacts.begin(), contacts.end(), is_loaded) > 1)
    add(system.half_width * system.half_width * system.phi.inverse_inertia);
  double slowest = std::numeric_limits<double>::infinity();
  for (const ContactState& contact : contacts)
    if (is_loaded(contact))
      slowest = std::min(slowest, ring_decay(stiffness_of(system, contact.face, c, s),
                                             damping_of(system, contact.face, c, s), mobility));
  return slowest;
}

/// Time in which the gripper turns a flight along the insertion round: a speed times this is how far it leads.
double flight_time(const System& system) { return 1.0 / std::sqrt(system.y.stiffness * system.y.inverse_inertia); }

/// What the spring of a contact makes of a velocity: its share in the normal force while that rings, or creeps away.
double spring_force_of(const System& system, const State& state, Site site, Face face, const StageAxes& velocity) {
  const auto [c, s] = tilt_of(state.phi);
  const ContactKinematics k = contact_kinematics(system, state, site, face);
  const double turn = cross(k.lever, k.normal), stiffness = stiffness_of(system, face, c, s);
  const double mobility = mobility_along(system, k.normal, turn);
  const double rate = k.normal.x * velocity[0] + k.normal.y * velocity[1] + turn * velocity[2];
  return stiffness * std::abs(rate) * answer_time(stiffness, damping_of(system, face, c, s), mobility);
}

/// Degree of the polynomials of the positions.
constexpr int kDegree = Collocation::kStages + 1;

/// The polynomial with these values at the start and at the nodes; `rates`: powers of 1/h.
VIBRATORY_ALIGNMENT_INLINE void interpolate(double at_start, const Octet& at_nodes, const Octet& rates,
                                            Series& series) {
  const StageTable& table = stage_table();
  Octet sum = table.value_power[0] * at_start;
  for (std::size_t j = 0; j < StageTable::kStages; ++j) sum += table.value_power[j + 1] * at_nodes[j];
  sum = sum * rates;
  for (std::size_t k = 0; k < Octet::kSize; ++k) series[k] = sum[k];
  series[kDegree] = 0.0;
}

/// Velocity and position from the polynomial through the accelerations at the nodes.
VIBRATORY_ALIGNMENT_INLINE void integrate(double q0, double v0, const Octet& acceleration, const Octet& rates,
                                          Series& q, Series& v) {
  const Octet a = combine(stage_table().acceleration_power, acceleration) * rates;
  q[0] = q0;
  q[1] = v[0] = v0;
  for (std::size_t k = 0; k < StageTable::kStages; ++k) {
    const auto n = static_cast<double>(k + 1);
    v[k + 1] = a[k] / n;
    q[k + 2] = a[k] / (n * (n + 1.0));
  }
  v[kDegree] = 0.0;
}

/// A force at the start to interpolate from: the last one, or where the step does not follow it, and that is farther
/// from the polynomial of the nodes than that can be from a smooth motion, the value of this polynomial.
VIBRATORY_ALIGNMENT_INLINE double force_to_begin_with(double last, const Octet& at_nodes, bool follows) {
  const double of_nodes = weighted_sum(stage_table().at_start, at_nodes);
  const bool is_far = std::abs(last - of_nodes) > std::abs(weighted_sum(stage_table().last_power, at_nodes));
  return !follows && is_far ? of_nodes : last;
}

}  // namespace

ImplicitStep::ImplicitStep(const System& system, double tolerance)
    : system_(system),
      equations_(system, tolerance),
      base_time_(base_time(system)),
      slow_base_time_(slow_base_time(system)),
      natural_rate_(natural_rate(system)),
      flight_time_(flight_time(system)),
      most_passed_over_(kPassedOver * tolerance * (system.half_width + system.base_distance)) {}

void ImplicitStep::restart(bool base_rings) {
  restarts_ = after_event_ = !base_rings;
  taken_ = false;
  if (base_rings)
    follow_base();
  else if (restart_step_ > 0.0)
    next_step_ = std::min(next_step_, kRestartGrowth * restart_step_);
}

/// What the polynomial of the accelerations misses at the start.
StageAxes ImplicitStep::missed_at_start() const {
  const Octet& at_start = stage_table().at_start;
  const Forces& forces = equations_.start_forces();
  const Stages& a = equations_.acceleration();
  return {forces.ax - weighted_sum(at_start, a[0]), forces.ay - weighted_sum(at_start, a[1]),
          forces.alpha - weighted_sum(at_start, a[2])};
}

/// Error of the velocities: what the polynomial of the accelerations misses at the start, without its stiff part. What
/// is stiff is damped by the method and, below the tolerance in position, is not to be followed: it is filtered twice.
/// A contact in the tanh layer that is about to be released is stiff at the start and no longer at the end.
double ImplicitStep::error(double h) const {
  const StageAxes missed = missed_at_start();
  double size = equations_.size_of(equations_.filter(equations_.filter(missed)));
  if (equations_.in_layer()) {
    const std::optional<Eigen::Matrix3d> filter = equations_.filter_at_end(h);
    if (!filter) return std::numeric_limits<double>::infinity();
    const Eigen::Vector3d left = *filter * (*filter * Eigen::Vector3d(missed[0], missed[1], missed[2]));
    size = std::max(size, equations_.size_of({left[0], left[1], left[2]}));
  }
  return h * collocation().eigenvalue[0].real() * size;
}

/// Velocities that the polynomial of those at the nodes misses at the start: of all motions that the step passes over,
/// which are over at the nodes.
StageAxes ImplicitStep::velocity_missed_at_start() const {
  const Octet& at_start = stage_table().at_start;
  const State& start = equations_.start();
  const StateOctet& stages = equations_.stages();
  return {start.vx - weighted_sum(at_start, stages.vx), start.vy - weighted_sum(at_start, stages.vy),
          start.omega - weighted_sum(at_start, stages.omega)};
}

double ImplicitStep::speed_missed_at_start() const { return equations_.size_of(velocity_missed_at_start()); }

/// Of the speed missed at the start, that of what is stiff: the filter leaves what the step follows.
double ImplicitStep::stiff_speed_missed_at_start() const {
  const StageAxes missed = velocity_missed_at_start(), followed = equations_.filter(missed);
  return equations_.size_of({missed[0] - followed[0], missed[1] - followed[1], missed[2] - followed[2]});
}

/// Speed of a ring of this rate that a step may pass over, z = h lambda_0 rate, at most kLongRing, and `allowed` the
/// error of a step with that z. The error by a motion c exp(lambda t) is h lambda_0 |filter^2(lambda c)|; where the
/// step is longer rebounds may make much more of it.
double ImplicitStep::most_speed_of_ring(double rate, double z, double allowed, const Segment& segment) const {
  const double left = 1.0 + z * z;
  // a rounded place is pushed back by the springs: to the speed of their ring, or of a creep, which is slower
  const double rounding = equations_.depth_rounding(segment) * std::min(rate, natural_rate_);
  return std::max(allowed * left * left / z, kRingOfRounding * rounding);
}

/// True when a step of the length h begins at an event at which no normal force jumps, and passes over a ring that is
/// too large for it: where a contact begins to slide or to stick, its velocity may be one that the base has not taken
/// on yet.
bool ImplicitStep::passes_over_ring_of_event(double h, const Segment& segment) const {
  if (!after_event_ || follows_ || at_start_ || h < kResolved * base_time_) return false;
  const double per_radian = collocation().eigenvalue[0].real() / base_time_, z = std::min(kLongRing, h * per_radian);
  const double allowed = equations_.allowed_at_start(z / per_radian);
  return stiff_speed_missed_at_start() > most_speed_of_ring(1.0 / base_time_, z, allowed, segment);
}

bool ImplicitStep::leaves_ring_of_event(const Segment& segment) const {
  return passes_over_ring_of_event(length_, segment);
}

/// True when a step of the length h passes over a motion whose amplitude is more than may be left out. What is stiff in
/// the missed accelerations is that amplitude, times the square of its rate, which the filter divides by; in the missed
/// velocities it is the amplitude times its rate. What the base has not damped of that speed by the end of the step the
/// part has once it is released.
bool ImplicitStep::passes_over_too_much(double h) const {
  const double length = h * collocation().eigenvalue[0].real();
  if (length * length * equations_.size_of(equations_.filter(missed_at_start())) > most_passed_over_) return true;
  const double time = std::max(slow_base_time_, flight_time_ * std::exp(-h * ring_decay_));
  return time * speed_missed_at_start() > most_passed_over_;
}

void ImplicitStep::go_on_from(double length) { known_step_ = next_step_ = std::min(next_step_, kMostGrowth * length); }

bool ImplicitStep::leaves_ring_of_start() const {
  return at_start_ && length_ > base_time_ && passes_over_too_much(length_);
}

double ImplicitStep::take(const State& start, const DriveForms& drives, const StepBounds& bounds, Segment& segment,
                          SolverCounts& counts) {
  follows_ = taken_;
  taken_ = false;
  if (!follows_) last_length_ = 0.0;
  equations_.begin(start, drives, segment.contacts, follows_, counts);
  if (at_start_) ring_decay_ = slowest_ring_decay(system_, start, segment.contacts);
  const double longest = longest_step(bounds.longest, drives);
  const double shortest = std::max(bounds.shortest, kShortest * longest);
  const long evaluations_before = counts.rhs_evaluations, cost_before = equations_.cost();
  const auto spent = [&] { return equations_.cost() - cost_before; };
  const FastMotion over = std::exchange(over_, {});
  double h = next_step_ > 0.0 ? std::min(next_step_, longest) : longest;
  double last_error = std::numeric_limits<double>::infinity();
  bool tried = false, slower_ring = false;
  // a step of this length was not good enough; for a ring it may be once that has decayed
  given_up_at_ = 0.0;
  event_rings_ = false;
  const auto give_up = [&] {
    given_up_at_ = h;
    if (known_step_ > 0.0 && !slower_ring) known_step_ = std::min(known_step_, h);
    return 0.0;
  };
  for (; h > shortest; tried = true, ++counts.rejected) {
    if (counts.rhs_evaluations - evaluations_before > bounds.evaluations) return give_up();
    if (spent() > bounds.cost) return give_up();
    if (!equations_.solve(h, counts, bounds.easily, bounds.most_cost - spent())) {
      if (bounds.easily) return give_up();
      h *= kRetry;
      continue;
    }
    const double ratio = error(h) / equations_.allowed(h);
    const double factor = growth(h, ratio);
    if (ratio > 1.0) {
      if (bounds.passes_over && ratio > last_error) return give_up();
      last_error = ratio;
      h *= std::min(0.9, factor);
      continue;
    }
    if (at_start_ && h > base_time_) {
      if (passes_over_too_much(h)) return 0.0;
      const double between_nodes = kMostBetweenNodes * h * speed_missed_at_start();
      if (between_nodes > most_passed_over_) {
        h *= std::max(kLeastGrowth, kSafety * most_passed_over_ / between_nodes);
        continue;
      }
    }
    event_rings_ = passes_over_ring_of_event(h, segment);
    if (event_rings_) return 0.0;
    if (over.rate > 0.0 && speed_missed_at_start() > std::max(over.speed, equations_.allowed(h))) {
      // a shorter step may follow it that still passes over the fast one
      slower_ring = true;
      h *= kShorter;
      if (h * over.rate < kFarOver) return give_up();
      continue;
    }
    // a step that was cut short says nothing about longer ones; after a shorter one nothing speaks for a longer one
    next_step_ = std::max(h == longest ? next_step_ : 0.0, h * std::clamp(factor, 0.5, tried ? 1.0 : kMostGrowth));
    known_step_ = next_step_;
    last_length_ = h;
    last_ratio_ = std::max(ratio, kNegligible);
    if (restarts_) restart_step_ = h;
    restarts_ = false;
    taken_ = true;
    fill(h, segment);
    return h;
  }
  return give_up();
}

double ImplicitStep::longest_step(double longest, const DriveForms& drives) {
  return std::min(longest, longest_drive_step(drives));
}

double ImplicitStep::length_over(const FastMotion& motion, double least, double longest, const DriveForms& drives,
                                 const Segment& segment) {
  double h = longest_step(longest, drives);
  if (known_step_ > 0.0) h = std::min(h, std::max(known_step_, least));
  over_ = {};
  if (h * motion.rate < kResolved) return h;
  const double per_radian = collocation().eigenvalue[0].real() * motion.rate, z = std::min(kLongRing, h * per_radian);
  const double allowed = equations_.allowed_from(segment, z / per_radian);
  const double most_speed = most_speed_of_ring(motion.rate, z, allowed, segment);
  over_ = {motion.rate, most_speed};
  return motion.speed <= most_speed ? h : 0.0;
}

bool ImplicitStep::keeps_contacts(const Segment& segment, const Pins& pins) const {
  if (follows_) return true;
  const Forces& state = equations_.start_forces();
  const StageAxes missed = velocity_missed_at_start();
  const bool is_dry = system_.friction > 0.0 && system_.regularization == 0.0;
  const double lasts = at_start_ && is_dry && length_ > base_time_ ? std::exp(-length_ * ring_decay_) : 0.0;
  const double most = kMostOverForce + (kMostLastingOverForce - kMostOverForce) * lasts;
  // in the first step of all the nodes alone tell: the polynomial may begin at the state, with the ring in it
  const auto begins_at = [&](const Series& force, const Octet& at_nodes) {
    return at_start_ ? weighted_sum(stage_table().at_start, at_nodes) : force[0];
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(segment.loaded_count); ++i) {
    const ContactSeries& contact = segment.loaded[i];
    if (pins[static_cast<std::size_t>(contact.site)].normal > 0) continue;  // N starts from zero
    const Face face = segment.contacts[static_cast<std::size_t>(contact.site)].face;
    const ContactForceOctet& at_nodes = equations_.forces().contact[i];
    const double of_state = state.contact[i].normal_force;
    const double of_step = begins_at(contact.normal_force, at_nodes.normal_force);
    const double of_speed = spring_force_of(system_, equations_.start(), contact.site, face, missed);
    const double ring = std::hypot(of_state - of_step, of_speed);
    if (!(ring <= most * std::min(of_state, of_step))) return false;
    // later on the series have followed what was large
    if (!at_start_ || slip_of(segment, contact) != Slip::stick) continue;
    const double held = begins_at(contact.tangential_force, at_nodes.tangential_force);
    const double most_held = std::abs(held) + std::abs(state.contact[i].tangential_force - held);
    if (most_held > system_.friction * (of_step - ring)) return false;
  }
  return true;
}

bool ImplicitStep::follows_base(double step, const DriveForms& drives) const {
  return step < kResolved * base_time_ && step < kShortForDrive * longest_drive_step(drives);
}

/// Next length over h after an error of `ratio` times the one allowed: that of order s, and where errors have risen
/// from the last step to this one, less by as much as they would rise again (Gustafsson's predictive control).
double ImplicitStep::growth(double h, double ratio) const {
  constexpr double kPower = 1.0 / (kStages + 1);
  const double least = 1e-30;
  double factor = kSafety * std::pow(ratio + least, -kPower);
  if (last_length_ > 0.0 && ratio <= 1.0)
    factor = std::min(factor, kSafety * h / last_length_ * std::pow(last_ratio_ / (ratio * ratio + least), kPower));
  return std::clamp(factor, kLeastGrowth, kMostGrowth);
}

bool ImplicitStep::retake(double h, Segment& segment, SolverCounts& counts) {
  if (equations_.solve(h, counts) && !(equations_.in_layer() && error(h) > equations_.allowed(h))) {
    fill(h, segment);
    return true;
  }
  equations_.drop_solution();
  return false;
}

/// The polynomials of the step as power series of the segment.
void ImplicitStep::fill(double h, Segment& segment) {
  length_ = h;
  segment.order = kDegree;
  segment.friction = system_.friction;
  segment.loaded_count = equations_.start_forces().count;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const double rate = 1.0 / h;
    Octet rates = 1.0;  // powers of the rate
    for (std::size_t k = 1; k < Octet::kSize; ++k) rates[k] = rates[k - 1] * rate;
    const State& start = equations_.start();
    const Stages& acceleration = equations_.acceleration();
    integrate(start.x, start.vx, acceleration[0], rates, segment.x, segment.vx);
    integrate(start.y, start.vy, acceleration[1], rates, segment.y, segment.vy);
    integrate(start.phi, start.omega, acceleration[2], rates, segment.phi, segment.omega);

    // N and T on a stiff base depend on the last digits of the start: they go on from the step before. Just after a
    // jump they may be what a long step does not follow
    const Forces &start_forces = equations_.start_forces(), &before = equations_.forces_before();
    for (std::size_t c = 0; c < static_cast<std::size_t>(segment.loaded_count); ++c) {
      ContactSeries& contact = segment.loaded[c];
      const ContactForceOctet& at_nodes = equations_.forces().contact[c];
      const ContactForce &now = start_forces.contact[c], &last = before.contact[c];
      contact.site = now.site;
      interpolate(now.depth, at_nodes.depth, rates, contact.depth);
      interpolate(force_to_begin_with(last.normal_force, at_nodes.normal_force, follows_), at_nodes.normal_force, rates,
                  contact.normal_force);
      interpolate(force_to_begin_with(last.tangential_force, at_nodes.tangential_force, follows_),
                  at_nodes.tangential_force, rates, contact.tangential_force);
      if (slip_of(segment, contact) == Slip::stick)
        std::fill(contact.slip_velocity.begin(), contact.slip_velocity.begin() + kDegree + 1, 0.0);
      else
        interpolate(now.slip_velocity, at_nodes.slip_velocity, rates, contact.slip_velocity);
    }
    const Load3& start_drive = equations_.start_drive();
    interpolate(start_drive.x, equations_.drive().x, rates, segment.drive_x);
    interpolate(start_drive.y, equations_.drive().y, rates, segment.drive_y);
    interpolate(start_drive.phi, equations_.drive().phi, rates, segment.drive_phi);
  });
}

}  // namespace vibratory_alignment
