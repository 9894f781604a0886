// Reading MJCF, MuJoCo's model format, through MuJoCo's own library. A separate, optional library:
// link manyworlds::mjcf.
//
// What is read: bodies and static geoms, made of spheres, capsules, cylinders, ellipsoids, boxes,
// meshes (their convex hulls, as in MuJoCo), planes and height fields. Poses, masses and inertias
// are those that MuJoCo's compiler computes. Whatever would change the motion and is not simulated
// here is an error; what only shapes the accuracy of MuJoCo's solver is a warning; what is only
// seen (lights, cameras, materials, textures) is ignored. Sites are kept, as points with names.
//
// A model with any joint but free ones is articulated: its scene is one of trees for
// Solver::newton, which moves as in MuJoCo. Read are
//   - every body that moves, as a body of its own; those without joints are held by a fixed joint
//     to their parent, but for those without mass, which are part of it;
//   - joints with armature, damping, stiffness, springref, ref, range, margin and the softness of
//     limits; several of one body are a series (Joint::after);
//   - actuators on hinges and slides without activation, of gain fixed or affine and bias none or
//     affine (motor, position, velocity, damper, general), as controls (ControlKind::joint_force);
//   - friction, condim 1 and 3, softness, margin, gap, priority and solmix of geoms; which pairs
//     collide, excludes included;
//   - fixed tendons, with their limits or to be looked at;
//   - keyframes (qpos, qvel and ctrl; a time is a warning);
//   - timestep, integrator, cone, impratio, gravity, gravcomp, wind, density and viscosity of a
//     medium (inertia model), iterations and tolerances, and the flags that switch off constraints,
//     limits, contacts, springs, dampers, gravity, clampctrl and filterparent.
// The solver is Newton's, whatever the file says. Refused are other integrators than Euler, RK4
// and implicitfast, drag of ellipsoids, friction loss, tendons that pull, equalities, contact
// pairs, condim 4 and 6, mocap bodies, and all other actuators and flags that change the motion.
//
// A model whose joints are all free is made for the default solver: what is welded to a free body
// is part of it, equality constraints connect and weld become ball and fixed joints, and what
// shapes the softness of MuJoCo's contacts is a warning.
//
// Files need not be trusted. Before MuJoCo reads one, it and all that it includes are read into
// memory, each once, and checked: regular files alone, from the model's own folder or from those
// that MjcfOptions::roots names, symbolic links followed first; root element <mujoco>; and no size
// beyond MjcfLimits. MuJoCo opens no file itself. Textures and skins are not opened at all, since
// nothing is drawn, and <size> and <custom> are left out. A model within the limits may still keep
// MuJoCo busy for minutes: read untrusted models in a separate process, with limits
// of memory and time, as the program manyworlds does.
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
  // Bodies in MuJoCo's order: a fixed body for each static body that has geoms (the worldbody is
  // named "world"), a dynamic body for each that moves. options.dt and options.gravity are the
  // file's; options.length_unit is the median size of the dynamic geoms.
  // Of an articulated model, joints are in MuJoCo's order, with fixed ones where their bodies are,
  // and controls in that of the actuators; worlds begin at the reference (MuJoCo's qpos0). Of other
  // models, joints are those of the active equalities, in order; where they begin apart
  // JointOptions::pull_speed is finite.
  Scene scene = {};
  // What was read but does not act as it does in MuJoCo, one sentence each.
  std::vector<std::string> warnings = {};
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

// What a model may ask for. An error names the limit that it reaches: "pile.xml: replicate, line 7:
// makes 3000000 elements; expected at most 10000 (limit 'copies')".
struct MjcfLimits {
  std::int64_t file_bytes = std::int64_t{64} << 20;    // of each file
  std::int64_t total_bytes = std::int64_t{256} << 20;  // of all files, and of all names and numbers
                                                       // after replicate and attach
  std::int64_t files = 1000;                           // opened for one model
  std::int64_t depth = 200;         // elements inside one another, through includes and attach
  std::int64_t elements = 100000;   // written, in all files of the model
  std::int64_t copies = 10000;      // elements that replicate, attach and flexcomp make
  std::int64_t samples = 1 << 24;   // of a height field, rows x columns; of all sensors together
  std::int64_t vertices = 1000000;  // of a mesh
};
// The names of the members, in order, and the member of a name. mjcf_limit() throws
// std::invalid_argument, which lists the names, for any other.
std::vector<std::string> mjcf_limit_names();
std::int64_t& mjcf_limit(MjcfLimits& limits, std::string_view name);

struct MjcfOptions {
  // Folders besides the model's own from which includes, meshes, height fields and attached models
  // may be read, with all that is in them. A text has no folder: only with a root can it name
  // files, which are then looked up in the first.
  std::vector<std::filesystem::path> roots;
  MjcfLimits limits;
};

// A model's files, read and checked but not compiled. What happens to them on disk later does not
// matter any more. Cheap to copy.
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

// Read and compile. All throw MjcfError and leave nothing behind. The scene still has to pass
// validate(), which compile(Scene) runs. Any thread may call them; compilations wait for one
// another, because MuJoCo reports errors through one handler per process.
MjcfResult load_mjcf(const std::filesystem::path& file, const MjcfOptions& options = {});
MjcfResult load_mjcf_string(std::string_view xml, const MjcfOptions& options = {});

}  // namespace manyworlds
