#include "study/measure.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "study/formula.h"

namespace vibratory_alignment {
namespace {

constexpr double kLowQuantile = 0.05, kHighQuantile = 0.95;

/// The column that numbers the samples at each point; studies without samples have none.
constexpr char kSampleColumn[] = "sample";

/// Ends of a range take in what differs from them by roundoff.
constexpr double kRoundoff = 1e-9;

const Table& table_of(const Measure& measure, const Tables& tables) {
  const auto found = tables.find(measure.table);
  if (found == tables.end()) throw std::out_of_range("there is no table of the study " + measure.table.study);
  return found->second;
}

const std::vector<double>& column_of(const Table& table, const Measure& measure, const std::string& name) {
  const std::vector<double>* const column = table.find(name);
  if (column == nullptr) throw std::out_of_range("the study " + measure.table.study + " has no column " + name);
  return *column;
}

/// A measure whose formulas have been evaluated: what is left is to pick rows and count.
struct Prepared {
  const Measure* measure = nullptr;
  std::vector<double> value;                     ///< of Measure::of
  std::vector<bool> kept;                        ///< by Measure::where
  const std::vector<double>* along = nullptr;    ///< curves: along; region: x
  std::vector<const std::vector<double>*> each;  ///< curves: each; region: y
  std::vector<std::vector<std::size_t>> rows_of_sample;
  std::vector<Prepared> terms;
};

std::vector<std::vector<std::size_t>> rows_by_sample(const Table& table) {
  const std::vector<double>* const sample = table.find(kSampleColumn);
  std::vector<std::vector<std::size_t>> rows(1);
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const auto s = sample != nullptr ? static_cast<std::size_t>((*sample)[r]) : 0;
    if (s >= rows.size()) rows.resize(s + 1);
    rows[s].push_back(r);
  }
  return rows;
}

/// Of a formula: what is no number holds nowhere.
bool is_true(double value) { return value != 0.0 && !std::isnan(value); }

Prepared prepare(const Measure& measure, const Tables& tables) {
  Prepared prepared;
  prepared.measure = &measure;
  if (measure.kind == Measure::Kind::ratio) {
    for (const Measure& term : measure.terms) prepared.terms.push_back(prepare(term, tables));
    return prepared;
  }
  const Table& table = table_of(measure, tables);
  prepared.value = evaluate_formula(measure.of, table);
  prepared.kept.assign(table.rows(), true);
  if (!measure.where.empty()) {
    const std::vector<double> condition = evaluate_formula(measure.where, table);
    for (std::size_t r = 0; r < condition.size(); ++r) prepared.kept[r] = is_true(condition[r]);
  }
  if (measure.kind == Measure::Kind::curves) {
    prepared.along = &column_of(table, measure, measure.curves.along);
    for (const std::string& name : measure.curves.each) prepared.each.push_back(&column_of(table, measure, name));
  } else if (measure.kind == Measure::Kind::region) {
    prepared.along = &column_of(table, measure, measure.region.x);
    prepared.each = {&column_of(table, measure, measure.region.y)};
  }
  prepared.rows_of_sample = rows_by_sample(table);
  return prepared;
}

/// The rows to look at: all, or those of as many samples drawn with replacement.
std::vector<std::size_t> pick_rows(const Prepared& prepared, const std::optional<std::uint64_t>& seed) {
  std::vector<std::size_t> picked;
  const std::size_t samples = prepared.rows_of_sample.size();
  std::mt19937_64 generator(seed.value_or(0));
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t sample = seed ? static_cast<std::size_t>(generator() % samples) : k;
    for (const std::size_t row : prepared.rows_of_sample[sample])
      if (prepared.kept[row]) picked.push_back(row);
  }
  return picked;
}

Reading read_rows(const Prepared& prepared, const std::vector<std::size_t>& rows) {
  std::vector<double> values;
  double present = 0.0;
  for (const std::size_t row : rows) {
    values.push_back(prepared.value[row]);
    if (!std::isnan(values.back())) present += 1.0;
  }
  Reading reading;
  reading.coverage = prepared.value.empty() ? 0.0 : present / static_cast<double>(prepared.value.size());
  const auto count_true = [&] { return static_cast<double>(std::count_if(values.begin(), values.end(), is_true)); };
  switch (prepared.measure->rows.take) {
    case RowStatistic::share: reading.value = present > 0.0 ? count_true() / present : kNone; break;
    case RowStatistic::count: reading.value = count_true(); break;
    case RowStatistic::mean: reading.value = mean(values); break;
    case RowStatistic::median: reading.value = median(values); break;
    case RowStatistic::min: reading.value = quantile(values, 0.0); break;
    case RowStatistic::max: reading.value = quantile(values, 1.0); break;
  }
  return reading;
}

/// Values of all trials at one point.
CurvePoint point_of(double at, const std::vector<double>& values, PointStatistic statistic, double least_share) {
  CurvePoint point;
  point.at = at;
  const auto present = std::count_if(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
  point.share = static_cast<double>(present) / static_cast<double>(values.size());
  point.value = statistic == PointStatistic::median ? median(values) : mean(values);
  point.low = quantile(values, 0.25);
  point.high = quantile(values, 0.75);
  if (point.share < least_share) point.value = point.low = point.high = kNone;
  return point;
}

std::vector<Curve> make_curves(const Prepared& prepared, const std::vector<std::size_t>& rows) {
  const CurvesMeasure& asked = prepared.measure->curves;
  std::map<std::vector<double>, std::map<double, std::vector<double>>> groups;
  for (const std::size_t row : rows) {
    const double at = (*prepared.along)[row];
    if (asked.within) {
      const double slack = kRoundoff * std::max(std::abs(asked.within->first), std::abs(asked.within->second));
      if (at < asked.within->first - slack || at > asked.within->second + slack) continue;
    }
    std::vector<double> key;
    key.reserve(prepared.each.size());
    for (const std::vector<double>* column : prepared.each) key.push_back((*column)[row]);
    groups[key][at].push_back(prepared.value[row]);
  }
  std::vector<Curve> curves;
  for (const auto& [key, points] : groups) {
    Curve curve;
    curve.each = key;
    for (const auto& [at, values] : points) curve.points.push_back(point_of(at, values, asked.point, asked.share));
    curves.push_back(curve);
  }
  return curves;
}

double number_of(const CurvePoints& points, const CurvesMeasure& asked) {
  const auto present =
      std::count_if(points.begin(), points.end(), [](const CurvePoint& p) { return !std::isnan(p.value); });
  if (static_cast<double>(present) < asked.filled * static_cast<double>(points.size())) return kNone;
  switch (asked.take) {
    case CurveNumber::min: return least(points);
    case CurveNumber::max: return largest(points);
    case CurveNumber::mean: return mean(points);
    case CurveNumber::argmin: return place_of_least(points);
    case CurveNumber::argmax: return place_of_largest(points);
    case CurveNumber::spread: return spread(points);
    case CurveNumber::relative_spread: return relative_spread(points);
    case CurveNumber::at: return value_at(points, asked.at);
    case CurveNumber::r_squared: return r_squared(points);
    case CurveNumber::rank_correlation: return rank_correlation(points);
    case CurveNumber::width: break;
  }
  return width(points, asked.threshold);
}

/// NaN if one of the curves has no number: what is said of all of them must be seen of all.
double join(const std::vector<double>& numbers, CurveJoin over) {
  if (numbers.empty() || std::any_of(numbers.begin(), numbers.end(), [](double v) { return std::isnan(v); }))
    return kNone;
  switch (over) {
    case CurveJoin::min: return quantile(numbers, 0.0);
    case CurveJoin::max: return quantile(numbers, 1.0);
    case CurveJoin::mean: return mean(numbers);
    case CurveJoin::median: return median(numbers);
    case CurveJoin::spread: break;
  }
  return quantile(numbers, 1.0) - quantile(numbers, 0.0);
}

Reading read_curves(const Prepared& prepared, const std::vector<std::size_t>& rows) {
  const CurvesMeasure& asked = prepared.measure->curves;
  Reading reading;
  std::vector<double> numbers;
  double points = 0.0, covered = 0.0;
  for (const Curve& curve : make_curves(prepared, rows)) {
    const double number = number_of(curve.points, asked);
    if (asked.filled > 0.0 || !std::isnan(number)) numbers.push_back(number);
    for (const CurvePoint& point : curve.points) {
      points += 1.0;
      covered += asked.share > 0.0 ? std::min(1.0, point.share / asked.share) : 1.0;
    }
  }
  reading.value = join(numbers, asked.over);
  reading.coverage = points > 0.0 ? covered / points : 0.0;
  return reading;
}

Field make_field(const Prepared& prepared, const std::vector<std::size_t>& rows) {
  std::map<std::pair<double, double>, std::vector<double>> cells;
  Field field;
  for (const std::size_t row : rows) {
    const double x = (*prepared.along)[row], y = (*prepared.each[0])[row];
    field.x.push_back(x);
    field.y.push_back(y);
    cells[{x, y}].push_back(is_true(prepared.value[row]) ? 1.0 : 0.0);
  }
  for (std::vector<double>* axis : {&field.x, &field.y}) {
    std::sort(axis->begin(), axis->end());
    axis->erase(std::unique(axis->begin(), axis->end()), axis->end());
  }
  for (const double x : field.x) {
    for (const double y : field.y) {
      const auto cell = cells.find({x, y});
      field.values.push_back(cell == cells.end() ? kNone : mean(cell->second));
    }
  }
  return field;
}

Reading read_region(const Prepared& prepared, const std::vector<std::size_t>& rows) {
  const RegionMeasure& asked = prepared.measure->region;
  const Field field = make_field(prepared, rows);
  Reading reading;
  switch (asked.take) {
    case RegionNumber::share: reading.value = region_share(field, asked.share); break;
    case RegionNumber::largest_piece: reading.value = largest_piece(field, asked.share); break;
    case RegionNumber::open: reading.value = region_open(field, asked.share); break;
    case RegionNumber::narrowing: reading.value = region_narrowing(field, asked.share); break;
  }
  const double held = mean(field.values);
  reading.coverage = std::isnan(held) ? 0.0 : held;
  return reading;
}

Reading read(const Prepared& prepared, const std::optional<std::uint64_t>& seed) {
  Reading reading;
  if (prepared.measure->kind == Measure::Kind::ratio) {
    const Reading above = read(prepared.terms.front(), seed), below = read(prepared.terms.back(), seed);
    reading.value = below.value != 0.0 ? above.value / below.value : kNone;
    reading.coverage = std::min(above.coverage, below.coverage);
    return reading;
  }
  const std::vector<std::size_t> rows = pick_rows(prepared, seed);
  switch (prepared.measure->kind) {
    case Measure::Kind::curves: return read_curves(prepared, rows);
    case Measure::Kind::region: return read_region(prepared, rows);
    default: return read_rows(prepared, rows);
  }
}

bool is_sampled(const Prepared& prepared) {
  return prepared.rows_of_sample.size() > 1 || std::any_of(prepared.terms.begin(), prepared.terms.end(), is_sampled);
}

}  // namespace

const std::vector<std::string>& row_statistic_words() {
  static const std::vector<std::string> words = {"share", "count", "mean", "median", "min", "max"};
  return words;
}

const std::vector<std::string>& curve_number_words() {
  static const std::vector<std::string> words = {
      "min",  "max", "mean", "argmin", "argmax", "spread", "relative_spread", "at", "r_squared", "rank_correlation",
      "width"};
  return words;
}

const std::vector<std::string>& point_statistic_words() {
  static const std::vector<std::string> words = {"median", "mean"};
  return words;
}

const std::vector<std::string>& curve_join_words() {
  static const std::vector<std::string> words = {"min", "max", "mean", "median", "spread"};
  return words;
}

const std::vector<std::string>& region_number_words() {
  static const std::vector<std::string> words = {"share", "largest_piece", "open", "narrowing"};
  return words;
}

void collect_tables(const Measure& measure, std::vector<TableName>& names) {
  if (measure.kind != Measure::Kind::ratio) names.push_back(measure.table);
  for (const Measure& term : measure.terms) collect_tables(term, names);
}

Reading read_measure(const Measure& measure, const Tables& tables, int resamples) {
  const Prepared prepared = prepare(measure, tables);
  Reading reading = read(prepared, std::nullopt);
  std::vector<double> drawn;
  if (is_sampled(prepared))
    for (int i = 0; i < resamples; ++i) drawn.push_back(read(prepared, static_cast<std::uint64_t>(i) + 1).value);
  reading.low = quantile(drawn, kLowQuantile);
  reading.high = quantile(drawn, kHighQuantile);
  return reading;
}

std::vector<Curve> curves_of(const Measure& measure, const Tables& tables) {
  const Prepared prepared = prepare(measure, tables);
  return make_curves(prepared, pick_rows(prepared, std::nullopt));
}

Field field_of(const Measure& measure, const Tables& tables) {
  const Prepared prepared = prepare(measure, tables);
  return make_field(prepared, pick_rows(prepared, std::nullopt));
}

}  // namespace vibratory_alignment
