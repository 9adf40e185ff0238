// The panel in rviz itself, on a virtual screen: rviz/aligner.rviz shows it, it can be clicked, and rviz saves it.
#include <memory>

#include <gtest/gtest.h>

#include <ros/ros.h>
#include <rviz/visualization_frame.h>
#include <QFile>

#include "panel_clicks.h"

namespace vibratory_alignment {
namespace {

TEST(PanelInRvizTest, IsShownClickedAndSaved) {
  const NodeProcess node;
  rviz::VisualizationFrame frame;
  frame.setShowChooseNewMaster(false);
  frame.initialize(RVIZ_FILE);
  frame.show();
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

}  // namespace
}  // namespace vibratory_alignment

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_panel_in_rviz");
  const QApplication application(argc, argv);
  const ros::NodeHandle handle;
  return RUN_ALL_TESTS();
}
