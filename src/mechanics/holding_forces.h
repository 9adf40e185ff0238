// The tangential forces that hold sticking contacts, and what they change of the motion (docs/hybrid_step.md "Stick").
//
// With J the rows (t_x, t_y, r x t) of the contacts, G = J M^-1 J^T is never formed: it would square the ratio between
// the mobilities of the axes, and what little one of them adds to the other would be lost. The factor J M^-1/2 keeps
// it. Whether contacts hold the same motion is asked of J alone, with levers measured by the size of the part, so that
// it does not depend on the inertia.
#pragma once

#include <array>
#include <cmath>

#include <Eigen/QR>

#include "mechanics/contact.h"
#include "mechanics/system.h"

namespace vibratory_alignment {

/// Row of J: t and its lever about the mass centre.
struct TangentRow {
  double x = 0.0, y = 0.0, moment = 0.0;
};

/// What a change leaves of the rate of an axis is rest where it is no more than this of what was taken out: a part that
/// moves by rounding would have the time scale of rounding.
constexpr double kRest = 1e-15;

/// Ratio of the axes' mobilities from which on the last digits of a force show in the motion.
constexpr double kUnequalMobility = 1e6;

/// How a contact that sticks alone is held, whatever its row of J.
struct SingleHold {
  bool delicate;          ///< see HoldingForces::delicate()
  double least_mobility;  ///< up to which G is rounding beside the mobility of the part, and nothing is held
};
SingleHold single_hold(const System& system);

class HoldingForces {
 public:
  using Vector = std::array<double, kSiteCount>;
  using Rows = std::array<TangentRow, kSiteCount>;

  /// T of every contact, and how they change the rates of the axes: M^-1 J^T T, to the last digit of the motion even
  /// where the last digit of T moves it by more.
  struct Answer {
    Vector force{};
    double x = 0.0, y = 0.0, phi = 0.0;
    bool told_apart = false;  ///< contacts of nearly the same row take each a T of its own, not all the same
  };

  /// The first `count` rows. What is rounding beside the mobility of the part holds nothing.
  void set(const System& system, const Rows& rows, int count);

  /// True when every rhs has exactly one T.
  bool regular() const { return regular_; }

  /// True when it depends on the noise given which contacts are told apart.
  bool tells_apart_by_noise() const { return count_ > 1 && safe_.rank != full_.rank; }

  /// True when rounding of the forces moves the part by more than rounding of the motion: V' is then to be read off
  /// the corrected motion and taken out once more.
  bool delicate() const { return delicate_; }

  /// The smallest T with |G T - rhs| <= noise; if none is as exact, the smallest of those that come nearest.
  Answer hold(const Vector& rhs, const Vector& noise) const;

  /// What is left of a motion of the part (rates of its axes; no forces) when T takes V' out of it, and that T; `noise`
  /// as above. V' is what the motion makes of it and `own_rates` besides. T follows from the motion itself, for in V'
  /// the slow axes drown beside the fast ones.
  Answer hold_motion(const Answer& motion, const Vector& own_rates, const Vector& noise) const;

  /// The same for a single contact that can be held: regular().
  Answer hold_motion_of_one(const Answer& motion, double own_rate) const {
    const double rate = rows_[0].x * motion.x + rows_[0].y * motion.y + rows_[0].moment * motion.phi;
    return left_of(motion, hold_one(-rate - own_rate));
  }

  /// The same to rounding of V': taken out once more where that is delicate.
  Answer hold_motion(const Answer& motion, const Vector& own_rates) const;

  /// How a load on the part (force, moment) changes the rates of the axes while the contacts hold; no force told.
  /// `told_apart`: those of nearly the same row take each a T of its own.
  Answer respond(const TangentRow& load, bool told_apart = false) const;

  /// G T - rhs of one row.
  double left_over(int row, const Vector& rhs, const Answer& answer) const;

  /// Errors of T that errors `noise` of the right-hand side cause, at most, nearly common motions left out.
  Vector spread(const Vector& noise) const;

 private:
  struct Factor {
    int rank = 0;
    /// (J M^-1/2)^+ in the axes x, y, phi times the reach.
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kSiteCount> inverse;
  };
  using Inverse = decltype(Factor::inverse);
  using Plane = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kSiteCount, 3>;
  /// J = Q R, its columns in this order of the axes.
  struct Decomposition {
    Eigen::ColPivHouseholderQR<Plane> qr;
    std::array<int, 3> axes{0, 1, 2};

    int rank(double singular);
  };
  Decomposition decompose() const;
  Factor factorize(Decomposition& decomposed, double singular) const;
  void share_alike(double singular, Factor& factor) const;
  Answer hold_with(const Factor& factor, const Vector& rhs) const;
  Answer hold_motion_with(const Factor& factor, const Answer& motion, const Vector& own_rates) const;
  double mobility(int i) const;

  /// hold() of a single contact.
  Answer hold_one(double rhs) const {
    const double force = rhs / single_.mobility;
    return {{force}, single_.x * force, single_.y * force, single_.phi * force};
  }

  /// What a change leaves of a motion, in its place.
  static Answer left_of(const Answer& motion, Answer change) {
    const auto left = [](double rate, double changed) {
      const double sum = rate + changed;
      return std::abs(sum) <= kRest * std::abs(rate) ? 0.0 : sum;
    };
    change.x = left(motion.x, change.x);
    change.y = left(motion.y, change.y);
    change.phi = left(motion.phi, change.phi);
    return change;
  }

  int count_ = 0;
  bool regular_ = true, delicate_ = false, holds_nothing_ = false;
  std::array<double, 3> inverse_inertia_{};
  double reach_ = 1.0;             ///< what levers are measured by
  std::array<double, 3> scale_{};  ///< M^-1/2 of x, y and phi times the reach; of several contacts
  Rows rows_{};
  struct {
    double mobility = 0.0, x = 0.0, y = 0.0, phi = 0.0;  ///< G, and how T = 1 changes the rates of the axes
  } single_;                                             ///< of a single contact
  Factor safe_, full_;  ///< without the nearly common motions, and with all that is not rounding
};

}  // namespace vibratory_alignment
