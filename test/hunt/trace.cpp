#include "trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "../support/touch_point.h"
#include "mechanics/system.h"
#include "segment_checks.h"
#include "solver/base_recovery.h"
#include "trial/make_solver.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace vibratory_alignment::hunt {
namespace {

constexpr double kSameTime = 1e-12;

bool ends_with_touch(const Segment& segment) {
  for (int i = 0; i < segment.event_count; ++i)
    if (segment.events[static_cast<std::size_t>(i)].kind == EventKind::touch) return true;
  return false;
}

/// How far each point has been from the face that it left, since it left it.
class Hops {
 public:
  explicit Hops(const System& system) : system_(system) {}

  void follow(const Segment& segment) {
    for (std::size_t i = 0; i < kSiteCount; ++i) {
      if (segment.contacts[i].touching())
        hops_[i] = {segment.contacts[i].face, 0.0};
      else if (hops_[i].left != Face::none)
        hops_[i].height = std::max(hops_[i].height, distance(segment, static_cast<Site>(i), hops_[i].left));
    }
  }

  /// True when every touch at the segment's end is one of the face that the point left, after a hop no higher than
  /// this.
  bool end_below(double height, const Segment& segment) const {
    for (int i = 0; i < segment.event_count; ++i) {
      const Event& event = segment.events[static_cast<std::size_t>(i)];
      const Hop& hop = hops_[static_cast<std::size_t>(event.site)];
      if (event.kind == EventKind::touch && !(hop.left == event.face && hop.height <= height)) return false;
    }
    return true;
  }

 private:
  struct Hop {
    Face left = Face::none;
    double height = 0.0;
  };

  /// Largest distance of the point from the face's line, or from what the base is still deformed by, during the segment:
  /// to either side, as it may go past the end of the face and be beneath its line when it is looked at.
  double distance(const Segment& segment, Site site, Face face) const {
    const Recovery& base = segment.recoveries[static_cast<std::size_t>(site)];
    std::optional<Relaxation> relaxation;
    if (system_.recovery && base.face == face && base.deformation > 0.0) relaxation.emplace(system_, segment, base);
    double most = 0.0;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double t = share * segment.duration;
      const State q = share < 1.0 ? state_at(segment, t) : segment.end;
      const double deformation = relaxation ? relaxation->deformation_at(t) : 0.0;
      most = std::max(most, std::abs(deformation - test::touch_point(system_, q, {site, face}).depth));
    }
    return most;
  }

  const System& system_;
  std::array<Hop, kSiteCount> hops_{};
};

/// The states at the instants that lie in a segment.
void note_places(double time_limit, const Segment& segment, std::vector<State>& places) {
  while (places.size() < kInstants) {
    const double time = time_limit * static_cast<double>(places.size() + 1) / (kInstants + 1);
    if (time > segment.end_time()) return;
    places.push_back(state_at(segment, std::clamp(time - segment.start.value(), 0.0, segment.duration)));
  }
}

/// FNV-1a.
class Digest {
 public:
  void add(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  void add(std::uint64_t bits) {
    for (int i = 0; i < 8; ++i) sum_ = (sum_ ^ ((bits >> (8 * i)) & 0xff)) * 0x100000001b3u;
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

}  // namespace

bool takes_implicit_steps(const Scene& scene) {
  const std::string& name = scene.solver.name;
  return name == "implicit" || name == kImplicitAlone || name == "auto";
}

double speed_of(const System& system, const State& q) {
  return std::abs(q.vx) + std::abs(q.vy) + std::abs(q.omega) * (system.half_width + system.base_distance);
}

Trace run_trial(const Trial& trial, bool checked, double uncertain) {
  const Scene& scene = trial.scene;
  Trace trace;
  Simulation simulation(scene);
  Changer changer(trial.changes);
  const System& system = simulation.system();
  const double size = system.half_width + system.base_distance, unseen = uncertain * scene.solver.tolerance * size;
  Hops hops(system);
  double way_since_touch = 0.0;  // or since the start; at most
  while (simulation.advance()) {
    changer.make_due(simulation);
    const Segment& segment = simulation.segment();
    if (uncertain > 0.0) hops.follow(segment);
    trace.energy_noise += energy_noise(system, segment);
    const double fastest = std::max(speed_of(system, segment.begin), speed_of(system, segment.end));
    trace.fastest = std::max(trace.fastest, fastest);
    way_since_touch += fastest * segment.duration;
    const Digits digits = {scene.solver.tolerance, trace.fastest, takes_implicit_steps(scene)};
    if (checked && !trace.fault) trace.fault = check_segment(system, digits, segment);
    if (trace.all_touches) note_places(scene.trial.time_limit, segment, trace.places);
    if (!ends_with_touch(segment)) continue;
    // a point that an implicit step has left beside its face may touch several times at once, a part that comes level
    // touches with two points in the order of rounding, and the ring that such steps leave makes or spares low hops
    const double since = trace.touches.empty() ? INFINITY : segment.end_time() - trace.touches.back().time;
    const bool at_once = since <= kSameTime || way_since_touch <= unseen;
    if (uncertain > 0.0 && (at_once || hops.end_below(unseen, segment))) continue;
    way_since_touch = 0.0;
    trace.all_touches = trace.touches.size() < kMaxTouches;
    if (trace.all_touches) trace.touches.push_back({segment.end_time(), segment.end});
  }
  trace.result = simulation.result();
  return trace;
}

TrialResult run_sampled(const Trial& trial, double interval, bool with_events) {
  Simulation simulation(trial.scene);
  Changer changer(trial.changes);
  Sampler sampler(simulation, interval, with_events);
  Sample sample;
  while (!sampler.finished())
    if (!sampler.next(sample, {}, changer.next_time()) && !sampler.finished()) changer.make_due(simulation);
  return simulation.result();
}

std::uint64_t digest(const TrialResult& r) {
  Digest digest;
  const State& q = r.final_state;
  for (const double value : {r.final_time, q.x, q.y, q.phi, q.vx, q.vy, q.omega, r.aligned_time.value_or(-1.0)})
    digest.add(value);
  for (const double peak : r.peak_force) digest.add(peak);
  for (const long impacts : r.impacts) digest.add(static_cast<std::uint64_t>(impacts));
  digest.add(static_cast<std::uint64_t>(r.outcome));
  digest.add(static_cast<std::uint64_t>(r.mode));
  digest.add(static_cast<std::uint64_t>(r.counts.steps));
  digest.add(static_cast<std::uint64_t>(r.counts.events));
  if (r.energy) {
    digest.add(r.energy->final);
    digest.add(r.energy->residual);
  }
  return digest.sum();
}

}  // namespace vibratory_alignment::hunt
