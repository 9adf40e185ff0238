// Makes a scene that shows a fault as simple as it can be while the fault is still there.
#pragma once

#include <functional>

#include "model/scene.h"

namespace vibratory_alignment::hunt {

/// Takes effects out, shortens the trial and rounds numbers, one at a time, and keeps what `still_fails` agrees to;
/// asks it at most `trials` times.
Scene shrink(Scene scene, const std::function<bool(const Scene&)>& still_fails, int trials);

}  // namespace vibratory_alignment::hunt
