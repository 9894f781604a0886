// What the library asks of a geometry. Each kind answers in a file of its own in this folder, and
// that file is all that src knows of it.
#pragma once

#include <vector>

#include "kernels/data/shape_kinds.hpp"
#include "manyworlds/surface.hpp"
#include "src/scene/checks.hpp"
#include "src/scene/convex.hpp"

namespace manyworlds {

// A geometry as the narrow phase wants it: a kind of the kernels, in a frame of its own.
struct ShapeForm {
  kernels::ShapeKind kind{};
  Vec3 offset = Vec3::Zero();  // of that frame in the shape frame
  Mat3 rotation = Mat3::Identity();
  Vec3 half = Vec3::Zero();         // half extents; capsule: x is half its length
  double thickness = 0;             // radius of what is round: sphere, circle, capsule
  double radius = 0;                // of the bounding sphere
  double inner_radius = 0;          // of a sphere inside
  std::vector<Vec2> vertices = {};  // of a polygon, about the offset, counter-clockwise
};

// Polygons of a scene are all taken as the simplest kind that fits them all.
struct PolygonChoice {
  bool rectangles = false, rounded = false;
};

class GeometryTraits {
 public:
  virtual ~GeometryTraits() = default;

  const char* const name;  // "height field"
  const bool in_plane, in_space;
  const bool ground;  // only fixed bodies have it

  // Appends what is wrong with it.
  virtual void check(detail::Checker& checker, const Geometry& geometry) const = 0;
  // In the shape frame, density in kg/m^3 (kg/m^2 planar). Nothing of what has no inside or no end.
  virtual MassProperties mass_properties(const Geometry& geometry, double density,
                                         Space space) const = 0;
  // Parameter::size: how many numbers it has, and each of them, m.
  virtual int sizes() const = 0;
  virtual double size(const Geometry& geometry, int component) const = 0;
  virtual void resize(Geometry& geometry, int component, double value) const = 0;
  // m, radius of a sphere about the shape frame around it; 0 of ground.
  virtual double reach(const Geometry& geometry) const = 0;
  // x, r: the shape frame in the world. Of a terrain one for each of its segments.
  virtual std::vector<Convex> convex_parts(const Geometry& geometry, const Vec3& x, const Mat3& r,
                                           Space space) const = 0;
  // Of what is one convex shape with an end.
  virtual ShapeForm form(const Geometry& geometry, const PolygonChoice& choice) const = 0;
  // What a picture shows of it (surface.hpp), once all is checked.
  virtual Surface surface(const Geometry& geometry, const SurfaceOptions& options) const = 0;

 protected:
  struct Kind {
    const char* name;
    bool in_plane = false, in_space = false, ground = false;
  };
  explicit GeometryTraits(const Kind& kind)
      : name(kind.name), in_plane(kind.in_plane), in_space(kind.in_space), ground(kind.ground) {}
};

// Defined for every alternative of Geometry, in its file.
template <class G>
const GeometryTraits& traits_of();
template <>
const GeometryTraits& traits_of<Sphere>();
template <>
const GeometryTraits& traits_of<Box>();
template <>
const GeometryTraits& traits_of<Plane>();
template <>
const GeometryTraits& traits_of<Circle>();
template <>
const GeometryTraits& traits_of<Polygon>();
template <>
const GeometryTraits& traits_of<HalfPlane>();
template <>
const GeometryTraits& traits_of<Capsule>();
template <>
const GeometryTraits& traits_of<Segment>();
template <>
const GeometryTraits& traits_of<Terrain>();
template <>
const GeometryTraits& traits_of<Cylinder>();
template <>
const GeometryTraits& traits_of<Hull>();
template <>
const GeometryTraits& traits_of<HeightField>();
template <>
const GeometryTraits& traits_of<Ellipsoid>();

const GeometryTraits& traits_of(const Geometry& geometry);

// Names of the geometries that a space takes: "circle, polygon and terrain".
std::string geometry_names(Space space);

}  // namespace manyworlds
