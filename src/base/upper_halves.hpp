// Between kernels and the rest of the program.
#pragma once

namespace manyworlds {

// After a call of a kernel with this many lanes: leaves the upper halves of vector registers
// unused. GCC 12 leaves that out where a function has passed registers to one of its own; what the
// program computes in SSE then waits for them, and the kernels after it, too. Compiled by -O3,
// which uses SSE where -O2 does not, ball2d steps at half its speed without.
inline void clear_upper_halves(int lanes) {
#if defined(__x86_64__) && defined(__GNUC__)
  if (lanes == 1) return;
  asm volatile("vzeroupper" ::
                   : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9",
                     "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#else
  static_cast<void>(lanes);
#endif
}

}  // namespace manyworlds
