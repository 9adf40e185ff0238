// Solvers `event`, `implicit` and `auto`: the hybrid step of docs/hybrid_step.md. Flight in closed form; the tanh layer
// in one step across it; other contact under error control by power series of high order, by implicit steps, or by
// whichever goes further for its cost; every event located to roundoff as a root of the polynomials.
#pragma once

#include <optional>

#include "solver/asked_changes.h"
#include "solver/flight.h"
#include "solver/implicit_step.h"
#include "solver/layer_crossing.h"
#include "solver/method_choice.h"
#include "solver/ring_watch.h"
#include "solver/series_reach.h"
#include "solver/solver.h"
#include "solver/transitions.h"

namespace vibratory_alignment {

class EventSolver final : public Solver {
 public:
  /// `tolerance`: solver.tolerance of docs/scene.md; a segment that would be number `step_limit` + 1 throws
  /// SolverFailure. Throws std::invalid_argument for more than DriveForms::kMax excitations.
  EventSolver(const System& system, const std::vector<Excitation>& excitations, double tolerance, long step_limit,
              ContactMethod method = ContactMethod::series);

  [[gnu::noinline]] const Segment& advance(double limit) override;
  const Segment& segment() const override { return segment_; }
  void cut(double duration) override;
  void set_excitations(const std::vector<Excitation>& excitations) override;
  void set_anchor_y(double anchor_y) override;
  const SolverCounts& counts() const override { return counts_; }

 private:
  void start();
  void begin_segment(bool contact);
  bool leap(double longest, FoundEvents& found);
  bool cross_layer(double longest, FoundEvents& found);
  void take_step(double longest, bool contact);
  void go_along(double step, double longest, double point_tolerance, bool contact);
  double bounded_step(double step, double longest, double point_tolerance, bool contact);
  State flight_state(double duration) const;
  bool corrects_crossings() const { return flight_.exact() && !system_.recovery; }
  double crossing_time(double found, const Event& event) const;
  double first_crossing(const FoundEvents& found) const;
  bool must_part() const;
  double expand_contact(double longest, const DriveForms& drives);
  double series_contact_step(double longest, const DriveForms& drives);
  double direction_step(double step, double point_tolerance);
  double contact_step(double longest, const DriveForms& drives);
  double lone_implicit_step(double longest, const DriveForms& drives);
  double implicit_or_ring_step(double longest, const DriveForms& drives);
  double chosen_contact_step(double longest, const DriveForms& drives);
  double length_over_ring(double least, double longest, const DriveForms& drives);
  void ring();
  double usual_reach();
  bool has_event(double step, const DriveForms& drives);
  double implicit_contact_step(const StepBounds& bounds, const DriveForms& drives);
  void leave_implicit_step();
  void doubt_implicit_steps();
  double shorten_implicit_step(double step);
  void retake_to_events(const DriveForms& drives, FoundEvents& found);
  bool contradicted() const;
  void believe_state();
  long spent() const;
  void settle(double gone, double longest);
  /// Mode and drives that hold from the segment's end on; makes the kinds of its events definite.
  void prepare_next(FoundEvents& found, bool kink);
  void go_to_end();
  void change_drives(const std::vector<Excitation>& excitations);
  void forces_jump();
  /// Of power series not finite where any coefficient is not: the last ones are made of all others. Zero of an implicit
  /// step, whose solution has been found finite.
  static double last_terms(const Segment& segment);

  /// Implicit steps to events no later than this, relative to the time, are no progress.
  static constexpr double kHardly = 1e-15;

  System system_;
  double tolerance_;
  int contact_order_;
  double search_tolerance_;
  int search_order_;
  long step_limit_;

  Instant now_;                   ///< start of the current segment
  State state_;                   ///< at now_
  ContactMode mode_, next_mode_;  ///< during the segment, and from its end on
  bool mode_changes_ = false;     ///< next_mode_ holds; else mode_ does, without pins once time has passed
  std::vector<Drive> drives_, next_drives_;
  bool drives_change_ = false;       ///< next_drives_ are others than drives_
  AskedChanges asked_;               ///< of the drives, at the segment's end
  bool forces_have_jumped_ = false;  ///< at the segment's end, by a change that was asked for
  bool is_cut_ = false;              ///< the segment ends where it was cut
  DriveForms forms_;                 ///< of the drives, from now_ on; once the segment's end is prepared, from there on
  bool forms_known_ = false;         ///< forms_ are those of the next segment
  OutcomeGuards outcomes_;
  bool started_ = false;

  ContactMethod method_;
  MotionSeries series_;
  SeriesReach reach_;
  FrictionChoice friction_;
  std::optional<ImplicitStep> implicit_;  ///< none where the series take all steps: it is large
  bool implicit_now_ = false;             ///< the current segment is an implicit step
  double implicit_length_ = 0.0;          ///< time at which implicit_ knows the state at the segment's end
  double series_step_ = 0.0;              ///< last step of the series in contact
  RingWatch ring_watch_;                  ///< implicit
  MethodChoice choice_;                   ///< automatic
  bool follows_base_ = false;             ///< automatic: the present implicit step is so short that it follows the base
  long cost_before_ = 0;                  ///< automatic: of all implicit steps before the present one
  std::optional<LayerCrossing> layer_crossing_;  ///< where the scene has a layer to cross
  bool may_cross_ = true;                        ///< not tried since the contacts changed
  Segment segment_;
  FoundEvents found_;      ///< in the step that is being taken
  double searched_ = 0.0;  ///< automatic: length of the series step whose events these are already; 0: of none

  bool in_flight_ = false;  ///< flight_ is the present one
  Flight flight_;

  int events_without_progress_ = 0;
  bool by_implicit_step_ = false;  ///< the state, or an event at the present time, is of an implicit step
  bool holds_here_ = false;  ///< friction has just been decided anew for contacts that could not stick for a whole step
  SolverCounts counts_;
};

}  // namespace vibratory_alignment
