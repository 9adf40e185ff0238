// Part of MotionSeries: the most frequent case, a single contact, in a loop of its own.
#include <cmath>

#include "mechanics/quad.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {
namespace {

/// Powers as factors of products, each number as often as it is needed. A sum pairs left j with right k - j.
struct LeftFactors {
  Quad next;       ///< c, s, c, s of the next power
  Quad turn_push;  ///< c, s of the next power, c, s
  Quad moment;     ///< where T is a series of its own: c, s, and the moments per unit of N and of T
  Quad layer;      ///< tanh law: tanh, tanh, 1 - tanh^2, -
  Pair face;       ///< k(n) that changes: c, cos^2
};
struct RightFactors {
  Quad centre;     ///< x, x, y, y of the next power
  Quad turn_push;  ///< omega, omega, N, N
  Quad moment;     ///< where T is a series of its own: T, T, N, T
  Quad layer;      ///< tanh law: tanh, N, V' of the power before, -
  Pair face;       ///< k(n) that changes: c, what N grows by per unit of cos^2
};

}  // namespace

/// The whole expansion for one contact: the same recurrences, in one loop. All products of series whose factors are
/// known when the forces of a power are asked for are summed together, for these forces and for the direction and the
/// centre of the next but one power; what a power itself finds is added as its last term, by constant factors: the way
/// from one velocity to the next, on which the powers wait for one another, is kept short. n and t lie along the axes
/// of the frame: kLevel, n along the second. k(n) and h(n) of a face that turns on a base stiffer one way are a
/// constant and a multiple of cos^2 phi (kVaries). T of what sticks takes V' out: of what the accelerations without it
/// make of V', and of what turning adds. False, with nothing but the start expanded, where V' has to be taken out twice
/// or nothing can be held.
template <bool kEdge, bool kTurns, bool kVaries, bool kLevel, MotionSeries::Law kLaw>
VIBRATORY_ALIGNMENT_INLINE bool MotionSeries::expand_single_of(Segment& segment) {
  constexpr bool kTanh = kLaw == Law::layer, kSticks = kLaw == Law::sticks, kOwnT = kTanh || kSticks;
  Contact& contact = contacts_[0];
  ContactSeries& series = segment.loaded[0];
  PairSeries& point = points_[contact.point];
  const ContactFrame& f = contact.frame;
  const double side = side_of(contact.site), l = side * system_.slot_half_width, beta = side * system_.half_width,
               b0 = system_.base_distance;
  // c1 a + c2 b, where c is n or t, of which one component is zero
  const auto along_n = [](double c1, double a, double c2, double b) { return kLevel ? c2 * b : c1 * a; };
  const auto along_t = [](double c1, double a, double c2, double b) { return kLevel ? c1 * a : c2 * b; };
  // ... or the force per unit of N
  const auto along_push = [&](double c1, double a, double c2, double b) {
    return kOwnT ? along_n(c1, a, c2, b) : c1 * a + c2 * b;
  };
  const double depth_1 = f.sign * f.n1, depth_2 = f.sign * f.n2, slip_1 = -f.sign * f.t1(), slip_2 = -f.sign * f.t2();
  // forces per unit of N (sliding friction included) and of T, in the axes of the frame
  const double push_1 = kOwnT ? f.n1 : contact.force1, push_2 = kOwnT ? f.n2 : contact.force2;
  const double drag_1 = f.t1(), drag_2 = f.t2();
  const double fast_x = system_.x.inverse_inertia, fast_y = system_.y.inverse_inertia,
               fast_phi = system_.phi.inverse_inertia, slope = kTanh ? 1.0 / system_.regularization : 0.0;
  // what k(n) and h(n) grow by per unit of cos^2 phi
  const double level = kLevel ? 1.0 : -1.0, stiffness_share = level * (system_.stiffness_y - system_.stiffness_x),
               damping_share = level * (system_.damping_y - system_.damping_x);
  // moments of both about the mass centre per unit of (cos, sin) times them: corners
  const double push_c_arm = push_1 * b0 + push_2 * beta, push_s_arm = push_2 * b0 - push_1 * beta,
               drag_c_arm = drag_1 * b0 + drag_2 * beta, drag_s_arm = drag_2 * b0 - drag_1 * beta;
  LeftFactors left[kMaxOrder + 1];
  RightFactors right[kMaxOrder + 1];
  double push_moment[kMaxOrder + 1], drag_moment_0 = 0.0;
  double tanh_0 = 0.0, tanh_rate = 0.0, tanh_force = 0.0;  // tanh, d tanh/dV and dT/d tanh, all at power 0
  const double x_0 = segment.x[0], y_0 = segment.y[0], c_0 = segment.cos_phi[0], s_0 = segment.sin_phi[0];
  // forces per unit of N and of T along x and y, power 0
  const double push_x = kEdge ? along_push(push_1, c_0, -push_2, s_0) : push_1,
               push_y = kEdge ? along_push(push_1, s_0, push_2, c_0) : push_2,
               drag_x = kEdge ? along_t(drag_1, c_0, -drag_2, s_0) : drag_1,
               drag_y = kEdge ? along_t(drag_1, s_0, drag_2, c_0) : drag_2;
  // sums for the direction and the centre of the next power, and for the forces
  Quad turn_push{}, centre{};

  // centre in body axes and point of an edge, point of a corner, of a power > 0 with these last terms
  const auto centre_of = [&](double c, double s, double x, double y) {
    if (!kTurns) return Pair{c_0 * x + s_0 * y, c_0 * y - s_0 * x};
    const double along_c = centre[0] + c_0 * x + c * x_0, along_s = centre[1] + s_0 * x + s * x_0,
                 across_c = centre[2] + c_0 * y + c * y_0, across_s = centre[3] + s_0 * y + s * y_0;
    return Pair{along_c + across_s, across_c - along_s};
  };
  const auto edge_at = [&](double c, double s, const Pair& of) {
    return kTurns ? Pair{l * c - of[0], -l * s - of[1]} : -of;
  };
  const auto corner_at = [&](double c, double s, double x, double y) {
    if (!kTurns) return Pair{x, y};
    return Pair{x + beta * c + b0 * s, y + beta * s - b0 * c};
  };

  direction_[0] = Pair{c_0, s_0};
  if (kEdge) centre_[0] = Pair{c_0 * x_0 + s_0 * y_0, c_0 * y_0 - s_0 * x_0};
  point[0] = kEdge ? Pair{l * c_0 - centre_[0][0], -l * s_0 - centre_[0][1]}
                   : Pair{x_0 + beta * c_0 + b0 * s_0, y_0 + beta * s_0 - b0 * c_0};
  series.depth[0] = along_n(depth_1, point[0][0], depth_2, point[0][1]) + f.offset;
  for (int k = 0;; ++k) {
    // direction, point and depth of the next power
    const int n = k + 1;
    const double omega = segment.omega[k], inverse = kInverse[n], next_inverse = kInverse[n + 1];
    const double c = kTurns ? -(inverse * turn_push[1] + (inverse * s_0) * omega) : 0.0;
    const double s = kTurns ? inverse * turn_push[0] + (inverse * c_0) * omega : 0.0;
    direction_[n] = Pair{c, s};
    segment.cos_phi[n] = c;
    segment.sin_phi[n] = s;
    if (kEdge) centre_[n] = centre_of(c, s, segment.x[n], segment.y[n]);
    point[n] = kEdge ? edge_at(c, s, centre_[n]) : corner_at(c, s, segment.x[n], segment.y[n]);
    series.depth[n] = along_n(depth_1, point[n][0], depth_2, point[n][1]);

    // sums over what the powers before know
    if (kEdge && kTurns) push_moment[k] = along_push(-push_1, point[k][1], push_2, point[k][0]);
    const bool levers = kEdge && kOwnT && (kTurns || k == 0);
    const double drag_moment = levers ? along_t(-drag_1, point[k][1], drag_2, point[k][0]) : 0.0;
    if (k == 0) drag_moment_0 = kEdge ? drag_moment : drag_c_arm * c_0 + drag_s_arm * s_0;
    turn_push = centre = Quad{};
    Quad moments{}, layer{};
    Pair face{};
    double moment = 0.0;
    if (kTurns) {
      const double ck = segment.cos_phi[k], sk = segment.sin_phi[k];
      left[k].next = Quad{c, s, c, s};
      left[k].turn_push = Quad{c, s, ck, sk};
      if (kOwnT) left[k].moment = Quad{ck, sk, kEdge ? push_moment[k] : 0.0, drag_moment};
      if (kEdge) right[k].centre = Quad{segment.x[n], segment.x[n], segment.y[n], segment.y[n]};
    }
    if (kTanh) left[k].layer = Quad{};
    if (kVaries) left[k].face = Pair{};
    const auto add_products = [&](int j) {
      const LeftFactors& a = left[j];
      const RightFactors& b = right[k - j];
      if (kTurns) {
        turn_push += a.turn_push * b.turn_push;
        if (kEdge) centre += a.next * b.centre;
        if (kOwnT) moments += a.moment * b.moment;
        if (kEdge && !kOwnT) moment += push_moment[j] * b.turn_push[2];
      }
      if (kTanh) layer += a.layer * b.layer;
      if (kVaries) face += a.face * b.face;
    };
    int j = 1;  // two at a time: the loop itself takes a quarter of a turn
    for (; j < k; j += 2) {
      add_products(j);
      add_products(j + 1);
    }
    if (j == k) add_products(k);
    if (kTurns) {
      turn_push += left[0].turn_push * Quad{omega, omega, 0.0, 0.0};
      if (kEdge) centre += left[0].next * right[k].centre;
    }

    // N, V and T of power k
    double force_n = contact.stiffness * series.depth[k] + (contact.damping * n) * series.depth[n];
    if (kVaries) {
      const double ck = segment.cos_phi[k];
      right[k].face = Pair{ck, stiffness_share * series.depth[k] + (damping_share * n) * series.depth[n]};
      if (k > 0) {
        const double square = face[0] + 2.0 * c_0 * ck;
        left[k].face = Pair{ck, square};
        force_n += face[1] + square * right[0].face[1];
      }
    }
    const double v = along_t(n * slip_1, point[n][0], n * slip_2, point[n][1]);
    double force_t = kSticks ? 0.0 : contact.ratio * force_n;
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
    if (k == segment.order && !goes_on(segment)) break;

    // forces of power k: of the axis itself, of what the powers before make of the contact, and of its N and T
    const double dx = k == 0 ? x_0 - system_.x.anchor : segment.x[k];
    const double dy = k == 0 ? y_0 - system_.y.anchor : segment.y[k];
    const double weight = k == 0 ? system_.weight : 0.0;
    double force_x = segment.drive_x[k] - system_.x.damping * segment.vx[k] - system_.x.stiffness * dx;
    double force_y = segment.drive_y[k] - weight - system_.y.damping * segment.vy[k] - system_.y.stiffness * dy;
    if (kEdge && kTurns) {
      force_x += along_push(push_1, turn_push[2], -push_2, turn_push[3]);
      force_y += along_push(push_1, turn_push[3], push_2, turn_push[2]);
    }
    if (kEdge && kTurns && kOwnT) {
      force_x += along_t(drag_1, moments[0], -drag_2, moments[1]);
      force_y += along_t(drag_1, moments[1], drag_2, moments[0]);
    }
    force_x += push_x * force_n;
    force_y += push_y * force_n;
    if (kTanh) {
      force_x += drag_x * force_t;
      force_y += drag_y * force_t;
    }
    double turn = 0.0;
    if (kTurns) {
      const double dphi = k == 0 ? segment.phi[0] - system_.phi.anchor : segment.phi[k];
      turn = segment.drive_phi[k] - system_.phi.damping * omega - system_.phi.stiffness * dphi;
      if (kEdge) {
        turn += moment + moments[2] + push_moment[0] * force_n;
        if (kOwnT) turn += moments[3];
      } else {
        turn += push_c_arm * (turn_push[2] + c_0 * force_n) + push_s_arm * (turn_push[3] + s_0 * force_n);
        if (kOwnT) turn += drag_c_arm * moments[0] + drag_s_arm * moments[1];
      }
      if (kTanh) turn += drag_moment_0 * force_t;
    }

    // velocity of power n: with the T that leaves nothing of V'
    if (kSticks) {
      if (k == 0) {
        contact.drag[0] = Pair{drag_x, drag_y};
        contact.drag_moment[0] = drag_moment_0;
        set_up_holding();
      }
      const double own_c = -next_inverse * turn_push[1], own_s = next_inverse * turn_push[0];
      const Pair own =
          kEdge ? edge_at(own_c, own_s, centre_of(own_c, own_s, 0.0, 0.0)) : corner_at(own_c, own_s, 0.0, 0.0);
      const double own_rate = kTurns ? (n * (n + 1)) * along_t(slip_1, own[0], slip_2, own[1]) : 0.0;
      const HoldingForces::Answer free{{}, fast_x * force_x, fast_y * force_y, fast_phi * turn};
      const HoldingForces::Answer held = holding_.hold_motion_of_one(free, own_rate);
      if (k == 0 && (!holding_.regular() || rounding_shows(free, held, segment))) return false;
      series.tangential_force[k] = force_t = held.force[0];
      segment.vx[n] = inverse * held.x;
      segment.vy[n] = inverse * held.y;
      segment.omega[n] = inverse * held.phi;
    } else {
      segment.vx[n] = (fast_x * inverse) * force_x;
      segment.vy[n] = (fast_y * inverse) * force_y;
      segment.omega[n] = (fast_phi * inverse) * turn;
    }
    // position of power n + 1
    segment.x[n + 1] = segment.vx[n] * next_inverse;
    segment.y[n + 1] = segment.vy[n] * next_inverse;
    segment.phi[n + 1] = segment.omega[n] * next_inverse;
    if (kTurns) right[k].turn_push = Quad{omega, omega, force_n, force_n};
    if (kTurns && kOwnT) right[k].moment = Quad{force_t, force_t, force_n, force_t};
  }
  known_trig_ = segment.order + 1;
  known_point_[contact.point] = segment.order + 1;
  if (kEdge) known_centre_ = segment.order + 1;
  return true;
}

template <bool kEdge, bool kTurns, bool kVaries, bool kLevel>
VIBRATORY_ALIGNMENT_INLINE bool MotionSeries::expand_single_by_law(Segment& segment) {
  if (contacts_[0].slip == Slip::stick) return expand_single_of<kEdge, kTurns, kVaries, kLevel, Law::sticks>(segment);
  if (contacts_[0].slip == Slip::regularized)
    return expand_single_of<kEdge, kTurns, kVaries, kLevel, Law::layer>(segment);
  return expand_single_of<kEdge, kTurns, kVaries, kLevel, Law::slides>(segment);
}

template <bool kEdge, bool kTurns, bool kVaries>
VIBRATORY_ALIGNMENT_INLINE bool MotionSeries::expand_single_by_face(Segment& segment) {
  return contacts_[0].frame.n2 != 0.0 ? expand_single_by_law<kEdge, kTurns, kVaries, true>(segment)
                                      : expand_single_by_law<kEdge, kTurns, kVaries, false>(segment);
}

VIBRATORY_ALIGNMENT_INLINE bool MotionSeries::expand_any_single(Segment& segment) {
  if (contacts_[0].turning) return expand_single_by_face<true, true, true>(segment);
  if (is_edge(contacts_[0].site))
    return system_.phi.moves ? expand_single_by_face<true, true, false>(segment)
                             : expand_single_by_face<true, false, false>(segment);
  return system_.phi.moves ? expand_single_by_face<false, true, false>(segment)
                           : expand_single_by_face<false, false, false>(segment);
}

bool MotionSeries::expand_single(Segment& segment) {
  bool expanded = false;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA { expanded = expand_any_single(segment); });
  return expanded;
}

}  // namespace vibratory_alignment
