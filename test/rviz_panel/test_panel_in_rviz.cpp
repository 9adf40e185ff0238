// The panel in rviz itself, on a virtual screen: rviz/aligner.rviz shows it, it can be clicked, and rviz saves it.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <ros/ros.h>
#include <rviz/properties/property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>
#include <QComboBox>
#include <QFile>

#include "panel_clicks.h"

namespace vibratory_alignment {
namespace {

/// One rviz for all tests: a process can have no second one.
class PanelInRvizTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    node_ = std::make_unique<NodeProcess>();
    frame_ = std::make_unique<rviz::VisualizationFrame>();
    frame_->setShowChooseNewMaster(false);
    frame_->initialize(RVIZ_FILE);
    frame_->show();
  }
  static void TearDownTestSuite() {
    frame_.reset();
    node_.reset();
  }

  static std::unique_ptr<NodeProcess> node_;
  static std::unique_ptr<rviz::VisualizationFrame> frame_;
};

std::unique_ptr<NodeProcess> PanelInRvizTest::node_;
std::unique_ptr<rviz::VisualizationFrame> PanelInRvizTest::frame_;

TEST_F(PanelInRvizTest, IsShownClickedAndSaved) {
  rviz::VisualizationFrame& frame = *frame_;
  ASSERT_TRUE(wait_until([&] { return frame.findChild<QPushButton*>("start") != nullptr; })) << "rviz loads the panel";
  EXPECT_TRUE(child<QPushButton>(frame, "start").isVisible());
  ASSERT_TRUE(wait_until([&] { return child<QWidget>(frame, "settings").isEnabled(); }));
  click(frame, "start");
  EXPECT_TRUE(wait_until([&] { return says(frame, "presence", "running: small"); }));

  const QString saved = QString::fromStdString(testing::TempDir()) + "panel_in_rviz.rviz";
  ASSERT_TRUE(frame.saveDisplayConfig(saved));
  QFile file(saved);
  ASSERT_TRUE(file.open(QIODevice::ReadOnly));
  const QByteArray text = file.readAll();
  EXPECT_TRUE(text.contains("Class: vibratory_alignment/AlignerPanel"));
  EXPECT_TRUE(text.contains("Node: /aligner"));
  file.remove();
}

TEST_F(PanelInRvizTest, ViewFollowsTheSizeOfTheSlot) {
  rviz::VisualizationFrame& frame = *frame_;
  rviz::ViewController& view = *frame.getManager()->getViewManager()->getCurrent();
  const auto value = [&](const char* name) { return view.subProp(name)->getValue().toDouble(); };
  const double distance = value("Distance"), clip = value("Near Clip Distance");
  ASSERT_TRUE(wait_until([&] { return says(frame, "presence", ": small"); }));
  QTest::qWait(500);
  EXPECT_EQ(value("Distance"), distance) << "the first scene is what it was made for";
  const auto load = [&](const char* scene) {
    child<QComboBox>(frame, "scene").setCurrentText(scene);
    click(frame, "load");
  };
  load("gripper_si");
  const double ratio = 5.25e-3 / 1.58e-3;  // of the slots' widths
  EXPECT_TRUE(wait_until([&] { return std::abs(value("Distance") / distance - ratio) < 1e-4; })) << value("Distance");
  EXPECT_NEAR(value("Near Clip Distance") / clip, ratio, 1e-4);
  load(SMALL_SCENE);
  EXPECT_TRUE(wait_until([&] { return std::abs(value("Distance") / distance - 1.0) < 1e-4; })) << value("Distance");
  const double far = 2.0;
  view.subProp("Distance")->setValue(far);
  view.subProp("Target Frame")->setValue("world");
  load("gripper_si");
  ASSERT_TRUE(wait_until([&] { return says(frame, "presence", "paused: gripper_si"); }));
  QTest::qWait(500);
  EXPECT_EQ(value("Distance"), far) << "a view of something else is somebody's own";
}

}  // namespace
}  // namespace vibratory_alignment

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_panel_in_rviz");
  const QApplication application(argc, argv);
  const ros::NodeHandle handle;
  return RUN_ALL_TESTS();
}
