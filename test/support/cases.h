// How many random cases a test looks at. In a build that the sanitizers watch each takes ten times as long, and a fifth
// of them show as much of memory and undefined behaviour.
#pragma once

namespace vibratory_alignment::test {

constexpr int cases_of(int count) {
#ifdef __SANITIZE_ADDRESS__
  return count / 5;
#else
  return count;
#endif
}

}  // namespace vibratory_alignment::test
