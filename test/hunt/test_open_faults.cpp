// The scenes of open/, if there are any, whose faults are known (README.md "Open faults"): they are no worse than their
// first lines say.
// Those of mended/ break nothing any more.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "scene_text.h"
#include "trial/make_solver.h"
#include "verdict.h"

namespace vibratory_alignment::hunt {
namespace {

/// "# no_passing, mirror: A corner ..." -> no_passing, mirror; "refused" where the solver gives up and nothing else is
/// wrong.
std::set<std::string> known_faults(const std::filesystem::path& file) {
  std::ifstream text(file);
  std::string line, word;
  std::getline(text, line, ':');
  std::istringstream words(line.substr(std::min<std::size_t>(line.size(), 1)));
  std::set<std::string> known;
  while (std::getline(words >> std::ws, word, ',')) known.insert(word);
  return known;
}

bool is_invariant(const std::string& word) {
  for (int i = 0; i < kInvariantCount; ++i)
    if (word == to_string(static_cast<Invariant>(i))) return true;
  return false;
}

TEST(OpenFaults, are_no_worse_than_they_are_said_to_be) {
  if (!std::filesystem::exists(OPEN_FAULTS)) GTEST_SKIP() << "no fault is open";
  for (const auto& entry : std::filesystem::directory_iterator(OPEN_FAULTS)) {
    const std::set<std::string> known = known_faults(entry.path());
    const std::string name = entry.path().stem();
    ASSERT_FALSE(known.empty()) << name;
    const Verdict verdict = judge(load_trial_file(entry.path()), Range::wild);
    EXPECT_TRUE(verdict.has_start) << name;
    if (known.count("refused") == 0) {
      for (const std::string& word : known) EXPECT_TRUE(is_invariant(word)) << name << ": " << word;
      EXPECT_FALSE(verdict.faults.empty() && !verdict.refusal.empty()) << name << " is refused, and nothing else";
    }
    for (const Fault& fault : verdict.faults)
      EXPECT_EQ(known.count(to_string(fault.invariant)), 1u) << name << ": " << to_string(fault.invariant) << ", "
                                                             << fault.detail;
  }
}

TEST(MendedFaults, break_nothing_any_more) {
  int seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MENDED_FAULTS)) {
    Trial trial = load_trial_file(entry.path());
    const std::string found_with = trial.scene.solver.name;
    for (const char* solver : {"event", "implicit", "auto", kImplicitAlone}) {
      trial.scene.solver.name = solver;
      const Verdict verdict = judge(trial, Range::wild);
      EXPECT_TRUE(verdict.has_start);
      // others may take more steps than the hunt allows
      const bool may_refuse = solver != found_with && verdict.refusal == "step limit";
      EXPECT_TRUE(may_refuse || verdict.refusal.empty()) << entry.path() << " " << solver << ": " << verdict.refusal;
      for (const Fault& fault : verdict.faults)
        ADD_FAILURE() << entry.path() << " " << solver << ": " << to_string(fault.invariant) << ", " << fault.detail;
    }
    ++seen;
  }
  EXPECT_GT(seen, 0);
}

}  // namespace
}  // namespace vibratory_alignment::hunt
