// quantity_text() for a label, which can show what rviz cannot.
#pragma once

#include <QString>

#include "node/quantity_text.h"

namespace vibratory_alignment {

/// "12.3 mm", "4.56 µs"; "12.3" without SI units.
inline QString quantity_label(double value, const char* unit, bool has_unit) {
  QString text = QString::fromStdString(quantity_text(value, unit, has_unit));
  if (has_unit) text.replace(" u", QString::fromUtf8(" \u00B5"));
  return text;
}

}  // namespace vibratory_alignment
