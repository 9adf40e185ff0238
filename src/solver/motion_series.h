// Power series of the motion: the Taylor coefficients of the state and of all contact forces, order by order, from the
// recurrences of docs/hybrid_step.md "Contact". With the contacts' laws fixed (slipping one way, sticking, without
// force) the motion is analytic, so the series is both the integrator and its dense output.
#pragma once

#include "mechanics/contact_frame.h"
#include "mechanics/drive.h"
#include "mechanics/friction.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// Forces of the excitations as sums over the drives, per axis.
struct DriveForms {
  static constexpr int kMax = 16;
  std::array<Direction, kMax> direction{};
  std::array<DriveForm, kMax> form{};
  int count = 0;
};

class MotionSeries {
 public:
  explicit MotionSeries(const System& system) : system_(system) {}

  /// Fills segment.x ... drive_phi for free motion from `start` (contact forces zero).
  void expand_free(const State& start, const DriveForms& drives, int order, Segment& segment);

  /// Fills the segment with its loaded contacts (segment.contacts) from `start`. Sticking contacts have V = 0 exactly.
  void expand_contact(const State& start, const DriveForms& drives, int order, Segment& segment);

  /// Contacts that stick now but cannot go on doing so together: one of `candidates` has to slide from the segment's
  /// start, in its direction. Empty when there is no such conflict.
  struct Conflict {
    int count = 0;
    std::array<Event, kSiteCount> candidates{};
  };
  const Conflict& conflict() const { return conflict_; }

  /// Coordinates of a site's point (body coordinates of an edge, position of a corner), made on the first call.
  const PairSeries& point(Site site, Segment& segment);

  /// (cos phi, sin phi), made on the first call.
  const PairSeries& direction(Segment& segment);

  /// k d + h d' of a contact on `face` with depth series d, to power order - 1 (trigonometric series must be known:
  /// call point() first).
  void push_series(const Segment& segment, Face face, const Series& depth, Series& push) const;

 private:
  struct Directions {  ///< force (x, y) and moment per unit of N (sliding friction included) and per unit of T
    PairSeries n, t;
    Series nm{}, tm{};
  };
  struct Contact {
    Site site = Site::a1;
    Face face = Face::none;
    Slip slip = Slip::none;
    ContactFrame frame;
    double ratio = 0.0;       ///< T = ratio N for sliding contacts
    bool separate_t = false;  ///< T is a series of its own (stick, regularised)
    bool turning = false;     ///< k(n), h(n) change with the tilt
    double stiffness = 0.0, damping = 0.0;
    Directions d;
    Series k{}, h{};         ///< of turning contacts
    Series tanh{}, sech2{};  ///< regularised: tanh(V/eps) and 1 - tanh^2
  };

  struct Load {  ///< forces and moment of all contacts, one power
    Pair force{0.0, 0.0};
    double moment = 0.0;
  };

  void start(const State& start, const DriveForms& drives, int order, Segment& segment);
  void set_up_contacts(Segment& segment);
  void trig_term(int k, Segment& segment);
  void point_term(Site site, int k, const Segment& segment);
  void force_terms(int k, Segment& segment);
  void hold_sticking(int k, Segment& segment);
  void find_conflict(const std::array<double, kSiteCount>& rhs, const std::array<double, kSiteCount>& force, int k);
  void direction_terms(Contact& contact, int k, const Segment& segment) const;
  Load contact_load(int k, const Segment& segment) const;
  void accelerate(int k, const Load& load, Segment& segment) const;

  const System& system_;
  int order_ = 0;
  int known_trig_ = 0;  ///< highest known power of cos and sin
  std::array<Contact, kSiteCount> contacts_;
  PairSeries direction_, turned_;               ///< (cos phi, sin phi) and (-sin phi, cos phi)
  std::array<PairSeries, 4> points_;            ///< a1, a2, b1, b2 (floor sites share their corner)
  std::array<PairSeries, 2> levers_, crossed_;  ///< edges: A - C = (r_x, r_y) and (r_y, -r_x), world axes
  std::array<int, 4> known_point_{};            ///< highest known power, -1: none
  Conflict conflict_;
  int sticking_count_ = 0;
  std::array<int, kSiteCount> sticking_{};  ///< indices into segment.loaded
  std::array<std::array<double, kSiteCount>, kSiteCount> mobility_{};
};

}  // namespace vibratory_alignment
