// Task: what a policy has to do in a scene: actions, observations, rewards, and when an episode
// ends. Plain values, as a Scene is; Environment (environment.hpp) runs it for thousands of worlds.
//
// Episodes begin where the scene does: with its jitter (Body::jitter) and variations, of which a
// task may set some itself (InitialParameter).
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "manyworlds/expression.hpp"
#include "manyworlds/observe.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds {

// One number of a continuous action. Beyond its range it counts as the end of the range. Where it
// is not clamped it counts as given, in costs too; an infinite one then loses the world. Controls
// of the scene are kept within their own ranges either way.
struct Action {
  std::string name = {};
  double low = -1, high = 1;
  bool clamped = true;
};

struct Observation {
  std::string name = {};
  Expression value = {};
  // What the policy is told of its range; the value is not clamped.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

struct Reward {
  std::string name = {};
  Expression value = {};  // of a step; a task's reward is the sum of its rewards
};

// What people are told beside: in double, of no account to the policy. Those that are named a[0],
// a[1] and so on are the array a to Gymnasium.
struct Info {
  std::string name = {};
  Expression value = {};
  bool of_steps_alone = false;  // not told where an episode begins
};

// A number that every world keeps over its episodes: how hard its task is, how often it succeeded.
// It is the same through a whole episode (terms::level).
struct Level {
  std::string name = {};
  // Its value in the first episode of a seed, of numbers and random ones of the episode; 0 where
  // that is not a number.
  Expression begin = 0;
  // Its value in the episode after this one, worked out at the end of the step that ends this one;
  // none: it stays. It also stays where that is not a number, and where a reset ends the episode.
  std::optional<Expression> next = std::nullopt;
};

// A number of every world that lasts for an episode (terms::memory). Where an episode begins it is
// `begin`, computed from the state there. At the end of each step of the task, before anything else
// is computed, all memories become their `next` at once: in `next`, memories are what they were
// before the step. So observations, rewards, ends, infos and levels of a step see memories after
// their update, and controls see them as the last step left them.
struct Memory {
  std::string name = {};
  Expression begin = 0;                           // of anything but memories
  std::optional<Expression> next = std::nullopt;  // none: it stays
};

// What a number of the scene is where an episode begins by a reset, instead of one that is drawn.
struct InitialParameter {
  Expression parameter = 0;  // terms::parameter(...), which varies, with Draw::none
  // Of numbers, random ones of the episode, and levels; kept within the range that the variation
  // declares. Where it is not a number, the scene's own number counts.
  Expression value = 0;
};

struct Task {
  std::string name = {};
  Scene scene = {};
  int frame_skip = 1;  // steps of the scene in a step of the task

  int choices = 0;  // discrete tasks: the action is one of 0 to choices - 1, and `actions` is empty
  std::vector<Action> actions = {};
  // What each control of the scene is set to before the steps: of actions, numbers, random ones,
  // parameters, levels, memories, age() and previous().
  std::vector<Expression> controls = {};

  std::vector<Observation> observations = {};
  std::vector<Reward> rewards = {};
  Expression terminated = 0;  // the episode has come to its end
  Expression truncated = 0;   // it is broken off
  // Broken off after so many steps of the task; 0: never. A world that is lost is broken off, too.
  int max_steps = 0;
  double solved_at = std::numeric_limits<double>::infinity();  // mean return; said to people only

  std::vector<Info> infos = {};

  std::vector<Level> levels = {};
  std::vector<Memory> memories = {};
  std::vector<InitialParameter> initial_parameters = {};

  std::vector<Ray> rays = {};      // for terms::ray_distance
  std::vector<Point> points = {};  // for terms::point_position and point_velocity
};

// Every issue of the task and its scene at once; empty means that an Environment can be made.
std::vector<Issue> validate(const Task& task);

}  // namespace manyworlds
