// A problem by name: parameters, start, end time. problems.cpp has the list of them.
#pragma once

#include <string>
#include <vector>

#include "right_hand_side.h"

namespace vibratory_alignment::peers {

struct Problem {
  std::string name;
  Parameters parameters;
  State start{};
  double end_time = 0.0;
  State answer{};           // converged state at end_time, from test/reference ...
  bool has_answer = false;  // ... where its integrator reaches it in reasonable time
};

// Regularised friction. `r1`, `r1_eps_*` (towards dry friction), `r1_stiff`, `lasting`, `lasting_overdamped`,
// and `slot`, `tilt`, `wedge`: both edges, bottom and sides, run-off, anisotropic base.
std::vector<Problem> regularised_problems();

// Dry friction, eps = 0: `r1_dry`, `r1_stiff_dry`, `lasting_dry`, `lasting_overdamped_dry`.
std::vector<Problem> dry_problems();

}  // namespace vibratory_alignment::peers
