// Prints the converged answers as lines of the peer `reference` (see report.h; setting, counts and times are 0).
#include <cstdio>

#include "problem.h"

namespace va = vibratory_alignment::peers;

int main() {
  for (const auto& problems : {va::regularised_problems(), va::dry_problems()}) {
    for (const va::Problem& problem : problems) {
      if (!problem.has_answer) continue;
      std::printf("reference,%s,0", problem.name.c_str());
      for (const double value : problem.answer) std::printf(",%.17g", value);
      std::printf(",0,0,0,0,0\n");
    }
  }
}
