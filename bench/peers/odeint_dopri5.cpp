// Boost.odeint: Dormand-Prince 5(4) with step control and dense output, events located on the dense output.
//
// odeint leaves events to its user. Here the guards are looked at after each step; one that rose through zero is
// located on the step's dense output with Boost.Math's TOMS 748, to the last digit of the time. A guard that has just
// been an event starts at zero, give or take roundoff: it may be an event again within the same step, so an instant at
// which it is negative is looked for first. Integration restarts with initialize(), which makes the stepper forget the
// first stage that it keeps from the step before: re-used without that, it would begin with the law that has just
// ended.
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "progress.h"
#include "report.h"

namespace va = vibratory_alignment::peers;
namespace odeint = boost::numeric::odeint;

namespace {

using Stepper = odeint::runge_kutta_dopri5<va::State>;
using DenseStepper = odeint::result_of::make_dense_output<Stepper>::type;

constexpr double first_step = 1e-3;  // odeint chooses none itself

struct Event {
  int guard = -1;  // none
  double time = 0.0;
};

// The guards along one step, from its dense output.
class Step {
 public:
  Step(const DenseStepper& stepper, const va::Progress& progress) : stepper_(stepper), progress_(progress) {}

  // First event between `begin` and `end`, from the guards there.
  Event first_event(double begin, double end, const va::Guards& at_begin, const va::Guards& at_end) const {
    Event event;
    for (int g = 0; g < va::guard_count; ++g) {
      const std::size_t u = static_cast<std::size_t>(g);
      if (at_end[u] < 0.0) continue;
      const double when = crossing(g, begin, end, at_begin[u], at_end[u]);
      if (event.guard < 0 || when < event.time) event = {g, when};
    }
    return event;
  }

 private:
  double guard_at(int guard, double t) const {
    va::State s;
    va::Guards values;
    stepper_.calc_state(t, s);
    progress_.guards(s.data(), values.data());
    return values[static_cast<std::size_t>(guard)];
  }

  // Where `guard` rises through zero: the instant behind it. Its value at `end` is not negative.
  double crossing(int guard, double begin, double end, double at_begin, double at_end) const {
    double before = begin;
    for (double part = 0.5; at_begin >= 0.0; part *= 0.5) {
      // It has just been an event: it falls first, or it is one again at once.
      if (part < 1e-4) return begin;
      before = begin + part * (end - begin);
      at_begin = guard_at(guard, before);
    }
    if (at_end == 0.0) return end;
    std::uintmax_t iterations = 100;
    return boost::math::tools::toms748_solve([&](double t) { return guard_at(guard, t); }, before, end, at_begin,
                                             at_end, boost::math::tools::eps_tolerance<double>(52), iterations)
        .second;
  }

  const DenseStepper& stepper_;
  const va::Progress& progress_;
};

va::Outcome integrate(const va::Problem& problem, double tolerance) {
  va::Progress progress(problem);
  const auto system = [&](const va::State& s, va::State& rate, double t) {
    progress.right_hand_side(t, s.data(), rate.data());
  };
  DenseStepper stepper = odeint::make_dense_output(tolerance, tolerance, Stepper());
  const Step step(stepper, progress);
  va::Guards at_begin, at_end;
  double t = 0.0;
  stepper.initialize(progress.state, t, first_step);
  progress.guards(progress.state.data(), at_begin.data());
  while (t < problem.end_time) {
    // The last step ends at the end, as in odeint's own integrate_adaptive.
    if (t + stepper.current_time_step() > problem.end_time) stepper.initialize(progress.state, t, problem.end_time - t);
    const auto [begin, end] = stepper.do_step(system);
    ++progress.steps;
    progress.check_limit();
    t = end;
    progress.state = stepper.current_state();
    progress.guards(progress.state.data(), at_end.data());
    const Event event = step.first_event(begin, end, at_begin, at_end);
    if (event.guard < 0) {
      at_begin = at_end;
      continue;
    }
    t = event.time;
    stepper.calc_state(t, progress.state);
    progress.pass(event.guard, progress.state.data());
    stepper.initialize(progress.state, t, stepper.current_time_step());
    progress.guards(progress.state.data(), at_begin.data());
  }
  return {progress.state, progress.evaluations, progress.steps, progress.events};
}

}  // namespace

int main(int argc, char** argv) {
  for (const va::Problem& problem : va::chosen(va::regularised_problems(), argc, argv))
    for (const double tolerance : va::tolerances(problem))
      va::report("odeint_dopri5", problem.name, tolerance, [&] { return integrate(problem, tolerance); });
}
