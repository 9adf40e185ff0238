// Power series of the forces and the moment of the excitations, which can be made longer.
#pragma once

#include <array>
#include <cmath>

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

/// Forces and moment at time t after the forms' start.
Load3 load_at(const DriveForms& drives, double t);

class DriveSeries {
 public:
  /// The drives of a segment from its start on; they have to outlive it. Nothing is made yet.
  void begin(const DriveForms& drives);

  /// Makes drive_x, drive_y and drive_phi of the segment to this power. What is known of them is left as it is; the
  /// places beyond, up to the next multiple of four, are of no meaning.
  void extend(int order, Segment& segment);

 private:
  /// Of a sine nu^k/k!, which is kept from segment to segment. Of a chirp its terms, amplitude sin of the phase, as far
  /// as they are known; the next ones and the last of sine and cosine.
  struct Wave {
    double frequency = NAN;  ///< of a sine
    Series terms{};
    double s = 0.0, c = 0.0, s_before = 0.0, c_before = 0.0;
  };

  static void set_powers(double frequency, Wave& wave);
  void extend_chirp(const DriveForm& form, int order, Wave& wave) const;
  void put(const DriveForm& form, const Wave& wave, bool first, int from, int order, Series& series) const;

  const DriveForms* drives_ = nullptr;
  int known_ = -1;  ///< highest power made
  std::array<Wave, DriveForms::kMax> waves_;
};

}  // namespace vibratory_alignment
