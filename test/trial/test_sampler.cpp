// Samples are read off the motion and change nothing: states, peaks and impulses must be those of the segments, at any
// interval, and what happens between two samples must not be lost.
#include "trial/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../support/random_scenes.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "mechanics/contact_frame.h"

namespace vibratory_alignment {
namespace {

using test::scene_of;

/// Slips down into a slot with walls and floor; events of every kind.
const std::string insertion = R"(
part: {half_width: 0.673, base_distance: 0.9015, inertia: 0.149}
slot: {clearance: 0.09, depth: 0.3}
gripper: {stiffness: {x: 0.0147, phi: 7.3}, damping: {x: 0.011, y: 0.01, phi: 1.33}, pressing_force: 0.4}
base: {stiffness: {x: 3648.0, y: 7600.0}, damping: {x: 9.96, y: 20.75}}
contacts: [edges, corners, walls]
friction: {coefficient: 0.319}
excitation: {amplitude: 1.0, frequency: 20.0}
initial: {x: 0.2, y: 0.95, phi: 0.0}
trial: {time_limit: 12.0, inserted_depth: 0.29}
)";

struct Record {
  std::vector<Sample> samples;
  TrialResult result;
};

Record record(const Scene& scene, double interval, bool with_events = false) {
  Simulation simulation(scene);
  Sampler sampler(simulation, interval, with_events);
  Record r;
  Sample sample;
  while (sampler.next(sample)) r.samples.push_back(sample);
  r.result = simulation.result();
  return r;
}

TEST(Sampler, gives_every_regular_instant_once_and_the_end) {
  for (const double interval : {0.25, 0.1, 0.0371}) {
    const Record r = record(scene_of(insertion), interval);
    ASSERT_GT(r.samples.size(), 10u);
    for (std::size_t i = 0; i + 1 < r.samples.size(); ++i) {
      EXPECT_EQ(r.samples[i].time, static_cast<double>(i) * interval);
      EXPECT_FALSE(r.samples[i].is_last);
    }
    EXPECT_TRUE(r.samples.back().is_last);
    EXPECT_EQ(r.samples.back().time, r.result.final_time);
    EXPECT_EQ(test::distance(r.samples.back().state, r.result.final_state), 0.0);
  }
}

TEST(Sampler, ends_on_a_regular_instant_without_repeating_it) {
  Scene scene = scene_of(insertion);
  scene.trial.time_limit = 2.0;
  const Record r = record(scene, 0.125);
  EXPECT_EQ(r.samples.size(), 17u);
  EXPECT_EQ(r.samples.back().time, 2.0);
  EXPECT_TRUE(r.samples.back().is_last);
}

// Where a sample is many segments away it can be given up for now: nothing is lost, and nothing changes.
TEST(Sampler, goes_on_where_it_was_held) {
  Scene scene = scene_of(insertion);
  scene.trial.time_limit = 4.0;
  scene.solver.name = "rk4";
  scene.solver.step = 1e-4;
  const Record r = record(scene, 0.5);
  Simulation simulation(scene);
  Sampler sampler(simulation, 0.5);
  Sample sample;
  std::size_t index = 0;
  int held = 0;
  while (!sampler.finished()) {
    const long before = simulation.result().counts.steps;
    if (!sampler.next(sample, [] { return false; })) {
      EXPECT_LE(simulation.result().counts.steps - before, Sampler::kSegmentsUnasked);
      ++held;
      continue;
    }
    ASSERT_LT(index, r.samples.size());
    EXPECT_EQ(sample.time, r.samples[index].time);
    EXPECT_EQ(test::distance(sample.state, r.samples[index].state), 0.0);
    EXPECT_EQ(sample.contacts[0].peak_normal_force, r.samples[index].contacts[0].peak_normal_force);
    ++index;
  }
  EXPECT_EQ(index, r.samples.size());
  EXPECT_GT(held, 20);
}

// Followed from one sample to the next the trial is the same, and its end is there once its instant is.
TEST(Sampler, gives_the_end_as_soon_as_it_is_reached) {
  Scene scene = scene_of(insertion);
  scene.trial.time_limit = 4.1;
  const Record r = record(scene, 0.5);
  Simulation simulation(scene);
  Sampler sampler(simulation, 0.5);
  Sample sample;
  std::size_t index = 0;
  for (double now = 0.0; !sampler.finished(); now += 0.01) {
    ASSERT_LT(now, 4.2);
    while (sampler.next(sample, {}, now)) {
      ASSERT_LT(index, r.samples.size());
      EXPECT_EQ(sample.time, r.samples[index].time);
      EXPECT_EQ(test::distance(sample.state, r.samples[index].state), 0.0);
      EXPECT_LE(sample.time, now);
      EXPECT_GT(sample.time, now - 0.011) << "not later than need be";
      ++index;
    }
  }
  EXPECT_EQ(index, r.samples.size());
  EXPECT_TRUE(sample.is_last);
  EXPECT_EQ(simulation.result().counts.steps, r.result.counts.steps);
}

TEST(Sampler, output_rate_changes_nothing) {
  const Scene scene = scene_of(insertion);
  const Record coarse = record(scene, 0.5), fine = record(scene, 1.0 / 128.0), events = record(scene, 0.25, true);
  const TrialResult alone = test::run(scene);
  std::map<double, Sample> at;
  for (const Sample& s : fine.samples) at[s.time] = s;
  for (const Record* r : {&coarse, &events})
    for (const Sample& s : r->samples) {
      if (at.count(s.time) == 0) continue;
      EXPECT_EQ(test::distance(at[s.time].state, s.state), 0.0) << s.time;
      for (std::size_t i = 0; i < kSiteCount; ++i)
        EXPECT_EQ(at[s.time].contacts[i].normal_force, s.contacts[i].normal_force);
    }
  for (const Record* r : {&coarse, &fine, &events}) {
    EXPECT_EQ(test::distance(r->result.final_state, alone.final_state), 0.0);
    EXPECT_EQ(r->result.final_time, alone.final_time);
    EXPECT_EQ(r->result.peak_force, alone.peak_force);
    EXPECT_EQ(r->result.counts.steps, alone.counts.steps);
  }
}

TEST(Sampler, event_samples_are_at_the_events_and_in_order) {
  const Scene scene = scene_of(insertion);
  const Record r = record(scene, 0.25, true);
  std::vector<double> expected;
  for (const test::TimedEvent& e : test::events_of(scene))
    if (expected.empty() || e.time > expected.back()) expected.push_back(e.time);
  std::vector<double> seen;
  double last = -1.0;
  for (const Sample& s : r.samples) {
    EXPECT_GT(s.time, last);
    last = s.time;
    const double steps = s.time / 0.25;
    if (s.is_event || steps != std::floor(steps)) seen.push_back(s.time);
  }
  for (const double time : expected)
    EXPECT_TRUE(std::any_of(r.samples.begin(), r.samples.end(), [&](const Sample& s) { return s.time == time; }))
        << time;
  EXPECT_GE(seen.size() + 3, expected.size());
}

// Integral of all forces = change of momentum: m dv = impulse of the base + of springs, dampers, weight and excitation.
// Without a gripper's spring and damper along x the base's impulse alone makes vx.
TEST(Sampler, impulses_make_the_momentum) {
  const Scene scene = scene_of(
      test::plain, {"gripper.stiffness.x=0", "gripper.damping.x=0", "contacts=[edges, corners]", "trial.time_limit=4"});
  for (const double interval : {1.0, 0.1, 0.013}) {
    double velocity = 0.0;
    double total = 0.0;
    for (const Sample& s : record(scene, interval).samples) {
      for (const ContactSample& c : s.contacts) total += c.impulse_x;
      velocity = s.state.vx;
      EXPECT_NEAR(total, velocity, 1e-12) << s.time;
    }
    EXPECT_GT(std::abs(velocity), 1e-3);
  }
}

TEST(Sampler, impulses_and_peaks_between_samples_are_not_lost) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.trial.time_limit = 5.0;
    if (seed % 2 == 0) test::cross_layers(scene);
    // the truth: a fine rule over every segment
    std::array<double, kSiteCount> impulse{}, peak{};
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i) {
        const auto site = static_cast<std::size_t>(g.loaded[static_cast<std::size_t>(i)].site);
        const int n = 40;  // Simpson
        for (int k = 0; k <= n; ++k) {
          const double force = contact_at(g, i, g.duration * k / n).normal_force;
          peak[site] = std::max(peak[site], force);
          impulse[site] += force * (k == 0 || k == n ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) * g.duration / (3.0 * n);
        }
      }
    });
    for (const double interval : {2.0, 0.3, 0.01}) {
      std::array<double, kSiteCount> sum{}, largest{};
      for (const Sample& s : record(scene, interval).samples)
        for (std::size_t i = 0; i < kSiteCount; ++i) {
          sum[i] += s.contacts[i].normal_impulse;
          largest[i] = std::max(largest[i], s.contacts[i].peak_normal_force);
          // the sample's own force is one of those since the last sample
          EXPECT_GE(s.contacts[i].peak_normal_force, s.contacts[i].normal_force * (1.0 - 1e-12)) << "seed " << seed;
        }
      for (std::size_t i = 0; i < kSiteCount; ++i) {
        EXPECT_NEAR(sum[i], impulse[i], 1e-6 * (1.0 + impulse[i])) << "seed " << seed << " site " << i;
        EXPECT_GE(largest[i], peak[i] * (1.0 - 1e-12)) << "seed " << seed;
        EXPECT_LE(largest[i], peak[i] * 1.01 + 1e-12) << "seed " << seed;
      }
    }
  }
}

TEST(Sampler, contact_samples_are_those_of_the_model) {
  const Scene scene = scene_of(insertion);
  int loaded = 0;
  for (const Sample& s : record(scene, 0.003).samples)
    for (std::size_t i = 0; i < kSiteCount; ++i) {
      const ContactSample& c = s.contacts[i];
      EXPECT_GE(c.normal_force, 0.0);
      EXPECT_GE(c.peak_normal_force, 0.0);
      if (c.state.phase == Phase::outside) {
        EXPECT_EQ(c.normal_force, 0.0);
        continue;
      }
      if (c.state.phase != Phase::loaded) continue;
      ++loaded;
      EXPECT_NEAR(std::hypot(c.normal_x, c.normal_y), 1.0, 1e-14);
      EXPECT_LE(std::abs(c.tangential_force), 0.319 * c.normal_force + 1e-9);
      EXPECT_NEAR(c.force_x, c.normal_force * c.normal_x + c.tangential_force * c.normal_y, 1e-12);
      EXPECT_NEAR(c.force_y, c.normal_force * c.normal_y - c.tangential_force * c.normal_x, 1e-12);
      // edges touch where they are; corners where the part has them
      if (i < 2) {
        EXPECT_NEAR(c.point_x, i == 0 ? scene.slot_half_width() : -scene.slot_half_width(), 1e-15);
        EXPECT_NEAR(c.point_y, 0.0, 1e-15);
      } else {
        const double reach = std::hypot(c.point_x - s.state.x, c.point_y - s.state.y);
        EXPECT_NEAR(reach, std::hypot(scene.part.half_width, scene.part.base_distance), 1e-14);
      }
    }
  EXPECT_GT(loaded, 10);
}

TEST(Sampler, impacts_and_progress_grow_to_those_of_the_result) {
  const Record r = record(scene_of(insertion), 0.02);
  long before = 0;
  for (const Sample& s : r.samples) {
    long now = 0;
    for (const long impacts : s.impacts) now += impacts;
    EXPECT_GE(now, before);
    before = now;
    EXPECT_EQ(s.misalignment, std::abs(s.state.x));
    EXPECT_GE(s.progress, 0.0);
    EXPECT_LE(s.progress, 1.0);
  }
  ASSERT_EQ(r.result.outcome, Outcome::inserted);  // by a touch at the last instant
  EXPECT_EQ(r.samples.back().impacts, r.result.impacts);
  EXPECT_EQ(r.samples.back().mode, r.result.mode);
  EXPECT_EQ(r.samples.front().progress, 0.0);
}

// Before the first change of mode contact is kept while the first one lasts, and nothing is decided in the flight after
// it, however long that is.
TEST(Sampler, before_the_first_change_mode_is_that_of_the_sample_s_contacts) {
  const Record r = record(scene_of(insertion, {"initial.y=null", "gripper.pressing_force=0.1"}), 0.002);
  ASSERT_EQ(r.result.mode_changes.at(0).mode, Mode::impact);
  int kept = 0, undecided = 0;
  for (const Sample& sample : r.samples) {
    if (sample.time >= r.result.first_contact->time) break;
    const bool touching = std::any_of(sample.contacts.begin(), sample.contacts.end(),
                                      [](const ContactSample& contact) { return contact.state.touching(); });
    EXPECT_EQ(sample.mode, touching ? Mode::nonimpact : Mode::none) << sample.time;
    ++(touching ? kept : undecided);
  }
  EXPECT_GT(kept, 3);
  EXPECT_GT(undecided, 3);
}

TEST(Sampler, of_a_failed_trial_ends_with_the_last_good_state) {
  Scene scene = scene_of(insertion);
  scene.solver.step_limit = 60;
  const Record r = record(scene, 0.01);
  EXPECT_EQ(r.result.outcome, Outcome::failed);
  ASSERT_FALSE(r.samples.empty());
  EXPECT_TRUE(r.samples.back().is_last);
  EXPECT_EQ(test::distance(r.samples.back().state, r.result.final_state), 0.0);
}

// A trial may fail in its very first step: then there is nothing to sample.
TEST(Sampler, of_a_trial_that_fails_at_once_gives_nothing) {
  Scene scene = scene_of(insertion);
  scene.initial.vx = NAN;
  const Record r = record(scene, 0.01);
  EXPECT_EQ(r.result.outcome, Outcome::failed);
  EXPECT_TRUE(r.samples.empty());
}

// An impact of a ball on an undamped base, dropped from 0.3 above: the base gives it 2 v k/(k + 1) upward, and is
// pressed in as far as the part is below it.
TEST(Sampler, of_a_ball_on_its_base) {
  constexpr double k = 1e3;
  const Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2",
                                            "base={stiffness: {y: 1.0e3}}", "trial.time_limit=3"});
  double impulse = 0.0;
  int touching = 0;
  for (const Sample& s : record(scene, 0.01).samples) {
    const ContactSample& c = s.contacts[0];
    impulse += c.impulse_y;
    EXPECT_EQ(c.impulse_x, 0.0);
    if (!c.state.touching()) continue;
    ++touching;
    EXPECT_NEAR(c.depth, 0.9 - s.state.y, 1e-14);
    EXPECT_NEAR(c.normal_force, k * c.depth, 1e-9);
  }
  EXPECT_GT(touching, 5);
  EXPECT_NEAR(impulse, 2.0 * 0.3 * k / (k + 1.0), 1e-7);
}

// Impulses are the integrals of the forces along x and y, also where a segment crosses the tanh layer.
TEST(Sampler, impulses_are_the_integrals_of_the_forces) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.trial.time_limit = 5.0;
    if (seed % 2 == 0) test::cross_layers(scene);
    const System system = make_system(scene);
    std::array<double, kSiteCount> x{}, y{};
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i) {
        const Site at = g.loaded[static_cast<std::size_t>(i)].site;
        const auto site = static_cast<std::size_t>(at);
        const int n = 40;  // Simpson
        for (int step = 0; step <= n; ++step) {
          const double t = g.duration * step / n;
          const ContactValues force = contact_at(g, i, t);
          const ContactKinematics c = contact_kinematics(system, state_at(g, t), at, g.contacts[site].face);
          const double weight = (step == 0 || step == n ? 1.0 : step % 2 == 1 ? 4.0 : 2.0) * g.duration / (3.0 * n);
          x[site] += weight * (force.normal_force * c.normal.x + force.tangential_force * c.normal.y);
          y[site] += weight * (force.normal_force * c.normal.y - force.tangential_force * c.normal.x);
        }
      }
    });
    std::array<double, kSiteCount> sum_x{}, sum_y{};
    for (const Sample& s : record(scene, 0.3).samples)
      for (std::size_t site = 0; site < kSiteCount; ++site) {
        sum_x[site] += s.contacts[site].impulse_x;
        sum_y[site] += s.contacts[site].impulse_y;
      }
    for (std::size_t site = 0; site < kSiteCount; ++site) {
      EXPECT_NEAR(sum_x[site], x[site], 1e-6 * (1.0 + std::abs(x[site]))) << "seed " << seed << " site " << site;
      EXPECT_NEAR(sum_y[site], y[site], 1e-6 * (1.0 + std::abs(y[site]))) << "seed " << seed << " site " << site;
    }
  }
}

// From the start, |x| = 0.2, to the clearance of the slot, 0.09.
TEST(Sampler, progress_is_the_share_of_the_way_to_the_clearance) {
  const Record r = record(scene_of(insertion), 0.02);
  int there = 0;
  for (const Sample& s : r.samples) {
    const double share = (0.2 - s.misalignment) / (0.2 - 0.09);
    EXPECT_NEAR(s.progress, std::min(1.0, std::max(0.0, share)), 1e-14) << s.time;
    there += s.misalignment <= 0.09 ? 1 : 0;
  }
  EXPECT_GT(there, 10);
}

}  // namespace
}  // namespace vibratory_alignment
