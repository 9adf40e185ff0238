// The invariants of a whole trial: how it ends, its energy ledger, and answers that must be alike.
#pragma once

#include <optional>
#include <string>

#include "fault.h"
#include "random_scene.h"
#include "trace.h"

namespace vibratory_alignment::hunt {

/// An implicit step leaves up to the tolerance: so many times as much may be left of many.
constexpr double kStepErrors = 100.0;

/// Why the solver gave up, without time and place; empty if it did not. It says so, with a reason: that is a refusal.
/// In scenes far beyond what is physical it may; in others only for the step limit, which the hunt sets low.
std::string refusal(const TrialResult& result);

/// It ended with an outcome, one that the range allows.
std::optional<Fault> check_ending(const TrialResult& result, Range range);

/// The result holds no NaN and nothing infinite.
std::optional<Fault> check_finite(const TrialResult& result);

/// The ledger closes to ten times the solver's tolerance (kStepErrors times with implicit steps), and every loss is
/// one.
std::optional<Fault> check_energy(const Scene& scene, const Trace& trace);

/// Two answers are the same to the last bit.
std::optional<Fault> check_same(const TrialResult& a, const TrialResult& b);

/// The trial ended as its motion had settled.
bool has_settled(const Trace& trace);

/// What is compared at touches and end besides the times. An implicit step leaves a ring of the base that is too small
/// to see, and whose speed is not. A change restarts the watch for settling: whether that is noticed before the time
/// limit says nothing then.
enum class Compared { places_but_settling, places, places_and_rates };

/// Largest difference of two traces over touches, places at instants before the last of these, and end, relative to the
/// sizes of the motion and its fastest speed; infinite where one of them touches or ends otherwise.
double difference(const System& system, const Trace& a, const Trace& b, Compared compared);

/// The trace of the mirrored scene as it should look.
Trace mirrored(Trace trace);

}  // namespace vibratory_alignment::hunt
