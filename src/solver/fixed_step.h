// The solvers with a fixed step: the loop around one StepMethod, honest baselines for the solver `event`.
//
// Steps end on a grid of multiples of the step, from time 0. One segment is one step. Events are what has changed
// between its two ends, and happen at its end: nothing is located inside a step (docs/solvers.md).
#pragma once

#include <memory>

#include "solver/asked_changes.h"
#include "solver/solver.h"
#include "solver/step_method.h"

namespace vibratory_alignment {

class FixedStepSolver final : public Solver {
 public:
  /// `step` > 0. Throws std::invalid_argument for more excitations than any solver simulates.
  FixedStepSolver(const System& system, const std::vector<Excitation>& excitations, std::unique_ptr<StepMethod> method,
                  double step, long step_limit);

  /// The next step; shorter where the limit or the rest of a step that was cut ends it.
  const Segment& advance(double limit) override;
  const Segment& segment() const override { return segment_; }

  /// The end becomes the segment's own value there, as samples have seen it; contacts are looked at anew for it. The
  /// next step goes on to where the whole one would have ended.
  void cut(double duration) override;
  void set_excitations(const std::vector<Excitation>& excitations) override;
  void set_anchor_y(double anchor_y) override { system_.y.anchor = anchor_y; }
  const SolverCounts& counts() const override { return counts_; }

 private:
  void go_to_end();
  void rest();
  void look_beyond_rest();
  void take_events_of_start();
  bool starts_on(const Event& touch) const;
  /// Outcomes that are awaited and hold at the book's instant.
  bool aligns(const ContactBook& at) const;
  bool inserts(const ContactBook& at) const;
  void add_outcomes(const ContactBook& at);
  /// Contacts, events and outcomes at the segment's end.
  void book_end(bool whole);
  void set_direction();
  Slip slip_at(std::size_t site, bool whole);
  const ContactBook& book() const { return books_[book_]; }
  ContactBook& end_book() { return books_[1 - book_]; }
  const State& state() const { return book().placed.state; }

  System system_;
  std::unique_ptr<StepMethod> method_;
  double step_;
  long step_limit_;

  SiteTable sites_;

  Instant now_;           ///< start of the current segment
  double planned_ = 0.0;  ///< length of the current step, were it not for the limit and cuts
  std::array<ContactBook, 2> books_;
  std::size_t book_ = 0;  ///< the one of now_; the other one is of the segment's end
  DriveLoads drives_;
  AskedChanges asked_;  ///< of the drives, at the segment's end
  bool started_ = false;
  bool awaits_aligned_ = true, awaits_inserted_;

  std::array<Slip, kSiteCount> slip_at_end_{};
  Segment segment_;
  SolverCounts counts_;
};

}  // namespace vibratory_alignment
