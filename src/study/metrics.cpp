#include "study/metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vibratory_alignment {
namespace {

const CurvePoint* least_point(const CurvePoints& points) {
  const CurvePoint* best = nullptr;
  for (const CurvePoint& point : points)
    if (!std::isnan(point.value) && (best == nullptr || point.value < best->value)) best = &point;
  return best;
}

const CurvePoint* largest_point(const CurvePoints& points) {
  const CurvePoint* best = nullptr;
  for (const CurvePoint& point : points)
    if (!std::isnan(point.value) && (best == nullptr || point.value > best->value)) best = &point;
  return best;
}

/// Ranks from 1; equal values share the mean of theirs.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) rank[order[k]] = 0.5 * static_cast<double>(i + 1 + end);
    i = end;
  }
  return rank;
}

struct Moments {
  double xx = 0.0, yy = 0.0, xy = 0.0;
};

/// Sums of squares and products about the means.
Moments moments(const std::vector<double>& x, const std::vector<double>& y) {
  const double mean_x = mean(x), mean_y = mean(y);
  Moments m;
  for (std::size_t i = 0; i < x.size(); ++i) {
    m.xx += (x[i] - mean_x) * (x[i] - mean_x);
    m.yy += (y[i] - mean_y) * (y[i] - mean_y);
    m.xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return m;
}

struct Columns {
  std::vector<double> at, value;
};

Columns columns_of(const CurvePoints& points) {
  Columns columns;
  for (const CurvePoint& point : points) {
    if (std::isnan(point.value)) continue;
    columns.at.push_back(point.at);
    columns.value.push_back(point.value);
  }
  return columns;
}

/// True for each grid point of the region.
std::vector<bool> region_of(const Field& field, double threshold) {
  std::vector<bool> inside(field.values.size());
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = field.values[i] >= threshold;
  return inside;
}

/// Number of points in the piece that holds `start`; takes them out of `inside`.
std::size_t take_piece(const Field& field, std::size_t start, std::vector<bool>& inside) {
  const std::size_t rows = field.x.size(), columns = field.y.size();
  std::vector<std::size_t> open = {start};
  inside[start] = false;
  std::size_t count = 0;
  while (!open.empty()) {
    const std::size_t at = open.back(), i = at / columns, j = at % columns;
    open.pop_back();
    ++count;
    const auto visit = [&](std::size_t next) {
      if (!inside[next]) return;
      inside[next] = false;
      open.push_back(next);
    };
    if (i > 0) visit(at - columns);
    if (i + 1 < rows) visit(at + columns);
    if (j > 0) visit(at - 1);
    if (j + 1 < columns) visit(at + 1);
  }
  return count;
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }), values.end());
  if (values.empty()) return kNone;
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(below);
  return part > 0.0 ? (1.0 - part) * values[below] + part * values[below + 1] : values[below];
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : kNone;
}

double least(const CurvePoints& points) {
  const CurvePoint* const point = least_point(points);
  return point != nullptr ? point->value : kNone;
}

double largest(const CurvePoints& points) {
  const CurvePoint* const point = largest_point(points);
  return point != nullptr ? point->value : kNone;
}

double mean(const CurvePoints& points) { return mean(columns_of(points).value); }

double place_of_least(const CurvePoints& points) {
  const CurvePoint* const point = least_point(points);
  return point != nullptr ? point->at : kNone;
}

double place_of_largest(const CurvePoints& points) {
  const CurvePoint* const point = largest_point(points);
  return point != nullptr ? point->at : kNone;
}

double spread(const CurvePoints& points) { return largest(points) - least(points); }

double relative_spread(const CurvePoints& points) { return spread(points) / mean(points); }

double value_at(const CurvePoints& points, double at) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].at == at) return points[i].value;
    if (i + 1 == points.size() || at < points[i].at || at > points[i + 1].at) continue;
    const double part = (at - points[i].at) / (points[i + 1].at - points[i].at);
    if (part < 1.0) return (1.0 - part) * points[i].value + part * points[i + 1].value;
  }
  return kNone;
}

double r_squared(const CurvePoints& points) {
  const Columns c = columns_of(points);
  if (c.at.size() < 3) return kNone;
  const Moments m = moments(c.at, c.value);
  return m.yy > 0.0 ? m.xy * m.xy / (m.xx * m.yy) : 1.0;
}

double rank_correlation(const CurvePoints& points) {
  const Columns c = columns_of(points);
  if (c.at.size() < 2) return kNone;
  const Moments m = moments(ranks(c.at), ranks(c.value));
  return m.yy > 0.0 ? m.xy / std::sqrt(m.xx * m.yy) : 0.0;
}

double width(const CurvePoints& points, double threshold) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double step = points[i + 1].at - points[i].at;
    const bool first = points[i].value >= threshold, second = points[i + 1].value >= threshold;
    if (first && second) sum += step;
    if (first == second) continue;
    const double inside = (first ? points[i] : points[i + 1]).value,
                 outside = (first ? points[i + 1] : points[i]).value;
    if (!std::isnan(outside)) sum += step * (inside - threshold) / (inside - outside);
  }
  return sum;
}

double region_share(const Field& field, double threshold) {
  const std::vector<bool> inside = region_of(field, threshold);
  if (inside.empty()) return kNone;
  return static_cast<double>(std::count(inside.begin(), inside.end(), true)) / static_cast<double>(inside.size());
}

double largest_piece(const Field& field, double threshold) {
  std::vector<bool> inside = region_of(field, threshold);
  const auto all = static_cast<double>(std::count(inside.begin(), inside.end(), true));
  std::size_t most = 0;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i]) most = std::max(most, take_piece(field, i, inside));
  return all > 0.0 ? static_cast<double>(most) / all : kNone;
}

double region_open(const Field& field, double threshold) {
  double all = 0.0, open = 0.0;
  for (std::size_t i = 0; i < field.x.size(); ++i) {
    for (std::size_t j = 0; j < field.y.size(); ++j) {
      if (!(field.at(i, j) >= threshold)) continue;
      all += 1.0;
      if (i + 1 == field.x.size() || j == 0 || j + 1 == field.y.size()) open += 1.0;
    }
  }
  return all > 0.0 ? open / all : kNone;
}

double region_narrowing(const Field& field, double threshold) {
  CurvePoints widths;
  for (std::size_t i = 0; i < field.x.size(); ++i) {
    CurvePoints line;
    for (std::size_t j = 0; j < field.y.size(); ++j) line.push_back({field.y[j], field.at(i, j), 0.0, 0.0, 1.0});
    widths.push_back({field.x[i], width(line, threshold), 0.0, 0.0, 1.0});
  }
  return rank_correlation(widths);
}

}  // namespace vibratory_alignment
