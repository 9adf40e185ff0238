// The scenes of a study's trials, read by the one loader of scenes.
//
// Most of what a trial varies are numbers. Their nodes in the tree are kept and written anew, trial after trial; the
// tree is made anew only when a value that is no number (a word, a list, null) changes. (A tree that is changed by
// set_value() for ever grows for ever: yaml-cpp frees the nodes of a tree together.)
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "model/scene.h"
#include "study/design.h"
#include "study/study.h"

namespace vibratory_alignment {

/// One for each thread; made in the thread that has the study, it shares nothing with it.
class TrialScenes {
 public:
  explicit TrialScenes(const Study& study);

  /// The scene of trial `index`. Throws SceneError when it is refused, also for an offset to what is no number.
  Scene at(std::size_t index);

 private:
  void build(const std::vector<VariedValue>& values);
  bool fits(const std::vector<VariedValue>& values) const;
  void write(const std::vector<VariedValue>& values);

  Study study_;
  std::vector<VariedKey> keys_;  ///< of all dimensions
  YAML::Node tree_;
  std::optional<std::vector<VariedValue>> built_;  ///< the values for which the tree was made
  std::vector<YAML::Node> leaves_;  ///< of each key, in the tree; those of values that are no numbers are not used
  std::vector<double> bases_;       ///< what an offset is added to unless that is varied itself
};

}  // namespace vibratory_alignment
