#include "random_changes.h"

#include <algorithm>
#include <cstddef>

#include "dice.h"
#include "model/scene.h"
#include "model/scene_error.h"

namespace vibratory_alignment::hunt {
namespace {

constexpr int kMostWishes = 5;

enum class Place { anywhere, at_event, near_event, at_start, after_start };

/// Asks for a change in the segment that goes on beyond `from`, or the first one after it that has what is asked for.
struct Wish {
  double from;
  Place place;
};

Place random_place(Dice& dice) { return dice.chance(0.4) ? Place::anywhere : static_cast<Place>(1 + dice.below(4)); }

/// The trial that is left alone ends where its outcome is known, often long before the time limit.
double length_of(const Scene& scene) {
  Simulation simulation(scene);
  while (simulation.advance()) {
  }
  return simulation.time();
}

/// The last one first.
std::vector<Wish> random_wishes(Dice& dice, double length) {
  std::vector<Wish> wishes(static_cast<std::size_t>(1 + dice.below(kMostWishes)));
  for (Wish& wish : wishes) wish = {dice.uniform(0.0, length), random_place(dice)};
  std::sort(wishes.begin(), wishes.end(), [](const Wish& a, const Wish& b) { return a.from > b.from; });
  return wishes;
}

bool wants_event(Place place) { return place == Place::at_event || place == Place::near_event; }

double instant_of(Dice& dice, const Wish& wish, const Segment& segment) {
  const double start = segment.start.value(), end = segment.end_time();
  switch (wish.place) {
    case Place::at_event: return end;
    case Place::near_event: return end + (dice.chance(0.5) ? 1.0 : -1.0) * dice.decades(1e-16, 1e-3) * (end - start);
    case Place::at_start: return start;
    case Place::after_start: return start + 1e-12;
    case Place::anywhere: break;
  }
  return wish.from;
}

/// `first`: as it was in the beginning, for many changes are not to go far.
void change(Dice& dice, const Excitation& first, Excitation& e) {
  if (dice.chance(0.5)) e.amplitude = dice.chance(0.15) ? 0.0 : first.amplitude * dice.uniform(-2.0, 2.0);
  if (dice.chance(0.5)) e.frequency = first.frequency * dice.decades(0.3, 2.0);
  if (dice.chance(0.3)) e.phase += dice.uniform(-10.0, 10.0);
  if (dice.chance(0.15)) e.waveform = static_cast<Waveform>(dice.below(4));
  if (e.waveform == Waveform::chirp && (e.sweep_time == 0.0 || dice.chance(0.5))) {
    e.end_frequency = first.frequency * dice.decades(0.1, 3.0);
    e.sweep_time = dice.decades(0.1, 50.0) / std::max(1.0, 0.05 * first.frequency);
  }
}

/// `present`: the scene as it has become by the changes before.
Change random_change(Dice& dice, double instant, const Scene& first, Scene& present) {
  Change c;
  c.time = instant;
  c.cut_late = dice.chance(0.2);
  if (dice.chance(0.15)) return c;  // a cut alone
  if (!present.excitations.empty() && dice.chance(0.75)) {
    for (std::size_t i = 0; i < present.excitations.size(); ++i)
      if (dice.chance(0.8)) change(dice, first.excitations[i], present.excitations[i]);
    c.excitations = present.excitations;
    if (dice.chance(0.1)) c.excitations->resize(1);
  }
  if (present.gripper.pressing_force && dice.chance(0.5)) {
    const double press = *first.gripper.pressing_force;
    present.gripper.pressing_force = dice.chance(0.1) ? 0.0 : (press > 0.0 ? press : 1.0) * dice.decades(0.1, 5.0);
    c.pressing_force = present.gripper.pressing_force;
  }
  return c;
}

}  // namespace

std::vector<Change> random_changes(std::uint64_t seed, const Scene& scene) {
  Dice dice(~seed);  // not those of the scene
  std::vector<Change> changes;
  Scene present = scene;
  try {
    std::vector<Wish> wishes = random_wishes(dice, length_of(scene));
    Simulation simulation(scene);
    Changer changer(changes);
    while (simulation.advance()) {
      const Segment& segment = simulation.segment();
      while (!wishes.empty() && wishes.back().from < segment.end_time()) {
        const Wish& wish = wishes.back();
        if (wants_event(wish.place) && segment.event_count == 0) break;
        const double last = changes.empty() ? 0.0 : changes.back().time;
        const double instant = std::max(instant_of(dice, wish, segment), last);
        do changes.push_back(random_change(dice, instant, scene, present));
        while (dice.chance(0.2));
        wishes.pop_back();
      }
      changer.make_due(simulation);
    }
  } catch (const SceneError&) {
  }
  return changes;
}

}  // namespace vibratory_alignment::hunt
