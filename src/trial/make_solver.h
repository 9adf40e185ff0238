// Every solver by its name: the one place that knows them all.
#pragma once

#include <memory>
#include <vector>

#include "solver/solver.h"

namespace vibratory_alignment {

/// Makes the solver that `settings` names (solver_names.h). Throws std::invalid_argument for one that this build does
/// not have, and for more excitations than DriveForms::kMax. `system` is copied.
std::unique_ptr<Solver> make_solver(const System& system, const std::vector<Excitation>& excitations,
                                    const SolverSettings& settings);

}  // namespace vibratory_alignment
