// The output of all peers: one line of comma-separated values for each setting.
//
//   peer,problem,setting,x,y,phi,vx,vy,omega,rhs,steps,events,cpu_min_s,cpu_median_s
//
// setting: the tolerance, absolute and relative, or the step. rhs: right-hand sides (0: the peer does not count them).
// A run that fails prints nan and its reason to the standard error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "problem.h"

namespace vibratory_alignment::peers {

// What one integration gave.
struct Outcome {
  State end{};
  long evaluations = 0, steps = 0, events = 0;
};

// Runs `integrate` again and again, until 0.15 s of processor time are spent and 5 repetitions are made (after 3 s:
// fewer). Returns the least time in seconds, nan for a run that fails.
double report(const std::string& peer, const std::string& problem, double setting,
              const std::function<Outcome()>& integrate);

// Those of the problems that are named in the command line; all of them where none is named.
std::vector<Problem> chosen(const std::vector<Problem>& known, int argc, char** argv);

// Tolerances from 1e-2 to 1e-13: three a decade, for the many problems `r1_eps_*` one a decade.
std::vector<double> tolerances(const Problem& problem);

// Numbers of steps for the peers of fixed step: 500 to 1,000,000, three a decade.
std::vector<long> step_counts();

}  // namespace vibratory_alignment::peers
