// A field for a number over many sizes: as many digits as it has, and steps in proportion to it.
#pragma once

#include <QDoubleSpinBox>

namespace vibratory_alignment {

class NumberField : public QDoubleSpinBox {
 public:
  explicit NumberField(QWidget* parent = nullptr);

  /// Shows a value that has come from elsewhere, unless the user is typing; tells nobody. A value beyond the range
  /// widens it.
  void show_value(double value);

  QString textFromValue(double value) const override;
  void stepBy(int steps) override;

 protected:
  /// Scrolling over a form must not change what is in force.
  void wheelEvent(QWheelEvent* event) override;
};

}  // namespace vibratory_alignment
