// The equations of one implicit step, a_i = f(c_i h, q_i, v_i) at the nodes of the collocation, and Newton's method on
// them (docs/implicit_steps.md).
#pragma once

#include <limits>
#include <optional>

#include "solver/layer_coupling.h"
#include "solver/motion_series.h"
#include "solver/solver.h"

namespace vibratory_alignment {

class StageEquations {
 public:
  static constexpr int kStages = Collocation::kStages;

  /// `tolerance`: error of the velocities per step, relative to the speed of the part.
  StageEquations(const System& system, double tolerance) : system_(system), tolerance_(tolerance), layer_(system) {}

  /// Steps from `start` with the loaded contacts of `contacts` come next. `follows`: it is the end of the solution that
  /// is at hand, and the forces have not jumped there: what comes is guessed from it.
  void begin(const State& start, const DriveForms& drives, const ContactStates& contacts, bool follows,
             SolverCounts& counts);

  /// Solves a step of length h; false when that does not converge. `easily`: in a few iterations. Given up once
  /// it has taken more than `most_cost` of cost().
  bool solve(double h, SolverCounts& counts, bool easily = false, long most_cost = std::numeric_limits<long>::max());

  /// The next solution is guessed from what the step began with, not from the one at hand, which is worth nothing.
  void drop_solution() { known_ = known_before_; }

  /// The solution.
  const State& start() const { return start_; }
  const Forces& start_forces() const { return start_forces_; }
  /// The forces at the end of the solution that the step follows, else those of the start.
  const Forces& forces_before() const { return forces_before_; }
  const Load3& start_drive() const { return start_drive_; }
  const LoadOctet& drive() const { return drive_; }
  const ForcesOctet& forces() const { return forces_; }
  const Stages& acceleration() const { return acceleration_; }
  const StateOctet& stages() const { return stages_; }
  State end() const { return stages_[kStages - 1]; }

  /// Error of the velocities that the step may make.
  double allowed(double h) const;
  /// The same for a step of any length h, as far as the start tells.
  double allowed_at_start(double h) const;
  /// What is left of an acceleration when what is stiff is taken out of it: at the start, and at the end of the
  /// solution of length h; none where a contact flutters there that the step does not follow (layer_flutter.h).
  StageAxes filter(const StageAxes& acceleration) const;
  std::optional<Eigen::Matrix3d> filter_at_end(double h) const;
  /// True when a contact is in the tanh layer, whose stiffness is that of N and changes within a step.
  bool in_layer() const { return start_jacobian_.layer_count > 0; }
  /// Size of an acceleration or a velocity, as one of the part's points.
  double size_of(const StageAxes& acceleration) const;

  /// Error of the velocities that a step of length h from the start of this segment may make, and rounding of the
  /// depths there, of those of its contacts that are loaded.
  double allowed_from(const Segment& segment, double h) const;
  double depth_rounding(const Segment& segment) const;

  /// What all steps so far have taken, in evaluations of the forces: one in which what sticks was held state by state
  /// (mechanics/octet_forces.h) counts as so many.
  long cost() const { return cost_; }
  static constexpr long kHeldApart = 10;

 private:
  double evaluate_stages(Stages& residual, SolverCounts& counts);
  double residual_under(Stages& residual) const;
  void guess(double h);
  void tell_acting();
  void keep_guess(double h);
  double place_stages(double h);
  double correct(const Stages& residual, double h);
  double speed_scale(double h) const;
  double speed_of_push(const Vec2& push, double h) const;
  double size_of_place(double x, double y) const;
  void set_rounding(double h);
  Octet sizes_of(const Stages& acceleration) const;

  const System& system_;
  double tolerance_;

  const DriveForms* drives_ = nullptr;
  const ContactStates* contacts_ = nullptr;
  State start_;
  Load3 start_drive_;
  Forces start_forces_, forces_before_;
  Vec2 start_push_;            ///< sum of the contact forces at the start
  double start_pushes_ = 0.0;  ///< sum of the sizes of all N and T there
  ForceJacobian start_jacobian_;
  StateOctet stages_{};
  LoadOctet drive_{};
  ForcesOctet forces_;
  Stages acceleration_{};
  NormalForcesOctet acting_{};           ///< N that act in an iteration: those of the states, foreseen
  double noise_ = 0.0, rounding_ = 0.0;  ///< of accelerations times h and of velocities in the present step

  /// What a step is guessed from: accelerations and normal forces at the nodes of a step of this length that began
  /// `ago` before `start_`.
  struct Known {
    Stages acceleration{};
    NormalForcesOctet normal{};
    double length = 0.0, ago = 0.0;
  };
  std::array<Known, 2> knowledge_;
  std::size_t known_ = 0, known_before_ = 0;  ///< of these, the one at hand and that of the step before

  StageModes modes_;
  LayerCoupling layer_;
  long cost_ = 0;
};

}  // namespace vibratory_alignment
