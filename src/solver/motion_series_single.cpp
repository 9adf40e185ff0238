// Part of MotionSeries: the most frequent case, one contact that slides, in a loop of its own.
#include <cmath>

#include "mechanics/quad.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {
namespace {

/// Powers as factors of products, each number as often as it is needed. The product of power k sums left j with
/// right k - j.
struct LeftFactors {
  Quad direction;  ///< c, s, c, s
  Quad moment;     ///< tanh law: c, s, and the moments per unit of N and of T
  Quad layer;      ///< tanh law: tanh, tanh, 1 - tanh^2, -
};
struct RightFactors {
  Quad turn_push;  ///< omega, omega, N, N
  Quad centre;     ///< x, x, y, y of the next power
  Quad moment;     ///< tanh law: T, T, N, T
  Quad layer;      ///< tanh law: tanh, N, V' of the power before, -
};

}  // namespace

/// The whole expansion for one contact that slides (or whose friction is regularised) on a base whose stiffness does
/// not turn: the same recurrences, in one loop. All products of series whose factors are known when a power begins are
/// summed together; what a power itself finds is added as its last term, by constant factors: the way from one velocity
/// to the next, on which the powers wait for one another, is kept short.
template <bool kEdge, bool kTurns, bool kTanh>
VIBRATORY_ALIGNMENT_INLINE void MotionSeries::expand_single_of(Segment& segment) {
  const Contact& contact = contacts_[0];
  ContactSeries& series = segment.loaded[0];
  PairSeries& point = points_[contact.point];
  const int order = segment.order;
  const ContactFrame& f = contact.frame;
  const double side = side_of(contact.site), l = side * system_.slot_half_width, beta = side * system_.half_width,
               b0 = system_.base_distance;
  const double depth_1 = f.sign * f.n1, depth_2 = f.sign * f.n2, slip_1 = -f.sign * f.t1(), slip_2 = -f.sign * f.t2();
  // forces per unit of N (sliding friction included) and of T, in the axes of the frame
  const double push_1 = kTanh ? f.n1 : contact.force1, push_2 = kTanh ? f.n2 : contact.force2;
  const double drag_1 = f.t1(), drag_2 = f.t2();
  const double fast_x = system_.x.inverse_inertia, fast_y = system_.y.inverse_inertia,
               fast_phi = system_.phi.inverse_inertia, slope = kTanh ? 1.0 / system_.regularization : 0.0;
  // moments of both about the mass centre per unit of (cos, sin) times them: corners
  const double push_c_arm = push_1 * b0 + push_2 * beta, push_s_arm = push_2 * b0 - push_1 * beta,
               drag_c_arm = drag_1 * b0 + drag_2 * beta, drag_s_arm = drag_2 * b0 - drag_1 * beta;
  LeftFactors left[kMaxOrder + 1];
  RightFactors right[kMaxOrder + 1];
  double push_moment[kMaxOrder + 1], drag_moment_0 = 0.0;
  double tanh_0 = 0.0, tanh_rate = 0.0, tanh_force = 0.0;  // tanh, d tanh/dV and dT/d tanh, all at power 0
  const double x_0 = segment.x[0], y_0 = segment.y[0], c_0 = segment.cos_phi[0], s_0 = segment.sin_phi[0];
  // forces per unit of N and of T along x and y, power 0
  const double push_x = kEdge ? push_1 * c_0 - push_2 * s_0 : push_1,
               push_y = kEdge ? push_1 * s_0 + push_2 * c_0 : push_2,
               drag_x = kEdge ? drag_1 * c_0 - drag_2 * s_0 : drag_1,
               drag_y = kEdge ? drag_1 * s_0 + drag_2 * c_0 : drag_2;

  for (int n = 0;; ++n) {
    // direction, point and depth of power n = k + 1, from all sums over what the powers up to k know
    const int k = n - 1;
    Quad turn_push{}, centre{}, moments{}, layer{};
    double moment = 0.0;
    double c = c_0, s = s_0;
    if (k >= 0) {
      if (kEdge) push_moment[k] = push_2 * point[k][0] - push_1 * point[k][1];
      const double drag_moment = kEdge && kTanh ? drag_2 * point[k][0] - drag_1 * point[k][1] : 0.0;
      if (k == 0) drag_moment_0 = drag_moment;
      if (kTurns) {
        const double ck = segment.cos_phi[k], sk = segment.sin_phi[k];
        left[k].direction = Quad{ck, sk, ck, sk};
        if (kTanh) left[k].moment = Quad{ck, sk, kEdge ? push_moment[k] : 0.0, drag_moment};
      }
      if (kTanh) left[k].layer = Quad{};
      for (int j = 1; j <= k; ++j) {
        const LeftFactors& a = left[j];
        const RightFactors& b = right[k - j];
        if (kTurns) {
          turn_push += a.direction * b.turn_push;
          if (kEdge) centre += a.direction * b.centre;
          if (kTanh) moments += a.moment * b.moment;
          if (kEdge && !kTanh) moment += push_moment[j] * b.turn_push[2];
        }
        if (kTanh) layer += a.layer * b.layer;
      }
      const double omega = segment.omega[k], inverse = kInverse[n];
      c = kTurns ? -(inverse * turn_push[1] + (inverse * s_0) * omega) : 0.0;
      s = kTurns ? inverse * turn_push[0] + (inverse * c_0) * omega : 0.0;
    }
    direction_[n] = Pair{c, s};
    segment.cos_phi[n] = c;
    segment.sin_phi[n] = s;
    const double xn = segment.x[n], yn = segment.y[n];
    if (kEdge) {
      const double along_c = centre[0] + c_0 * xn + (n > 0 ? c * x_0 : 0.0),
                   along_s = centre[1] + s_0 * xn + (n > 0 ? s * x_0 : 0.0),
                   across_c = centre[2] + c_0 * yn + (n > 0 ? c * y_0 : 0.0),
                   across_s = centre[3] + s_0 * yn + (n > 0 ? s * y_0 : 0.0);
      centre_[n] = Pair{along_c + across_s, across_c - along_s};
      point[n] = Pair{l * c - centre_[n][0], -l * s - centre_[n][1]};
    } else {
      point[n] = Pair{xn + beta * c + b0 * s, yn + beta * s - b0 * c};
    }
    series.depth[n] = depth_1 * point[n][0] + depth_2 * point[n][1];
    if (k < 0) {
      series.depth[0] += f.offset;
      continue;
    }

    // N, V and T of power k
    const double force_n = contact.stiffness * series.depth[k] + (contact.damping * n) * series.depth[n];
    const double v = (n * slip_1) * point[n][0] + (n * slip_2) * point[n][1];
    double force_t = contact.ratio * force_n;
    if (kTanh && k == 0) {
      tanh_0 = std::tanh(v * slope);
      const double sech2_0 = 1.0 - tanh_0 * tanh_0;
      tanh_rate = sech2_0 * slope;
      tanh_force = -system_.friction * force_n;
      force_t = tanh_force * tanh_0;
      right[0].layer = Quad{tanh_0, force_n, 0.0, 0.0};
    } else if (kTanh) {
      const double tanh = (kInverse[k] * slope) * layer[2] + tanh_rate * v;
      left[k].layer = Quad{tanh, tanh, -(layer[0] + 2.0 * tanh_0 * tanh), 0.0};
      right[k].layer = Quad{tanh, force_n, k * v, 0.0};
      force_t = -system_.friction * (layer[1] + force_n * tanh_0) + tanh_force * tanh;
    }
    series.normal_force[k] = force_n;
    series.slip_velocity[k] = v;
    series.tangential_force[k] = force_t;
    if (k == order) break;

    // forces of power k: of the axis itself, of what the powers before make of the contact, and of its N and T
    const double dx = k == 0 ? x_0 - system_.x.anchor : segment.x[k];
    const double dy = k == 0 ? y_0 - system_.y.anchor : segment.y[k];
    const double weight = k == 0 ? system_.weight : 0.0;
    double force_x = segment.drive_x[k] - system_.x.damping * segment.vx[k] - system_.x.stiffness * dx;
    double force_y = segment.drive_y[k] - weight - system_.y.damping * segment.vy[k] - system_.y.stiffness * dy;
    if (kEdge && kTurns) {
      force_x += push_1 * turn_push[2] - push_2 * turn_push[3];
      force_y += push_1 * turn_push[3] + push_2 * turn_push[2];
    }
    if (kEdge && kTurns && kTanh) {
      force_x += drag_1 * moments[0] - drag_2 * moments[1];
      force_y += drag_1 * moments[1] + drag_2 * moments[0];
    }
    force_x += push_x * force_n;
    force_y += push_y * force_n;
    if (kTanh) {
      force_x += drag_x * force_t;
      force_y += drag_y * force_t;
    }

    // velocity of power n, position of power n + 1
    const double inverse = kInverse[n], next_inverse = kInverse[n + 1];
    segment.vx[n] = (fast_x * inverse) * force_x;
    segment.vy[n] = (fast_y * inverse) * force_y;
    segment.x[n + 1] = segment.vx[n] * next_inverse;
    segment.y[n + 1] = segment.vy[n] * next_inverse;
    if (kTurns) {
      const double dphi = k == 0 ? segment.phi[0] - system_.phi.anchor : segment.phi[k];
      const double omega = segment.omega[k];
      double turn = segment.drive_phi[k] - system_.phi.damping * omega - system_.phi.stiffness * dphi;
      if (kEdge) {
        turn += moment + moments[2] + push_moment[0] * force_n;
        if (kTanh) turn += moments[3] + drag_moment_0 * force_t;
      } else {
        turn += push_c_arm * (turn_push[2] + c_0 * force_n) + push_s_arm * (turn_push[3] + s_0 * force_n);
        if (kTanh) turn += drag_c_arm * (moments[0] + c_0 * force_t) + drag_s_arm * (moments[1] + s_0 * force_t);
      }
      segment.omega[n] = (fast_phi * inverse) * turn;
      segment.phi[n + 1] = segment.omega[n] * next_inverse;
      right[k].turn_push = Quad{omega, omega, force_n, force_n};
      if (kEdge) right[k].centre = Quad{segment.x[n], segment.x[n], segment.y[n], segment.y[n]};
      if (kTanh) right[k].moment = Quad{force_t, force_t, force_n, force_t};
    } else {
      segment.omega[n] = segment.phi[n + 1] = 0.0;
    }
  }
  known_trig_ = order + 1;
  known_point_[contact.point] = order + 1;
  if (kEdge) known_centre_ = order + 1;
}

VIBRATORY_ALIGNMENT_INLINE void MotionSeries::expand_any_single(Segment& segment) {
  const bool edge = is_edge(contacts_[0].site), turns = system_.phi.moves, tanh = contacts_[0].separate_t;
  if (edge)
    turns ? (tanh ? expand_single_of<true, true, true>(segment) : expand_single_of<true, true, false>(segment))
          : (tanh ? expand_single_of<true, false, true>(segment) : expand_single_of<true, false, false>(segment));
  else
    turns ? (tanh ? expand_single_of<false, true, true>(segment) : expand_single_of<false, true, false>(segment))
          : (tanh ? expand_single_of<false, false, true>(segment) : expand_single_of<false, false, false>(segment));
}

#ifdef __x86_64__
__attribute__((target("avx2"))) void MotionSeries::expand_single_wide(Segment& segment) { expand_any_single(segment); }

void MotionSeries::expand_single(Segment& segment) {
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  wide ? expand_single_wide(segment) : expand_any_single(segment);
}
#else
void MotionSeries::expand_single(Segment& segment) { expand_any_single(segment); }
#endif

}  // namespace vibratory_alignment
