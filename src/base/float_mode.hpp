// FloatMode: how this thread computes while one lives. What the library computes thus depends on no
// setting of the caller, which is restored: rounding, flushing of denormals, traps, and the
// exception flags that were raised before.
//
// Every public call that computes is in one, mostly by Pimpl (src/base/pimpl.hpp); steps of groups
// are in one that flushes denormals, whatever thread they run on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace manyworlds {

class FloatMode {
 public:
  enum Denormals { keep, flush };

  // Rounding to nearest, no traps, and denormals kept or, as input and as output, zero.
  explicit FloatMode(Denormals denormals = keep) noexcept {
    std::uint16_t x87 = 0;
    asm volatile("stmxcsr %0\n\tfnstcw %1" : "=m"(sse_), "=m"(x87));
    // Printing and reading of numbers look at the rounding mode of the x87.
    if (x87 != kX87) {
      asm volatile("fnstenv %0\n\tfninit" : "=m"(x87_));
      x87_saved_ = true;
    }
    const std::uint32_t wanted = kSse | (denormals == flush ? kFlush : 0u) | (sse_ & kFlags);
    set(wanted);
  }
  ~FloatMode() {
    set(sse_);
    if (x87_saved_) asm volatile("fldenv %0" : : "m"(x87_) : "memory");
  }
  // The number, worked out before the mode ends: registers know nothing of modes.
  template <class Number>
  static Number done(Number x) {
    asm volatile("" : "+m"(x));
    return x;
  }
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
  static constexpr std::uint32_t kFlags = 0x3f;    // exceptions that were raised
  static constexpr std::uint32_t kSse = 0x1f80;    // all masked, to nearest
  static constexpr std::uint32_t kFlush = 0x8040;  // flush-to-zero, denormals-are-zero
  static constexpr std::uint16_t kX87 = 0x37f;

  // Setting costs more than looking. Nothing that computes on memory is moved across either.
  static void set(std::uint32_t wanted) noexcept {
    std::uint32_t now = 0;
    asm volatile("stmxcsr %0" : "=m"(now) : : "memory");
    if (now != wanted) asm volatile("ldmxcsr %0" : : "m"(wanted) : "memory");
  }

  std::uint32_t sse_ = 0;
  bool x87_saved_ = false;
  std::array<std::byte, 28> x87_;
};

// Calls a function in the library's mode, as a function of its own.
template <auto make>
auto in_float_mode() {
  const FloatMode mode;
  return make();
}

}  // namespace manyworlds
