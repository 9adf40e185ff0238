// Makes the node known to a master that was started anew: roscpp registers topics and services only once.
//
// The calls to the master may block, so a thread of its own makes them. It sees nothing of the trial.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace vibratory_alignment {

/// Number of the master's process; 0 while there is none.
int master_process();

class MasterWatch {
 public:
  /// `services`: all that this node advertises, by full name, first the one that was first: a master that does not know
  /// it came later and may know only a part. Topics are found. `known`: the master's process before anything was
  /// registered.
  MasterWatch(std::vector<std::string> services, int known);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

 private:
  void watch(int known);

  std::vector<std::string> services_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace vibratory_alignment
