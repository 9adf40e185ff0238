// The motion at regular instants n * interval, for CSV, bags and the node's topics. Sampling never changes the motion:
// samples are read off the segments. What happens between two samples is kept as peak and impulse.
#pragma once

#include <array>
#include <functional>
#include <limits>

#include "mechanics/contact.h"
#include "mechanics/state.h"
#include "mechanics/system.h"
#include "trial/outcome.h"
#include "trial/simulation.h"

namespace vibratory_alignment {

/// One contact at the instant of a sample. World (slot) axes x right, y up.
struct ContactSample {
  ContactState state;
  double depth = 0.0;                       ///< d, 0 outside
  double normal_force = 0.0;                ///< N >= 0
  double tangential_force = 0.0;            ///< T along t = n turned by -90 degrees
  double normal_x = 0.0, normal_y = 1.0;    ///< n, the direction in which the base pushes the part
  double point_x = 0.0, point_y = 0.0;      ///< contact point
  double force_x = 0.0, force_y = 0.0;      ///< N n + T t, force on the part
  double peak_normal_force = 0.0;           ///< largest N since the previous sample
  double impulse_x = 0.0, impulse_y = 0.0;  ///< integral of the force since the previous sample
  double normal_impulse = 0.0;              ///< integral of N since the previous sample
};

struct Sample {
  double time = 0.0;
  bool is_event = false;  ///< an event instant between the regular ones (only on request)
  bool is_last = false;   ///< the trial ends here
  State state;
  std::array<ContactSample, kSiteCount> contacts;
  std::array<long, kSpotCount> impacts{};
  Mode mode = Mode::none;
  double misalignment = 0.0;  ///< |x|
  double progress = 0.0;      ///< 0 at the start, 1 when the part has reached the clearance of the slot, from |x|
};

/// Raises the largest N of each spot to that of the sample.
void raise_peaks(const Sample& sample, std::array<double, kSpotCount>& peak_force);

/// Samples in a period of the fastest excitation, where nobody says how far apart they are to be.
constexpr double kUsualSamplesPerPeriod = 20.0;

/// A run of more samples than these is nothing that can be waited for or stored: those who ask for it are refused.
constexpr double kMostSamples = 1e9;

class Sampler {
 public:
  static constexpr long kSegmentsUnasked = 1000;

  /// `interval` > 0. `with_events`: also a sample at every event instant.
  Sampler(Simulation& simulation, double interval, bool with_events = false);

  /// The next sample: t = 0 first, then n * interval, at last the end of the trial. False when there is none left, or
  /// when `go_on`, asked every kSegmentsUnasked segments, said no, or when there is none up to the instant `latest`,
  /// and the motion is computed as far: then finished() is false, and the next call goes on.
  bool next(Sample& sample, const std::function<bool()>& go_on = {},
            double latest = std::numeric_limits<double>::infinity());

  /// There is no sample left.
  bool finished() const { return finished_; }

  /// Time of the last regular sample that next() gave; changes made through Simulation::cut() belong here.
  double time() const { return time_; }

 private:
  void integrate_to(double local_time);
  void read(double time, double local_time, Sample& sample);
  void count_impacts(Sample& sample) const;

  Simulation& simulation_;
  const System& system_;  ///< of the simulation
  double interval_;
  bool with_events_;
  bool started_ = false, finished_ = false;
  long index_ = 0;
  double time_ = 0.0;
  double last_ = -1.0;          ///< time of the last sample at the end of a segment
  double integrated_to_ = 0.0;  ///< local time in the current segment up to which peaks and impulses are booked
  std::array<ContactSample, kSiteCount> pending_;
};

}  // namespace vibratory_alignment
