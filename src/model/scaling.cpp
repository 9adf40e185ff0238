#include "model/scaling.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vibratory_alignment {
namespace {

constexpr double two_pi = 6.283185307179586476925;

void visit_axis(GripperAxis& axis, const std::string& name, const QuantityVisitor& visit) {
  const bool turns = name == "phi";
  if (axis.moves) visit(turns ? "part.inertia" : "part.mass", turns ? Quantity::inertia : Quantity::mass, axis.inertia);
  visit("gripper.stiffness." + name, turns ? Quantity::angular_stiffness : Quantity::stiffness, axis.stiffness);
  visit("gripper.damping." + name, turns ? Quantity::angular_damping : Quantity::damping, axis.damping);
}

void visit_optional(std::optional<double>& value, const char* key_path, Quantity quantity,
                    const QuantityVisitor& visit) {
  if (value) visit(key_path, quantity, *value);
}

double largest_force(const Scene& in_si, Direction direction) {
  double largest = 0.0;
  for (const Excitation& excitation : in_si.excitations)
    if (excitation.direction == direction) largest = std::max(largest, std::abs(excitation.amplitude));
  return largest;
}

}  // namespace

const char* si_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::mass: return "kg";
    case Quantity::length: return "m";
    case Quantity::angle: return "rad";
    case Quantity::time: return "s";
    case Quantity::velocity: return "m/s";
    case Quantity::angular_velocity: return "rad/s";
    case Quantity::force: return "N";
    case Quantity::moment: return "N m";
    case Quantity::stiffness: return "N/m";
    case Quantity::angular_stiffness: return "N m/rad";
    case Quantity::damping: return "N s/m";
    case Quantity::angular_damping: return "N m s/rad";
    case Quantity::inertia: return "kg m^2";
    case Quantity::frequency: return "Hz";
  }
  return "";
}

std::string own_unit_text(const Scene& scene, Quantity quantity, double value) {
  std::ostringstream text;
  if (scene.units == Units::si)
    text << value * si_size(quantity, *scene.scales) << ' ' << si_unit(quantity);
  else
    text << value;
  return text.str();
}

double si_size(Quantity quantity, const Scales& scales) {
  switch (quantity) {
    case Quantity::mass: return scales.mass_kg;
    case Quantity::length: return scales.length_m();
    case Quantity::angle: return 1.0;
    case Quantity::time: return scales.time_s();
    case Quantity::velocity: return scales.velocity_m_per_s();
    case Quantity::angular_velocity: return scales.angular_velocity_rad_per_s();
    case Quantity::force: return scales.force_n;
    case Quantity::moment: return scales.moment_n_m();
    case Quantity::stiffness: return scales.stiffness_n_per_m;
    case Quantity::angular_stiffness: return scales.moment_n_m();
    case Quantity::damping: return scales.stiffness_n_per_m * scales.time_s();
    case Quantity::angular_damping: return scales.moment_n_m() * scales.time_s();
    case Quantity::inertia: return scales.mass_kg * scales.length_m() * scales.length_m();
    case Quantity::frequency: return 1.0 / (two_pi * scales.time_s());
  }
  return 1.0;
}

Scales natural_scales(const Scene& in_si) {
  const GripperAxis& axial = in_si.gripper.y;
  double force = largest_force(in_si, Direction::y);
  if (force == 0.0) force = largest_force(in_si, Direction::x);
  if (force == 0.0) force = axial.stiffness * in_si.part.half_width;
  return {axial.inertia, axial.stiffness, force};
}

void make_dimensionless(Scene& scene) {
  const Scales scales = scene.scales.value();
  visit_quantities(
      scene, [&scales](const std::string&, Quantity quantity, double& value) { value /= si_size(quantity, scales); });
}

void visit_quantities(Scene& scene, const QuantityVisitor& visit) {
  visit("part.half_width", Quantity::length, scene.part.half_width);
  visit("part.base_distance", Quantity::length, scene.part.base_distance);
  visit("slot.clearance", Quantity::length, scene.slot.clearance);
  visit_optional(scene.slot.depth, "slot.depth", Quantity::length, visit);

  Gripper& gripper = scene.gripper;
  visit_axis(gripper.x, "x", visit);
  visit_axis(gripper.y, "y", visit);
  visit_axis(gripper.phi, "phi", visit);
  visit("gripper.anchor.x", Quantity::length, gripper.anchor_x);
  visit("gripper.anchor.phi", Quantity::angle, gripper.anchor_phi);
  visit_optional(gripper.anchor_y, "gripper.anchor.y", Quantity::length, visit);
  visit_optional(gripper.pressing_force, "gripper.pressing_force", Quantity::force, visit);

  visit("base.stiffness.x", Quantity::stiffness, scene.base.stiffness_x);
  visit("base.stiffness.y", Quantity::stiffness, scene.base.stiffness_y);
  visit("base.damping.x", Quantity::damping, scene.base.damping_x);
  visit("base.damping.y", Quantity::damping, scene.base.damping_y);
  if (scene.friction)
    visit_optional(scene.friction->regularization, "friction.regularization", Quantity::velocity, visit);
  visit("weight", Quantity::force, scene.weight);

  for (Excitation& excitation : scene.excitations) {
    const bool turns = excitation.direction == Direction::phi;
    visit("excitation.amplitude", turns ? Quantity::moment : Quantity::force, excitation.amplitude);
    visit("excitation.frequency", Quantity::frequency, excitation.frequency);
    visit("excitation.end_frequency", Quantity::frequency, excitation.end_frequency);
    visit("excitation.phase", Quantity::angle, excitation.phase);
    visit("excitation.sweep_time", Quantity::time, excitation.sweep_time);
  }

  InitialState& initial = scene.initial;
  visit("initial.x", Quantity::length, initial.x);
  visit_optional(initial.y, "initial.y", Quantity::length, visit);
  visit_optional(initial.phi, "initial.phi", Quantity::angle, visit);
  visit("initial.vx", Quantity::velocity, initial.vx);
  visit("initial.vy", Quantity::velocity, initial.vy);
  visit("initial.omega", Quantity::angular_velocity, initial.omega);

  visit("trial.time_limit", Quantity::time, scene.trial.time_limit);
  visit("trial.aligned_depth", Quantity::length, scene.trial.aligned_depth);
  visit_optional(scene.trial.inserted_depth, "trial.inserted_depth", Quantity::length, visit);
  visit_optional(scene.trial.force_limit, "trial.force_limit", Quantity::force, visit);
  visit_optional(scene.solver.step, "solver.step", Quantity::time, visit);
}

OutputUnits si_output_units(const Scales& scales) {
  OutputUnits units;
  units.time = scales.time_s();
  units.length = scales.length_m();
  units.velocity = scales.velocity_m_per_s();
  units.angular_velocity = scales.angular_velocity_rad_per_s();
  units.force = scales.force_n;
  units.moment = scales.moment_n_m();
  units.impulse = scales.impulse_n_s();
  units.energy = scales.energy_j();
  return units;
}

OutputUnits output_units(const Scene& scene) {
  return scene.units == Units::si && scene.scales ? si_output_units(*scene.scales) : OutputUnits();
}

}  // namespace vibratory_alignment
