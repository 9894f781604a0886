// From a geom to a shape.
//
// MuJoCo collides a mesh by its convex hull, which its compiler makes, with no more corners than
// the mesh's maxhullvert allows. Those corners are taken, so the shape is the same.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"
#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {

// Whether geoms of that type (mjtGeom) can collide here.
bool has_shape(int geom_type);
// "a sphere, a capsule or a box": those that can.
std::string shape_names();

// Why the geom, a mesh, cannot be a hull: "has a convex hull of ...; expected ...". Nothing if it
// can.
std::optional<std::string> hull_problem(const Model& model, int geom);

// Without material and filter; `body` is the pose of the geom's body in the scene's. Nothing for
// what is only seen: kinds that have no shape, meshes and height fields that do not collide.
std::optional<Shape> shape_of(const Model& model, int geom, const Pose& body);

// m; 0 for what has no end.
double bounding_diameter(const Geometry& geometry);

}  // namespace manyworlds::mjcf
