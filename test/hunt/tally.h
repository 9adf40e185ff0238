// What a hunt has met so far.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "fault.h"
#include "random_scene.h"
#include "verdict.h"

namespace vibratory_alignment::hunt {

struct Tally {
  long scenes = 0, without_start = 0, sensitive = 0, open = 0, failed = 0;
  std::map<std::string, long> refusals;        ///< by reason
  std::array<long, 7> outcomes{};              ///< by Outcome
  std::array<long, kInvariantCount> faults{};  ///< by Invariant
  std::uint64_t digest = 0;                    ///< of all answers; does not depend on their order

  void add(std::uint64_t seed, const Verdict& verdict);
};

/// The table at the end of a hunt.
std::string summary(const Tally& tally, Range range);

}  // namespace vibratory_alignment::hunt
