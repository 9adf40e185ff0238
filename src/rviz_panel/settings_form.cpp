#include "rviz_panel/settings_form.h"

#include <cmath>
#include <utility>

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QSignalBlocker>

#include "rviz_panel/quantity_label.h"

namespace vibratory_alignment {
namespace {

/// With three digits at least, and no exponent.
QString plain(double number) {
  return number < 999.5 ? QString::number(number, 'g', 3) : QString::number(number, 'f', 0);
}

}  // namespace

SettingsForm::SettingsForm(Change change, Refusal refuse, QWidget* parent)
    : QWidget(parent), change_(std::move(change)), refuse_(std::move(refuse)) {
  setObjectName("settings");
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(3);
  grid->setColumnStretch(1, 1);

  enabled_ = new QCheckBox("Excitation");
  enabled_->setObjectName("enabled");
  enabled_->setToolTip("Off: its amplitude is 0, its phase runs on");
  QObject::connect(enabled_, &QCheckBox::clicked, this, [this](bool on) { change_("enabled", on ? 1.0 : 0.0); });
  waveform_ = new QComboBox;
  waveform_->setObjectName("waveform");
  waveform_->addItems({"sine", "square", "triangle", "chirp"});
  waveform_->setToolTip("Waveform of the excitation; chirp only for a scene that gives a sweep");
  QObject::connect(waveform_, qOverload<int>(&QComboBox::activated), this,
                   [this](int index) { change_("waveform", index); });
  grid->addWidget(enabled_, 0, 0);
  grid->addWidget(waveform_, 0, 1);

  add_number(*grid, "Amplitude", "amplitude", &AlignerConfig::amplitude);
  add_number(*grid, "Frequency", "frequency", &AlignerConfig::frequency);
  add_number(*grid, "Phase", "phase", &AlignerConfig::phase);
  add_number(*grid, "Pressing force", "pressing_force", &AlignerConfig::pressing_force);
  add_number(*grid, "Time scale", "time_scale", &AlignerConfig::time_scale);
}

void SettingsForm::add_number(QGridLayout& grid, const char* title, const char* setting, double AlignerConfig::*value) {
  const AlignerConfig &least = AlignerConfig::__getMin__(), &most = AlignerConfig::__getMax__();
  const auto refuse = [this, setting, low = least.*value, high = most.*value](const QString& typed) {
    const QString allowed = QString(": must be a number from %1 to %2").arg(low).arg(high);
    refuse_((QString(setting) + ": " + typed + allowed).toStdString());
  };
  Number number{setting, value, new NumberField(refuse), new QLabel};
  number.field->setObjectName(setting);
  number.field->setRange(least.*value, most.*value);
  number.field->setToolTip(QString("from %1 to %2; Enter puts it in force").arg(least.*value).arg(most.*value));
  number.note->setObjectName(QString(setting) + "_note");
  number.note->setStyleSheet("color: gray");
  QObject::connect(number.field, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
                   [this, setting](double entered) { change_(setting, entered); });
  const int row = grid.rowCount();
  grid.addWidget(new QLabel(title), row, 0);
  grid.addWidget(number.field, row, 1);
  grid.addWidget(number.note, row, 2);
  numbers_.push_back(number);
}

void SettingsForm::show_settings(const AlignerConfig& settings, const SettingUnits& units) {
  {
    const QSignalBlocker blocker(enabled_);
    enabled_->setChecked(settings.enabled);
  }
  {
    const QSignalBlocker blocker(waveform_);
    waveform_->setCurrentIndex(settings.waveform);
  }
  for (const Number& number : numbers_) {
    const double value = settings.*number.value;
    const QString unit = unit_of(number, units);
    if (number.field->suffix() != unit) number.field->setSuffix(unit);
    number.field->show_value(value);
    number.note->setText(note_of(number, value, units));
  }
}

QString SettingsForm::unit_of(const Number& number, const SettingUnits& units) const {
  if (number.setting == "phase") return " rad";
  if (number.setting == "time_scale") return {};
  if (number.setting == "frequency") return units.si ? " Hz" : "";
  const bool moment = number.setting == "amplitude" && units.turns;
  if (units.si) return moment ? " N m" : " N";
  return QString::fromUtf8(moment ? " F\u2081L" : " F\u2081");
}

QString SettingsForm::note_of(const Number& number, double value, const SettingUnits& units) const {
  if (number.setting == "time_scale") {
    if (value == 0.0) return "as fast as it goes";
    if (value == 1.0) return "real time";
    return plain(value < 1.0 ? 1.0 / value : value) + (value < 1.0 ? " times slower" : " times faster");
  }
  if (number.setting == "phase") return QString("%1\u00B0").arg(value * 180.0 / M_PI, 0, 'g', 3);
  if (units.si || !units.has_scales) return {};
  if (number.setting == "frequency") {
    return QString("%1 Hz").arg(value / (2.0 * M_PI * units.time), 0, 'g', 4);
  }
  if (number.setting == "amplitude" && units.turns) {
    return quantity_label(value * units.force * units.length, "N m", true);
  }
  return quantity_label(value * units.force, "N", true);
}

}  // namespace vibratory_alignment
