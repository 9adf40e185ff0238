#include "cli/progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace vibratory_alignment {
namespace {

constexpr std::chrono::milliseconds kDelay(1000);
constexpr std::chrono::milliseconds kInterval(100);
constexpr int kTextWidth = 58;  ///< columns that the text around the bar takes
constexpr int kMaxBarWidth = 40;

int terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

bool stdout_is_terminal() {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDOUT_FILENO) == 1 && (terminal == nullptr || std::string(terminal) != "dumb");
}

ProgressBar::ProgressBar(double end, bool shown)
    : end_(end), shown_(shown), begin_(Clock::now()), next_(begin_ + kDelay) {}

ProgressBar::~ProgressBar() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
}

void ProgressBar::update(double time) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  draw(time, now);
  next_ = now + kInterval;
}

void ProgressBar::draw(double time, Clock::time_point now) {
  const double done = end_ > 0.0 ? std::clamp(time / end_, 0.0, 1.0) : 0.0;
  const int width = std::clamp(terminal_width() - kTextWidth, 0, kMaxBarWidth);
  const int filled = static_cast<int>(done * width);
  const std::string bar =
      std::string(static_cast<size_t>(filled), '#') + std::string(static_cast<size_t>(width - filled), '.');
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  std::printf("\r\033[K[%s] %3.0f %%  at t = %.5g of at most %.5g, %.0f s", bar.c_str(), 100.0 * done, time, end_,
              seconds);
  std::fflush(stdout);
  drawn_ = true;
}

}  // namespace vibratory_alignment
