// Reading MJCF, MuJoCo's model format, through MuJoCo's own library. A separate, optional library:
// link manyworlds::mjcf.
//
// What is read: worlds of free bodies (a free joint on a top-level body) and static geoms, made of
// spheres, capsules, cylinders, boxes, meshes (their convex hulls, as in MuJoCo), planes and height
// fields. Equality constraints connect and weld become ball and fixed joints. Poses, masses and
// inertias are those that MuJoCo's compiler computes. Whatever would change the motion and is not
// simulated here is an error; what only shapes MuJoCo's contact softness or its solver is a
// warning; what is only seen (lights, cameras, materials, textures, sites) is ignored.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

struct MjcfResult {
  // Bodies in MuJoCo's order: a fixed body for each static body that has geoms (the worldbody is
  // named "world"), a dynamic body for each free one. options.dt and options.gravity are the
  // file's; options.length_unit is the median size of the dynamic geoms; joints that begin apart
  // get a finite options.joint_pull_speed. Joints are those of the active equalities, in order.
  Scene scene;
  // What was read but does not act as it does in MuJoCo, one sentence each.
  std::vector<std::string> warnings;
};

// A file that cannot be read, or that holds something we do not simulate. what() has one line per
// problem: "pile.xml: joint 'hip' of body 'leg', line 12: is a hinge, which is ...; expected ...".
class MjcfError : public std::runtime_error {
 public:
  explicit MjcfError(std::vector<std::string> problems);
  // The lines of what(). Never empty.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

// Both throw MjcfError and leave nothing behind. The scene still has to pass validate(), which
// compile() runs. Any thread may call them; calls wait for one another, because MuJoCo reports
// errors through one handler per process.
MjcfResult load_mjcf(const std::filesystem::path& file);
// Assets are looked up relative to the working directory.
MjcfResult load_mjcf_string(std::string_view xml);

}  // namespace manyworlds
