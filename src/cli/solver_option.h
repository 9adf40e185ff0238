// Names of solvers as options.
#pragma once

#include <string>

namespace vibratory_alignment {

/// "event, implicit, ...": all there are. (`ode` is refused by a build without Open Dynamics Engine.)
std::string solver_list();

/// Empty for the name of a solver, else what is wrong with it: a check of CLI11.
std::string check_solver(const std::string& name);

}  // namespace vibratory_alignment
