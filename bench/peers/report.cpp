#include "report.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iterator>
#include <limits>

namespace vibratory_alignment::peers {
namespace {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void print(const std::string& peer, const std::string& problem, double setting, const Outcome& o, double least,
           double median) {
  std::printf("%s,%s,%.6g", peer.c_str(), problem.c_str(), setting);
  for (const double value : o.end) std::printf(",%.17g", value);
  std::printf(",%ld,%ld,%ld,%.4g,%.4g\n", o.evaluations, o.steps, o.events, least, median);
  std::fflush(stdout);
}

}  // namespace

double report(const std::string& peer, const std::string& problem, double setting,
              const std::function<Outcome()>& integrate) {
  constexpr double enough_s = 0.15, too_much_s = 3.0;
  constexpr std::size_t least_repetitions = 5;
  Outcome outcome;
  std::vector<double> times;
  double spent = 0.0;
  try {
    while ((spent < enough_s || times.size() < least_repetitions) && spent < too_much_s) {
      const double begin = processor_seconds();
      outcome = integrate();
      times.push_back(processor_seconds() - begin);
      spent += times.back();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s, %s, setting %g: %s\n", peer.c_str(), problem.c_str(), setting, error.what());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    outcome.end.fill(nan);
    print(peer, problem, setting, outcome, nan, nan);
    return nan;
  }
  std::sort(times.begin(), times.end());
  print(peer, problem, setting, outcome, times.front(), times[times.size() / 2]);
  return times.front();
}

std::vector<Problem> chosen(const std::vector<Problem>& known, int argc, char** argv) {
  if (argc < 2) return known;
  std::vector<Problem> list;
  std::copy_if(known.begin(), known.end(), std::back_inserter(list),
               [&](const Problem& p) { return std::find(argv + 1, argv + argc, p.name) != argv + argc; });
  return list;
}

std::vector<double> tolerances(const Problem& problem) {
  const int per_decade = problem.name.rfind("r1_eps_", 0) == 0 ? 1 : 3;
  std::vector<double> list;
  for (int i = 2 * per_decade; i <= 13 * per_decade; ++i)
    list.push_back(std::pow(10.0, -static_cast<double>(i) / per_decade));
  return list;
}

std::vector<long> step_counts() {
  std::vector<long> list;
  for (long decade = 500; decade < 500'000; decade *= 10)
    for (const long part : {decade, 2 * decade, 5 * decade}) list.push_back(part);
  list.push_back(500'000);
  list.push_back(1'000'000);
  return list;
}

}  // namespace vibratory_alignment::peers
