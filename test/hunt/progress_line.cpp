#include "progress_line.h"

#include <unistd.h>

#include <cstdio>

namespace vibratory_alignment::hunt {

ProgressLine::ProgressLine(long count) : count_(count), shown_(isatty(STDERR_FILENO) == 1), begin_(Clock::now()) {}

double ProgressLine::seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

void ProgressLine::show(long done, long failed) {
  if (!shown_ || done == 0) return;
  const double rate = static_cast<double>(done) / seconds();
  const auto left = static_cast<long>(static_cast<double>(count_ - done) / rate);
  std::fprintf(stderr, "\r\033[K%ld of %ld scenes (%.1f %%), %.0f a second, %ld failed, %ld:%02ld:%02ld left", done,
               count_, 100.0 * static_cast<double>(done) / static_cast<double>(count_), rate, failed, left / 3600,
               left / 60 % 60, left % 60);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressLine::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace vibratory_alignment::hunt
