#include "solver/implicit_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace vibratory_alignment {
namespace {

constexpr int kMostIterations = 10;

/// Newton's last correction as a share of the error allowed.
constexpr double kConverged = 1e-2;

/// Differences for the Jacobian, relative to the size of the part and its speed; in the tanh layer to its width.
constexpr double kDifference = 1e-7, kLayerDifference = 1e-3;

/// Steps shorter than this share of the longest are not tried.
constexpr double kShortest = 1e-14;

/// Steps after which the cheap iteration gets another chance where it has failed.
constexpr int kForget = 16;

/// Rounding of coordinates and velocities, relative to the size of the part and its speed.
constexpr double kRounding = 4e-16;

/// The first step after a jump of the forces is tried with so many times the last such step.
constexpr double kRestartGrowth = 2.0;

/// Longest step in radians of the fastest excitation: where all that moves is stiff, nothing but N shows that a longer
/// one is not resolved, and the error estimate filters it out.
constexpr double kLongestDrive = 1.5;

double longest_drive_step(const DriveForms& drives) {
  double fastest = 0.0;
  for (int i = 0; i < drives.count; ++i)
    fastest = std::max(fastest, std::abs(drives.form[static_cast<std::size_t>(i)].frequency));
  return fastest > 0.0 ? kLongestDrive / fastest : std::numeric_limits<double>::infinity();
}

Load3 drive_at(const DriveForms& drives, double t) {
  Load3 load;
  for (int i = 0; i < drives.count; ++i) {
    const double value = drives.form[static_cast<std::size_t>(i)].at(t);
    const Direction direction = drives.direction[static_cast<std::size_t>(i)];
    (direction == Direction::x ? load.x : direction == Direction::y ? load.y : load.phi) += value;
  }
  return load;
}

/// Time in which the base alone answers, at least: its period over 2 pi, or the time in which its damper stops the
/// part.
double base_time(const System& system) {
  const double reach = system.half_width * system.half_width + system.base_distance * system.base_distance;
  const double mobility =
      std::max(system.x.inverse_inertia, system.y.inverse_inertia) + reach * system.phi.inverse_inertia;
  const double stiffness = std::max(system.stiffness_x, system.stiffness_y);
  const double damping = std::max(system.damping_x, system.damping_y);
  return 1.0 / std::max(std::sqrt(stiffness * mobility), damping * mobility);
}

}  // namespace

ImplicitStep::ImplicitStep(const System& system, double tolerance)
    : system_(system), tolerance_(tolerance), base_time_(base_time(system)) {}

void ImplicitStep::evaluate(const State& state, double t, Forces& forces, SolverCounts& counts) const {
  evaluate_forces(system_, state, drive_at(*drives_, t), *contacts_, forces);
  ++counts.rhs_evaluations;
}

/// Jacobians of the accelerations at a state where these are `forces`, by differences.
ImplicitStep::Jacobian ImplicitStep::jacobian(const State& state, double t, const Forces& forces,
                                              SolverCounts& counts) const {
  Jacobian result{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  const double length = std::abs(state.x) + std::abs(state.y) + system_.half_width + system_.base_distance;
  const double speed = std::abs(state.vx) + std::abs(state.vy) + length * std::abs(state.omega);
  double velocity_step = kDifference * (speed + length);
  if (system_.regularization > 0.0) velocity_step = std::min(velocity_step, kLayerDifference * system_.regularization);
  const double position_step = kDifference * length;
  const auto column = [&](double State::*member, double step, Eigen::Matrix3d& matrix, int index) {
    State moved = state;
    moved.*member += step;
    Forces there;
    evaluate(moved, t, there, counts);
    const double actual = moved.*member - state.*member;
    matrix(0, index) = (there.ax - forces.ax) / actual;
    matrix(1, index) = (there.ay - forces.ay) / actual;
    matrix(2, index) = (there.alpha - forces.alpha) / actual;
  };
  const auto axis = [&](bool moves, double State::*q, double State::*v, double q_step, double v_step, int index) {
    if (!moves) return;
    column(q, q_step, result.by_position, index);
    column(v, v_step, result.by_velocity, index);
  };
  axis(system_.x.moves, &State::x, &State::vx, position_step, velocity_step, 0);
  axis(system_.y.moves, &State::y, &State::vy, position_step, velocity_step, 1);
  axis(system_.phi.moves, &State::phi, &State::omega, kDifference, velocity_step / length, 2);
  return result;
}

/// The inverses for Newton's method with the Jacobian of the start for all stages.
void ImplicitStep::linearise(double h, SolverCounts& counts) {
  start_jacobian_ = jacobian(start_, 0.0, start_forces_, counts);
  const Jacobian& start = start_jacobian_;
  const Collocation& table = collocation();
  for (std::size_t m = 0; m < inverse_.size(); ++m) {
    const std::complex<double> z = h * table.eigenvalue[m];
    const Eigen::Matrix3cd matrix = Eigen::Matrix3cd::Identity() - z * start.by_velocity - z * z * start.by_position;
    const Eigen::Matrix3cd inverse = matrix.partialPivLu().inverse();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inverse_[m][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = inverse(i, j);
  }
  rounding_ = rounding(h);
}

/// What rounding of the coordinates and velocities makes of the velocities in a step: no iteration converges and no
/// error is known beyond it.
double ImplicitStep::rounding(double h) const {
  const double length = std::abs(start_.x) + std::abs(start_.y) + system_.half_width + system_.base_distance;
  const double speed = std::abs(start_.vx) + std::abs(start_.vy);
  const auto of_column = [this](const Eigen::Matrix3d& matrix, int column) {
    return size_of(filter({matrix(0, column), matrix(1, column), matrix(2, column)}));
  };
  double sum = 0.0;
  for (int axis = 0; axis < 2; ++axis)
    sum += length * of_column(start_jacobian_.by_position, axis) + speed * of_column(start_jacobian_.by_velocity, axis);
  return kRounding * h * sum;
}

/// The matrix of Newton's method with the Jacobian of every stage, on the way that the start's velocity leads: a stiff
/// normal that turns during the step needs it.
void ImplicitStep::linearise_stages(double h, SolverCounts& counts) {
  const Collocation& table = collocation();
  Eigen::Matrix<double, kUnknowns, kUnknowns> matrix;
  for (std::size_t i = 0; i < kStages; ++i) {
    const double t = table.node[i] * h;
    State ahead = start_;
    ahead.x += t * start_.vx;
    ahead.y += t * start_.vy;
    ahead.phi += t * start_.omega;
    Forces forces;
    evaluate(ahead, t, forces, counts);
    const Jacobian there = jacobian(ahead, t, forces, counts);
    for (std::size_t j = 0; j < kStages; ++j)
      matrix.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          -h * table.velocity[i][j] * there.by_velocity - h * h * table.position[i][j] * there.by_position;
  }
  matrix.diagonal().array() += 1.0;
  coupled_.compute(matrix);
}

/// States of the stages from their accelerations.
void ImplicitStep::place_stages(double h) {
  const Collocation& table = collocation();
  for (std::size_t i = 0; i < kStages; ++i) {
    Axes dv{}, dq{};
    for (std::size_t j = 0; j < kStages; ++j)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        dv[axis] += table.velocity[i][j] * acceleration_[j][axis];
        dq[axis] += table.position[i][j] * acceleration_[j][axis];
      }
    const double t = table.node[i] * h;
    stage_[i] = {start_.x + t * start_.vx + h * h * dq[0],
                 start_.y + t * start_.vy + h * h * dq[1],
                 start_.phi + t * start_.omega + h * h * dq[2],
                 start_.vx + h * dv[0],
                 start_.vy + h * dv[1],
                 start_.omega + h * dv[2]};
  }
}

/// Speed of the part during the step, and what the contact forces alone would make of it: the measure of errors.
double ImplicitStep::speed_scale(double h) const {
  const double reach = system_.half_width + system_.base_distance;
  double most = std::abs(start_.vx) + std::abs(start_.vy) + reach * std::abs(start_.omega), push = 0.0;
  for (const State& s : stage_) most = std::max(most, std::abs(s.vx) + std::abs(s.vy) + reach * std::abs(s.omega));
  for (int i = 0; i < start_forces_.count; ++i) push += std::abs(start_forces_.contact[i].normal_force);
  return most + h * push * std::max(system_.x.inverse_inertia, system_.y.inverse_inertia);
}

/// What is left of an acceleration when what is stiff is taken out of it.
ImplicitStep::Axes ImplicitStep::filter(const Axes& acceleration) const {
  Axes filtered{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t axis = 0; axis < 3; ++axis) filtered[row] += inverse_[0][row][axis].real() * acceleration[axis];
  return filtered;
}

double ImplicitStep::size_of(const Axes& acceleration) const {
  const double reach = system_.half_width + system_.base_distance;
  return std::abs(acceleration[0]) + std::abs(acceleration[1]) + reach * std::abs(acceleration[2]);
}

/// Error of the velocities that a step may make.
double ImplicitStep::allowed(double h) const { return std::max(tolerance_ * speed_scale(h), rounding_); }

void ImplicitStep::restart(bool base_rings) {
  restarts_ = !base_rings;
  if (base_rings)
    next_step_ = base_time_;
  else if (restart_step_ > 0.0)
    next_step_ = std::min(next_step_, kRestartGrowth * restart_step_);
}

/// In the modes of A the equations decouple.
ImplicitStep::Stages ImplicitStep::decoupled_correction(const Stages& residual) const {
  const Collocation& table = collocation();
  Stages correction{};
  for (std::size_t m = 0; m < table.eigenvalue.size(); ++m) {
    std::array<std::complex<double>, 3> projected{}, solved{};
    for (std::size_t i = 0; i < kStages; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) projected[axis] += table.dual[m][i] * residual[i][axis];
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t axis = 0; axis < 3; ++axis) solved[row] += inverse_[m][row][axis] * projected[axis];
    const double weight = m == 0 ? 1.0 : 2.0;  // a complex mode comes with its conjugate
    for (std::size_t i = 0; i < kStages; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        correction[i][axis] += weight * (table.mode[m][i] * solved[axis]).real();
  }
  return correction;
}

ImplicitStep::Stages ImplicitStep::coupled_correction(const Stages& residual) const {
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

/// Newton's iteration on a_i = f(t_i, q_i, v_i) with fixed Jacobians; false when it does not converge.
bool ImplicitStep::iterate(double h, bool coupled, SolverCounts& counts) {
  const Collocation& table = collocation();
  for (Axes& a : acceleration_) a = {};
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    place_stages(h);
    Stages residual;
    bool finite = true;
    for (std::size_t i = 0; i < kStages; ++i) {
      evaluate(stage_[i], table.node[i] * h, forces_[i], counts);
      const Forces& f = forces_[i];
      residual[i] = {f.ax - acceleration_[i][0], f.ay - acceleration_[i][1], f.alpha - acceleration_[i][2]};
      finite = finite && std::isfinite(f.ax + f.ay + f.alpha);
    }
    if (!finite) return false;
    const Stages correction = coupled ? coupled_correction(residual) : decoupled_correction(residual);
    for (std::size_t i = 0; i < kStages; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) acceleration_[i][axis] += correction[i][axis];
    // what the correction makes of the velocities
    double change = 0.0;
    for (std::size_t i = 0; i < kStages; ++i) {
      Axes dv{};
      for (std::size_t j = 0; j < kStages; ++j)
        for (std::size_t axis = 0; axis < 3; ++axis) dv[axis] += table.velocity[i][j] * correction[j][axis];
      change = std::max(change, h * size_of(dv));
    }
    // converged, or as far as rounding lets it
    const double most = allowed(h);
    const bool stagnates = iteration > 0 && change > 0.5 * before;
    if (change <= kConverged * most || (stagnates && change <= most)) {
      place_stages(h);
      for (std::size_t i = 0; i < kStages; ++i) evaluate(stage_[i], table.node[i] * h, forces_[i], counts);
      return true;
    }
    if (stagnates && iteration > 1) return false;
    before = change;
  }
  return false;
}

bool ImplicitStep::solve(double h, SolverCounts& counts) {
  linearise(h, counts);
  if (!couples_ && iterate(h, false, counts)) return true;
  // where the cheap iteration has failed it is not tried first again for some steps
  couples_ = true;
  linearise_stages(h, counts);
  return iterate(h, true, counts);
}

/// Error of the velocities: what the polynomial of the accelerations misses at the start, without its stiff part. What
/// is stiff is damped by the method and, below the tolerance in position, is not to be followed: it is filtered twice.
double ImplicitStep::error(double h) const {
  const Collocation& table = collocation();
  Axes missed = {start_forces_.ax, start_forces_.ay, start_forces_.alpha};
  for (std::size_t j = 0; j < kStages; ++j)
    for (std::size_t axis = 0; axis < 3; ++axis) missed[axis] -= table.at_start[j] * acceleration_[j][axis];
  return h * table.eigenvalue[0].real() * size_of(filter(filter(missed)));
}

double ImplicitStep::take(const State& start, const DriveForms& drives, double longest, double shortest,
                          Segment& segment, SolverCounts& counts) {
  start_ = start;
  drives_ = &drives;
  contacts_ = &segment.contacts;
  evaluate(start, 0.0, start_forces_, counts);
  if (++steps_ % kForget == 0) couples_ = false;
  longest = std::min(longest, longest_drive_step(drives));
  double h = next_step_ > 0.0 ? std::min(next_step_, longest) : longest;
  shortest = std::max(shortest, kShortest * longest);
  while (h > shortest) {
    if (solve(h, counts)) {
      const double ratio = error(h) / allowed(h);
      const double factor = std::clamp(0.8 * std::pow(ratio + 1e-30, -1.0 / (kStages + 1)), 0.1, 2.5);
      if (ratio <= 1.0) {
        // a step that was cut short says nothing about longer ones
        next_step_ = std::max(h == longest ? next_step_ : 0.0, h * std::max(0.5, factor));
        if (restarts_) restart_step_ = h;
        restarts_ = false;
        fill(h, segment);
        end_ = stage_[kStages - 1];
        return h;
      }
      h *= std::min(0.9, factor);
    } else {
      h *= 0.25;
    }
    ++counts.rejected;
  }
  return 0.0;
}

bool ImplicitStep::retake(double h, Segment& segment, SolverCounts& counts) {
  if (!solve(h, counts)) return false;
  fill(h, segment);
  end_ = stage_[kStages - 1];
  return true;
}

/// The polynomials of the step as power series of the segment.
void ImplicitStep::fill(double h, Segment& segment) const {
  const Collocation& table = collocation();
  constexpr int kDegree = kStages + 1;
  segment.order = kDegree;
  const auto axis_series = [&](std::size_t axis, double q0, double v0, Series& q, Series& v) {
    q[0] = q0;
    q[1] = v[0] = v0;
    double power = 1.0;
    for (int k = 0; k < kStages; ++k, power /= h) {
      double a = 0.0;
      for (std::size_t j = 0; j < kStages; ++j)
        a += table.acceleration_power[static_cast<std::size_t>(k)][j] * acceleration_[j][axis];
      v[static_cast<std::size_t>(k + 1)] = a * power / (k + 1);
      q[static_cast<std::size_t>(k + 2)] = a * power / ((k + 1) * (k + 2));
    }
    v[kDegree] = 0.0;
  };
  axis_series(0, start_.x, start_.vx, segment.x, segment.vx);
  axis_series(1, start_.y, start_.vy, segment.y, segment.vy);
  axis_series(2, start_.phi, start_.omega, segment.phi, segment.omega);

  // polynomials through the values at the start and at the nodes
  std::array<double, kStages + 1> values{};
  const auto interpolate = [&](Series& series) {
    double power = 1.0;
    for (std::size_t k = 0; k <= kStages; ++k, power /= h) {
      double sum = 0.0;
      for (std::size_t j = 0; j <= kStages; ++j) sum += table.value_power[k][j] * values[j];
      series[k] = sum * power;
    }
    series[kDegree] = 0.0;
  };
  const auto through = [&](Series& series, const auto& value_of) {
    values[0] = value_of(start_forces_);
    for (std::size_t i = 0; i < kStages; ++i) values[i + 1] = value_of(forces_[i]);
    interpolate(series);
  };
  segment.loaded_count = start_forces_.count;
  for (std::size_t c = 0; c < static_cast<std::size_t>(start_forces_.count); ++c) {
    ContactSeries& contact = segment.loaded[c];
    contact.site = start_forces_.contact[c].site;
    through(contact.depth, [c](const Forces& f) { return f.contact[c].depth; });
    through(contact.normal_force, [c](const Forces& f) { return f.contact[c].normal_force; });
    through(contact.tangential_force, [c](const Forces& f) { return f.contact[c].tangential_force; });
    if ((*contacts_)[static_cast<std::size_t>(contact.site)].slip == Slip::stick)
      std::fill(contact.slip_velocity.begin(), contact.slip_velocity.begin() + kDegree + 1, 0.0);
    else
      through(contact.slip_velocity, [c](const Forces& f) { return f.contact[c].slip_velocity; });
  }
  const auto drive_series = [&](double Load3::*axis, Series& series) {
    values[0] = drive_at(*drives_, 0.0).*axis;
    for (std::size_t i = 0; i < kStages; ++i) values[i + 1] = drive_at(*drives_, table.node[i] * h).*axis;
    interpolate(series);
  };
  drive_series(&Load3::x, segment.drive_x);
  drive_series(&Load3::y, segment.drive_y);
  drive_series(&Load3::phi, segment.drive_phi);
}

}  // namespace vibratory_alignment
