// Contacts in the tanh layer whose ring grows: what is told of one is what the eigenvalues of the whole part say.
#include "solver/layer_flutter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <random>

#include "../support/runs.h"
#include "../support/scenes.h"
#include "mechanics/contact_frame.h"
#include "solver/collocation.h"

namespace vibratory_alignment {
namespace {

/// A part on the edge a1, in the layer.
struct InLayer {
  System system;
  ForceJacobian jacobian;
  Forces forces;
};

InLayer in_layer(std::mt19937& random) {
  std::uniform_real_distribution<double> u(0.0, 1.0);
  Scene scene = test::scene_of(test::plain, {"part.base_distance=2.2", "initial.y=2.2"});
  scene.friction = Friction{1.0 + 4.0 * u(random), 3e-4};
  scene.base.stiffness_x = scene.base.stiffness_y = std::pow(10.0, 6.0 + 4.0 * u(random));
  scene.base.damping_x = scene.base.damping_y = 4.0 * u(random) * std::sqrt(scene.base.stiffness_y);
  InLayer part{make_system(scene), {}, {}};
  State state = part.system.start;
  state.x = 2.0 * u(random) - 1.0;
  state.phi = 0.4 * u(random) - 0.2;
  state.vx = 2e-3 * (u(random) - 0.5);
  const double gap = -contact_kinematics(part.system, state, Site::a1, Face::bottom).depth;
  state.y -= (gap + 5.0 * u(random) / scene.base.stiffness_y) / std::cos(state.phi);
  ContactStates contacts{};
  contacts[0] = {Phase::loaded, Face::bottom, Slip::regularized};
  evaluate_forces(part.system, state, {}, contacts, part.forces);
  part.jacobian = force_jacobian(part.system, state, contacts, part.forces);
  return part;
}

/// Largest rate of growth of a pair that rings faster than `rate`; none: -infinity.
double growth_of_pairs(const ForceJacobian& jacobian, double rate) {
  Eigen::Matrix<double, 6, 6> motion = Eigen::Matrix<double, 6, 6>::Zero();
  motion.topRightCorner<3, 3>().setIdentity();
  motion.bottomLeftCorner<3, 3>() = jacobian.by_position;
  motion.bottomRightCorner<3, 3>() = jacobian.by_velocity;
  double most = -INFINITY;
  const Eigen::Matrix<std::complex<double>, 6, 1> rates = motion.eigenvalues();
  for (int i = 0; i < 6; ++i)
    if (rates[i].imag() != 0.0 && std::abs(rates[i]) > rate) most = std::max(most, rates[i].real());
  return most;
}

TEST(LayerFlutter, is_what_the_eigenvalues_tell) {
  std::mt19937 random(1);
  int grow = 0, decay = 0;
  for (int i = 0; i < 2000; ++i) {
    const InLayer part = in_layer(random);
    if (!(part.forces.contact[0].normal_force > 0.0)) continue;
    for (const double h : {1e-3, 1e-2}) {
      const double growth = h * growth_of_pairs(part.jacobian, 3.0 / (h * collocation().eigenvalue[0].real()));
      if (std::isinf(growth) || (growth > 0.05 && growth < 0.2)) continue;
      EXPECT_EQ(flutters_within(h, part.jacobian), growth > 0.1) << i << " " << growth;
      ++(growth > 0.1 ? grow : decay);
    }
  }
  EXPECT_GT(grow, 100);
  EXPECT_GT(decay, 100);
}

// Steps that go along the ring are none that damp it.
TEST(LayerFlutter, is_followed_by_short_steps) {
  std::mt19937 random(1);
  int followed = 0;
  for (int i = 0; i < 2000; ++i) {
    const InLayer part = in_layer(random);
    if (!flutters_within(1e-2, part.jacobian)) continue;
    EXPECT_FALSE(flutters_within(1e-8, part.jacobian)) << i;
    ++followed;
  }
  EXPECT_GT(followed, 50);
}

// An edge that slides in the layer under f = 3: as the part comes down its ring begins to grow, from the last digits,
// until the part lets go. When that is, the last digits say; that it is, every method.
TEST(LayerFlutter, lets_the_part_go) {
  const Scene scene = test::scene_of(R"(
part: {half_width: 1, base_distance: 2.2, inertia: 0.7}
slot: {clearance: 0.006}
gripper: {stiffness: {x: 0, phi: 1.7e+02}, damping: {x: 1.7, y: 0, phi: 0}, anchor: {x: 0, phi: -0.03}, pressing_force: 3.4}
base: {stiffness: {x: 3e+08, y: 1}, damping: {x: 2e+04, y: 0}}
contacts: [edges]
friction: {coefficient: 3, regularization: 0.00033}
weight: 1.4
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.13, y: 2.227, phi: -0.06}
trial: {time_limit: 0.23}
)");
  for (const char* solver : {"event", "implicit", "auto"}) {
    Scene by_solver = scene;
    by_solver.solver.name = solver;
    double release = 0.0;
    for (const test::TimedEvent& event : test::events_of(by_solver))
      if (event.event.kind == EventKind::release) release = event.time;
    EXPECT_NEAR(release, 0.228, 1e-3) << solver;
  }
}

}  // namespace
}  // namespace vibratory_alignment
