// Flushes denormals to zero while it lives and restores the caller's setting after: the same for
// every task on every thread, so results do not depend on who runs them.
#pragma once

#include <xmmintrin.h>

namespace manyworlds {

class FlushDenormals {
 public:
  // Round to nearest, all exceptions masked, flush-to-zero and denormals-are-zero.
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(0x1f80u | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace manyworlds
