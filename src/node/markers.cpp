#include "node/markers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "node/messages.h"
#include "node/quantity_text.h"

namespace vibratory_alignment {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::size_t kTracePoints = 512;  ///< when the trace is full, every other point is dropped
constexpr double kPeakFading = 0.9;        ///< of a peak from sample to sample

// In half widths of the slot:
constexpr double kThickness = 1.0;  ///< of the bodies behind the plane of motion
constexpr double kGap = 0.02;       ///< from the plane of motion to the bodies
constexpr double kBaseWidth = 2.1;  ///< of each half of the base
constexpr double kBaseDepth = 1.3;  ///< of a base whose slot has no floor
constexpr double kFloorThickness = 0.4;
constexpr double kTallest = 3.2;  ///< what is higher of the part is cut off, but for a piece above its centre
constexpr double kLeastAboveCentre = 0.5;
constexpr double kLongestArrow = 1.3;
constexpr double kShortestArrow = 0.07;  ///< shorter ones are not drawn
constexpr double kLineWidth = 0.025;
constexpr double kCentreDot = 0.055, kContactDot = 0.11;
constexpr double kTextHeight = 0.16, kLineHeight = 0.25;
constexpr double kTextX = -2.1, kTextY = 2.6;  ///< centre of the first line

constexpr double kLeastForceScale = 2.0;  ///< dimensionless force that draws the longest arrow at least

struct Colour {
  float red, green, blue, alpha = 1.0F;
};
constexpr Colour kBaseColour{0.55F, 0.60F, 0.66F};
constexpr Colour kPartColour{0.96F, 0.68F, 0.20F};
constexpr Colour kCentreColour{0.10F, 0.10F, 0.12F};
constexpr Colour kTraceColour{0.05F, 0.25F, 0.75F};
constexpr Colour kContactColour{0.98F, 0.95F, 0.25F};
constexpr Colour kReactionColour{0.85F, 0.08F, 0.10F};
constexpr Colour kPeakColour{0.85F, 0.15F, 0.55F, 0.5F};
constexpr Colour kTextColour{0.08F, 0.09F, 0.12F};

void paint(Marker& marker, const Colour& colour) {
  marker.color.r = colour.red;
  marker.color.g = colour.green;
  marker.color.b = colour.blue;
  marker.color.a = colour.alpha;
}

/// Point of the plane of motion in ROS axes; `behind` the plane, away from the observer.
geometry_msgs::Point point(double x, double y, double unit, double behind = 0.0) {
  geometry_msgs::Point point;
  point.x = x * unit;
  point.y = behind * unit;
  point.z = y * unit;
  return point;
}

/// A box between two corners of the plane of motion, behind it. The shade of each face is fixed: rviz's light would
/// leave those black that are seen here.
class Boxes {
 public:
  Boxes(Marker& marker, double front, double back, double unit)
      : marker_(&marker), front_(front), back_(back), unit_(unit) {
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  }

  void add(double left, double bottom, double right, double top) {
    const geometry_msgs::Point near[4] = {at(left, bottom, front_), at(right, bottom, front_), at(right, top, front_),
                                          at(left, top, front_)};
    const geometry_msgs::Point far[4] = {at(left, bottom, back_), at(right, bottom, back_), at(right, top, back_),
                                         at(left, top, back_)};
    face(near[0], near[1], near[2], near[3], 1.0F);
    face(far[1], far[0], far[3], far[2], 0.8F);
    face(near[3], near[2], far[2], far[3], 1.12F);
    face(near[1], near[0], far[0], far[1], 0.6F);
    face(near[1], far[1], far[2], near[2], 0.78F);
    face(far[0], near[0], near[3], far[3], 0.78F);
  }

 private:
  geometry_msgs::Point at(double x, double y, double behind) const { return point(x, y, unit_, behind); }

  void face(const geometry_msgs::Point& a, const geometry_msgs::Point& b, const geometry_msgs::Point& c,
            const geometry_msgs::Point& d, float shade) {
    std_msgs::ColorRGBA colour = marker_->color;
    for (float* part : {&colour.r, &colour.g, &colour.b}) *part = std::min(1.0F, *part * shade);
    for (const geometry_msgs::Point* corner : {&a, &b, &c, &a, &c, &d}) {
      marker_->points.push_back(*corner);
      marker_->colors.push_back(colour);
    }
  }

  Marker* marker_;
  double front_, back_, unit_;
};

}  // namespace

Markers::Markers(const Scene& scene, const Frames& frames)
    : frames_(frames),
      has_scales_(scene.scales.has_value()),
      units_(ros_units(scene)),
      part_(scene.part),
      slot_half_width_(scene.slot_half_width()),
      slot_depth_(scene.slot.depth.value_or(kBaseDepth * scene.slot_half_width())),
      has_floor_(scene.contacts.walls && scene.slot.depth.has_value()),
      size_(slot_half_width_) {
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
    const Spot spot = spot_of(static_cast<Site>(i));
    Arrow& now = now_[static_cast<std::size_t>(spot)];
    now.force_x += contact.force_x;
    now.force_y += contact.force_y;
    place(now, spot);
    Arrow& peak = peak_[static_cast<std::size_t>(spot)];
    const double impulse = std::hypot(contact.impulse_x, contact.impulse_y);
    if (impulse > 0.0 && contact.peak_normal_force > std::hypot(peak.force_x, peak.force_y)) {
      peak.force_x = contact.peak_normal_force * contact.impulse_x / impulse;
      peak.force_y = contact.peak_normal_force * contact.impulse_y / impulse;
      place(peak, spot);
    }
    largest_force_ = std::max(largest_force_, contact.peak_normal_force);
  }
}

/// The edge of the slot, or the corner of the part where it is now.
void Markers::place(Arrow& arrow, Spot spot) const {
  const State& state = sample_.state;
  const double side = spot == Spot::a1 || spot == Spot::b1 ? 1.0 : -1.0;
  if (spot == Spot::a1 || spot == Spot::a2) {
    arrow.point_x = side * slot_half_width_;
    arrow.point_y = 0.0;
  } else {
    const double a = side * part_.half_width, b = part_.base_distance;
    arrow.point_x = state.x + a * std::cos(state.phi) + b * std::sin(state.phi);
    arrow.point_y = state.y + a * std::sin(state.phi) - b * std::cos(state.phi);
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
  array.markers.push_back(marker(stamp, "base", 0, Marker::TRIANGLE_LIST));
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
  Marker base = marker(stamp, "base", 0, Marker::TRIANGLE_LIST);
  paint(base, kBaseColour);
  Boxes boxes(base, kGap * size_, (kGap + kThickness) * size_, units_.length);
  const double inside = slot_half_width_, outside = slot_half_width_ + kBaseWidth * size_;
  boxes.add(-outside, -slot_depth_, -inside, 0.0);
  boxes.add(inside, -slot_depth_, outside, 0.0);
  if (has_floor_) boxes.add(-outside, -slot_depth_ - kFloorThickness * size_, outside, -slot_depth_);
  array.markers.push_back(base);
}

void Markers::draw_part(const ros::Time& stamp, MarkerArray& array) const {
  const double unit = units_.length;
  const State& state = sample_.state;
  Marker body = marker(stamp, "part", 0, Marker::TRIANGLE_LIST);
  body.pose.position = point(state.x, state.y, unit);
  body.pose.orientation = ros_tilt(state.phi);
  paint(body, kPartColour);
  const double b = part_.base_distance;
  const double above_centre = std::min(b, std::max(kTallest * size_ - b, kLeastAboveCentre * size_));
  Boxes(body, kGap * size_, (kGap + kThickness) * size_, unit)
      .add(-part_.half_width, -b, part_.half_width, above_centre);
  array.markers.push_back(body);

  Marker centre = marker(stamp, "part", 1, Marker::SPHERE);
  centre.pose.position = point(state.x, state.y, unit);
  centre.scale.x = centre.scale.y = centre.scale.z = kCentreDot * size_ * unit;
  paint(centre, kCentreColour);
  array.markers.push_back(centre);
}

void Markers::draw_trace(const ros::Time& stamp, MarkerArray& array) const {
  Marker trace = marker(stamp, "trace", 0, Marker::LINE_STRIP);
  trace.scale.x = kLineWidth * size_ * units_.length;
  paint(trace, kTraceColour);
  trace.pose.position.y = -0.1 * size_ * units_.length;  // before the centre and the arrows
  trace.points = trace_;
  trace.points.push_back(point(sample_.state.x, sample_.state.y, units_.length));
  if (trace.points.size() < 2) trace.points.push_back(trace.points.back());
  array.markers.push_back(trace);
}

Marker Markers::arrow(const ros::Time& stamp, const char* name, int id, const Arrow& force) const {
  Marker arrow = marker(stamp, name, id, Marker::ARROW);
  const double size = std::hypot(force.force_x, force.force_y);
  const double length = kLongestArrow * size_ * std::sqrt(size / std::max(largest_force_, kLeastForceScale));
  if (length < kShortestArrow * size_) {
    arrow.action = Marker::DELETE;
    return arrow;
  }
  const double dx = force.force_x / size * length, dy = force.force_y / size * length;
  const double unit = units_.length;
  arrow.points = {point(force.point_x, force.point_y, unit), point(force.point_x + dx, force.point_y + dy, unit)};
  arrow.scale.x = 0.06 * size_ * unit;
  arrow.scale.y = 0.14 * size_ * unit;
  arrow.scale.z = std::min(0.2 * size_, 0.5 * length) * unit;
  return arrow;
}

void Markers::draw_contacts(const ros::Time& stamp, MarkerArray& array) const {
  for (int i = 0; i < kSiteCount; ++i) {
    const ContactSample& contact = sample_.contacts[static_cast<std::size_t>(i)];
    Marker dot = marker(stamp, "contact", i, Marker::SPHERE);
    if (contact.state.touching()) {
      dot.pose.position = point(contact.point_x, contact.point_y, units_.length);
      dot.scale.x = dot.scale.y = dot.scale.z = kContactDot * size_ * units_.length;
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
  char tau[32];
  std::snprintf(tau, sizeof tau, "tau = %.2f", sample_.time);
  std::vector<std::string> lines = {tau};
  if (has_scales_) lines.push_back("t = " + quantity_text(sample_.time * units_.time, "s", true));
  lines.push_back("misalignment " + quantity_text(sample_.misalignment * units_.length, "m", has_scales_));
  lines.push_back("largest reaction " + quantity_text(largest_force_ * units_.force, "N", has_scales_));
  lines.push_back(std::string("mode ") + to_string(sample_.mode));
  if (outcome_ != Outcome::running) lines.emplace_back(to_string(outcome_));

  // A marker for each line: rviz spaces the lines of one marker by a fixed length, whatever their height.
  double y = kTextY * size_;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Marker line = marker(stamp, "text", static_cast<int>(i), Marker::TEXT_VIEW_FACING);
    line.pose.position = point(kTextX * size_, y, units_.length);
    line.scale.z = kTextHeight * size_ * units_.length;
    paint(line, kTextColour);
    line.text = lines[i];
    array.markers.push_back(line);
    y -= kLineHeight * size_;
  }
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
