// Part of MotionSeries: any contacts, power by power.
#include "solver/motion_series_terms.h"

namespace vibratory_alignment {

VIBRATORY_ALIGNMENT_INLINE void MotionSeries::expand_any(Segment& segment) {
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Contact& contact = contacts_[i];
    point_term(contact.point, 0, segment);
    const Pair& p = points_[contact.point][0];
    segment.loaded[i].depth[0] = contact.frame.depth(p[0], p[1]);
  }
  for (int k = 0;; ++k) {
    // positions are known to power k + 1: so are the points, and the forces to power k
    if (k + 1 > known_trig_) trig_term(k + 1, segment);
    known_trig_ = k + 1;
    for (int i = 0; i < segment.loaded_count; ++i) {
      point_term(contacts_[i].point, k + 1, segment);
      force_term(contacts_[i], k, segment.loaded[i]);
    }
    if (k == segment.order && !goes_on(segment)) break;
    Quad load{};
    add_contact_load(k, segment, load);
    accelerate(k, load, segment);
    if (sticking_count_ > 0) hold_sticking(k, segment);
  }
}

void MotionSeries::expand_several(Segment& segment) {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA { expand_any(segment); });
}

}  // namespace vibratory_alignment
