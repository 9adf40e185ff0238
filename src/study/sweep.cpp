// Threads take the next trial that nobody has taken yet, and put its row into a ring; the calling thread takes rows out
// in order. A thread waits when the ring has no room: some trial before its own takes long.
#include "study/sweep.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "model/scene.h"
#include "model/scene_error.h"
#include "study/design.h"
#include "study/thread_group.h"
#include "study/trial_scenes.h"

namespace vibratory_alignment {
namespace {

constexpr std::size_t kRing = 1024;
/// The calling thread is woken for so many rows, or after so long for fewer.
constexpr std::size_t kBatch = 64;
constexpr std::chrono::milliseconds kTurn(50);

class Crew {
 public:
  Crew(const Study& study, const SweepOptions& options) : first_(options.first), stride_(options.stride), ring_(kRing) {
    const std::size_t all = trial_count(study);
    count_ = first_ < all ? (all - first_ - 1) / stride_ + 1 : 0;
    const auto threads = std::min<std::size_t>(static_cast<std::size_t>(std::max(1, options.threads)), count_);
    // all trees are copied before a thread runs: yaml-cpp's are for one thread at a time
    std::vector<TrialScenes> scenes;
    for (std::size_t i = 0; i < threads; ++i) scenes.emplace_back(study);
    try {
      for (TrialScenes& own : scenes) threads_.start([this, own = std::move(own)]() mutable { work(own); });
    } catch (...) {
      stop();  // those that have started
      throw;
    }
  }

  ~Crew() { stop(); }

  /// Takes out the rows that are next in order, waiting for them one turn at most. False when all have been taken.
  /// Rethrows what ended a thread.
  bool take(std::vector<TrialRow>& rows) {
    rows.clear();
    std::unique_lock lock(mutex_);
    if (taken_ == count_) return false;
    filled_.wait_for(lock, kTurn, [&] { return error_ || worth_waking(); });
    if (error_) std::rethrow_exception(error_);
    for (; taken_ < count_ && ring_[taken_ % kRing]; ++taken_) {
      rows.push_back(std::move(*ring_[taken_ % kRing]));
      ring_[taken_ % kRing].reset();
    }
    lock.unlock();
    emptied_.notify_all();
    return true;
  }

 private:
  void work(TrialScenes& scenes) {
    try {
      while (const std::optional<std::size_t> place = claim()) put(*place, row(scenes, first_ + *place * stride_));
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      filled_.notify_one();
    }
  }

  TrialRow row(TrialScenes& scenes, std::size_t index) const {
    std::optional<Scene> scene;
    try {
      scene = scenes.at(index);
    } catch (const SceneError& error) {
      return refused_row(index, error);
    }
    return run_trial_row(*scene, index, &stopped_);
  }

  /// The next place that has room; none when all are claimed, or the sweep ends.
  std::optional<std::size_t> claim() {
    std::unique_lock lock(mutex_);
    emptied_.wait(lock, [&] { return stopped_ || claimed_ == count_ || claimed_ < taken_ + kRing; });
    if (stopped_ || claimed_ == count_) return std::nullopt;
    return claimed_++;
  }

  void put(std::size_t place, TrialRow row) {
    const std::lock_guard lock(mutex_);
    ring_[place % kRing] = std::move(row);
    ++put_;
    if (worth_waking()) filled_.notify_one();
  }

  bool worth_waking() const { return ring_[taken_ % kRing] && (put_ - taken_ >= kBatch || put_ == count_); }

  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    emptied_.notify_all();
  }

  std::size_t first_, stride_, count_ = 0;
  std::atomic<bool> stopped_{false};

  std::mutex mutex_;  // guards all that follows
  std::condition_variable filled_, emptied_;
  std::vector<std::optional<TrialRow>> ring_;  ///< row of place p at p modulo its size
  std::size_t claimed_ = 0, put_ = 0, taken_ = 0;
  std::exception_ptr error_;

  ThreadGroup threads_;  // the first to go
};

}  // namespace

bool run_sweep(const Study& study, const SweepOptions& options, const std::function<void(const TrialRow&)>& sink) {
  Crew crew(study, options);
  std::vector<TrialRow> rows;
  while (crew.take(rows)) {
    for (const TrialRow& row : rows) sink(row);
    if (options.go_on && !options.go_on()) return false;
  }
  return true;
}

}  // namespace vibratory_alignment
