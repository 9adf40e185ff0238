// What trials cost, for the tables of docs/cost.md.
//
//   cost run SCENE_FILE [KEY=VALUE ...]     runs the scene once (for callgrind) and prints: impacts steps outcome
//   cost time SCENE_FILE [KEY=VALUE ...]    the same with the CPU time of a trial, us, least of the turns, before it
//   cost rate SECONDS SCENE_FILE [KEY=VALUE ...]
//                                           trials one after the other for so long, scene given, and prints: trials per
//                                           second of CPU time, steps and evaluations of one
// All without the energy ledger. KEY=VALUE as `align --set`.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "../support/run_bench.h"
#include "model/scene_loader.h"
#include "trial/simulation.h"

namespace va = vibratory_alignment;

namespace {

/// Turns of a timed trial: until they have taken this long together, but neither fewer nor more than these.
constexpr double kSeconds = 0.2;
constexpr int kFewestTurns = 5, kMostTurns = 1001;

va::TrialResult run(const va::Scene& scene) {
  va::SimulationOptions options;
  options.energy = false;
  va::Simulation simulation(scene, options);
  while (simulation.advance()) {
  }
  return simulation.result();
}

void print(const va::TrialResult& result) {
  long impacts = 0;
  for (const long i : result.impacts) impacts += i;
  std::printf("%ld %ld %s\n", impacts, result.counts.steps, va::to_string(result.outcome));
}

void print_time(const va::Scene& scene) {
  va::TrialResult result;
  double least = INFINITY, spent = 0.0;
  for (int turn = 0; turn < kFewestTurns || (spent < kSeconds && turn < kMostTurns); ++turn) {
    result = run(scene);
    least = std::min(least, result.cpu_seconds);
    spent += result.cpu_seconds;
  }
  std::printf("%.4g ", 1e6 * least);
  print(result);
}

double cpu_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Trials with all that belongs to them: setting up, running, result.
void print_rate(const va::Scene& scene, double seconds) {
  long trials = 0;
  va::TrialResult result;
  const double start = cpu_now();
  for (; cpu_now() - start < seconds; ++trials) result = run(scene);
  const double spent = cpu_now() - start;
  std::printf("%.0f %ld %ld\n", static_cast<double>(trials) / spent, result.counts.steps,
              result.counts.rhs_evaluations);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string task = argc > 2 ? argv[1] : "";
  const int file = task == "rate" ? 3 : 2;
  if (argc <= file || (task != "run" && task != "time" && task != "rate")) {
    std::fprintf(stderr, "usage: cost run | time | rate SECONDS   SCENE_FILE [KEY=VALUE ...]\n");
    return 2;
  }
  return va::run_bench("cost", [&] {
    const va::Scene scene = va::load_scene_file(argv[file], std::vector<std::string>(argv + file + 1, argv + argc));
    if (task == "run") print(run(scene));
    if (task == "time") print_time(scene);
    if (task == "rate") print_rate(scene, std::atof(argv[2]));
  });
}
