#include "shrink.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

namespace vibratory_alignment::hunt {
namespace {

/// Changes the scene; false if there is nothing to change.
using Step = std::function<bool(Scene&)>;

/// Takes an optional value out.
template <class Value>
Step dropped(std::optional<Value>& (*part)(Scene&)) {
  return [part](Scene& s) {
    if (!part(s)) return false;
    part(s).reset();
    return true;
  };
}

Step switched_off(bool& (*flag)(Scene&)) {
  return [flag](Scene& s) {
    if (!flag(s)) return false;
    flag(s) = false;
    return true;
  };
}

/// A number that a scene may lack.
using Number = std::function<double*(Scene&)>;

Step set_to(const Number& number, double value) {
  return [number, value](Scene& s) {
    double* const place = number(s);
    if (place == nullptr || *place == value) return false;
    *place = value;
    return true;
  };
}

Step rounded_to(const Number& number, int digits) {
  return [number, digits](Scene& s) {
    double* const place = number(s);
    if (place == nullptr) return false;
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, *place);
    const double value = std::strtod(text, nullptr);
    if (value == *place) return false;
    *place = value;
    return true;
  };
}

Step trial_shortened(double factor) {
  return [factor](Scene& s) {
    s.trial.time_limit *= factor;
    return s.trial.time_limit > 1e-12;
  };
}

Step excitation_dropped(std::size_t index) {
  return [index](Scene& s) {
    if (s.excitations.size() <= index) return false;
    s.excitations.erase(s.excitations.begin() + static_cast<std::ptrdiff_t>(index));
    return true;
  };
}

Step excitation_made_sine(std::size_t index) {
  return [index](Scene& s) {
    if (s.excitations.size() <= index || s.excitations[index].waveform == Waveform::sine) return false;
    s.excitations[index].waveform = Waveform::sine;
    return true;
  };
}

bool walls_dropped(Scene& s) {
  if (!s.contacts.walls) return false;
  s.contacts.walls = false;
  s.slot.depth.reset();
  s.trial.inserted_depth.reset();
  return true;
}

bool tilt_locked(Scene& s) {
  if (!s.gripper.phi.moves || !s.initial.phi) return false;
  s.gripper.phi.moves = false;
  s.gripper.phi.inertia = 1.0;
  return true;
}

bool sideways_locked(Scene& s) {
  if (!s.gripper.x.moves) return false;
  s.gripper.x.moves = false;
  s.gripper.x.stiffness = 0.0;
  return true;
}

bool base_made_isotropic(Scene& s) {
  if (s.base.stiffness_x == s.base.stiffness_y && s.base.damping_x == s.base.damping_y) return false;
  s.base.stiffness_x = s.base.stiffness_y;
  s.base.damping_x = s.base.damping_y;
  return true;
}

/// Numbers that may become zero, then all numbers.
std::vector<Number> dispensable_numbers() {
  std::vector<Number> numbers;
  numbers.push_back([](Scene& s) { return &s.gripper.x.damping; });
  numbers.push_back([](Scene& s) { return &s.gripper.y.damping; });
  numbers.push_back([](Scene& s) { return &s.gripper.phi.damping; });
  numbers.push_back([](Scene& s) { return &s.gripper.phi.stiffness; });
  numbers.push_back([](Scene& s) { return s.gripper.x.moves ? &s.gripper.x.stiffness : nullptr; });
  numbers.push_back([](Scene& s) { return &s.base.damping_x; });
  numbers.push_back([](Scene& s) { return &s.base.damping_y; });
  numbers.push_back([](Scene& s) { return &s.weight; });
  numbers.push_back([](Scene& s) { return &s.gripper.anchor_x; });
  numbers.push_back([](Scene& s) { return &s.gripper.anchor_phi; });
  numbers.push_back([](Scene& s) { return &s.initial.vx; });
  numbers.push_back([](Scene& s) { return &s.initial.vy; });
  numbers.push_back([](Scene& s) { return &s.initial.omega; });
  numbers.push_back([](Scene& s) { return &s.initial.x; });
  numbers.push_back([](Scene& s) { return s.initial.phi ? &*s.initial.phi : nullptr; });
  numbers.push_back([](Scene& s) { return &s.trial.aligned_depth; });
  for (const std::size_t i : {0u, 1u, 2u})
    numbers.push_back([i](Scene& s) { return i < s.excitations.size() ? &s.excitations[i].phase : nullptr; });
  return numbers;
}

std::vector<Number> needed_numbers() {
  std::vector<Number> numbers;
  numbers.push_back([](Scene& s) { return &s.part.half_width; });
  numbers.push_back([](Scene& s) { return &s.part.base_distance; });
  numbers.push_back([](Scene& s) { return &s.slot.clearance; });
  numbers.push_back([](Scene& s) { return s.slot.depth ? &*s.slot.depth : nullptr; });
  numbers.push_back([](Scene& s) { return s.gripper.phi.moves ? &s.gripper.phi.inertia : nullptr; });
  numbers.push_back([](Scene& s) { return &s.base.stiffness_x; });
  numbers.push_back([](Scene& s) { return &s.base.stiffness_y; });
  numbers.push_back([](Scene& s) { return s.friction ? &s.friction->coefficient : nullptr; });
  numbers.push_back(
      [](Scene& s) { return s.friction && s.friction->regularization ? &*s.friction->regularization : nullptr; });
  numbers.push_back([](Scene& s) { return s.gripper.anchor_y ? &*s.gripper.anchor_y : nullptr; });
  numbers.push_back([](Scene& s) { return s.gripper.pressing_force ? &*s.gripper.pressing_force : nullptr; });
  numbers.push_back([](Scene& s) { return s.initial.y ? &*s.initial.y : nullptr; });
  numbers.push_back([](Scene& s) { return s.trial.inserted_depth ? &*s.trial.inserted_depth : nullptr; });
  numbers.push_back([](Scene& s) { return &s.trial.time_limit; });
  numbers.push_back([](Scene& s) { return &s.solver.tolerance; });
  for (const std::size_t i : {0u, 1u, 2u}) {
    numbers.push_back([i](Scene& s) { return i < s.excitations.size() ? &s.excitations[i].amplitude : nullptr; });
    numbers.push_back([i](Scene& s) { return i < s.excitations.size() ? &s.excitations[i].frequency : nullptr; });
  }
  return numbers;
}

std::vector<Step> all_steps() {
  std::vector<Step> steps;
  for (const double factor : {0.1, 0.5, 0.8}) steps.push_back(trial_shortened(factor));
  steps.push_back(dropped<Friction>([](Scene& s) -> std::optional<Friction>& { return s.friction; }));
  for (const std::size_t i : {2u, 1u, 0u}) steps.push_back(excitation_dropped(i));
  for (const std::size_t i : {0u, 1u, 2u}) steps.push_back(excitation_made_sine(i));
  steps.push_back(walls_dropped);
  steps.push_back(switched_off([](Scene& s) -> bool& { return s.contacts.corners; }));
  steps.push_back(switched_off([](Scene& s) -> bool& { return s.contacts.edges; }));
  steps.push_back(switched_off([](Scene& s) -> bool& { return s.base.recovery; }));
  steps.push_back(dropped<double>([](Scene& s) -> std::optional<double>& { return s.slot.depth; }));
  steps.push_back(dropped<double>([](Scene& s) -> std::optional<double>& { return s.trial.inserted_depth; }));
  steps.push_back([](Scene& s) {
    if (!s.friction || !s.friction->regularization) return false;
    s.friction->regularization.reset();
    return true;
  });
  steps.push_back(tilt_locked);
  steps.push_back(sideways_locked);
  steps.push_back(base_made_isotropic);
  steps.push_back(set_to([](Scene& s) { return &s.solver.tolerance; }, 1e-8));
  const std::vector<Number> dispensable = dispensable_numbers(), needed = needed_numbers();
  for (const Number& number : dispensable) steps.push_back(set_to(number, 0.0));
  for (const Number& number : needed) steps.push_back(set_to(number, 1.0));
  for (const int digits : {1, 2, 4})
    for (const std::vector<Number>* const numbers : {&needed, &dispensable})
      for (const Number& number : *numbers) steps.push_back(rounded_to(number, digits));
  return steps;
}

bool calls_for_contact(const Scene& s) { return s.contacts.edges || s.contacts.corners || s.contacts.walls; }

}  // namespace

Scene shrink(Scene scene, const std::function<bool(const Scene&)>& still_fails, int trials) {
  const std::vector<Step> steps = all_steps();
  for (bool simpler = true; simpler;) {
    simpler = false;
    for (const Step& step : steps) {
      Scene candidate = scene;
      if (!step(candidate) || !calls_for_contact(candidate)) continue;
      if (--trials < 0) return scene;
      if (!still_fails(candidate)) continue;
      scene = candidate;
      simpler = true;
    }
  }
  return scene;
}

}  // namespace vibratory_alignment::hunt
