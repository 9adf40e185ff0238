// Solver `ode`: the Open Dynamics Engine solves for the velocities at the end of a step, for one body in a plane on
// soft contacts that come from this project's own geometry (docs/solvers.md "ode").
#pragma once

#include <ode/ode.h>

#include "engine_ode/ode_library.h"
#include "solver/step_method.h"

namespace vibratory_alignment {

class OdeStep final : public StepMethod {
 public:
  explicit OdeStep(const System& system);
  ~OdeStep() override;
  OdeStep(const OdeStep&) = delete;
  OdeStep& operator=(const OdeStep&) = delete;

  int step(const StepStart& start, Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) override;

 private:
  struct ContactJoint {
    Site site = Site::a1;
    dJointFeedback feedback{};
  };

  void set_springs(const System& system, const State& state, double h);
  void add_contact(const StepStart& start, Site site);

  OdeLibrary library_;                     ///< before all that is of ODE
  dThreadingImplementationID own_thread_;  ///< worlds share one by default, and then cannot be in several threads
  dWorldID world_;
  dBodyID body_;
  dJointID plane_;          ///< keeps the body in the plane and carries the gripper's springs
  dJointGroupID contacts_;  ///< of the present step
  int count_ = 0;
  std::array<ContactJoint, kSiteCount> joints_;
};

}  // namespace vibratory_alignment
