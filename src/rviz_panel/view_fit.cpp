#include "rviz_panel/view_fit.h"

#include <rviz/display_group.h>
#include <rviz/properties/property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <tf2_ros/buffer.h>

namespace vibratory_alignment {
namespace {

constexpr char kSlot[] = "slot", kEdge[] = "edge_a1", kOrbit[] = "rviz/Orbit";

/// Half the width of the slot [m]; 0 while it is not known.
double half_width_of(rviz::VisualizationManager& manager, const std::string& slot) {
  const std::string edge = slot.substr(0, slot.size() - (sizeof kSlot - 1)) + kEdge;
  try {
    return manager.getTF2BufferPtr()->lookupTransform(slot, edge, ros::Time()).transform.translation.x;
  } catch (const tf2::TransformException&) {
    return 0.0;
  }
}

void scale(rviz::Property& length, double ratio) { length.setValue(length.getValue().toDouble() * ratio); }

void scale_view(rviz::ViewController& view, double ratio) {
  for (const char* length : {"Distance", "Focal Shape Size", "Near Clip Distance"}) scale(*view.subProp(length), ratio);
  for (const char* axis : {"X", "Y", "Z"}) scale(*view.subProp("Focal Point")->subProp(axis), ratio);
}

void scale_axes(rviz::DisplayGroup& group, double ratio) {
  for (int i = 0; i < group.numDisplays(); ++i) {
    rviz::Display& display = *group.getDisplayAt(i);
    if (display.getClassId() == "rviz/TF") scale(*display.subProp("Marker Scale"), ratio);
  }
}

}  // namespace

void ViewFit::follow(rviz::VisualizationManager& manager, const std::string& slot) {
  const double now = half_width_of(manager, slot);
  if (!(now > 0.0)) return;
  const double ratio = slot == slot_ && half_width_ > 0.0 ? now / half_width_ : 1.0;
  slot_ = slot;
  half_width_ = now;
  if (ratio == 1.0) return;
  rviz::ViewController* const view = manager.getViewManager()->getCurrent();
  if (!view || view->getClassId() != kOrbit) return;
  if (view->subProp("Target Frame")->getValue().toString().toStdString() != slot) return;
  scale_view(*view, ratio);
  scale_axes(*manager.getRootDisplayGroup(), ratio);
}

}  // namespace vibratory_alignment
