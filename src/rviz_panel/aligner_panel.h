// The rviz panel of an aligner: runs its trial, changes its settings, and shows how far it is and what came of it.
//
// All that can wait for the node is in AlignerLink; a timer brings what is new from there to the widgets.
#pragma once

#include <memory>
#include <string>

#include <rviz/panel.h>
#include <QTimer>

#include "rviz_panel/aligner_link.h"
#include "rviz_panel/view_fit.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;

namespace vibratory_alignment {

class HistoryPlot;
class SettingsForm;

class AlignerPanel : public rviz::Panel {
 public:
  explicit AlignerPanel(QWidget* parent = nullptr);
  ~AlignerPanel() override;

  void onInitialize() override { in_rviz_ = true; }

  /// Keys in the .rviz file: Node, Scene (chosen in the list), Show Plot, Show Settings.
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

  /// Looks at another aligner.
  void set_node(const QString& name);

 private:
  QWidget* make_head();
  QWidget* make_scene_row();
  QWidget* make_buttons();
  QPushButton* make_button(const char* title, const char* service, const char* tip);
  QPushButton* make_fold(const char* title, const char* name, QWidget* body);
  void refresh();
  void show_presence(const AlignerLink::Status& status);
  void show_progress(const AlignerLink::Status& status);
  void show_settings(const AlignerLink::Status& status);

  std::unique_ptr<AlignerLink> link_;
  bool in_rviz_ = false;  ///< else vis_manager_ has no value
  ViewFit view_fit_;
  QTimer timer_;
  QLabel *lamp_, *presence_, *outcome_, *answer_;
  QLineEdit* node_;
  QComboBox* scene_;
  QPushButton *fold_plot_, *fold_settings_;
  QProgressBar* progress_;
  HistoryPlot* plot_;
  SettingsForm* settings_;
  QWidget* controls_;  ///< what is of use while the node is there
};

}  // namespace vibratory_alignment
