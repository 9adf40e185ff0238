// Open Dynamics Engine: one body, its world stepped with dWorldStep; dry friction.
//
// Each step, as the manual's "How to use ODE" has it: forces on the body, then the contact joints, the step, the
// contact joints away again. The gripper's springs and dampers and the excitation are forces at the step's begin
// (semi-implicit Euler treats their positions so in any case). A contact of stiffness k and damping h is a joint with
// the manual's
//   ERP = dt k / (dt k + h),  CFM = 1 / (dt k + h)
// for this dt. Its point is the edge and its normal the face's, from the problem's own geometry: no collision
// detection. Friction is the pyramid mu N along the face. A Plane2D joint keeps the body in the x-y plane.
#include <ode/ode.h>

#include <cmath>
#include <type_traits>

#include "progress.h"
#include "report.h"

namespace va = vibratory_alignment::peers;

namespace {

static_assert(std::is_same_v<dReal, double>, "ODE in double precision is needed");

class World {
 public:
  explicit World(const va::Problem& problem) : p_(problem.parameters), world_(dWorldCreate()) {
    dMass mass;
    dMassSetParameters(&mass, 1.0, 0.0, 0.0, 0.0, p_.mu, p_.mu, p_.mu, 0.0, 0.0, 0.0);
    body_ = dBodyCreate(world_);
    dBodySetMass(body_, &mass);
    dBodySetGyroscopicMode(body_, 0);
    dBodySetFiniteRotationMode(body_, 1);
    const dJointID plane = dJointCreatePlane2D(world_, nullptr);
    dJointAttach(plane, body_, nullptr);
    contacts_ = dJointGroupCreate(0);

    const va::State& s = problem.start;
    dMatrix3 rotation;
    dRFromAxisAndAngle(rotation, 0.0, 0.0, 1.0, s[2]);
    dBodySetPosition(body_, s[0], s[1], 0.0);
    dBodySetRotation(body_, rotation);
    dBodySetLinearVel(body_, s[3], s[4], 0.0);
    dBodySetAngularVel(body_, 0.0, 0.0, s[5]);
  }
  ~World() {
    dJointGroupDestroy(contacts_);
    dWorldDestroy(world_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void step(double t, double dt) {
    const va::State s = state();
    va::Load load;
    add_excitations(p_, t, load);
    dBodyAddForce(body_, load.x - p_.h_x * s[3] - p_.k_x * (s[0] - p_.x_a),
                  load.y - p_.h_y * s[4] - (s[1] - p_.y_a) - p_.weight, 0.0);
    dBodyAddTorque(body_, 0.0, 0.0, load.moment - p_.h_phi * s[5] - p_.k_phi * (s[2] - p_.phi_a));
    const va::Mode mode = va::mode_of_start(p_, s.data());
    for (int edge = 0; edge < 2; ++edge) add_contact(s, edge, mode[static_cast<std::size_t>(edge)].face, dt);
    dWorldStep(world_, dt);
    dJointGroupEmpty(contacts_);
  }

  va::State state() const {
    const dReal* position = dBodyGetPosition(body_);
    const dReal* q = dBodyGetQuaternion(body_);
    const dReal* velocity = dBodyGetLinearVel(body_);
    return {position[0], position[1], 2.0 * std::atan2(q[3], q[0]),
            velocity[0], velocity[1], dBodyGetAngularVel(body_)[2]};
  }

 private:
  void add_contact(const va::State& s, int edge, va::Face face, double dt) {
    if (face == va::Face::none) return;
    const va::Contact c = contact_at(p_, s.data(), va::Tilt(s[2]), edge, face);
    dContact contact{};
    contact.surface.mode = dContactSoftERP | dContactSoftCFM | dContactMu2 | dContactFDir1 | dContactApprox1;
    contact.surface.mu = p_.f;
    contact.surface.mu2 = 0.0;
    contact.surface.soft_erp = dt * c.stiffness / (dt * c.stiffness + c.damping);
    contact.surface.soft_cfm = 1.0 / (dt * c.stiffness + c.damping);
    contact.geom.pos[0] = s[0] + c.lever.x;
    contact.geom.pos[1] = s[1] + c.lever.y;
    contact.geom.normal[0] = c.normal.x;
    contact.geom.normal[1] = c.normal.y;
    contact.geom.depth = c.depth;
    contact.fdir1[0] = c.tangent.x;
    contact.fdir1[1] = c.tangent.y;
    dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_, nullptr);
  }

  const va::Parameters& p_;
  dWorldID world_;
  dBodyID body_;
  dJointGroupID contacts_;
};

va::Outcome integrate(const va::Problem& problem, long steps) {
  World world(problem);
  const double dt = problem.end_time / static_cast<double>(steps);
  for (long i = 0; i < steps; ++i) world.step(dt * static_cast<double>(i), dt);
  return {world.state(), 0, steps, 0};
}

}  // namespace

int main(int argc, char** argv) {
  dInitODE2(0);
  for (const va::Problem& problem : va::chosen(va::dry_problems(), argc, argv))
    for (const long steps : va::step_counts())
      va::report("ode_world_step", problem.name, problem.end_time / static_cast<double>(steps),
                 [&] { return integrate(problem, steps); });
  dCloseODE();
}
