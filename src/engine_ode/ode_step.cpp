#include "engine_ode/ode_step.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "solver/first_order.h"
#include "solver/solver.h"

namespace vibratory_alignment {
namespace {

static_assert(std::is_same<dReal, double>::value, "ODE must be built with double precision (dDOUBLE)");

/// Softness of what should be hard, velocity per force: keeps ODE's equations regular where two contacts hold the same
/// motion. What sticks creeps with this times its friction force.
constexpr double kHard = 1e-10;

/// A sliding velocity beside the speed of the part that is none: rounding.
constexpr double kStill = 1e-12;

using SetMotor = void (*)(dJointID, int, dReal);

/// A motor that never moves: a locked motion.
void lock(dJointID plane, SetMotor set) {
  set(plane, dParamFMax, dInfinity);
  set(plane, dParamVel, 0.0);
  set(plane, dParamCFM, 0.0);
}

/// A motor that is the spring and damper of an axis at the end of a step: force = -k (q + h v - anchor) - c v, which is
/// (vel - v)/CFM with CFM = 1/(h k + c).
void set_spring(dJointID plane, SetMotor set, const Axis& axis, double q, double h) {
  if (!axis.moves) return;
  const double cfm = 1.0 / (h * axis.stiffness + axis.damping);
  set(plane, dParamVel, -axis.stiffness * (q - axis.anchor) * cfm);
  set(plane, dParamCFM, cfm);
}

/// Slip velocity per friction force that follows tanh(V/eps) from where V is at the start of the step.
double slip_per_force(double v, double eps, double limit) {
  const double z = std::abs(v) / eps;
  return z < 1e-4 ? eps / limit : std::abs(v) / (limit * std::tanh(z));
}

}  // namespace

OdeStep::OdeStep(const System& system) {
  library_.enter_thread();
  own_thread_ = dThreadingAllocateSelfThreadedImplementation();
  world_ = dWorldCreate();
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(own_thread_), own_thread_);
  dWorldSetGravity(world_, 0.0, 0.0, 0.0);
  dWorldSetCFM(world_, kHard);
  dWorldSetAutoDisableFlag(world_, 0);
  body_ = dBodyCreate(world_);
  dMass mass;
  // about all axes alike: the body never turns out of the plane
  const double inertia = system.phi.moves ? system.phi.inertia : 1.0;
  dMassSetParameters(&mass, system.y.inertia, 0.0, 0.0, 0.0, inertia, inertia, inertia, 0.0, 0.0, 0.0);
  dBodySetMass(body_, &mass);
  dBodySetGyroscopicMode(body_, 0);
  plane_ = dJointCreatePlane2D(world_, nullptr);
  dJointAttach(plane_, body_, nullptr);
  const auto prepare = [this](const Axis& axis, SetMotor set) {
    if (!axis.moves) return lock(plane_, set);
    if (axis.stiffness > 0.0 || axis.damping > 0.0) set(plane_, dParamFMax, dInfinity);
  };
  prepare(system.x, dJointSetPlane2DXParam);
  prepare(system.y, dJointSetPlane2DYParam);
  prepare(system.phi, dJointSetPlane2DAngleParam);
  contacts_ = dJointGroupCreate(0);
}

OdeStep::~OdeStep() {
  dJointGroupDestroy(contacts_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(own_thread_);
}

void OdeStep::set_springs(const System& system, const State& state, double h) {
  set_spring(plane_, dJointSetPlane2DXParam, system.x, state.x, h);
  set_spring(plane_, dJointSetPlane2DYParam, system.y, state.y, h);
  set_spring(plane_, dJointSetPlane2DAngleParam, system.phi, state.phi, h);
}

/// A soft contact: N = max(0, k d + h d') at the end of the step, with ERP and CFM of k(n), h(n) and the step as they
/// are now.
void OdeStep::add_contact(const StepStart& start, Site site) {
  const System& system = start.system;
  const double h = start.duration;
  const State& state = start.book.placed.state;
  const ContactPoint& point = start.book.touching[static_cast<std::size_t>(site)];
  const double stiffness = h * point.stiffness, sum = stiffness + point.damping;
  dContact contact{};
  contact.surface.mode = dContactSoftERP | dContactSoftCFM | dContactMu2 | dContactFDir1 | dContactApprox1_1;
  contact.surface.soft_erp = stiffness / sum;
  contact.surface.soft_cfm = 1.0 / sum;
  contact.surface.mu = system.friction;
  contact.surface.mu2 = 0.0;  // across the plane nothing moves
  const double limit = system.friction * std::max(0.0, point.push());
  if (system.friction > 0.0 && system.regularization > 0.0) {
    if (limit > 0.0) {
      contact.surface.mode |= dContactSlip1;
      contact.surface.slip1 = slip_per_force(point.slip_velocity, system.regularization, limit);
    } else {
      contact.surface.mu = 0.0;
    }
  }
  contact.fdir1[0] = point.tangent.x;
  contact.fdir1[1] = point.tangent.y;
  contact.geom.pos[0] = state.x + point.lever.x;
  contact.geom.pos[1] = state.y + point.lever.y;
  contact.geom.normal[0] = point.normal.x;
  contact.geom.normal[1] = point.normal.y;
  contact.geom.depth = point.depth;
  ContactJoint& made = joints_[static_cast<std::size_t>(count_++)];
  made.site = site;
  const dJointID joint = dJointCreateContact(world_, contacts_, &contact);
  dJointAttach(joint, body_, nullptr);
  dJointSetFeedback(joint, &made.feedback);
}

int OdeStep::step(const StepStart& start, Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) {
  library_.enter_thread();
  const System& system = start.system;
  const State& s = start.book.placed.state;
  const double h = start.duration;
  const Load3 drive = start.drives.at(0.0);

  const dQuaternion upright = {1.0, 0.0, 0.0, 0.0};  // the tilt is in the contacts
  dBodySetPosition(body_, s.x, s.y, 0.0);
  dBodySetQuaternion(body_, upright);
  dBodySetLinearVel(body_, s.vx, s.vy, 0.0);
  dBodySetAngularVel(body_, 0.0, 0.0, s.omega);
  dBodySetForce(body_, drive.x, drive.y - system.weight, 0.0);
  dBodySetTorque(body_, 0.0, 0.0, drive.phi);
  set_springs(system, s, h);
  dJointGroupEmpty(contacts_);
  count_ = 0;
  for (int n = 0; n < start.sites.count; ++n) {
    const Site site = start.sites.sites[static_cast<std::size_t>(n)];
    if (may_push(system, start.book, site)) add_contact(start, site);
  }
  if (dWorldStep(world_, h) == 0) throw SolverFailure("ODE has no memory for a step");
  OdeLibrary::check_messages();

  const dReal* v = dBodyGetLinearVel(body_);
  State& end = segment.end;
  end.vx = system.x.moves ? v[0] : s.vx;
  end.vy = v[1];
  end.omega = system.phi.moves ? dBodyGetAngularVel(body_)[2] : s.omega;
  end.x = s.x + h * end.vx;
  end.y = s.y + h * end.vy;
  end.phi = s.phi + h * end.omega;

  set_first_order_motion(start, drive, segment);
  const PlacedState placed(end);
  const double reach = system.half_width + system.base_distance + system.slot_half_width;
  const double speed = std::abs(end.vx) + std::abs(end.vy) + reach * std::abs(end.omega);
  for (int i = 0; i < count_; ++i) {
    const Site site = joints_[static_cast<std::size_t>(i)].site;
    const auto index = static_cast<std::size_t>(site);
    const dReal* force = joints_[static_cast<std::size_t>(i)].feedback.f1;
    const ContactPoint& p = start.book.touching[index];
    StepForces forces;
    forces.normal = std::max(0.0, force[0] * p.normal.x + force[1] * p.normal.y);
    forces.tangential = force[0] * p.tangent.x + force[1] * p.tangent.y;
    // V as ODE has solved for it; beside the creep at full friction, so that a part at rest sticks without any force
    const double moved = end.vx * p.tangent.x + end.vy * p.tangent.y + end.omega * p.tangent_lever();
    forces.sticks = std::abs(moved) <= 2.0 * kHard * system.friction * forces.normal + kStill * speed;
    add_first_order_contact(start, site, forces, placed, segment, slip_at_end);
  }
  return 1;
}

}  // namespace vibratory_alignment
