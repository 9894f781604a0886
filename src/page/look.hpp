// What a page knows of a kind of worlds before any frame: meshes, bodies made of them, joints.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "manyworlds/plan.hpp"
#include "manyworlds/surface.hpp"
#include "src/page/json.hpp"

namespace manyworlds::page {

// Meshes of a page, each once. Shapes that are the same but for their size share one.
class Meshes {
 public:
  explicit Meshes(Space space) : space_(space) {}

  // How a shape is made of its mesh: a point p of the mesh is at size p + stretch sign(p) of the
  // shape frame, axis by axis.
  struct Use {
    int mesh = -1;
    Vec3 size = Vec3::Ones();
    Vec3 stretch = Vec3::Zero();
  };
  Use use(const Geometry& geometry);
  // Of one with another size (Parameter::size), with the mesh of the geometry itself.
  Use use(const Geometry& geometry, const Vec3& size);
  // The mesh of a shape without end, cut to a box in its frame.
  int ground(const Geometry& geometry, const Vec3& low, const Vec3& high);
  const Json& json() const { return json_; }

 private:
  int add(const char* kind, const Geometry& geometry, const SurfaceOptions& options);

  Space space_;
  std::map<std::string, int> known_;
  Json json_ = Json::array();
};

// m, of a sphere about each body's origin around all its shapes that have an end; of a body without
// such shapes, `otherwise`.
std::vector<double> radii_of(const Scene& scene, double otherwise);

// A box along the axes, m.
struct Room {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  void add(const Vec3& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  bool empty() const { return !(low.array() <= high.array()).all(); }
};

// What is known of a kind apart from its frames: bodies with their shapes, joints. Ground without
// end is cut to `room`, in the world.
Json look_of(const Plan& plan, const std::vector<double>& radii, const Room& room, Meshes& meshes);

// The box around all fixed shapes that have an end.
Room fixed_room(const Scene& scene);

}  // namespace manyworlds::page
