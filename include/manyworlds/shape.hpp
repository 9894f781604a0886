// Shapes: what bodies collide with and take their mass from. Part of Scene (scene.hpp).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "manyworlds/compliance.hpp"

namespace manyworlds {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
// Eigen's constructor order: (w, x, y, z). Unaligned, so that structs have the same layout whatever
// instruction set the user compiles for.
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

enum class Space { planar, spatial };

struct Sphere {         // spatial
  double radius = 0.5;  // m
};
struct Box {                         // spatial, centred on the shape frame
  Vec3 half_extents{0.5, 0.5, 0.5};  // m
};
struct Plane {  // spatial, fixed bodies only: all points p with normal . p <= offset are solid
  Vec3 normal{0, 0, 1};  // unit, body frame, pointing out of the solid
  double offset = 0;     // m
};
// All points no farther than the radius from a straight line of length 2 half_length, centred on
// the shape frame: along z in a spatial scene, along y in a planar one.
struct Capsule {
  double radius = 0.25;      // m
  double half_length = 0.5;  // m, without the round ends
};
// Spatial: all points within the radius of the z axis of the shape frame and no farther than
// half_length from its origin along it.
struct Cylinder {
  double radius = 0.5;       // m
  double half_length = 0.5;  // m
};
struct Ellipsoid {            // spatial, centred on the shape frame
  Vec3 radii{0.5, 0.4, 0.3};  // m, along its axes
};
// Spatial, a convex polyhedron: the smallest convex solid around its vertices, 4 to 64 of them.
// make_hull (hull.hpp) finds those of a cloud of points. Faces that lie in one plane are one.
struct Hull {
  std::vector<Vec3> vertices = {};  // m, shape frame, in any order
};
struct Circle {         // planar
  double radius = 0.5;  // m
};
struct Polygon {                    // planar, convex, 3 to 8 vertices
  std::vector<Vec2> vertices = {};  // m, shape frame, counter-clockwise
  double radius = 0;  // m, the solid is all points no farther than that from the polygon

  // Rectangle of half extents (half_x, half_y) centred on the shape frame.
  static Polygon box(double half_x, double half_y) {
    return {{{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}}, 0};
  }
};
struct HalfPlane {    // planar, fixed bodies only: all points p with normal . p <= offset are solid
  Vec2 normal{0, 1};  // unit, body frame
  double offset = 0;  // m
};
struct Segment {               // planar, fixed bodies only: a line that is solid from either side
  Vec2 a{-0.5, 0}, b{0.5, 0};  // m, shape frame
};
// Planar, fixed bodies only: a chain of segments, solid on the right when going along the points
// (so hills run from left to right), free on the left. Bodies slide over its vertices as
// over one smooth ground. At the ends of an open chain the solid falls off at a right angle.
struct Terrain {
  std::vector<Vec2> points = {};  // m, shape frame; 2 or more, of a loop 3 or more
  bool loop = false;              // the last point is joined to the first
};
// Spatial, fixed bodies only: everything below a surface of triangles over a grid of points, which
// is centred on the shape frame. Each cell has two, on either side of the diagonal from its corner
// of low x and y. Bodies slide and roll over its edges as over one smooth ground; at its border the
// solid falls off at a right angle. A body that got below the surface is moved up.
struct HeightField {
  std::vector<double> heights = {};  // m, of the points: x varies fastest
  int columns = 2;                   // points along x, 2 or more; as many rows as that leaves
  Vec2 cell{1, 1};                   // m, between points along x and y
  int rows() const { return columns > 0 ? static_cast<int>(heights.size()) / columns : 0; }
};
using Geometry = std::variant<Sphere, Box, Plane, Circle, Polygon, HalfPlane, Capsule, Segment,
                              Terrain, Cylinder, Hull, HeightField, Ellipsoid>;

// Contacts of Solver::newton, as MuJoCo mixes those of two geoms: of two materials the one of
// higher priority decides; where they are equal, friction and dimensions are the larger ones, and
// the compliance is the mean by weight, or the smaller of two direct ones. Margins add up.
struct SoftContact {
  int dimensions = 3;  // 1: no friction, 3: friction along the surface
  Compliance compliance = {};
  double margin = 0;  // m, separation below which a contact acts
  double gap = 0;     // m, by how much farther MuJoCo lists it; it moves nothing
  int priority = 0;
  double weight = 1;  // of the compliance
  bool operator==(const SoftContact&) const = default;
};

struct Material {
  double friction = 0.6;     // Coulomb coefficient; a pair uses the geometric mean of its two
  double restitution = 0.0;  // 0 to 1; a pair uses the larger of its two
  SoftContact soft = {};  // of Solver::newton, which uses the larger friction and bounces nothing
};

// Two shapes collide when each one's category is in the other's mask and they are on different
// bodies of which at least one is dynamic.
struct Filter {
  std::uint32_t category = 1;
  std::uint32_t mask = 0xffffffffu;
};

struct Shape {
  Geometry geometry = Sphere{};
  Vec3 position = Vec3::Zero();        // m, of the shape frame in the body frame
  Quat rotation = Quat::Identity();    // of the shape frame in the body frame; need not be unit
  std::optional<double> density = {};  // kg/m^3 (kg/m^2 planar); default Options::density
  Material material = {};
  Filter filter = {};
  std::string name = {};
};

}  // namespace manyworlds
