// Threads that have ended before what they work on is gone.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace vibratory_alignment {

/// As many as there are processors, where nobody says how many; 1 where that is not known.
inline int usual_thread_count() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

class ThreadGroup {
 public:
  ThreadGroup() = default;
  ThreadGroup(const ThreadGroup&) = delete;
  ThreadGroup& operator=(const ThreadGroup&) = delete;
  /// Whoever owns the group has told them to end by then.
  ~ThreadGroup() { join(); }

  /// `work()` runs in a thread of its own. Throws std::runtime_error when there can be no further one.
  template <class Work>
  void start(Work work) {
    try {
      threads_.emplace_back(std::move(work));
    } catch (const std::system_error& error) {
      throw std::runtime_error("cannot start thread " + std::to_string(threads_.size() + 1) + ": " +
                               error.code().message());
    }
  }

  /// Waits until all have ended.
  void join() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  std::vector<std::thread> threads_;
};

}  // namespace vibratory_alignment
