// By how much the solvers with a fixed step differ from the model by nature, over the step: restitution of an impact,
// |T|/(f N) of a contact that slides, creep of one that sticks. Prints Markdown (docs/solvers.md has it).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "model/scene_loader.h"
#include "trial/simulation.h"

namespace va = vibratory_alignment;

namespace {

/// A part that is thrown on an edge: base of rate 100, damping ratio 0.1.
constexpr char kThrown[] = R"(
part: {half_width: 0.7, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {anchor: {y: 0.6}}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges]
excitation: {amplitude: 0.0, frequency: 10.0}
initial: {x: 0.2, y: 0.901, vy: -0.3}
trial: {time_limit: 0.06}
)";

/// Pressed on and pushed along, forward, on a tilted face: friction changes N.
constexpr char kSliding[] = R"(
part: {half_width: 0.67, base_distance: 0.93, inertia: 0.17}
slot: {clearance: 0.083}
gripper: {stiffness: {x: 2.0, phi: 11.0}, damping: {x: 0.4, y: 0.03, phi: 0.3}, anchor: {x: 0.23}, pressing_force: 2.0}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges]
friction: {coefficient: 0.24}
excitation: {amplitude: 1.0, frequency: 9.0}
initial: {x: 0.21, phi: 0.02, vx: 0.5}
trial: {time_limit: 0.3}
)";

/// Held by friction against a push of half of what it can hold.
constexpr char kHeld[] = R"(
part: {half_width: 0.7, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 1.0}, anchor: {x: 0.2625, y: 0.39995}}
base: {stiffness: {y: 1.0e4}, damping: {y: 200.0}}
contacts: [edges]
friction: {coefficient: 0.25}
excitation: {amplitude: 0.0, frequency: 10.0}
initial: {x: 0.2, y: 0.89995}
trial: {time_limit: 1.0}
)";

constexpr double kAnchor = 0.6, kSurface = 0.9;
constexpr int kPhases = 40;

va::Scene scene_of(const char* text, const std::string& solver, double step) {
  va::Scene scene = va::load_scene(YAML::Load(text), "scene");
  scene.solver.name = solver;
  if (step > 0.0) scene.solver.step = step;
  scene.solver.tolerance = 1e-12;
  return scene;
}

template <class Look>
void run(const va::Scene& scene, const Look& look) {
  va::Simulation simulation(scene);
  while (simulation.advance()) look(simulation.segment());
}

/// Speed at the surface of a flight with this state.
double speed_at_surface(const va::State& s) {
  const double height = s.y - kAnchor, surface = kSurface - kAnchor;
  return std::sqrt(s.vy * s.vy + height * height - surface * surface);
}

struct Spread {
  double mean = 0.0, least = 1e9, most = -1e9;
};

/// Over where in a step the touch falls.
Spread restitution(const std::string& solver, double step) {
  Spread spread;
  for (int i = 0; i < kPhases; ++i) {
    va::Scene scene = scene_of(kThrown, solver, step);
    *scene.initial.y += 0.3 * step * i / kPhases;
    const double before = speed_at_surface({scene.initial.x, *scene.initial.y, 0.0, 0.0, scene.initial.vy, 0.0});
    va::State end;
    run(scene, [&](const va::Segment& g) { end = g.end; });
    const double e = speed_at_surface(end) / before;
    spread = {spread.mean + e / kPhases, std::min(spread.least, e), std::max(spread.most, e)};
  }
  return spread;
}

/// Largest and smallest |T|/(f N) of what slides.
Spread cone(const std::string& solver, double step) {
  const va::Scene scene = scene_of(kSliding, solver, step);
  Spread spread;
  run(scene, [&](const va::Segment& g) {
    if (g.loaded_count != 1) return;
    const double n = va::value_at(g.loaded[0].normal_force, g.order, g.duration);
    const double t = va::value_at(g.loaded[0].tangential_force, g.order, g.duration);
    if (n <= 0.1) return;
    const double ratio = std::abs(t) / (scene.friction->coefficient * n);
    spread = {0.0, std::min(spread.least, ratio), std::max(spread.most, ratio)};
  });
  return spread;
}

double creep(const std::string& solver, double step) {
  double speed = 0.0;
  run(scene_of(kHeld, solver, step), [&](const va::Segment& g) { speed = std::abs(g.end.vx); });
  return speed;
}

}  // namespace

int main() {
  std::vector<std::string> solvers = {"rk4", "semi_implicit"};
#ifdef VIBRATORY_ALIGNMENT_ODE
  solvers.push_back("ode");
#endif
  std::printf("Restitution, mean (least ... most) over where in a step the touch falls; event: %.4f\n\n",
              restitution("event", 0.0).mean);
  std::printf("| h omega | rk4 | semi_implicit | ode |\n|---|---|---|---|\n");
  for (const double share : {0.1, 0.03, 0.01, 0.001}) {
    std::printf("| %g |", share);
    for (const std::string& solver : solvers) {
      const Spread e = restitution(solver, share / 100.0);
      std::printf(" %.4f (%.4f ... %.4f) |", e.mean, e.least, e.most);
    }
    std::printf("\n");
  }
  std::printf("\n|T|/(f N) of sliding, least ... most; creep V of what sticks at T = f N/2\n\n");
  std::printf("| h omega | rk4 | semi_implicit | ode |\n|---|---|---|---|\n");
  for (const double share : {0.1, 0.03, 0.01, 0.001}) {
    std::printf("| %g |", share);
    for (const std::string& solver : solvers) {
      const Spread c = cone(solver, share / 100.0);
      std::printf(" %.6f ... %.6f; %.1e |", c.least, c.most, creep(solver, share / 100.0));
    }
    std::printf("\n");
  }
  return 0;
}
