// Ctrl-C, or the end of the terminal, during a run: the run ends at the next step instead of dying with half-written
// files.
#pragma once

namespace vibratory_alignment {

/// While it lives, SIGINT, SIGTERM and SIGHUP only set a flag. A second signal ends the process at once, unless it
/// comes within half a second: that is how long tidying up may take. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Number of the signal that arrived, 0 for none.
  int signal() const;
};

}  // namespace vibratory_alignment
