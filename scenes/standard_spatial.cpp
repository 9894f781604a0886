// The spatial standard scenes. Their numbers define the benchmark and must not change.
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

// 20 bodies on layers of 3 by 3 in a bin of 4 m by 4 m.
Scene bin_of_twenty(const std::string& name, const Geometry& geometry, bool any_orientation) {
  constexpr double kHalfWidth = 2;
  Scene scene = spatial_scene(name);
  scene.options.bounds = bounds_of(Space::spatial, kHalfWidth);
  scene.add(bin(Space::spatial, kHalfWidth));
  for (int i = 0; i < 20; ++i) {
    const int k = i % 9;
    const int layer = i / 9;
    Body body;
    body.name = "body" + std::to_string(i);
    body.position = {(k % 3 - 1) * 1.3, (k / 3 - 1) * 1.3, 1 + 1.4 * layer};
    body.shapes.push_back(shape_of(geometry));
    body.jitter.position = {0.05, 0.05, 0.05};
    body.jitter.any_orientation = any_orientation;
    scene.add(body);
  }
  return scene;
}

}  // namespace

Scene bin_spheres() { return bin_of_twenty("bin-spheres", Sphere{0.5}, false); }
Scene bin_boxes() { return bin_of_twenty("bin-boxes", Box{{0.4, 0.4, 0.4}}, true); }

Scene stack10() {
  Scene scene = spatial_scene("stack10");
  scene.options.bounds = bounds_of(Space::spatial, 20);
  scene.add(ground(Space::spatial));
  for (int i = 0; i < 10; ++i) {
    Body box;
    box.name = "box" + std::to_string(i);
    box.position = {0, 0, 0.5 + i};
    box.shapes.push_back(shape_of(Box{{0.5, 0.5, 0.5}}));
    box.jitter.position = {0.005, 0.005, 0};
    scene.add(box);
  }
  return scene;
}

Scene ball3d() {
  Scene scene = spatial_scene("ball3d");
  scene.options.bounds = bounds_of(Space::spatial, 20);
  scene.add(ground(Space::spatial));
  Body ball;
  ball.name = "ball";
  ball.position = {0, 0, 5};
  ball.shapes.push_back(shape_of(Sphere{0.5}));
  ball.shapes.back().material.restitution = 0.9;
  ball.jitter.position = {0, 0, 1};
  scene.add(ball);
  return scene;
}

}  // namespace manyworlds::scenes
