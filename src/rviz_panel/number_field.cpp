#include "rviz_panel/number_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QLineEdit>
#include <QSignalBlocker>
#include <QWheelEvent>

namespace vibratory_alignment {
namespace {

constexpr int kDecimals = 323;  ///< kept: all that a double has
constexpr int kDigits = 6;      ///< shown
constexpr double kStepFromZero = 0.01;

}  // namespace

NumberField::NumberField(Refusal refuse, QWidget* parent) : QDoubleSpinBox(parent), refuse_(std::move(refuse)) {
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

/// What is typed beside the unit.
QString NumberField::number_in(QString text) const {
  const QString unit = suffix().trimmed();
  text = text.trimmed();
  if (!unit.isEmpty() && text.endsWith(unit)) text.chop(unit.size());
  return text.trimmed();
}

double NumberField::valueFromText(const QString& text) const {
  const QString number = number_in(text);
  return number == textFromValue(value()) ? value() : number.toDouble();
}

QValidator::State NumberField::validate(QString& text, int& /*position*/) const {
  bool is_number = false;
  const double number = number_in(text).toDouble(&is_number);
  return is_number && number >= minimum() && number <= maximum() ? QValidator::Acceptable : QValidator::Intermediate;
}

void NumberField::fixup(QString& text) const {
  refuse_(number_in(text));
  text = textFromValue(value()) + suffix();
}

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
