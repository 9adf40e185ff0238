#include "solver/first_order.h"

#include <cmath>

namespace vibratory_alignment {
namespace {

Slip slip_of(const System& system, double v, bool sticks) {
  if (system.friction == 0.0) return Slip::none;
  if (system.regularization > 0.0 && std::abs(v) <= system.tanh_saturation * system.regularization)
    return Slip::regularized;
  if (system.regularization == 0.0 && sticks) return Slip::stick;
  return v > 0.0 ? Slip::plus : Slip::minus;
}

}  // namespace

void set_first_order_motion(const StepStart& start, const Load3& drive, Segment& segment) {
  segment.order = 1;
  const State &s = start.book.placed.state, &end = segment.end;
  const auto line = [&](Series& series, double from, double to) { set_line(series, 1, from, to, start.duration); };
  line(segment.x, s.x, end.x);
  line(segment.y, s.y, end.y);
  line(segment.phi, s.phi, end.phi);
  line(segment.vx, s.vx, end.vx);
  line(segment.vy, s.vy, end.vy);
  line(segment.omega, s.omega, end.omega);
  set_constant(segment.drive_x, 1, drive.x);
  set_constant(segment.drive_y, 1, drive.y);
  set_constant(segment.drive_phi, 1, drive.phi);
}

void add_first_order_contact(const StepStart& start, Site site, const StepForces& forces, const PlacedState& end,
                             Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) {
  const auto index = static_cast<std::size_t>(site);
  ContactState& state = segment.contacts[index];
  if (state.phase == Phase::unloaded && forces.normal == 0.0) return;
  const ContactPoint& p0 = start.book.touching[index];
  const ContactPoint p1 = contact_point(start.system, end, site, state.face, site_point(start.system, end, site));
  const bool stuck = state.slip == Slip::stick || (state.slip == Slip::none && forces.sticks);
  slip_at_end[index] = slip_of(start.system, p1.slip_velocity, forces.sticks);
  state.phase = Phase::loaded;
  state.slip = slip_of(start.system, p0.slip_velocity, stuck);
  ContactSeries& contact = segment.loaded[static_cast<std::size_t>(segment.loaded_count++)];
  contact.site = site;
  set_line(contact.depth, 1, p0.depth, p1.depth, start.duration);
  set_line(contact.slip_velocity, 1, p0.slip_velocity, p1.slip_velocity, start.duration);
  set_constant(contact.normal_force, 1, forces.normal);
  set_constant(contact.tangential_force, 1, forces.tangential);
}

}  // namespace vibratory_alignment
