// First roots of polynomials on an interval, with proof: an interval is passed over only when a bound on the
// polynomial shows that it holds no root, so double crossings and grazing roots are neither missed nor invented
// (docs/hybrid_step.md "Finding events").
#pragma once

#include "solver/series.h"

namespace vibratory_alignment {

constexpr double kNoRoot = -1.0;

/// First t in [0, h] at which g (powers up to `order`) falls below zero, or kNoRoot.
/// `zeros_at_start`: multiplicity of a root at t = 0 that is known to be there and is left out of the search.
/// Throws SolverFailure when g has a coefficient that is not a number, or not finite where that could hide a root.
/// A g that starts at or below zero for want of the last digit, and rises, is taken as starting at zero.
double first_fall(const Series& g, int order, double h, int zeros_at_start);

/// True when bounds show that g stays above zero on [0, h]; false says nothing.
bool stays_above_zero(const Series& g, int order, double h);

/// True when bounds show that g stays at or below `level` on [0, h]; false says nothing. Closer, and dearer, than the
/// bounds of stays_above_zero().
bool stays_below(const Series& g, int order, double h, double level);

constexpr int kMaxConditions = 6;

/// Several polynomials that must all be positive.
struct Conditions {
  std::array<Series, kMaxConditions> g;
  std::array<int, kMaxConditions> zeros_at_start{};
  int count = 0;
};

struct Entry {
  double time = kNoRoot;
  int last = 0;  ///< the condition that became true last
};

/// First t in [0, h] from which on all conditions are positive; time = kNoRoot when there is none.
Entry first_entry(const Conditions& conditions, int order, double h);

}  // namespace vibratory_alignment
