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

Slope slope_at(const System& system, const ContactForce& contact) {
  const double share = std::tanh(contact.slip_velocity / system.regularization);
  return {-system.friction * share,
          -system.friction * contact.normal_force * (1.0 - share) * (1.0 + share) / system.regularization};
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
      normal_[c][d] = modes.response(at.n_by_position, at.n_by_velocity, push);
      slip_[c][d] = modes.response(at.slip_by_position, at.slip_by_velocity, push);
    }
}

Stages LayerCoupling::correction(const Stages& residual, const std::array<Forces, kStages>& forces) const {
  const Stages plain = modes_->correction(residual);
  const int count = jacobian_->layer_count;
  if (count == 0) return plain;

  // y: what T is at the stages beyond what one Jacobian says of it,
  // y = alpha (dN + normal y) + beta (dV + slip y), dN, dV of the plain correction
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
    const Slope start = slope_at(system_, start_->contact[contact]);
    for (int i = 0; i < kStages; ++i) {
      const Slope here = slope_at(system_, forces[static_cast<std::size_t>(i)].contact[contact]);
      const double alpha = here.by_normal - start.by_normal, beta = here.by_slip - start.by_slip;
      const int row = kStages * c + i;
      rhs[row] = alpha * (at.n_by_position * dq.col(i) + at.n_by_velocity * dv.col(i)).value() +
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
