// Facts with their studies: the shipped suite, settings, thinning, threads.
#include "study/fact_suite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "model/setting.h"
#include "study/design.h"
#include "study/trial_table.h"
#include "study_text.h"

namespace vibratory_alignment {
namespace {

std::string scene_path(const std::string& name) { return std::string(SCENE_DIR) + "/" + name + ".yaml"; }

const FactSuite& shipped_suite() {
  static const FactSuite suite = load_fact_suite(std::string(SCENE_DIR) + "/../paper/facts.yaml", scene_path);
  return suite;
}

/// The shipped suite with these facts alone, and no figures.
FactSuite suite_of(const std::vector<std::string>& ids) {
  FactSuite suite = shipped_suite();
  suite.book.figures.clear();
  auto& facts = suite.book.facts;
  facts.erase(std::remove_if(facts.begin(), facts.end(),
                             [&](const Fact& f) { return std::find(ids.begin(), ids.end(), f.id) == ids.end(); }),
              facts.end());
  return suite;
}

TEST(ShippedFacts, are_all_that_the_paper_states) {
  std::vector<std::string> ids;
  for (const Fact& fact : shipped_suite().book.facts) ids.push_back(fact.id);
  EXPECT_EQ(ids,
            (std::vector<std::string>{"M1",   "M2",   "M3",   "F2.1", "F2.2", "F2.3", "F3.1", "F3.2", "N1",   "N2",
                                      "N3",   "N4",   "F4.1", "F4.2", "F4.3", "F4.4", "F5",   "F6.1", "F6.2", "F6.3",
                                      "F6.4", "F7.1", "F7.2", "F7.3", "F7.4", "F8.1", "R1",   "R2"}));
}

TEST(ShippedFacts, keep_what_the_captions_print) {
  const auto number = [&](const char* study, const char* key) {
    return find_value(*shipped_suite().studies.at(study).scene, key)->as<double>();
  };
  EXPECT_EQ(number("fig2", "gripper.pressing_force"), 0.2);
  EXPECT_EQ(number("fig2", "slot.clearance"), 0.09);
  EXPECT_EQ(number("fig2", "initial.x"), 0.2);
  EXPECT_EQ(number("fig2", "initial.y"), 0.895);
  EXPECT_EQ(number("fig2", "initial.phi"), 0.025);
  EXPECT_EQ(number("fig2", "excitation.frequency"), 20.0);
  EXPECT_EQ(number("fig3", "gripper.stiffness.phi"), 60.0);
  EXPECT_EQ(number("fig3", "gripper.pressing_force"), 0.3);
  EXPECT_EQ(number("fig3", "slot.clearance"), 0.02);
  EXPECT_EQ(number("fig3", "initial.x"), 0.2);
  EXPECT_EQ(number("fig3", "initial.y"), 0.90);
  EXPECT_EQ(number("fig3", "initial.phi"), 0.003);
  EXPECT_EQ(number("fig3", "excitation.frequency"), 20.0);
}

/// The same text for `key: value` on lines of their own and in braces.
std::string on_one_line(const YAML::Node& node) {
  if (node.IsScalar()) return node.Scalar();
  std::string text;
  for (const auto& entry : node)
    text += node.IsMap() ? entry.first.Scalar() + ": " + on_one_line(entry.second) + ", " : on_one_line(entry) + ", ";
  return text;
}

// One part, one slot material, one gripper damping for all figures.
TEST(ShippedFacts, share_one_set_of_material_and_geometry) {
  for (const auto& [name, study] : shipped_suite().studies)
    for (const char* key : {"part.half_width", "part.base_distance", "gripper.damping", "base", "friction", "contacts",
                            "trial.aligned_depth"}) {
      const auto value = find_value(*study.scene, key),
                 first = find_value(*shipped_suite().studies.at("fig2").scene, key);
      ASSERT_TRUE(value && first) << name << ": " << key;
      EXPECT_EQ(on_one_line(*value), on_one_line(*first)) << name << ": " << key;
    }
}

TEST(EvaluateFacts, is_the_same_with_any_number_of_threads) {
  FactRunOptions options;
  options.thinning = {16, 8};
  const FactSuite suite = suite_of({"F2.1", "F2.3", "F4.2", "F7.2"});
  const std::vector<FactResult> one = evaluate_facts(suite, options);
  options.threads = 3;
  const std::vector<FactResult> three = evaluate_facts(suite, options);
  ASSERT_EQ(one.size(), 4U);
  for (std::size_t i = 0; i < one.size(); ++i)
    for (std::size_t k = 0; k < one[i].measures.size(); ++k) {
      const double a = one[i].measures[k].reading.value, b = three[i].measures[k].reading.value;
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << one[i].id;
      EXPECT_EQ(one[i].shortfall, three[i].shortfall);
    }
}

TEST(EvaluateFacts, applies_settings_of_all_and_of_one_study) {
  const FactSuite suite = suite_of({"F2.1", "F3.1"});
  FactRunOptions options;
  // pressed with 5, many times the excitation, no part aligns so early
  options.settings.all = {"gripper.pressing_force=5", "trial.time_limit=0.5"};
  std::vector<FactResult> results = evaluate_facts(suite, options);
  EXPECT_TRUE(std::isnan(results[0].measures[0].reading.value));
  EXPECT_TRUE(results[1].met);
  // the settings of the one study come last
  options.settings.of_study["fig2"] = {"gripper.pressing_force=0.2", "trial.time_limit=20"};
  results = evaluate_facts(suite, options);
  EXPECT_FALSE(std::isnan(results[0].measures[0].reading.value));
  EXPECT_TRUE(results[1].met);
  EXPECT_EQ(results[0].measures[0].reading.value, evaluate_facts(suite, FactRunOptions{})[0].measures[0].reading.value);
}

TEST(EvaluateFacts, tells_how_far_it_is) {
  // a trial of Fig. 3, and one of Fig. 2 for its touches
  FactRunOptions options;
  std::size_t last = 0, all = 0;
  options.progress = [&](std::size_t done, std::size_t of) {
    EXPECT_EQ(done, last + 1);
    last = done;
    all = of;
  };
  evaluate_facts(suite_of({"F2.3", "F3.1"}), options);
  EXPECT_EQ(last, 2U);
  EXPECT_EQ(all, 2U);
}

TEST(EvaluateFacts, stops_on_request) {
  FactRunOptions options;
  std::size_t trials = 0;
  options.progress = [&](std::size_t done, std::size_t) { trials = done; };
  options.go_on = [] { return false; };
  EXPECT_THROW(evaluate_facts(suite_of({"F8.1"}), options), std::runtime_error);
  EXPECT_LT(trials, 9500U);
}

TEST(Thinned, keeps_every_so_many_th_value_and_the_last) {
  const Study study = test::study_of(R"(
vary:
  - gripper.pressing_force: {from: 0, to: 1, count: 11}
  - friction.coefficient: [0.1, 0.2, 0.3]
  - excitation.phase: {from: 0, to: 6}
samples: {count: 32, seed: 1}
)");
  const Study thin = thinned(study, {8, 3});
  EXPECT_EQ(trial_count(thin), 5U * 3U * 4U);
  std::vector<double> forces;
  for (std::size_t i = 0; i < 5; ++i) forces.push_back(values_at(thin, i * 12)[0].number);
  EXPECT_EQ(forces, (std::vector<double>{0.0, 0.3, 0.6, 0.9, 1.0}));
  // the same samples, fewer of them
  for (std::size_t s = 0; s < 4; ++s) EXPECT_EQ(values_at(thin, s)[2].number, values_at(study, s)[2].number);
  EXPECT_EQ(trial_count(thinned(study, {1, 1})), trial_count(study));
  EXPECT_EQ(trial_count(thinned(study, {1000, 1})), 11U * 3U * 2U);
}

TEST(TrialTable, has_a_column_for_each_quantity) {
  const Study study = test::study_of(R"(
vary:
  - initial.x: [0.2, 0.21]
  - initial.x: {from: -0.001, to: 0.001, as: offset}
samples: {count: 2, seed: 1}
)");
  TrialTable table(study);
  TrialRow row;
  row.index = 3;
  row.duration = 4.0;
  row.mode = Mode::mixed;
  row.impacts = {1, 2, 3, 4};
  row.last_impact[2] = 0.7;
  table.add(row);
  const auto value = [&](const char* name) { return table.table().find(name)->front(); };
  EXPECT_EQ(value("index"), 3.0);
  EXPECT_EQ(value("sample"), 1.0);
  EXPECT_EQ(value("initial.x"), 0.21);
  EXPECT_LT(std::abs(value("initial.x_offset")), 0.001);
  EXPECT_EQ(value("aligned"), 1.0);
  EXPECT_EQ(value("duration"), 4.0);
  EXPECT_EQ(value("impact"), 0.0);
  EXPECT_EQ(value("mixed"), 1.0);
  EXPECT_EQ(value("impacts_b1"), 3.0);
  EXPECT_EQ(value("last_impact_b1"), 0.7);
  EXPECT_TRUE(std::isnan(value("last_impact_a1")));
}

// Keys of one entry change together in the thinned study too, and entries beside them keep their values.
TEST(Thinned, keeps_the_values_of_one_entry_together) {
  const Study study = test::study_of(R"(
vary:
  - {gripper.pressing_force: {from: 0, to: 1, count: 11}, initial.x: {from: 0.1, to: 0.3, count: 11}}
  - friction.coefficient: {from: 0.1, to: 0.5, count: 5}
)");
  const Study thin = thinned(study, {1, 2});
  ASSERT_EQ(trial_count(thin), 6U * 3U);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<VariedValue> found = values_at(thin, 3 * i + k), whole = values_at(study, 5 * 2 * i + 2 * k);
      for (std::size_t v = 0; v < 3; ++v) EXPECT_EQ(found[v].number, whole[v].number) << i << ' ' << k << ' ' << v;
    }
}

// Whichever stands first: a list and a range of one entry change together in the thinned study as in the whole one.
TEST(Thinned, keeps_a_list_beside_a_range_together) {
  const std::string range = "gripper.pressing_force: {from: 0, to: 1, count: 5}",
                    list = "initial.x: [0.1, 0.2, 0.3, 0.4, 0.5]";
  for (const std::string& entry : {range + ", " + list, list + ", " + range}) {
    const Study study = test::study_of("vary: [{" + entry + "}]"), thin = thinned(study, {1, 2});
    std::map<double, double> whole;
    for (std::size_t i = 0; i < trial_count(study); ++i)
      whole[values_at(study, i)[0].number] = values_at(study, i)[1].number;
    for (std::size_t i = 0; i < trial_count(thin); ++i)
      EXPECT_EQ(values_at(thin, i)[1].number, whole[values_at(thin, i)[0].number]) << entry << ", trial " << i;
  }
}

}  // namespace
}  // namespace vibratory_alignment
