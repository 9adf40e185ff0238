// SI units <-> the paper's dimensionless numbers (its nomenclature, section 2; MODEL.md, head).
#pragma once

#include <functional>
#include <string>

#include "model/scene.h"

namespace vibratory_alignment {

enum class Quantity {
  mass,
  length,
  angle,
  time,
  velocity,
  angular_velocity,
  force,
  moment,
  stiffness,
  angular_stiffness,
  damping,
  angular_damping,
  inertia,
  frequency  ///< in cycles outside (Hz), in radians per unit of time inside (nu)
};

/// "kg", "m", ... as a scene in SI units gives the quantity.
const char* si_unit(Quantity quantity);

/// What 1 dimensionless unit of the quantity is in that SI unit.
double si_size(Quantity quantity, const Scales& scales);

/// "0.25 m": a dimensionless value in the scene's own unit; "0.25" of a dimensionless scene.
std::string own_unit_text(const Scene& scene, Quantity quantity, double value);

/// M and K_Y from the gripper's y axis; F1 is the largest excitation force along y, or along x if there is none along
/// y, or K_Y half_width if there is neither. `in_si` is a scene whose numbers are still in SI units.
Scales natural_scales(const Scene& in_si);

/// Turns every number from SI units into a dimensionless one, by scene.scales.
void make_dimensionless(Scene& scene);

/// Hands every dimensional number of the scene that is set to `visit`, with the key path that it has in a scene file.
using QuantityVisitor = std::function<void(const std::string& key_path, Quantity quantity, double& value)>;
void visit_quantities(Scene& scene, const QuantityVisitor& visit);

/// Factors from dimensionless numbers to the units in which results are reported.
struct OutputUnits {
  double time = 1.0, length = 1.0, velocity = 1.0, angular_velocity = 1.0;
  double force = 1.0, moment = 1.0, impulse = 1.0, energy = 1.0;
};

OutputUnits si_output_units(const Scales& scales);

/// The scene's own units: all 1 for a dimensionless scene.
OutputUnits output_units(const Scene& scene);

}  // namespace vibratory_alignment
