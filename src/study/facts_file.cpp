#include "study/facts_file.h"

#include <algorithm>
#include <set>

#include "model/scene_error.h"
#include "model/tree_reader.h"
#include "model/yaml_file.h"
#include "study/formula.h"

namespace vibratory_alignment {
namespace {

const std::vector<std::string> table_words = {"trials", "touches"};
const std::vector<std::string> expected_words = {"met", "missed"};

const NumberRule share_rule = {"a number from 0 to 1", 0.0, 1.0, true, false};

/// A required word of an enumeration.
template <class Word>
void read_word(TreeReader& reader, const char* key, const std::vector<std::string>& words, Word& word) {
  if (!reader.has(key)) reader.fault(key, "must be " + alternatives(words));
  word = static_cast<Word>(reader.choice(key, words).value_or(0));
}

std::string required_text(TreeReader& reader, const char* key, const char* what) {
  if (!reader.has(key)) reader.fault(key, what);
  return reader.text(key).value_or("");
}

void read_curves(TreeReader reader, bool figure, CurvesMeasure& curves) {
  curves.along = required_text(reader, "along", "must be the name of a column");
  curves.each = reader.texts("each");
  TreeReader within = reader.section("within");
  if (reader.has("within")) {
    const double from = within.required_number("from", any_number), to = within.required_number("to", any_number);
    if (from > to) within.fault("from", "must not be above `to`");
    curves.within = {from, to};
    within.refuse_unknown_keys();
  }
  if (reader.has("point")) read_word(reader, "point", point_statistic_words(), curves.point);
  curves.share = reader.number("share", share_rule).value_or(curves.share);
  if (figure) {
    reader.refuse_unknown_keys();
    return;
  }
  curves.filled = reader.number("filled", share_rule).value_or(curves.filled);
  read_word(reader, "take", curve_number_words(), curves.take);
  if (curves.take == CurveNumber::at)
    curves.at = reader.required_number("at", any_number);
  else
    reader.refuse("at", "means something with `take: at` only");
  if (curves.take == CurveNumber::width)
    curves.threshold = reader.required_number("threshold", any_number);
  else
    reader.refuse("threshold", "means something with `take: width` only");
  if (reader.has("over")) read_word(reader, "over", curve_join_words(), curves.over);
  reader.refuse_unknown_keys();
}

void read_region(TreeReader reader, bool figure, RegionMeasure& region) {
  region.x = required_text(reader, "x", "must be the name of a column");
  region.y = required_text(reader, "y", "must be the name of a column");
  region.share = reader.number("share", share_rule).value_or(region.share);
  if (!figure) read_word(reader, "take", region_number_words(), region.take);
  reader.refuse_unknown_keys();
}

/// The keys of a measure, without those of what holds it.
Measure read_measure_keys(TreeReader& reader, bool may_be_ratio) {
  Measure measure;
  const bool ratio = may_be_ratio && reader.has("ratio");
  if (ratio) {
    measure.kind = Measure::Kind::ratio;
    for (const char* key : {"study", "table", "where", "of", "rows", "curves", "region"})
      reader.refuse(key, "stands in the two measures of the ratio");
    std::vector<TreeReader> terms = reader.sections("ratio");
    if (terms.size() != 2) reader.fault("ratio", "must be a list of two measures");
    for (TreeReader& term : terms) {
      measure.terms.push_back(read_measure_keys(term, false));
      term.refuse_unknown_keys();
    }
    return measure;
  }
  measure.table.study = required_text(reader, "study", "must be the name of a study");
  measure.table.touches = reader.choice("table", table_words).value_or(0) == 1;
  measure.where = reader.text("where").value_or("");
  measure.of = required_text(reader, "of", "must be a formula");
  const bool rows = reader.has("rows"), curves = reader.has("curves"), region = reader.has("region");
  if (static_cast<int>(rows) + static_cast<int>(curves) + static_cast<int>(region) != 1) {
    reader.fault(
        rows     ? "rows"
        : curves ? "curves"
                 : "region",
        std::string("there must be one of rows, curves") + (may_be_ratio ? ", region or ratio" : " or region"));
    return measure;
  }
  if (rows) {
    TreeReader section = reader.section("rows");
    read_word(section, "take", row_statistic_words(), measure.rows.take);
    section.refuse_unknown_keys();
  } else if (curves) {
    measure.kind = Measure::Kind::curves;
    read_curves(reader.section("curves"), false, measure.curves);
  } else {
    measure.kind = Measure::Kind::region;
    read_region(reader.section("region"), false, measure.region);
  }
  return measure;
}

FactMeasure read_fact_measure(TreeReader reader) {
  FactMeasure result;
  result.name = required_text(reader, "name", "must say what is measured");
  result.measure = read_measure_keys(reader, true);
  result.bound.at_least = reader.number("at_least", any_number);
  result.bound.at_most = reader.number("at_most", any_number);
  if (!reader.has("at_least") && !reader.has("at_most"))
    reader.fault("at_least", "there must be a bound: at_least, at_most or both");
  if (result.bound.at_least && result.bound.at_most && *result.bound.at_least > *result.bound.at_most)
    reader.fault("at_least", "must not be above at_most");
  result.bound.scale = reader.required_number("scale", positive_number);
  reader.refuse_unknown_keys();
  return result;
}

Fact read_fact(TreeReader reader) {
  Fact fact;
  fact.id = required_text(reader, "id", "must be the short name of the fact");
  fact.says = required_text(reader, "says", "must be the fact in words");
  fact.why = required_text(reader, "why", "must say why these measures are what the words mean");
  if (!reader.has("expected")) reader.fault("expected", "must be " + alternatives(expected_words));
  fact.expected = reader.choice("expected", expected_words).value_or(0) == 0;
  if (!reader.has("measures")) reader.fault("measures", "must be a list of measures");
  for (TreeReader& measure : reader.sections("measures")) fact.measures.push_back(read_fact_measure(measure));
  reader.refuse_unknown_keys();
  return fact;
}

Figure read_figure(TreeReader reader) {
  Figure figure;
  figure.name = required_text(reader, "name", "must be the name of the figure");
  figure.title = required_text(reader, "title", "must be the title of the figure");
  figure.measure.table.study = required_text(reader, "study", "must be the name of a study");
  if (reader.has("curves") && reader.has("region")) reader.fault("region", "there must be one of curves and region");
  if (reader.has("with_tilt_rate")) figure.with_tilt_rate = reader.flag("with_tilt_rate").value_or(false);
  if (reader.has("curves") || reader.has("region")) {
    figure.measure.where = reader.text("where").value_or("");
    figure.measure.of = required_text(reader, "of", "must be a formula");
  }
  if (reader.has("curves")) {
    figure.kind = Figure::Kind::curves;
    figure.mark = reader.text("mark").value_or("");
    figure.measure.kind = Measure::Kind::curves;
    read_curves(reader.section("curves"), true, figure.measure.curves);
  } else if (reader.has("region")) {
    figure.kind = Figure::Kind::region;
    figure.measure.kind = Measure::Kind::region;
    read_region(reader.section("region"), true, figure.measure.region);
  }
  reader.refuse_unknown_keys();
  return figure;
}

/// Every column that the measure names, and its formulas, against the columns there are.
void check_measure(const Measure& measure, const Tables& tables, const std::string& place,
                   std::vector<std::string>& faults) {
  for (const Measure& term : measure.terms) check_measure(term, tables, place, faults);
  if (measure.kind == Measure::Kind::ratio) return;
  const auto found = tables.find(measure.table);
  if (found == tables.end()) {
    faults.push_back(place + ": study: " + measure.table.study + ": there is no such study");
    return;
  }
  const Table& table = found->second;
  const auto check_formula = [&](const char* key, const std::string& formula) {
    if (formula.empty()) return;
    try {
      evaluate_formula(formula, table);
    } catch (const FormulaError& error) {
      faults.push_back(place + ": " + key + ": " + error.what());
    }
  };
  const auto check_column = [&](const char* key, const std::string& name) {
    if (table.find(name) == nullptr)
      faults.push_back(place + ": " + key + ": " + name + ": the study " + measure.table.study + " has no such column");
  };
  check_formula("of", measure.of);
  check_formula("where", measure.where);
  if (measure.kind == Measure::Kind::curves) {
    check_column("along", measure.curves.along);
    for (const std::string& name : measure.curves.each) check_column("each", name);
  } else if (measure.kind == Measure::Kind::region) {
    check_column("x", measure.region.x);
    check_column("y", measure.region.y);
  }
}

}  // namespace

FactBook load_facts(const std::string& path) {
  TreeReader::Faults faults;
  TreeReader reader(read_yaml_file(path), "", faults);
  FactBook book;
  book.source = path;
  book.study_folder = required_text(reader, "studies", "must be the folder of the studies, relative to this file");
  if (!reader.has("facts")) reader.fault("facts", "must be a list of facts");
  std::set<std::string> ids;
  for (TreeReader& fact : reader.sections("facts")) {
    book.facts.push_back(read_fact(fact));
    if (!ids.insert(book.facts.back().id).second) fact.fault("id", "is the name of two facts");
  }
  if (reader.has("figures"))
    for (TreeReader& figure : reader.sections("figures")) book.figures.push_back(read_figure(figure));
  reader.refuse_unknown_keys();
  if (!faults.empty()) throw SceneError(path, faults);
  return book;
}

std::vector<std::string> faults_of_formulas(const FactBook& book, const Tables& empty_tables) {
  std::vector<std::string> faults;
  for (const Fact& fact : book.facts)
    for (const FactMeasure& measure : fact.measures)
      check_measure(measure.measure, empty_tables, fact.id + ": " + measure.name, faults);
  for (const Figure& figure : book.figures) {
    if (figure.kind == Figure::Kind::motion) continue;
    check_measure(figure.measure, empty_tables, figure.name, faults);
    if (!figure.mark.empty()) check_measure(marks_of(figure), empty_tables, figure.name + ": mark", faults);
  }
  return faults;
}

}  // namespace vibratory_alignment
