// One implicit step in contact: Radau IIA collocation of order 13 (solver/collocation.h) on q'' = f(t, q, q'), whose
// length follows the motion and not the stiffness of the base, of a damper or of the tanh layer
// (docs/hybrid_step.md "Implicit steps").
#pragma once

#include <Eigen/LU>

#include "mechanics/forces.h"
#include "solver/collocation.h"
#include "solver/motion_series.h"
#include "solver/solver.h"

namespace vibratory_alignment {

class ImplicitStep {
 public:
  /// `tolerance`: error of the velocities per step, relative to the speed of the part.
  ImplicitStep(const System& system, double tolerance);

  /// Takes a step of at most `longest` from `start` with the loaded contacts of segment.contacts and fills the
  /// segment's series with its polynomials (powers of the time since its start). Returns its length, 0 when it would
  /// have to be shorter than `shortest` or when even the shortest does not converge. Counts forces and rejected steps.
  double take(const State& start, const DriveForms& drives, double longest, double shortest, Segment& segment,
              SolverCounts& counts);

  /// The last step once more, with the shorter length `h` at whose end an event lies: the state there then fulfils the
  /// equations of motion, as no point inside a step does on a stiff base. False when it does not converge.
  bool retake(double h, Segment& segment, SolverCounts& counts);

  /// Length that the next step is tried with first, and the one after a first jump of the forces.
  void suggest(double step) {
    next_step_ = step;
    if (restart_step_ == 0.0) restart_step_ = step;
  }

  /// The forces have just jumped: the next step is as short as the one after the last jump could be. `base_rings`: the
  /// normal forces are among them, and the next step follows the base.
  void restart(bool base_rings);

  /// The state at the end of the last step.
  const State& end() const { return end_; }

 private:
  static constexpr int kStages = Collocation::kStages;
  using Axes = std::array<double, 3>;  ///< x, y, phi
  using Stages = std::array<Axes, kStages>;

  void evaluate(const State& state, double t, Forces& forces, SolverCounts& counts) const;
  struct Jacobian {
    Eigen::Matrix3d by_position, by_velocity;  ///< of (x'', y'', phi'')
  };
  Jacobian jacobian(const State& state, double t, const Forces& forces, SolverCounts& counts) const;
  void linearise(double h, SolverCounts& counts);
  void linearise_stages(double h, SolverCounts& counts);
  Stages decoupled_correction(const Stages& residual) const;
  Stages coupled_correction(const Stages& residual) const;
  bool iterate(double h, bool coupled, SolverCounts& counts);
  bool solve(double h, SolverCounts& counts);
  void place_stages(double h);
  double error(double h) const;
  double speed_scale(double h) const;
  double rounding(double h) const;
  double allowed(double h) const;
  Axes filter(const Axes& acceleration) const;
  double size_of(const Axes& acceleration) const;
  void fill(double h, Segment& segment) const;

  const System& system_;
  double tolerance_;
  double base_time_;
  double next_step_ = 0.0;     ///< length that the last step suggests
  double restart_step_ = 0.0;  ///< length of the first step after the last jump
  bool couples_ = false;       ///< the iteration with one Jacobian for all stages has failed a short while ago
  int steps_ = 0;
  bool restarts_ = false;  ///< the next step is such a first one

  const DriveForms* drives_ = nullptr;
  const ContactStates* contacts_ = nullptr;
  State start_, end_;
  Forces start_forces_;
  std::array<State, kStages> stage_;
  std::array<Forces, kStages> forces_;
  Stages acceleration_{};
  Jacobian start_jacobian_;
  double rounding_ = 0.0;  ///< of the velocities in the present step
  /// (I - h lambda f_v - h^2 lambda^2 f_q)^-1 for every eigenvalue lambda.
  std::array<std::array<std::array<std::complex<double>, 3>, 3>, 1 + Collocation::kPairs> inverse_{};
  /// The whole matrix of Newton's method, with the Jacobians of every stage.
  static constexpr int kUnknowns = 3 * kStages;
  Eigen::PartialPivLU<Eigen::Matrix<double, kUnknowns, kUnknowns>> coupled_;
};

}  // namespace vibratory_alignment
