// The scene: everything that describes one alignment trial, as plain data.
//
// All numbers are dimensionless in the paper's scaling (MODEL.md, head): length F1/K_Y, force F1, time 1/p with
// p^2 = K_Y/M. A scene written in SI units is scaled while it is loaded; `units` and `scales` say how to scale back.
// An effect is simulated only if its std::optional is set or its flag is true.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vibratory_alignment {

// In scene_loader.cpp the words for these stand in the same order.
enum class Units { dimensionless, si };
enum class Direction : std::uint8_t { x, y, phi };
enum class Waveform { sine, square, triangle, chirp };

/// The three physical scales from which all others follow.
struct Scales {
  double mass_kg = 1.0;            ///< M
  double stiffness_n_per_m = 1.0;  ///< K_Y
  double force_n = 1.0;            ///< F1

  double length_m() const { return force_n / stiffness_n_per_m; }
  double time_s() const { return std::sqrt(mass_kg / stiffness_n_per_m); }
  double velocity_m_per_s() const { return length_m() / time_s(); }
  double angular_velocity_rad_per_s() const { return 1.0 / time_s(); }
  double moment_n_m() const { return force_n * length_m(); }
  double impulse_n_s() const { return force_n * time_s(); }
  double energy_j() const { return force_n * length_m(); }
};

/// Rectangle that is being aligned (MODEL.md "Geometry and frame").
struct Part {
  double half_width = 0.0;     ///< a
  double base_distance = 0.0;  ///< b, mass centre to bottom face
};

/// The hole. Its half width is part.half_width + clearance.
struct Slot {
  double clearance = 0.0;       ///< delta, per side
  std::optional<double> depth;  ///< of the floor below the top surface, touched with walls only; absent: no floor
};

/// One coordinate of the part in its gripper: inertia q'' + damping q' + stiffness (q - anchor) = forces.
struct GripperAxis {
  bool moves = false;      ///< false: the coordinate keeps its initial value
  double inertia = 1.0;    ///< 1 for x and y, mu for phi
  double stiffness = 0.0;  ///< k_x, 1, k_phi
  double damping = 0.0;    ///< h_x, h_y, h_phi
};

struct Gripper {
  GripperAxis x, y, phi;
  double anchor_x = 0.0;                 ///< x_a
  double anchor_phi = 0.0;               ///< phi_a
  std::optional<double> anchor_y;        ///< y_a; exactly one of anchor_y and pressing_force is set
  std::optional<double> pressing_force;  ///< f0; y_a = y_touch - f0
};

/// Compliant base; y: along the slot's axis (C1, H1), x: across it (C2, H2).
struct Base {
  double stiffness_x = 0.0, stiffness_y = 0.0;
  double damping_x = 0.0, damping_y = 0.0;
  bool recovery = false;  ///< true: after release the base relaxes as u' = -(k/h) u instead of at once
};

/// The contact features that the scene calls for.
struct ContactFeatures {
  bool edges = false, corners = false, walls = false;
};

struct Friction {
  double coefficient = 0.0;
  std::optional<double> regularization;  ///< eps: T = -f N tanh(V/eps) instead of the set-valued law
};

/// A force (a moment for direction phi) on the part: amplitude * waveform(frequency * tau + phase).
/// chirp: the frequency moves linearly from `frequency` to `end_frequency` during `sweep_time`, then stays there.
struct Excitation {
  Direction direction = Direction::y;
  Waveform waveform = Waveform::sine;
  double amplitude = 0.0;
  double frequency = 0.0;  ///< nu, radians per unit of time
  double phase = 0.0;      ///< radians
  double end_frequency = 0.0;
  double sweep_time = 0.0;
};

/// More than these are not simulated.
constexpr int kMostExcitations = 16;

/// Start of the trial. y or phi absent: their static equilibrium on the base.
struct InitialState {
  double x = 0.0;
  std::optional<double> y, phi;
  double vx = 0.0, vy = 0.0, omega = 0.0;
};

struct TrialSettings {
  double time_limit = 0.0;
  double aligned_depth = 0.0;
  std::optional<double> inserted_depth;  ///< scenes with walls: end as inserted at this depth
  std::optional<double> force_limit;     ///< only marks the result
};

struct SolverSettings {
  std::string name = "event";  ///< one of solver_names.h
  double tolerance = 1.0e-8;
  /// Of the pose at the end, if that was asked for: name and tolerance were then chosen for it (solver_choice.h).
  std::optional<double> accuracy;
  std::optional<double> step;    ///< fixed-step solvers, in units of time
  long step_limit = 20'000'000;  ///< more steps than this end the trial as failed
};

struct Scene {
  std::string name;
  std::string source;  ///< file or parameter namespace that it was read from, for messages
  Units units = Units::dimensionless;
  std::optional<Scales> scales;  ///< always set for si scenes; absent in a dimensionless scene: no SI output
  Part part;
  Slot slot;
  Gripper gripper;
  Base base;
  ContactFeatures contacts;
  std::optional<Friction> friction;
  double weight = 0.0;
  std::vector<Excitation> excitations;  ///< a scene that has been loaded has one at least
  InitialState initial;
  TrialSettings trial;
  SolverSettings solver;

  /// l, half width of the slot.
  double slot_half_width() const { return part.half_width + slot.clearance; }

  /// Largest frequency of the excitations, radians per unit of time.
  double fastest_excitation() const {
    double fastest = 0.0;
    for (const Excitation& e : excitations) fastest = std::max({fastest, e.frequency, e.end_frequency});
    return fastest;
  }

  /// Its period.
  double shortest_period() const { return 2.0 * M_PI / fastest_excitation(); }
};

}  // namespace vibratory_alignment
