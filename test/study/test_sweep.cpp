// A sweep: every trial once, in order, the same bits whatever the threads; refused and failed ones are rows too.
#include "study/sweep.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "study/design.h"
#include "study/trial_scenes.h"
#include "study_text.h"

namespace vibratory_alignment {
namespace {

using test::study_of;

const std::string small = R"(
set: {trial.time_limit: 0.8}
vary:
  - gripper.pressing_force: {from: 0.1, to: 0.8, count: 8}
  - excitation.frequency: [15, 25]
  - excitation.phase: {from: 0, to: 6}
samples: {count: 9}
)";

/// All of a row, bit by bit.
std::string bits_of(const TrialRow& row) {
  std::string bits = std::to_string(row.index) + outcome_word(row) + row.reason + to_string(row.mode);
  const auto add = [&](const auto& value) { bits.append(reinterpret_cast<const char*>(&value), sizeof value); };
  add(row.duration), add(row.end_time), add(row.nonimpact_time), add(row.end), add(row.impacts), add(row.first_impact),
      add(row.last_impact);
  add(row.peak_force), add(row.normal_impulse), add(row.friction_impulse), add(row.impulse_x), add(row.impulse_y);
  add(row.contact_time);
  return bits;
}

std::vector<std::string> rows_of(const Study& study, const SweepOptions& options) {
  std::vector<std::string> rows;
  EXPECT_TRUE(run_sweep(study, options, [&](const TrialRow& row) { rows.push_back(bits_of(row)); }));
  return rows;
}

SweepOptions with_threads(int threads) {
  SweepOptions options;
  options.threads = threads;
  return options;
}

TEST(Sweep, GivesEveryTrialOnceInOrder) {
  const Study study = study_of(small);
  std::size_t next = 0;
  TrialScenes scenes(study);
  EXPECT_TRUE(run_sweep(study, with_threads(3), [&](const TrialRow& row) {
    ASSERT_EQ(row.index, next);
    EXPECT_EQ(bits_of(row), bits_of(run_trial_row(scenes.at(next), next)));
    ++next;
  }));
  EXPECT_EQ(next, 8u * 2u * 9u);
}

TEST(Sweep, ThreadsChangeNoBit) {
  const Study study = study_of(small);
  const std::vector<std::string> one = rows_of(study, with_threads(1));
  for (const int threads : {2, 3, 8}) EXPECT_EQ(rows_of(study, with_threads(threads)), one) << threads;
}

TEST(Sweep, ShardsTogetherAreTheWhole) {
  const Study study = study_of(small);
  const std::vector<std::string> whole = rows_of(study, with_threads(2));
  for (const std::size_t shards : {std::size_t{2}, std::size_t{5}, std::size_t{200}}) {
    std::vector<std::string> together(whole.size());
    for (std::size_t shard = 0; shard < shards; ++shard) {
      SweepOptions options = with_threads(2);
      options.first = shard;
      options.stride = shards;
      std::size_t index = shard;
      for (const std::string& row : rows_of(study, options)) together.at(index) = row, index += shards;
    }
    EXPECT_EQ(together, whole) << shards;
  }
}

// More trials than the ring has room for; the first is long, so that the threads run ahead of it as far as they may.
TEST(Sweep, KeepsTheOrderWhenTheFirstTrialIsTheLongest) {
  const Study study = study_of(
      "set: {solver: {name: rk4, step: 1.0e-5}}\n"
      "vary: {trial.time_limit: [30" +
      [] {
        std::string rest;
        for (int i = 0; i < 3000; ++i) rest += ", 0.001";
        return rest;
      }() +
      "]}");
  std::size_t next = 0;
  EXPECT_TRUE(run_sweep(study, with_threads(2), [&](const TrialRow& row) { EXPECT_EQ(row.index, next++); }));
  EXPECT_EQ(next, 3001u);
}

TEST(Sweep, RefusedAndFailedTrialsAreRows) {
  const Study study =
      study_of("vary: [{slot.clearance: [0.1, 0]}, {initial.x: [0.2, 40]}, {solver.step_limit: [3, 1000000]}]");
  std::vector<std::string> words, reasons;
  run_sweep(study, with_threads(2), [&](const TrialRow& row) {
    words.push_back(outcome_word(row));
    reasons.push_back(row.reason);
  });
  ASSERT_EQ(words.size(), 8u);
  EXPECT_EQ(words[0], "failed");
  EXPECT_NE(words[1], "failed");
  EXPECT_NE(words[1], "refused");
  for (std::size_t i = 2; i < 8; ++i) EXPECT_EQ(words[i], "refused") << i;
  EXPECT_NE(reasons[4].find("slot.clearance: 0: must be a number > 0"), std::string::npos) << reasons[4];
  EXPECT_TRUE(reasons[1].empty());
  EXPECT_FALSE(reasons[2].empty());
}

// Trials that take hours: they are given up on the way, or this test does not end.
TEST(Sweep, EndsWhenTold) {
  const Study study =
      study_of("set: {solver: {name: rk4, step: 1.0e-9, step_limit: 1.0e15}}\nvary: {excitation.phase: [0, 1, 2, 3]}");
  SweepOptions options = with_threads(2);
  int asked = 0;
  options.go_on = [&] { return ++asked < 3; };
  EXPECT_FALSE(run_sweep(study, options, [](const TrialRow&) { FAIL() << "no trial can be through"; }));
  EXPECT_EQ(asked, 3);
}

TEST(Sweep, WhatTheSinkThrowsEndsIt) {
  const Study study = study_of(small);
  const auto sink = [](const TrialRow& row) {
    if (row.index == 20) throw std::domain_error("full");
  };
  EXPECT_THROW(run_sweep(study, with_threads(2), sink), std::domain_error);
}

TEST(Sweep, AllTheSinkSeesIsInTheCallingThread) {
  const std::thread::id self = std::this_thread::get_id();
  run_sweep(study_of(small), with_threads(2), [&](const TrialRow&) { ASSERT_EQ(std::this_thread::get_id(), self); });
}

}  // namespace
}  // namespace vibratory_alignment
