// SUNDIALS ARKODE, ERKStep: explicit Runge-Kutta of order 5 with step control and root finding.
//
// As with CVODE (sundials_cvode.cpp) the integration stops at a root and begins anew there, with ERKStepReInit.
#include <arkode/arkode_erkstep.h>

#include "report.h"
#include "sundials_support.h"

namespace va = vibratory_alignment::peers;

namespace {

class Erk {
 public:
  Erk(double tolerance, va::Progress& progress, const va::SundialsState& state)
      : memory_(ERKStepCreate(va::sundials_right_hand_side, 0.0, state.vector(), state.context())) {
    va::checked(ERKStepSetOrder(memory_, 5), "ERKStepSetOrder");
    va::checked(ERKStepSStolerances(memory_, tolerance, tolerance), "ERKStepSStolerances");
    va::checked(ERKStepSetUserData(memory_, &progress), "ERKStepSetUserData");
    va::checked(ERKStepRootInit(memory_, va::guard_count, va::sundials_guards), "ERKStepRootInit");
    va::checked(ERKStepSetRootDirection(memory_, va::rising), "ERKStepSetRootDirection");
    va::checked(ERKStepSetNoInactiveRootWarn(memory_), "ERKStepSetNoInactiveRootWarn");
    va::checked(ERKStepSetMaxNumSteps(memory_, va::step_limit), "ERKStepSetMaxNumSteps");
  }
  ~Erk() { ERKStepFree(&memory_); }
  Erk(const Erk&) = delete;
  Erk& operator=(const Erk&) = delete;

  void* memory() const { return memory_; }
  long steps() const {
    long count = 0;
    ERKStepGetNumSteps(memory_, &count);
    return count;
  }

 private:
  void* memory_ = nullptr;
};

va::Outcome integrate(const va::Problem& problem, double tolerance) {
  va::Progress progress(problem);
  const va::SundialsState state(progress);
  const Erk erk(tolerance, progress, state);
  for (double t = 0.0;;) {
    va::checked(ERKStepSetStopTime(erk.memory(), problem.end_time), "ERKStepSetStopTime");
    const int flag =
        va::checked(ERKStepEvolve(erk.memory(), problem.end_time, state.vector(), &t, ARK_NORMAL), "ERKStepEvolve");
    if (flag != ARK_ROOT_RETURN) break;
    int found[va::guard_count];
    va::checked(ERKStepGetRootInfo(erk.memory(), found), "ERKStepGetRootInfo");
    va::pass_roots(found, progress);
    progress.check_limit();
    progress.steps += erk.steps();
    va::checked(ERKStepReInit(erk.memory(), va::sundials_right_hand_side, t, state.vector()), "ERKStepReInit");
  }
  progress.steps += erk.steps();
  return {progress.state, progress.evaluations, progress.steps, progress.events};
}

}  // namespace

int main(int argc, char** argv) {
  for (const va::Problem& problem : va::chosen(va::regularised_problems(), argc, argv))
    for (const double tolerance : va::tolerances(problem))
      va::report("arkode_erk5", problem.name, tolerance, [&] { return integrate(problem, tolerance); });
}
