// Bodies of every shape on rough ground: in space on a height field, in the plane on a terrain.
#include <array>
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

// Products and sums only: the same bits with every mathematical library.
double wave(double x) {  // period 4, from -1 to 1
  const double u = x / 4 - std::floor(x / 4), v = u < 0.5 ? u : u - 0.5;
  const double arch = 16 * v * (0.5 - v);
  return u < 0.5 ? arch : -arch;
}

Hull wedge(double size) {
  return Hull{{{-size, -size, -0.5 * size},
               {size, -size, -0.5 * size},
               {size, size, -0.5 * size},
               {-size, size, -0.5 * size},
               {-size, 0, 0.9 * size},
               {size, 0, 0.9 * size}}};
}
Hull octahedron(double size) {
  return Hull{
      {{size, 0, 0}, {-size, 0, 0}, {0, size, 0}, {0, -size, 0}, {0, 0, size}, {0, 0, -size}}};
}

Geometry shape_number(int i) {
  const double size = 0.3 + 0.03 * (i % 5);  // m
  switch (i % 6) {
    case 0: return Sphere{size};
    case 1: return Box{{size, 0.7 * size, 0.5 * size}};
    case 2: return Cylinder{0.7 * size, 0.8 * size};
    case 3: return Capsule{0.5 * size, 0.7 * size};
    case 4: return wedge(0.8 * size);
    default: return octahedron(1.2 * size);
  }
}

}  // namespace

HeightField rough_field(int columns, int rows, double cell, double height) {
  HeightField field;
  field.columns = columns, field.cell = {cell, cell};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double x = (i - 0.5 * (columns - 1)) * cell, y = (j - 0.5 * (rows - 1)) * cell;
      field.heights.push_back(height * wave(x + 0.5 * wave(y)) * wave(0.8 * y + 1));
    }
  }
  return field;
}

// 24 spheres, boxes, cylinders, capsules and hulls fall on hills in a hollow.
Scene hills() {
  Scene scene = spatial_scene("hills");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-9, -9, -3), Vec3(9, 9, 100));
  HeightField field = rough_field(33, 33, 0.6, 0.35);
  for (int j = 0; j < 33; ++j) {
    for (int i = 0; i < 33; ++i) {
      const double x = 0.6 * (i - 16), y = 0.6 * (j - 16);
      field.heights[static_cast<std::size_t>(i + 33 * j)] += 0.05 * (x * x + y * y);
    }
  }
  Body ground;
  ground.name = "hills";
  ground.motion = Motion::fixed;
  ground.shapes.push_back(shape_of(field));
  scene.add(ground);
  for (int i = 0; i < 24; ++i) {
    const Vec3 place(1.3 * (i % 4) - 1.95, 1.3 * (i / 4 % 3) - 1.3, 1.8 + 1.2 * (i / 12));
    const BodyId body = add_body(scene, "body" + std::to_string(i), place, shape_number(i));
    Jitter& jitter = scene.at(body).jitter;
    jitter.position = {0.1, 0.1, 0.05};
    jitter.any_orientation = true;
  }
  return scene;
}

// 24 pebbles, which are polygons with round corners, circles, capsules and boxes, on a terrain
// with a bench made of a segment over it.
Scene pebbles() {
  Scene scene = planar_scene("pebbles");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-8, -3, -1), Vec3(8, 100, 1));
  Body ground;
  ground.name = "ground";
  ground.motion = Motion::fixed;
  Terrain terrain;
  for (int i = -14; i <= 14; ++i) {
    const double x = 0.5 * i;
    terrain.points.emplace_back(x, 0.1 * x * x + 0.12 * wave(3 * x));
  }
  ground.shapes.push_back(shape_of(terrain));
  ground.shapes.push_back(shape_of(Segment{{-1, 2.2}, {1, 2}}));
  scene.add(ground);
  for (int i = 0; i < 24; ++i) {
    const Vec3 place(0.9 * (i % 6) - 2.25, 3 + 0.9 * (i / 6), 0);
    const double size = 0.2 + 0.02 * (i % 4);  // m
    const std::array<Geometry, 4> shapes = {
        Polygon{{{-size, -0.6 * size}, {size, -0.4 * size}, {0.1 * size, 0.8 * size}}, 0.4 * size},
        Circle{size}, Capsule{0.6 * size, 0.7 * size},
        Polygon{
            {{-size, -0.5 * size}, {size, -0.5 * size}, {size, 0.5 * size}, {-size, 0.5 * size}},
            0.2 * size}};
    const BodyId body = add_body(scene, "pebble" + std::to_string(i), place,
                                 shapes[static_cast<std::size_t>(i % 4)]);
    Jitter& jitter = scene.at(body).jitter;
    jitter.position = {0.1, 0.05, 0};
    jitter.angle = 1.5;
  }
  return scene;
}

}  // namespace manyworlds::scenes
