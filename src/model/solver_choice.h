// Solver and tolerance for an accuracy that is asked for: what `solver: {accuracy: E}` means.
#pragma once

#include "model/scene.h"

namespace vibratory_alignment {

/// Accuracies that can be asked for. Less than the finest is lost in rounding before long.
inline constexpr double kFinestAccuracy = 1e-9, kCoarsestAccuracy = 0.1;

/// The tolerance is this part of the accuracy: impacts let an error grow.
inline constexpr double kToleranceShare = 1e-2;

/// `auto` instead of `event` where base, tanh layer or gripper answer this many times as fast as the part is excited.
inline constexpr double kStiffRatio = 500.0;

/// Rate at which a dimensionless part moves on the base, at most: max(sqrt(k G), h G), G = 1/m + (a^2 + b^2)/mu, the
/// mobility of the part's farthest point.
double contact_rate(const Scene& scene);

/// Rate at which V in the tanh layer follows what drives it, at most, under the forces that stand on the part:
/// f N G/eps, N = press + weight + amplitudes along y; 0 without a layer.
double layer_rate(const Scene& scene);

/// The error-controlled solver for a dimensionless scene: `event`, or `auto` where one of these rates or of those of
/// the gripper (sqrt(k/m) and h/m of each axis) is more than kStiffRatio nu (docs/solvers.md).
const char* solver_for_accuracy(const Scene& scene);

/// Step of a solver with a fixed step where none is given, in radians of the fastest that the part may be moved by.
inline constexpr double kDefaultStep = 0.02;

/// That step for a dimensionless scene: kDefaultStep over the fastest of the excitation (nu), the contact (sqrt(k G)
/// and h G, as above, but with |y| of a start below the slot's top in place of b where that is more) and the gripper
/// (sqrt(k/m) and h/m of each axis).
double default_step(const Scene& scene);

/// The tolerance of event, implicit and auto with which the pose at the end is exact to `accuracy`, dimensionless.
double tolerance_for_accuracy(double accuracy);

}  // namespace vibratory_alignment
