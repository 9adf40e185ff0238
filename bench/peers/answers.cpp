// Prints the converged answers as lines of the peer `reference` (see report.h; setting, counts and times are 0).
//
//   answers          the lines
//   answers names    the names of all problems instead
#include <cstdio>
#include <string>

#include "problem.h"

namespace va = vibratory_alignment::peers;

namespace {

void print(const va::Problem& problem) {
  if (!problem.has_answer) return;
  std::printf("reference,%s,0", problem.name.c_str());
  for (const double value : problem.answer) std::printf(",%.17g", value);
  std::printf(",0,0,0,0,0\n");
}

}  // namespace

int main(int argc, char** argv) {
  const bool names = argc == 2 && argv[1] == std::string("names");
  for (const auto& problems : {va::regularised_problems(), va::dry_problems()}) {
    for (const va::Problem& problem : problems) {
      if (names)
        std::printf("%s\n", problem.name.c_str());
      else
        print(problem);
    }
  }
}
