// Bodies that stand or slide on faces: the floors under them, the points at which flat faces touch,
// and whether contact forces within the friction cones balance the loads.
#pragma once

#include <vector>

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

// ---- floors -------------------------------------------------------------------------------------

// A flat surface through the world's origin. Its frame has the normal along z (planar: y).
struct Floor {
  BodyId body = {};
  Quat rotation = Quat::Identity();  // from the surface's frame to the world
  Vec3 velocity = Vec3::Zero();      // m/s, world, of a conveyor
  const char* name = "";
};
struct FloorDraw {
  double extent = 10;  // m, how far bodies may be from the origin
  double tilt = 0;     // rad, between the normal and gravity
  Material material = {};
  double belt = 0;  // m/s, the speed of a conveyor; 0: none is drawn
};
// Adds a plane, a box, a height field, a terrain, a segment or a conveyor, and sets gravity.
Floor add_floor(Scene& scene, Random& kind, const Scale& scale, const FloorDraw& draw);

// ---- bodies that stand on a face ----------------------------------------------------------------

struct Standing {
  Body body;  // shapes, and mass properties if they are not those of the shapes
  Quat rotation = Quat::Identity();  // of the body frame in a frame with z (planar: y) up
  double height = 0;                 // m, of the body frame's origin above the floor
  Vec3 center = Vec3::Zero();        // m, centre of mass from the origin, in the upright frame
  std::vector<Vec3> base = {};       // m, points on the floor, from the origin, upright frame
  double support =
      0;  // m, least distance of the centre of mass from an edge of the base, seen from above
  double size = 0;  // m, cube root of the volume (planar: square root of the area)
  const char* name = "";
};
// A box, an upright cylinder, a hull or prism on one of its faces, a deck on three feet or two
// runners; planar: a polygon, a capsule, a deck on two feet.
Standing draw_standing(Random& kind, Space space, double size, const Material& material);
Standing draw_prism(Random& kind, double size, int sides, const Material& material);
// The body on the floor, at `at` and turned by `yaw` (spatial) in the surface's frame.
Body stand(Space space, const Standing& standing, const Floor& floor, const Vec3& at, double yaw);

// ---- balance of forces --------------------------------------------------------------------------

// A point at which two bodies touch.
struct Touch {
  int a = -1, b = -1;  // bodies of the scene; loads of those that do not move are ignored
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();  // from a to b, world
  double friction = 0;
};
struct Solid {
  int body = -1;
  double friction = 0;
  std::vector<Vec3> vertices;           // world
  std::vector<std::vector<int>> faces;  // counter-clockwise from outside; planar: edges
};
// A box, hull, cylinder (as a prism), polygon, or the ground as a large block.
Solid solid_of(const Scene& scene, int body, double extent);
// All points of contact: corners of the faces' common areas, moved towards their middle by the
// share `shrink`, by half where there are more than four.
std::vector<Touch> touches_of(Space space, const std::vector<Solid>& solids, double tolerance,
                              double shrink);

struct Margin {
  double friction = 0.8;     // of its value
  double weight = 1.2;       // of every other body, then of the rest
  double tilt = 0.04;        // rad, of gravity, in all directions
  bool all_weights = false;  // of all bodies at once: where preloads do not grow with them
};
// A force at the centre of mass, besides the weight, on body i of the scene: a preload.
struct Preload {
  int body = 0;
  Vec3 force = Vec3::Zero();
};
// Whether forces in the friction cones balance the weights of all dynamic bodies. Bodies on sliders
// keep their rotation and move along x only.
bool stands(const Scene& scene, const std::vector<Touch>& touches, const Margin& margin = {},
            const std::vector<Preload>& preloads = {});

}  // namespace manyworlds::invariants
