// The free motion of one axis, the others locked, for what asks a single axis for its motion.
#pragma once

#include "mechanics/free_motion.h"

namespace vibratory_alignment::test {

/// An axis that moves.
inline Axis axis_of(double inertia, double damping, double stiffness, double anchor) {
  Axis axis;
  axis.moves = true;
  axis.inertia = inertia;
  axis.inverse_inertia = 1.0 / inertia;
  axis.damping = damping;
  axis.stiffness = stiffness;
  axis.anchor = anchor;
  return axis;
}

class LoneMotion {
 public:
  LoneMotion(const Axis& axis, std::size_t drive_count) : system_(system_of(axis)), motion_(system_, drive_count) {}
  LoneMotion(const LoneMotion&) = delete;

  /// From q and v; a constant force comes as a drive.
  void begin(double q, double v, double constant_force) {
    State state;
    state.y = q;
    state.vy = v;
    motion_.begin(state);
    DriveForm force;
    force.constant = constant_force;
    add(force);
  }
  void add(const DriveForm& form) { motion_.add(Direction::y, form); }
  void settle() { motion_.settle(); }
  bool exact() const { return motion_.exact(); }
  double rate(double t) const { return motion_.rate(t); }

  /// Leaves q and v as they are without an exact closed form.
  void at(double t, double& q, double& v) const {
    State state;
    state.y = q;
    state.vy = v;
    motion_.at(t, state);
    q = state.y;
    v = state.vy;
  }

  /// The acceleration, and bounds on the absolute values of the first three derivatives.
  struct Outlook {
    double acceleration, rate, second, third;
  };
  Outlook outlook(double t, double end) const {
    State state;
    FreeMotion::Outlook outlook;
    motion_.at(t, end, state, outlook);
    constexpr int y = FreeAxes::kY;
    return {outlook.acceleration[y], outlook.rate[y], outlook.second[y], outlook.third[y]};
  }

 private:
  static System system_of(const Axis& axis) {
    System system;
    system.y = axis;
    return system;
  }

  System system_;
  FreeMotion motion_;
};

}  // namespace vibratory_alignment::test
