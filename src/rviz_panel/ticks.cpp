#include "rviz_panel/ticks.h"

#include <cmath>

namespace vibratory_alignment {

std::vector<double> ticks(double low, double high, int count) {
  std::vector<double> marks;
  if (!(high > low) || !std::isfinite(high - low)) return marks;
  const double least = (high - low) / count;
  double step = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {2.0, 2.5, 2.0}) {
    if (step >= least) break;
    step *= factor;
  }
  const double roundoff = 1e-9 * step;
  for (double i = std::ceil((low - roundoff) / step); i * step <= high + roundoff; ++i) marks.push_back(i * step);
  return marks;
}

}  // namespace vibratory_alignment
