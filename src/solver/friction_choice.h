// Which contacts stick, which slide and how: the decision at an instant where sliding velocities are zero
// (docs/hybrid_step.md "Friction").
//
// A choice of stick, plus or minus for each of these contacts fixes the motion, as a power series. It is consistent
// when every guard of the choice (V = 0, f N - T and f N + T of what sticks; V in its direction of what slides) starts
// with a coefficient of the right sign, whatever its order: coefficients that are only rounding count as zeros. The
// motion exists and is unique, so the first consistent choice is taken.
#pragma once

#include "solver/contact_mode.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {

struct SeriesNoise;
using SiteFlags = std::array<bool, kSiteCount>;

class FrictionChoice {
 public:
  /// `tolerance`: truncation error of the steps after which decisions are due.
  FrictionChoice(const System& system, double tolerance);

  /// Decides slip of the loaded contacts marked `at_rest` (V = 0) in `state`; the others keep theirs. The mode's pins
  /// hold the zeros of f N -+ T that events have just brought about; on return those of V and f N -+ T of all it
  /// decides. `unmoved`: the state is still that from whose series these events are, so that a limit may be
  /// reached by them although the forces in the state are not near it.
  void decide(const State& state, const DriveForms& drives, const SiteFlags& at_rest, ContactMode& mode,
              bool unmoved = false);

 private:
  /// How far a choice is from being consistent: the order in time of its first contradiction, and its size beside
  /// rounding. Holds the zeros of its guards.
  struct Judgement {
    static constexpr int kNone = 1000;
    int order = kNone;
    double excess = 0.0;
    bool limits_kept = true;  ///< whatever contradicts it is a V' of sticking contacts that no T holds
    ContactMode mode;

    bool consistent() const { return order == kNone; }
    bool better_than(const Judgement& other) const {
      return order != other.order ? order > other.order : excess < other.excess;
    }
    void contradict(int at_order, double size);
  };

  /// How far a friction force may be from a limit that an event says it has reached, relative to the limit.
  double limit_error() const { return unmoved_ ? 1.0 : limit_tolerance_; }
  bool has_event(std::size_t site) const;
  bool decide_alone(const State& state, const DriveForms& drives, std::size_t site, ContactMode& mode);
  void judge(const State& state, const DriveForms& drives, double allowance, Judgement& judgement);
  void judge_sliding(int loaded, const SeriesNoise& noise, Judgement& judgement) const;
  void judge_sticking(int loaded, const SeriesNoise& noise, double allowance, double force_noise,
                      Judgement& judgement) const;

  const System& system_;
  double limit_tolerance_;  ///< relative error of a friction force that an event says is at its limit
  MotionSeries series_;
  Segment probe_;
  SiteFlags decided_{};
  Pins known_{};          ///< zeros that events have just put there
  bool unmoved_ = false;  ///< and the state is as it was before
};

}  // namespace vibratory_alignment
