// How often `solver: {accuracy: E}` is kept, on the random scenes of the tests (seeds 1 to COUNT), as a table.
//
// Each scene is run with `event` at tolerances 1e-13, the reference, and 1e-12, to the same instant. Where the poses at
// the end differ by more than E, the impacts amplify the last digits of a double beyond E, and nothing can be asked.
// Else E is kept if the run with the solver and the tolerance that E chooses ends within E of the reference.
// Then the scenes that miss, with their errors over E and how well the reference is known.
// Usage: accuracy_choice COUNT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "../test/support/random_scenes.h"
#include "../test/support/runs.h"
#include "model/solver_choice.h"
#include "support/run_bench.h"

namespace va = vibratory_alignment;

namespace {

constexpr std::array<double, 3> kAccuracies = {1e-3, 1e-6, 1e-9};

double pose_error(const va::State& a, const va::State& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.phi - b.phi)});
}

va::TrialResult run_with(va::Scene scene, const char* solver, double tolerance, std::optional<double> until = {}) {
  scene.solver.name = solver;
  scene.solver.tolerance = tolerance;
  return va::test::run(scene, {}, until);
}

/// The scenes for one accuracy, by how it went.
struct Tally {
  int kept = 0, unknown = 0, missed = 0;
};

double percent(int part, int all) { return all == 0 ? 0.0 : 100.0 * part / all; }

void print_choices(int count) {
  std::array<Tally, kAccuracies.size()> tallies;
  std::string misses;
  int scenes = 0, failed = 0;
  long most_impacts = 0;
  for (int seed = 1; seed <= count; ++seed) {
    const va::Scene scene = va::test::random_scene(static_cast<unsigned>(seed));
    const va::TrialResult reference = run_with(scene, "event", 1e-13);
    if (reference.outcome == va::Outcome::failed) {
      ++failed;
      continue;
    }
    ++scenes;
    most_impacts = std::max(most_impacts, va::test::total_impacts(reference));
    const double end = reference.final_time;
    const double known = pose_error(run_with(scene, "event", 1e-12, end).final_state, reference.final_state);
    for (std::size_t i = 0; i < kAccuracies.size(); ++i) {
      const double accuracy = kAccuracies[i];
      Tally& tally = tallies[i];
      if (!(known <= accuracy)) {
        ++tally.unknown;
        continue;
      }
      const va::TrialResult chosen =
          run_with(scene, va::solver_for_accuracy(scene), va::tolerance_for_accuracy(accuracy), end);
      const double error = pose_error(chosen.final_state, reference.final_state);
      if (error <= accuracy) {
        ++tally.kept;
        continue;
      }
      ++tally.missed;
      char line[80];
      std::snprintf(line, sizeof line, "| %d | %.0e | %.3g | %.0e | %ld |\n", seed, accuracy, error / accuracy, known,
                    va::test::total_impacts(reference));
      misses += line;
    }
  }
  std::printf("%d random scenes, up to %ld impacts; %d failed\n\n", scenes, most_impacts, failed);
  std::printf("| E | kept | amplified beyond E | missed |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < kAccuracies.size(); ++i) {
    const Tally& t = tallies[i];
    std::printf("| %.0e | %d (%.1f %%) | %d (%.1f %%) | %d (%.1f %%) |\n", kAccuracies[i], t.kept,
                percent(t.kept, scenes), t.unknown, percent(t.unknown, scenes), t.missed, percent(t.missed, scenes));
  }
  std::printf("\n| missed by seed | E | error / E | reference known to | impacts |\n|---|---|---|---|---|\n%s",
              misses.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc == 2 ? std::atoi(argv[1]) : 0;
  if (count <= 0) {
    std::fprintf(stderr, "usage: accuracy_choice COUNT   (of scenes, > 0)\n");
    return 2;
  }
  return va::run_bench("accuracy_choice", [&] { print_choices(count); });
}
