// Every solver by its name: the one place that knows them all.
#pragma once

#include <memory>
#include <vector>

#include "solver/solver.h"

namespace vibratory_alignment {

/// A method for the contacts of `event` to be held against: implicit steps that follow every ring of the base
/// themselves, where the solver `implicit` has the series follow it. No name that a scene may give.
inline constexpr char kImplicitAlone[] = "implicit_alone";

/// Makes the solver that `settings` names (solver_names.h, kImplicitAlone). Throws std::invalid_argument for one that
/// this build does not have, and for more excitations than DriveForms::kMax. `system` is copied.
std::unique_ptr<Solver> make_solver(const System& system, const std::vector<Excitation>& excitations,
                                    const SolverSettings& settings);

}  // namespace vibratory_alignment
