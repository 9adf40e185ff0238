// Two and four numbers at once, the latter in one register where the processor has AVX2, else in two. The results are
// the same to the bit.
#pragma once

namespace vibratory_alignment {

using Pair = double __attribute__((vector_size(16)));
using Quad = double __attribute__((vector_size(32)));

/// For what has to become part of a function that is compiled for AVX2: also of a lambda, after its parameters.
#define VIBRATORY_ALIGNMENT_INLINE __attribute__((always_inline)) inline
#define VIBRATORY_ALIGNMENT_INLINE_LAMBDA __attribute__((always_inline))

#ifdef __x86_64__
template <typename Body>
__attribute__((target("avx2"), noinline)) void run_on_avx2(const Body& body) {
  body();
}

/// Runs the body, a lambda that is marked as above, compiled for AVX2 where the processor has it.
template <typename Body>
inline void run_widely(const Body& body) {
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  wide ? run_on_avx2(body) : body();
}
#else
template <typename Body>
inline void run_widely(const Body& body) {
  body();
}
#endif

}  // namespace vibratory_alignment
