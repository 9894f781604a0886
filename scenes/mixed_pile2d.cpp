// Circles, boxes, triangles and hexagons of many sizes, dropped into a planar bin 10 m wide.
#include <cmath>
#include <string>
#include <utility>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

// Regular polygons with their vertices on a circle; coordinates by square root only, which gives
// the same bits with every mathematical library.
Polygon triangle(double radius) {
  const double h = radius * std::sqrt(0.75);
  return {{{radius, 0}, {-radius / 2, h}, {-radius / 2, -h}}};
}

Polygon hexagon(double radius) {
  const double h = radius * std::sqrt(0.75);
  return {{{radius, 0},
           {radius / 2, h},
           {-radius / 2, h},
           {-radius, 0},
           {-radius / 2, -h},
           {radius / 2, -h}}};
}

}  // namespace

Scene mixed_pile2d() {
  constexpr double kHalfWidth = 5;
  Scene scene = planar_scene("mixed-pile2d");
  scene.options.bounds = bounds_of(Space::planar, kHalfWidth);
  scene.add(bin(Space::planar, kHalfWidth));
  for (int i = 0; i < 40; ++i) {
    const int column = i % 8;
    const int row = i / 8;
    Body body;
    body.position = {(column - 3.5) * 1.2, 1 + 1.45 * row, 0};
    body.jitter.position = {0.05, 0.05, 0};
    body.jitter.angle = 1.5;
    // No shape reaches farther than 0.525 m, so that bodies start apart.
    const double size = 0.35 + 0.035 * (i % 6);  // m, 0.35 to 0.525
    switch ((column + row) % 4) {
      case 0:
        body.name = "circle";
        body.shapes.push_back(shape_of(Circle{size}));
        break;
      case 1:
        body.name = "box";
        body.shapes.push_back(shape_of(Polygon::box(0.8 * size, 0.5 * size)));
        break;
      case 2:
        body.name = "triangle";
        body.shapes.push_back(shape_of(triangle(size)));
        break;
      default:
        body.name = "hexagon";
        body.shapes.push_back(shape_of(hexagon(size)));
        break;
    }
    body.name += std::to_string(i);
    scene.add(std::move(body));
  }
  return scene;
}

}  // namespace manyworlds::scenes
