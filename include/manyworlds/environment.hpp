// Environment: a task in thousands of worlds. A step maps actions to controls, steps the worlds and
// works out observations, rewards and ends, group by group on the threads that step.
//
// Worlds depend on nothing but the task, their seed and their actions: not on how many there are.
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

// What happens to a world whose episode has ended (as Gymnasium's AutoresetMode).
enum class Autoreset {
  next_step,  // the next step begins its next episode instead of stepping it: reward 0, no end
  same_step,  // the step that ends it begins the next: `final_observations` has where it ended
  disabled,   // it steps on until it is reset
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
  // Calls that step or begin worlds throw NonFiniteError where a result is not finite, after they
  // have done all that they do.
  bool check = false;
};

// An observation, a reward or an end that was not a finite number. Its world is frozen then
// (Status::non_finite) and its episode is truncated, not terminated.
struct NonFinite {
  std::string expression = {};  // "observation 3 'lean'", as validate() names it
  int world = 0;
  std::int64_t step = 0;  // of the world's episode, from 1; 0: where it began
  // Infinite or not a number. An end that compares what is not a number counts as not a number.
  double value = 0;
};
std::string to_string(
    const NonFinite& fault);  // "reward 0 'pace' is nan in world 7 at step 12 of ..."

// The first one of a call, by world and then in the order of NonFinite::expression.
class NonFiniteError : public std::runtime_error {
 public:
  explicit NonFiniteError(NonFinite what)
      : std::runtime_error(to_string(what)), fault_(std::move(what)) {}
  const NonFinite& fault() const { return fault_; }

 private:
  NonFinite fault_;
};

// The caller's arrays that a step writes to, [world] or [world][number]. Those that are empty are
// not wanted; others must have just the size.
struct StepArrays {
  std::span<float> observations = {};  // [world][observation]
  std::span<float> final_observations =
      {};  // same_step: of worlds that ended, the others' stay; requires observations
  std::span<double> rewards = {};
  std::span<double> reward_terms = {};                      // [world][reward]
  std::span<std::uint8_t> terminated = {}, truncated = {};  // 1 or 0
  // The same in double: as the worlds of Precision::f64 have them. Either may be wanted, or both.
  std::span<double> observations_f64 = {}, final_observations_f64 = {};
  std::span<double> infos = {};        // [world][info]
  std::span<double> final_infos = {};  // as final_observations; requires infos
  // Was it lost at the end of the step (Status)? Also of worlds that then begin anew (same_step).
  std::span<std::uint8_t> lost = {};
};

// Those of a beginning; of worlds that do not begin they stay.
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

// Worlds of an Environment, to go on from later, elsewhere or many times: what they are, and what
// the task remembers of them. Restored as a whole, later episodes are drawn as they would have
// been; single worlds draw from the seed of the place that they are restored into. A world that was
// to begin with its next step (Autoreset::next_step) steps on beyond its end in an Environment of
// another mode.
struct EnvironmentSnapshot {
  Snapshot worlds = {};
  std::uint64_t task = 0;           // of which task: equal for tasks that compute the same
  std::vector<double> memory = {};  // [world][number]
};

class Environment {
 public:
  // Throws SceneError with every issue of the task, std::invalid_argument for options that make no
  // sense. All worlds are at the beginning of their first episode.
  explicit Environment(const Task& task, const EnvironmentOptions& options = {});
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  const Task& task() const;
  Autoreset autoreset() const;
  int worlds() const;
  int observations() const;  // numbers of one world
  int actions() const;       // numbers of one world; 1 of a discrete task
  int infos() const;         // numbers of one world

  // One step of the task in every world. `actions`: [world][action]; of a discrete task one per
  // world. An action that is not a number, or is infinite and not clamped (Action), freezes its
  // world, which then is lost; a choice that there is not throws std::invalid_argument before
  // anything is done. Allocates nothing, except where a world begins whose masses or sizes vary.
  void step(std::span<const float> actions, const StepArrays& out);
  void step(std::span<const std::int64_t> actions, const StepArrays& out);
  // As these, asking between physics steps, some 15 times a second, whether to go on. False: it was
  // ended early. All worlds have then taken as many physics steps, batch().steps() counts them,
  // forces that were added have acted in them and are gone, and nothing was written to `out`.
  // Until the step is finished, or all worlds are reset, begun or restored, other calls that step,
  // begin, copy or save worlds throw std::invalid_argument. The early end allocates.
  bool step(std::span<const float> actions, const StepArrays& out, const GoOn& go_on);
  bool step(std::span<const std::int64_t> actions, const StepArrays& out, const GoOn& go_on);
  // Takes a step that was ended early to its end, with its actions: the bits are those of one that
  // was not. Throws std::invalid_argument when there is none.
  void finish_step(const StepArrays& out);
  bool finish_step(const StepArrays& out, const GoOn& go_on);
  int steps_left() const;  // physics steps of a step that was ended early; 0: there is none

  // Next episodes of the worlds of a mask, [world]; with seeds, [world], their first ones, where
  // levels begin again, too. What is told of the others stays. With batch().seed_of() of each world
  // it repeats their first episode.
  void reset(std::span<const std::uint8_t> mask, const BeginArrays& out);
  void reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds,
             const BeginArrays& out);

  // The first fault of each expression since the environment was made, in the order in which they
  // were found.
  std::vector<NonFinite> non_finite() const;
  int non_finite_expressions() const;  // how many those are

  // The value of an expression in every world, [world], as an Info of the task would have had it
  // after the last step or beginning, but of the state that worlds have now. Changes nothing.
  // Throws std::invalid_argument for what is no expression of the task's scene, for what the task
  // does not observe or remember (the task can have an Info for it), and in the middle of a step.
  void evaluate(const Expression& expression, std::span<double> out) const;

  // Levels (Task::levels) of all worlds, [world][level]. Written values, of the worlds of a mask,
  // must be finite. They apply from the next step until the end of an episode changes them; those
  // that are written as they are change nothing.
  int levels() const;  // numbers of one world
  void read_levels(std::span<double> out) const;
  void write_levels(std::span<const std::uint8_t> mask, std::span<const double> in);

  // What steps, to look at, to record and to draw. Whoever changes worlds in it (write, restore)
  // says so by begin(), for what the task remembers of them.
  Batch& batch();
  const Batch& batch() const;
  // The worlds of a mask begin an episode in the state, and with the numbers, that they have.
  void begin(std::span<const std::uint8_t> mask, const BeginArrays& out);
  // World `to` becomes what world `from` is, with what the task remembers of it.
  void copy_world(int from, int to);

  EnvironmentSnapshot save() const;  // all worlds
  // As Batch::restore: all worlds of as many, or world `from` of it into world `to`. Throw
  // SnapshotError for one of another task, and change nothing then.
  void restore(const EnvironmentSnapshot& snapshot);
  void restore(const EnvironmentSnapshot& snapshot, int from, int to);

 private:
  struct Impl;
  Pimpl<Impl> impl_;
};

}  // namespace manyworlds
