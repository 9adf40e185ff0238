// Prints how far the solver `event` is from converged answers, as Markdown (docs/verification.md is its output).
//
// 1. The cases of test/reference (computed by two other methods, in extended and quadruple precision): error of the end
//    state over the tolerance. `floor` is what rounding the start values to double leaves: amplification x 1.1e-16.
// 2. The energy balance of every shipped scene at its own tolerance.
// Usage: verification SCENE_FILE ...
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../test/reference/reference_cases.h"
#include "model/scene_loader.h"
#include "support/run_bench.h"
#include "trial/make_solver.h"
#include "trial/simulation.h"

namespace va = vibratory_alignment;
namespace ref = vibratory_alignment::reference;

namespace {

double number(ref::Real value) { return static_cast<double>(value); }

va::Axis axis(ref::Real inertia, ref::Real stiffness, ref::Real damping, ref::Real anchor) {
  return {true, number(inertia), 1.0 / number(inertia), number(stiffness), number(damping), number(anchor)};
}

va::System system_of(const ref::ReferenceCase& c) {
  const ref::ReferenceParameters& p = c.parameters;
  va::System system;
  system.half_width = number(p.a);
  system.base_distance = number(p.b);
  system.slot_half_width = number(p.l);
  system.x = axis(1.0L, p.k_x, p.h_x, p.x_a);
  system.y = axis(1.0L, 1.0L, p.h_y, p.y_a);
  system.phi = axis(p.mu, p.k_phi, p.h_phi, p.phi_a);
  system.weight = number(p.weight);
  system.contacts.edges = p.edges;
  system.contacts.corners = p.corners;
  system.stiffness_x = number(p.c2);
  system.stiffness_y = number(p.c1);
  system.damping_x = number(p.h2);
  system.damping_y = number(p.h1);
  system.isotropic = p.c1 == p.c2 && p.h1 == p.h2;
  system.friction = number(p.f);
  system.regularization = number(p.eps);
  system.aligned_depth = 1e3;  // run on, whatever the outcome
  system.start = {number(c.start.x),  number(c.start.y),  number(c.start.phi),
                  number(c.start.vx), number(c.start.vy), number(c.start.omega)};
  return system;
}

std::vector<va::Excitation> excitations_of(const ref::ReferenceParameters& p) {
  std::vector<va::Excitation> excitations;
  const auto add = [&](const ref::Sine& sine, va::Direction direction) {
    if (sine.amplitude == 0.0L) return;
    va::Excitation e;
    e.direction = direction;
    e.amplitude = number(sine.amplitude);
    e.frequency = number(sine.frequency);
    e.phase = number(sine.phase);
    excitations.push_back(e);
  };
  add(p.excitation_x, va::Direction::x);
  add(p.excitation_y, va::Direction::y);
  add(p.excitation_phi, va::Direction::phi);
  return excitations;
}

struct Run {
  double error = 0.0;
  long steps = 0;
};

Run run(const ref::ReferenceCase& c, double tolerance) {
  va::SolverSettings settings;
  settings.tolerance = tolerance;
  const auto solver = va::make_solver(system_of(c), excitations_of(c.parameters), settings);
  const double end = number(c.end_time);
  while (solver->advance(end).end_time() < end) {
  }
  const va::State& s = solver->segment().end;
  const double error = std::max({std::abs(number(s.x - c.end.x)), std::abs(number(s.y - c.end.y)),
                                 std::abs(number(s.phi - c.end.phi)), std::abs(number(s.vx - c.end.vx)),
                                 std::abs(number(s.vy - c.end.vy)), std::abs(number(s.omega - c.end.omega))});
  return {error, solver->counts().steps};
}

void print_references() {
  const double tolerances[] = {1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
  std::printf("| case |");
  for (const double tolerance : tolerances) std::printf(" %.0e |", tolerance);
  std::printf(" steps at 1e-08 | floor |\n|---|");
  for (std::size_t i = 0; i < std::size(tolerances) + 2; ++i) std::printf("---|");
  std::printf("\n");
  for (const ref::ReferenceCase& c : ref::referenceCases()) {
    std::printf("| %s |", c.name.c_str());
    for (const double tolerance : tolerances) std::printf(" %.1e |", run(c, tolerance).error);
    std::printf(" %ld | %.0e |\n", run(c, 1e-8).steps, 1.1e-16 * number(c.amplification));
  }
}

void print_energy(int count, char** paths) {
  std::printf("| scene | outcome | time | impacts | energy exchanged | residual |\n|---|---|---|---|---|---|\n");
  for (int i = 0; i < count; ++i) {
    va::Simulation simulation(va::load_scene_file(paths[i]));
    while (simulation.advance()) {
    }
    const va::TrialResult r = simulation.result();
    std::printf("| %s | %s | %.4g | %ld | %.3g | %.1e |\n", r.scene.c_str(), va::to_string(r.outcome), r.final_time,
                r.impacts[0] + r.impacts[1] + r.impacts[2] + r.impacts[3], r.energy->exchanged, r.energy->residual);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return va::run_bench("verification", [&] {
    std::printf(
        "## Converged answers\n\nLargest error of the end state (position and velocity) at each "
        "`solver.tolerance`.\n\n");
    print_references();
    std::printf("\n## Energy\n\nResidual of the ledger relative to the energy exchanged, dimensionless times.\n\n");
    print_energy(argc - 1, argv + 1);
  });
}
