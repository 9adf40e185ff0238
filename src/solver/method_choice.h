// Solver `auto`: which method takes the next step in contact, power series or implicit steps. Implicit steps are taken
// on credit, which the series earn (docs/automatic.md).
#pragma once

#include <array>
#include <cstddef>

#include "solver/contact_mode.h"
#include "solver/implicit_step.h"

namespace vibratory_alignment {

/// How contact is stepped: power series; implicit steps, but for rings of the base, which the series follow; implicit
/// steps alone; or whichever goes further for its cost.
enum class ContactMethod { series, implicit, implicit_alone, automatic };

class MethodChoice {
 public:
  MethodChoice();

  /// The contacts of the next step. The series go while nothing is known of how far they do in such contacts.
  void look_at(const ContactStates& contacts);

  /// The series have been made with so many powers more than usual: what a step of them costs.
  void note_powers(int more) { more_powers_ = more; }

  /// True when the next step in contact is an implicit one.
  bool implicit() const { return implicit_; }

  /// True at the start of a trial that starts in contact, until time has passed: an implicit step may pass over the
  /// ring of its base.
  bool may_pass_over() const { return may_pass_over_; }

  /// True when that is worth trying, where series of the usual order would hold for `step` of at most `longest` without
  /// an event and the normal forces would change by the share `change`.
  bool passing_over_pays(double step, double longest, double change) const;

  /// An implicit step of at most `longest` is due that passes over the ring.
  void start_passing_over(double step, double longest, double change);

  /// Length from which on an implicit step is worth trying now, provided that it passes over what rings: the last step
  /// is one of the series that shows it. Infinite where none is.
  double shortest_start() const;

  /// The same where implicit steps have paid, and one goes on after a ring: it is worth trying however short the last
  /// ones had to be.
  double shortest_resumed() const;

  /// One of this length passes over it; 0: none does. True when one of that or of `longest` is to be tried now: it is
  /// due then, and begins with that length or `trial_length`, the shorter one.
  bool starts(double length_over_ring, double longest);
  double trial_length() const;

  /// Bounds of the implicit step that is due, of at most `longest`.
  StepBounds bounds(double longest) const;

  /// True when the series are to be asked before the implicit step that is due how far they would go: a ring in which
  /// their pace has been learned may have decayed.
  bool asks_series();

  /// They would go `step`: where that is farther than their pace, it is learned, and the credit shrinks.
  void learn_pace(double step);

  /// The series are about to take a step in contact.
  void earn();

  /// The series have gone `gone` of at most `longest` in a step, which an event may have ended.
  void settle_series(double gone, double longest, bool event);

  /// An implicit step has gone `gone` of at most `longest`; 0: an event came at once. `follows_base`: it is so short
  /// that it follows a ring of the base.
  void settle_implicit(double gone, double longest, long evaluations, bool follows_base = false);

  /// An implicit step was given up, at this length; 0: not for its length.
  void give_up_implicit(long evaluations, double length);

  /// The normal forces jump: the base rings.
  void ring();

  /// An implicit step was given up as the last event makes the base ring.
  void leave_to_ring(long evaluations);

  /// The present implicit step has found events that a short one does not have: once it is settled the series go.
  void doubt() { doubted_ = true; }

  /// Implicit steps have led to events that undo each other: the series go.
  void distrust();

  /// The tanh layer has been crossed by neither method: there is no last step.
  void cross_layer();

  /// Nothing touches any more.
  void leave_contact();

 private:
  /// How far the series go for a cost of 1: the mean of the last steps in this contact.
  struct Pace {
    double way = 0.0;
    int steps = 0;
  };

  static constexpr std::size_t kKinds = 9;  ///< of contacts, by what a step costs (method_choice.cpp)

  /// What the implicit step that is due is for.
  enum class Attempt { ordinary, easy_trial, trial, early_trial, passes_over };

  double series_cost() const;
  double pace() const;
  double way_ahead() const;
  bool trial_is_due() const;
  double shortest_trial() const;
  double shortest_early() const;
  void book_implicit(double gain);
  void leave_to_series(int steps);
  void wait_longer();

  std::size_t kind_ = 0;  ///< of the contacts of this step
  int more_powers_ = 0;   ///< of the last series than usual
  std::array<Pace, kKinds> paces_;
  bool implicit_ = false;
  bool doubted_ = false;  ///< what the present implicit step has found are no events
  bool may_pass_over_ = true;
  Attempt attempt_ = Attempt::ordinary;
  double early_reach_ = 0.0;     ///< how long an early trial may become
  double retried_length_ = 0.0;  ///< with which the next trial begins at most, after one was given up; 0: any
  /// What the first step of a trial may take to pass over a ring, before a further length and with all.
  long passing_cost_ = 0, most_passing_cost_ = 0;
  bool tried_ = false;           ///< a trial has been made
  bool paid_ = false;            ///< an implicit step has gained
  double resumed_length_ = 0.0;  ///< of the trial, if it goes on where implicit steps have paid; 0: it does not
  int wait_ = 0;                 ///< series steps before that is tried again
  int refused_ = 0;              ///< series steps before the next trial, as the last one was refused; 0: it was not
  /// How far the last series steps went for a cost of 1; 0: none since a ring began or an implicit step was taken.
  double last_way_ = 0.0, way_before_ = 0.0;
  double credit_ = 0.0;     ///< what implicit steps may lose
  int series_steps_ = 0;    ///< in this contact since the last implicit step
  int patience_;            ///< of these, before an implicit step is tried
  int steps_alike_ = 0;     ///< of these, since an event or the kind of contacts changed
  int implicit_steps_ = 0;  ///< since the series went last
  int next_question_;       ///< of these, before the series are asked how far they would go
};

}  // namespace vibratory_alignment
