#include "solver/layer_coupling.h"

#include <cmath>

#include <Eigen/LU>

namespace vibratory_alignment {
namespace {

constexpr int kStages = Collocation::kStages;

/// Derivatives of T = -f N tanh(V/eps) by N and by V.
struct Slope {
  double by_normal, by_slip;
};

Slope slope_at(const System& system, double normal_force, double friction_ratio) {
  const double f = system.friction;
  return {friction_ratio, -normal_force * (f - friction_ratio) * (f + friction_ratio) / (f * system.regularization)};
}

}  // namespace

void LayerCoupling::set(const StageModes& modes, double h, const ForceJacobian& jacobian, const Forces& start) {
  modes_ = &modes;
  h_ = h;
  jacobian_ = &jacobian;
  start_ = &start;
  for (std::size_t c = 0; c < static_cast<std::size_t>(jacobian.layer_count); ++c)
    for (std::size_t d = 0; d < static_cast<std::size_t>(jacobian.layer_count); ++d) {
      const LayerJacobian& at = jacobian.layer[c];
      const Eigen::Vector3d& push = jacobian.layer[d].push;
      const NormalJacobian& normal = jacobian.normal[static_cast<std::size_t>(at.contact)];
      normal_[c][d] = modes.response(normal.by_position, normal.by_velocity, push);
      slip_[c][d] = modes.response(at.slip_by_position, at.slip_by_velocity, push);
    }
}

Stages LayerCoupling::correction(const Stages& residual, const StageForces& forces, const StageNormals& acting) const {
  const Stages plain = modes_->correction(residual);
  const int count = jacobian_->layer_count;
  if (count == 0) return plain;

  // y: what T is at the stages beyond what one Jacobian says of it,
  // y = alpha (lag + dN + normal y) + beta (dV + slip y), dN, dV of the plain correction, lag what N is of the state
  // beyond the one that acts
  const Collocation& table = collocation();
  Eigen::Matrix<double, 3, kStages> dq = Eigen::Matrix<double, 3, kStages>::Zero(), dv = dq;
  for (int i = 0; i < kStages; ++i)
    for (int j = 0; j < kStages; ++j)
      for (int axis = 0; axis < 3; ++axis) {
        dv(axis, i) += h_ * table.velocity[i][j] * plain[j][axis];
        dq(axis, i) += h_ * h_ * table.position[i][j] * plain[j][axis];
      }
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost> matrix(kStages * count, kStages * count);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1> rhs(kStages * count);
  for (int c = 0; c < count; ++c) {
    const LayerJacobian& at = jacobian_->layer[static_cast<std::size_t>(c)];
    const auto contact = static_cast<std::size_t>(at.contact);
    const NormalJacobian& normal = jacobian_->normal[contact];
    const ContactForce& at_start = start_->contact[contact];
    const Slope start = slope_at(system_, at_start.normal_force, at_start.friction_ratio);
    for (int i = 0; i < kStages; ++i) {
      const ContactForce& force = forces[static_cast<std::size_t>(i)].contact[contact];
      const double acts = acting[static_cast<std::size_t>(i)][contact], lag = force.normal_force - acts;
      const Slope here = slope_at(system_, acts, force.friction_ratio);
      const double alpha = here.by_normal - start.by_normal, beta = here.by_slip - start.by_slip;
      const int row = kStages * c + i;
      rhs[row] = alpha * (lag + (normal.by_position * dq.col(i) + normal.by_velocity * dv.col(i)).value()) +
                 beta * (at.slip_by_position * dq.col(i) + at.slip_by_velocity * dv.col(i)).value();
      for (int d = 0; d < count; ++d)
        matrix.row(row).segment<kStages>(kStages * d) =
            -alpha * normal_[static_cast<std::size_t>(c)][static_cast<std::size_t>(d)].row(i) -
            beta * slip_[static_cast<std::size_t>(c)][static_cast<std::size_t>(d)].row(i);
      matrix(row, row) += 1.0;
    }
  }
  rhs = matrix.partialPivLu().solve(rhs).eval();
  Stages corrected = residual;
  for (int c = 0; c < count; ++c)
    for (int i = 0; i < kStages; ++i)
      for (int axis = 0; axis < 3; ++axis)
        corrected[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)] +=
            rhs[kStages * c + i] * jacobian_->layer[static_cast<std::size_t>(c)].push[axis];
  return modes_->correction(corrected);
}

}  // namespace vibratory_alignment
