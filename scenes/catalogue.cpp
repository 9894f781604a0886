// The list of named scenes and the search for a name.
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "manyworlds/scenes.hpp"
#include "scenes/cradle.hpp"
#include "scenes/makers.hpp"

namespace manyworlds::scenes {
namespace {

// Levenshtein distance: insertions, deletions and substitutions. `row` holds the distances of the
// prefixes of b from the current prefix of a.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substitution, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

Scene default_cradle() { return newton_cradle(1, 1e-3); }

}  // namespace

const std::vector<Entry>& all() {
  static const std::vector<Entry> entries = {
      {"bin2d", "2D: 20 circles and 20 boxes dropped into a bin 10 m wide", true, bin2d},
      {"pyramid2d", "2D: pyramid of 15 boxes", true, pyramid2d},
      {"chain2d", "2D: chain of 10 hinged links", true, chain2d},
      {"ball2d", "2D: one bouncing ball", true, ball2d},
      {"bin-spheres", "3D: 20 spheres dropped into a 4 x 4 m bin", true, bin_spheres},
      {"bin-boxes", "3D: 20 boxes dropped into a 4 x 4 m bin", true, bin_boxes},
      {"stack10", "3D: stack of 10 unit boxes", true, stack10},
      {"car2d", "2D: a car with sprung wheels on a rough road", true, car2d},
      {"lunar-lander", "2D: a lander with thrusters and legs over a pad", true, lunar_lander},
      {"chain3d", "3D: chain of 10 links on ball joints", true, chain3d},
      {"ball3d", "3D: one bouncing ball", true, ball3d},
      {"ragdoll", "3D: a ragdoll of 11 bodies down a stair", true, ragdoll},
      {"free-flight", "3D: 20 tumbling boxes without gravity or contacts", false, free_flight},
      {"billiards", "2D: break of 15 balls on a table seen from above", false, billiards},
      {"domino", "3D: a row of 15 dominoes falling", false, domino},
      {"newton-cradle", "2D: 5 elastic balls in a row, one comes in", false, default_cradle},
      {"mixed-pile", "3D: boxes, spheres and compounds of many sizes in a bin", false, mixed_pile},
      {"mixed-pile2d", "2D: circles and polygons of many sizes in a bin", false, mixed_pile2d},
      {"hills", "3D: cylinders, hulls and all other shapes on a height field", false, hills},
      {"pebbles", "2D: polygons with round corners and others on a terrain", false, pebbles},
      {"bridge", "2D: boxes on a bridge of 16 hinged planks", false, bridge},
      {"ball-and-chain", "2D: a heavy ball on a chain of 20 links", false, ball_and_chain},
      {"joint-grid", "2D: a net of 10 x 10 hinged discs", false, joint_grid},
      {"pulley", "2D: two weights on a rope over a pulley", false, pulley},
      {"elevator", "2D: a driven platform lifts three boxes", false, elevator},
      {"windmill", "2D: a motor's cross stirs 16 balls", false, windmill},
      {"four-bar", "2D: a driven crank, a coupler and a rocker", false, four_bar},
      {"bird-sling", "2D: a heavy ball is slung over a wall at a pile of 14 boxes", false,
       bird_sling},
      {"cradle-joints", "2D: 5 elastic balls on rods, one swings in", false, cradle_joints},
      {"crane", "2D: a driven trolley, and a load on a rope with a winch", false, crane},
      {"jenga", "3D: a tower of 30 blocks, one drawn and laid on top", false, jenga},
      {"car3d", "3D: a car with sprung, driven and steered wheels on rough ground", false, car3d},
      {"chain-reaction", "2D: ball, dominoes, see-saw gate, marble, bucket, flag", false,
       chain_reaction},
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
