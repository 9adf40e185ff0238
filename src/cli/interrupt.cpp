#include "cli/interrupt.h"

#include <csignal>

namespace vibratory_alignment {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t g_signal = 0;

void remember(int signal) {
  g_signal = signal;
  std::signal(signal, SIG_DFL);
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
