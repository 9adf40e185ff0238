// After the first advance() a trial allocates nothing: not in the solver, not in what watches it, not in the sampler.
// This file replaces the global operators new and delete and, where nothing else does, malloc, and counts while asked
// to.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace {

thread_local bool counting = false;
thread_local long allocations = 0;

void count() {
  if (counting) ++allocations;
}

}  // namespace

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* __libc_realloc(void* old, std::size_t size);

extern "C" void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
extern "C" void* calloc(std::size_t n, std::size_t size) {
  count();
  return __libc_calloc(n, size);
}
extern "C" void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
#endif

// not inlined: the compiler would see free() at the end of a `new`
__attribute__((noinline)) void* operator new(std::size_t size) {
  count();
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace vibratory_alignment {
namespace {

/// Counts while it lives.
class Watch {
 public:
  Watch() {
    allocations = 0;
    counting = true;
  }
  ~Watch() { counting = false; }
  long seen() const { return allocations; }
};

struct WatchedCase {
  std::string name;
  std::vector<std::string> settings;
};

std::ostream& operator<<(std::ostream& out, const WatchedCase& c) { return out << c.name; }

const std::string slips_down = R"(
part: {half_width: 0.673, base_distance: 0.9015, inertia: 0.149}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.0147, phi: 7.3}, damping: {x: 0.011, y: 0.01, phi: 1.33}, pressing_force: 0.4}
base: {stiffness: {x: 3648.0, y: 7600.0}, damping: {x: 9.96, y: 20.75}}
contacts: [edges, corners]
friction: {coefficient: 0.319}
excitation: {amplitude: 1.0, frequency: 20.0}
initial: {x: 0.2, y: 0.895, phi: 0.025}
trial: {time_limit: 20.0, aligned_depth: 0.02}
)";

class NoAllocation : public testing::TestWithParam<WatchedCase> {};
INSTANTIATE_TEST_SUITE_P(
    scene, NoAllocation,
    testing::Values(
        WatchedCase{"slips_down", {}}, WatchedCase{"insertion", {"contacts=[edges, corners, walls]", "slot.depth=0.2"}},
        WatchedCase{"regularised", {"friction.regularization=2.0e-3"}}, WatchedCase{"recovery", {"base.recovery=true"}},
        WatchedCase{"implicit", {"solver.name=implicit"}},
        WatchedCase{"auto", {"solver.name=auto", "gripper.pressing_force=3"}},
        WatchedCase{"rk4", {"solver={name: rk4, step: 1.0e-3}", "base.recovery=true"}},
        WatchedCase{"semi_implicit", {"solver={name: semi_implicit, step: 1.0e-3}"}},
        WatchedCase{
            "semi_implicit_in_the_slot",
            {"solver={name: semi_implicit, step: 1.0e-3}", "contacts=[edges, corners, walls]", "slot.depth=0.2"}},
        WatchedCase{"wedged",
                    {"contacts=[edges, walls]", "slot={clearance: 0.02, depth: 0.4}",
                     "gripper={anchor: {y: 0.3, phi: 0.2}, "
                     "stiffness: {x: 0.5, phi: 7}}",
                     "trial.time_limit=5"}},
        WatchedCase{
            "all_waveforms",
            {"excitation=[{amplitude: 1, frequency: 20, waveform: square}, {amplitude: 0.3, frequency: 7, "
             "waveform: triangle, direction: x}, {amplitude: 0.1, frequency: 3, waveform: chirp, end_frequency: 30, "
             "sweep_time: 2, direction: phi}]",
             "trial.time_limit=3"}}),
    [](const auto& info) { return info.param.name; });

TEST_P(NoAllocation, in_advance) {
  const Scene scene = test::scene_of(slips_down, GetParam().settings);
  Simulation simulation(scene);
  ASSERT_TRUE(simulation.advance());
  long steps = 0;
  const Watch watch;
  while (simulation.advance()) ++steps;
  EXPECT_EQ(watch.seen(), 0);
  EXPECT_GT(steps, 50);
}

TEST_P(NoAllocation, in_the_sampler) {
  const Scene scene = test::scene_of(slips_down, GetParam().settings);
  Simulation simulation(scene);
  Sampler sampler(simulation, 0.01, true);
  Sample sample;
  ASSERT_TRUE(sampler.next(sample));
  long samples = 0;
  const Watch watch;
  while (sampler.next(sample)) ++samples;
  EXPECT_EQ(watch.seen(), 0);
  EXPECT_GT(samples, 100);
}

// What the node does while it runs: cuts, and changes of excitation and press.
TEST(NoAllocation, in_changes_while_it_runs) {
  const Scene scene = test::scene_of(slips_down);
  std::vector<Excitation> settings = scene.excitations;
  Simulation simulation(scene);
  Sampler sampler(simulation, 0.05);
  Sample sample;
  ASSERT_TRUE(sampler.next(sample));
  // the first change may take room for its copy
  simulation.cut(sampler.time());
  simulation.set_excitations(settings);
  const Watch watch;
  while (sampler.next(sample)) {
    simulation.cut(sampler.time());
    settings[0].frequency *= 1.001;
    simulation.set_excitations(settings);
    simulation.set_pressing_force(0.4);
  }
  EXPECT_EQ(watch.seen(), 0);
}

TEST(NoAllocation, is_something_that_this_test_would_notice) {
  const Watch watch;
  std::vector<double>* some = new std::vector<double>(10);
  delete some;
  EXPECT_GE(watch.seen(), 2);
}

}  // namespace
}  // namespace vibratory_alignment
