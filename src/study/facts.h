// Facts that studies are to show: what is said, how it is measured, what the measure must be. Read from a facts file
// (facts_file.h); judged on the tables of the studies that they name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/measure.h"

namespace vibratory_alignment {

/// What a measure must be. At least one end is set.
struct Bound {
  std::optional<double> at_least, at_most;
  double scale = 1.0;  ///< a miss by this much counts 1
};

struct FactMeasure {
  std::string name;
  Measure measure;
  Bound bound;
};

/// Met when all of its measures are.
struct Fact {
  std::string id;
  std::string says;       ///< in words
  std::string why;        ///< why these measures are what the words mean
  bool expected = false;  ///< to be met: a check fails when it is not
  std::vector<FactMeasure> measures;
};

/// A picture of a study: the motion of its only trial, curves, or a region of reliable points.
struct Figure {
  enum class Kind { motion, curves, region };
  std::string name, title;
  Kind kind = Kind::motion;
  Measure measure;              ///< what is drawn; of a motion only the study counts
  bool with_tilt_rate = false;  ///< motions: the rate of the tilt has a panel too
  std::string mark;  ///< curves: condition on trials; points at which it holds often enough are marked; may be empty
};

struct FactBook {
  std::string source;        ///< file that it was read from, for messages
  std::string study_folder;  ///< where the studies are, relative to the file
  std::vector<Fact> facts;
  std::vector<Figure> figures;
};

struct MeasureResult {
  std::string name;
  Bound bound;
  Reading reading;
  bool met = false;
  double shortfall = 0.0;
};

struct FactResult {
  std::string id;
  std::vector<MeasureResult> measures;  ///< in the order of Fact::measures
  bool met = false;
  double shortfall = 0.0;  ///< mean of those of its measures
};

/// How far a reading is from its bound: 0 when met, else its distance over Bound::scale up to 1, then 2 - 1/distance
/// (so that one measure far off does not outweigh all others), always < 2. Where there is nothing to read: from 2 (all
/// but there) to 3 (nothing there). Continuous in the value.
double shortfall(const Reading& reading, const Bound& bound);

/// The curves of the shares of trials for which the mark of a figure holds, point by point those of its measure.
Measure marks_of(const Figure& figure);

/// Tables that the facts need, each once, sorted; with those of the figures.
std::vector<TableName> tables_of(const FactBook& book);

/// `resamples` as of read_measure. Throws like it, with the fact named.
FactResult judge(const Fact& fact, const Tables& tables, int resamples = 0);

}  // namespace vibratory_alignment
