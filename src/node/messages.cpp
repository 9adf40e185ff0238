#include "node/messages.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibratory_alignment {
namespace {

static_assert(static_cast<int>(Mode::none) == AlignerState::MODE_NONE);
static_assert(static_cast<int>(Mode::impact) == AlignerState::MODE_IMPACT);
static_assert(static_cast<int>(Mode::nonimpact) == AlignerState::MODE_NONIMPACT);
static_assert(static_cast<int>(Mode::mixed) == AlignerState::MODE_MIXED);
static_assert(static_cast<int>(Spot::a1) == AlignerState::A1 && static_cast<int>(Spot::a2) == AlignerState::A2);
static_assert(static_cast<int>(Spot::b1) == AlignerState::B1 && static_cast<int>(Spot::b2) == AlignerState::B2);

std::size_t index_of(Site site) { return static_cast<std::size_t>(site); }
std::size_t index_of(Spot spot) { return static_cast<std::size_t>(spot); }

const ContactSample& contact_at(const Sample& sample, Site site) { return sample.contacts[index_of(site)]; }

/// Calls `visit` for every site of the sample that lies at `spot`.
template <class Visitor>
void for_each_site(const Sample& sample, Spot spot, const Visitor& visit) {
  for (int i = 0; i < kSiteCount; ++i) {
    const auto site = static_cast<Site>(i);
    if (spot_of(site) == spot) visit(contact_at(sample, site));
  }
}

bool touches(const Sample& sample, Spot spot) {
  bool touching = false;
  for_each_site(sample, spot, [&](const ContactSample& contact) { touching |= contact.state.touching(); });
  return touching;
}

void add(geometry_msgs::Vector3& sum, const geometry_msgs::Vector3& term) {
  sum.x += term.x;
  sum.y += term.y;
  sum.z += term.z;
}

}  // namespace

OutputUnits ros_units(const Scene& scene) { return si_output_units(scene.scales.value_or(Scales())); }

geometry_msgs::Vector3 ros_vector(double x, double y, double unit) {
  geometry_msgs::Vector3 vector;
  vector.x = x * unit;
  vector.z = y * unit;
  return vector;
}

geometry_msgs::Quaternion ros_tilt(double phi) {
  geometry_msgs::Quaternion rotation;
  rotation.y = -std::sin(phi / 2.0);
  rotation.w = std::cos(phi / 2.0);
  return rotation;
}

Messages::Messages(const Scene& scene, const Frames& frames)
    : scene_name_(scene.name),
      scene_units_(scene.units == Units::si ? "si" : "dimensionless"),
      has_scales_(scene.scales.has_value()),
      excites_tilt_(!scene.excitations.empty() && scene.excitations.front().direction == Direction::phi),
      units_(ros_units(scene)),
      frames_(frames) {}

PlanarState Messages::dimensionless(const State& state) const {
  PlanarState message;
  message.x = state.x;
  message.y = state.y;
  message.phi = state.phi;
  message.vx = state.vx;
  message.vy = state.vy;
  message.omega = state.omega;
  return message;
}

PlanarState Messages::si(const State& state) const {
  PlanarState message;
  message.x = state.x * units_.length;
  message.y = state.y * units_.length;
  message.phi = state.phi;
  message.vx = state.vx * units_.velocity;
  message.vy = state.vy * units_.velocity;
  message.omega = state.omega * units_.angular_velocity;
  return message;
}

AlignerState Messages::state(const Sample& sample, const ros::Time& stamp) const {
  AlignerState message;
  message.header.stamp = stamp;
  message.header.frame_id = frames_.slot;
  message.scene = scene_name_;
  message.units = scene_units_;
  message.has_scales = has_scales_;
  message.excites_tilt = excites_tilt_;
  message.length_scale = units_.length;
  message.force_scale = units_.force;
  message.time_scale = units_.time;
  message.tau = sample.time;
  message.time = sample.time * units_.time;
  message.dimensionless = dimensionless(sample.state);
  message.si = si(sample.state);
  message.a1 = touches(sample, Spot::a1);
  message.a2 = touches(sample, Spot::a2);
  message.b1 = touches(sample, Spot::b1);
  message.b2 = touches(sample, Spot::b2);
  message.mode = static_cast<std::uint8_t>(sample.mode);
  message.misalignment = sample.misalignment * units_.length;
  message.progress = sample.progress;
  for (int i = 0; i < kSpotCount; ++i) {
    const auto spot = static_cast<Spot>(i);
    double peak = 0.0, impulse = 0.0;
    for_each_site(sample, spot, [&](const ContactSample& contact) {
      peak = std::max(peak, contact.peak_normal_force);
      impulse += contact.normal_impulse;
    });
    message.impacts[index_of(spot)] = static_cast<std::uint32_t>(sample.impacts[index_of(spot)]);
    message.peak_force[index_of(spot)] = peak * units_.force;
    message.impulse[index_of(spot)] = impulse * units_.impulse;
  }
  return message;
}

geometry_msgs::WrenchStamped Messages::reaction(const Sample& sample, Site edge, const ros::Time& stamp) const {
  const ContactSample& contact = contact_at(sample, edge);
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = edge == Site::a1 ? frames_.edge_a1 : frames_.edge_a2;
  message.wrench.force = ros_vector(contact.force_x, contact.force_y, units_.force);
  return message;
}

AlignerContact Messages::contact(const Sample& sample, Spot spot) const {
  AlignerContact message;
  message.info = to_string(spot);
  message.collision1_name = "part";
  message.collision2_name = "base";
  for_each_site(sample, spot, [&](const ContactSample& contact) {
    message.peak_force = std::max(message.peak_force, contact.peak_normal_force * units_.force);
    add(message.impulse, ros_vector(contact.impulse_x, contact.impulse_y, units_.impulse));
    if (!contact.state.touching()) return;
    const double lever_x = contact.point_x - sample.state.x, lever_y = contact.point_y - sample.state.y;
    geometry_msgs::Wrench wrench;
    wrench.force = ros_vector(contact.force_x, contact.force_y, units_.force);
    wrench.torque.y = -(lever_x * contact.force_y - lever_y * contact.force_x) * units_.moment;
    add(message.total_wrench.force, wrench.force);
    add(message.total_wrench.torque, wrench.torque);
    message.wrenches.push_back(wrench);
    message.contact_positions.push_back(ros_vector(contact.point_x, contact.point_y, units_.length));
    message.contact_normals.push_back(ros_vector(contact.normal_x, contact.normal_y));
    message.depths.push_back(contact.depth * units_.length);
  });
  return message;
}

AlignerContacts Messages::contacts(const Sample& sample, const ros::Time& stamp) const {
  AlignerContacts message;
  message.header.stamp = stamp;
  message.header.frame_id = frames_.slot;
  for (int i = 0; i < kSpotCount; ++i) {
    AlignerContact spot = contact(sample, static_cast<Spot>(i));
    if (!spot.wrenches.empty() || spot.peak_force > 0.0) message.states.push_back(std::move(spot));
  }
  return message;
}

AlignerResult Messages::result(const TrialResult& result, const ros::Time& stamp) const {
  AlignerResult message;
  message.header.stamp = stamp;
  message.header.frame_id = frames_.slot;
  message.scene = result.scene;
  message.has_scales = has_scales_;
  message.outcome = to_string(result.outcome);
  message.failure = result.failure;
  message.mode = to_string(result.mode);
  for (const ModeChange& change : result.mode_changes) {
    message.mode_change_times.push_back(change.time * units_.time);
    message.mode_change_modes.emplace_back(to_string(change.mode));
  }
  message.duration =
      result.aligned_time ? *result.aligned_time * units_.time : std::numeric_limits<double>::quiet_NaN();
  message.tau = result.final_time;
  message.time = result.final_time * units_.time;
  message.dimensionless = dimensionless(result.final_state);
  message.si = si(result.final_state);
  for (std::size_t i = 0; i < kSpotCount; ++i) {
    message.impacts[i] = static_cast<std::uint32_t>(result.impacts[i]);
    message.peak_force[i] = result.peak_force[i] * units_.force;
  }
  message.force_limit_exceeded = result.force_limit_exceeded;
  if (const auto& first = result.first_contact) {
    message.first_contact.happened = true;
    message.first_contact.time = first->time * units_.time;
    message.first_contact.spot = to_string(first->spot);
    message.first_contact.dimensionless = dimensionless(first->state);
    message.first_contact.si = si(first->state);
    message.first_contact.approach_speed = first->approach_speed * units_.velocity;
    message.first_contact.slip_velocity = first->slip_velocity * units_.velocity;
  }
  if (const auto& ledger = result.energy) {
    message.energy.initial = ledger->initial * units_.energy;
    message.energy.final = ledger->final * units_.energy;
    message.energy.excitation_work = ledger->excitation_work * units_.energy;
    message.energy.gripper_loss = ledger->gripper_loss * units_.energy;
    message.energy.base_loss = ledger->base_loss * units_.energy;
    message.energy.friction_loss = ledger->friction_loss * units_.energy;
    message.energy.release_loss = ledger->release_loss * units_.energy;
    message.energy.turning = ledger->turning * units_.energy;
    message.energy.residual = ledger->residual;
  }
  message.solver = result.solver_name;
  message.tolerance = result.solver_tolerance;
  message.step = result.solver_step * units_.time;
  message.accuracy = result.solver_accuracy;
  message.steps = static_cast<std::uint64_t>(result.counts.steps);
  message.rejected = static_cast<std::uint64_t>(result.counts.rejected);
  message.rhs_evaluations = static_cast<std::uint64_t>(result.counts.rhs_evaluations);
  message.events = static_cast<std::uint64_t>(result.counts.events);
  message.cpu_seconds = result.cpu_seconds;
  return message;
}

}  // namespace vibratory_alignment
