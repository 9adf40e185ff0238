#include "changes.h"

#include <algorithm>
#include <cmath>

#include "../support/mirror.h"

namespace vibratory_alignment::hunt {
namespace {

void make(const Change& change, Simulation& simulation) {
  // the last digits of an instant are not those of its double
  const double time = std::max(change.time, simulation.segment().start.value());
  simulation.cut(change.cut_late ? 0.5 * (time + simulation.segment().end_time()) : time);
  if (change.excitations) simulation.set_excitations(*change.excitations);
  if (change.pressing_force) simulation.set_pressing_force(*change.pressing_force);
  if (change.cut_late) simulation.cut(time);
}

}  // namespace

Trial mirrored(Trial trial) {
  trial.scene = test::mirrored(trial.scene);
  for (Change& change : trial.changes)
    if (change.excitations) change.excitations = test::mirrored(*change.excitations);
  return trial;
}

void Changer::make_due(Simulation& simulation) {
  while (next_time() < simulation.segment().end_time()) make(changes_[made_++], simulation);
}

double Changer::next_time() const { return made_ < changes_.size() ? changes_[made_].time : INFINITY; }

}  // namespace vibratory_alignment::hunt
