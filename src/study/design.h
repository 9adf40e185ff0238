// Which values a trial of a study has: a function of its index alone, so that trials can be run in any order, in shards
// and again.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "study/study.h"

namespace vibratory_alignment {

/// The value of a varied key in one trial; of an offset, what is added.
struct VariedValue {
  std::string text;     ///< YAML on one line
  double number = 0.0;  ///< what the text says; not a number for words, lists, maps and null
};

/// Most trials that a study may have.
constexpr std::size_t kMostTrials = 1'000'000'000'000'000;

/// Points of the grid times samples. At most kMostTrials.
std::size_t trial_count(const Study& study);

/// Names of the varied keys in the order of the file: the key path; for an offset "key.path offset".
std::vector<std::string> varied_names(const Study& study);

/// The values of trial `index` < trial_count(study), in the order of varied_names().
std::vector<VariedValue> values_at(const Study& study, std::size_t index);

/// Coordinates of sample `index`, in [0, 1). sobol: the sequence of Sobol with the direction numbers of Joe and Kuo
/// (2008), its point 0 included, after a digital shift that the seed gives: the first 2^m samples hit each of 2^m equal
/// parts of every coordinate once. random: independent numbers. A sample does not depend on how many there are, nor a
/// coordinate of `random` on the others.
std::vector<double> unit_sample(SampleMethod method, std::uint64_t seed, std::size_t dimension, std::size_t index);

}  // namespace vibratory_alignment
