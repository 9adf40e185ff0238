// One implicit step in contact: Radau IIA collocation of order 13 (solver/collocation.h) on q'' = f(t, q, q'), whose
// length follows the motion and not the stiffness of the base, of a damper or of the tanh layer
// (docs/implicit_steps.md).
#pragma once

#include <limits>

#include "solver/contact_mode.h"
#include "solver/fast_motion.h"
#include "solver/motion_series.h"
#include "solver/stage_equations.h"

namespace vibratory_alignment {

/// What a step may be, and what may be spent on it.
struct StepBounds {
  static constexpr long kAny = std::numeric_limits<long>::max();

  double longest;
  double shortest = 0.0;
  long evaluations = kAny;  ///< of the forces, after which no further length is tried
  bool easily = false;      ///< given up at the first length whose equations are not solved in a few iterations
  /// Given up when a shorter length has the larger error: it begins to see a ring that the longer one passes over.
  bool passes_over = false;
  /// StageEquations::cost() after which no further length is tried, and after which the one at hand is given up.
  long cost = kAny, most_cost = kAny;
};

class ImplicitStep {
 public:
  /// `tolerance`: error of the velocities per step, relative to the speed of the part.
  ImplicitStep(const System& system, double tolerance);

  /// Takes a step from `start` with the loaded contacts of segment.contacts and fills the segment's series with its
  /// polynomials (powers of the time since its start). Returns its length, 0 when none within `bounds` is found, nor
  /// one at the start of the trial that passes over no more than it may. Counts forces and rejected steps.
  double take(const State& start, const DriveForms& drives, const StepBounds& bounds, Segment& segment,
              SolverCounts& counts);

  /// Length at which the last take() was given up; 0 where it was not, or not for its length.
  double given_up_at() const { return given_up_at_; }

  /// True when the last take() was given up as the event before it makes the base ring.
  bool event_rings() const { return event_rings_; }

  /// What all steps so far have taken (StageEquations::cost).
  long cost() const { return equations_.cost(); }

  /// The last step once more, with the shorter length `h` at whose end an event lies: the state there then fulfils the
  /// equations of motion, as no point inside a step does on a stiff base. False when it does not converge, or when
  /// its error in the tanh layer, of which the longer step has seen less, is too large.
  bool retake(double h, Segment& segment, SolverCounts& counts);

  /// Time has passed: the steps to come are none at the start of the trial.
  void leave_start() { at_start_ = false; }

  /// Length of a step of at most `longest` that resolves the excitations.
  static double longest_step(double longest, const DriveForms& drives);

  /// Length of a step that passes over this motion, with an error within its tolerance, or is so short that it follows
  /// it; 0 when there is none. `segment` begins with the speeds and normal forces of now, or of the step before; a step
  /// of `least` is tried even where the last one had to be shorter.
  double length_over(const FastMotion& motion, double least, double longest, const DriveForms& drives,
                     const Segment& segment);

  /// True when a step of this length is so short for the base alone, in which it then sees every ring.
  bool follows_base(double step, const DriveForms& drives) const;

  /// Of the last step only this length is gone: what it passes over beyond that is not over, and the next one may be
  /// longer than that as it may be after any step.
  void go_on_from(double length);

  /// Length that the next step is tried with first.
  void suggest(double step) { next_step_ = step; }

  /// The next step is so short that it follows the base.
  void follow_base() { next_step_ = base_time_; }

  /// The forces have just jumped: the next step is as short as the one after the last jump could be. `base_rings`: the
  /// normal forces are among them, and the next step follows the base.
  void restart(bool base_rings);

  /// True unless the last step, which filled `segment`, is the first one and passes over a ring of a normal force that
  /// is not small beside it, in place or speed: it may lift that contact, or make it slide another way; or, at the
  /// start of the trial, one in which friction could not hold what sticks, or which nothing damps while friction is
  /// dry.
  bool keeps_contacts(const Segment& segment, const Pins& pins) const;

  /// True when the last step is one at the start of the trial and, as short as an event has made it, ends before the
  /// base has damped what it passes over.
  bool leaves_ring_of_start() const;

  /// True when the last step begins at an event, and as short as another one has made it, passes over a ring of the
  /// base that is too large for it.
  bool leaves_ring_of_event(const Segment& segment) const;

  /// The motion does not go on from the end of the last step.
  void forget() { taken_ = after_event_ = false; }

  /// The state at the end of the last step.
  State end() const { return equations_.end(); }

 private:
  static constexpr int kStages = Collocation::kStages;

  StageAxes missed_at_start() const;
  StageAxes velocity_missed_at_start() const;
  double speed_missed_at_start() const;
  double stiff_speed_missed_at_start() const;
  double error(double h) const;
  bool passes_over_too_much(double h) const;
  double most_speed_of_ring(double rate, double z, double allowed, const Segment& segment) const;
  bool passes_over_ring_of_event(double h, const Segment& segment) const;
  double growth(double h, double ratio) const;
  void fill(double h, Segment& segment);

  const System& system_;
  StageEquations equations_;
  double base_time_, slow_base_time_, natural_rate_, flight_time_, most_passed_over_;
  double ring_decay_ = 0.0;                      ///< of what a step at the start of the trial passes over
  double length_ = 0.0;                          ///< of the solution that fills the segment
  double given_up_at_ = 0.0;                     ///< length at which the last take() was given up
  double known_step_ = 0.0;                      ///< of steps that are good enough, as far as the last ones tell
  FastMotion over_;                              ///< what the next step passes over, with its most speed; rate 0: all
  double next_step_ = 0.0;                       ///< length that the last step suggests
  double restart_step_ = 0.0;                    ///< length of the first step after the last jump
  double last_length_ = 0.0, last_ratio_ = 1.0;  ///< of the last step, and its error over the one allowed
  bool at_start_ = true;                         ///< of the trial, where a step may pass over a ring
  bool restarts_ = false;                        ///< the next step is such a first one
  bool after_event_ = false;                     ///< ... right at a jump or event at which no normal force jumps
  bool event_rings_ = false;                     ///< the last take() was given up as that makes the base ring
  bool taken_ = false;                           ///< the last step was taken, and the forces have not jumped since
  bool follows_ = false;                         ///< so at the start of the present step
};

}  // namespace vibratory_alignment
