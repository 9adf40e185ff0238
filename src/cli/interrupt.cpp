#include "cli/interrupt.h"

#include <csignal>
#include <ctime>

namespace vibratory_alignment {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

/// A signal within this time of the first one comes with it, as `timeout` sends one to the process and one to its
/// group; in seconds.
constexpr double kOneInterrupt = 0.5;

volatile std::sig_atomic_t g_signal = 0;
timespec g_arrival{};

double seconds_since(const timespec& instant) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec - instant.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - instant.tv_nsec);
}

void remember(int signal) {
  if (g_signal == 0) {
    clock_gettime(CLOCK_MONOTONIC, &g_arrival);
    g_signal = signal;
  } else if (seconds_since(g_arrival) > kOneInterrupt) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

InterruptGuard::InterruptGuard() {
  g_signal = 0;
  for (const int signal : kSignals) {
    // A shell starts background jobs with SIGINT ignored, and nohup any with SIGHUP; that stays so.
    if (std::signal(signal, remember) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

InterruptGuard::~InterruptGuard() {
  for (const int signal : kSignals) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

int InterruptGuard::signal() const { return g_signal; }

}  // namespace vibratory_alignment
