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
constexpr int kFrame = 11;  ///< columns around the bar, and one that stays free so that no terminal breaks the line
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

ProgressBar::ProgressBar(bool shown) : shown_(shown), begin_(Clock::now()), next_(begin_ + kDelay) {}

ProgressBar::~ProgressBar() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
}

void ProgressBar::update(double share, const std::function<std::string()>& describe) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  draw(std::clamp(share, 0.0, 1.0), describe());
  next_ = now + kInterval;
}

double ProgressBar::seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

void ProgressBar::draw(double share, const std::string& words) {
  const int room = terminal_width() - kFrame;
  const std::string text = words.substr(0, static_cast<std::size_t>(std::max(0, room)));
  const int width = std::clamp(room - static_cast<int>(text.size()), 0, kMaxBarWidth);
  const int filled = static_cast<int>(share * width);
  const std::string bar =
      std::string(static_cast<size_t>(filled), '#') + std::string(static_cast<size_t>(width - filled), '.');
  std::printf("\r\033[K[%s] %3.0f %%  %s", bar.c_str(), 100.0 * share, text.c_str());
  std::fflush(stdout);
  drawn_ = true;
}

}  // namespace vibratory_alignment
