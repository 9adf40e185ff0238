#include "solver/transitions.h"

#include <algorithm>
#include <cmath>

#include "mechanics/site_rules.h"

namespace vibratory_alignment {
namespace {

/// A sliding velocity this small, relative to the speeds it is made of, is zero.
constexpr double kZeroSlip = 1e-14;

/// A friction force this near to its limit, relative to it, is at the limit.
constexpr double kAtLimit = 1e-9;

/// How the friction of a loaded contact enters the decision.
enum class Ask { keep, decide };

/// A stick that has just broken: sign of V, and multiplicity of its zero at this instant.
struct Broken {
  int direction = 0, zeros = 2;
  bool alone = false;  ///< the others hold on
};

struct LoadedContact {
  std::size_t site = 0;
  ContactKinematics kinematics;
  double normal_force = 0.0;
  Ask ask = Ask::keep;
};

/// Force sums of the excitations at the instant of the decision.
Load3 drive_load(const DriveForms& drives) {
  Load3 load;
  for (int i = 0; i < drives.count; ++i) {
    const DriveForm& form = drives.form[i];
    const double value = form.constant + form.amplitude * form.sin_phase;
    (drives.direction[i] == Direction::x ? load.x : drives.direction[i] == Direction::y ? load.y : load.phi) += value;
  }
  return load;
}

double moment_of(const Vec2& lever, const Vec2& force) { return lever.x * force.y - lever.y * force.x; }

double reach_of(const Vec2& lever) { return std::abs(lever.x) + std::abs(lever.y); }

double speed_scale(const System& system, const State& state) {
  return std::abs(state.vx) + std::abs(state.vy) +
         std::abs(state.omega) * (system.half_width + system.base_distance + system.slot_half_width);
}

double base_force(const System& system, const State& state, Face face, const ContactKinematics& k) {
  const double c = std::cos(state.phi), s = std::sin(state.phi);
  return std::max(0.0, stiffness_of(system, face, c, s) * k.depth + damping_of(system, face, c, s) * k.depth_rate);
}

/// Slip velocity beyond which a contact slides with the full friction force.
double sliding_threshold(const System& system) { return kTanhSaturation * system.regularization; }

/// Decides stick and slip of all contacts marked `decide`, with the others sliding as they do. When one has just broken
/// (`any_broken`), those that are at their limit too break with it.
void decide_friction(const System& system, const State& state, const DriveForms& drives,
                     std::array<LoadedContact, kSiteCount>& loaded, int count, bool any_broken, ContactMode& mode) {
  FrictionProblem problem;
  std::array<int, kSiteCount> asked{};
  for (int i = 0; i < count; ++i)
    if (loaded[i].ask == Ask::decide) asked[problem.count++] = i;
  if (problem.count == 0) return;

  // acceleration without the forces sought
  const Load3 drive = drive_load(drives);
  double fx = drive.x - system.x.damping * state.vx - system.x.stiffness * (state.x - system.x.anchor);
  double fy = drive.y - system.y.damping * state.vy - system.y.stiffness * (state.y - system.y.anchor) - system.weight;
  double m = drive.phi - system.phi.damping * state.omega - system.phi.stiffness * (state.phi - system.phi.anchor);
  double force_scale = std::abs(fx) + std::abs(fy), moment_scale = std::abs(m);
  for (int i = 0; i < count; ++i) {
    const LoadedContact& contact = loaded[i];
    double t = 0.0;
    if (contact.ask != Ask::decide) {
      const Slip slip = mode.contacts[contact.site].slip;
      t = slip == Slip::plus    ? -system.friction * contact.normal_force
          : slip == Slip::minus ? system.friction * contact.normal_force
                                : 0.0;
    }
    const Vec2 force{contact.normal_force * contact.kinematics.normal.x + t * contact.kinematics.tangent.x,
                     contact.normal_force * contact.kinematics.normal.y + t * contact.kinematics.tangent.y};
    fx += force.x;
    fy += force.y;
    m += moment_of(contact.kinematics.lever, force);
    force_scale += contact.normal_force;
    moment_scale += contact.normal_force * reach_of(contact.kinematics.lever);
  }
  const double ax = fx * system.x.inverse_inertia, ay = fy * system.y.inverse_inertia,
               alpha = m * system.phi.inverse_inertia;
  for (int i = 0; i < problem.count; ++i) {
    const LoadedContact& a = loaded[asked[i]];
    const double arm = moment_of(a.kinematics.lever, a.kinematics.tangent);
    problem.drift[i] = ax * a.kinematics.tangent.x + ay * a.kinematics.tangent.y + alpha * arm + a.kinematics.slip_rate;
    problem.drift_scale[i] = force_scale * std::max(system.x.inverse_inertia, system.y.inverse_inertia) +
                             moment_scale * reach_of(a.kinematics.lever) * system.phi.inverse_inertia +
                             std::abs(state.omega) * speed_scale(system, state);
    problem.limit[i] = system.friction * a.normal_force;
    for (int j = 0; j < problem.count; ++j) {
      const LoadedContact& b = loaded[asked[j]];
      problem.mobility[i][j] = a.kinematics.tangent.x * b.kinematics.tangent.x * system.x.inverse_inertia +
                               a.kinematics.tangent.y * b.kinematics.tangent.y * system.y.inverse_inertia +
                               arm * moment_of(b.kinematics.lever, b.kinematics.tangent) * system.phi.inverse_inertia;
    }
  }
  const FrictionSolution solution = solve_friction(problem);
  for (int i = 0; i < problem.count; ++i) {
    const std::size_t site = loaded[asked[i]].site;
    mode.contacts[site].slip = solution.slip[i];
    mode.pins[site].slip = solution.slip[i] == Slip::stick ? 0 : 1;
    const bool at_limit = std::abs(solution.force[i]) >= (1.0 - kAtLimit) * problem.limit[i];
    if (any_broken && solution.slip[i] == Slip::stick && at_limit) {
      mode.contacts[site].slip = solution.force[i] > 0.0 ? Slip::minus : Slip::plus;
      mode.pins[site].slip = 2;
    }
  }
}

/// Sets the law of friction of every loaded contact. `zero_slip` marks those whose V an event has just brought to zero,
/// `broken` those whose stick an event has just broken.
void set_friction(const System& system, const State& state, const DriveForms& drives,
                  const std::array<bool, kSiteCount>& zero_slip, const std::array<Broken, kSiteCount>& broken,
                  ContactMode& mode) {
  std::array<LoadedContact, kSiteCount> loaded;
  int count = 0;
  bool any_broken = false;
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    ContactState& contact = mode.contacts[i];
    if (contact.phase != Phase::loaded) {
      contact.slip = Slip::none;
      continue;
    }
    if (system.friction == 0.0) continue;
    LoadedContact& entry = loaded[count++];
    entry.site = i;
    entry.kinematics = contact_kinematics(system, state, static_cast<Site>(i), contact.face);
    entry.normal_force = base_force(system, state, contact.face, entry.kinematics);
    const double v = entry.kinematics.slip_velocity;
    const bool at_rest = zero_slip[i] || std::abs(v) <= kZeroSlip * speed_scale(system, state);
    if (system.regularization > 0.0) {
      // sliding, or the layer about V = 0; an event has put V on the border, from where the old law tells the way
      if (zero_slip[i]) {
        contact.slip = contact.slip == Slip::regularized ? (v > 0.0 ? Slip::plus : Slip::minus) : Slip::regularized;
        mode.pins[i].slip = 1;
      } else if (contact.slip == Slip::none) {
        contact.slip = std::abs(v) <= sliding_threshold(system) ? Slip::regularized
                       : v > 0.0                                ? Slip::plus
                                                                : Slip::minus;
      }
      continue;
    }
    if (broken[i].direction != 0) {
      contact.slip = broken[i].direction > 0 ? Slip::plus : Slip::minus;
      mode.pins[i].slip = broken[i].zeros;
      any_broken = any_broken || !broken[i].alone;
    } else if (contact.slip == Slip::stick || at_rest) {
      entry.ask = Ask::decide;
    } else if (contact.slip == Slip::none) {
      contact.slip = v > 0.0 ? Slip::plus : Slip::minus;
    }
  }
  if (system.regularization == 0.0) decide_friction(system, state, drives, loaded, count, any_broken, mode);
}

/// A contact without base damping along its normal: N starts and ends at zero depth.
bool is_undamped(const System& system, const State& state, Face face) {
  return damping_of(system, face, std::cos(state.phi), std::sin(state.phi)) == 0.0;
}

}  // namespace

ContactMode apply_events(const System& system, const Segment& segment, const ContactMode& before,
                         const DriveForms& drives_at_end, FoundEvents& events) {
  ContactMode mode = before;
  // what was zero at the start no longer is, unless no time has passed
  if (segment.duration > 0.0) mode.pins = {};
  const State& state = segment.end;
  std::array<bool, kSiteCount> zero_slip{};
  std::array<Broken, kSiteCount> broken{};
  for (int i = 0; i < events.count; ++i) {
    const Site site = events.events[i].site;
    const auto index = static_cast<std::size_t>(site);
    ContactState& contact = mode.contacts[index];
    SitePins& pins = mode.pins[index];
    const Face face = events.events[i].face;
    // a contact that has ended takes its other events with it
    if (contact.phase != segment.contacts[index].phase) continue;
    switch (events.events[i].kind) {
      case EventKind::touch:
        contact = {Phase::loaded, face, Slip::none};
        pins.normal = is_undamped(system, state, face) ? 1 : 0;
        mode.recoveries[index] = {};
        break;
      case EventKind::reload:
        contact.phase = Phase::loaded;
        pins.normal = system.recovery ? 0 : 1;
        mode.recoveries[index] = {};
        break;
      case EventKind::release:
        // a base that recovers leaves with the part: depth and deformation agree in value and rate
        pins.normal = system.recovery ? 2 : 1;
        if (is_undamped(system, state, contact.face)) {
          // N = k d: force and depth end together
          pins.face = contact.face;
          contact = {};
        } else {
          contact.phase = Phase::unloaded;
          contact.slip = Slip::none;
          if (system.recovery) mode.recoveries[index] = release_recovery(system, state, site, contact.face);
        }
        break;
      case EventKind::close:
        pins.face = contact.face;
        contact = {};
        break;
      case EventKind::run_off:
        contact = {};
        pins.face = face;
        mode.recoveries[index] = {};
        break;
      case EventKind::leave:
        contact = {};
        pins.face = face;
        break;
      case EventKind::enter: contact = {Phase::free, Face::none, Slip::none}; break;
      case EventKind::slip_reversal: zero_slip[index] = true; break;
      case EventKind::slip:
        if (system.regularization > 0.0) {
          zero_slip[index] = true;
        } else {
          broken[index] = {events.events[i].direction, events.events[i].zeros, false};
        }
        break;
      case EventKind::part: broken[index] = {events.events[i].direction, events.events[i].zeros, true}; break;
      default: break;
    }
  }
  set_friction(system, state, drives_at_end, zero_slip, broken, mode);
  for (int i = 0; i < events.count; ++i) {
    Event& event = events.events[i];
    if (event.kind == EventKind::slip_reversal &&
        mode.contacts[static_cast<std::size_t>(event.site)].slip == Slip::stick)
      event.kind = EventKind::stick;
  }
  return mode;
}

void decide_friction_anew(const System& system, const State& state, const DriveForms& drives, ContactMode& mode) {
  set_friction(system, state, drives, {}, {}, mode);
}

ContactMode start_mode(const System& system, const State& start, const DriveForms& drives) {
  ContactMode mode{};
  place_contacts(system, start, mode.contacts);
  for (std::size_t i = 0; i < kSiteCount; ++i)
    if (system.recovery && mode.contacts[i].phase == Phase::unloaded)
      mode.recoveries[i] = release_recovery(system, start, static_cast<Site>(i), mode.contacts[i].face);
  set_friction(system, start, drives, {}, {}, mode);
  return mode;
}

Recovery release_recovery(const System& system, const State& state, Site site, Face face) {
  const double c = std::cos(state.phi), s = std::sin(state.phi);
  const double damping = damping_of(system, face, c, s);
  if (damping == 0.0) return {};  // recovers at once
  return {contact_kinematics(system, state, site, face).depth, stiffness_of(system, face, c, s) / damping, face};
}

State hold_sticking(const System& system, const State& state, const ContactStates& contacts) {
  FrictionProblem problem;
  std::array<ContactKinematics, kSiteCount> held;
  for (std::size_t i = 0; i < kSiteCount; ++i)
    if (contacts[i].slip == Slip::stick)
      held[problem.count++] = contact_kinematics(system, state, static_cast<Site>(i), contacts[i].face);
  if (problem.count == 0) return state;
  std::array<double, kSiteCount> rhs{}, impulse{};
  for (int i = 0; i < problem.count; ++i) {
    rhs[i] = -held[i].slip_velocity;
    for (int j = 0; j < problem.count; ++j)
      problem.mobility[i][j] = held[i].tangent.x * held[j].tangent.x * system.x.inverse_inertia +
                               held[i].tangent.y * held[j].tangent.y * system.y.inverse_inertia +
                               moment_of(held[i].lever, held[i].tangent) * moment_of(held[j].lever, held[j].tangent) *
                                   system.phi.inverse_inertia;
  }
  solve_mobility(problem.mobility, problem.count, rhs, impulse);
  State result = state;
  for (int i = 0; i < problem.count; ++i) {
    result.vx += impulse[i] * held[i].tangent.x * system.x.inverse_inertia;
    result.vy += impulse[i] * held[i].tangent.y * system.y.inverse_inertia;
    result.omega += impulse[i] * moment_of(held[i].lever, held[i].tangent) * system.phi.inverse_inertia;
  }
  return result;
}

}  // namespace vibratory_alignment
