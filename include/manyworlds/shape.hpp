// Shapes: geometry, material and collision filter of a body. A body collides with its shapes and
// takes its mass from them. Part of Scene (scene.hpp).
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
// Eigen's constructor order: (w, x, y, z). Unaligned, so that structs have the same layout for
// every instruction set that the caller compiles for.
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
// All points within the radius of a line segment of length 2 half_length, centred on the shape
// frame. The segment runs along z in a spatial scene and along y in a planar one.
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
// Spatial, a convex polyhedron: the convex hull of 4 to 8192 vertices. make_hull (hull.hpp)
// computes the vertices from a point cloud. Coplanar faces are merged.
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
// Planar, fixed bodies only: a chain of segments. The solid is to the right of the direction of the
// points, so list the points of a hill from left to right. Bodies slide over inner vertices without
// a bump. At the ends of an open chain the solid has a vertical side.
struct Terrain {
  std::vector<Vec2> points = {};  // m, shape frame; 2 or more, of a loop 3 or more
  bool loop = false;              // the last point is joined to the first
};
// Spatial, fixed bodies only: the solid below a triangulated grid of heights, centred on the shape
// frame. The diagonal of each cell starts at its corner of low x and low y. Bodies slide and roll
// over inner edges without a bump. At the border the solid has a vertical side. A body below the
// surface is moved up.
struct HeightField {
  std::vector<double> heights = {};  // m, [row][column]; columns run along x, rows along y
  int columns = 2;                   // points along x, 2 or more
  Vec2 cell{1, 1};                   // m, between points along x and y
  int rows() const { return columns > 0 ? static_cast<int>(heights.size()) / columns : 0; }
};
using Geometry = std::variant<Sphere, Box, Plane, Circle, Polygon, HalfPlane, Capsule, Segment,
                              Terrain, Cylinder, Hull, HeightField, Ellipsoid>;

// Contact parameters of Solver::newton. A pair combines its two materials as MuJoCo does: the
// material of higher priority decides. At equal priority the pair takes the larger friction and
// dimensions and the weighted mean of the compliances, or the smaller of two direct ones. Margins
// add up.
struct SoftContact {
  int dimensions = 3;  // 1: no friction, 3: friction along the surface
  Compliance compliance = {};
  double margin = 0;  // m, separation below which a contact acts
  double gap = 0;     // m, MuJoCo lists contacts from margin + gap; no effect on the motion
  int priority = 0;
  double weight = 1;  // weight of the compliance in the mean
  bool operator==(const SoftContact&) const = default;
};

// A contact with the normal force N resists rolling by moments up to rolling_resistance N, and
// spinning about the normal up to torsional_resistance N; a pair uses the larger values. They are
// MuJoCo's rolling and torsional friction. Box2D's rollingResistance is rolling_resistance over the
// radius. A ball of radius R rests on slopes up to atan(rolling_resistance / R). Solver::newton
// refuses both.
struct Material {
  double friction = 0.6;            // Coulomb coefficient; a pair uses the geometric mean
  double restitution = 0.0;         // 0 to 1; a pair uses the larger value
  double rolling_resistance = 0;    // m
  double torsional_resistance = 0;  // m, spatial scenes only
  SoftContact soft = {};            // Solver::newton only; that solver has no restitution
};

// Two shapes collide if each one's category is in the other's mask. They must belong to different
// bodies, at least one of which is dynamic.
struct Filter {
  std::uint32_t category = 1;
  std::uint32_t mask = 0xffffffffu;
};

struct Shape {
  Geometry geometry = Sphere{};
  Vec3 position = Vec3::Zero();        // m, shape frame in the body frame
  Quat rotation = Quat::Identity();    // shape frame in the body frame; need not be unit
  std::optional<double> density = {};  // kg/m^3 (kg/m^2 planar); default Options::density
  Material material = {};
  Filter filter = {};
  std::string name = {};
};

}  // namespace manyworlds
