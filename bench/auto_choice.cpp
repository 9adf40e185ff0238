// Whether the solver `auto` chooses well: its CPU time beside the better one of `event` and `implicit`, as a table.
//
// Scenes: the files named; config/scenes/hard/lasting_contact.yaml over stiffness and damping ratio of the base; one
// part in lasting contact over the same: shaken across and along, it sticks and slips twenty times and never leaves the
// base; and shaken by forces with kinks, after each of which the base rings, with all laws of friction, over frequency,
// stiffness and damping ratio. Then random scenes of the hunt (test/hunt), of which the table has only those above the
// ratio allowed. The three solvers take turns, so that what else the computer does meets all of them alike. A time is
// the least of the turns; the ratio is the median of those within one turn, for the clock of a computer may change
// between two speeds, and does not do so for each solver at once. The time is that of a trial as a sweep runs it, from
// the scene to the outcome; of the steps alone, which the solver decides on, there is a ratio of its own.
// `> step limit`: more than a million steps, a hundred thousand in random scenes. **: the ratio is above 1.3.
// Usage: auto_choice TOLERANCE SCENE_FILE ...
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/scene_loader.h"
#include "random_scene.h"
#include "support/run_bench.h"
#include "trial/simulation.h"

namespace va = vibratory_alignment;

namespace {

constexpr std::array<const char*, 3> kSolvers = {"event", "implicit", "auto"};
constexpr double kAllowedRatio = 1.3;

/// Turns of each solver: until they have taken this long together, but neither fewer nor more than these. A scene above
/// the ratio allowed gets as many turns more as one that is not random: the clock has slow spells that outlast a few.
constexpr double kSecondsPerScene = 0.5, kSecondsPerRandomScene = 0.01;
constexpr std::size_t kFewestTurns = 5, kMostTurns = 101;

/// A solver that has taken this many times as long as the best one is left out of further turns; not before some
/// turns have been taken, as a pause of the computer in its first one would do that to any.
constexpr double kHopeless = 5.0;
constexpr std::size_t kTurnsOfAll = 3;

constexpr std::uint64_t kFirstRandomScene = 40000, kRandomScenes = 8000;
constexpr long kRandomStepLimit = 100000;

/// A trial that takes so long with the better solver is worth choosing for, in seconds.
constexpr double kLongTrial = 5e-4;

constexpr char kLastingContact[] = R"(
part: {half_width: 0.67, base_distance: 0.93, inertia: 0.17}
slot: {clearance: 0.083}
gripper:
  stiffness: {x: 0.071, phi: 11.0}
  damping: {x: 0.013, y: 0.029, phi: 0.31}
  anchor: {x: 0.23, phi: 0.007}
  pressing_force: 3.0
base: {stiffness: {y: 1.0e4}}
contacts: [edges]
friction: {coefficient: 0.2}
excitation: {amplitude: 1.0, frequency: 19.0}
initial: {x: 0.21}
trial: {time_limit: 5.0}
solver: {step_limit: 1000000}
)";

struct Case {
  std::string label;
  va::Scene scene;
};

/// The scene on a base of this stiffness and damping ratio.
va::Scene on_base(va::Scene scene, double stiffness, double damping_ratio) {
  scene.base.stiffness_x = scene.base.stiffness_y = stiffness;
  scene.base.damping_x = scene.base.damping_y = 2.0 * damping_ratio * std::sqrt(stiffness);
  return scene;
}

std::vector<Case> built_in_cases() {
  std::vector<Case> cases;
  char label[80];
  const va::Scene block = va::load_scene_file(SCENES "/hard/lasting_contact.yaml");
  const va::Scene part = va::load_scene(YAML::Load(kLastingContact), "lasting contact");
  for (const double stiffness : {1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10})
    for (const double damping_ratio : {0.01, 0.1, 1.0, 10.0, 100.0}) {
      std::snprintf(label, sizeof label, "hard/lasting_contact, k = %.0e, zeta = %g", stiffness, damping_ratio);
      cases.push_back({label, on_base(block, stiffness, damping_ratio)});
      cases.back().scene.solver.step_limit = 1000000;
    }
  for (const double stiffness : {1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10})
    for (const double damping_ratio : {0.01, 0.1, 1.0, 10.0, 100.0}) {
      std::snprintf(label, sizeof label, "k = %.0e, zeta = %g", stiffness, damping_ratio);
      cases.push_back({label, on_base(part, stiffness, damping_ratio)});
    }
  struct Law {
    const char* name;
    std::optional<va::Friction> friction;
  };
  const Law laws[] = {{"no friction", {}}, {"tanh", va::Friction{0.3, 0.2}}, {"dry", va::Friction{0.3, {}}}};
  for (const auto& [wave, waveform] : {std::pair{"square", va::Waveform::square}, {"triangle", va::Waveform::triangle}})
    for (const Law& law : laws)
      for (const double frequency : {5.0, 19.0})
        for (const double damping_ratio : {0.03, 0.15, 1.0})
          for (const double stiffness : {3e3, 3e4, 3e5, 3e6, 3e7}) {
            std::snprintf(label, sizeof label, "%s %g, %s, k = %.0e, zeta = %g", wave, frequency, law.name, stiffness,
                          damping_ratio);
            va::Scene scene = on_base(part, stiffness, damping_ratio);
            scene.excitations[0].waveform = waveform;
            scene.excitations[0].amplitude = 0.05;
            scene.excitations[0].frequency = frequency;
            scene.friction = law.friction;
            scene.trial.time_limit = 40.0;
            cases.push_back({label, scene});
          }
  return cases;
}

/// CPU time of a turn in seconds; infinite where it was not taken, or the clock stood still.
struct Turn {
  double trial = HUGE_VAL, steps = HUGE_VAL;
};

struct Measured {
  std::vector<Turn> turns;
  std::string failure;
  long steps = 0;

  /// Of a trial.
  double least() const {
    double least = HUGE_VAL;
    for (const Turn& turn : turns) least = std::min(least, turn.trial);
    return least;
  }
  bool usable() const { return failure.empty() && least() < HUGE_VAL; }
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void take_turn(const va::Scene& scene, const char* solver, double tolerance, Measured& measured) {
  va::Scene s = scene;
  s.solver.name = solver;
  s.solver.tolerance = tolerance;
  s.solver.step.reset();
  va::SimulationOptions options;
  options.energy = false;
  const double start = cpu_seconds();
  va::Simulation simulation(s, options);
  while (simulation.advance()) {
  }
  const va::TrialResult result = simulation.result();
  const double trial = cpu_seconds() - start;
  measured.failure = result.failure;
  measured.steps = result.counts.steps;
  if (result.cpu_seconds > 0.0) measured.turns.back() = {trial, result.cpu_seconds};
}

using Measurement = std::array<Measured, kSolvers.size()>;

/// Adds turns of all solvers.
void take_turns(const va::Scene& scene, double tolerance, double seconds, Measurement& all) {
  double spent = 0.0;
  for (std::size_t turn = 0; turn < kFewestTurns || (spent < seconds && turn < kMostTurns); ++turn) {
    double best = HUGE_VAL;
    for (const Measured& m : all)
      if (m.usable()) best = std::min(best, m.least());
    for (std::size_t i = 0; i < all.size(); ++i) {
      Measured& m = all[i];
      m.turns.emplace_back();
      if (turn > 0 && !m.failure.empty()) continue;
      if (turn >= kTurnsOfAll && m.usable() && m.least() > kHopeless * best) continue;
      take_turn(scene, kSolvers[i], tolerance, m);
      if (m.turns.back().trial < HUGE_VAL) spent += m.turns.back().trial;
    }
  }
}

/// Time of the better one of the solvers that `auto` chooses from.
double better(const Measurement& all) {
  double best = HUGE_VAL;
  for (std::size_t i = 0; i < 2; ++i)
    if (all[i].usable()) best = std::min(best, all[i].least());
  return best;
}

/// Of the time of `auto` to that of the better of the others: the median over the turns.
double ratio_of(const Measurement& all, double Turn::*time = &Turn::trial) {
  std::vector<double> ratios;
  for (std::size_t turn = 0; all[2].usable() && turn < all[2].turns.size(); ++turn) {
    double best = HUGE_VAL;
    for (std::size_t i = 0; i < 2; ++i)
      if (all[i].usable()) best = std::min(best, all[i].turns[turn].*time);
    const double of_auto = all[2].turns[turn].*time;
    if (best < HUGE_VAL && of_auto < HUGE_VAL) ratios.push_back(of_auto / best);
  }
  if (ratios.empty()) return HUGE_VAL;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

bool is_above(double ratio) { return ratio > kAllowedRatio; }

/// `auto` over the better of the others: of trials and of their steps alone.
struct Ratios {
  double trial, steps;
};
Ratios ratios_of(const Measurement& all) { return {ratio_of(all), ratio_of(all, &Turn::steps)}; }

void print_row(const std::string& label, const Measurement& all) {
  std::printf("| %s |", label.c_str());
  for (const Measured& m : all) {
    if (m.usable())
      std::printf(" %.0f (%ld) |", 1e6 * m.least(), m.steps);
    else
      std::printf(" %s |", m.failure.find("step limit") != std::string::npos ? "> step limit" : "failed");
  }
  const Ratios ratios = ratios_of(all);
  for (const double ratio : {ratios.trial, ratios.steps}) std::printf(" %.2f%s |", ratio, is_above(ratio) ? " **" : "");
  std::printf("\n");
  std::fflush(stdout);
}

/// Prints a row.
Ratios report(const std::string& label, const va::Scene& scene, double tolerance) {
  Measurement all;
  take_turns(scene, tolerance, kSecondsPerScene, all);
  if (is_above(ratio_of(all))) take_turns(scene, tolerance, kSecondsPerScene, all);
  print_row(label, all);
  return ratios_of(all);
}

/// Ratios of many scenes.
class Summary {
 public:
  void add(const Ratios& ratios) {
    trial_.push_back(ratios.trial);
    steps_.push_back(ratios.steps);
  }

  std::size_t size() const { return trial_.size(); }
  static double worst(const std::vector<double>& ratios) {
    return ratios.empty() ? 0.0 : *std::max_element(ratios.begin(), ratios.end());
  }
  static double geometric_mean(const std::vector<double>& ratios) {
    double sum = 0.0;
    for (const double ratio : ratios) sum += std::log(ratio);
    return std::exp(sum / static_cast<double>(ratios.size()));
  }
  static std::ptrdiff_t above(const std::vector<double>& ratios) {
    return std::count_if(ratios.begin(), ratios.end(), is_above);
  }

  void print(const char* what) const {
    if (trial_.empty()) return;
    std::printf("%zu %s: ", size(), what);
    const auto print_of = [](const char* name, const std::vector<double>& ratios) {
      std::printf("%s %td above %.1f, worst %.2f, geometric mean %.2f", name, above(ratios), kAllowedRatio,
                  worst(ratios), geometric_mean(ratios));
    };
    print_of("trials", trial_);
    print_of("; their steps alone", steps_);
    std::printf("\n");
  }

 private:
  std::vector<double> trial_, steps_;
};

/// Prints the rows of random scenes above the ratio allowed, then how many there are.
void report_random_scenes(double tolerance) {
  Summary all, longer;
  double most_beyond = 0.0;  // in seconds
  for (std::uint64_t seed = kFirstRandomScene; seed < kFirstRandomScene + kRandomScenes; ++seed) {
    va::Scene scene = va::hunt::random_scene(seed, va::hunt::Range::ordinary);
    scene.solver.accuracy.reset();
    scene.solver.step_limit = kRandomStepLimit;
    Measurement measured;
    const auto shows = [&] {
      const Ratios ratios = ratios_of(measured);
      return is_above(ratios.trial) || is_above(ratios.steps);
    };
    try {
      take_turns(scene, tolerance, kSecondsPerRandomScene, measured);
      if (shows() && better(measured) < HUGE_VAL) take_turns(scene, tolerance, kSecondsPerScene, measured);
    } catch (const va::SceneError&) {
      continue;  // it has no start
    }
    if (better(measured) == HUGE_VAL) continue;
    all.add(ratios_of(measured));
    if (better(measured) > kLongTrial) longer.add(ratios_of(measured));
    if (!shows()) continue;
    if (measured[2].usable())
      most_beyond = std::max(most_beyond, measured[2].least() - kAllowedRatio * better(measured));
    print_row("random scene " + std::to_string(seed), measured);
  }
  std::printf("\n");
  all.print("random scenes");
  std::printf("%.0f us beyond %.1f at most\n", 1e6 * most_beyond, kAllowedRatio);
  longer.print("of these longer than 0.5 ms");
}

void print_all(double tolerance, const std::vector<va::Scene>& scenes) {
  std::printf("CPU time of a trial in us (steps), tolerance %g; ratio: auto to the better of the others\n\n",
              tolerance);
  std::printf("| scene | event | implicit | auto | ratio | of the steps alone |\n|---|---|---|---|---|---|\n");
  Summary files, made;
  const auto add = [&](const std::string& label, const va::Scene& scene, Summary* kind) {
    const Ratios ratios = report(label, scene, tolerance);
    made.add(ratios);
    if (kind != nullptr) kind->add(ratios);
  };
  for (const va::Scene& scene : scenes) add(scene.name, scene, &files);
  for (const Case& c : built_in_cases()) add(c.label, c.scene, nullptr);
  std::printf("\n");
  made.print("scenes");
  files.print("of these, of the files");
  std::printf("\n| random scene | event | implicit | auto | ratio | of the steps alone |\n|---|---|---|---|---|---|\n");
  report_random_scenes(tolerance);
}

}  // namespace

int main(int argc, char** argv) {
  const double tolerance = argc > 1 ? std::atof(argv[1]) : 0.0;
  if (!(tolerance > 0.0 && tolerance <= 0.1)) {
    std::fprintf(stderr, "usage: auto_choice TOLERANCE SCENE_FILE ...   (tolerance > 0 and <= 0.1)\n");
    return 2;
  }
  return va::run_bench("auto_choice", [&] {
    std::vector<va::Scene> scenes;
    for (int i = 2; i < argc; ++i) scenes.push_back(va::load_scene_file(argv[i]));
    print_all(tolerance, scenes);
  });
}
