// Ctrl-C and other signals while a call that takes long works without the GIL.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <optional>
#include <utility>

namespace manyworlds::python {

// For calls that ask whether to go on (manyworlds::GoOn) and, since they can be asked often, looks
// for signals every 50 ms. What a signal's handler raised waits for raise(): it must be called
// after the call, by whoever let it ask.
class Interrupts {
 public:
  static constexpr auto kPause = std::chrono::milliseconds(50);

  // Looks first when the call has lasted for so long.
  explicit Interrupts(std::chrono::milliseconds first = kPause) : next_(Clock::now() + first) {}

  bool go_on() {
    if (raised_) return false;
    const auto now = Clock::now();
    if (now < next_) return true;
    next_ = now + kPause;
    const nanobind::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) raised_.emplace();
    return !raised_;
  }
  // Without the GIL, as the calls are.
  void raise() {
    if (!raised_) return;
    const nanobind::gil_scoped_acquire acquire;
    nanobind::python_error error = std::move(*raised_);
    raised_.reset();
    throw error;
  }
  // f(go on), then raise().
  template <class F>
  static auto during(F f, std::chrono::milliseconds first = kPause) {
    Interrupts self(first);
    auto result = f([&self] { return self.go_on(); });
    self.raise();
    return result;
  }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point next_;
  std::optional<nanobind::python_error> raised_;
};

}  // namespace manyworlds::python
