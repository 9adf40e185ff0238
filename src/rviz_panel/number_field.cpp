#include "rviz_panel/number_field.h"

#include <algorithm>
#include <cmath>

#include <QLineEdit>
#include <QSignalBlocker>
#include <QWheelEvent>

namespace vibratory_alignment {
namespace {

constexpr int kDecimals = 9;  ///< kept, not shown
constexpr int kDigits = 6;    ///< shown
constexpr double kStepFromZero = 0.01;

}  // namespace

NumberField::NumberField(QWidget* parent) : QDoubleSpinBox(parent) {
  setLocale(QLocale::c());
  setDecimals(kDecimals);
  setKeyboardTracking(false);
  setFocusPolicy(Qt::StrongFocus);
}

void NumberField::show_value(double value) {
  if (hasFocus() && lineEdit()->isModified()) return;
  const QSignalBlocker blocker(this);
  setRange(std::min(minimum(), value), std::max(maximum(), value));
  setValue(value);
}

QString NumberField::textFromValue(double value) const { return QString::number(value, 'g', kDigits); }

/// A step is a tenth of the leading digit's.
void NumberField::stepBy(int steps) {
  const double size = std::abs(value());
  const double step = size > 0.0 ? std::pow(10.0, std::floor(std::log10(size) + 1e-9) - 1.0) : kStepFromZero;
  setValue(value() + steps * step);
}

void NumberField::wheelEvent(QWheelEvent* event) {
  if (hasFocus()) {
    QDoubleSpinBox::wheelEvent(event);
  } else {
    event->ignore();
  }
}

}  // namespace vibratory_alignment
