// The list of named tasks.
#include "manyworlds/tasks.hpp"
#include "scenes/tasks/makers.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds::tasks {

const std::vector<Entry>& all() {
  static const std::vector<Entry> entries = {
      {"CartPole", "2D: pushes to either side balance a pole on a cart", in_float_mode<cart_pole>},
      {"CartPoleSwingUp", "2D: a force swings a pole up from its cart",
       in_float_mode<cart_pole_swing_up>},
      {"Pendulum", "2D: a weak motor swings a rod up", in_float_mode<pendulum>},
      {"Acrobot", "2D: two links swing up by a motor in their elbow", in_float_mode<acrobot>},
      {"LunarLander", "2D: land on two legs; engines on or off", in_float_mode<lunar_lander>},
      {"LunarLanderContinuous", "2D: the same by thrust", in_float_mode<lunar_lander_continuous>},
      {"Hopper", "2D: a leg on three motors runs without falling", in_float_mode<hopper>},
      {"Pusher", "2D: a disc pushes a puck onto a mark", in_float_mode<pusher>},
      {"BirdSling", "2D: one shot at a pile of boxes; for design search",
       in_float_mode<bird_sling>},
      {"BallBalance", "3D: a ball is kept in the middle of a tilting plate",
       in_float_mode<ball_balance>},
      {"Stacking", "2D: a flown box is set down on a tower of two", in_float_mode<stacking>},
  };
  return entries;
}

const Entry* find(std::string_view name) {
  for (const Entry& entry : all()) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

}  // namespace manyworlds::tasks
