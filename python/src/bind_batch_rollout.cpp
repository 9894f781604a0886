// Open-loop rollouts: controls in, trajectories out, all steps in one call without the GIL.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <chrono>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "read_quantity.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

namespace {

using Clock = std::chrono::steady_clock;

// Ctrl-C and other signals, ten times a second.
class Interrupts {
 public:
  void check() {
    if (Clock::now() < next_) return;
    next_ = Clock::now() + std::chrono::milliseconds(100);
    const nb::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }

 private:
  Clock::time_point next_ = Clock::now() + std::chrono::milliseconds(100);
};

// One array (frames, ...) and where its next frame goes.
template <class Number>
struct Trajectory {
  Quantity quantity;
  std::span<Number> numbers;

  void frame(const Batch& batch, std::size_t index, std::size_t frames) const {
    const std::size_t each = numbers.size() / frames;
    read_quantity(batch, quantity, numbers.subspan(index * each, each));
  }
};

// Controls of each step, or none; all of one number type.
template <class Number>
struct Plays {
  std::span<const Number> controls;
  std::size_t each = 0;

  void play(Batch& batch, std::size_t step) const {
    if (!controls.empty()) batch.set_controls(controls.subspan(step * each, each));
  }
};

struct Recorder {
  std::vector<Trajectory<float>> singles;
  std::vector<Trajectory<double>> doubles;

  void frame(const Batch& batch, std::size_t index, std::size_t frames) const {
    for (const auto& t : singles) t.frame(batch, index, frames);
    for (const auto& t : doubles) t.frame(batch, index, frames);
  }
};

template <class Number>
void roll(Batch& batch, const Plays<Number>& plays, const Recorder& recorder, std::size_t steps,
          std::size_t every) {
  Interrupts interrupts;
  const std::size_t frames = steps / every;
  for (std::size_t step = 0; step < steps;) {
    // Without controls the steps to the next frame are one call.
    const std::size_t n = plays.controls.empty() ? std::min(every - step % every, steps - step) : 1;
    plays.play(batch, step);
    batch.step(static_cast<int>(n));
    step += n;
    if (step % every == 0) recorder.frame(batch, step / every - 1, frames);
    interrupts.check();
  }
}

void rollout(HeldBatch& self, int steps, int every, const std::optional<AnyIn>& controls,
             const std::vector<std::string>& names, const std::vector<AnyOut>& arrays) {
  if (steps < 0 || every < 1 || names.size() != arrays.size()) {
    throw nb::value_error("steps must be >= 0, every >= 1, and as many arrays as names");
  }
  const auto count = static_cast<std::size_t>(steps);
  const std::size_t frames = count / static_cast<std::size_t>(every);
  Recorder recorder;
  std::size_t of_step = 0;
  self.with([&](Batch& b) {
    of_step = static_cast<std::size_t>(b.worlds()) * static_cast<std::size_t>(b.controls());
    const auto all = quantities_of(b);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Quantity& q = find_quantity(all, names[i]);
      check_size(q.name, arrays[i].size(),
                 frames * static_cast<std::size_t>(b.worlds()) * static_cast<std::size_t>(q.items) *
                     static_cast<std::size_t>(q.components));
      with_reals(arrays[i], [&]<class T>(std::span<T> numbers) {
        if constexpr (std::is_same_v<T, float>) {
          recorder.singles.push_back({q, numbers});
        } else {
          recorder.doubles.push_back({q, numbers});
        }
      });
    }
  });
  const auto go = [&](auto plays) {
    self.run([&](Batch& b) { roll(b, plays, recorder, count, static_cast<std::size_t>(every)); });
  };
  if (!controls) return go(Plays<float>{});
  check_size("controls", controls->size(), of_step * count);
  with_reals(*controls, [&]<class T>(std::span<const T> numbers) {
    go(Plays<T>{numbers, of_step});
  });
}

}  // namespace

void bind_batch_rollout(nb::class_<HeldBatch>& c) {
  c.def("rollout", &rollout, nb::arg("steps"), nb::arg("every"), nb::arg("controls").none(),
        nb::arg("names"), nb::arg("arrays").noconvert(),
        "Takes steps and fills arrays (frames, worlds, items, components).");
}

}  // namespace manyworlds::python
