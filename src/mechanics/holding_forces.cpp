#include "mechanics/holding_forces.h"

#include <algorithm>
#include <cmath>

#include "mechanics/mobility.h"

namespace vibratory_alignment {
namespace {

/// Rows of J that differ by less than this count as the same.
constexpr double kSame = 4e-8;

/// Rows that differ by less than this amplify rounding too much to be told apart where it is not needed.
constexpr double kNearlySame = 1e-4;

/// A mobility that is rounding beside that of the part.
constexpr double kNoMobility = 2e-15;

/// Ratio beyond which the less mobile axis does not move at all.
constexpr double kMotionless = 1e60;

/// Products with the inverse until rhs is met to rounding.
constexpr int kPasses = 2;

/// Rounding of V' relative to the sizes of its terms.
constexpr double kSlipRateRounding = 1e-14;

/// Of the axes, that of phi at the part's reach.
std::array<double, 3> mobilities(const System& system) {
  const double reach = system.half_width + system.base_distance;
  return {system.x.inverse_inertia, system.y.inverse_inertia, reach * reach * system.phi.inverse_inertia};
}

}  // namespace

SingleHold single_hold(const System& system) {
  const std::array<double, 3> of_axes = mobilities(system);
  const double most = std::max({of_axes[0], of_axes[1], of_axes[2]});
  double least = most;
  for (const double mobility : of_axes)
    if (mobility * kMotionless > most) least = std::min(least, mobility);
  return {most > kUnequalMobility * least, kNoMobility * typical_mobility(system)};
}

/// J, rows of count_ contacts; columns from the most mobile axis to the least: as a row of (V M^-1/2)^T the first must
/// not cost the digits of the others.
HoldingForces::Decomposition HoldingForces::decompose() const {
  Decomposition result;
  std::sort(result.axes.begin(), result.axes.end(), [&](int a, int b) { return scale_[a] > scale_[b]; });
  Plane plane = Plane::Zero(count_, 3);
  for (int i = 0; i < count_; ++i) {
    const double row[3] = {rows_[i].x, rows_[i].y, rows_[i].moment / reach_};
    for (int a = 0; a < 3; ++a)
      if (scale_[result.axes[a]] > 0.0) plane(i, a) = row[result.axes[a]];
  }
  result.qr.compute(plane);
  return result;
}

int HoldingForces::Decomposition::rank(double singular) {
  qr.setThreshold(singular);
  return static_cast<int>(qr.rank());
}

/// Two steps, for the rank is one of J, the size that of J M^-1/2: J = Q V with orthonormal columns of Q,
/// (Q V M^-1/2)^+ = (V M^-1/2)^+ Q^T.
HoldingForces::Factor HoldingForces::factorize(Decomposition& decomposed, double singular) const {
  using Tall = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;
  using Orthonormal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSiteCount, 3>;
  const auto& [qr, axes] = decomposed;
  Factor factor;
  factor.rank = decomposed.rank(singular);
  factor.inverse = Inverse::Zero(3, count_);
  if (factor.rank == 0) return factor;
  Tall tall = Tall::Zero(3, factor.rank);
  for (int c = 0; c < 3; ++c) {
    const int a = qr.colsPermutation().indices()[c];
    for (int i = 0; i < factor.rank && i <= c; ++i) tall(a, i) = qr.matrixQR()(i, c) * scale_[axes[a]];
  }
  Orthonormal q = Orthonormal::Identity(count_, factor.rank);
  q.applyOnTheLeft(qr.householderQ());
  Eigen::CompleteOrthogonalDecomposition<Tall> decomposition;
  decomposition.setThreshold(0.0);
  decomposition.compute(tall);
  using Wide = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3>;
  const Wide pseudo_inverse = decomposition.solve(Eigen::Matrix3d::Identity());
  const Inverse inverse = pseudo_inverse.transpose() * q.transpose();
  for (int a = 0; a < 3; ++a) factor.inverse.row(axes[a]) = inverse.row(a);
  if (factor.rank < count_) share_alike(singular, factor);
  return factor;
}

/// Contacts that count as the same take the same force to the last digit: so they reach the limit of friction together.
void HoldingForces::share_alike(double singular, Factor& factor) const {
  const auto alike = [&](const TangentRow& a, const TangentRow& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.moment - b.moment) / reach_}) <= singular;
  };
  std::array<bool, kSiteCount> done{};
  for (int i = 0; i < count_; ++i) {
    if (done[i]) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::array<int, kSiteCount> group{};
    int size = 0;
    for (int j = i; j < count_; ++j) {
      if (done[j] || !alike(rows_[i], rows_[j])) continue;
      done[j] = true;
      group[size++] = j;
      sum += factor.inverse.col(j);
    }
    for (int g = 0; g < size; ++g) factor.inverse.col(group[g]) = sum / size;
  }
}

void HoldingForces::set(const System& system, const Rows& rows, int count) {
  rows_ = rows;
  count_ = count;
  regular_ = true;
  delicate_ = holds_nothing_ = false;
  inverse_inertia_ = {system.x.inverse_inertia, system.y.inverse_inertia, system.phi.inverse_inertia};
  if (count == 0) return;
  reach_ = system.half_width + system.base_distance;
  double largest = 0.0;
  for (int i = 0; i < count; ++i) largest = std::max(largest, mobility(i));
  const SingleHold single = single_hold(system);
  holds_nothing_ = largest <= single.least_mobility;
  delicate_ = single.delicate;
  regular_ = !holds_nothing_;
  single_ = {mobility(0), inverse_inertia_[0] * rows[0].x, inverse_inertia_[1] * rows[0].y,
             inverse_inertia_[2] * rows[0].moment};
  if (count == 1 || holds_nothing_) return;
  scale_ = mobilities(system);
  for (double& scale : scale_) scale = std::sqrt(scale);
  Decomposition decomposed = decompose();
  safe_ = factorize(decomposed, kNearlySame);
  // where both are of the same rank, only the first is used
  full_.rank = decomposed.rank(kSame);
  if (full_.rank != safe_.rank) full_ = factorize(decomposed, kSame);
  regular_ = safe_.rank == count;
  delicate_ = delicate_ || !regular_;
}

/// G_ii.
double HoldingForces::mobility(int i) const {
  const TangentRow& row = rows_[i];
  return inverse_inertia_[0] * row.x * row.x + inverse_inertia_[1] * row.y * row.y +
         inverse_inertia_[2] * row.moment * row.moment;
}

/// Where rows are nearly the same the inverse is large, and its product with rhs inexact: what is left is taken out
/// once more.
HoldingForces::Answer HoldingForces::hold_with(const Factor& factor, const Vector& rhs) const {
  Answer answer;
  answer.told_apart = factor.rank > safe_.rank;
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  for (int pass = 0; pass < kPasses; ++pass) {
    Vector left{};
    for (int i = 0; i < count_; ++i) left[i] = left_over(i, rhs, answer);
    for (int i = 0; i < count_; ++i) motion -= factor.inverse.col(i) * left[i];
    answer.x = scale_[0] * motion[0];
    answer.y = scale_[1] * motion[1];
    answer.phi = scale_[2] / reach_ * motion[2];
  }
  for (int i = 0; i < count_; ++i) answer.force[i] = factor.inverse.col(i).dot(motion);
  return answer;
}

HoldingForces::Answer HoldingForces::hold(const Vector& rhs, const Vector& noise) const {
  if (count_ == 0 || holds_nothing_) return {};
  if (count_ == 1) return hold_one(rhs[0]);
  const Answer answer = hold_with(safe_, rhs);
  if (safe_.rank == full_.rank) return answer;
  bool exact = true;
  for (int i = 0; i < count_; ++i) exact = exact && std::abs(left_over(i, rhs, answer)) <= noise[i];
  return exact ? answer : hold_with(full_, rhs);
}

HoldingForces::Answer HoldingForces::hold_motion_with(const Factor& factor, const Answer& motion,
                                                      const Vector& own_rates) const {
  // where contacts hold every axis, nothing is left of the motion, not even its rounding
  const bool holds_all = factor.rank == std::count_if(scale_.begin(), scale_.end(), [](double s) { return s > 0.0; });
  Vector rates{};
  for (int i = 0; i < count_; ++i) rates[i] = (holds_all ? 0.0 : -left_over(i, {}, motion)) - own_rates[i];
  Answer held = hold_with(factor, rates);
  const double rate[3] = {motion.x, motion.y, motion.phi * reach_};
  Eigen::Vector3d asked = Eigen::Vector3d::Zero();
  for (int a = 0; a < 3; ++a)
    if (scale_[a] > 0.0) asked[a] = rate[a] / scale_[a];
  for (int i = 0; i < count_; ++i) asked += factor.inverse.col(i) * own_rates[i];
  for (int i = 0; i < count_; ++i) held.force[i] = -factor.inverse.col(i).dot(asked);
  return holds_all ? held : left_of(motion, held);
}

HoldingForces::Answer HoldingForces::hold_motion(const Answer& motion, const Vector& own_rates,
                                                 const Vector& noise) const {
  if (count_ == 0 || holds_nothing_) return motion;
  if (count_ == 1) return hold_motion_of_one(motion, own_rates[0]);
  const Answer held = hold_motion_with(safe_, motion, own_rates);
  if (safe_.rank == full_.rank) return held;
  bool exact = true;
  for (int i = 0; i < count_; ++i) exact = exact && std::abs(left_over(i, {}, held) + own_rates[i]) <= noise[i];
  return exact ? held : hold_motion_with(full_, motion, own_rates);
}

HoldingForces::Answer HoldingForces::hold_motion(const Answer& motion, const Vector& own_rates) const {
  const auto noise_of = [&](const Answer& now) {
    Vector noise{};
    for (int i = 0; i < count_; ++i)
      noise[i] = kSlipRateRounding * (std::abs(rows_[i].x * now.x) + std::abs(rows_[i].y * now.y) +
                                      std::abs(rows_[i].moment * now.phi) + std::abs(own_rates[i]));
    return noise;
  };
  Answer held = hold_motion(motion, own_rates, noise_of(motion));
  if (!delicate_) return held;
  const auto taken_out_once_more = [&] {
    Vector rates{};
    for (int i = 0; i < count_; ++i) rates[i] = -left_over(i, {}, held) - own_rates[i];
    return hold(rates, noise_of(held));
  };
  Answer correction = taken_out_once_more();
  if (correction.told_apart && !held.told_apart) {  // T are then those of the motion, told apart as well
    held = hold_motion(motion, own_rates, {});
    correction = taken_out_once_more();
  }
  held.x += correction.x;
  held.y += correction.y;
  held.phi += correction.phi;
  return held;
}

HoldingForces::Answer HoldingForces::respond(const TangentRow& load, bool told_apart) const {
  Answer motion;
  motion.x = inverse_inertia_[0] * load.x;
  motion.y = inverse_inertia_[1] * load.y;
  motion.phi = inverse_inertia_[2] * load.moment;
  Vector rates{}, noise{};
  for (int i = 0; i < count_; ++i) rates[i] = -left_over(i, {}, motion);
  if (!told_apart) noise.fill(INFINITY);
  const Answer change = hold(rates, noise);
  motion.x += change.x;
  motion.y += change.y;
  motion.phi += change.phi;
  return motion;
}

double HoldingForces::left_over(int row, const Vector& rhs, const Answer& answer) const {
  return rows_[row].x * answer.x + rows_[row].y * answer.y + rows_[row].moment * answer.phi - rhs[row];
}

HoldingForces::Vector HoldingForces::spread(const Vector& noise) const {
  Vector error{};
  if (count_ == 0 || holds_nothing_) return error;
  if (count_ == 1) {
    error[0] = noise[0] / single_.mobility;
    return error;
  }
  for (int i = 0; i < count_; ++i)
    for (int j = 0; j < count_; ++j) error[i] += std::abs(safe_.inverse.col(i).dot(safe_.inverse.col(j))) * noise[j];
  return error;
}

}  // namespace vibratory_alignment
