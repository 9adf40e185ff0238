#include "trial/make_solver.h"

#include <stdexcept>

#include "solver/event_solver.h"
#include "solver/fixed_step.h"
#include "solver/rk4.h"
#include "solver/semi_implicit.h"
#ifdef VIBRATORY_ALIGNMENT_ODE
#include "engine_ode/ode_step.h"
#endif

namespace vibratory_alignment {
namespace {

#ifdef VIBRATORY_ALIGNMENT_ODE
constexpr char kAvailable[] = "event, implicit, auto, rk4, semi_implicit, ode";
#else
constexpr char kAvailable[] =
    "event, implicit, auto, rk4, semi_implicit; ode needs the Open Dynamics Engine (libode-dev)";
#endif

/// The method of a solver with a fixed step; null for other solvers.
std::unique_ptr<StepMethod> make_step_method(const std::string& name, double step,
                                             [[maybe_unused]] const System& system) {
  if (name == "rk4") return std::make_unique<Rk4>(step);
  if (name == "semi_implicit") return std::make_unique<SemiImplicit>();
#ifdef VIBRATORY_ALIGNMENT_ODE
  if (name == "ode") return std::make_unique<OdeStep>(system);
#endif
  return nullptr;
}

}  // namespace

std::unique_ptr<Solver> make_solver(const System& system, const std::vector<Excitation>& excitations,
                                    const SolverSettings& settings) {
  const auto hybrid = [&](ContactMethod method) {
    return std::make_unique<EventSolver>(system, excitations, settings.tolerance, settings.step_limit, method);
  };
  if (settings.name == "event") return hybrid(ContactMethod::series);
  if (settings.name == "implicit") return hybrid(ContactMethod::implicit);
  if (settings.name == kImplicitAlone) return hybrid(ContactMethod::implicit_alone);
  if (settings.name == "auto") return hybrid(ContactMethod::automatic);
  const double step = settings.step.value_or(0.0);
  if (std::unique_ptr<StepMethod> method = make_step_method(settings.name, step, system)) {
    if (!(step > 0.0))
      throw std::invalid_argument("solver.step: missing; the solver " + settings.name + " needs a step, a time > 0");
    return std::make_unique<FixedStepSolver>(system, excitations, std::move(method), step, settings.step_limit);
  }
  throw std::invalid_argument("solver '" + settings.name +
                              "' is not available in this build; available: " + kAvailable);
}

}  // namespace vibratory_alignment
