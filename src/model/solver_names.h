// The solvers that a scene and the command line can name.
#pragma once

#include <algorithm>
#include <array>
#include <string>

namespace vibratory_alignment {

struct SolverName {
  const char* name;
  bool fixed_step;  ///< set by solver.step instead of solver.tolerance
};

inline constexpr std::array<SolverName, 6> solver_names = {
    {{"event", false}, {"implicit", false}, {"rk4", true}, {"semi_implicit", true}, {"ode", true}, {"auto", false}}};

/// The solver of that name; null when there is none.
inline const SolverName* find_solver(const std::string& name) {
  const auto* const end = solver_names.data() + solver_names.size();
  const auto* const found = std::find_if(solver_names.data(), end, [&](const SolverName& s) { return s.name == name; });
  return found == end ? nullptr : found;
}

}  // namespace vibratory_alignment
