#include "tests/support/float_modes.hpp"

#include <catch2/catch.hpp>

#include <xmmintrin.h>

#include <cfenv>
#include <cstdint>

namespace manyworlds::test {

namespace {

struct Mode {
  const char* name;
  void (*enter)();
};

std::uint16_t x87_control() {
  std::uint16_t word = 0;
  asm volatile("fnstcw %0" : "=m"(word));
  return word;
}

constexpr unsigned kDenormalTrap = 0x100;

// Of all exceptions, inexact results and denormals, too: whatever computes outside of the library's
// mode ends the test.
const Mode kModes[] = {
    {"rounds up", [] { std::fesetround(FE_UPWARD); }},
    {"rounds down", [] { std::fesetround(FE_DOWNWARD); }},
    {"rounds towards zero", [] { std::fesetround(FE_TOWARDZERO); }},
    {"flushes denormals", [] { _mm_setcsr(_mm_getcsr() | 0x8040u); }},
    {"has raised exceptions", [] { std::feraiseexcept(FE_OVERFLOW | FE_DIVBYZERO); }},
    {"traps",
     [] {
       feenableexcept(FE_ALL_EXCEPT);
       _mm_setcsr(_mm_getcsr() & ~kDenormalTrap);
     }},
};

}  // namespace

void check_modes(const std::vector<ModeEntry>& entries) {
  for (const ModeEntry& entry : entries) {
    INFO(entry.name);
    const StateBytes expected = entry.call([](const auto& act) { act(); });
    CHECK(!expected.empty());
    for (const Mode& mode : kModes) {
      INFO(mode.name);
      bool called = false, kept = true;
      const StateBytes found = entry.call([&](const std::function<void()>& act) {
        std::fenv_t before;
        std::feholdexcept(&before);
        mode.enter();
        const unsigned sse = _mm_getcsr();
        const std::uint16_t x87 = x87_control();
        act();
        kept = kept && _mm_getcsr() == sse && x87_control() == x87;
        called = true;
        std::fesetenv(&before);
      });
      CHECK(called);
      CHECK(kept);
      if (!(found == expected)) FAIL_CHECK("gives other bytes");
    }
  }
}

}  // namespace manyworlds::test
