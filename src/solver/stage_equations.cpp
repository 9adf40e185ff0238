#include "solver/stage_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "mechanics/contact_frame.h"
#include "solver/layer_flutter.h"

namespace vibratory_alignment {
namespace {

/// Newton's iterations, at most: where a step is to be solved easily, and otherwise.
constexpr int kEasyIterations = 6, kMostIterations = 10;

/// Iterations in which corrections may grow.
constexpr int kTrials = 3;

/// Newton's last correction as a share of the error allowed; and the next one, as foreseen where corrections fall at
/// least at this rate.
constexpr double kConverged = 1e-2, kForeseen = 1e-3, kFast = 0.1;

/// A residual that needs no correction, as a share of the error allowed, where rounding does not hide it; and one that
/// a correction may leave, as foreseen: what N of the state is beyond the N that the accelerations are made by.
constexpr double kSettled = 1e-5, kLeft = 0.1;

/// Corrections may come in pairs of about the same size: a later one that is not this much smaller than the one before
/// the last does not get smaller.
constexpr double kPairs = 0.1;

/// Rounding of coordinates and velocities, relative to the size of the part and its speed.
constexpr double kRounding = 4e-16;

/// Error of the velocities in the tanh layer at most, as a share of its width: T follows V, however large N is.
constexpr double kLayerError = 0.01;

/// A solution is continued over at most so many times its length.
constexpr double kLongestGuess = 2.0;

Load3 drive_at_start(const DriveForms& drives) {
  Load3 load;
  for (int i = 0; i < drives.count; ++i) {
    const DriveForm& form = drives.form[static_cast<std::size_t>(i)];
    const Direction direction = drives.direction[static_cast<std::size_t>(i)];
    (direction == Direction::x ? load.x : direction == Direction::y ? load.y : load.phi) += form.at_start();
  }
  return load;
}

/// Adds N n + T t of a contact to the sum of the contact forces: several may hold each other by far more than that.
void add_force(const ContactKinematics& contact, double normal_force, double tangential_force, Vec2& sum) {
  sum.x += normal_force * contact.normal.x + tangential_force * contact.tangent.x;
  sum.y += normal_force * contact.normal.y + tangential_force * contact.tangent.y;
}

/// Positions and velocities of one axis at the stages from its accelerations. Returns the changes of the velocities.
VIBRATORY_ALIGNMENT_INLINE Octet place(double h, double q0, double v0, const Octet& acceleration, Octet& q, Octet& v) {
  const StageTable& table = stage_table();
  const Octet before = v;
  q = q0 + (h * v0) * table.node + (h * h) * combine(table.position, acceleration);
  v = v0 + h * combine(table.velocity, acceleration);
  return v - before;
}

}  // namespace

void StageEquations::begin(const State& start, const DriveForms& drives, const ContactStates& contacts, bool follows,
                           SolverCounts& counts) {
  Known& known = knowledge_[known_];
  known.ago = known.length;
  if (!follows) known.length = 0.0;
  known_before_ = known_;
  start_ = start;
  drives_ = &drives;
  contacts_ = &contacts;
  start_drive_ = drive_at_start(drives);
  evaluate_forces(system_, start, start_drive_, contacts, start_forces_);
  ++counts.rhs_evaluations;
  ++cost_;
  start_jacobian_ = force_jacobian(system_, start, contacts, start_forces_);
  start_push_ = {};
  start_pushes_ = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(start_forces_.count); ++i) {
    const ContactForce& force = start_forces_.contact[i];
    const Face face = contacts[static_cast<std::size_t>(force.site)].face;
    add_force(contact_kinematics(system_, start, force.site, face), force.normal_force, force.tangential_force,
              start_push_);
    start_pushes_ += std::abs(force.normal_force) + std::abs(force.tangential_force);
  }
  forces_before_ = follows ? forces_[kStages - 1] : start_forces_;
}

/// Accelerations and normal forces at the nodes to begin with: the polynomials of the solution at hand, continued.
void StageEquations::guess(double h) {
  const StageTable& table = stage_table();
  const auto contacts = static_cast<std::size_t>(start_forces_.count);
  const Known& known = knowledge_[known_];
  if (known.length == 0.0 || h > kLongestGuess * known.length) {
    acceleration_ = {start_forces_.ax, start_forces_.ay, start_forces_.alpha};
    for (std::size_t c = 0; c < contacts; ++c) acting_[c] = start_forces_.contact[c].normal_force;
    return;
  }
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    // what a value at the nodes counts at each of the new nodes: Lagrange's polynomials
    const Octet t = (known.ago + table.node * h) / known.length;
    std::array<Octet, kStages> weight;
    for (std::size_t j = 0; j < kStages; ++j) {
      weight[j] = table.lagrange[kStages - 1][j];
      for (std::size_t k = kStages - 1; k-- > 0;) weight[j] = weight[j] * t + table.lagrange[k][j];
    }
    for (std::size_t axis = 0; axis < 3; ++axis) acceleration_[axis] = combine(weight, known.acceleration[axis]);
    for (std::size_t c = 0; c < contacts; ++c) acting_[c] = combine(weight, known.normal[c]);
  });
}

/// The forces of the solution are those that the accelerations are made by: N of the states hangs on the last digits of
/// their places.
void StageEquations::tell_acting() {
  for (std::size_t c = 0; c < static_cast<std::size_t>(start_forces_.count); ++c) {
    ContactForceOctet& force = forces_.contact[c];
    force.normal_force = acting_[c];
    if ((*contacts_)[static_cast<std::size_t>(forces_.site[c])].slip != Slip::stick)
      force.tangential_force = force.friction_ratio * force.normal_force;
  }
}

void StageEquations::keep_guess(double h) {
  known_ = 1 - known_before_;
  Known& known = knowledge_[known_];
  known.acceleration = acceleration_;
  for (std::size_t c = 0; c < static_cast<std::size_t>(start_forces_.count); ++c)
    known.normal[c] = forces_.contact[c].normal_force;
  known.length = h;
  known.ago = 0.0;
}

/// What rounding of the coordinates and velocities makes of the accelerations, times h: no residual is smaller. What is
/// left of it without its stiff part is how far velocities are known: no iteration converges and no error is known
/// beyond it.
void StageEquations::set_rounding(double h) {
  const double length = size_of_place(start_.x, start_.y);
  const double speed = std::abs(start_.vx) + std::abs(start_.vy);
  noise_ = rounding_ = 0.0;
  const auto add = [&](const Eigen::Matrix3d& matrix, int column, double size) {
    const StageAxes rate = {matrix(0, column), matrix(1, column), matrix(2, column)};
    noise_ += kRounding * h * size * size_of(rate);
    rounding_ += kRounding * h * size * size_of(filter(rate));
  };
  for (int axis = 0; axis < 2; ++axis) {
    add(start_jacobian_.by_position, axis, length);
    add(start_jacobian_.by_velocity, axis, speed);
  }
  add(start_jacobian_.by_position, 2, std::abs(start_.phi));
  add(start_jacobian_.by_velocity, 2, std::abs(start_.omega));
  // forces that hold each other are rounded as well, and leave nothing else in the Jacobian
  const double of_forces = kRounding * speed_of_push({start_pushes_, start_pushes_}, h);
  noise_ += of_forces;
  rounding_ += of_forces;
}

/// States of the stages from their accelerations. Returns the largest change of a velocity.
double StageEquations::place_stages(double h) {
  double change = 0.0;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    Stages changes;
    changes[0] = place(h, start_.x, start_.vx, acceleration_[0], stages_.x, stages_.vx);
    changes[1] = place(h, start_.y, start_.vy, acceleration_[1], stages_.y, stages_.vy);
    changes[2] = place(h, start_.phi, start_.omega, acceleration_[2], stages_.phi, stages_.omega);
    const Octet sizes = sizes_of(changes);
    change = all_finite(sizes) ? largest(sizes) : std::numeric_limits<double>::infinity();
  });
  return change;
}

/// Speed of the part during the step, and what the contact forces together would make of it: the measure of errors.
double StageEquations::speed_scale(double h) const {
  double most = 0.0;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    most = largest(sizes_of({stages_.vx, stages_.vy, stages_.omega}));
  });
  return std::max(most, size_of({start_.vx, start_.vy, start_.omega})) + speed_of_push(start_push_, h);
}

/// What a force makes of the part's speed in the time h, along the axes that are free.
double StageEquations::speed_of_push(const Vec2& push, double h) const {
  return h * (std::abs(push.x) * system_.x.inverse_inertia + std::abs(push.y) * system_.y.inverse_inertia);
}

/// Coordinates are exact to kRounding of this.
double StageEquations::size_of_place(double x, double y) const {
  return std::abs(x) + std::abs(y) + system_.half_width + system_.base_distance;
}

StageAxes StageEquations::filter(const StageAxes& acceleration) const {
  StageAxes filtered{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t axis = 0; axis < 3; ++axis)
      filtered[row] +=
          modes_.filter()(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(axis)) * acceleration[axis];
  return filtered;
}

std::optional<Eigen::Matrix3d> StageEquations::filter_at_end(double h) const {
  const ForceJacobian there = force_jacobian(system_, end(), *contacts_, forces_[kStages - 1]);
  if (flutters_within(h, there)) return std::nullopt;
  const double z = h * collocation().eigenvalue[0].real();
  return Eigen::Matrix3d((Eigen::Matrix3d::Identity() - z * there.by_velocity - z * z * there.by_position).inverse());
}

double StageEquations::size_of(const StageAxes& acceleration) const {
  const double reach = system_.half_width + system_.base_distance;
  return std::abs(acceleration[0]) + std::abs(acceleration[1]) + reach * std::abs(acceleration[2]);
}

VIBRATORY_ALIGNMENT_INLINE Octet StageEquations::sizes_of(const Stages& acceleration) const {
  const double reach = system_.half_width + system_.base_distance;
  return abs(acceleration[0]) + abs(acceleration[1]) + reach * abs(acceleration[2]);
}

double StageEquations::allowed(double h) const {
  const double layer = in_layer() ? kLayerError * system_.regularization : std::numeric_limits<double>::infinity();
  return std::max(std::min(tolerance_ * speed_scale(h), layer), rounding_);
}

double StageEquations::allowed_at_start(double h) const {
  return tolerance_ * (size_of({start_.vx, start_.vy, start_.omega}) + speed_of_push(start_push_, h));
}

double StageEquations::allowed_from(const Segment& segment, double h) const {
  Vec2 push;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& force = segment.loaded[i];
    const ContactState& contact = segment.contacts[static_cast<std::size_t>(force.site)];
    if (contact.phase != Phase::loaded) continue;
    add_force(contact_kinematics(system_, segment.begin, force.site, contact.face), force.normal_force[0],
              force.tangential_force[0], push);
  }
  return tolerance_ * (size_of({segment.vx[0], segment.vy[0], segment.omega[0]}) + speed_of_push(push, h));
}

double StageEquations::depth_rounding(const Segment& segment) const {
  double along_normal = 0.0;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Site site = segment.loaded[i].site;
    const ContactState& contact = segment.contacts[static_cast<std::size_t>(site)];
    if (contact.phase != Phase::loaded) continue;
    const Vec2 normal = contact_kinematics(system_, segment.begin, site, contact.face).normal;
    along_normal = std::max(along_normal, std::abs(normal.x * segment.begin.x) + std::abs(normal.y * segment.begin.y));
  }
  return kRounding * (along_normal + system_.half_width + system_.base_distance);
}

/// Forces at the stages, and what these leave of f - a where the acting normal forces change by as much as those of the
/// states are beyond them, in the directions of the start. Returns the largest.
double StageEquations::evaluate_stages(Stages& residual, SolverCounts& counts) {
  const bool at_once = evaluate_forces_under(acting_, system_, stages_, drive_, *contacts_, forces_);
  cost_ += at_once ? kStages : kHeldApart * kStages;
  counts.rhs_evaluations += kStages;
  double most = 0.0;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA { most = residual_under(residual); });
  return most;
}

VIBRATORY_ALIGNMENT_INLINE double StageEquations::residual_under(Stages& residual) const {
  residual = {forces_.ax - acceleration_[0], forces_.ay - acceleration_[1], forces_.alpha - acceleration_[2]};
  for (std::size_t c = 0; c < static_cast<std::size_t>(forces_.count); ++c) {
    const Octet beyond = forces_.contact[c].normal_force - acting_[c];
    for (std::size_t axis = 0; axis < 3; ++axis)
      residual[axis] += start_jacobian_.normal[c].push[static_cast<Eigen::Index>(axis)] * beyond;
  }
  const Octet sizes = sizes_of(residual);
  return all_finite(sizes) ? largest(sizes) : std::numeric_limits<double>::infinity();
}

/// Takes the residual out, and foresees the normal forces: from the corrections themselves, for the last digits of the
/// places are forces on a stiff base. Returns the largest change of a velocity.
double StageEquations::correct(const Stages& residual, double h) {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    Stages correction;
    layer_.correction(residual, forces_, acting_, correction);
    for (std::size_t axis = 0; axis < 3; ++axis) acceleration_[axis] += correction[axis];
    for (std::size_t c = 0; c < static_cast<std::size_t>(start_forces_.count); ++c)
      acting_[c] =
          forces_.contact[c].normal_force +
          change_at_stages(start_jacobian_.normal[c].by_position, start_jacobian_.normal[c].by_velocity, h, correction);
  });
  return place_stages(h);
}

bool StageEquations::solve(double h, SolverCounts& counts, bool easily, long most_cost) {
  evaluate_drives(drives_->form.data(), drives_->direction.data(), drives_->count, h * stage_table().node, drive_);
  modes_.set(h, start_jacobian_);
  if (modes_.passes_over_growth() || flutters_within(h, start_jacobian_)) return false;
  layer_.set(modes_, h, start_jacobian_, start_forces_);
  set_rounding(h);
  guess(h);
  place_stages(h);
  double before = std::numeric_limits<double>::infinity(), before_that = before;
  const int most_iterations = easily ? kEasyIterations : kMostIterations;
  double enough = allowed(h);
  const long cost_before = cost_;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Stages residual;
    const double left = evaluate_stages(residual, counts);
    if (!std::isfinite(left)) return false;
    if (h * left <= std::max(kSettled * enough, std::min(noise_, kConverged * enough))) {
      keep_guess(h);
      return true;
    }
    const double change = correct(residual, h);
    // converged, or as far as rounding lets it; and so that N of the states is the one that acts
    enough = allowed(h);
    const double rate = iteration > 0 ? change / before : 1.0;
    const bool stagnates = iteration > 0 && rate > 0.5, foreseen = rate <= kFast && rate * change <= kForeseen * enough;
    const bool converged = change <= kConverged * enough || foreseen || (stagnates && change <= enough);
    if (converged && std::min(rate, 1.0) * h * left <= std::max(kLeft * enough, noise_)) {
      evaluate_stages(residual, counts);
      tell_acting();
      keep_guess(h);
      return true;
    }
    if (cost_ - cost_before > most_cost) return false;
    if (stagnates && change > kPairs * before_that && iteration >= kTrials) return false;
    before_that = before;
    before = change;
  }
  return false;
}

}  // namespace vibratory_alignment
