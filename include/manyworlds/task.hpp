// Task: actions, observations, rewards and ends of episodes in a scene. Plain data, as a Scene is.
// Environment (environment.hpp) runs it in many worlds.
//
// Episodes start at the scene's initial state, with its jitter (Body::jitter) and variations. A
// task may set some of the varied parameters itself (InitialParameter).
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "manyworlds/expression.hpp"
#include "manyworlds/observe.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds {

// One value of a continuous action. It is clamped to its range. With clamped = false, expressions
// such as costs use the value as given, and an infinite value makes the world lost. Controls of the
// scene are clamped to their own ranges in both cases.
struct Action {
  std::string name = {};
  double low = -1, high = 1;
  bool clamped = true;
};

struct Observation {
  std::string name = {};
  Expression value = {};
  // Range of the observation space; the value is not clamped.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

struct Reward {
  std::string name = {};
  Expression value = {};  // of a step; a task's reward is the sum of its rewards
};

// Diagnostics in double, which the policy does not observe. In Gymnasium, infos with the names
// a[0], a[1] and so on form the array a.
struct Info {
  std::string name = {};
  Expression value = {};
  bool of_steps_alone = false;  // not reported at the start of an episode
};

// A value per world that lasts over episodes, such as difficulty or number of successes. It is
// constant within an episode (terms::level).
struct Level {
  std::string name = {};
  // Value in the first episode of a seed. May use constants and random numbers of the episode. A
  // NaN counts as 0.
  Expression begin = 0;
  // Value in the next episode, computed at the end of the step that ends this one. None: unchanged.
  // A NaN leaves the level unchanged, and so does an episode that a reset ends.
  std::optional<Expression> next = std::nullopt;
};

// A value per world that lasts for an episode (terms::memory). It starts at `begin`, computed from
// the state at the start of the episode. At the end of each step of the task, all memories change
// to their `next` at once, before anything else is computed. In `next`, memories have their values
// before the step. Observations, rewards, ends, infos and levels of a step use memories after the
// change. Controls use memories as the last step left them.
struct Memory {
  std::string name = {};
  Expression begin = 0;                           // may use anything but memories
  std::optional<Expression> next = std::nullopt;  // none: unchanged
};

// Sets a parameter of the scene at a reset, instead of a draw.
struct InitialParameter {
  Expression parameter = 0;  // terms::parameter(...), varied with Draw::none
  // May use constants, random numbers of the episode, and levels. Clamped to the range of the
  // variation. A NaN gives the scene's own value.
  Expression value = 0;
};

struct Task {
  std::string name = {};
  Scene scene = {};
  int frame_skip = 1;  // steps of the scene per step of the task

  int choices = 0;  // discrete tasks: the action is one of 0 to choices - 1, and `actions` is empty
  std::vector<Action> actions = {};
  // Values of the scene's controls, set before the steps. May use actions, constants, random
  // numbers, parameters, levels, memories, age() and previous().
  std::vector<Expression> controls = {};

  std::vector<Observation> observations = {};
  std::vector<Reward> rewards = {};
  Expression terminated = 0;  // true: the task has ended
  Expression truncated = 0;   // true: the episode is cut off
  // Episodes are truncated after this many steps of the task; 0: never. Lost worlds are truncated,
  // too.
  int max_steps = 0;
  double solved_at = std::numeric_limits<double>::infinity();  // mean return; for information only

  std::vector<Info> infos = {};

  std::vector<Level> levels = {};
  std::vector<Memory> memories = {};
  std::vector<InitialParameter> initial_parameters = {};

  std::vector<Ray> rays = {};      // for terms::ray_distance
  std::vector<Point> points = {};  // for terms::point_position and point_velocity
};

// All issues of the task and its scene. If it is empty, an Environment can be made.
std::vector<Issue> validate(const Task& task);

}  // namespace manyworlds
