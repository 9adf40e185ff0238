// The hunt: many random scenes, judged by several threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "changes.h"
#include "random_scene.h"
#include "tally.h"

namespace vibratory_alignment::hunt {

struct HuntOptions {
  Range range = Range::ordinary;
  std::uint64_t from = 0;  ///< first seed
  long count = 10000;
  int threads = 1;
  std::string solver = "event";
  bool changes = false;             ///< random ones in every trial
  std::vector<std::uint64_t> open;  ///< seeds with a fault that is known; a failure only once it is mended
};

/// The random trial of a seed, for the solver asked.
Trial trial_of(std::uint64_t seed, const HuntOptions& options);

/// Runs in the background from its construction on.
class Hunt {
 public:
  /// `on_failure` is called for every scene that breaks an invariant, by one thread at a time.
  using OnFailure = std::function<void(std::uint64_t seed, const Verdict& verdict)>;

  Hunt(const HuntOptions& options, OnFailure on_failure);
  ~Hunt();
  Hunt(const Hunt&) = delete;
  Hunt& operator=(const Hunt&) = delete;

  bool done() const { return running_ == 0; }
  /// Ends it after the scenes that are under way.
  void stop() { stopped_ = true; }
  Tally tally() const;
  /// The seed that has been under way for longer than `seconds` of CPU time, or -1.
  std::int64_t hanging(double seconds) const;

 private:
  struct Worker {
    std::atomic<std::int64_t> seed{-1};  ///< under way, -1: none
    std::atomic<double> started{0.0};    ///< CPU time at its start, s
    std::thread thread;
  };

  void work(Worker& worker);
  /// CPU time of the process for each of its threads: a computer that sleeps, or does something else, lets nothing
  /// hang.
  double cpu_time_s() const;

  HuntOptions options_;
  OnFailure on_failure_;
  std::atomic<long> next_{0};
  std::atomic<bool> stopped_{false};
  std::atomic<int> running_;
  mutable std::mutex tally_mutex_, failure_mutex_;
  Tally tally_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace vibratory_alignment::hunt
