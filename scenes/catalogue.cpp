// The list of named scenes and the search for a name.
#include <cstddef>
#include <utility>

#include "manyworlds/nearest.hpp"
#include "manyworlds/scenes.hpp"
#include "scenes/cradle.hpp"
#include "scenes/makers.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds::scenes {
namespace {

Scene default_cradle() { return newton_cradle(1, 1e-3); }

}  // namespace

const std::vector<Entry>& all() {
  static const std::vector<Entry> entries = {
      {"bin2d", "2D: 20 circles and 20 boxes dropped into a bin 10 m wide", true,
       in_float_mode<bin2d>},
      {"pyramid2d", "2D: pyramid of 15 boxes", true, in_float_mode<pyramid2d>},
      {"chain2d", "2D: chain of 10 hinged links", true, in_float_mode<chain2d>},
      {"ball2d", "2D: one bouncing ball", true, in_float_mode<ball2d>},
      {"bin-spheres", "3D: 20 spheres dropped into a 4 x 4 m bin", true,
       in_float_mode<bin_spheres>},
      {"bin-boxes", "3D: 20 boxes dropped into a 4 x 4 m bin", true, in_float_mode<bin_boxes>},
      {"stack10", "3D: stack of 10 unit boxes", true, in_float_mode<stack10>},
      {"car2d", "2D: a car with sprung wheels on a rough road", true, in_float_mode<car2d>},
      {"lunar-lander", "2D: a lander with thrusters and legs over a pad", true,
       in_float_mode<lunar_lander>},
      {"chain3d", "3D: chain of 10 links on ball joints", true, in_float_mode<chain3d>},
      {"ball3d", "3D: one bouncing ball", true, in_float_mode<ball3d>},
      {"ragdoll", "3D: a ragdoll of 11 bodies down a stair", true, in_float_mode<ragdoll>},
      {"free-flight", "3D: 20 tumbling boxes without gravity or contacts", false,
       in_float_mode<free_flight>},
      {"billiards", "2D: break of 15 balls on a table seen from above", false,
       in_float_mode<billiards>},
      {"domino", "3D: a row of 15 dominoes falling", false, in_float_mode<domino>},
      {"newton-cradle", "2D: 5 elastic balls in a row, one comes in", false,
       in_float_mode<default_cradle>},
      {"mixed-pile", "3D: boxes, spheres and compounds of many sizes in a bin", false,
       in_float_mode<mixed_pile>},
      {"mixed-pile2d", "2D: circles and polygons of many sizes in a bin", false,
       in_float_mode<mixed_pile2d>},
      {"hills", "3D: cylinders, hulls and all other shapes on a height field", false,
       in_float_mode<hills>},
      {"pebbles", "2D: polygons with round corners and others on a terrain", false,
       in_float_mode<pebbles>},
      {"bridge", "2D: boxes on a bridge of 16 hinged planks", false, in_float_mode<bridge>},
      {"ball-and-chain", "2D: a heavy ball on a chain of 20 links", false,
       in_float_mode<ball_and_chain>},
      {"joint-grid", "2D: a net of 10 x 10 hinged discs", false, in_float_mode<joint_grid>},
      {"pulley", "2D: two weights on a rope over a pulley", false, in_float_mode<pulley>},
      {"elevator", "2D: a driven platform lifts three boxes", false, in_float_mode<elevator>},
      {"windmill", "2D: a motor's cross stirs 16 balls", false, in_float_mode<windmill>},
      {"four-bar", "2D: a driven crank, a coupler and a rocker", false, in_float_mode<four_bar>},
      {"bird-sling", "2D: a heavy ball is slung over a wall at a pile of 14 boxes", false,
       in_float_mode<bird_sling>},
      {"cradle-joints", "2D: 5 elastic balls on rods, one swings in", false,
       in_float_mode<cradle_joints>},
      {"crane", "2D: a driven trolley, and a load on a rope with a winch", false,
       in_float_mode<crane>},
      {"jenga", "3D: a tower of 30 blocks, one drawn and laid on top", false, in_float_mode<jenga>},
      {"car3d", "3D: a car with sprung, driven and steered wheels on rough ground", false,
       in_float_mode<car3d>},
      {"chain-reaction", "2D: ball, dominoes, see-saw gate, marble, bucket, flag", false,
       in_float_mode<chain_reaction>},
      {"pendulum", "3D robot: a motor swings a pole between two posts", false,
       in_float_mode<pendulum>},
      {"hopper", "3D robot: one leg in a plane, 3 motors", false, in_float_mode<hopper>},
      {"cheetah", "3D robot: a runner in a plane, 6 motors", false, in_float_mode<cheetah>},
      {"ant", "3D robot: four legs on a free trunk and a tail, 8 motors", false,
       in_float_mode<ant>},
      {"humanoid", "3D robot: a free humanoid of 21 hinges, motors and servos", false,
       in_float_mode<humanoid>},
  };
  return entries;
}

const Entry* find(std::string_view name) {
  for (const Entry& entry : all()) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

std::string nearest(std::string_view name) {
  std::string best;
  std::size_t best_distance = static_cast<std::size_t>(-1);
  for (const Entry& entry : all()) {
    const std::size_t distance = edit_distance(name, entry.name);
    if (distance < best_distance) {
      best_distance = distance;
      best = entry.name;
    }
  }
  return best;
}

}  // namespace manyworlds::scenes
