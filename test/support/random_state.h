// States at random, in the slot or anywhere about it.
#pragma once

#include <random>

#include "mechanics/state.h"

namespace vibratory_alignment::test {

inline State random_state(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  return {0.5 * u(random), 0.9 + 0.5 * u(random), 2.0 * u(random), u(random), u(random), 2.0 * u(random)};
}

}  // namespace vibratory_alignment::test
