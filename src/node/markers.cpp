#include "node/markers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "node/messages.h"

namespace vibratory_alignment {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::size_t kTracePoints = 512;  ///< when the trace is full, every other point is dropped
constexpr double kPeakFading = 0.93;       ///< of a peak's length from sample to sample
constexpr double kThickness = 1.2;         ///< of the bodies behind the plane, in half part widths
constexpr double kGap = 0.02;              ///< from the plane of motion to the bodies
constexpr double kLongestArrow = 1.5;
constexpr double kLeastForceScale = 2.0;   ///< dimensionless force that draws the longest arrow at least

struct Colour {
  float red, green, blue, alpha;
};
constexpr Colour kBaseColour{0.45F, 0.50F, 0.56F, 1.0F};
constexpr Colour kFloorColour{0.36F, 0.40F, 0.45F, 1.0F};
constexpr Colour kPartColour{0.93F, 0.64F, 0.16F, 1.0F};
constexpr Colour kCentreColour{0.10F, 0.10F, 0.12F, 1.0F};
constexpr Colour kTraceColour{0.05F, 0.25F, 0.65F, 1.0F};
constexpr Colour kContactColour{0.95F, 0.95F, 0.20F, 1.0F};
constexpr Colour kReactionColour{0.85F, 0.08F, 0.10F, 1.0F};
constexpr Colour kPeakColour{0.85F, 0.20F, 0.55F, 0.45F};
constexpr Colour kTextColour{0.08F, 0.09F, 0.12F, 1.0F};

void paint(Marker& marker, const Colour& colour) {
  marker.color.r = colour.red;
  marker.color.g = colour.green;
  marker.color.b = colour.blue;
  marker.color.a = colour.alpha;
}

geometry_msgs::Point point(double x, double y, double unit) {
  geometry_msgs::Point point;
  point.x = x * unit;
  point.z = y * unit;
  return point;
}

/// "12.3 mm"; without scales "12.3".
std::string with_unit(double value, const char* unit, bool has_scales) {
  char text[64];
  if (!has_scales) {
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
  }
  const double size = std::abs(value);
  const char* prefix = "";
  if (size > 0.0 && size < 0.9995e-3) {
    prefix = "u";
    value *= 1e6;
  } else if (size > 0.0 && size < 0.9995) {
    prefix = "m";
    value *= 1e3;
  }
  std::snprintf(text, sizeof text, "%.3g %s%s", value, prefix, unit);
  return text;
}

}  // namespace

Markers::Markers(const Scene& scene, const Frames& frames)
    : frames_(frames),
      has_scales_(scene.scales.has_value()),
      units_(ros_units(scene)),
      part_(scene.part),
      slot_half_width_(scene.slot_half_width()),
      slot_depth_(scene.slot.depth.value_or(1.6 * scene.part.base_distance)),
      has_floor_(scene.contacts.walls && scene.slot.depth.has_value()),
      size_(scene.part.half_width) {
  trace_.reserve(kTracePoints);
}

void Markers::add(const Sample& sample) {
  sample_ = sample;
  if (trace_skipped_ == 0) extend_trace();
  trace_skipped_ = (trace_skipped_ + 1) % trace_stride_;

  now_ = {};
  for (Arrow& peak : peak_) {
    peak.force_x *= kPeakFading;
    peak.force_y *= kPeakFading;
  }
  for (int i = 0; i < kSiteCount; ++i) {
    const ContactSample& contact = sample.contacts[static_cast<std::size_t>(i)];
    const auto spot = static_cast<std::size_t>(spot_of(static_cast<Site>(i)));
    Arrow& now = now_[spot];
    now.force_x += contact.force_x;
    now.force_y += contact.force_y;
    if (contact.normal_force > 0.0) {
      now.point_x = contact.point_x;
      now.point_y = contact.point_y;
    }
    const double impulse = std::hypot(contact.impulse_x, contact.impulse_y);
    Arrow& peak = peak_[spot];
    if (impulse > 0.0 && contact.peak_normal_force > std::hypot(peak.force_x, peak.force_y)) {
      peak = {contact.peak_normal_force * contact.impulse_x / impulse,
              contact.peak_normal_force * contact.impulse_y / impulse, contact.point_x, contact.point_y};
    }
    largest_force_ = std::max({largest_force_, contact.peak_normal_force, std::hypot(now.force_x, now.force_y)});
  }
}

void Markers::extend_trace() {
  if (trace_.size() == kTracePoints) {
    for (std::size_t i = 0; i < kTracePoints / 2; ++i) trace_[i] = trace_[2 * i];
    trace_.resize(kTracePoints / 2);
    trace_stride_ *= 2;
  }
  trace_.push_back(point(sample_.state.x, sample_.state.y, units_.length));
}

MarkerArray Markers::clear(const ros::Time& stamp) {
  sample_ = Sample();
  outcome_ = Outcome::running;
  trace_.clear();
  trace_stride_ = 1;
  trace_skipped_ = 0;
  now_ = peak_ = {};
  largest_force_ = 0.0;
  MarkerArray array;
  array.markers.push_back(marker(stamp, "base", 0, Marker::CUBE));
  array.markers.back().action = Marker::DELETEALL;
  return array;
}

Marker Markers::marker(const ros::Time& stamp, const char* name, int id, int type) const {
  Marker marker;
  marker.header.stamp = stamp;
  marker.header.frame_id = frames_.slot;
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  return marker;
}

void Markers::draw_base(const ros::Time& stamp, MarkerArray& array) const {
  const double unit = units_.length;
  const double width = 3.0 * size_, thickness = kThickness * size_;
  const double depth = slot_depth_ + (has_floor_ ? 0.3 * size_ : 0.0);
  for (int side = 0; side < 2; ++side) {
    Marker half = marker(stamp, "base", side, Marker::CUBE);
    const double centre = slot_half_width_ + width / 2.0;
    half.pose.position.x = (side == 0 ? centre : -centre) * unit;
    half.pose.position.y = (thickness / 2.0 + kGap * size_) * unit;
    half.pose.position.z = -depth / 2.0 * unit;
    half.scale.x = width * unit;
    half.scale.y = thickness * unit;
    half.scale.z = depth * unit;
    paint(half, kBaseColour);
    array.markers.push_back(half);
  }
  if (!has_floor_) return;
  Marker floor = marker(stamp, "base", 2, Marker::CUBE);
  floor.pose.position.y = (thickness / 2.0 + kGap * size_) * unit;
  floor.pose.position.z = -(slot_depth_ + 0.15 * size_) * unit;
  floor.scale.x = 2.0 * slot_half_width_ * unit;
  floor.scale.y = thickness * unit;
  floor.scale.z = 0.3 * size_ * unit;
  paint(floor, kFloorColour);
  array.markers.push_back(floor);
}

void Markers::draw_part(const ros::Time& stamp, MarkerArray& array) const {
  const double unit = units_.length, thickness = kThickness * size_;
  const State& state = sample_.state;
  Marker body = marker(stamp, "part", 0, Marker::CUBE);
  body.pose.position = point(state.x, state.y, unit);
  body.pose.position.y = (thickness / 2.0 + kGap * size_) * unit;
  body.pose.orientation.y = -std::sin(state.phi / 2.0);
  body.pose.orientation.w = std::cos(state.phi / 2.0);
  body.scale.x = 2.0 * part_.half_width * unit;
  body.scale.y = thickness * unit;
  body.scale.z = 2.0 * part_.base_distance * unit;
  paint(body, kPartColour);
  array.markers.push_back(body);

  Marker centre = marker(stamp, "part", 1, Marker::SPHERE);
  centre.pose.position = point(state.x, state.y, unit);
  centre.scale.x = centre.scale.y = centre.scale.z = 0.09 * size_ * unit;
  paint(centre, kCentreColour);
  array.markers.push_back(centre);
}

void Markers::draw_trace(const ros::Time& stamp, MarkerArray& array) const {
  Marker trace = marker(stamp, "trace", 0, Marker::LINE_STRIP);
  trace.scale.x = 0.02 * size_ * units_.length;
  paint(trace, kTraceColour);
  trace.points = trace_;
  trace.points.push_back(point(sample_.state.x, sample_.state.y, units_.length));
  if (trace.points.size() < 2) trace.points.push_back(trace.points.back());
  array.markers.push_back(trace);
}

Marker Markers::arrow(const ros::Time& stamp, const char* name, int id, const Arrow& force) const {
  Marker arrow = marker(stamp, name, id, Marker::ARROW);
  const double length = kLongestArrow * size_ / std::max(largest_force_, kLeastForceScale);
  const double dx = force.force_x * length, dy = force.force_y * length;
  if (std::hypot(dx, dy) < 0.02 * size_) {
    arrow.action = Marker::DELETE;
    return arrow;
  }
  const double unit = units_.length;
  arrow.points = {point(force.point_x, force.point_y, unit), point(force.point_x + dx, force.point_y + dy, unit)};
  arrow.scale.x = 0.07 * size_ * unit;
  arrow.scale.y = 0.16 * size_ * unit;
  arrow.scale.z = std::min(0.22 * size_, 0.5 * std::hypot(dx, dy)) * unit;
  return arrow;
}

void Markers::draw_contacts(const ros::Time& stamp, MarkerArray& array) const {
  for (int i = 0; i < kSiteCount; ++i) {
    const ContactSample& contact = sample_.contacts[static_cast<std::size_t>(i)];
    Marker dot = marker(stamp, "contact", i, Marker::SPHERE);
    if (contact.state.touching()) {
      dot.pose.position = point(contact.point_x, contact.point_y, units_.length);
      dot.scale.x = dot.scale.y = dot.scale.z = 0.13 * size_ * units_.length;
      paint(dot, kContactColour);
    } else {
      dot.action = Marker::DELETE;
    }
    array.markers.push_back(dot);
  }
  for (int i = 0; i < kSpotCount; ++i) {
    array.markers.push_back(arrow(stamp, "reaction", i, now_[static_cast<std::size_t>(i)]));
    paint(array.markers.back(), kReactionColour);
    array.markers.push_back(arrow(stamp, "peak", i, peak_[static_cast<std::size_t>(i)]));
    paint(array.markers.back(), kPeakColour);
  }
}

void Markers::draw_text(const ros::Time& stamp, MarkerArray& array) const {
  const double unit = units_.length;
  Marker text = marker(stamp, "text", 0, Marker::TEXT_VIEW_FACING);
  text.pose.position = point(0.0, 2.0 * part_.base_distance + 1.1 * size_, unit);
  text.scale.z = 0.2 * size_ * unit;
  paint(text, kTextColour);
  char tau[32];
  std::snprintf(tau, sizeof tau, "tau = %.2f", sample_.time);
  text.text = std::string(tau);
  if (has_scales_) text.text += "   t = " + with_unit(sample_.time * units_.time, "s", true);
  text.text += "\nmisalignment " + with_unit(sample_.misalignment * units_.length, "m", has_scales_);
  text.text += "\nlargest reaction " + with_unit(largest_force_ * units_.force, "N", has_scales_);
  text.text += std::string("\nmode: ") + to_string(sample_.mode);
  if (outcome_ != Outcome::running) text.text += std::string("\n") + to_string(outcome_);
  array.markers.push_back(text);
}

MarkerArray Markers::draw(const ros::Time& stamp) const {
  MarkerArray array;
  array.markers.reserve(24);
  draw_base(stamp, array);
  draw_part(stamp, array);
  draw_trace(stamp, array);
  draw_contacts(stamp, array);
  draw_text(stamp, array);
  return array;
}

}  // namespace vibratory_alignment
