// The planar standard scenes. Their numbers define the benchmark and must not change.
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"
#include "scenes/sized.hpp"

namespace manyworlds::scenes {

// 40 bodies, circles and squares in turn, on a grid of 8 columns in a bin 10 m wide.
Scene bin2d() {
  constexpr double kHalfWidth = 5;
  Scene scene = planar_scene("bin2d");
  scene.options.bounds = bounds_of(Space::planar, kHalfWidth);
  scene.add(bin(Space::planar, kHalfWidth));
  for (int i = 0; i < 40; ++i) {
    const int column = i % 8;
    const int row = i / 8;
    const bool square = (column + row) % 2 == 1;
    Body body;
    body.name = (square ? "box" : "circle") + std::to_string(i);
    body.position = {(column - 3.5) * 1.2, 1 + 1.45 * row, 0};
    body.shapes.push_back(square ? shape_of(Polygon::box(0.4, 0.4)) : shape_of(Circle{0.5}));
    body.jitter.position = {0.05, 0.05, 0};
    body.jitter.angle = 1.5;
    scene.add(body);
  }
  return scene;
}

Scene pyramid2d() { return pyramid(5); }

Scene ball2d() {
  Scene scene = planar_scene("ball2d");
  scene.options.bounds = bounds_of(Space::planar, 20);
  scene.add(ground(Space::planar));
  Body ball = named_body("ball", {0, 5, 0}, Circle{0.5});
  ball.shapes.back().material.restitution = 0.9;
  ball.jitter.position = {0, 1, 0};
  scene.add(ball);
  return scene;
}

}  // namespace manyworlds::scenes
