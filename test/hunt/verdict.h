// The verdict on one trial: it is run as it is, sampled at some other rate, mirrored, and where it is changed on its
// way also only cut there, and set to what it is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "changes.h"
#include "fault.h"
#include "random_scene.h"
#include "trial/outcome.h"

namespace vibratory_alignment::hunt {

struct Verdict {
  bool has_start = true;   ///< false: the scene was refused before anything ran
  std::string refusal;     ///< why the solver gave up, empty if it did not
  bool sensitive = false;  ///< mirror images or methods differ, but so do starts that differ in the last digits
  bool open = false;       ///< its faults are known, and taken out of `faults`
  Outcome outcome = Outcome::running;
  std::uint64_t digest = 0;  ///< of the answer
  std::vector<Fault> faults;

  bool breaks(Invariant invariant) const;
};

/// Never throws.
Verdict judge(const Trial& trial, Range range);

}  // namespace vibratory_alignment::hunt
