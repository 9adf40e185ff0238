// Which tangential forces hold sticking contacts: G T = rhs exactly where that has one answer, the smallest forces
// where several contacts hold the same motion, nothing where nothing can be held.
#include "mechanics/mobility.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "mechanics/contact_frame.h"

namespace vibratory_alignment {
namespace {

using Vector = Mobility::Vector;
using Matrix = Mobility::Matrix;
using Row = std::array<double, 3>;  ///< M^-1/2 t of one contact

/// G = J J^T.
Matrix matrix_of(const std::vector<Row>& rows) {
  Matrix g{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows.size(); ++j)
      for (std::size_t k = 0; k < 3; ++k) g[i][j] += rows[i][k] * rows[j][k];
  return g;
}

/// J c: what a motion c does at the contacts, so that forces can hold it.
Vector image(const std::vector<Row>& rows, const Row& cause) {
  Vector rhs{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) rhs[i] += rows[i][k] * cause[k];
  return rhs;
}

std::vector<Row> random_rows(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::vector<Row> rows;
  for (int i = 0; i < count; ++i) rows.push_back({u(random), u(random), 3.0 * u(random)});
  return rows;
}

double product(const Matrix& g, int count, int row, const Vector& force) {
  double sum = 0.0;
  for (int j = 0; j < count; ++j) sum += g[row][j] * force[j];
  return sum;
}

double square(const Vector& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return sum;
}

Mobility mobility_of(const Matrix& g, int count, double typical = 1.0) {
  Mobility mobility;
  mobility.set(g, count, typical);
  return mobility;
}

/// Independent motions at the contacts, by more than what counts as common.
bool is_regular(const Matrix& g, int count) {
  Eigen::MatrixXd dense(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) dense(i, j) = g[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return Eigen::FullPivLU<Eigen::MatrixXd>(dense).setThreshold(1e-7).isInvertible();
}

// The residual of a backward stable solution is rounding beside |G| |T|, however large T is.
TEST(Mobility, a_regular_matrix_is_solved_to_roundoff) {
  std::mt19937 random(26);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int count = 1; count <= 3; ++count)
    for (int i = 0; i < 200; ++i) {
      const Matrix g = matrix_of(random_rows(random, count));
      if (!is_regular(g, count)) continue;
      const Mobility mobility = mobility_of(g, count);
      Vector rhs{};
      for (int j = 0; j < count; ++j) rhs[j] = u(random);
      const Vector force = mobility.hold(rhs, {});
      for (int j = 0; j < count; ++j) {
        const double scale = 9.0 * std::sqrt(square(force)) * count;
        EXPECT_NEAR(product(g, count, j, force), rhs[j], 1e-15 * scale);
        EXPECT_EQ(mobility.left_over(j, rhs, {}), -rhs[j]);
        EXPECT_NEAR(mobility.left_over(j, rhs, force), 0.0, 1e-15 * scale);
      }
    }
}

// Contacts that hold the same motion (a flat part on both of its corners): which of them does is open, and they share.
TEST(Mobility, equal_contacts_share_equally) {
  for (int count = 2; count <= kSiteCount; ++count)
    for (const double size : {1.0, 7.3, 1e-3, 1e4}) {
      const std::vector<Row> rows(static_cast<std::size_t>(count), Row{std::sqrt(size), 0, 0});
      Vector rhs{};
      std::fill_n(rhs.begin(), count, 0.37);
      const Vector force = mobility_of(matrix_of(rows), count, size).hold(rhs, {});
      for (int i = 0; i < count; ++i)
        EXPECT_NEAR(force[i], 0.37 / (count * size), 1e-14 / size) << count << " contacts, G = " << size;
    }
}

// What moves in opposite directions at two equal contacts cannot be held: their mean is, and the difference is left.
TEST(Mobility, what_cannot_be_held_is_left_over) {
  const Mobility mobility = mobility_of(matrix_of({{1, 0, 0}, {1, 0, 0}}), 2);
  const Vector rhs{0.3, 0.5}, force = mobility.hold(rhs, {});
  EXPECT_NEAR(force[0], 0.2, 1e-15);
  EXPECT_NEAR(force[1], 0.2, 1e-15);
  EXPECT_NEAR(mobility.left_over(0, rhs, force), 0.1, 1e-15);
  EXPECT_NEAR(mobility.left_over(1, rhs, force), -0.1, 1e-15);
}

/// The smallest T with J J^T T = J c, for J of three independent columns: J^T T = c, T = J (J^T J)^-1 c.
Vector smallest_force(const std::vector<Row>& rows, const Row& cause) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Row& row : rows) {
    const Eigen::Vector3d r(row[0], row[1], row[2]);
    sum += r * r.transpose();
  }
  const Eigen::Vector3d y = sum.inverse() * Eigen::Vector3d(cause[0], cause[1], cause[2]);
  return image(rows, {y[0], y[1], y[2]});
}

TEST(Mobility, more_contacts_than_motions_take_the_smallest_forces) {
  std::mt19937 random(27);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int count = 4; count <= kSiteCount; ++count)
    for (int i = 0; i < 100; ++i) {
      const std::vector<Row> rows = random_rows(random, count);
      const Row cause{u(random), u(random), u(random)};
      const Matrix g = matrix_of(rows);
      const Mobility mobility = mobility_of(g, count);
      const Vector rhs = image(rows, cause), force = mobility.hold(rhs, {}), smallest = smallest_force(rows, cause);
      const double size = std::sqrt(square(smallest));
      for (int j = 0; j < count; ++j) {
        EXPECT_NEAR(product(g, count, j, force), rhs[j], 1e-12 * (1.0 + size));
        EXPECT_NEAR(force[j], smallest[j], 1e-9 * size) << count << " contacts, problem " << i;
      }
    }
}

/// Two contacts whose levers differ by `off`, and forces on them that are far from equal.
struct NearlyEqual {
  explicit NearlyEqual(double off)
      : rows{{1, 0, 0}, {1, off, 0}}, matrix(matrix_of(rows)), mobility(mobility_of(matrix, 2)) {
    for (int i = 0; i < 2; ++i) rhs[static_cast<std::size_t>(i)] = product(matrix, 2, i, exact);
  }
  std::vector<Row> rows;
  Matrix matrix;
  Mobility mobility;
  Vector exact{3.0, -1.0}, rhs{};
};

TEST(Mobility, nearly_equal_levers_are_solved_where_the_motion_asks_for_it) {
  for (const double off : {1e-5, 3e-6, 1e-6}) {
    const NearlyEqual two(off);
    const Vector force = two.mobility.hold(two.rhs, {});
    for (std::size_t i = 0; i < 2; ++i) {
      // the last digit of G, seen through the small pivot
      EXPECT_NEAR(force[i], two.exact[i], 20.0 * 2.2e-16 / (off * off)) << off;
      EXPECT_NEAR(two.mobility.left_over(static_cast<int>(i), two.rhs, force), 0.0, 1e-14);
    }
  }
}

TEST(Mobility, nearly_equal_levers_share_where_noise_covers_the_difference) {
  for (const double off : {1e-5, 1e-6, 1e-8}) {
    const NearlyEqual two(off);
    // equal forces, 1 and 1, leave 2 off^2; those that suit one lever between the two leave about off
    const double noise = 4.0 * off;
    const Vector force = two.mobility.hold(two.rhs, {noise, noise});
    EXPECT_NEAR(force[0], 1.0, 4.0 * off);
    EXPECT_NEAR(force[1], 1.0, 4.0 * off);
    EXPECT_LT(square(force), 0.5 * square(two.exact));
    for (int i = 0; i < 2; ++i) EXPECT_LE(std::abs(two.mobility.left_over(i, two.rhs, force)), noise);
  }
}

// A normal force that points into a wall: friction along it moves nothing that can move.
TEST(Mobility, a_matrix_of_rounding_holds_nothing) {
  for (const double g : {0.0, 1e-30, 1e-17, 1e-15})
    for (int count = 1; count <= 3; ++count) {
      Matrix matrix{};
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) matrix[i][j] = i == j ? g : -0.3 * g;
      const Mobility mobility = mobility_of(matrix, count, 1.0);
      const Vector rhs{0.3, -2.0, 1e10}, force = mobility.hold(rhs, {});
      for (std::size_t i = 0; i < kSiteCount; ++i) EXPECT_EQ(force[i], 0.0) << g;
      for (int i = 0; i < count; ++i) EXPECT_EQ(mobility.left_over(i, rhs, force), -rhs[static_cast<std::size_t>(i)]);
    }
  // the same numbers are no rounding where everything is as small
  Matrix small{};
  small[0][0] = 1e-15;
  EXPECT_NEAR(mobility_of(small, 1, 1e-14).hold({0.3}, {})[0], 3e14, 1.0);
}

// No corner of the part is much more mobile, in any direction; locked motions do not count.
TEST(Mobility, the_typical_one_is_that_of_the_corners) {
  for (const char* locked : {"name=none", "gripper.stiffness.x=null", "part.inertia=null"}) {
    const System system = make_system(test::scene_of(test::plain, {locked, "initial={x: 0.21, y: 0.95, phi: 0.02}"}));
    const double typical = typical_mobility(system);
    double largest = 0.0;
    for (const Site site : {Site::b1, Site::b2})
      for (const Face face : {Face::top, Face::right_wall}) {
        const ContactKinematics k = contact_kinematics(system, system.start, site, face);
        const double moment = k.lever.x * k.tangent.y - k.lever.y * k.tangent.x;
        largest = std::max(largest, k.tangent.x * k.tangent.x * system.x.inverse_inertia +
                                        k.tangent.y * k.tangent.y * system.y.inverse_inertia +
                                        moment * moment * system.phi.inverse_inertia);
      }
    EXPECT_GE(typical, largest) << locked;
    EXPECT_LE(typical, 4.0 * largest) << locked;
  }
}

}  // namespace
}  // namespace vibratory_alignment
