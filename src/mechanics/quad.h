// Two and four numbers at once, the latter in one register where the processor has AVX, else in two. The results are
// the same to the bit.
#pragma once

namespace vibratory_alignment {

using Pair = double __attribute__((vector_size(16)));
using Quad = double __attribute__((vector_size(32)));

/// For what has to become part of a function that is compiled for AVX.
#define VIBRATORY_ALIGNMENT_INLINE __attribute__((always_inline)) inline

}  // namespace vibratory_alignment
