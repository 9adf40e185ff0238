#include "solver/segment.h"

#include <algorithm>

#include "solver/flight.h"
#include "solver/layer_crossing.h"

namespace vibratory_alignment {

State state_at(const Segment& segment, double t) {
  if (segment.flight != nullptr) {
    State state;
    segment.flight->at(segment.flight_time + t, state);
    return state;
  }
  if (segment.layer_crossing != nullptr) return segment.layer_crossing->at(t);
  State end;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    // Horner's rule on all six at once: none waits for another
    int k = segment.order;
    State q{segment.x[k], segment.y[k], segment.phi[k], segment.vx[k], segment.vy[k], segment.omega[k]};
    while (--k >= 0)
      q = {q.x * t + segment.x[k],   q.y * t + segment.y[k],   q.phi * t + segment.phi[k],
           q.vx * t + segment.vx[k], q.vy * t + segment.vy[k], q.omega * t + segment.omega[k]};
    end = q;
  });
  return end;
}

Load3 drive_at(const Segment& segment, double t) {
  if (segment.flight != nullptr) return segment.flight->drive_at(segment.flight_time + t);
  if (segment.layer_crossing != nullptr) return segment.layer_crossing->drive_at(t);
  const int order = segment.order;
  return {value_at(segment.drive_x, order, t), value_at(segment.drive_y, order, t),
          value_at(segment.drive_phi, order, t)};
}

ContactValues contact_at(const Segment& segment, int i, double t) {
  if (segment.layer_crossing != nullptr) return segment.layer_crossing->contact_at(t);
  const ContactSeries& contact = segment.loaded[static_cast<std::size_t>(i)];
  const int order = segment.order;
  ContactValues values = {value_at(contact.depth, order, t), value_at(contact.normal_force, order, t),
                          value_at(contact.tangential_force, order, t), value_at(contact.slip_velocity, order, t)};
  if (segment.coarse && slip_of(segment, contact) == Slip::regularized) {
    const double limit = segment.friction * std::max(values.normal_force, 0.0);
    values.tangential_force = std::clamp(values.tangential_force, -limit, limit);
  }
  return values;
}

double largest_normal_force(const Segment& segment, int i, double from, double to) {
  if (segment.layer_crossing != nullptr) return segment.layer_crossing->largest_normal_force(from, to);
  return largest_value(segment.loaded[static_cast<std::size_t>(i)].normal_force, segment.order, from, to);
}

}  // namespace vibratory_alignment
