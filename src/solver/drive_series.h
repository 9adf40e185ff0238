// Power series of the forces and the moment of the excitations, which can be made longer.
#pragma once

#include <array>

#include "mechanics/drive.h"
#include "model/scene.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// Forces of the excitations as sums over the drives, per axis. Of the forms only the first `count` are made and
/// copied: room for more costs nothing.
struct DriveForms {
  static constexpr int kMax = kMostExcitations;
  std::array<Direction, kMax> direction{};
  union {
    std::array<DriveForm, kMax> form;
  };
  int count = 0;

  DriveForms() {}
  DriveForms(const DriveForms& other) : direction(other.direction), count(other.count) { copy_forms(other); }
  DriveForms& operator=(const DriveForms& other) {
    direction = other.direction;
    count = other.count;
    copy_forms(other);
    return *this;
  }

 private:
  void copy_forms(const DriveForms& other) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) form[i] = other.form[i];
  }
};

class DriveSeries {
 public:
  /// The drives of a segment from its start on; they have to outlive it. Nothing is made yet.
  void begin(const DriveForms& drives);

  /// Makes drive_x, drive_y and drive_phi of the segment to this power. What is known of them is left as it is.
  void extend(int order, Segment& segment);

 private:
  /// s(t) = amplitude sin, c(t) = amplitude cos of a drive's phase: their next powers, and the last ones.
  struct Wave {
    double s = 0.0, c = 0.0, s_before = 0.0, c_before = 0.0;
  };

  void extend_drive(std::size_t drive, int order, Series& series);

  const DriveForms* drives_ = nullptr;
  int known_ = -1;  ///< highest power made
  std::array<Wave, DriveForms::kMax> next_;
};

}  // namespace vibratory_alignment
