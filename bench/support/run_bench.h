// The end of a bench's main().
#pragma once

#include <cstdio>
#include <exception>

namespace vibratory_alignment {

/// Runs the bench and returns its exit status: 1, with a message, where it throws or its output cannot be written.
template <class Bench>
int run_bench(const char* name, Bench bench) {
  try {
    bench();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 1;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    std::fprintf(stderr, "%s: the output cannot be written\n", name);
    return 1;
  }
  return 0;
}

}  // namespace vibratory_alignment
