#include "trial/sampler.h"

#include <algorithm>
#include <cmath>

#include "mechanics/contact_frame.h"
#include "mechanics/system.h"
#include "trial/contact_impulse.h"

namespace vibratory_alignment {

void raise_peaks(const Sample& sample, std::array<double, kSpotCount>& peak_force) {
  for (std::size_t site = 0; site < kSiteCount; ++site) {
    double& peak = peak_force[static_cast<std::size_t>(spot_of(static_cast<Site>(site)))];
    peak = std::max(peak, sample.contacts[site].peak_normal_force);
  }
}

Sampler::Sampler(Simulation& simulation, double interval, bool with_events)
    : simulation_(simulation), system_(simulation.system()), interval_(interval), with_events_(with_events) {}

/// Books peaks and impulses of the current segment up to `local_time`.
void Sampler::integrate_to(double local_time) {
  if (!(local_time > integrated_to_)) return;
  const Segment& segment = simulation_.segment();
  for (int i = 0; i < segment.loaded_count; ++i) {
    ContactSample& pending = pending_[static_cast<std::size_t>(segment.loaded[static_cast<std::size_t>(i)].site)];
    const ContactImpulse impulse = contact_impulse(system_, segment, i, integrated_to_, local_time);
    pending.impulse_x += impulse.x;
    pending.impulse_y += impulse.y;
    pending.normal_impulse += impulse.normal;
    pending.peak_normal_force =
        std::max(pending.peak_normal_force, largest_normal_force(segment, i, integrated_to_, local_time));
  }
  integrated_to_ = local_time;
}

/// Reads the sample at `local_time` off the current segment and takes over what is pending.
void Sampler::read(double time, double local_time, Sample& sample) {
  const Segment& segment = simulation_.segment();
  integrate_to(local_time);
  sample.time = time;
  sample.is_event = sample.is_last = false;
  sample.state = local_time == segment.duration ? segment.end : state_at(segment, local_time);
  sample.contacts = pending_;
  pending_ = {};
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    ContactSample& contact = sample.contacts[i];
    contact.state = segment.contacts[i];
    if (!contact.state.touching()) continue;
    const ContactKinematics k = contact_kinematics(system_, sample.state, static_cast<Site>(i), contact.state.face);
    contact.depth = k.depth;
    contact.normal_x = k.normal.x;
    contact.normal_y = k.normal.y;
    contact.point_x = sample.state.x + k.lever.x;
    contact.point_y = sample.state.y + k.lever.y;
  }
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactValues values = contact_at(segment, i, local_time);
    ContactSample& contact =
        sample.contacts[static_cast<std::size_t>(segment.loaded[static_cast<std::size_t>(i)].site)];
    contact.normal_force = std::max(0.0, values.normal_force);
    contact.peak_normal_force = std::max(contact.peak_normal_force, contact.normal_force);
    contact.tangential_force = values.tangential_force;
    contact.force_x = contact.normal_force * contact.normal_x + contact.tangential_force * contact.normal_y;
    contact.force_y = contact.normal_force * contact.normal_y - contact.tangential_force * contact.normal_x;
  }
  count_impacts(sample);
  sample.mode = simulation_.mode();
  sample.misalignment = std::abs(sample.state.x);
  const double clearance = simulation_.scene().slot.clearance, start = std::abs(system_.start.x);
  sample.progress = start > clearance ? std::clamp((start - sample.misalignment) / (start - clearance), 0.0, 1.0) : 1.0;
}

void Sampler::count_impacts(Sample& sample) const {
  for (int i = 0; i < kSpotCount; ++i)
    sample.impacts[static_cast<std::size_t>(i)] = simulation_.impacts(static_cast<Spot>(i));
}

bool Sampler::next(Sample& sample, const std::function<bool()>& go_on, double latest) {
  if (finished_) return false;
  if (!started_) {
    started_ = true;
    if (!simulation_.advance()) {
      finished_ = true;
      return false;
    }
  }
  for (long passed = 1;; ++passed) {
    if (go_on && passed % kSegmentsUnasked == 0 && !go_on()) return false;
    const Segment& segment = simulation_.segment();
    const double target = static_cast<double>(index_) * interval_;
    const double end = segment.end_time();
    if (std::min(target, end) > latest) return false;
    if (target < end) {
      const double local = std::clamp(target - segment.start, 0.0, segment.duration);
      read(target, local, sample);
      time_ = target;
      ++index_;
      return true;
    }
    // the segment ends first, or here
    const bool wanted = target == end || (with_events_ && segment.event_count > 0);
    const bool is_event = segment.event_count > 0;
    integrate_to(segment.duration);
    const auto kept = pending_;
    read(end, segment.duration, sample);
    finished_ = !simulation_.advance();
    integrated_to_ = 0.0;
    sample.is_event = is_event && target != end;
    sample.is_last = finished_;
    // what happens at this instant has been booked by now
    count_impacts(sample);
    if (finished_) sample.mode = simulation_.mode();
    if (target == end) {
      ++index_;
      time_ = target;
    }
    if (finished_ || (wanted && end > last_)) {
      last_ = end;
      return true;
    }
    // not a sample: what was pending still is
    pending_ = kept;
  }
}

}  // namespace vibratory_alignment
