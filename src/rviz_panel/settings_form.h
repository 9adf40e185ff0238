// The settings of an aligner with their units: what holds in the node, and fields to change it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <vibratory_alignment/AlignerConfig.h>
#include <QWidget>

#include "rviz_panel/number_field.h"

class QCheckBox;
class QComboBox;
class QGridLayout;
class QLabel;

namespace vibratory_alignment {

/// What the numbers of the settings mean.
struct SettingUnits {
  bool si = false;          ///< N, N m and Hz; else F1, F1 L and radians per dimensionless time
  bool turns = false;       ///< the amplitude is that of a moment
  bool has_scales = false;  ///< of a dimensionless scene: the SI values are known
  double force = 1.0;       ///< 1 dimensionless force [N]
  double length = 1.0;      ///< 1 dimensionless length [m]
  double time = 1.0;        ///< 1 dimensionless time [s]
};

class SettingsForm : public QWidget {
 public:
  using Change = std::function<void(const std::string& setting, double value)>;
  using Refusal = std::function<void(const std::string& why)>;

  /// `change` is called when the user changes a value, `refuse` when what is typed is none.
  SettingsForm(Change change, Refusal refuse, QWidget* parent = nullptr);

  /// Shows what is in force; a field in which the user is typing stays as it is.
  void show_settings(const AlignerConfig& settings, const SettingUnits& units);

 private:
  struct Number {
    std::string setting;
    double AlignerConfig::*value;
    NumberField* field;
    QLabel* note;
  };

  void add_number(QGridLayout& grid, const char* title, const char* setting, double AlignerConfig::*value);
  QString unit_of(const Number& number, const SettingUnits& units) const;
  QString note_of(const Number& number, double value, const SettingUnits& units) const;

  Change change_;
  Refusal refuse_;
  QCheckBox* enabled_;
  QComboBox* waveform_;
  std::vector<Number> numbers_;
};

}  // namespace vibratory_alignment
