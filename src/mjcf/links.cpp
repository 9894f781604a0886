#include "src/mjcf/links.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include "src/mjcf/compliance.hpp"
#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {
namespace {

// What the flags of <option> leave on.
struct Acting {
  bool springs, dampers, limits, friction_loss;
  explicit Acting(const mjModel& m) {
    const auto on = [&](int flags) { return (m.opt.disableflags & flags) == 0; };
    springs = on(mjDSBL_SPRING);
    dampers = on(mjDSBL_DAMPER);
    limits = on(mjDSBL_LIMIT | mjDSBL_CONSTRAINT);
    friction_loss = on(mjDSBL_FRICTIONLOSS | mjDSBL_CONSTRAINT);
  }
};

void check_joint(const Model& model, int j, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  const Acting acts(m);
  const int dof = m.jnt_dofadr[j];
  const auto refuse = [&](bool found, const char* what, const char* expected) {
    if (!found) return;
    problems.push_back(model.joint_place(j) + ": " + what + " is not simulated yet; expected " +
                       expected);
  };
  refuse(acts.springs && any_nonzero(m.jnt_stiffnesspoly + mjNPOLY * j, mjNPOLY),
         "polynomial stiffness", "one number");
  refuse(acts.springs && m.jnt_springyield[j] != 0, "springyield", "0");
  refuse(acts.dampers && any_nonzero(m.dof_dampingpoly + mjNPOLY * dof, mjNPOLY),
         "polynomial damping", "one number");
  refuse(acts.friction_loss && m.dof_frictionloss[dof] != 0, "frictionloss", "0");
  refuse(m.jnt_actfrclimited[j] && m.nactuator > 0, "actuatorfrcrange", "none");
}

// R z is the axis of a hinge, R x that of a slide.
Frame frame_of(const mjModel& m, int j) {
  const Vec3 axis = vec3(m.jnt_axis + 3 * j);
  Frame frame{vec3(m.jnt_pos + 3 * j), Quat::Identity()};
  if (m.jnt_type[j] == mjJNT_HINGE) frame.rotation.setFromTwoVectors(Vec3::UnitZ(), axis);
  if (m.jnt_type[j] == mjJNT_SLIDE) frame.rotation.setFromTwoVectors(Vec3::UnitX(), axis);
  return frame;
}

JointType type_of(const mjModel& m, int j) {
  std::optional<Limit> limit;
  if (m.jnt_limited[j] && Acting(m).limits) {
    limit = Limit{.low = m.jnt_range[2 * j],
                  .high = m.jnt_range[2 * j + 1],
                  .compliance = compliance(m.jnt_solref + mjNREF * j, m.jnt_solimp + mjNIMP * j),
                  .margin = m.jnt_margin[j]};
  }
  switch (m.jnt_type[j]) {
    case mjJNT_HINGE: return HingeJoint{.limit = limit};
    case mjJNT_SLIDE: return SliderJoint{.limit = limit};
    default: return BallJoint{.limit = limit};
  }
}

JointDynamics dynamics_of(const mjModel& m, int j) {
  const Acting acts(m);
  const int dof = m.jnt_dofadr[j];  // all of a ball joint are alike
  JointDynamics dynamics{.armature = m.dof_armature[dof],
                         .damping = acts.dampers ? m.dof_damping[dof] : 0};
  dynamics.stiffness = acts.springs ? m.jnt_stiffness[j] : 0;
  if (m.jnt_type[j] == mjJNT_BALL) return dynamics;
  const int coordinate = m.jnt_qposadr[j];
  dynamics.rest = m.qpos_spring[coordinate];
  dynamics.reference = m.qpos0[coordinate];
  return dynamics;
}

Frame moved(const Pose& by, const Frame& frame) {
  const Pose pose = by * Pose{frame.position, frame.rotation};
  return {pose.position, pose.rotation};
}

}  // namespace

void check_links(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  if (!model.articulated) return;
  for (int b = 1; b < m.nbody; ++b) {
    if (m.body_weldid[b] == 0 || m.body_mass[b] != 0) continue;
    const int first = m.body_geomadr[b];
    bool collides = false;
    for (int g = first; g < first + m.body_geomnum[b]; ++g) collides |= model.collides(g);
    const bool jointed = m.body_jntnum[b] > 0;
    if (!jointed && !collides) continue;  // its parent carries it
    problems.push_back(model.body_place(b) + ": has " +
                       (jointed ? "joints" : "geoms that collide") +
                       " but no mass, which is not simulated yet; expected a mass");
  }
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_type[j] != mjJNT_FREE) check_joint(model, j, problems);
  }
}

std::vector<JointId> add_links(const Model& model, const std::vector<BodyId>& scene_body,
                               Scene& scene) {
  const mjModel& m = *model.compiled;
  const bool parents_collide = (m.opt.disableflags & mjDSBL_FILTERPARENT) != 0;
  std::vector<JointId> scene_joint(static_cast<std::size_t>(m.njnt));
  for (int b = 1; b < m.nbody; ++b) {
    if (m.body_weldid[b] == 0 || model.carrier(b) != b) continue;
    const int above = m.body_parentid[b];
    const bool grounded = m.body_weldid[above] == 0;
    const int parent = grounded ? 0 : model.carrier(above);
    const Pose pose = pose_in(m, b, parent);
    Joint joint;
    if (!grounded) joint.body_a = scene_body[static_cast<std::size_t>(parent)];
    joint.body_b = scene_body[static_cast<std::size_t>(b)];
    if (m.body_jntnum[b] == 0) {
      joint.type = FixedJoint{};
      joint.frame_a = moved(pose, Frame{});
      scene.add(std::move(joint));
      continue;
    }
    joint.collide = parents_collide;
    const int first = m.body_jntadr[b];
    for (int j = first; j < first + m.body_jntnum[b]; ++j) {
      if (m.jnt_type[j] == mjJNT_FREE) continue;
      joint.name = model.name(mjOBJ_JOINT, j);
      joint.type = type_of(m, j);
      joint.dynamics = dynamics_of(m, j);
      joint.frame_b = frame_of(m, j);
      // The frame that the joint before moves is the body's at the reference.
      joint.frame_a = j == first ? moved(pose, joint.frame_b) : joint.frame_b;
      joint.after = j == first ? JointId() : scene_joint[static_cast<std::size_t>(j - 1)];
      scene_joint[static_cast<std::size_t>(j)] = scene.add(joint);
    }
  }
  return scene_joint;
}

}  // namespace manyworlds::mjcf
