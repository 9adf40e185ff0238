#include "trial/outcome.h"

namespace vibratory_alignment {

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::running: return "running";
    case Outcome::aligned: return "aligned";
    case Outcome::inserted: return "inserted";
    case Outcome::jammed: return "jammed";
    case Outcome::stalled: return "stalled";
    case Outcome::time_limit: return "time_limit";
    case Outcome::failed: break;
  }
  return "failed";
}

const char* to_string(Mode mode) {
  switch (mode) {
    case Mode::impact: return "impact";
    case Mode::nonimpact: return "nonimpact";
    case Mode::mixed: return "mixed";
    case Mode::none: break;
  }
  return "none";
}

Spot spot_of(Site site) {
  switch (site) {
    case Site::a1: return Spot::a1;
    case Site::a2: return Spot::a2;
    case Site::b1:
    case Site::b1_floor: return Spot::b1;
    default: return Spot::b2;
  }
}

const char* to_string(Spot spot) {
  static constexpr const char* kNames[kSpotCount] = {"a1", "a2", "b1", "b2"};
  return kNames[static_cast<int>(spot)];
}

}  // namespace vibratory_alignment
