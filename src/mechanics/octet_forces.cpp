#include "mechanics/octet_forces.h"

#include <cmath>

#include "mechanics/octet_contact.h"
#include "mechanics/octet_holding.h"
#include "mechanics/quad_functions.h"

namespace vibratory_alignment {
namespace {

using StickingContacts = std::array<StickingOctet, kSiteCount>;

/// As contact_kinematics() and evaluate_forces(). Returns the number of sticking contacts.
VIBRATORY_ALIGNMENT_INLINE int evaluate(const NormalForcesOctet& acting, const System& system, const StateOctet& q,
                                        const LoadOctet& drive, const ContactStates& contacts, ForcesOctet& forces,
                                        StickingContacts& sticking) {
  auto [fx, fy, moment] = free_load(system, q, drive);
  // as numbers: a build without friction has constants of another type in their place (bench/effects)
  const double friction = system.friction, regularization = system.regularization;
  Octet c, s;
  tilts_of(q.phi, c, s);
  int sticking_count = 0;
  forces.count = 0;
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    const ContactState& contact = contacts[i];
    if (contact.phase != Phase::loaded) continue;
    const auto index = static_cast<std::size_t>(forces.count++);
    const auto site = static_cast<Site>(i);
    const ContactOctet at = contact_octet(system, q, site, contact.face, c, s);
    const Vec2Octet &n = at.normal, &t = at.tangent;

    ContactForceOctet& force = forces.contact[index];
    forces.site[index] = site;
    force.depth = at.depth;
    force.slip_velocity = at.slip_velocity;
    force.normal_force = normal_force_of(system, at, contact.face, c, s);
    Octet ratio = 0.0;
    switch (contact.slip) {
      case Slip::plus: ratio = -friction; break;
      case Slip::minus: ratio = friction; break;
      case Slip::regularized: {
        const Octet share = at.slip_velocity / regularization;
        Octet tanh;
        tanh_of(share.low, tanh.low);
        tanh_of(share.high, tanh.high);
        ratio = -friction * tanh;
        break;
      }
      case Slip::stick: {
        StickingOctet& row = sticking[static_cast<std::size_t>(sticking_count++)];
        row.index = index;
        row.x = t.x;
        row.y = t.y;
        row.moment = cross(at.lever, t);
        row.slip_rate = slip_rate_of(q, at, contact.face);
        break;
      }
      case Slip::none: break;
    }
    force.friction_ratio = ratio;
    force.tangential_force = ratio * force.normal_force;
    const Octet tangential_force = ratio * acting[index];
    const Vec2Octet total = {acting[index] * n.x + tangential_force * t.x,
                             acting[index] * n.y + tangential_force * t.y};
    fx += total.x;
    fy += total.y;
    moment += cross(at.lever, total);
  }
  forces.ax = system.x.inverse_inertia * fx;
  forces.ay = system.y.inverse_inertia * fy;
  forces.alpha = system.phi.inverse_inertia * moment;
  return sticking_count;
}

/// As DriveForm::at().
VIBRATORY_ALIGNMENT_INLINE Octet drive_at(const DriveForm& form, const Octet& t) {
  Octet value = form.constant + form.slope * t;
  if (form.amplitude == 0.0) return value;
  const Octet angle = (form.frequency + 0.5 * form.rate * t) * t;
  Octet sin, cos;
  if (largest(abs(angle)) <= kLargestAngle) {
    sin_cos(angle.low, sin.low, cos.low);
    sin_cos(angle.high, sin.high, cos.high);
  } else {
    for (std::size_t i = 0; i < Octet::kSize; ++i) {
      sin[i] = std::sin(angle[i]);
      cos[i] = std::cos(angle[i]);
    }
  }
  return value + form.amplitude * (form.sin_phase * cos + form.cos_phase * sin);
}

}  // namespace

Forces ForcesOctet::operator[](std::size_t i) const {
  Forces one;
  one.ax = ax[i];
  one.ay = ay[i];
  one.alpha = alpha[i];
  one.count = count;
  for (std::size_t c = 0; c < static_cast<std::size_t>(count); ++c) {
    const ContactForceOctet& force = contact[c];
    one.contact[c] = {site[c],
                      force.depth[i],
                      force.normal_force[i],
                      force.tangential_force[i],
                      force.friction_ratio[i],
                      force.slip_velocity[i]};
  }
  return one;
}

void evaluate_drives(const DriveForm* forms, const Direction* directions, int count, const Octet& times,
                     LoadOctet& load) {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    load = LoadOctet{};
    for (int i = 0; i < count; ++i)
      (directions[i] == Direction::x   ? load.x
       : directions[i] == Direction::y ? load.y
                                       : load.phi) += drive_at(forms[i], times);
  });
}

bool evaluate_forces_under(const NormalForcesOctet& acting, const System& system, const StateOctet& states,
                           const LoadOctet& drive, const ContactStates& contacts, ForcesOctet& forces) {
  StickingContacts sticking;
  int count = 0;
  bool held = false;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    count = evaluate(acting, system, states, drive, contacts, forces, sticking);
    held = count == 0 || (count == 1 && hold_single(system, sticking[0], forces)) ||
           (count == 2 && hold_pair(system, sticking[0], sticking[1], forces));
  });
  if (!held) hold_one_by_one(system, sticking.data(), count, forces);
  return held;
}

}  // namespace vibratory_alignment
