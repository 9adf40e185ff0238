#include "node/quantity_text.h"

#include <cmath>
#include <cstdio>

namespace vibratory_alignment {

std::string quantity_text(double value, const char* unit, bool has_unit) {
  char text[64];
  const char* prefix = "";
  const double size = std::abs(value);
  if (has_unit && size > 0.0 && size < 0.9995e-3) {
    prefix = "u";
    value *= 1e6;
  } else if (has_unit && size > 0.0 && size < 0.9995) {
    prefix = "m";
    value *= 1e3;
  }
  std::snprintf(text, sizeof text, has_unit ? "%.3g %s%s" : "%.3g", value, prefix, unit);
  return text;
}

}  // namespace vibratory_alignment
