#include "solver/stage_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibratory_alignment {
namespace {

/// Newton's iterations, at most: where a step is to be solved easily, and otherwise.
constexpr int kEasyIterations = 6, kMostIterations = 10;

/// Iterations in which corrections may grow.
constexpr int kTrials = 3;

/// Newton's last correction as a share of the error allowed.
constexpr double kConverged = 1e-2;

/// A residual that needs no correction, as a share of the error allowed, where rounding does not hide it.
constexpr double kSettled = 1e-5;

/// A correction that is not this much smaller than the one before shows that Jacobians are to be taken anew.
constexpr double kSlow = 0.1;

/// Steps with the Jacobian of every stage before the modes get another chance where they have failed: at first; twice
/// as many each time they fail again before they have solved so many steps; and at most. In the tanh layer, where a
/// failure shortens the step, most.
constexpr int kFewestCoupledSteps = 1, kRarely = 8, kMostCoupledSteps = 16;

/// Rounding of coordinates and velocities, relative to the size of the part and its speed.
constexpr double kRounding = 4e-16;

/// A solution is continued over at most so many times its length.
constexpr double kLongestGuess = 2.0;

Load3 drive_at(const DriveForms& drives, double t) {
  Load3 load;
  for (int i = 0; i < drives.count; ++i) {
    const double value = drives.form[static_cast<std::size_t>(i)].at(t);
    const Direction direction = drives.direction[static_cast<std::size_t>(i)];
    (direction == Direction::x ? load.x : direction == Direction::y ? load.y : load.phi) += value;
  }
  return load;
}

}  // namespace

void StageEquations::evaluate(const State& state, const Load3& drive, Forces& forces, SolverCounts& counts) const {
  evaluate_forces(system_, state, drive, *contacts_, forces);
  ++counts.rhs_evaluations;
}

void StageEquations::begin(const State& start, const DriveForms& drives, const ContactStates& contacts, bool follows,
                           SolverCounts& counts) {
  known_ago_ = known_length_;
  if (!follows) known_length_ = 0.0;
  start_ = start;
  drives_ = &drives;
  contacts_ = &contacts;
  start_drive_ = drive_at(drives, 0.0);
  evaluate(start, start_drive_, start_forces_, counts);
  start_jacobian_ = force_jacobian(system_, start, contacts, start_forces_);
  forces_before_ = follows ? forces_[kStages - 1] : start_forces_;
  if (coupled_steps_ > 0) --coupled_steps_;
  failures_ = 0;
}

/// Accelerations at the nodes to begin with: the polynomial of the solution at hand, continued.
void StageEquations::guess(double h) {
  const Collocation& table = collocation();
  if (known_length_ == 0.0 || h > kLongestGuess * known_length_) {
    for (StageAxes& a : acceleration_) a = {start_forces_.ax, start_forces_.ay, start_forces_.alpha};
    return;
  }
  Stages power{};
  for (std::size_t k = 0; k < kStages; ++k)
    for (std::size_t j = 0; j < kStages; ++j)
      for (std::size_t axis = 0; axis < 3; ++axis) power[k][axis] += table.acceleration_power[k][j] * known_[j][axis];
  for (std::size_t i = 0; i < kStages; ++i) {
    const double t = (known_ago_ + table.node[i] * h) / known_length_;
    StageAxes value = power[kStages - 1];
    for (std::size_t k = kStages - 1; k-- > 0;)
      for (std::size_t axis = 0; axis < 3; ++axis) value[axis] = value[axis] * t + power[k][axis];
    acceleration_[i] = value;
  }
}

void StageEquations::keep_guess(double h) {
  known_ = acceleration_;
  known_length_ = h;
  known_ago_ = 0.0;
}

/// The matrix of Newton's method with the Jacobian of every stage where it is now.
void StageEquations::linearise_stages(double h) {
  ++factorizations_;
  const Collocation& table = collocation();
  Eigen::Matrix<double, kUnknowns, kUnknowns> matrix;
  for (std::size_t i = 0; i < kStages; ++i) {
    const ForceJacobian there = force_jacobian(system_, stage_[i], *contacts_, forces_[i]);
    for (std::size_t j = 0; j < kStages; ++j)
      matrix.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          -h * table.velocity[i][j] * there.by_velocity - h * h * table.position[i][j] * there.by_position;
  }
  matrix.diagonal().array() += 1.0;
  coupled_.compute(matrix);
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
}

/// States of the stages from their accelerations. Returns the largest change of a velocity.
double StageEquations::place_stages(double h) {
  const Collocation& table = collocation();
  double largest = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < kStages; ++i) {
    StageAxes dv{}, dq{};
    for (std::size_t j = 0; j < kStages; ++j)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        dv[axis] += table.velocity[i][j] * acceleration_[j][axis];
        dq[axis] += table.position[i][j] * acceleration_[j][axis];
      }
    const double t = table.node[i] * h;
    const State before = stage_[i];
    stage_[i] = {start_.x + t * start_.vx + h * h * dq[0],
                 start_.y + t * start_.vy + h * h * dq[1],
                 start_.phi + t * start_.omega + h * h * dq[2],
                 start_.vx + h * dv[0],
                 start_.vy + h * dv[1],
                 start_.omega + h * dv[2]};
    const double change = size_of({stage_[i].vx - before.vx, stage_[i].vy - before.vy, stage_[i].omega - before.omega});
    largest = std::max(largest, change);
    sum += change;
  }
  return std::isfinite(sum) ? largest : std::numeric_limits<double>::infinity();
}

/// Speed of the part during the step, and what the contact forces alone would make of it: the measure of errors.
double StageEquations::speed_scale(double h) const {
  const double reach = system_.half_width + system_.base_distance;
  double most = std::abs(start_.vx) + std::abs(start_.vy) + reach * std::abs(start_.omega), push = 0.0;
  for (const State& s : stage_) most = std::max(most, std::abs(s.vx) + std::abs(s.vy) + reach * std::abs(s.omega));
  for (int i = 0; i < start_forces_.count; ++i) push += std::abs(start_forces_.contact[i].normal_force);
  return most + speed_of_push(push, h);
}

/// What a force makes of the part's speed in the time h.
double StageEquations::speed_of_push(double push, double h) const {
  return h * push * std::max(system_.x.inverse_inertia, system_.y.inverse_inertia);
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

Eigen::Matrix3d StageEquations::filter_at_end(double h) const {
  const ForceJacobian there = force_jacobian(system_, end(), *contacts_, forces_[kStages - 1]);
  const double z = h * collocation().eigenvalue[0].real();
  return (Eigen::Matrix3d::Identity() - z * there.by_velocity - z * z * there.by_position).inverse();
}

double StageEquations::size_of(const StageAxes& acceleration) const {
  const double reach = system_.half_width + system_.base_distance;
  return std::abs(acceleration[0]) + std::abs(acceleration[1]) + reach * std::abs(acceleration[2]);
}

double StageEquations::allowed(double h) const { return std::max(tolerance_ * speed_scale(h), rounding_); }

double StageEquations::allowed_from(const Segment& segment, double h) const {
  double push = 0.0;
  for (int i = 0; i < segment.loaded_count; ++i) push += std::abs(segment.loaded[i].normal_force[0]);
  return tolerance_ * (size_of({segment.vx[0], segment.vy[0], segment.omega[0]}) + speed_of_push(push, h));
}

double StageEquations::place_rounding(const Segment& segment) const {
  return kRounding * size_of_place(segment.x[0], segment.y[0]);
}

Stages StageEquations::coupled_correction(const Stages& residual) const {
  Eigen::Matrix<double, kUnknowns, 1> rhs;
  for (std::size_t i = 0; i < kStages; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) rhs[static_cast<Eigen::Index>(3 * i + axis)] = residual[i][axis];
  const Eigen::Matrix<double, kUnknowns, 1> solution = coupled_.solve(rhs);
  Stages correction;
  for (std::size_t i = 0; i < kStages; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      correction[i][axis] = solution[static_cast<Eigen::Index>(3 * i + axis)];
  return correction;
}

bool StageEquations::solve(double h, SolverCounts& counts, bool easily) {
  const Collocation& table = collocation();
  for (std::size_t i = 0; i < kStages; ++i) drive_[i] = drive_at(*drives_, table.node[i] * h);
  modes_.set(h, start_jacobian_);
  layer_.set(modes_, h, start_jacobian_, start_forces_);
  set_rounding(h);
  if (easily) return iterate(h, false, kEasyIterations, counts);
  if (coupled_steps_ == 0) {
    if (iterate(h, false, kMostIterations, counts)) {
      if (++solved_by_modes_ >= kRarely) next_coupled_steps_ = kFewestCoupledSteps;
      return true;
    }
    // in the tanh layer the step being too long is the likelier cause than the normal turning too far
    if (in_layer() && ++failures_ == 1) return false;
  }
  if (!iterate(h, true, kMostIterations, counts)) return false;
  if (coupled_steps_ == 0) {
    coupled_steps_ = in_layer() ? kMostCoupledSteps : next_coupled_steps_;
    next_coupled_steps_ = std::min(2 * next_coupled_steps_, kMostCoupledSteps);
    solved_by_modes_ = 0;
  }
  return true;
}

/// Newton's iteration from a guess: with the modes, or with the Jacobians of every stage, taken anew when that is slow.
/// False when it does not converge.
bool StageEquations::iterate(double h, bool coupled, int most_iterations, SolverCounts& counts) {
  guess(h);
  place_stages(h);
  double before = std::numeric_limits<double>::infinity(), before_that = before;
  bool renew = coupled;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Stages residual;
    double left = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < kStages; ++i) {
      evaluate(stage_[i], drive_[i], forces_[i], counts);
      const Forces& f = forces_[i];
      residual[i] = {f.ax - acceleration_[i][0], f.ay - acceleration_[i][1], f.alpha - acceleration_[i][2]};
      const double size = size_of(residual[i]);
      left = std::max(left, size);
      sum += size;
    }
    if (!std::isfinite(sum)) return false;
    const double enough = allowed(h);
    if (h * left <= std::max(kSettled * enough, std::min(noise_, kConverged * enough))) {
      keep_guess(h);
      return true;
    }
    if (renew) linearise_stages(h);
    const Stages correction = coupled ? coupled_correction(residual) : layer_.correction(residual, forces_);
    for (std::size_t i = 0; i < kStages; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) acceleration_[i][axis] += correction[i][axis];
    const double change = place_stages(h);
    // converged, or as far as rounding lets it
    const double most = allowed(h);
    const bool stagnates = iteration > 0 && change > 0.5 * before;
    if (change <= kConverged * most || (stagnates && change <= most)) {
      // the forces are those of the last states, or as near to them as rounding lets them be
      if (h * left > noise_)
        for (std::size_t i = 0; i < kStages; ++i) evaluate(stage_[i], drive_[i], forces_[i], counts);
      keep_guess(h);
      return true;
    }
    // where the normal turns every other correction may be a small one
    const bool stalls = stagnates && change > kSlow * before_that;
    if (stalls && iteration >= kTrials && (renew || !coupled)) return false;
    renew = coupled && change > kSlow * before;
    before_that = before;
    before = change;
  }
  return false;
}

}  // namespace vibratory_alignment
