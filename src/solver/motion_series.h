// Power series of the motion: the Taylor coefficients of the state and of all contact forces, order by order, from the
// recurrences of docs/hybrid_step.md "Contact". With the contacts' laws fixed (slipping one way, sticking, without
// force) the motion is analytic, so the series is both the integrator and its dense output.
#pragma once

#include <algorithm>

#include "mechanics/contact_frame.h"
#include "mechanics/drive.h"
#include "mechanics/holding_forces.h"
#include "solver/drive_series.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// Asked when the series of a step in contact are known to a power: to which power to go on, if to a higher one.
class OrderChoice {
 public:
  virtual int next_order(const Segment& segment) = 0;

 protected:
  ~OrderChoice() = default;
};

class MotionSeries {
 public:
  explicit MotionSeries(const System& system) : system_(system) {}

  /// Fills segment.x ... drive_phi for free motion from `start` (contact forces zero).
  void expand_free(const State& start, const DriveForms& drives, int order, Segment& segment);

  /// Fills the segment with its loaded contacts (segment.contacts) from `start`. Sticking contacts have V = 0 exactly.
  /// `choice`: is asked at the power `order` whether to go on.
  [[gnu::noinline]] void expand_contact(const State& start, const DriveForms& drives, int order, Segment& segment,
                                        OrderChoice* choice = nullptr);

  /// Takes over a segment whose x ... omega were made elsewhere, for what point() and direction() tell about it.
  void adopt(Segment& segment);

  /// Power up to which it is watched whether sticking contacts can hold together.
  static constexpr int kHeldPowers = 6;

  /// What no tangential forces can take out of V' of the sticking contacts, power k < kHeldPowers: contacts that hold
  /// the same motion now and have to move apart. Largest among them; 0 but for rounding where they hold.
  double not_held(int k) const { return not_held_[static_cast<std::size_t>(k)]; }

  /// The most of it within the time h: largest not_held(k) h^k.
  double not_held_within(double h) const {
    double most = 0.0, power = 1.0;
    for (const double left : not_held_) {
      most = std::max(most, left * power);
      power *= h;
    }
    return most;
  }

  /// Accelerations that V' is made of at the segment's start: sum of their absolute values over all axes and forces.
  double slip_rate_size(const Segment& segment) const;

  /// Errors of T of the sticking contacts that errors of V' cause, both per entry of segment.loaded.
  std::array<double, kSiteCount> holding_force_noise(const std::array<double, kSiteCount>& slip_rate_noise) const;

  /// Coordinates of a site's point (body coordinates of an edge, position of a corner), made on the first call.
  const PairSeries& point(Site site, Segment& segment);

  /// (cos phi, sin phi), made on the first call.
  const PairSeries& direction(Segment& segment);

  /// k d + h d' of a contact on `face` with depth series d, to power order - 1 (trigonometric series must be known:
  /// call point() first).
  void push_series(const Segment& segment, Face face, const Series& depth, Series& push) const;

 private:
  struct Contact {
    Site site = Site::a1;
    Face face = Face::none;
    Slip slip = Slip::none;
    int point = 0;  ///< index of its point
    ContactFrame frame;
    double ratio = 0.0;                 ///< T = ratio N for sliding contacts
    double force1 = 0.0, force2 = 0.0;  ///< force per unit of N, sliding friction included, in the axes of the frame
    bool separate_t = false;            ///< T is a series of its own (stick, regularised)
    bool turning = false;               ///< k(n), h(n) change with the tilt
    double stiffness = 0.0, damping = 0.0;
    // known to the power that is made
    QuadSeries push, drag;       ///< force and moment per unit of N (with sliding friction), and of T
    PairSeries square, growth;   ///< turning: cos, cos^2; and cos, what N grows by per unit of cos^2
    QuadSeries layer, layer_by;  ///< regularised, z = tanh(V/eps): z, z, z^2; and z, N, V' of the power before
  };

  void restart(int order, Segment& segment);
  void start(const State& start, const DriveForms& drives, int order, Segment& segment);
  bool goes_on(Segment& segment);
  void set_up_contacts(Segment& segment);
  void trig_term(int k, Segment& segment);
  void centre_term(int k, const Segment& segment);
  void point_term(int point, int k, const Segment& segment);
  void force_term(Contact& contact, int k, ContactSeries& series);
  double push_of_turning(Contact& contact, int k, double depth, double depth_rate);
  void tanh_term(Contact& contact, int k, ContactSeries& series) const;
  void hold_sticking(int k, Segment& segment);
  void set_up_holding();
  void end_sticking(Segment& segment) const;
  void negated_slip_rates(int k, Segment& segment, HoldingForces::Vector& rates);
  bool rounding_shows(const HoldingForces::Answer& free, const HoldingForces::Answer& held,
                      const Segment& segment) const;
  void watch_held(int k, const HoldingForces::Vector& rates, const HoldingForces::Vector& noise,
                  const HoldingForces::Answer& held);
  static HoldingForces::Answer motion(int k, const Segment& segment);
  void set_motion(int k, const HoldingForces::Answer& motion, Segment& segment);
  double slip_rate_size(const Contact& contact, int k, const Segment& segment) const;
  double motion_size(int k, int known, const Segment& segment) const;
  void direction_terms(Contact& contact, int k) const;
  void add_contact_load(int k, const Segment& segment, Quad& load) const;
  void accelerate(int k, const Quad& load, Segment& segment) const;
  void expand_any(Segment& segment);
  void expand_several(Segment& segment);
  enum class Law { slides, layer, sticks };  ///< of a single contact
  bool expand_single(Segment& segment);
  bool expand_any_single(Segment& segment);
  template <bool kEdge, bool kTurns, bool kVaries>
  bool expand_single_by_face(Segment& segment);
  template <bool kEdge, bool kTurns, bool kVaries, bool kLevel>
  bool expand_single_by_law(Segment& segment);
  template <bool kEdge, bool kTurns, bool kVaries, bool kLevel, Law kLaw>
  bool expand_single_of(Segment& segment);

  const System& system_;
  OrderChoice* choice_ = nullptr;  ///< of the present step in contact
  DriveSeries drive_series_;
  int order_ = 0;
  int known_trig_ = 0;  ///< highest known power of cos and sin
  std::array<Contact, kSiteCount> contacts_;
  PairSeries direction_;              ///< (cos phi, sin phi)
  PairSeries centre_;                 ///< C in body axes: (x cos phi + y sin phi, y cos phi - x sin phi)
  int known_centre_ = -1;             ///< highest known power
  std::array<PairSeries, 4> points_;  ///< a1, a2, b1, b2 (floor sites share their corner)
  std::array<int, 4> known_point_{};  ///< highest known power, -1: none
  int sticking_count_ = 0;
  std::array<int, kSiteCount> sticking_{};  ///< indices into segment.loaded
  HoldingForces holding_;                   ///< of the sticking contacts, at the segment's start
  bool takes_out_twice_ = false;            ///< V' that their rounding leaves is taken out once more
  std::array<double, kHeldPowers> not_held_{};
};

}  // namespace vibratory_alignment
