#include "hunt.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "random_changes.h"
#include "trace.h"

namespace vibratory_alignment::hunt {
namespace {

/// Below the one an implicit step is known to rounding only (docs/implicit_steps.md "Rounding"), above the other it
/// passes over bounces that are smaller, and has other touches.
constexpr double kLeastImplicitTolerance = 1e-10, kMostImplicitTolerance = 1e-6;

void allow_open_fault(Verdict& verdict) {
  verdict.open = !verdict.faults.empty();
  verdict.faults.clear();
  if (!verdict.open) verdict.faults.push_back({Invariant::ends, "every invariant holds: the fault is open no longer"});
}

}  // namespace

Trial trial_of(std::uint64_t seed, const HuntOptions& options) {
  Scene scene = random_scene(seed, options.range);
  scene.solver.name = options.solver;
  if (takes_implicit_steps(scene))
    scene.solver.tolerance = std::clamp(scene.solver.tolerance, kLeastImplicitTolerance, kMostImplicitTolerance);
  if (!options.changes) return scene;
  return {scene, random_changes(seed, scene)};
}

Hunt::Hunt(const HuntOptions& options, OnFailure on_failure)
    : options_(options), on_failure_(std::move(on_failure)), running_(options.threads) {
  for (int i = 0; i < options.threads; ++i) workers_.push_back(std::make_unique<Worker>());
  for (const auto& worker : workers_) worker->thread = std::thread([this, w = worker.get()] { work(*w); });
}

Hunt::~Hunt() {
  stop();
  for (const auto& worker : workers_) worker->thread.join();
}

void Hunt::work(Worker& worker) {
  for (long i = next_++; i < options_.count && !stopped_; i = next_++) {
    const std::uint64_t seed = options_.from + static_cast<std::uint64_t>(i);
    worker.started = cpu_time_s();
    worker.seed = static_cast<std::int64_t>(seed);
    Verdict verdict = judge(trial_of(seed, options_), options_.range);
    if (std::find(options_.open.begin(), options_.open.end(), seed) != options_.open.end()) allow_open_fault(verdict);
    worker.seed = -1;
    {
      const std::lock_guard lock(tally_mutex_);
      tally_.add(seed, verdict);
    }
    if (verdict.faults.empty()) continue;
    const std::lock_guard lock(failure_mutex_);
    on_failure_(seed, verdict);
  }
  --running_;
}

double Hunt::cpu_time_s() const {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC) / options_.threads;
}

Tally Hunt::tally() const {
  const std::lock_guard lock(tally_mutex_);
  return tally_;
}

std::int64_t Hunt::hanging(double seconds) const {
  for (const auto& worker : workers_) {
    const std::int64_t seed = worker->seed;
    if (seed >= 0 && cpu_time_s() - worker->started > seconds) return seed;
  }
  return -1;
}

}  // namespace vibratory_alignment::hunt
