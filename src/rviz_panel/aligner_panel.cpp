#include "rviz_panel/aligner_panel.h"

#include <algorithm>
#include <cmath>

#include <ros/names.h>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QStyle>
#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

#include "rviz_panel/history_plot.h"
#include "rviz_panel/quantity_label.h"
#include "rviz_panel/scene_list.h"
#include "rviz_panel/settings_form.h"

namespace vibratory_alignment {
namespace {

constexpr int kRefresh = 50;  ///< [ms]
constexpr int kProgressSteps = 1000;
constexpr int kLongestAnswer = 160;  ///< characters; the rest is in the tool tip
constexpr char kDefaultNode[] = "/aligner";
constexpr char kGreen[] = "#1a7f37", kAmber[] = "#9a6700", kRed[] = "#b42318", kGrey[] = "#6b7280";

QString coloured(const QString& text, const char* color) {
  return QString("<span style='color:%1'>%2</span>").arg(color, text.toHtmlEscaped());
}

void set_colour(QLabel& lamp, const char* color) {
  const QString style = QString("background:%1; border-radius:6px").arg(color);
  if (lamp.styleSheet() != style) lamp.setStyleSheet(style);
}

const char* colour_of(const std::string& outcome) {
  if (outcome == "aligned" || outcome == "inserted") return kGreen;
  return outcome == "failed" ? kRed : kAmber;
}

/// "aligned after 16.4 ms, impact mode, 15 impacts, at most 36.4 N"; "inserted at 25 ms, aligned after 20.3 ms, ..."
QString words_of(const AlignerResult& result) {
  QString words = QString::fromStdString(result.outcome).replace('_', ' ');
  if (result.outcome == "failed") return words + ": " + QString::fromStdString(result.failure);
  if (result.outcome != "aligned") words += " at " + quantity_label(result.time, "s", result.has_scales);
  if (!std::isnan(result.duration))
    words += (result.outcome == "aligned" ? "" : ", aligned") +
             (" after " + quantity_label(result.duration, "s", result.has_scales));
  if (result.mode != "none") words += ", " + QString::fromStdString(result.mode) + " mode";
  unsigned impacts = 0;
  for (const unsigned count : result.impacts) impacts += count;
  words += QString(", %1 impacts").arg(impacts);
  const double peak = *std::max_element(result.peak_force.begin(), result.peak_force.end());
  return words + ", at most " + quantity_label(peak, "N", result.has_scales);
}

QString words_of(const AlignerState& state) {
  return "misalignment " + quantity_label(state.misalignment, "m", state.has_scales) + " at " +
         quantity_label(state.time, "s", state.has_scales);
}

}  // namespace

AlignerPanel::AlignerPanel(QWidget* parent) : rviz::Panel(parent) {
  controls_ = new QWidget;
  controls_->setObjectName("controls");
  auto* const inner = new QVBoxLayout(controls_);
  inner->setContentsMargins(0, 0, 0, 0);
  inner->addWidget(make_scene_row());
  inner->addWidget(make_buttons());

  progress_ = new QProgressBar;
  progress_->setObjectName("progress");
  progress_->setRange(0, kProgressSteps);
  progress_->setToolTip("How much of the misalignment is gone that keeps the part out of the slot");
  outcome_ = new QLabel;
  outcome_->setObjectName("outcome");
  outcome_->setWordWrap(true);
  answer_ = new QLabel;
  answer_->setObjectName("answer");
  answer_->setWordWrap(true);
  plot_ = new HistoryPlot;
  settings_ = new SettingsForm([this](const std::string& setting, double value) { link_->change(setting, value); },
                               [this](const std::string& why) { link_->refuse(why); });

  auto* const body = new QWidget;
  auto* const column = new QVBoxLayout(body);
  column->addWidget(make_head());
  column->addWidget(controls_);
  column->addWidget(answer_);
  column->addWidget(progress_);
  column->addWidget(outcome_);
  column->addWidget(fold_plot_ = make_fold("Plot", "show_plot", plot_));
  column->addWidget(plot_, 1);
  column->addWidget(fold_settings_ = make_fold("Settings", "show_settings", settings_));
  column->addWidget(settings_);
  column->addStretch(0);
  auto* const area = new QScrollArea;
  area->setWidget(body);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setMinimumWidth(body->minimumSizeHint().width() + style()->pixelMetric(QStyle::PM_ScrollBarExtent));
  auto* const all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(area);

  set_node(kDefaultNode);
  QObject::connect(&timer_, &QTimer::timeout, this, [this] { refresh(); });
  timer_.start(kRefresh);
}

AlignerPanel::~AlignerPanel() = default;

QWidget* AlignerPanel::make_head() {
  auto* const head = new QWidget;
  auto* const grid = new QGridLayout(head);
  grid->setContentsMargins(0, 0, 0, 0);
  lamp_ = new QLabel;
  lamp_->setFixedSize(12, 12);
  node_ = new QLineEdit;
  node_->setObjectName("node");
  node_->setToolTip("Name of the aligner_node that this panel is for");
  QObject::connect(node_, &QLineEdit::editingFinished, this, [this] {
    if (node_->text().toStdString() == link_->node()) return;
    set_node(node_->text());
    Q_EMIT configChanged();
  });
  presence_ = new QLabel;
  presence_->setObjectName("presence");
  presence_->setWordWrap(true);
  grid->addWidget(new QLabel("Node"), 0, 0);
  grid->addWidget(node_, 0, 1, 1, 2);
  grid->addWidget(lamp_, 1, 0, Qt::AlignHCenter);
  grid->addWidget(presence_, 1, 1, 1, 2);
  grid->setColumnStretch(1, 1);
  return head;
}

QWidget* AlignerPanel::make_scene_row() {
  auto* const row = new QWidget;
  auto* const line = new QHBoxLayout(row);
  line->setContentsMargins(0, 0, 0, 0);
  scene_ = new QComboBox;
  scene_->setObjectName("scene");
  scene_->setEditable(true);
  scene_->addItems(shipped_scenes());
  scene_->setCurrentText("fig2");
  scene_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  scene_->setToolTip("A scene that comes with the package, or the path of a scene file where the node runs");
  QObject::connect(scene_, &QComboBox::currentTextChanged, this, [this] { Q_EMIT configChanged(); });
  auto* const load = new QPushButton("Load");
  load->setObjectName("load");
  load->setToolTip("Puts this scene in the place of the present one, at its start");
  QObject::connect(load, &QPushButton::clicked, this,
                   [this] { link_->load_scene(scene_->currentText().trimmed().toStdString()); });
  line->addWidget(new QLabel("Scene"));
  line->addWidget(scene_, 1);
  line->addWidget(load);
  return row;
}

QWidget* AlignerPanel::make_buttons() {
  auto* const row = new QWidget;
  auto* const line = new QHBoxLayout(row);
  line->setContentsMargins(0, 0, 0, 0);
  line->setSpacing(4);
  line->addWidget(make_button("Start", "start", "Runs the trial, or goes on with it"));
  line->addWidget(make_button("Pause", "pause", "Stops simulated time"));
  line->addWidget(make_button("Step", "step", "Pauses, and goes on by one sample"));
  line->addWidget(make_button("Reset", "reset", "Back to the start, with the settings as they are"));
  return row;
}

QPushButton* AlignerPanel::make_button(const char* title, const char* service, const char* tip) {
  auto* const button = new QPushButton(title);
  button->setObjectName(service);
  button->setToolTip(tip);
  button->setMinimumWidth(0);
  QObject::connect(button, &QPushButton::clicked, this, [this, service] { link_->trigger(service); });
  return button;
}

/// A heading that shows and hides what is below it.
QPushButton* AlignerPanel::make_fold(const char* title, const char* name, QWidget* body) {
  auto* const fold = new QPushButton;
  fold->setObjectName(name);
  fold->setCheckable(true);
  fold->setFlat(true);
  fold->setStyleSheet("text-align: left; font-weight: bold; padding: 2px");
  const auto follow = [fold, body, title](bool open) {
    fold->setText(QString::fromUtf8(open ? "\u25BE " : "\u25B8 ") + title);
    body->setVisible(open);
  };
  QObject::connect(fold, &QPushButton::toggled, this, [this, follow](bool open) {
    follow(open);
    Q_EMIT configChanged();
  });
  fold->setChecked(true);
  follow(true);
  return fold;
}

void AlignerPanel::set_node(const QString& name) {
  QString full = name.trimmed();
  while (full.startsWith('/')) full.remove(0, 1);
  while (full.endsWith('/')) full.chop(1);
  std::string problem;
  if (full.isEmpty() || !ros::names::validate("/" + full.toStdString(), problem)) {
    if (link_) {
      node_->setText(QString::fromStdString(link_->node()));
      link_->refuse("Node: " + name.toStdString() + ": " + (full.isEmpty() ? "must be a name" : problem));
      return;
    }
    full = kDefaultNode + 1;
  }
  full = "/" + full;
  node_->setText(full);
  if (link_ && link_->node() == full.toStdString()) return;
  link_.reset();
  link_ = std::make_unique<AlignerLink>(full.toStdString());
  plot_->clear();
  refresh();
}

void AlignerPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString text;
  bool open = true;
  if (config.mapGetString("Node", &text)) set_node(text);
  if (config.mapGetString("Scene", &text)) scene_->setCurrentText(text);
  if (config.mapGetBool("Show Plot", &open)) fold_plot_->setChecked(open);
  if (config.mapGetBool("Show Settings", &open)) fold_settings_->setChecked(open);
}

void AlignerPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Node", QString::fromStdString(link_->node()));
  config.mapSetValue("Scene", scene_->currentText());
  config.mapSetValue("Show Plot", fold_plot_->isChecked());
  config.mapSetValue("Show Settings", fold_settings_->isChecked());
}

void AlignerPanel::refresh() {
  const AlignerLink::Status status = link_->status();
  for (const AlignerState& state : link_->take_samples()) {
    plot_->set_units(state.has_scales);
    plot_->add(
        {state.time, state.misalignment, state.peak_force[AlignerState::A1], state.peak_force[AlignerState::A2]});
  }
  show_presence(status);
  show_progress(status);
  show_settings(status);
  if (in_rviz_ && status.state) view_fit_.follow(*vis_manager_, status.state->header.frame_id);
}

void AlignerPanel::show_presence(const AlignerLink::Status& status) {
  using Presence = AlignerLink::Presence;
  const bool present = status.presence == Presence::present;
  const QString node = QString::fromStdString(link_->node());
  QString words;
  if (status.presence == Presence::sought) words = "looking for " + node;
  if (status.presence == Presence::no_master) words = "no ROS master answers";
  if (status.presence == Presence::absent) words = "no node " + node + ": start one with trial.launch";
  if (present) {
    words = status.silent    ? "does not answer"
            : status.result  ? "ended"
            : status.running ? "running"
            : status.state   ? "paused"
                             : "waiting";
    if (status.state) words += ": " + QString::fromStdString(status.state->scene);
  } else if (status.presence == Presence::absent && status.running) {
    words += " (what is shown is being replayed)";
  }
  set_colour(*lamp_, !present ? kRed : status.silent ? kAmber : status.running ? kGreen : kGrey);
  if (presence_->text() != words) presence_->setText(words);
  if (controls_->isEnabled() != present) controls_->setEnabled(present);

  const QString whole = QString::fromStdString(status.answer);
  const QString brief =
      whole.size() > kLongestAnswer ? whole.left(kLongestAnswer) + QString::fromUtf8(" \u2026") : whole;
  const bool is_told = !status.answer.empty() && (present || status.refused);
  const QString answer = is_told ? coloured(brief, status.refused ? kRed : kGrey) : QString();
  if (answer_->text() != answer) answer_->setText(answer);
  if (answer_->toolTip() != whole) answer_->setToolTip(whole);
  answer_->setVisible(is_told);
}

void AlignerPanel::show_progress(const AlignerLink::Status& status) {
  double progress = status.state ? std::clamp(status.state->progress, 0.0, 1.0) : 0.0;
  const bool arrived = status.result && colour_of(status.result->outcome) == kGreen;
  if (arrived) progress = 1.0;
  progress_->setValue(static_cast<int>(std::lround(progress * kProgressSteps)));
  QString words = status.result  ? coloured(words_of(*status.result), colour_of(status.result->outcome))
                  : status.state ? words_of(*status.state).toHtmlEscaped()
                                 : QString();
  if (status.result && status.result->force_limit_exceeded) words += coloured("; exceeds the force limit", kRed);
  if (outcome_->text() != words) outcome_->setText(words);
}

void AlignerPanel::show_settings(const AlignerLink::Status& status) {
  const bool usable = status.presence == AlignerLink::Presence::present && status.settings;
  if (settings_->isEnabled() != usable) settings_->setEnabled(usable);
  if (!status.settings || status.changing) return;
  SettingUnits units;
  if (status.state) {
    const AlignerState& state = *status.state;
    units.si = state.units == "si";
    units.turns = state.excites_tilt != 0;
    units.has_scales = state.has_scales != 0;
    units.force = state.force_scale;
    units.length = state.length_scale;
    units.time = state.time_scale;
  }
  settings_->show_settings(*status.settings, units);
}

}  // namespace vibratory_alignment

PLUGINLIB_EXPORT_CLASS(vibratory_alignment::AlignerPanel, rviz::Panel)
