#include "trial/make_solver.h"

#include <stdexcept>

#include "solver/event_solver.h"

namespace vibratory_alignment {

std::unique_ptr<Solver> make_solver(const System& system, const std::vector<Excitation>& excitations,
                                    const SolverSettings& settings) {
  if (settings.name == "event")
    return std::make_unique<EventSolver>(system, excitations, settings.tolerance, settings.step_limit);
  throw std::invalid_argument("solver '" + settings.name + "' is not available in this build; available: event");
}

}  // namespace vibratory_alignment
