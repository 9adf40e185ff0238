// One step through the tanh layer, from one side to the other: Gauss collocation with the sliding velocity V as the
// independent variable, in which the law of friction is a given function and the motion nearly a quadrature
// (docs/hybrid_step.md "Crossing").
#pragma once

#include "mechanics/octet_forces.h"
#include "solver/drive_series.h"
#include "solver/gauss_table.h"
#include "solver/segment.h"
#include "solver/solver.h"

namespace vibratory_alignment {

class LayerCrossing {
 public:
  /// `tolerance`: error of the velocities and of the duration, relative to them.
  LayerCrossing(const System& system, double tolerance);

  /// Takes the part from `start` to where V leaves the layer; of `contacts` that at `site` is the only one that is
  /// loaded. False when V would turn within it, the part would be released, that takes `longest` or longer, or nothing
  /// is gained, as for a stiff base. Counts forces, and what is thrown away.
  [[gnu::noinline]] bool take(const State& start, const DriveForms& drives, const ContactStates& contacts, Site site,
                              double longest, SolverCounts& counts);

  double duration() const { return duration_; }
  const State& end() const { return end_; }

  /// Bounds of |x''|, |y''|, |phi''| during the crossing.
  const Load3& most_acceleration() const { return most_acceleration_; }

  /// Bound of N.
  double most_normal_force() const { return most_normal_force_; }

  /// State, forces of the excitations and contact at time t since the start, 0 <= t <= duration().
  State at(double t) const { return state_at_place(place_at(t)); }
  Load3 drive_at(double t) const;
  ContactValues contact_at(double t) const { return contact_at_place(place_at(t)); }

  /// Largest N from one time to another.
  double largest_normal_force(double from, double to) const;

  /// Quadrature over a part of the crossing, as exact as the motion: times and their weights, the first `count`.
  struct Quadrature {
    std::size_t count = 0;
    std::array<double, GaussTable::kMost> time, weight;
  };
  Quadrature quadrature(double from, double to) const;

 private:
  using Stages = std::array<Octet, GaussTable::kOctets>;
  using Basis = std::array<double, GaussTable::kMost + 1>;
  /// What a force of one along n or t makes of x'', y'', phi'' and V'.
  struct Effect {
    double x = 0.0, y = 0.0, phi = 0.0, slip_rate = 0.0;
  };

  bool look_at_start(const ContactStates& contacts);
  bool place_nodes();
  bool resolve(SolverCounts& counts);
  bool solve(SolverCounts& counts);
  bool guess();
  void evaluate();
  double integrate();
  bool passes();
  double unresolved() const;
  bool finish();

  double slip_at(double place) const;
  Basis basis_at(double place) const;
  double interpolate(const Basis& basis, double at_start, const Stages& at_nodes) const;
  double place_at(double t) const;
  State state_at_place(double place) const;
  ContactValues contact_at_place(double place) const;

  const System& system_;
  double tolerance_, longest_ = 0.0;
  const GaussTable* table_;

  // the start
  State start_;
  DriveForms drives_;
  Site site_ = Site::a1;
  Face face_ = Face::none;
  double share_at_start_ = 0.0;                                         ///< V/eps
  double normal_force_at_start_ = 0.0;                                  ///< N
  double friction_at_start_ = 0.0;                                      ///< T
  double slip_rate_at_start_ = 0.0;                                     ///< V'
  double push_rate_at_start_ = 0.0, push_acceleration_at_start_ = 0.0;  ///< N = N(0) + rate t + acceleration t^2
  Load3 acceleration_at_start_;                                         ///< x'', y'', phi''
  Effect of_push_, of_friction_;
  double way_ = 1.0;        ///< sign of V'
  double base_rate_ = 0.0;  ///< of what the base answers with, rad per unit of time

  // V = way eps (centre + kWidth sinh w), w = first + half (1 + place), -1 <= place <= 1. T has poles pi/2 eps from the
  // real axis of V, which the map leads away.
  static constexpr double kWidth = 1.5707963267948966;
  static constexpr double kRounding = 4e-15;  ///< of a place, and of changes relative to what changes
  double centre_ = 0.0, first_ = 0.0, half_ = 0.0;
  double pace_at_start_ = 0.0;  ///< dt/dw

  // at the nodes
  Stages tanh_, stretch_;  ///< tanh(V/eps), dV/dw
  Stages time_, pace_;     ///< t, dt/dw
  std::array<StateOctet, GaussTable::kOctets> states_;
  Stages ax_, ay_, alpha_;  ///< x'', y'', phi''
  Stages normal_force_;
  double least_force_ = 0.0, most_force_ = 0.0;  ///< of N at the start and the nodes

  double duration_ = 0.0;
  State end_;
  Load3 most_acceleration_;
  double most_normal_force_ = 0.0;
};

}  // namespace vibratory_alignment
