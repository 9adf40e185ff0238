// Part of MotionSeries: the most frequent case, a single contact, in a loop of its own.
#include <cmath>

#include "mechanics/quad.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {
namespace {

/// Powers as factors of products, each number as often as it is needed. A sum pairs left j with right k - j. Where
/// three numbers are needed the last one stands twice: with a constant in its place the compiler stores them one by
/// one, and the next product waits for that.
struct LeftFactors {
  Quad next;       ///< c, s, c, s of the next power
  Quad turn_push;  ///< c, s of the next power, c, s
  Quad moment;     ///< where T is a series of its own: c, s, and the moments per unit of N and of T
  Quad layer;      ///< tanh law: tanh, tanh, tanh^2, tanh^2
  Pair face;       ///< k(n) that changes: c, cos^2
};
struct RightFactors {
  Quad centre;     ///< x, x, y, y of the next power
  Quad turn_push;  ///< omega, omega, N, N
  Quad moment;     ///< where T is a series of its own: T, T, N, T
  Quad layer;      ///< tanh law: tanh, N, V' of the power before, the same
  Pair face;       ///< k(n) that changes: c, what N grows by per unit of cos^2
};

}  // namespace

/// The whole expansion for one contact: the same recurrences, in one loop. All products of series whose factors are
/// known when the forces of a power are asked for are summed together, for these forces and for the direction and the
/// centre of the next but one power; what a power itself finds is added as its last term, by constant factors. The way
/// from one velocity to the next, on which the powers wait for one another, is kept short: d' and V are what these sums
/// make of them, known a power ahead, and the velocities times constants, so that N and T do not wait for the point of
/// the contact. n and t lie along the axes of the frame: kLevel, n along the second. k(n) and h(n) of a face that turns
/// on a base stiffer one way are a constant and a multiple of cos^2 phi (kVaries). T of what sticks takes V' out: of
/// what the accelerations without it make of V', and of what turning adds. Where little of the motion is left, that is
/// rid once more of the V' that the rounding of T makes. False, with nothing but the start expanded, where nothing can
/// be held.
template <bool kEdge, bool kTurns, bool kVaries, bool kLevel, MotionSeries::Law kLaw>
VIBRATORY_ALIGNMENT_INLINE bool MotionSeries::expand_single_of(Segment& segment) {
  constexpr bool kTanh = kLaw == Law::layer, kSticks = kLaw == Law::sticks, kOwnT = kTanh || kSticks;
  Contact& contact = contacts_[0];
  ContactSeries& series = segment.loaded[0];
  PairSeries& point = points_[contact.point];
  const ContactFrame& f = contact.frame;
  const double side = side_of(contact.site), l = side * system_.slot_half_width, beta = side * system_.half_width,
               b0 = system_.base_distance;
  // what the point's coordinates count for: one for the depth, the other one for the slip velocity
  constexpr int kDepth = kLevel ? 1 : 0, kSlip = kLevel ? 0 : 1;
  const Pair axes = f.sign * (kLevel ? Pair{-f.t1(), f.n2} : Pair{f.n1, -f.t2()});
  // forces per unit of N (sliding friction included) and of T, in the axes of the frame
  const double push_1 = kOwnT ? f.n1 : contact.force1, push_2 = kOwnT ? f.n2 : contact.force2;
  const double drag_1 = f.t1(), drag_2 = f.t2();
  // ... and turned into those of the world by a direction (c, s), of which the first component goes along it and the
  // second one across, along (-s, c)
  const Pair push_across{-push_2, push_2}, drag_across{-drag_2, drag_2};
  const auto turned_push = [&](const Pair& direction) {
    if (!kOwnT) return rounded(push_1 * direction) + push_across * swapped(direction);
    return kLevel ? push_across * swapped(direction) : push_1 * direction;
  };
  const auto turned_drag = [&](const Pair& direction) {
    return kLevel ? drag_1 * direction : drag_across * swapped(direction);
  };
  const Pair fast{system_.x.inverse_inertia, system_.y.inverse_inertia},
      stiffness{system_.x.stiffness, system_.y.stiffness}, damping{system_.x.damping, system_.y.damping};
  const double fast_phi = system_.phi.inverse_inertia, slope = kTanh ? 1.0 / system_.regularization : 0.0;
  // what k(n) and h(n) grow by per unit of cos^2 phi
  const double level = kLevel ? 1.0 : -1.0, stiffness_share = level * (system_.stiffness_y - system_.stiffness_x),
               damping_share = level * (system_.damping_y - system_.damping_x);
  // moments of both about the mass centre per unit of (cos, sin) times them: corners
  const double push_c_arm = push_1 * b0 + push_2 * beta, push_s_arm = push_2 * b0 - push_1 * beta,
               drag_c_arm = drag_1 * b0 + drag_2 * beta, drag_s_arm = drag_2 * b0 - drag_1 * beta;
  LeftFactors left[kMaxOrder + 1];
  RightFactors right[kMaxOrder + 1];
  double push_moment[kMaxOrder + 1], drag_moment_0 = 0.0;
  // tanh, d tanh/dV, dT/d tanh and dT/dN, all at power 0
  double tanh_0 = 0.0, tanh_rate = 0.0, tanh_force = 0.0, tanh_ratio = 0.0;
  const Pair place_0{segment.x[0], segment.y[0]}, direction_0{segment.cos_phi[0], segment.sin_phi[0]};
  const double c_0 = direction_0[0], s_0 = direction_0[1];
  const Quad directions_0{c_0, s_0, c_0, s_0}, places_0{place_0[0], place_0[0], place_0[1], place_0[1]};
  // forces per unit of N and of T along x and y, power 0
  const Pair push_0 = kEdge ? turned_push(direction_0) : Pair{push_1, push_2},
             drag_0 = kEdge ? turned_drag(direction_0) : Pair{drag_1, drag_2};
  // sums for the direction and the centre of the next power, and for the forces
  Quad turn_push{}, centre{};

  // centre in body axes, from the products c x, s x, c y, s y, and point of an edge, point of a corner, of a power > 0
  // with these last terms
  constexpr Pair kTurn{-1.0, 1.0};  // (a, b) swapped and times this is turned by a right angle
  const auto turned_back = [&](const Quad& products) { return swapped(high(products)) - kTurn * low(products); };
  const auto centre_of = [&](const Quad& directions, const Quad& places) {
    return turned_back(kTurns ? centre + directions_0 * places + directions * places_0 : directions_0 * places);
  };
  const auto edge_at = [&](const Pair& direction, const Pair& of) {
    return kTurns ? Pair{l, -l} * direction - of : -of;
  };
  const auto corner_at = [&](const Pair& direction, const Pair& place) {
    return kTurns ? place + beta * direction - (b0 * kTurn) * swapped(direction) : place;
  };

  // d' and V per unit of c', s', velocities and angular velocity, power 0
  const Pair by_c = axes * (kEdge ? Pair{l - place_0[0], -place_0[1]} : Pair{beta, -b0}),
             by_s = axes * (kEdge ? Pair{-place_0[1], place_0[0] - l} : Pair{b0, beta}),
             by_vx = axes * (kEdge ? Pair{-c_0, s_0} : Pair{1.0, 0.0}),
             by_vy = axes * (kEdge ? Pair{-s_0, -c_0} : Pair{0.0, 1.0}), by_omega = c_0 * by_s - s_0 * by_c;

  // of power k, and place and angle of the next one; powers 0 of place and angle from where the springs feel nothing
  Pair direction_k = direction_0, velocity{segment.vx[0], segment.vy[0]};
  Pair known_rate{};  // what d' and V of power k are but for velocities of that power
  Pair stretch{place_0[0] - system_.x.anchor, place_0[1] - system_.y.anchor}, place{segment.x[1], segment.y[1]};
  double omega = segment.omega[0], twist = segment.phi[0] - system_.phi.anchor, angle = segment.phi[1];
  direction_[0] = direction_0;
  if (kEdge) centre_[0] = turned_back(directions_0 * places_0);
  Pair point_k = kEdge ? Pair{l, -l} * direction_0 - centre_[0]
                       : place_0 + beta * direction_0 - (b0 * kTurn) * swapped(direction_0);
  double depth = axes[kDepth] * point_k[kDepth] + f.offset;
  point[0] = point_k;
  series.depth[0] = depth;
  for (int k = 0;; ++k) {
    // direction, point and depth of the next power
    const int n = k + 1;
    const double inverse = kInverse[n], next_inverse = kInverse[n + 1], number = n;
    Pair direction{};
    if (kTurns) direction = (inverse * kTurn) * swapped(low(turn_push) + direction_0 * omega);
    direction_[n] = direction;
    segment.cos_phi[n] = direction[0];
    segment.sin_phi[n] = direction[1];
    const Quad directions{direction[0], direction[1], direction[0], direction[1]},
        places{place[0], place[0], place[1], place[1]};
    if (kEdge) centre_[n] = centre_of(directions, places);
    const Pair point_n = kEdge ? edge_at(direction, centre_[n]) : corner_at(direction, place);
    const double depth_n = axes[kDepth] * point_n[kDepth];
    point[n] = point_n;
    series.depth[n] = depth_n;

    // sums over what the powers before know
    Pair arms{};  // moments per unit of N and of T
    if (kEdge && kOwnT) arms = kLevel ? Pair{push_2, -drag_1} * point_k : Pair{-push_1, drag_2} * swapped(point_k);
    if (kEdge && !kOwnT) arms[0] = push_2 * point_k[0] - push_1 * point_k[1];
    if (kEdge && kTurns) push_moment[k] = arms[0];
    if (k == 0) drag_moment_0 = kEdge ? arms[1] : drag_c_arm * c_0 + drag_s_arm * s_0;
    turn_push = centre = Quad{};
    Quad moments{}, layer{};
    Pair face{};
    double moment = 0.0;
    if (kTurns) {
      left[k].next = directions;
      right[k].centre = places;
      left[k].turn_push = Quad{direction[0], direction[1], direction_k[0], direction_k[1]};
      if (kOwnT) left[k].moment = Quad{direction_k[0], direction_k[1], arms[0], arms[1]};
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
    // two at a time: the loop itself takes a quarter of a turn; what has been found last, 1 on the right, comes last
    int j = 2;
    for (; j + 1 < k; j += 2) {
      add_products(j);
      add_products(j + 1);
    }
    if (j < k) add_products(j);
    if (k > 1) add_products(k);
    if (k > 0) add_products(1);
    if (kTurns) {
      turn_push += left[0].turn_push * Quad{omega, omega, 0.0, 0.0};
      if (kEdge) centre += left[0].next * right[k].centre;
    }
    const Pair rate = known_rate + omega * by_omega + velocity[0] * by_vx + velocity[1] * by_vy;
    const double depth_rate = rate[kDepth], v = rate[kSlip];
    if (kTurns) known_rate = turn_push[0] * by_s - turn_push[1] * by_c;
    if (kTurns && kEdge) known_rate -= ((number + 1.0) * axes) * turned_back(centre);

    // N and T of power k
    double force_n = rounded(contact.stiffness * depth) + contact.damping * depth_rate;
    if (kVaries) {
      const double ck = direction_k[0];
      right[k].face = Pair{ck, rounded(stiffness_share * depth) + damping_share * depth_rate};
      if (k > 0) {
        const double square = face[0] + 2.0 * c_0 * ck;
        left[k].face = Pair{ck, square};
        force_n += face[1] + square * right[0].face[1];
      }
    }
    double force_t = kSticks ? 0.0 : contact.ratio * force_n;
    if (kTanh && k == 0) {
      tanh_0 = std::tanh(v * slope);
      const double sech2_0 = 1.0 - tanh_0 * tanh_0;
      tanh_rate = sech2_0 * slope;
      tanh_force = -system_.friction * force_n;
      tanh_ratio = -system_.friction * tanh_0;
      force_t = tanh_force * tanh_0;
      right[0].layer = Quad{tanh_0, force_n, 0.0, 0.0};
    } else if (kTanh) {
      const double tanh = rounded(tanh_rate * v) - (kInverse[k] * slope) * layer[2];
      const double square = layer[0] + 2.0 * tanh_0 * tanh, slip_rate = (number - 1.0) * v;
      left[k].layer = Quad{tanh, tanh, square, square};
      right[k].layer = Quad{tanh, force_n, slip_rate, slip_rate};
      force_t = rounded(tanh_force * tanh) - system_.friction * layer[1] + tanh_ratio * force_n;
    }
    series.normal_force[k] = force_n;
    series.slip_velocity[k] = v;
    series.tangential_force[k] = force_t;
    if (k == segment.order && !goes_on(segment)) break;

    // forces of power k: of the axis itself, of what the powers before make of the contact, and of its N and T
    Pair force{segment.drive_x[k], segment.drive_y[k]};
    if (k == 0) force[1] -= system_.weight;
    force = force - damping * velocity - stiffness * stretch;
    if (kEdge && kTurns) force += turned_push(high(turn_push));
    if (kEdge && kTurns && kOwnT) force += turned_drag(low(moments));
    force += push_0 * force_n;
    if (kTanh) force += drag_0 * force_t;
    double turn = 0.0;
    if (kTurns) {
      turn = segment.drive_phi[k] - system_.phi.damping * omega - system_.phi.stiffness * twist;
      if (kEdge) {
        turn += (kOwnT ? moments[2] + moments[3] : moment) + push_moment[0] * force_n;
      } else {
        turn += push_c_arm * (turn_push[2] + c_0 * force_n) + push_s_arm * (turn_push[3] + s_0 * force_n);
        if (kOwnT) turn += drag_c_arm * moments[0] + drag_s_arm * moments[1];
      }
      if (kTanh) turn += drag_moment_0 * force_t;
    }

    // velocity of power n: with the T that leaves nothing of V'
    if (kSticks) {
      if (k == 0) {
        contact.drag[0] = Quad{drag_0[0], drag_0[1], drag_moment_0, 0.0};
        set_up_holding();
      }
      const Pair free_rate = fast * force;
      const HoldingForces::Answer free{{}, free_rate[0], free_rate[1], fast_phi * turn};
      const HoldingForces::Answer held = holding_.hold_motion_of_one(free, number * known_rate[kSlip]);
      if (k == 0) {
        if (!holding_.regular()) return false;
        takes_out_twice_ = rounding_shows(free, held, segment);
      }
      series.tangential_force[k] = force_t = held.force[0];
      velocity = inverse * Pair{held.x, held.y};
      omega = inverse * held.phi;
      if (takes_out_twice_) {
        // V of the next power is what the rounding of a large T has left
        const Pair left = known_rate + omega * by_omega + velocity[0] * by_vx + velocity[1] * by_vy;
        const HoldingForces::Answer correction = holding_.hold_motion_of_one({}, left[kSlip]);
        velocity += Pair{correction.x, correction.y};
        omega += correction.phi;
      }
    } else {
      velocity = (fast * inverse) * force;
      omega = (fast_phi * inverse) * turn;
    }
    if (kTurns) right[k].turn_push = Quad{segment.omega[k], segment.omega[k], force_n, force_n};
    if (kTurns && kOwnT) right[k].moment = Quad{force_t, force_t, force_n, force_t};

    // place of power n + 1
    stretch = place;
    twist = angle;
    place = velocity * next_inverse;
    angle = omega * next_inverse;
    segment.vx[n] = velocity[0];
    segment.vy[n] = velocity[1];
    segment.omega[n] = omega;
    segment.x[n + 1] = place[0];
    segment.y[n + 1] = place[1];
    segment.phi[n + 1] = angle;
    direction_k = direction;
    point_k = point_n;
    depth = depth_n;
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
