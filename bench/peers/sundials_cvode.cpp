// SUNDIALS CVODE with its root finding: Adams with fixed-point iteration, and BDF with Newton and a dense Jacobian by
// difference quotients, the two set-ups that its manual names for non-stiff and for stiff problems.
//
// As the manual has it for a discontinuous right-hand side: the guards are root functions (rising only), the
// integration stops at a root and CVodeReInit begins anew there; CVodeSetStopTime keeps the last step from passing the
// end.
#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "report.h"
#include "sundials_support.h"

namespace va = vibratory_alignment::peers;

namespace {

enum class Method { adams, bdf };

// CVODE's memory and the algebraic solver that the method needs.
class Cvode {
 public:
  Cvode(Method method, double tolerance, va::Progress& progress, const va::SundialsState& state)
      : memory_(CVodeCreate(method == Method::adams ? CV_ADAMS : CV_BDF, state.context())) {
    va::checked(CVodeInit(memory_, va::sundials_right_hand_side, 0.0, state.vector()), "CVodeInit");
    va::checked(CVodeSStolerances(memory_, tolerance, tolerance), "CVodeSStolerances");
    va::checked(CVodeSetUserData(memory_, &progress), "CVodeSetUserData");
    if (method == Method::adams) {
      iteration_ = SUNNonlinSol_FixedPoint(state.vector(), 0, state.context());
      va::checked(CVodeSetNonlinearSolver(memory_, iteration_), "CVodeSetNonlinearSolver");
    } else {
      matrix_ = SUNDenseMatrix(6, 6, state.context());
      linear_ = SUNLinSol_Dense(state.vector(), matrix_, state.context());
      va::checked(CVodeSetLinearSolver(memory_, linear_, matrix_), "CVodeSetLinearSolver");
    }
    va::checked(CVodeRootInit(memory_, va::guard_count, va::sundials_guards), "CVodeRootInit");
    va::checked(CVodeSetRootDirection(memory_, va::rising), "CVodeSetRootDirection");
    va::checked(CVodeSetNoInactiveRootWarn(memory_), "CVodeSetNoInactiveRootWarn");
    va::checked(CVodeSetMaxNumSteps(memory_, va::step_limit), "CVodeSetMaxNumSteps");
  }
  ~Cvode() {
    CVodeFree(&memory_);
    if (iteration_) SUNNonlinSolFree(iteration_);
    if (linear_) SUNLinSolFree(linear_);
    if (matrix_) SUNMatDestroy(matrix_);
  }
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;

  void* memory() const { return memory_; }
  long steps() const {
    long count = 0;
    CVodeGetNumSteps(memory_, &count);
    return count;
  }

 private:
  void* memory_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNMatrix matrix_ = nullptr;
};

va::Outcome integrate(const va::Problem& problem, Method method, double tolerance) {
  va::Progress progress(problem);
  const va::SundialsState state(progress);
  const Cvode cvode(method, tolerance, progress, state);
  for (double t = 0.0;;) {
    va::checked(CVodeSetStopTime(cvode.memory(), problem.end_time), "CVodeSetStopTime");
    const int flag = va::checked(CVode(cvode.memory(), problem.end_time, state.vector(), &t, CV_NORMAL), "CVode");
    if (flag != CV_ROOT_RETURN) break;
    int found[va::guard_count];
    va::checked(CVodeGetRootInfo(cvode.memory(), found), "CVodeGetRootInfo");
    va::pass_roots(found, progress);
    progress.check_limit();
    progress.steps += cvode.steps();
    va::checked(CVodeReInit(cvode.memory(), t, state.vector()), "CVodeReInit");
  }
  progress.steps += cvode.steps();
  return {progress.state, progress.evaluations, progress.steps, progress.events};
}

}  // namespace

int main(int argc, char** argv) {
  for (const va::Problem& problem : va::chosen(va::regularised_problems(), argc, argv)) {
    for (const double tolerance : va::tolerances(problem)) {
      va::report("cvode_adams", problem.name, tolerance, [&] { return integrate(problem, Method::adams, tolerance); });
      va::report("cvode_bdf", problem.name, tolerance, [&] { return integrate(problem, Method::bdf, tolerance); });
    }
  }
}
