// Loads MJCF, MuJoCo's model format, with MuJoCo's library. A separate, optional library: link
// manyworlds::mjcf.
//
// The loader reads bodies and static geoms: spheres, capsules, cylinders, ellipsoids, boxes, meshes
// (their convex hulls, as in MuJoCo), planes and height fields. MuJoCo's compiler computes poses,
// masses and inertias. Sites are read as named points. Lights, cameras, materials and textures are
// ignored. Settings that affect only the accuracy of MuJoCo's solver are warnings. Unsupported
// elements that change the motion are errors.
//
// A model with a joint other than a free joint is articulated. Its scene has trees for
// Solver::newton and moves as in MuJoCo. The loader reads
//   - every moving body as a separate body. A body without joints has a fixed joint to its parent,
//     or is merged with the parent if it has no mass;
//   - joints with armature, damping, stiffness, springref, ref, range, margin and the softness of
//     limits; several joints of one body form a series (Joint::after);
//   - actuators on hinges and slides without activation, with gain fixed or affine and bias none or
//     affine (motor, position, velocity, damper, general), as controls (ControlKind::joint_force);
//   - friction, condim 1 and 3, softness, margin, gap, priority and solmix of geoms; which pairs
//     collide, with excludes;
//   - fixed tendons, with limits or for observation only;
//   - keyframes (qpos, qvel and ctrl; a time is a warning);
//   - timestep, integrator, cone, impratio, gravity, gravcomp, wind, density and viscosity of a
//     medium (inertia model), iterations and tolerances, and the flags that disable constraints,
//     limits, contacts, springs, dampers, gravity, clampctrl and filterparent.
// The solver is always Newton. Errors are: integrators other than Euler, RK4 and implicitfast, drag
// of ellipsoids, friction loss, tendons that exert forces, equalities, contact pairs, condim 4 and
// 6, mocap bodies, and all other actuators and flags that change the motion.
//
// A model with free joints only uses the default solver. Bodies welded to a free body are merged
// with it. The equality constraints connect and weld become ball and fixed joints. Settings for the
// softness of MuJoCo's contacts are warnings.
//
// Loading is safe for untrusted files. Before MuJoCo runs, the loader reads the model and its
// includes into memory, each once, and checks them. It follows symbolic links first. It accepts
// only regular files in the model's folder or in MjcfOptions::roots, with root element <mujoco> and
// sizes within MjcfLimits. MuJoCo opens no file. Textures and skins are never opened; <size> and
// <custom> are dropped. A model within the limits may still take MuJoCo minutes to compile. Read
// untrusted models in a separate process with limits of memory and time, as the program manyworlds
// does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

namespace mjcf {
struct FilesAccess;
}

struct MjcfResult {
  // Bodies are in MuJoCo's order: a fixed body for each static body with geoms (the worldbody is
  // named "world"), a dynamic body for each moving body. options.dt and options.gravity are the
  // file's values. options.length_unit is the median size of the dynamic geoms.
  // In an articulated model, joints are in MuJoCo's order, with each fixed joint at the position of
  // its body; controls are in the order of the actuators; worlds start at MuJoCo's qpos0. In other
  // models, joints are the active equalities, in order. If a joint starts with a gap,
  // JointOptions::pull_speed is finite.
  Scene scene = {};
  // Elements that were read but act differently from MuJoCo, one sentence each.
  std::vector<std::string> warnings = {};
};

// The file cannot be read or contains an unsupported element. what() has one line per problem:
// "pile.xml: joint 'hip' of body 'leg', line 12: is a hinge, which is ...; expected ...".
class MjcfError : public std::runtime_error {
 public:
  explicit MjcfError(std::vector<std::string> problems);
  // The lines of what(). Never empty.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

// Limits of a model. An error names the limit that the model exceeds: "pile.xml: replicate, line 7:
// makes 3000000 elements; expected at most 10000 (limit 'copies')".
struct MjcfLimits {
  std::int64_t file_bytes = std::int64_t{64} << 20;    // of each file
  std::int64_t total_bytes = std::int64_t{256} << 20;  // of all files, and of all names and numbers
                                                       // after replicate and attach
  std::int64_t files = 1000;                           // files opened for a model
  std::int64_t depth = 200;         // nesting of elements, through includes and attach
  std::int64_t elements = 100000;   // elements written in all files of the model
  std::int64_t copies = 10000;      // elements made by replicate, attach and flexcomp
  std::int64_t samples = 1 << 24;   // rows x columns of a height field; all sensors together
  std::int64_t vertices = 1000000;  // vertices of a mesh
};
// The names of the members, in order, and the member with a name. For an unknown name, mjcf_limit()
// throws std::invalid_argument, which lists the names.
std::vector<std::string> mjcf_limit_names();
std::int64_t& mjcf_limit(MjcfLimits& limits, std::string_view name);

struct MjcfOptions {
  // Folders, in addition to the model's, from which includes, meshes, height fields and attached
  // models may be read, with all subfolders. A model given as text has no folder: its files are
  // looked up in the first root, and without a root it cannot name files.
  std::vector<std::filesystem::path> roots;
  MjcfLimits limits;
};

// A model's files, read and checked but not compiled. Later changes on disk have no effect. Cheap
// to copy.
class MjcfFiles {
 public:
  // Throw MjcfError.
  static MjcfFiles read(const std::filesystem::path& file, const MjcfOptions& options = {});
  static MjcfFiles of_string(std::string_view xml, const MjcfOptions& options = {});
  // Runs MuJoCo's compiler. Throws MjcfError.
  MjcfResult compile() const;

 private:
  friend struct mjcf::FilesAccess;
  struct Impl;
  explicit MjcfFiles(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

// Read and compile a model. Both throw MjcfError. compile(Scene) also runs validate() on the scene.
// Any thread may call them. Compilations run one at a time, because MuJoCo reports errors through
// one handler per process.
MjcfResult load_mjcf(const std::filesystem::path& file, const MjcfOptions& options = {});
MjcfResult load_mjcf_string(std::string_view xml, const MjcfOptions& options = {});

}  // namespace manyworlds
