#include "study/facts.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "study/formula.h"

namespace vibratory_alignment {

double shortfall(const Reading& reading, const Bound& bound) {
  if (std::isnan(reading.value)) return 3.0 - std::clamp(reading.coverage, 0.0, 1.0);
  double miss = 0.0;
  if (bound.at_least) miss = std::max(miss, *bound.at_least - reading.value);
  if (bound.at_most) miss = std::max(miss, reading.value - *bound.at_most);
  const double scaled = miss / bound.scale;
  return scaled <= 1.0 ? scaled : 2.0 - 1.0 / scaled;
}

Measure marks_of(const Figure& figure) {
  Measure marks = figure.measure;
  // 0 also where the mark is none, which alone is not equal to itself
  marks.of = "((" + figure.mark + ") == (" + figure.mark + ")) && ((" + figure.mark + ") != 0)";
  marks.curves.point = PointStatistic::mean;
  marks.curves.share = 0.0;
  return marks;
}

std::vector<TableName> tables_of(const FactBook& book) {
  std::vector<TableName> names;
  for (const Fact& fact : book.facts)
    for (const FactMeasure& measure : fact.measures) collect_tables(measure.measure, names);
  for (const Figure& figure : book.figures)
    if (figure.kind != Figure::Kind::motion) collect_tables(figure.measure, names);
  const auto same = [](const TableName& a, const TableName& b) { return !(a < b) && !(b < a); };
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end(), same), names.end());
  return names;
}

FactResult judge(const Fact& fact, const Tables& tables, int resamples) {
  FactResult result;
  result.id = fact.id;
  result.met = true;
  for (const FactMeasure& asked : fact.measures) {
    MeasureResult measured;
    measured.name = asked.name;
    measured.bound = asked.bound;
    try {
      measured.reading = read_measure(asked.measure, tables, resamples);
    } catch (const FormulaError& error) {
      throw FormulaError("fact " + fact.id + ": " + error.what());
    } catch (const std::out_of_range& error) {
      throw std::out_of_range("fact " + fact.id + ": " + error.what());
    }
    measured.shortfall = shortfall(measured.reading, asked.bound);
    measured.met = measured.shortfall == 0.0;
    result.met = result.met && measured.met;
    result.shortfall += measured.shortfall / static_cast<double>(fact.measures.size());
    result.measures.push_back(measured);
  }
  return result;
}

}  // namespace vibratory_alignment
