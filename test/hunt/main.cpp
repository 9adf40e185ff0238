// hunt: random scenes against the invariants that hold for every trial. README.md says how to use it.
#include <CLI/CLI.hpp>

#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include "cli/interrupt.h"
#include "hunt.h"
#include "model/scene_error.h"
#include "progress_line.h"
#include "scene_text.h"
#include "shrink.h"
#include "trial/make_solver.h"

namespace vibratory_alignment::hunt {
namespace {

constexpr double kHangSeconds = 300.0;
constexpr int kShrinkTrials = 600;

constexpr char kFooter[] = R"(Examples:
  hunt                                            10000 ordinary scenes
  hunt --range wild --count 1000000 --threads 2 --keep found
  hunt --changes                                  ... cut and changed while they run
  hunt --range wild --from 1234 --count 1         one seed again
  hunt --range wild --scene found/wild_1234_mirror.yaml      a scene that was kept
  hunt --range wild --show 1234                   print the scene of a seed

Exit status: 0 every invariant held; 1 some did not; 2 bad usage; 130 interrupted, with the summary so far.)";

struct Options {
  HuntOptions hunt;
  std::string keep, scene;
  int shrunk = 10;
  std::optional<std::uint64_t> show;
};

std::string faults_text(const Verdict& verdict) {
  std::string text;
  for (const Fault& fault : verdict.faults)
    text += "# " + std::string(to_string(fault.invariant)) + ": " + fault.detail + "\n";
  return text;
}

/// The trial, made as simple as it can be while the first fault stays, as a scene file with the faults as its head.
std::string shrunk_text(const Trial& trial, Range range, const Verdict& verdict) {
  const Invariant broken = verdict.faults.front().invariant;
  const Trial simple = shrink(
      trial, [&](const Trial& t) { return judge(t, range).breaks(broken); }, kShrinkTrials);
  return faults_text(judge(simple, range)) + trial_text(simple);
}

class FailureReport {
 public:
  FailureReport(const Options& options, ProgressLine& progress) : options_(options), progress_(progress) {
    if (!options.keep.empty()) std::filesystem::create_directories(options.keep);
  }

  void operator()(std::uint64_t seed, const Verdict& verdict) {
    const char* const range = to_string(options_.hunt.range);
    const char* const invariant = to_string(verdict.faults.front().invariant);
    std::ostringstream text;
    text << "\nFAILED: seed " << seed << " (" << range << ")\n" << faults_text(verdict);
    if (count_++ < options_.shrunk) {
      const std::string scene = shrunk_text(trial_of(seed, options_.hunt), options_.hunt.range, verdict);
      text << "--- shrunk\n" << scene;
      if (!options_.keep.empty()) {
        const std::string path = options_.keep + "/" + range + "_" + std::to_string(seed) + "_" + invariant + ".yaml";
        std::ofstream(path) << scene;
        text << "--- kept as " << path << "\n";
      }
    }
    progress_.clear();
    std::cout << text.str() << std::flush;
  }

 private:
  const Options& options_;
  ProgressLine& progress_;
  int count_ = 0;
};

int judge_file(const std::string& path, Range range) {
  const Verdict verdict = judge(load_trial_file(path), range);
  std::cout << faults_text(verdict) << (verdict.faults.empty() ? "every invariant held" : "FAILED")
            << (verdict.has_start ? "" : " (no start: nothing ran)")
            << (verdict.refusal.empty() ? "" : " (the solver gave up: " + verdict.refusal + ")")
            << (verdict.sensitive ? " (too sensitive to compare)" : "") << "\n";
  return verdict.faults.empty() ? 0 : 1;
}

int run(const Options& options) {
  const InterruptGuard interrupt;
  ProgressLine progress(options.hunt.count);
  FailureReport report(options, progress);
  Hunt hunt(options.hunt, [&](std::uint64_t seed, const Verdict& verdict) { report(seed, verdict); });
  while (!hunt.done()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const Tally tally = hunt.tally();
    progress.show(tally.scenes, tally.failed);
    if (interrupt.signal() != 0) hunt.stop();
    if (const std::int64_t seed = hunt.hanging(kHangSeconds); seed >= 0) {
      std::cout << "\nFAILED: seed " << seed << " (" << to_string(options.hunt.range) << ") hangs\n" << std::flush;
      std::_Exit(1);
    }
  }
  progress.clear();
  const Tally tally = hunt.tally();
  std::cout << summary(tally, options.hunt.range);
  std::printf("%.0f s, %.1f scenes a second\n", progress.seconds(),
              static_cast<double>(tally.scenes) / progress.seconds());
  if (interrupt.signal() != 0) return 128 + interrupt.signal();
  return tally.failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace vibratory_alignment::hunt

int main(int argc, char** argv) {
  using namespace vibratory_alignment;
  using hunt::Range;
  CLI::App app("Runs random scenes and holds every trial against what must be true of all of them.", "hunt");
  hunt::Options options;
  app.footer(hunt::kFooter);
  app.add_option("--from", options.hunt.from, "First seed")->capture_default_str();
  app.add_option("--count", options.hunt.count, "How many scenes")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--range", options.hunt.range,
                 "ordinary: what a gripper and a hole could be; wild: far beyond; round: as people write them")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Range>{{"ordinary", Range::ordinary}, {"wild", Range::wild}, {"round", Range::round}}))
      ->type_name("ordinary|wild|round");
  app.add_option("--solver", options.hunt.solver, "Solver; all others are compared with event")
      ->check(CLI::IsMember({"event", "implicit", kImplicitAlone, "auto"}))
      ->capture_default_str();
  app.add_flag("--changes", options.hunt.changes,
               "Cut every trial at random instants, and change excitations and press");
  app.add_option("--threads", options.hunt.threads, "Threads")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--keep", options.keep, "Write every shrunk scene that fails to this directory")->type_name("DIR");
  app.add_option("--shrink", options.shrunk, "Shrink this many of the scenes that fail")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--open", options.hunt.open, "Seeds whose fault is known: no failure, unless it is mended")
      ->delimiter(',')
      ->type_name("SEED,...");
  app.add_option("--scene", options.scene, "Judge this scene file instead of random ones")->type_name("FILE");
  app.add_option("--show", options.show, "Print the scene of this seed and judge nothing")->type_name("SEED");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (options.show) {
      std::cout << hunt::trial_text(hunt::trial_of(*options.show, options.hunt));
      return 0;
    }
    return options.scene.empty() ? hunt::run(options) : hunt::judge_file(options.scene, options.hunt.range);
  } catch (const SceneError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
