// A tower of three blocks per layer, each layer across the one below it. A middle block of a lower
// layer has been drawn and laid on top.
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {

Scene jenga() {
  constexpr int kLayers = 10, kDrawnLayer = 3;
  // Ten times the size of the game's blocks, m; next to each other with a little air.
  const Vec3 half_extents{0.375, 0.125, 0.075};
  constexpr double kPitch = 0.26;
  Scene scene = spatial_scene("jenga");
  scene.options.density = 600;
  scene.options.substeps = 12;  // with 4, so high a tower of soft contacts quivers
  scene.options.bounds = bounds_of(Space::spatial, 10);
  scene.add(ground(Space::spatial));
  const double half = std::sqrt(0.5);
  for (int i = 0; i < 3 * kLayers; ++i) {
    const bool drawn = i == 3 * kDrawnLayer + 1;
    const int layer = drawn ? kLayers : i / 3;
    const double aside = (i % 3 - 1) * kPitch, height = (2 * layer + 1) * half_extents.z();
    const bool along_y = layer % 2 == 1;
    Body block;
    block.name = "block" + std::to_string(i);
    block.position = along_y ? Vec3(aside, 0, height) : Vec3(0, aside, height);
    if (along_y) block.rotation = Quat(half, 0, 0, half);
    block.shapes.push_back(shape_of(Box{half_extents}));
    block.shapes.back().material.friction = 0.5;
    block.jitter.position = {1e-3, 1e-3, 0};
    block.jitter.angle = 0.005;
    scene.add(block);
  }
  return scene;
}

}  // namespace manyworlds::scenes
