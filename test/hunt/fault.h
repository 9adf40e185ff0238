// What must hold for every trial whatever its scene, and a breach of it.
#pragma once

#include <string>

namespace vibratory_alignment::hunt {

enum class Invariant {
  ends,             ///< the trial ends with an outcome; an ordinary one may only fail by its step limit
  finite,           ///< no number of motion or result is NaN or infinite
  base_pushes,      ///< N >= 0, and N is what the base law makes of depth and rate
  friction_cone,    ///< |T| <= f N
  friction_brakes,  ///< T V <= 0
  no_passing,       ///< no point is inside the other body unnoticed
  ledger_closes,    ///< what came in, less what went out, is there
  losses,           ///< energy leaves through dampers and friction, it does not come in through them
  mirror,           ///< the mirrored scene gives the mirrored answer
  output_rate,      ///< how often the motion is looked at changes no bit of it
  methods_agree,    ///< `implicit` and `auto` give the answer of `event`
  cuts,             ///< cut, and cut again, the motion goes on as it would have
  same_settings     ///< changes to what is there already change nothing
};
constexpr int kInvariantCount = 13;

const char* to_string(Invariant invariant);

struct Fault {
  Invariant invariant = Invariant::ends;
  std::string detail;
};

}  // namespace vibratory_alignment::hunt
