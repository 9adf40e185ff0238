// A field for a number over many sizes: as many digits as it has, and steps in proportion to it. What is typed need not
// be a number, and is refused as a whole then: no key is swallowed, by which 0,5 would become 5.
#pragma once

#include <functional>

#include <QDoubleSpinBox>

namespace vibratory_alignment {

class NumberField : public QDoubleSpinBox {
 public:
  using Refusal = std::function<void(const QString& typed)>;

  /// `refuse` is called when what has been typed is no number, or none of the range: the one before is back.
  explicit NumberField(Refusal refuse, QWidget* parent = nullptr);

  /// Shows a value that has come from elsewhere, unless the user is typing; tells nobody. A value beyond the range
  /// widens it.
  void show_value(double value);

  /// With six digits, and an exponent where it is shorter.
  QString textFromValue(double value) const override;
  /// The value itself if the text is what is shown of it.
  double valueFromText(const QString& text) const override;
  QValidator::State validate(QString& text, int& position) const override;
  void fixup(QString& text) const override;
  void stepBy(int steps) override;

 protected:
  /// Scrolling over a form must not change what is in force.
  void wheelEvent(QWheelEvent* event) override;

 private:
  QString number_in(QString text) const;

  Refusal refuse_;
};

}  // namespace vibratory_alignment
