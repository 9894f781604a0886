// Environment: a task in many worlds. A step maps actions to controls, steps the worlds, and
// computes observations, rewards and ends of episodes. The stepping threads do this group by group.
//
// Results of a world depend only on the task, the world's seed and its actions, not on the number
// of worlds.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "manyworlds/batch.hpp"
#include "manyworlds/pimpl.hpp"
#include "manyworlds/task.hpp"

namespace manyworlds {

// What happens to a world whose episode has ended (Gymnasium's AutoresetMode).
enum class Autoreset {
  // The next step starts the next episode instead of stepping the world: reward 0, no end.
  next_step,
  // The step that ends an episode starts the next. `final_observations` has the end of the old one.
  same_step,
  disabled,  // the world steps on until it is reset
};
const char* to_string(Autoreset autoreset);

struct EnvironmentOptions {
  int worlds = 1;
  int threads = 0;         // as BatchOptions
  std::uint64_t seed = 0;  // world i draws from seed + i
  Precision precision = Precision::f32;
  std::optional<Isa> isa = std::nullopt;
  Autoreset autoreset = Autoreset::next_step;
  std::shared_ptr<Executor> executor = nullptr;
  // Calls that step worlds or start episodes throw NonFiniteError if a result is not finite. They
  // complete all their work first.
  bool check = false;
};

// An observation, reward or end that was not finite. Its world is frozen (Status::non_finite), and
// its episode is truncated, not terminated.
struct NonFinite {
  std::string expression = {};  // "observation 3 'lean'", as in validate()
  int world = 0;
  std::int64_t step = 0;  // step of the world's episode, from 1; 0: its start
  // Infinite or NaN. An end that compares a NaN counts as NaN.
  double value = 0;
};
// "reward 0 'pace' is nan in world 7 at step 12 of ..."
std::string to_string(const NonFinite& fault);

// Contains the first fault of a call: by world, then in the order of NonFinite::expression.
class NonFiniteError : public std::runtime_error {
 public:
  explicit NonFiniteError(NonFinite what)
      : std::runtime_error(to_string(what)), fault_(std::move(what)) {}
  const NonFinite& fault() const { return fault_; }

 private:
  NonFinite fault_;
};

// Output arrays of a step, [world] or [world][value]. Empty arrays are skipped; others must have
// the exact size.
struct StepArrays {
  std::span<float> observations = {};  // [world][observation]
  // same_step: last observations of worlds whose episode ended. Entries of other worlds are
  // unchanged. Requires `observations`.
  std::span<float> final_observations = {};
  std::span<double> rewards = {};
  std::span<double> reward_terms = {};                      // [world][reward]
  std::span<std::uint8_t> terminated = {}, truncated = {};  // 1 or 0
  // The same in double, without rounding for Precision::f64. A caller may pass either or both.
  std::span<double> observations_f64 = {}, final_observations_f64 = {};
  std::span<double> infos = {};        // [world][info]
  std::span<double> final_infos = {};  // as final_observations; requires infos
  // 1 if the world was lost at the end of the step (Status), also if a new episode then started
  // (same_step).
  std::span<std::uint8_t> lost = {};
};

// Output arrays of calls that start episodes. Entries of other worlds are unchanged.
struct BeginArrays {
  BeginArrays() = default;
  template <class Floats>
  requires std::convertible_to<Floats, std::span<float>> BeginArrays(
      Floats&& floats)  // NOLINT(google-explicit-constructor): observations alone
      : observations(floats) {}

  std::span<float> observations = {};
  std::span<double> observations_f64 = {};
  std::span<double> infos = {};
};

// Saved worlds of an Environment, with the memory of the task. A restore of all worlds also
// restores the random draws of later episodes. A world restored alone draws from the seed of the
// world that it replaces.
//
// With Autoreset::next_step, a snapshot may contain a world whose episode has ended. In an
// Environment of another mode that world steps on.
struct EnvironmentSnapshot {
  Snapshot worlds = {};
  std::uint64_t task = 0;           // identifies the task: equal for tasks that compute the same
  std::vector<double> memory = {};  // [world][value]
};

class Environment {
 public:
  // Starts the first episode of all worlds. Throws SceneError with every issue of the task, and
  // std::invalid_argument for invalid options.
  explicit Environment(const Task& task, const EnvironmentOptions& options = {});
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  const Task& task() const;
  Autoreset autoreset() const;
  int worlds() const;
  int observations() const;  // per world
  int actions() const;       // per world; 1 for a discrete task
  int infos() const;         // per world

  // One step of the task in every world. `actions` is [world][action], for a discrete task [world].
  // A NaN freezes its world, which is then lost; so does an infinite action that is not clamped
  // (Action). An invalid choice throws std::invalid_argument before any change. Allocates only if a
  // world whose masses or sizes vary starts an episode.
  void step(std::span<const float> actions, const StepArrays& out);
  void step(std::span<const std::int64_t> actions, const StepArrays& out);
  // The same, with `go_on` called between physics steps, about 15 times a second. If it returns
  // false, the step ends early and returns false. All worlds have then taken the same number of
  // physics steps, which batch().steps() counts. Added forces have acted in them and are cleared.
  // `out` is not written.
  //
  // Finish the step, or reset, begin or restore all worlds. Until then, other calls that step,
  // begin, copy, save or evaluate worlds throw std::invalid_argument. Ending early allocates.
  bool step(std::span<const float> actions, const StepArrays& out, const GoOn& go_on);
  bool step(std::span<const std::int64_t> actions, const StepArrays& out, const GoOn& go_on);
  // Completes a step that ended early, with its actions. The result has the same bits as an
  // uninterrupted step. Throws std::invalid_argument if no step ended early.
  void finish_step(const StepArrays& out);
  bool finish_step(const StepArrays& out, const GoOn& go_on);
  int steps_left() const;  // physics steps left in a step that ended early, else 0

  // Start the next episode in the worlds of a mask, [world]. With `seeds`, [world], start the first
  // episodes of these seeds and restart the levels. Results of other worlds are unchanged. Seeds
  // from batch().seed_of() repeat the first episodes.
  void reset(std::span<const std::uint8_t> mask, const BeginArrays& out);
  void reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds,
             const BeginArrays& out);

  // The first fault of each expression since construction, in the order of detection.
  std::vector<NonFinite> non_finite() const;
  int non_finite_expressions() const;  // size of non_finite()

  // Computes an expression in every world, [world], at the current state, as an Info does after a
  // step or at the start of an episode. Changes nothing. Throws std::invalid_argument if the
  // expression does not fit the task's scene, or in the middle of a step. It also throws if the
  // expression needs an observer or earlier values that the task does not store; add an Info to the
  // task then.
  void evaluate(const Expression& expression, std::span<double> out) const;

  // Levels (Task::levels) of all worlds, [world][level]. write_levels() sets those of the worlds of
  // a mask; values must be finite. A written level applies from the next step until the end of an
  // episode changes it. Writing the same value has no effect.
  int levels() const;  // per world
  void read_levels(std::span<double> out) const;
  void write_levels(std::span<const std::uint8_t> mask, std::span<const double> in);

  // The batch that the environment steps: inspect, record or draw it. After changing its worlds
  // (write, restore), call begin() to update the memory of the task.
  Batch& batch();
  const Batch& batch() const;
  // Starts an episode in the worlds of a mask, with their current state and parameters.
  void begin(std::span<const std::uint8_t> mask, const BeginArrays& out);
  // Copies world `from` to world `to`, with the memory of the task.
  void copy_world(int from, int to);

  EnvironmentSnapshot save() const;  // all worlds
  // As Batch::restore: all worlds from a snapshot of as many, or its world `from` to world `to`.
  // Throw SnapshotError for a snapshot of another task, and change nothing then.
  void restore(const EnvironmentSnapshot& snapshot);
  void restore(const EnvironmentSnapshot& snapshot, int from, int to);

 private:
  struct Impl;
  Pimpl<Impl> impl_;
};

}  // namespace manyworlds
