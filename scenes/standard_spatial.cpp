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
    Body body = named_body("body" + std::to_string(i),
                           {(k % 3 - 1) * 1.3, (k / 3 - 1) * 1.3, 1 + 1.4 * layer}, geometry);
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
    Body box = named_body("box" + std::to_string(i), {0, 0, 0.5 + i}, Box{{0.5, 0.5, 0.5}});
    box.jitter.position = {0.005, 0.005, 0};
    scene.add(box);
  }
  return scene;
}

Scene ball3d() {
  Scene scene = spatial_scene("ball3d");
  scene.options.bounds = bounds_of(Space::spatial, 20);
  scene.add(ground(Space::spatial));
  Body ball = named_body("ball", {0, 0, 5}, Sphere{0.5});
  ball.shapes.back().material.restitution = 0.9;
  ball.jitter.position = {0, 0, 1};
  scene.add(ball);
  return scene;
}

}  // namespace manyworlds::scenes
