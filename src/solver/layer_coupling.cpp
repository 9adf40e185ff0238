#include "solver/layer_coupling.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vibratory_alignment {
namespace {

constexpr std::size_t kStages = StageTable::kStages;

/// Derivatives of T = -f N tanh(V/eps) by N and by V.
template <typename Number>
struct Slope {
  Number by_normal, by_slip;
};

template <typename Number>
VIBRATORY_ALIGNMENT_INLINE Slope<Number> slope_at(const System& system, const Number& normal_force,
                                                  const Number& friction_ratio) {
  const double f = system.friction;
  return {friction_ratio, -normal_force * (f - friction_ratio) * (f + friction_ratio) / (f * system.regularization)};
}

/// Equations of all stages of `count` layer contacts, at most kMost. A row is an Octet for each contact; the last place
/// of the last one is the right-hand side.
template <std::size_t kMost>
class RowEquations {
 public:
  using Row = std::array<Octet, kMost>;

  explicit RowEquations(std::size_t count) : contacts_(kMost == 1 ? 1 : count) {}
  VIBRATORY_ALIGNMENT_INLINE Row& row(std::size_t contact, std::size_t stage) {
    return rows_[kStages * contact + stage];
  }
  /// The right-hand side, and once solved the unknown.
  VIBRATORY_ALIGNMENT_INLINE double& right(std::size_t row) { return rows_[row][contacts_ - 1][kStages]; }

  /// Gauss's elimination with the largest pivots.
  VIBRATORY_ALIGNMENT_INLINE void solve() {
    const std::size_t count = kStages * contacts_;
    std::array<double, kStages * kMost> inverse;
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < count; ++i)
        if (std::abs(entry(i, k)) > std::abs(entry(pivot, k))) pivot = i;
      if (pivot != k) std::swap(rows_[pivot], rows_[k]);
      inverse[k] = 1.0 / entry(k, k);
      for (std::size_t i = k + 1; i < count; ++i) {
        const double factor = entry(i, k) * inverse[k];
        for (std::size_t c = k / kStages; c < contacts_; ++c) rows_[i][c] -= factor * rows_[k][c];
      }
    }
    for (std::size_t k = count; k-- > 0;) {
      double left = right(k);
      for (std::size_t i = k + 1; i < count; ++i) left -= entry(k, i) * right(i);
      right(k) = left * inverse[k];
    }
  }

 private:
  VIBRATORY_ALIGNMENT_INLINE double entry(std::size_t row, std::size_t column) const {
    return rows_[row][column / kStages][column % kStages];
  }

  std::size_t contacts_;
  std::array<Row, kStages * kMost> rows_;
};

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
      modes.response(normal.by_position, normal.by_velocity, push, normal_[c][d]);
      modes.response(at.slip_by_position, at.slip_by_velocity, push, slip_[c][d]);
    }
}

/// Adds to the plain correction what friction at the stages is beyond that of one Jacobian:
/// y = alpha (lag + dN + normal y) + beta (dV + slip y), dN, dV of the plain correction, lag what N is of the state
/// beyond the one that acts.
template <std::size_t kMost>
VIBRATORY_ALIGNMENT_INLINE void LayerCoupling::correct_layer_of(const Stages& residual, const ForcesOctet& forces,
                                                                const NormalForcesOctet& acting,
                                                                Stages& correction) const {
  const std::size_t count = kMost == 1 ? 1 : static_cast<std::size_t>(jacobian_->layer_count);
  RowEquations<kMost> equations(count);
  for (std::size_t c = 0; c < count; ++c) {
    const LayerJacobian& at = jacobian_->layer[c];
    const auto contact = static_cast<std::size_t>(at.contact);
    const NormalJacobian& normal = jacobian_->normal[contact];
    const ContactForce& at_start = start_->contact[contact];
    const ContactForceOctet& force = forces.contact[contact];
    const auto start = slope_at(system_, at_start.normal_force, at_start.friction_ratio);
    const auto here = slope_at(system_, acting[contact], force.friction_ratio);
    const Octet alpha = here.by_normal - start.by_normal, beta = here.by_slip - start.by_slip;
    const Octet lag = force.normal_force - acting[contact];
    const Octet right = alpha * (lag + change_at_stages(normal.by_position, normal.by_velocity, h_, correction)) +
                        beta * change_at_stages(at.slip_by_position, at.slip_by_velocity, h_, correction);
    for (std::size_t i = 0; i < kStages; ++i) {
      auto& row = equations.row(c, i);
      for (std::size_t d = 0; d < count; ++d) row[d] = -alpha[i] * normal_[c][d][i] - beta[i] * slip_[c][d][i];
      row[c][i] += 1.0;
      equations.right(kStages * c + i) = right[i];
    }
  }
  equations.solve();
  Stages pushed = residual;
  for (std::size_t c = 0; c < count; ++c) {
    Octet y;
    for (std::size_t i = 0; i < Octet::kSize; ++i) y[i] = equations.right(kStages * c + std::min(i, kStages - 1));
    for (std::size_t axis = 0; axis < 3; ++axis)
      pushed[axis] += jacobian_->layer[c].push[static_cast<Eigen::Index>(axis)] * y;
  }
  modes_->correction(pushed, correction);
}

void LayerCoupling::correct_layer(const Stages& residual, const ForcesOctet& forces, const NormalForcesOctet& acting,
                                  Stages& correction) const {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    if (jacobian_->layer_count == 1)
      correct_layer_of<1>(residual, forces, acting, correction);
    else
      correct_layer_of<kSiteCount>(residual, forces, acting, correction);
  });
}

}  // namespace vibratory_alignment
