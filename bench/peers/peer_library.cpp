// The problems as a shared library with C functions, for Python's ctypes (scipy_solve_ivp.py).
#include <algorithm>

#include "peer_session.h"

namespace {

vibratory_alignment::peers::PeerSession& session() {
  static vibratory_alignment::peers::PeerSession the_session;
  return the_session;
}

}  // namespace

extern "C" {

// Writes the six numbers of the start; returns the end time, negative for a problem that is not there.
double peer_begin(const char* problem, double* start) {
  try {
    session().begin(problem);
  } catch (const std::invalid_argument&) {
    return -1.0;
  }
  std::copy_n(session().problem().start.data(), 6, start);
  return session().problem().end_time;
}

void peer_right_hand_side(double t, const double* s, double* rate) { session().progress().right_hand_side(t, s, rate); }

void peer_guards(const double* s, double* values) { session().progress().guards(s, values); }

void peer_pass(int guard, const double* s) { session().progress().pass(guard, s); }

long peer_evaluations() { return session().progress().evaluations; }

}  // extern "C"
