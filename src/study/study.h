// A study: trials of one scene in which some values are varied. Read from a file by study_file.h; design.h gives the
// values of each trial; run by sweep.h.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/setting.h"

namespace vibratory_alignment {

/// The values of one key of the scene: those of a list, or a range.
struct VariedKey {
  std::string key_path;             ///< as `--set` of `align trial` has it
  bool offset = false;              ///< added to the number that the trial has there otherwise
  std::vector<std::string> values;  ///< YAML, each on one line; empty: a range
  double from = 0.0, to = 0.0;      ///< of the range
  bool logarithmic = false;         ///< equal ratios instead of equal differences
};

/// Keys that change together.
struct Dimension {
  std::vector<VariedKey> keys;
  std::size_t count = 0;  ///< of values; 0: sampled from the ranges

  bool sampled() const { return count == 0; }
};

/// Words for how values are spread over a range: evenly, or evenly in their logarithm.
inline const std::vector<std::string> spacing_words = {"linear", "log"};

// In study_file.cpp the words for these stand in the same order.
enum class SampleMethod { sobol, random };

struct Samples {
  SampleMethod method = SampleMethod::sobol;
  std::size_t count = 1;  ///< at every point of the grid, the same ones
  std::uint64_t seed = 0;
};

/// Plain data. Copies share the tree of the scene, which yaml-cpp lets one thread at a time read.
struct Study {
  std::string name;
  std::string source;                       ///< file that it was read from, for messages
  std::string scene_source;                 ///< file of the scene
  std::shared_ptr<const YAML::Node> scene;  ///< tree of the scene, with what the study sets for every trial
  std::vector<ValueOrigin> origins;         ///< of the values in it that are not from the scene's file
  std::vector<Dimension> dimensions;        ///< the first changes slowest; samples change fastest
  std::optional<Samples> samples;           ///< set if and only if a dimension is sampled
};

}  // namespace vibratory_alignment
