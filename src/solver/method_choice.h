// Solver `auto`: which method takes the next step in contact, power series or implicit steps. Implicit steps are taken
// on credit, which the series earn (docs/hybrid_step.md "Automatic").
#pragma once

#include "solver/contact_mode.h"
#include "solver/implicit_step.h"

namespace vibratory_alignment {

/// How contact is stepped: power series, implicit steps, or whichever goes further for its cost.
enum class ContactMethod { series, implicit, automatic };

/// What an implicit step has taken, also in attempts that were given up.
struct StepEffort {
  long evaluations = 0;  ///< of the forces
  long factorizations = 0;
};

class MethodChoice {
 public:
  MethodChoice() { leave_contact(); }

  /// True when the next step in contact is an implicit one.
  bool implicit() const { return implicit_; }

  /// The first step of a trial that starts in contact, over which the series would go `step` of at most `longest`.
  /// True when an implicit one is worth asking for: it is due then.
  bool starts_first(double step, double longest, const ContactStates& contacts);

  /// Bounds of that one, and the length tried when no ring can be passed over.
  StepBounds first_bounds(double longest) const;
  double moderate_first() const;

  /// True when an implicit step is to be tried now: it is due then.
  bool starts_trial();

  /// Bounds of a trial, and the length that it begins with.
  StepBounds trial_bounds(double longest) const;
  double trial_length() const;

  /// No implicit step is due any more.
  void drop() { implicit_ = false; }

  /// The series are about to take a step in contact.
  void earn();

  /// The series have gone `gone` of at most `longest` in a step.
  void settle_series(double gone, double longest, const ContactStates& contacts);

  /// An implicit step has gone `gone` of at most `longest`; 0: was given up.
  void settle_implicit(double gone, double longest, const StepEffort& effort, const ContactStates& contacts);

  /// The normal forces jump: the base rings.
  void ring();

  /// Nothing touches any more.
  void leave_contact();

 private:
  bool implicit_ = false;
  double credit_ = -10.0;  ///< what implicit steps may lose; what the first trial may cost has to be earned before
  double pace_ = 0.0;      ///< how far the series go for a cost of 1: mean of the last steps in this contact
  int series_steps_ = 0;   ///< in this contact since the last implicit step
  int patience_;           ///< series steps in a contact before an implicit step is tried
  bool rings_ = false;     ///< no implicit step has paid since the base was made to ring
  int losses_ = 0;         ///< implicit steps since then, or since it was last left to the series
};

}  // namespace vibratory_alignment
