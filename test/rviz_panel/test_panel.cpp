// The panel beside a real node: clicks, typing, other clients, a node that goes and comes back.
#include <cmath>
#include <csignal>
#include <memory>

#include <gtest/gtest.h>

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>
#include <rviz/config.h>
#include <std_srvs/Trigger.h>
#include <QCheckBox>
#include <QComboBox>
#include <QLineEdit>
#include <QProgressBar>

#include "panel_clicks.h"
#include "rviz_panel/aligner_panel.h"
#include "rviz_panel/history_plot.h"
#include "rviz_panel/number_field.h"

namespace vibratory_alignment {
namespace {

std::unique_ptr<NodeProcess> node;

class PanelTest : public testing::Test {
 protected:
  void SetUp() override {
    panel_.resize(340, 760);
    panel_.show();
    ASSERT_TRUE(wait_until([this] { return child<QWidget>(panel_, "settings").isEnabled(); })) << presence();
    bool at_start = false;
    for (int tries = 0; tries < 5 && !at_start; ++tries) {  // the node may know of the panel later than it of the node
      click(panel_, "reset");
      at_start = wait_until([this] { return says("answer", "paused at the start"); }, 3000) &&
                 wait_until([this] { return points() == 1 && says("presence", "paused"); }, 3000);
    }
    ASSERT_TRUE(at_start) << presence();
  }

  bool says(const char* label, const char* words) { return vibratory_alignment::says(panel_, label, words); }
  std::string presence() { return child<QLabel>(panel_, "presence").text().toStdString(); }
  HistoryPlot& plot() { return child<HistoryPlot>(panel_, "plot"); }
  NumberField& number(const char* name) { return child<NumberField>(panel_, name); }
  std::size_t points() { return plot().history().points().size(); }

  void type(const char* field, const char* text) {
    auto* const edit = number(field).findChild<QLineEdit*>();
    edit->setFocus();
    edit->selectAll();
    QTest::keyClicks(edit, text);
  }

  /// A setting as the node has it.
  template <class Value>
  static Value in_node(const std::string& name) {
    Value value{};
    ros::param::get("/aligner/" + name, value);
    return value;
  }

  /// Another client of dynamic_reconfigure.
  static void change_elsewhere(const std::string& name, double value) {
    dynamic_reconfigure::Reconfigure message;
    message.request.config.doubles.resize(1);
    message.request.config.doubles[0].name = name;
    message.request.config.doubles[0].value = value;
    ASSERT_TRUE(ros::service::call("/aligner/set_parameters", message));
  }

  AlignerPanel panel_;
};

/// Calls a service of the node; false: it is refused.
bool trigger(const char* service) {
  std_srvs::Trigger message;
  return ros::service::waitForService(std::string("/aligner/") + service, 15000) &&
         ros::service::call(std::string("/aligner/") + service, message) && message.response.success;
}

TEST(PanelThatStartsLaterTest, ShowsATrialThatStandsStill) {
  ASSERT_TRUE(trigger("reset"));
  ASSERT_TRUE(trigger("step"));
  {
    AlignerPanel panel;
    EXPECT_TRUE(wait_until([&] { return says(panel, "presence", "paused: small"); }));
    EXPECT_TRUE(says(panel, "outcome", "misalignment 400 \u00B5m at 50 \u00B5s"))
        << child<QLabel>(panel, "outcome").text().toStdString();
    EXPECT_EQ(child<HistoryPlot>(panel, "plot").history().points().size(), 1U);
    const auto unit = [&] { return child<NumberField>(panel, "pressing_force").suffix(); };  // comes with the settings
    EXPECT_TRUE(wait_until([&] { return unit() == QString::fromUtf8(" F\u2081"); })) << unit().toStdString();
  }
  for (int i = 0; i < 299; ++i) ASSERT_TRUE(trigger("step"));
  ASSERT_FALSE(trigger("step"));
  AlignerPanel panel;
  EXPECT_TRUE(wait_until([&] { return says(panel, "presence", "ended: small"); }));
  EXPECT_TRUE(says(panel, "outcome", "time limit at 15 ms"));
}

TEST_F(PanelTest, ButtonsRunPauseStepAndResetTheTrial) {
  click(panel_, "start");
  ASSERT_TRUE(wait_until([this] { return says("presence", "running: small") && points() > 20; })) << presence();
  click(panel_, "pause");
  ASSERT_TRUE(wait_until([this] { return says("presence", "paused"); })) << presence();
  const std::size_t paused_at = points();
  click(panel_, "step");
  ASSERT_TRUE(wait_until([&] { return points() == paused_at + 1; }));
  QTest::qWait(300);
  EXPECT_EQ(points(), paused_at + 1);
  click(panel_, "reset");
  ASSERT_TRUE(wait_until([&] { return points() == 1; }));
  EXPECT_EQ(plot().history().points()[0].time, 0.0);
}

TEST_F(PanelTest, ShowsProgressAndOutcome) {
  change_elsewhere("time_scale", 0.0);
  click(panel_, "start");
  ASSERT_TRUE(wait_until([this] { return says("presence", "ended"); })) << presence();
  EXPECT_TRUE(says("outcome", "time limit at 15 ms")) << child<QLabel>(panel_, "outcome").text().toStdString();
  EXPECT_TRUE(says("outcome", "impact mode"));
  // on a busy machine the outcome arrives before the last samples
  const auto last_time = [this] { return plot().history().points().back().time; };
  EXPECT_TRUE(wait_until([&] { return std::abs(last_time() - 0.015) < 1e-12; })) << last_time();
  const HistoryPoint& last = plot().history().points().back();
  // 0.2 at the start, 0.09 is the clearance, both in units of 2 mm
  const double progress = (0.4e-3 - last.misalignment) / (0.4e-3 - 0.18e-3);
  EXPECT_NEAR(child<QProgressBar>(panel_, "progress").value() / 1000.0, progress, 1e-3);
  click(panel_, "start");
  EXPECT_TRUE(wait_until([this] { return says("answer", "the trial has ended; reset it first"); }));
  change_elsewhere("time_scale", 0.005);
}

TEST_F(PanelTest, WhatIsTypedIsInForceInTheNode) {
  type("pressing_force", "0.35");
  QTest::qWait(200);
  EXPECT_NE(in_node<double>("pressing_force"), 0.35) << "not before Enter";
  QTest::keyClick(number("pressing_force").findChild<QLineEdit*>(), Qt::Key_Enter);
  EXPECT_TRUE(wait_until([] { return in_node<double>("pressing_force") == 0.35; }));
  EXPECT_EQ(number("pressing_force").suffix(), QString::fromUtf8(" F\u2081"));
  child<QCheckBox>(panel_, "enabled").click();
  EXPECT_TRUE(wait_until([] { return !in_node<bool>("enabled"); }));
  child<QCheckBox>(panel_, "enabled").click();
  EXPECT_TRUE(wait_until([] { return in_node<bool>("enabled"); }));
  EXPECT_EQ(in_node<double>("pressing_force"), 0.35) << "other settings stay";
}

// The fields show exponents themselves.
TEST_F(PanelTest, NumbersMayHaveAnExponentAndTheirUnit) {
  const auto enter = [this](const char* text) {
    type("pressing_force", text);
    QTest::keyClick(number("pressing_force").findChild<QLineEdit*>(), Qt::Key_Enter);
  };
  const auto becomes = [](double value) {
    return wait_until([value] { return in_node<double>("pressing_force") == value; });
  };
  enter("5e-2");
  EXPECT_TRUE(becomes(0.05)) << in_node<double>("pressing_force");
  enter("1.5E+1");
  EXPECT_TRUE(becomes(15.0)) << in_node<double>("pressing_force");
  enter(" .25 N");  // not its unit
  EXPECT_TRUE(wait_until([this] { return says("answer", "pressing_force: .25 N: must be a number from 0 to 1000"); }));
  enter("4e-10");
  EXPECT_TRUE(becomes(4e-10)) << in_node<double>("pressing_force");
  EXPECT_EQ(number("pressing_force").text(), QString::fromUtf8("4e-10 F\u2081"));
  change_elsewhere("pressing_force", 0.35);
}

TEST_F(PanelTest, WhatIsNoNumberOfTheRangeIsRefusedAsAWhole) {
  const double before = in_node<double>("amplitude");
  for (const char* text : {"0,5", "1.2.3", "nan", "-3", "1e9", "two", "5 5"}) {
    type("amplitude", text);
    QTest::keyClick(number("amplitude").findChild<QLineEdit*>(), Qt::Key_Enter);
    const std::string why = std::string("amplitude: ") + text + ": must be a number from 0 to 1000";
    EXPECT_TRUE(wait_until([&] { return says("answer", why.c_str()); })) << why;
    EXPECT_EQ(number("amplitude").value(), before) << text;
  }
  EXPECT_EQ(in_node<double>("amplitude"), before);
}

// Six digits are shown; Enter without typing changes nothing.
TEST_F(PanelTest, DigitsThatAreNotShownStay) {
  change_elsewhere("frequency", 20.123456789);
  ASSERT_TRUE(wait_until([this] { return number("frequency").value() == 20.123456789; }));
  EXPECT_EQ(number("frequency").text().left(7), "20.1235");
  number("frequency").setFocus();
  QTest::keyClick(number("frequency").findChild<QLineEdit*>(), Qt::Key_Enter);
  QTest::qWait(300);
  EXPECT_EQ(in_node<double>("frequency"), 20.123456789);
}

TEST_F(PanelTest, ANameThatIsNoneLeavesTheNodeAlone) {
  panel_.set_node("left/aligner");
  panel_.set_node("bad name!");
  EXPECT_EQ(child<QLineEdit>(panel_, "node").text(), "/left/aligner");
  EXPECT_TRUE(wait_until([this] { return says("answer", "Node: bad name!: "); }));
  panel_.set_node("/aligner");
}

TEST_F(PanelTest, ShowsWhatOthersChange) {
  change_elsewhere("frequency", 23.5);
  EXPECT_TRUE(wait_until([this] { return number("frequency").value() == 23.5; }));
  EXPECT_EQ(number("frequency").text(), "23.5");
}

TEST_F(PanelTest, SaysInPlainWordsHowSlowItIs) {
  const auto wait_for = [this](const char* words) {
    return wait_until([&] { return says("time_scale_note", words); });
  };
  change_elsewhere("time_scale", 0.0005);
  EXPECT_TRUE(wait_for("2000 times slower")) << child<QLabel>(panel_, "time_scale_note").text().toStdString();
  change_elsewhere("time_scale", 0.0123);
  EXPECT_TRUE(wait_for("81.3 times slower"));
  change_elsewhere("time_scale", 1000.0);
  EXPECT_TRUE(wait_for("1000 times faster"));
  change_elsewhere("time_scale", 0.005);
}

TEST_F(PanelTest, LeavesAFieldAloneInWhichSomeoneTypes) {
  panel_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&panel_));
  type("amplitude", "1.2");
  change_elsewhere("amplitude", 0.9);
  change_elsewhere("frequency", 21.5);
  ASSERT_TRUE(wait_until([this] { return number("frequency").value() == 21.5; }));
  EXPECT_EQ(number("amplitude").findChild<QLineEdit*>()->text().left(3), "1.2");
  QTest::keyClick(number("amplitude").findChild<QLineEdit*>(), Qt::Key_Enter);
  EXPECT_TRUE(wait_until([] { return in_node<double>("amplitude") == 1.2; }));
}

TEST_F(PanelTest, SaysWhatIsRefused) {
  auto& waveform = child<QComboBox>(panel_, "waveform");
  waveform.setCurrentIndex(3);
  Q_EMIT waveform.activated(3);
  EXPECT_TRUE(wait_until([this] { return says("answer", "waveform: 3 is not possible"); }));
  EXPECT_TRUE(wait_until([&] { return waveform.currentText() == "sine"; }));
}

TEST_F(PanelTest, LoadsAnotherScene) {
  auto& scene = child<QComboBox>(panel_, "scene");
  EXPECT_GE(scene.findText("hard/chatter"), 0);
  scene.setCurrentText("gripper_si");
  click(panel_, "load");
  ASSERT_TRUE(wait_until([this] { return says("presence", "paused: gripper_si"); })) << presence();
  EXPECT_TRUE(wait_until([this] { return number("pressing_force").suffix() == " N"; }));
  EXPECT_EQ(number("amplitude").suffix(), " N");
  EXPECT_EQ(points(), 1U);
  scene.setCurrentText(TWISTED_SCENE);
  click(panel_, "load");
  EXPECT_TRUE(wait_until([this] { return number("amplitude").suffix() == " N m"; }));
  EXPECT_EQ(number("amplitude").value(), 0.016) << "the moment of the scene";
  EXPECT_EQ(number("pressing_force").suffix(), " N");
  scene.setCurrentText("gripper_si");
  click(panel_, "load");
  ASSERT_TRUE(wait_until([this] { return says("presence", "paused: gripper_si"); })) << presence();
  scene.setCurrentText("no_such_scene");
  click(panel_, "load");
  EXPECT_TRUE(wait_until([this] { return says("answer", "no_such_scene"); }));
  EXPECT_TRUE(says("presence", "gripper_si")) << "the one before stays";
  scene.setCurrentText(SMALL_SCENE);
  click(panel_, "load");
  ASSERT_TRUE(wait_until([this] { return says("presence", "paused: small"); })) << presence();
  click(panel_, "start");
  EXPECT_TRUE(wait_until([this] { return says("presence", "running: small"); })) << presence();
}

TEST_F(PanelTest, TellsWhenATrialEndedThatWentOnAfterAlignment) {
  auto& scene = child<QComboBox>(panel_, "scene");
  scene.setCurrentText("insertion");
  click(panel_, "load");
  ASSERT_TRUE(wait_until([this] { return says("presence", "paused: insertion"); })) << presence();
  change_elsewhere("time_scale", 0.0);
  click(panel_, "start");
  ASSERT_TRUE(wait_until([this] { return says("presence", "ended"); })) << presence();
  EXPECT_TRUE(wait_until([this] { return says("outcome", "inserted at") && says("outcome", ", aligned after"); }))
      << child<QLabel>(panel_, "outcome").text().toStdString();
  change_elsewhere("time_scale", 0.005);
  scene.setCurrentText(SMALL_SCENE);
  click(panel_, "load");
  EXPECT_TRUE(wait_until([this] { return says("presence", "paused: small"); })) << presence();
}

TEST_F(PanelTest, TheNodeHasCommandsInTheOrderInWhichTheyWereGiven) {
  auto& scene = child<QComboBox>(panel_, "scene");
  ::kill(static_cast<pid_t>(node->pid()), SIGSTOP);
  click(panel_, "step");  // under way until the node goes on; all others wait
  QTest::qWait(100);
  scene.setCurrentText("gripper_si");
  click(panel_, "load");
  type("amplitude", "6.5");
  QTest::keyClick(number("amplitude").findChild<QLineEdit*>(), Qt::Key_Enter);
  ::kill(static_cast<pid_t>(node->pid()), SIGCONT);
  ASSERT_TRUE(wait_until([this] { return says("presence", "paused: gripper_si"); })) << presence();
  EXPECT_TRUE(wait_until([] { return in_node<double>("amplitude") == 6.5; })) << in_node<double>("amplitude");
  scene.setCurrentText(SMALL_SCENE);
  click(panel_, "load");
  EXPECT_TRUE(wait_until([this] { return says("presence", "paused: small"); })) << presence();
}

TEST_F(PanelTest, ANodeThatHangsDoesNotHoldUpThePanel) {
  ASSERT_FALSE(wait_until([this] { return says("presence", "does not answer"); }, 5000)) << "at a standstill";
  ::kill(static_cast<pid_t>(node->pid()), SIGSTOP);
  EXPECT_TRUE(wait_until([this] { return says("presence", "does not answer: small"); })) << presence();
  click(panel_, "start");  // would wait here for ever
  EXPECT_TRUE(wait_until([this] { return says("answer", "/aligner does not answer"); }));
  ::kill(static_cast<pid_t>(node->pid()), SIGCONT);
  click(panel_, "reset");
  EXPECT_TRUE(wait_until([this] { return says("answer", "paused at the start"); }));
  EXPECT_TRUE(wait_until([this] { return says("presence", "paused: small"); })) << presence();
}

TEST_F(PanelTest, ShowsNothingThatOthersPublishUnderTheNameOfTheNode) {
  ros::NodeHandle handle;
  const ros::Publisher other = handle.advertise<AlignerState>("/aligner/state", 1);
  ASSERT_TRUE(wait_until([&] { return other.getNumSubscribers() > 0; }));
  AlignerState state;
  state.scene = "of a bag";
  state.header.stamp = ros::Time::now();
  other.publish(state);
  QTest::qWait(500);
  EXPECT_TRUE(says("presence", "paused: small")) << presence();
  EXPECT_EQ(points(), 1U);
}

TEST_F(PanelTest, SaysWhenTheNodeIsGoneAndFindsItAgain) {
  node->kill();
  ASSERT_TRUE(wait_until([this] { return says("presence", "no node /aligner"); })) << presence();
  EXPECT_FALSE(child<QWidget>(panel_, "controls").isEnabled());
  EXPECT_FALSE(child<QWidget>(panel_, "settings").isEnabled());
  node->start();
  ASSERT_TRUE(wait_until([this] { return child<QWidget>(panel_, "settings").isEnabled(); })) << presence();
  click(panel_, "start");
  EXPECT_TRUE(wait_until([this] { return says("presence", "running: small"); })) << presence();
  EXPECT_TRUE(wait_until([this] { return points() > 20; }));
}

TEST_F(PanelTest, KeepsItsSettingsInTheFileOfRviz) {
  child<QComboBox>(panel_, "scene").setCurrentText("hard/chatter");
  child<QPushButton>(panel_, "show_plot").setChecked(false);
  panel_.set_node("left/aligner/");
  EXPECT_TRUE(wait_until([this] { return says("presence", "no node /left/aligner"); })) << presence();
  rviz::Config config;
  panel_.save(config);

  AlignerPanel other;
  other.load(config);
  EXPECT_EQ(child<QLineEdit>(other, "node").text(), "/left/aligner");
  EXPECT_EQ(child<QComboBox>(other, "scene").currentText(), "hard/chatter");
  EXPECT_FALSE(child<QPushButton>(other, "show_plot").isChecked());
  EXPECT_TRUE(child<QPushButton>(other, "show_settings").isChecked());
  EXPECT_TRUE(child<QWidget>(other, "plot").isHidden());
}

}  // namespace
}  // namespace vibratory_alignment

int main(int argc, char** argv) {
  qputenv("QT_QPA_PLATFORM", "offscreen");
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_panel");
  const QApplication application(argc, argv);
  const ros::NodeHandle handle;  // ROS goes on between two panels
  vibratory_alignment::node = std::make_unique<vibratory_alignment::NodeProcess>();
  const int status = RUN_ALL_TESTS();
  vibratory_alignment::node.reset();
  return status;
}
