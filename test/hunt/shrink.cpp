#include "shrink.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

namespace vibratory_alignment::hunt {
namespace {

/// Makes the trial simpler; false if there is nothing to take out.
using Step = std::function<bool(Trial&)>;

/// The same for what concerns the scene alone.
using SceneStep = std::function<bool(Scene&)>;

/// Takes an optional value out.
template <class Value>
SceneStep dropped(std::optional<Value>& (*part)(Scene&)) {
  return [part](Scene& s) {
    if (!part(s)) return false;
    part(s).reset();
    return true;
  };
}

SceneStep switched_off(bool& (*flag)(Scene&)) {
  return [flag](Scene& s) {
    if (!flag(s)) return false;
    flag(s) = false;
    return true;
  };
}

/// A number that a scene may lack.
using Number = std::function<double*(Scene&)>;

SceneStep set_to(const Number& number, double value) {
  return [number, value](Scene& s) {
    double* const place = number(s);
    if (place == nullptr || *place == value) return false;
    *place = value;
    return true;
  };
}

SceneStep rounded_to(const Number& number, int digits) {
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

SceneStep trial_shortened(double factor) {
  return [factor](Scene& s) {
    s.trial.time_limit *= factor;
    return s.trial.time_limit > 1e-12;
  };
}

/// That of the scene, and those that it is changed to.
template <class Look>
void for_each_list(Trial& trial, const Look& look) {
  look(trial.scene.excitations);
  for (Change& change : trial.changes)
    if (change.excitations) look(*change.excitations);
}

Step excitation_dropped(std::size_t index) {
  return [index](Trial& t) {
    if (t.scene.excitations.size() <= index) return false;
    for_each_list(t, [&](std::vector<Excitation>& list) {
      if (list.size() > index) list.erase(list.begin() + static_cast<std::ptrdiff_t>(index));
    });
    return true;
  };
}

Step excitation_made_sine(std::size_t index) {
  return [index](Trial& t) {
    bool others = false;
    for_each_list(t, [&](std::vector<Excitation>& list) {
      if (list.size() <= index || list[index].waveform == Waveform::sine) return;
      list[index].waveform = Waveform::sine;
      others = true;
    });
    return others;
  };
}

Step change_dropped(std::size_t index) {
  return [index](Trial& t) {
    if (t.changes.size() <= index) return false;
    t.changes.erase(t.changes.begin() + static_cast<std::ptrdiff_t>(index));
    return true;
  };
}

template <class Value>
Step taken_out_of_change(std::size_t index, Value Change::*part) {
  return [index, part](Trial& t) {
    if (t.changes.size() <= index || !(t.changes[index].*part)) return false;
    t.changes[index].*part = Value{};
    return true;
  };
}

/// One setting of an excitation that is changed, as it was before.
Step setting_kept(std::size_t index, std::size_t excitation, double Excitation::*setting) {
  return [=](Trial& t) {
    if (t.changes.size() <= index || !t.changes[index].excitations) return false;
    std::vector<Excitation>& list = *t.changes[index].excitations;
    if (list.size() <= excitation) return false;
    const double before = t.scene.excitations[excitation].*setting;
    if (list[excitation].*setting == before) return false;
    list[excitation].*setting = before;
    return true;
  };
}

/// Of more changes those beyond are looked at when the ones before are dropped.
constexpr std::size_t kChanges = 8;

void add_steps_of_changes(std::vector<Step>& steps) {
  for (std::size_t i = kChanges; i-- > 0;) steps.push_back(change_dropped(i));
  for (std::size_t i = 0; i < kChanges; ++i) {
    steps.push_back(taken_out_of_change(i, &Change::excitations));
    steps.push_back(taken_out_of_change(i, &Change::pressing_force));
    steps.push_back(taken_out_of_change(i, &Change::cut_late));
    for (const std::size_t excitation : {0u, 1u, 2u})
      for (double Excitation::*const setting : {&Excitation::amplitude, &Excitation::frequency, &Excitation::phase})
        steps.push_back(setting_kept(i, excitation, setting));
  }
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
  for (const std::size_t i : {0u, 1u, 2u}) {
    numbers.push_back([i](Scene& s) { return i < s.excitations.size() ? &s.excitations[i].amplitude : nullptr; });
    numbers.push_back([i](Scene& s) { return i < s.excitations.size() ? &s.excitations[i].frequency : nullptr; });
  }
  return numbers;
}

std::vector<SceneStep> scene_steps() {
  std::vector<SceneStep> steps;
  for (const double factor : {0.1, 0.5, 0.8}) steps.push_back(trial_shortened(factor));
  steps.push_back(dropped<Friction>([](Scene& s) -> std::optional<Friction>& { return s.friction; }));
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
  const Number tolerance = [](Scene& s) { return &s.solver.tolerance; };
  steps.push_back(set_to(tolerance, 1e-8));
  steps.push_back(rounded_to(tolerance, 1));
  const std::vector<Number> dispensable = dispensable_numbers(), needed = needed_numbers();
  for (const Number& number : dispensable) steps.push_back(set_to(number, 0.0));
  for (const Number& number : needed) steps.push_back(set_to(number, 1.0));
  for (const int digits : {1, 2, 4})
    for (const std::vector<Number>* const numbers : {&needed, &dispensable})
      for (const Number& number : *numbers) steps.push_back(rounded_to(number, digits));
  return steps;
}

std::vector<Step> all_steps() {
  std::vector<Step> steps;
  add_steps_of_changes(steps);
  for (const std::size_t i : {2u, 1u, 0u}) steps.push_back(excitation_dropped(i));
  for (const std::size_t i : {0u, 1u, 2u}) steps.push_back(excitation_made_sine(i));
  for (const SceneStep& step : scene_steps()) steps.push_back([step](Trial& t) { return step(t.scene); });
  return steps;
}

bool calls_for_contact(const Scene& s) { return s.contacts.edges || s.contacts.corners || s.contacts.walls; }

}  // namespace

Trial shrink(Trial trial, const std::function<bool(const Trial&)>& still_fails, int trials) {
  const std::vector<Step> steps = all_steps();
  for (bool simpler = true; simpler;) {
    simpler = false;
    for (const Step& step : steps) {
      Trial candidate = trial;
      if (!step(candidate) || !calls_for_contact(candidate.scene)) continue;
      if (--trials < 0) return trial;
      if (!still_fails(candidate)) continue;
      trial = candidate;
      simpler = true;
    }
  }
  return trial;
}

}  // namespace vibratory_alignment::hunt
