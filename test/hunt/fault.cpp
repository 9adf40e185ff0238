#include "fault.h"

namespace vibratory_alignment::hunt {

const char* to_string(Invariant invariant) {
  switch (invariant) {
    case Invariant::ends: return "ends";
    case Invariant::finite: return "finite";
    case Invariant::base_pushes: return "base_pushes";
    case Invariant::friction_cone: return "friction_cone";
    case Invariant::friction_brakes: return "friction_brakes";
    case Invariant::no_passing: return "no_passing";
    case Invariant::ledger_closes: return "ledger_closes";
    case Invariant::losses: return "losses";
    case Invariant::mirror: return "mirror";
    case Invariant::output_rate: return "output_rate";
    case Invariant::methods_agree: return "methods_agree";
    case Invariant::cuts: return "cuts";
    case Invariant::same_settings: break;
  }
  return "same_settings";
}

}  // namespace vibratory_alignment::hunt
