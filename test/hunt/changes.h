// Changes while a trial runs, as the node makes them: its motion is cut at an instant, and from there on excitations
// and press are others.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "model/scene.h"
#include "trial/simulation.h"

namespace vibratory_alignment::hunt {

/// A cut alone where it sets nothing.
struct Change {
  double time = 0.0;
  std::optional<std::vector<Excitation>> excitations;
  std::optional<double> pressing_force;
  bool cut_late = false;  ///< cut and changed later first: cut again at `time` it takes the change with it
};

/// A scene and what is changed while it runs, in the order of time.
struct Trial {
  Scene scene;
  std::vector<Change> changes;

  Trial(Scene s) : scene(std::move(s)) {}  // NOLINT(google-explicit-constructor): most trials are left alone
  Trial(Scene s, std::vector<Change> c) : scene(std::move(s)), changes(std::move(c)) {}
};

Trial mirrored(Trial trial);

/// Makes the changes of one trial. `changes` may grow while it does.
class Changer {
 public:
  explicit Changer(const std::vector<Change>& changes) : changes_(changes) {}

  /// Makes those that are due in the present segment; to be called after each advance().
  void make_due(Simulation& simulation);

  /// Instant of the next one; infinite when all are made.
  double next_time() const;

 private:
  const std::vector<Change>& changes_;
  std::size_t made_ = 0;
};

}  // namespace vibratory_alignment::hunt
