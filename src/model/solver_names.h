// The solvers that a scene and the command line can name.
#pragma once

#include <array>

namespace vibratory_alignment {

struct SolverName {
  const char* name;
  bool fixed_step;  ///< set by solver.step instead of solver.tolerance
};

inline constexpr std::array<SolverName, 6> solver_names = {
    {{"event", false}, {"implicit", false}, {"rk4", true}, {"semi_implicit", true}, {"ode", true}, {"auto", false}}};

}  // namespace vibratory_alignment
