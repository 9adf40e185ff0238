// Two and four numbers at once, the latter in one register where the processor has AVX2, else in two. Where it has that
// it adds products without rounding them first (FMA): the last digits are not those of other processors.
#pragma once

namespace vibratory_alignment {

using Pair = double __attribute__((vector_size(16)));
/// Their alignment is told: of a structure of them the compiler believes 16 bytes where it compiles without AVX2.
using Quad = double __attribute__((vector_size(32), aligned(32)));
using QuadMask = long long __attribute__((vector_size(32), aligned(32)));  ///< for choosing (-1 or 0) and ordering

/// For what has to become part of a function that is compiled for AVX2: also of a lambda, after its parameters.
#define VIBRATORY_ALIGNMENT_INLINE __attribute__((always_inline)) inline
#define VIBRATORY_ALIGNMENT_INLINE_LAMBDA __attribute__((always_inline))

/// The first two of four, the last two, and two in the other order.
VIBRATORY_ALIGNMENT_INLINE Pair low(const Quad& of) { return Pair{of[0], of[1]}; }
VIBRATORY_ALIGNMENT_INLINE Pair high(const Quad& of) { return Pair{of[2], of[3]}; }
VIBRATORY_ALIGNMENT_INLINE Pair swapped(const Pair& of) { return Pair{of[1], of[0]}; }

/// A product that is rounded before something is added. Of a b + c d either one may be, as the compiler likes: where
/// results of different functions are to be the same to the bit, it is told which.
template <typename Number>
VIBRATORY_ALIGNMENT_INLINE Number rounded(Number product) {
#ifdef __x86_64__
  asm("" : "+x"(product));
#endif
  return product;
}

#ifdef __x86_64__
template <typename Body>
__attribute__((target("avx2,fma"), noinline)) void run_on_avx2(const Body& body) {
  body();
}

/// Runs the body, a lambda that is marked as above, compiled for AVX2 and FMA where the processor has them.
template <typename Body>
inline void run_widely(const Body& body) {
  static const bool wide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  wide ? run_on_avx2(body) : body();
}
#else
template <typename Body>
inline void run_widely(const Body& body) {
  body();
}
#endif

}  // namespace vibratory_alignment
