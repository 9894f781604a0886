// A bird, a heavy ball, is slung over a wall at a pile of boxes. For design search: angle and speed
// are the bird's linear velocity, which a caller writes per world before the first step.
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr double kSide = 0.8;  // m, of a box
constexpr int kRows = 4;
constexpr double kHalfWidth = 60;  // m, to the walls at which a bird stops

}  // namespace

Scene bird_sling() {
  Scene scene = planar_scene("bird-sling");
  scene.options.bounds = bounds_of(Space::planar, kHalfWidth);
  Body ground = bin(Space::planar, kHalfWidth);
  Shape wall = shape_of(Polygon::box(0.3, 1.2));
  wall.position = {-4, 1.2, 0};
  ground.shapes.push_back(wall);
  scene.add(ground);

  Body bird = named_body("bird", {-15, 1.5, 0}, Circle{0.4});
  bird.linear_velocity = {13, 6.5, 0};  // m/s: over the wall into the pile
  bird.jitter.linear_velocity = {0.5, 0.5, 0};
  bird.shapes.back().density = 8;
  scene.add(bird);

  // Rows of 5, 4, 3 and 2, each box on two.
  for (int row = 0; row < kRows; ++row) {
    const int boxes = kRows + 1 - row;
    for (int k = 0; k < boxes; ++k) {
      const double x = 2 + (k - (boxes - 1) / 2.0) * 1.1 * kSide;
      const BodyId box = add_body(scene, "box" + std::to_string(row) + "." + std::to_string(k),
                                  {x, (row + 0.5) * kSide, 0}, Polygon::box(kSide / 2, kSide / 2));
      scene.at(box).jitter.position = {0.01, 0, 0};
    }
  }
  return scene;
}

}  // namespace manyworlds::scenes
