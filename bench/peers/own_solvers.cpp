// The project's own solvers on the problems of the peers, in the same run and printed alike: peers `own_event`,
// `own_implicit`, `own_auto` over tolerances, `own_rk4`, `own_semi_implicit` and, where it is built, `own_ode` over
// steps. Making the solver is in the time.
#include <cmath>
#include <stdexcept>

#include "report.h"
#include "solver/solver.h"
#include "trial/make_solver.h"

namespace va = vibratory_alignment;

namespace {

using va::peers::Parameters;
using va::peers::Problem;

va::System system_of(const Problem& problem) {
  const Parameters& p = problem.parameters;
  va::System s;
  s.half_width = p.a;
  s.base_distance = p.b;
  s.slot_half_width = p.l;
  s.x = {true, 1.0, 1.0, p.k_x, p.h_x, p.x_a};
  s.y = {true, 1.0, 1.0, 1.0, p.h_y, p.y_a};
  s.phi = {true, p.mu, 1.0 / p.mu, p.k_phi, p.h_phi, p.phi_a};
  s.weight = p.weight;
  s.contacts.edges = true;
  s.stiffness_x = p.c2;
  s.stiffness_y = p.c1;
  s.damping_x = p.h2;
  s.damping_y = p.h1;
  s.isotropic = p.c1 == p.c2 && p.h1 == p.h2;
  s.friction = p.f;
  s.regularization = p.eps;
  s.aligned_depth = 1e3;  // no outcome is waited for
  const va::peers::State& q = problem.start;
  s.start = {q[0], q[1], q[2], q[3], q[4], q[5]};
  return s;
}

std::vector<va::Excitation> excitations_of(const Parameters& p) {
  std::vector<va::Excitation> list;
  for (int i = 0; i < p.excitation_count; ++i) {
    const va::peers::Excitation& from = p.excitations[static_cast<std::size_t>(i)];
    va::Excitation to;
    to.amplitude = from.amplitude;
    to.frequency = from.frequency;
    to.phase = from.phase;
    to.direction = from.axis == va::peers::axis_x   ? va::Direction::x
                   : from.axis == va::peers::axis_y ? va::Direction::y
                                                    : va::Direction::phi;
    list.push_back(to);
  }
  return list;
}

va::peers::Outcome integrate(const Problem& problem, const va::SolverSettings& settings) {
  const auto solver = va::make_solver(system_of(problem), excitations_of(problem.parameters), settings);
  const va::Segment* segment = nullptr;
  do segment = &solver->advance(problem.end_time);
  while (segment->end_time() < problem.end_time);
  const va::State& q = segment->end;
  const va::SolverCounts& counts = solver->counts();
  return {{q.x, q.y, q.phi, q.vx, q.vy, q.omega}, counts.rhs_evaluations, counts.steps, counts.events};
}

/// A setting that takes longer than this is the last of its series.
constexpr double kTooLong = 0.3;

void run_adaptive(const std::string& name, const Problem& problem) {
  constexpr int kPerDecade = 3;
  for (int i = kPerDecade; i <= 12 * kPerDecade; ++i) {
    va::SolverSettings settings;
    settings.name = name;
    settings.tolerance = std::pow(10.0, -static_cast<double>(i) / kPerDecade);
    const double time_s = va::peers::report("own_" + name, problem.name, settings.tolerance,
                                            [&] { return integrate(problem, settings); });
    if (time_s > kTooLong) return;
  }
}

void run_fixed_step(const std::string& name, const Problem& problem) {
  constexpr long kMostSteps = 200'000;
  for (const long steps : va::peers::step_counts()) {
    if (steps > kMostSteps) break;
    va::SolverSettings settings;
    settings.name = name;
    settings.step = problem.end_time / static_cast<double>(steps);
    va::peers::report("own_" + name, problem.name, *settings.step, [&] { return integrate(problem, settings); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Problem> problems = va::peers::regularised_problems();
  const std::vector<Problem> dry = va::peers::dry_problems();
  problems.insert(problems.end(), dry.begin(), dry.end());
  for (const Problem& problem : va::peers::chosen(problems, argc, argv)) {
    for (const char* name : {"event", "implicit", "auto"}) run_adaptive(name, problem);
    for (const char* name : {"rk4", "semi_implicit"}) run_fixed_step(name, problem);
#ifdef VIBRATORY_ALIGNMENT_ODE
    run_fixed_step("ode", problem);
#endif
  }
}
