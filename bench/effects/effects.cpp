// What one effect more costs: the rows of bench/effects/chain.yaml, of which each adds an effect to those before it.
//
//   effects CHAIN names            the effects, one a line
//   effects CHAIN run ROW          runs one row once, for callgrind, and prints: impacts steps
//   effects CHAIN time             CPU time of a row per impact, us, one a line: rows take turns, median of the turns
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "../support/run_bench.h"
#include "model/scene_loader.h"
#include "model/setting.h"
#include "trial/simulation.h"

namespace va = vibratory_alignment;

namespace {

constexpr int kTurns = 31;
constexpr std::size_t kAll = 1000;

struct Row {
  std::string effect;
  va::Scene scene;
  va::SimulationOptions options;
};

/// The first `count` rows: a build without an effect knows nothing of those that call for it.
std::vector<Row> read_chain(const char* path, std::size_t count) {
  const YAML::Node chain = YAML::LoadFile(path);
  YAML::Node tree = chain["scene"];
  bool ledger = false;
  std::vector<Row> rows;
  for (const YAML::Node& node : chain["rows"]) {
    if (rows.size() == count) break;
    for (const YAML::Node& setting : node["set"]) va::apply_setting(tree, setting.as<std::string>());
    ledger = ledger || (node["ledger"] && node["ledger"].as<bool>());
    Row row;
    row.effect = node["effect"].as<std::string>();
    row.scene = va::load_scene(tree, path);
    row.options.energy = ledger;
    row.options.until = row.scene.trial.time_limit;
    rows.push_back(row);
  }
  return rows;
}

struct Run {
  long impacts = 0;
  va::TrialResult result;
};

Run run(const Row& row) {
  va::Simulation simulation(row.scene, row.options);
  while (simulation.advance()) {
  }
  Run run;
  run.result = simulation.result();
  for (const long impacts : run.result.impacts) run.impacts += impacts;
  if (run.result.outcome == va::Outcome::failed) {
    std::fprintf(stderr, "%s: %s\n", row.effect.c_str(), run.result.failure.c_str());
    std::exit(1);
  }
  return run;
}

void print_times(const std::vector<Row>& rows) {
  std::vector<std::vector<double>> times(rows.size());
  for (int turn = 0; turn < kTurns; ++turn)
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Run one = run(rows[i]);
      times[i].push_back(1e6 * one.result.cpu_seconds / static_cast<double>(one.impacts));
    }
  for (std::vector<double>& row : times) {
    std::sort(row.begin(), row.end());
    std::printf("%.4g\n", row[row.size() / 2]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string task = argc > 2 ? argv[2] : "";
  if (argc < 3 || (task == "run") != (argc == 4)) {
    std::fprintf(stderr, "usage: effects CHAIN names | run ROW | time\n");
    return 2;
  }
  const std::size_t row = argc == 4 ? static_cast<std::size_t>(std::atoi(argv[3])) : kAll - 1;
  return va::run_bench("effects", [&] {
    const std::vector<Row> rows = read_chain(argv[1], row + 1);
    if (task == "names") {
      for (const Row& row : rows) std::printf("%s\n", row.effect.c_str());
    } else if (task == "time") {
      print_times(rows);
    } else {
      const Run one = run(rows.at(row));
      std::printf("%ld %ld\n", one.impacts, one.result.counts.steps);
    }
  });
}
