// One integration at a time through plain functions, for the peers in Python and Octave: they call this compiled
// right-hand side, the one that the C++ peers use.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "progress.h"

namespace vibratory_alignment::peers {

class PeerSession {
 public:
  // Throws std::invalid_argument for a problem that is not there.
  void begin(const std::string& name) {
    for (const Problem& problem : problems_) {
      if (problem.name != name) continue;
      problem_ = &problem;
      progress_ = std::make_unique<Progress>(problem);
      return;
    }
    throw std::invalid_argument("no problem " + name);
  }

  const Problem& problem() const { return *problem_; }
  Progress& progress() { return *progress_; }

 private:
  std::vector<Problem> problems_ = regularised_problems();
  const Problem* problem_ = nullptr;
  std::unique_ptr<Progress> progress_;
};

}  // namespace vibratory_alignment::peers
