// Open-loop rollouts: controls in, trajectories out, all steps in one call without the GIL.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "interrupts.hpp"
#include "read_quantity.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

namespace {

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

// Returns the steps taken.
template <class Number>
std::size_t roll(Batch& batch, const Plays<Number>& plays, const Recorder& recorder,
                 std::size_t steps, std::size_t every, const GoOn& go_on) {
  const std::size_t frames = steps / every;
  std::size_t step = 0;
  while (step < steps && go_on()) {
    // Without controls the steps to the next frame are one call.
    const std::size_t n = plays.controls.empty() ? std::min(every - step % every, steps - step) : 1;
    plays.play(batch, step);
    const auto taken = static_cast<std::size_t>(batch.step(static_cast<int>(n), go_on));
    step += taken;
    if (taken < n) break;
    if (step % every == 0) recorder.frame(batch, step / every - 1, frames);
  }
  return step;
}

void rollout(HeldBatch& self, int steps, int every, const std::optional<AnyIn>& controls,
             const std::vector<std::string>& names, const std::vector<AnyOut>& arrays) {
  if (steps < 0 || every < 1 || names.size() != arrays.size()) {
    throw nb::value_error("steps must be >= 0, every >= 1, and as many arrays as names");
  }
  if (self.kinds() > 1) throw nb::value_error("rollouts need a batch with one kind of world");
  const auto count = static_cast<std::size_t>(steps);
  const std::size_t frames = count / static_cast<std::size_t>(every);
  Recorder recorder;
  std::size_t of_step = 0;
  self.with([&](Batch& b) {
    of_step = static_cast<std::size_t>(b.worlds()) * static_cast<std::size_t>(b.controls());
    const auto all = quantities_of(b, self.range(0));
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
    self.run([&](Batch& b) {
      Interrupts::during([&](const GoOn& go_on) {
        return roll(b, plays, recorder, count, static_cast<std::size_t>(every), go_on);
      });
    });
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
