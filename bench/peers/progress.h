// A problem on its way: the mode it is in and what has been spent so far. Every peer drives one of these.
#pragma once

#include <stdexcept>

#include "contact_mode.h"
#include "problem.h"

namespace vibratory_alignment::peers {

// A run that needs more is given up.
constexpr long evaluation_limit = 60'000'000;
constexpr long event_limit = 10'000;

class Progress {
 public:
  explicit Progress(const Problem& problem)
      : state(problem.start),
        parameters_(problem.parameters),
        mode_(mode_of_start(problem.parameters, problem.start.data())) {}

  void right_hand_side(double t, const double* s, double* rate) {
    ++evaluations;
    peers::right_hand_side(parameters_, mode_, t, s, rate);
  }
  void guards(const double* s, double* values) const { peers::guards(parameters_, mode_, s, values); }
  void pass(int guard, const double* s) {
    ++events;
    transition(parameters_, guard, s, mode_);
  }
  void check_limit() const {
    if (evaluations > evaluation_limit) throw std::runtime_error("too many right-hand sides");
    if (events > event_limit) throw std::runtime_error("too many events");
  }

  State state;
  long evaluations = 0, steps = 0, events = 0;

 private:
  const Parameters& parameters_;
  Mode mode_;
};

}  // namespace vibratory_alignment::peers
