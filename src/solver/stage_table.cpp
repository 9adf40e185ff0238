#include "solver/stage_table.h"

#include <algorithm>

namespace vibratory_alignment {
namespace {

StageTable make_stage_table() {
  constexpr std::size_t kStages = StageTable::kStages, kModes = StageTable::kModes;
  const Collocation& from = collocation();
  StageTable table;
  for (std::size_t i = 0; i <= kStages; ++i) {
    const std::size_t stage = std::min(i, kStages - 1);
    const bool twice = i == kStages;
    table.node[i] = from.node[stage];
    table.at_start[i] = twice ? 0.0 : from.at_start[stage];
    table.last_power[i] = twice ? 0.0 : from.acceleration_power[kStages - 1][stage];
    for (std::size_t j = 0; j < kStages; ++j) {
      table.velocity[j][i] = from.velocity[stage][j];
      table.position[j][i] = from.position[stage][j];
      table.acceleration_power[j][i] = twice ? 0.0 : from.acceleration_power[i][j];
      table.lagrange[j][i] = twice ? 0.0 : from.acceleration_power[j][i];
    }
    for (std::size_t j = 0; j <= kStages; ++j) table.value_power[j][i] = from.value_power[i][j];
    for (std::size_t m = 0; m < kModes; ++m) {
      const double weight = m == 0 ? 1.0 : 2.0;
      table.weight[m] = weight;
      table.eigenvalue_real[m] = from.eigenvalue[m].real();
      table.eigenvalue_imaginary[m] = from.eigenvalue[m].imag();
      table.from_modes[m][i] = weight * from.mode[m][stage].real();
      table.from_modes[kModes + m][i] = -weight * from.mode[m][stage].imag();
      table.dual[m][i] = twice ? 0.0 : from.dual[m][stage].real();
      table.dual[kModes + m][i] = twice ? 0.0 : -from.dual[m][stage].imag();
      if (twice) continue;
      table.mode[i][m] = from.mode[m][i].real();
      table.mode[i][kModes + m] = from.mode[m][i].imag();
      table.to_modes[i][m] = from.dual[m][i].real();
      table.to_modes[i][kModes + m] = from.dual[m][i].imag();
    }
  }
  return table;
}

}  // namespace

const StageTable& stage_table() {
  static const StageTable table = make_stage_table();
  return table;
}

}  // namespace vibratory_alignment
