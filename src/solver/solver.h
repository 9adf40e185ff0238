// The one interface of all solvers: the motion as a sequence of segments.
#pragma once

#include <stdexcept>
#include <vector>

#include "mechanics/system.h"
#include "model/scene.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// A run that cannot go on from the end of its last segment: step limit, numbers that are no longer finite, no
/// consistent contact state.
class SolverFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SolverCounts {
  long steps = 0;            ///< segments
  long rejected = 0;         ///< steps computed and thrown away
  long rhs_evaluations = 0;  ///< evaluations of the forces (each order of a power series counts as one)
  long events = 0;           ///< from which the motion went on: those that end a trial are not among them
};

class Solver {
 public:
  virtual ~Solver() = default;

  /// Computes the next segment: to the next event, the end of a step or `limit`, whichever comes first.
  /// Throws SolverFailure. Allocates nothing.
  virtual const Segment& advance(double limit) = 0;

  /// The segment that the last advance() gave.
  virtual const Segment& segment() const = 0;

  /// Shortens the current segment to `duration`; its events are dropped and the next advance() starts there.
  virtual void cut(double duration) = 0;

  /// From the end of the current segment on. The number of excitations must not grow.
  virtual void set_excitations(const std::vector<Excitation>& excitations) = 0;
  virtual void set_anchor_y(double anchor_y) = 0;

  virtual const SolverCounts& counts() const = 0;
};

}  // namespace vibratory_alignment
