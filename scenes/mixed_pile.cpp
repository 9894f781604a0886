// Boxes and spheres of many sizes and two compound bodies, dropped into a bin of 4 m by 4 m.
#include <string>
#include <utility>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr double kBinHalfWidth = 2;

// Two balls on a bar.
Body dumbbell() {
  Body body;
  body.name = "dumbbell";
  body.shapes.push_back(shape_of(Box{{0.25, 0.08, 0.08}}));
  for (const double side : {-1.0, 1.0}) {
    body.shapes.push_back(shape_of(Sphere{0.2}));
    body.shapes.back().position.x() = 0.35 * side;
  }
  return body;
}

// An L of two bars; its centre of mass is not at the body frame.
Body angle_bar() {
  Body body;
  body.name = "angle bar";
  body.shapes.push_back(shape_of(Box{{0.4, 0.12, 0.12}}));
  body.shapes.push_back(shape_of(Box{{0.12, 0.12, 0.15}}));
  body.shapes.back().position = {-0.28, 0, 0.27};
  return body;
}

// Half extents and radii in steps that give every body a size of its own. None reaches farther
// than 0.6 m from its centre, so that bodies start apart however they are turned.
Body box(int i) {
  Body body;
  body.name = "box" + std::to_string(i);
  body.shapes.push_back(
      shape_of(Box{{0.25 + 0.015 * i, 0.2 + 0.02 * (i % 5), 0.15 + 0.03 * (i % 4)}}));
  return body;
}

Body sphere(int i) {
  Body body;
  body.name = "sphere" + std::to_string(i);
  body.shapes.push_back(shape_of(Sphere{0.25 + 0.02 * i}));
  return body;
}

}  // namespace

Scene mixed_pile() {
  Scene scene = spatial_scene("mixed-pile");
  scene.options.bounds = bounds_of(Space::spatial, kBinHalfWidth);
  scene.add(bin(Space::spatial, kBinHalfWidth));
  for (int i = 0; i < 26; ++i) {
    Body body = i == 24      ? dumbbell()
                : i == 25    ? angle_bar()
                : i % 2 == 0 ? box(i / 2)
                             : sphere(i / 2);
    const int k = i % 9;
    const int layer = i / 9;
    body.position = {(k % 3 - 1) * 1.3, (k / 3 - 1) * 1.3, 1 + 1.4 * layer};
    body.jitter.position = {0.05, 0.05, 0.05};
    body.jitter.any_orientation = true;
    scene.add(std::move(body));
  }
  return scene;
}

}  // namespace manyworlds::scenes
