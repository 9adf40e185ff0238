// Facts files: what is read from them, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "model/scene_error.h"
#include "study/facts_file.h"

namespace vibratory_alignment {
namespace {

/// A file with this text, gone at the end.
class FactsText {
 public:
  explicit FactsText(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("facts_" + std::to_string(getpid()) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  ~FactsText() { std::filesystem::remove(path_); }
  FactsText(const FactsText&) = delete;
  FactsText& operator=(const FactsText&) = delete;

  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

FactBook load(const std::string& text) { return load_facts(FactsText(text).path()); }

/// The faults of a text, each without the name of the file.
std::vector<std::string> faults(const std::string& text) {
  try {
    load(text);
  } catch (const SceneError& error) {
    return error.faults();
  }
  return {};
}

bool holds(const std::vector<std::string>& faults, const std::string& start) {
  return std::any_of(faults.begin(), faults.end(),
                     [&](const std::string& fault) { return fault.rfind(start, 0) == 0; });
}

constexpr char kGood[] = R"(
studies: ../studies
facts:
  - id: F4.1
    says: Duration against f0 is
      close to linear.
    why: A line.
    expected: met
    measures:
      - name: R^2
        study: fig4
        where: initial.x > 0.1
        of: duration
        curves: {along: f0, each: [initial.x], within: {from: 0.1, to: 0.8}, share: 0.9, filled: 0.4, take: r_squared, over: min}
        at_least: 0.9
        scale: 0.1
      - name: ratio
        ratio:
          - {study: fig4, of: duration, curves: {along: f0, take: at, at: 0.2}}
          - {study: fig5, table: touches, of: aligned, rows: {take: share}}
        at_least: 1
        at_most: 2
        scale: 1
figures:
  - {name: fig4, title: Durations, study: fig4, of: duration, curves: {along: f0, each: initial.x}}
  - {name: fig2, title: Motion, study: fig2}
  - {name: fig8, title: Region, study: fig8, of: aligned, region: {x: f0, y: k, share: 0.95}}
)";

TEST(FactsFile, is_read_whole) {
  const FactBook book = load(kGood);
  EXPECT_EQ(book.study_folder, "../studies");
  ASSERT_EQ(book.facts.size(), 1U);
  const Fact& fact = book.facts[0];
  EXPECT_EQ(fact.id, "F4.1");
  EXPECT_EQ(fact.says, "Duration against f0 is close to linear.");
  EXPECT_TRUE(fact.expected);
  ASSERT_EQ(fact.measures.size(), 2U);
  const FactMeasure& line = fact.measures[0];
  EXPECT_EQ(line.measure.kind, Measure::Kind::curves);
  EXPECT_EQ(line.measure.table.study, "fig4");
  EXPECT_EQ(line.measure.where, "initial.x > 0.1");
  EXPECT_EQ(line.measure.curves.each, std::vector<std::string>{"initial.x"});
  EXPECT_EQ(line.measure.curves.within, std::make_pair(0.1, 0.8));
  EXPECT_EQ(line.measure.curves.take, CurveNumber::r_squared);
  EXPECT_EQ(line.measure.curves.over, CurveJoin::min);
  EXPECT_EQ(line.measure.curves.share, 0.9);
  EXPECT_EQ(line.measure.curves.filled, 0.4);
  EXPECT_EQ(line.bound.at_least, 0.9);
  EXPECT_FALSE(line.bound.at_most);
  EXPECT_EQ(line.bound.scale, 0.1);
  const Measure& ratio = fact.measures[1].measure;
  ASSERT_EQ(ratio.terms.size(), 2U);
  EXPECT_EQ(ratio.terms[0].curves.at, 0.2);
  EXPECT_TRUE(ratio.terms[1].table.touches);
  ASSERT_EQ(book.figures.size(), 3U);
  EXPECT_EQ(book.figures[0].kind, Figure::Kind::curves);
  EXPECT_EQ(book.figures[0].measure.curves.each, std::vector<std::string>{"initial.x"});
  EXPECT_EQ(book.figures[1].kind, Figure::Kind::motion);
  EXPECT_EQ(book.figures[2].measure.region.y, "k");
}

/// The good file with one piece replaced.
std::string with(const std::string& piece, const std::string& other) {
  std::string text = kGood;
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), other);
}

TEST(FactsFile, refuses_with_place_and_reason) {
  const struct {
    std::string piece, other, fault;
  } cases[] = {
      {"take: r_squared", "take: slope", "facts.0.measures.0.curves.take: slope: must be min, "},
      {"share: 0.9", "share: 1.5", "facts.0.measures.0.curves.share: 1.5: must be a number from 0 to 1"},
      {"scale: 0.1", "scale: 0", "facts.0.measures.0.scale: 0: must be a number > 0"},
      {"at_least: 0.9", "colour: red", "facts.0.measures.0.at_least: missing: there must be a bound"},
      {"at_least: 0.9", "colour: red", "facts.0.measures.0.colour: red: unknown key"},
      {"at_least: 1\n", "at_least: 3\n", "facts.0.measures.1.at_least: 3: must not be above at_most"},
      {"expected: met", "expected: perhaps", "facts.0.expected: perhaps: must be met or missed"},
      {"studies: ../studies", "", "studies: missing: must be the folder"},
      {"each: [initial.x]", "each: [[a]]", "facts.0.measures.0.curves.each: (a list): must be text or a list of texts"},
      {"why: A line.", "why: {}", "facts.0.why: (a map): must be text, of 1 to 1000 bytes"},
      {"id: F4.1", "", "facts.0.id: missing: "},
      {"take: at, at: 0.2", "take: at", "facts.0.measures.1.ratio.0.curves.at: missing: must be a number"},
      {"take: r_squared", "take: min, at: 1", "facts.0.measures.0.curves.at: 1: means something with"},
      {"from: 0.1, to: 0.8", "from: 1, to: 0", "facts.0.measures.0.curves.within.from: 1: must not be above"},
      {"table: touches", "table: chairs", "facts.0.measures.1.ratio.1.table: chairs: must be trials or touches"},
      {"rows: {take: share}", "rows: {}", "facts.0.measures.1.ratio.1.rows.take: missing: must be share"},
      {"rows: {take: share}", "x: 1", "facts.0.measures.1.ratio.1.region: missing: there must be one of rows, curves"},
      {"{along: f0, each: initial.x}", "{along: f0}, region: {}", "figures.0.region: (a map): there must be one"},
      {"  - {name: fig2, title: Motion, study: fig2}", "  - {name: fig2, title: Motion}", "figures.1.study: missing"},
  };
  for (const auto& c : cases) EXPECT_TRUE(holds(faults(with(c.piece, c.other)), c.fault)) << c.fault;
}

TEST(FactsFile, tells_every_fault_at_once) {
  EXPECT_EQ(faults(with("take: r_squared", "take: slope, point: mode, at: 2")).size(), 3U);
}

TEST(FactsFile, refuses_the_same_name_twice) {
  const std::string fact = std::string(kGood).substr(0, std::string(kGood).find("figures:"));
  EXPECT_TRUE(holds(faults(fact + fact.substr(fact.find("  - id"))), "facts.1.id: F4.1: is the name of two facts"));
}

TEST(FactsFile, has_formulas_and_columns_that_are_checked) {
  Tables tables;
  tables[{"fig4", false}] = {{"f0", "initial.x", "duration"}, {{}, {}, {}}};
  tables[{"fig5", true}] = {{"aligned"}, {{}}};
  tables[{"fig8", false}] = {{"f0", "k", "aligned"}, {{}, {}, {}}};
  EXPECT_TRUE(faults_of_formulas(load(kGood), tables).empty());
  tables[{"fig4", false}].names = {"f0", "x", "durations"};
  tables.erase({"fig8", false});
  const std::vector<std::string> found = faults_of_formulas(load(kGood), tables);
  EXPECT_TRUE(holds(found, "F4.1: R^2: of: duration: "));
  EXPECT_TRUE(holds(found, "F4.1: R^2: where: initial.x > 0.1: "));
  EXPECT_TRUE(holds(found, "F4.1: R^2: each: initial.x: the study fig4 has no such column"));
  EXPECT_TRUE(holds(found, "fig8: study: fig8: there is no such study"));
}

}  // namespace
}  // namespace vibratory_alignment
