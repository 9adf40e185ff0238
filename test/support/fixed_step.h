// What the tests of the solvers with a fixed step share.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runs.h"
#include "scenes.h"

namespace vibratory_alignment::test {

/// Those that this build has.
inline std::vector<std::string> fixed_step_solvers() {
#ifdef VIBRATORY_ALIGNMENT_ODE
  return {"rk4", "semi_implicit", "ode"};
#else
  return {"rk4", "semi_implicit"};
#endif
}

inline double order_of(const std::string& solver) { return solver == "rk4" ? 4.0 : 1.0; }

inline Scene with_solver(Scene scene, const std::string& solver, double step) {
  scene.solver.name = solver;
  scene.solver.step = step;
  return scene;
}

inline Scene with_event_solver(Scene scene, double tolerance = 1e-13) {
  scene.solver = {};
  scene.solver.tolerance = tolerance;
  return scene;
}

/// Order p of an error that is proportional to step^p, from errors at two steps.
inline double order_between(double step, double error, double smaller_step, double smaller_error) {
  return std::log(error / smaller_error) / std::log(step / smaller_step);
}

/// State, and forces of one site, at an instant of a run.
struct Look {
  State state;
  double normal_force = 0.0, tangential_force = 0.0;
};

/// Looks at a run at `times` (rising).
inline std::vector<Look> looks_at(const Scene& scene, const std::vector<double>& times, Site site) {
  std::vector<Look> looks;
  run(
      scene,
      [&](const Segment& g) {
        while (looks.size() < times.size() && times[looks.size()] < g.end_time()) {
          const double t = std::clamp(times[looks.size()] - g.start, 0.0, g.duration);
          Look look{state_at(g, t)};
          for (int i = 0; i < g.loaded_count; ++i) {
            const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
            if (contact.site != site) continue;
            look.normal_force = value_at(contact.normal_force, g.order, t);
            look.tangential_force = value_at(contact.tangential_force, g.order, t);
          }
          looks.push_back(look);
        }
      },
      times.back() * (1.0 + 1e-9));
  return looks;
}

}  // namespace vibratory_alignment::test
