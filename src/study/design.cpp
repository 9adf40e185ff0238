#include "study/design.h"

#include <boost/random/sobol.hpp>
#include <cmath>
#include <limits>

#include "model/number_text.h"
#include "model/tree_reader.h"
#include "study/scramble.h"

namespace vibratory_alignment {
namespace {

/// At `part` of the way, 0 at `from`.
double in_range(const VariedKey& key, double part) {
  if (key.logarithmic) return key.from * std::pow(key.to / key.from, part);
  return key.from + part * (key.to - key.from);
}

/// Value `i` of `count`.
VariedValue listed_value(const VariedKey& key, std::size_t i, std::size_t count) {
  if (!key.values.empty())
    return {key.values[i], parse_number(key.values[i]).value_or(std::numeric_limits<double>::quiet_NaN())};
  double number = i == 0 ? key.from : key.to;
  if (i > 0 && i + 1 < count)
    number = rounded(in_range(key, static_cast<double>(i) / static_cast<double>(count - 1)), 15);
  return {number_text(number), number};
}

VariedValue sampled_value(const VariedKey& key, double part) {
  const double number = in_range(key, part);
  return {number_text(number), number};
}

std::size_t sampled_dimensions(const Study& study) {
  std::size_t count = 0;
  for (const Dimension& dimension : study.dimensions) count += dimension.sampled() ? 1 : 0;
  return count;
}

}  // namespace

std::size_t trial_count(const Study& study) {
  std::size_t count = study.samples ? study.samples->count : 1;
  for (const Dimension& dimension : study.dimensions)
    if (!dimension.sampled()) count *= dimension.count;
  return count;
}

std::vector<std::string> varied_names(const Study& study) {
  std::vector<std::string> names;
  for (const Dimension& dimension : study.dimensions)
    for (const VariedKey& key : dimension.keys) names.push_back(key.key_path + (key.offset ? " offset" : ""));
  return names;
}

std::vector<VariedValue> values_at(const Study& study, std::size_t index) {
  std::vector<double> sample;
  std::size_t point = index;
  if (study.samples) {
    sample = unit_sample(study.samples->method, study.samples->seed, sampled_dimensions(study),
                         index % study.samples->count);
    point = index / study.samples->count;
  }
  // the last dimension changes fastest: positions from the back, values from the front
  std::vector<std::size_t> positions(study.dimensions.size(), 0);
  for (std::size_t d = positions.size(); d-- > 0;) {
    const Dimension& dimension = study.dimensions[d];
    if (dimension.sampled()) continue;
    positions[d] = point % dimension.count;
    point /= dimension.count;
  }
  std::vector<VariedValue> values;
  std::size_t coordinate = 0;
  for (std::size_t d = 0; d < positions.size(); ++d) {
    const Dimension& dimension = study.dimensions[d];
    for (const VariedKey& key : dimension.keys)
      values.push_back(dimension.sampled() ? sampled_value(key, sample[coordinate])
                                           : listed_value(key, positions[d], dimension.count));
    if (dimension.sampled()) ++coordinate;
  }
  return values;
}

std::vector<double> unit_sample(SampleMethod method, std::uint64_t seed, std::size_t dimension, std::size_t index) {
  // the bits of a seed's coordinate, and from them those of an index
  const auto coordinate_bits = [&](std::size_t i) {
    return scrambled(scrambled(seed + kSplitmixStride) + (i + 1) * kSplitmixStride);
  };
  std::vector<double> sample(dimension);
  if (method == SampleMethod::random) {
    for (std::size_t i = 0; i < dimension; ++i)
      sample[i] = unit_number(scrambled(coordinate_bits(i) + (index + 1) * kSplitmixStride));
    return sample;
  }
  boost::random::sobol engine(dimension);
  // the engine leaves out point 0, all of whose coordinates are 0
  if (index > 0) engine.seed(index - 1);
  for (std::size_t i = 0; i < dimension; ++i) {
    const std::uint64_t bits = index > 0 ? engine() : 0;
    sample[i] = unit_number(bits ^ coordinate_bits(i));
  }
  return sample;
}

}  // namespace vibratory_alignment
