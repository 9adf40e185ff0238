#include "node/pace_meter.h"

namespace vibratory_alignment {

void PaceMeter::set_running(bool running, Clock::time_point now) {
  if (running_ && !running) report_.running += std::chrono::duration<double>(now - since_).count();
  if (!running_ && running) since_ = now;
  running_ = running;
}

void PaceMeter::add_sample(double simulated) {
  if (!running_) return;
  report_.simulated += simulated;
  ++report_.samples;
}

PaceReport PaceMeter::take(Clock::time_point now) {
  if (running_) report_.running += std::chrono::duration<double>(now - since_).count();
  since_ = now;
  const PaceReport taken = report_;
  report_ = {};
  return taken;
}

}  // namespace vibratory_alignment
