// Models with joints as trees: bodies, joints and their frames, judged by MuJoCo's kinematics.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "manyworlds/mjcf.hpp"
#include "src/mjcf/pose.hpp"
#include "tests/mjcf/mujoco_reference.hpp"
#include "tests/support/random.hpp"

namespace manyworlds::test {
namespace {

using mjcf::Pose;
using mjcf::quat;
using mjcf::vec3;

// A walker on a free joint, a cart on a static pillar, a pendulum on the world and a ball that is
// free: each kind of joint, several on one body, a welded hand and a mount without mass.
constexpr const char* kRobots = R"(<mujoco>
  <compiler angle="radian" autolimits="true"/>
  <option timestep="0.004" gravity="0.5 -1 -9.81"/>
  <default><geom type="capsule" size="0.04 0.1" density="900"/>
    <joint armature="0.01" damping="0.3"/></default>
  <worldbody>
    <geom name="ground" type="plane" size="5 5 1"/>
    <body name="trunk" pos="0 0 1" euler="0.1 0.2 0.3"><freejoint name="root"/>
      <geom size="0.1 0.2" euler="0 1.57 0" pos="0.03 0 0.02"/>
      <body name="thigh" pos="0.1 0.15 -0.1" euler="0.2 0 0.1">
        <joint name="hip x" axis="1 0 0" pos="0 0 0.1" range="-0.5 0.6" stiffness="4"/>
        <joint name="hip y" axis="0 -1 0.2" pos="0.02 0 0.1" range="-1 0.3" ref="0.2"
               springref="0.4" stiffness="9"/>
        <geom pos="0.01 0 -0.05"/>
        <body name="mount" pos="0.1 0 0" euler="0 0.3 0">
          <body name="shin" pos="0 0 -0.25">
            <joint name="knee" axis="0 0 -1" pos="0 0 0.12" range="-1.2 0.1" margin="0.05"
                   solreflimit="0.03 0.8" solimplimit="0.5 0.9 0.2 0.4 3"/>
            <geom/><geom type="sphere" size="0.05" pos="0.06 0 -0.12"/>
          </body>
        </body>
      </body>
      <body name="tail" pos="-0.2 0 0">
        <joint name="tail" type="ball" pos="0.08 0 0" damping="0.1" stiffness="2" range="0 0.7"
               margin="0.1" solreflimit="0.04 0.9" ref="0.3" springref="0.2"/>
        <geom type="box" size="0.1 0.03 0.02"/>
        <body name="tip" pos="-0.2 0 0" euler="0.4 0 0"><geom type="ellipsoid" size="0.1 0.05 0.03"
          pos="0.01 0 0"/></body>
      </body>
    </body>
    <body name="pillar" pos="2 0 0.2" euler="0 0 0.7"><geom type="box" size="0.1 0.1 0.1"/>
      <body name="cart" pos="0 0.1 0.3" euler="0.1 0 0">
        <joint name="rail" type="slide" axis="1 0.1 0" range="-0.5 0.5" ref="0.1"/>
        <joint name="lift" type="slide" axis="0 0 1" stiffness="300" springref="0.05"/>
        <joint name="swivel" axis="0 0 1" pos="0.05 0.02 0"/>
        <geom type="box" size="0.2 0.1 0.05"/>
      </body>
    </body>
    <body name="bob" pos="-2 0 2" gravcomp="0.25"><joint name="hook" type="ball" pos="0 0 0.5"/>
      <geom friction="0.7 0.1 0.1" condim="1" solref="-100 -5" solimp="0 0.8 0.01 0.4 3"
            margin="0.02" gap="0.01" priority="2" solmix="0.3"/></body>
    <body name="pebble" pos="0 3 1"><freejoint/><geom type="sphere" size="0.05"/></body>
  </worldbody>
</mujoco>)";

Pose pose_of(const Frame& frame) { return {frame.position, frame.rotation}; }
Pose inverse(const Pose& pose) {
  const Quat back = pose.rotation.conjugate();
  return {back * -pose.position, back};
}

// Of B's frame against A's.
Pose displacement(const mjModel& m, int joint, const JointType& type, const mjtNum* qpos) {
  const mjtNum* q = qpos + m.jnt_qposadr[joint];
  if (std::holds_alternative<BallJoint>(type)) return {Vec3::Zero(), quat(q)};
  const double moved = q[0] - m.qpos0[m.jnt_qposadr[joint]];
  if (std::holds_alternative<SliderJoint>(type)) return {moved * Vec3::UnitX(), Quat::Identity()};
  return {Vec3::Zero(), Quat(Eigen::AngleAxisd(moved, Vec3::UnitZ()))};
}

// Forward kinematics of a scene.
struct Places {
  std::vector<Pose> body;   // [scene body]
  std::vector<Pose> joint;  // [scene joint] of A's frame, in the world
};

Places places_of(const Scene& scene, const mjModel& m, const mjtNum* qpos) {
  Places out;
  for (const Body& body : scene.bodies) {
    const int b = mj_name2id(&m, mjOBJ_BODY, body.name.c_str());
    const int j = m.body_jntadr[b];
    if (j >= 0 && m.jnt_type[j] == mjJNT_FREE) {
      const mjtNum* q = qpos + m.jnt_qposadr[j];
      out.body.push_back({vec3(q), quat(q + 3)});
    } else {
      out.body.push_back({body.position, body.rotation});  // of those on joints until below
    }
  }
  for (const Joint& joint : scene.joints) {
    const auto b = static_cast<std::size_t>(joint.body_b.index());
    Pose before;
    if (joint.after) {
      before = out.body[b];  // of what the joint before moves
    } else if (joint.body_a) {
      before = out.body[static_cast<std::size_t>(joint.body_a.index())];
    }
    const Pose at = before * pose_of(joint.frame_a);
    out.joint.push_back(at);
    const int j = mj_name2id(&m, mjOBJ_JOINT, joint.name.c_str());
    const bool fixed = std::holds_alternative<FixedJoint>(joint.type);
    const Pose moved = fixed ? Pose{} : displacement(m, j, joint.type, qpos);
    out.body[b] = at * moved * inverse(pose_of(joint.frame_b));
  }
  return out;
}

}  // namespace

TEST_CASE("bodies and joints of trees come in MuJoCo's order, by name", "[mjcf][robots][fast]") {
  const MjcfResult result = load_mjcf_string(kRobots);
  CHECK(result.warnings.empty());
  const Scene& scene = result.scene;
  std::vector<std::string> bodies, joints;
  for (const Body& body : scene.bodies) bodies.push_back(body.name);
  for (const Joint& joint : scene.joints) joints.push_back(joint.name);
  // The mount has neither mass nor joints.
  CHECK(bodies == std::vector<std::string>{"world", "trunk", "thigh", "shin", "tail", "tip",
                                           "pillar", "cart", "bob", "pebble"});
  CHECK(joints == std::vector<std::string>{"hip x", "hip y", "knee", "tail", "", "rail", "lift",
                                           "swivel", "hook"});
  for (const Body& body : scene.bodies) {
    const bool fixed = body.name == "world" || body.name == "pillar";
    CHECK(body.motion == (fixed ? Motion::fixed : Motion::dynamic));
  }
  const auto on = [&](const char* name) { return scene.at(scene.joint(name)); };
  CHECK(on("hip x").body_a == scene.body("trunk"));
  CHECK_FALSE(on("hip x").after);
  CHECK(on("hip y").body_a == scene.body("trunk"));
  CHECK(on("hip y").body_b == scene.body("thigh"));
  CHECK(on("hip y").after == scene.joint("hip x"));
  CHECK(on("knee").body_a == scene.body("thigh"));
  CHECK(on("swivel").after == scene.joint("lift"));
  CHECK_FALSE(on("rail").body_a);
  CHECK_FALSE(on("hook").body_a);
  CHECK(std::holds_alternative<FixedJoint>(scene.joints[4].type));
  CHECK(scene.joints[4].body_a == scene.body("tail"));
  CHECK(scene.joints[4].body_b == scene.body("tip"));
  for (const Joint& joint : scene.joints) CHECK_FALSE(joint.collide);
}

TEST_CASE("bodies of trees begin where MuJoCo's are, with their mass", "[mjcf][robots][fast]") {
  const Scene scene = load_mjcf_string(kRobots).scene;
  const Reference reference(kRobots);
  const mjModel& m = *reference.model;
  double mass = 0;
  for (const Body& body : scene.bodies) {
    INFO(body.name);
    const int b = mj_name2id(&m, mjOBJ_BODY, body.name.c_str());
    CHECK((body.position - vec3(reference.data->xpos + 3 * b)).norm() < 1e-12);
    CHECK(body.rotation.angularDistance(quat(reference.data->xquat + 4 * b)) < 1e-7);
    if (body.motion == Motion::fixed) continue;
    REQUIRE(body.mass_properties);
    CHECK(body.mass_properties->mass == m.body_mass[b]);
    CHECK(body.mass_properties->center == vec3(m.body_ipos + 3 * b));
    const Mat3 axes = quat(m.body_iquat + 4 * b).toRotationMatrix();
    const Mat3 inertia = axes * vec3(m.body_inertia + 3 * b).asDiagonal() * axes.transpose();
    CHECK((body.mass_properties->inertia - inertia).norm() < 1e-15 * inertia.norm());
    CHECK(body.gravity_scale == (body.name == "bob" ? 0.75 : 1));
    mass += body.mass_properties->mass;
  }
  CHECK(mass == Approx(m.body_subtreemass[0] -
                       m.body_mass[m.body_parentid[mj_name2id(&m, mjOBJ_BODY, "cart")]]));
}

TEST_CASE("frames of joints move bodies as MuJoCo does", "[mjcf][robots][fast]") {
  const Scene scene = load_mjcf_string(kRobots).scene;
  const Reference reference(kRobots);
  const mjModel& m = *reference.model;
  mjData* d = reference.data.get();
  Random random(4);
  for (int trial = 0; trial < 10; ++trial) {
    // The first is the reference itself.
    std::copy_n(m.qpos0, m.nq, d->qpos);
    for (int i = 0; trial > 0 && i < m.nq; ++i) d->qpos[i] += random.uniform(-1, 1);
    mj_normalizeQuat(&m, d->qpos);
    mj_kinematics(&m, d);
    const Places places = places_of(scene, m, d->qpos);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      INFO(scene.bodies[i].name);
      const int b = mj_name2id(&m, mjOBJ_BODY, scene.bodies[i].name.c_str());
      CHECK((places.body[i].position - vec3(d->xpos + 3 * b)).norm() < 1e-12);
      CHECK(places.body[i].rotation.angularDistance(quat(d->xquat + 4 * b)) < 1e-7);
    }
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
      const Joint& joint = scene.joints[i];
      if (std::holds_alternative<FixedJoint>(joint.type)) continue;
      INFO(joint.name);
      const int j = mj_name2id(&m, mjOBJ_JOINT, joint.name.c_str());
      CHECK((places.joint[i].position - vec3(d->xanchor + 3 * j)).norm() < 1e-12);
      if (std::holds_alternative<BallJoint>(joint.type)) continue;
      const bool slides = std::holds_alternative<SliderJoint>(joint.type);
      const Vec3 axis = slides ? Vec3::UnitX() : Vec3::UnitZ();
      CHECK((places.joint[i].rotation * axis - vec3(d->xaxis + 3 * j)).norm() < 1e-12);
    }
  }
}

TEST_CASE("springs, dampers, rotors and limits of joints are MuJoCo's", "[mjcf][robots][fast]") {
  const Scene scene = load_mjcf_string(kRobots).scene;
  const auto dynamics = [&](const char* name) { return scene.at(scene.joint(name)).dynamics; };
  CHECK(dynamics("hip x") == JointDynamics{.armature = 0.01, .damping = 0.3, .stiffness = 4});
  CHECK(dynamics("hip y") ==
        JointDynamics{
            .armature = 0.01, .damping = 0.3, .stiffness = 9, .rest = 0.4, .reference = 0.2});
  CHECK(dynamics("tail") == JointDynamics{.armature = 0.01, .damping = 0.1, .stiffness = 2});
  CHECK(dynamics("rail").reference == 0.1);
  CHECK(dynamics("lift").rest == 0.05);

  const auto knee = std::get<HingeJoint>(scene.at(scene.joint("knee")).type).limit;
  REQUIRE(knee);
  CHECK(knee->low == -1.2);
  CHECK(knee->high == 0.1);
  CHECK(knee->margin == 0.05);
  CHECK(knee->compliance == Compliance{0.03, 0.8, 0.5, 0.9, 0.2, 0.4, 3});
  const auto rail = std::get<SliderJoint>(scene.at(scene.joint("rail")).type).limit;
  REQUIRE(rail);
  CHECK(rail->low == -0.5);
  CHECK(rail->compliance == Compliance{});
  CHECK_FALSE(std::get<SliderJoint>(scene.at(scene.joint("lift")).type).limit);
  const auto tail = std::get<BallJoint>(scene.at(scene.joint("tail")).type).limit;
  REQUIRE(tail);
  CHECK(tail->low == 0);
  CHECK(tail->high == 0.7);
  CHECK(tail->margin == 0.1);
  CHECK(tail->compliance.time_constant == 0.04);
  CHECK_FALSE(std::get<BallJoint>(scene.at(scene.joint("hook")).type).limit);
}

TEST_CASE("contacts of trees are as soft as MuJoCo's", "[mjcf][robots][fast]") {
  const Scene scene = load_mjcf_string(kRobots).scene;
  const Material& bob = scene.at(scene.body("bob")).shapes.at(0).material;
  CHECK(bob.friction == 0.7);
  CHECK(bob.restitution == 0);
  CHECK(bob.soft == SoftContact{.dimensions = 1,
                                .compliance = {-100, -5, 0, 0.8, 0.01, 0.4, 3},
                                .margin = 0.02,
                                .gap = 0.01,
                                .priority = 2,
                                .weight = 0.3});
  const Material& pebble = scene.at(scene.body("pebble")).shapes.at(0).material;
  CHECK(pebble.friction == 1);
  CHECK(pebble.soft == SoftContact{});
}

TEST_CASE("a model whose bodies are all free is no scene of trees", "[mjcf][fast]") {
  const Scene scene = load_mjcf_string(
                          "<mujoco><worldbody><body><freejoint/><geom size='.1'/><body pos='1 0 0'>"
                          "<geom size='.1'/></body></body></worldbody></mujoco>")
                          .scene;
  CHECK(scene.options.solver.method == Solver::tgs_soft);
  CHECK(scene.options.substeps == Options{}.substeps);
  CHECK(scene.bodies.size() == 1);
  CHECK(scene.joints.empty());
}

}  // namespace manyworlds::test
