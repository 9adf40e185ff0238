#include "solver/motion_series_terms.h"

#include <algorithm>

#include "mechanics/tilt.h"
#include "solver/turning_face.h"

namespace vibratory_alignment {
namespace {

int point_index(Site site) { return (is_edge(site) ? 0 : 2) + pair_index(site); }

/// k(n) d + h(n) d', power k.
double turning_push(const Series& stiffness, const Series& damping, const Series& depth, int k) {
  double n = 0.0;
  for (int j = 0; j <= k; ++j) n += stiffness[j] * depth[k - j] + damping[j] * (k - j + 1) * depth[k - j + 1];
  return n;
}

}  // namespace

/// Direction of power 0; nothing else is known.
void MotionSeries::restart(int order, Segment& segment) {
  order_ = order;
  segment.order = order;
  const auto [c, s] = tilt_of(segment.phi[0]);
  segment.cos_phi[0] = c;
  segment.sin_phi[0] = s;
  direction_[0] = Pair{c, s};
  known_trig_ = 0;
  known_centre_ = -1;
  known_point_.fill(-1);
  sticking_count_ = 0;
  not_held_.fill(0.0);
}

void MotionSeries::adopt(Segment& segment) { restart(segment.order, segment); }

void MotionSeries::start(const State& start, const DriveForms& drives, int order, Segment& segment) {
  segment.x[0] = start.x;
  segment.y[0] = start.y;
  segment.phi[0] = start.phi;
  segment.x[1] = segment.vx[0] = start.vx;
  segment.y[1] = segment.vy[0] = start.vy;
  segment.phi[1] = segment.omega[0] = start.omega;
  restart(order, segment);
  drive_series_.begin(drives);
  drive_series_.extend(order, segment);
}

void MotionSeries::expand_free(const State& start, const DriveForms& drives, int order, Segment& segment) {
  this->start(start, drives, order, segment);
  segment.loaded_count = 0;
  for (int k = 0; k < order; ++k) accelerate(k, Quad{}, segment);
}

const PairSeries& MotionSeries::point(Site site, Segment& segment) {
  direction(segment);
  const int index = point_index(site);
  while (known_point_[index] < order_) point_term(index, known_point_[index] + 1, segment);
  return points_[index];
}

const PairSeries& MotionSeries::direction(Segment& segment) {
  while (known_trig_ < order_) trig_term(++known_trig_, segment);
  return direction_;
}

void MotionSeries::set_up_contacts(Segment& segment) {
  segment.loaded_count = 0;
  for (int i = 0; i < kSiteCount; ++i) {
    const ContactState& state = segment.contacts[i];
    if (state.phase != Phase::loaded) continue;
    const int index = segment.loaded_count++;
    segment.loaded[index].site = static_cast<Site>(i);
    Contact& contact = contacts_[index];
    contact.site = static_cast<Site>(i);
    contact.face = state.face;
    contact.slip = state.slip;
    contact.frame = contact_frame(system_, state.face);
    contact.separate_t = state.slip == Slip::stick || state.slip == Slip::regularized;
    contact.ratio = state.slip == Slip::plus ? -system_.friction : state.slip == Slip::minus ? system_.friction : 0.0;
    contact.point = point_index(contact.site);
    contact.force1 = contact.frame.n1 + contact.ratio * contact.frame.t1();
    contact.force2 = contact.frame.n2 + contact.ratio * contact.frame.t2();
    contact.turning = is_edge(contact.site) && !system_.isotropic && system_.phi.moves;
    contact.stiffness = stiffness_of(system_, state.face, segment.cos_phi[0], segment.sin_phi[0]);
    contact.damping = damping_of(system_, state.face, segment.cos_phi[0], segment.sin_phi[0]);
    if (state.slip == Slip::stick) sticking_[sticking_count_++] = index;
  }
}

void MotionSeries::push_series(const Segment& segment, Face face, const Series& depth, Series& push) const {
  if (is_part_face(face) && !system_.isotropic) {
    Series stiffness, damping;
    for (int k = 0; k < segment.order; ++k) {
      turning_term(system_, face, k, segment, stiffness[k], damping[k]);
      push[k] = turning_push(stiffness, damping, depth, k);
    }
    return;
  }
  const double stiffness = stiffness_of(system_, face, segment.cos_phi[0], segment.sin_phi[0]);
  const double damping = damping_of(system_, face, segment.cos_phi[0], segment.sin_phi[0]);
  for (int k = 0; k < segment.order; ++k) push[k] = stiffness * depth[k] + damping * (k + 1) * depth[k + 1];
}

/// At the last power that has been asked for: makes room for more, if they are wanted.
bool MotionSeries::goes_on(Segment& segment) {
  if (choice_ == nullptr) return false;
  const int order = choice_->next_order(segment);
  if (order <= segment.order) return false;
  order_ = segment.order = order;
  drive_series_.extend(order, segment);
  return true;
}

void MotionSeries::expand_contact(const State& start, const DriveForms& drives, int order, Segment& segment,
                                  OrderChoice* choice) {
  choice_ = choice;
  this->start(start, drives, order, segment);
  set_up_contacts(segment);
  if (segment.loaded_count == 1 && expand_single(segment)) return end_sticking(segment);
  expand_several(segment);
  end_sticking(segment);
}

/// V of what sticks is zero by construction.
void MotionSeries::end_sticking(Segment& segment) const {
  for (int m = 0; m < sticking_count_; ++m) {
    Series& v = segment.loaded[sticking_[m]].slip_velocity;
    std::fill(v.begin(), v.begin() + segment.order + 1, 0.0);
  }
}

}  // namespace vibratory_alignment
