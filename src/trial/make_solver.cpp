#include "trial/make_solver.h"

#include <stdexcept>

#include "solver/event_solver.h"

namespace vibratory_alignment {

std::unique_ptr<Solver> make_solver(const System& system, const std::vector<Excitation>& excitations,
                                    const SolverSettings& settings) {
  const auto hybrid = [&](ContactMethod method) {
    return std::make_unique<EventSolver>(system, excitations, settings.tolerance, settings.step_limit, method);
  };
  if (settings.name == "event") return hybrid(ContactMethod::series);
  if (settings.name == "implicit") return hybrid(ContactMethod::implicit);
  if (settings.name == "auto") return hybrid(ContactMethod::automatic);
  throw std::invalid_argument("solver '" + settings.name +
                              "' is not available in this build; available: event, implicit, auto");
}

}  // namespace vibratory_alignment
