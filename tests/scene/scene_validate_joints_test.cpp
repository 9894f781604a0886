// What validate() says about joints.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/joints.hpp"
#include "tests/support/scene_cases.hpp"

namespace manyworlds::test {
namespace {

// Body 0 fixed, 1 and 2 dynamic; joint 0 'elbow' between 1 and 2.
Scene jointed(Space space, JointType type) {
  Scene scene = empty_scene(space);
  scene.add(ground(space));
  for (int i = 0; i < 2; ++i) {
    scene.add(body_of(shape_of(cube_of(space, 0.1)), Vec3(i, 0, 0) + up_of(space)));
  }
  Joint joint = joint_at(scene, BodyId(1), BodyId(2), at(up_of(space)), std::move(type));
  joint.name = "elbow";
  scene.add(joint);
  return scene;
}
template <class Type>
Type& type_of(Scene& scene) {
  return std::get<Type>(scene.joints[0].type);
}
const std::string kElbow = "joint 0 'elbow': ";

}  // namespace

TEST_CASE("joints between the wrong bodies are refused", "[fast][validate][joint]") {
  for (Space space : {Space::planar, Space::spatial}) {
    check_each(
        jointed(space, HingeJoint{}), kElbow,
        {{"body_a", "is 3, must be -1 (the world) or a body, 0 to 2",
          [](Scene& s) { s.joints[0].body_a = BodyId(3); }},
         {"body_b", "is -1, must be a body, 0 to 2", [](Scene& s) { s.joints[0].body_b = {}; }},
         {"body_b", "is 1, must be another body than body_a",
          [](Scene& s) { s.joints[0].body_b = BodyId(1); }},
         {"body_b", "are both not dynamic",
          [](Scene& s) { s.bodies[1].motion = s.bodies[2].motion = Motion::kinematic; }},
         {"body_b", "is fixed, must be a body that moves",
          [](Scene& s) { s.joints[0].body_b = BodyId(0); }},
         {"frame_b.position", "is 1000 m from frame_a's",
          [](Scene& s) { s.joints[0].frame_a.position.x() += 1000; }},
         {"frame_a.position.x", "is nan m",
          [](Scene& s) { s.joints[0].frame_a.position.x() = kNan; }},
         {"frame_b.rotation", "must not be zero",
          [](Scene& s) { s.joints[0].frame_b.rotation.coeffs().setZero(); }}});
  }
}

TEST_CASE("limits, springs and drives that make no sense are refused", "[fast][validate][joint]") {
  HingeJoint hinge;
  hinge.limit = Limit{-1, 1, std::nullopt};
  hinge.drive = Drive{0, 0, Spring{10, 1, 0, 0}, 5};
  check_each(
      jointed(Space::spatial, hinge), kElbow,
      {{"limit", "is from 2 to 1, low must not be above high",
        [](Scene& s) { type_of<HingeJoint>(s).limit->low = 2; }},
       {"limit.high", "is 4 rad, must be between -pi and pi",
        [](Scene& s) { type_of<HingeJoint>(s).limit->high = 4; }},
       {"limit.low", "is nan rad", [](Scene& s) { type_of<HingeJoint>(s).limit->low = kNan; }},
       {"drive.spring.stiffness", "is -10, must be >= 0",
        [](Scene& s) { type_of<HingeJoint>(s).drive->spring->stiffness = -10; }},
       {"drive.spring", "has both a stiffness or damping and a frequency",
        [](Scene& s) { type_of<HingeJoint>(s).drive->spring->frequency = 2; }},
       {"drive.spring", "is zero, must have a stiffness",
        [](Scene& s) { type_of<HingeJoint>(s).drive->spring = Spring{}; }},
       {"drive.max_force", "is -1, must be >= 0",
        [](Scene& s) { type_of<HingeJoint>(s).drive->max_force = -1; }},
       {"drive.target_speed", "is nan",
        [](Scene& s) { type_of<HingeJoint>(s).drive->target_speed = kNan; }}});
}

TEST_CASE("each type of joint has checks of its own", "[fast][validate][joint]") {
  check_each(
      jointed(Space::spatial, BallJoint{0.5, std::nullopt}), kElbow,
      {{"cone", "is 4, must be between 0 and", [](Scene& s) { type_of<BallJoint>(s).cone = 4; }}});
  CHECK(places(jointed(Space::planar, BallJoint{})) == std::vector<std::string>{kElbow + "type"});
  check_each(
      jointed(Space::spatial, PulleyJoint{}), kElbow,
      {{"ratio", "is 0, must be > 0", [](Scene& s) { type_of<PulleyJoint>(s).ratio = 0; }},
       {"ground_b.y", "is nan m", [](Scene& s) { type_of<PulleyJoint>(s).ground_b.y() = kNan; }},
       {"body_a", "does not move, must be a moving body at the end of the rope",
        [](Scene& s) { s.joints[0].body_a = {}; }},
       {"body_a", "does not move, must be a moving body at the end of the rope",
        [](Scene& s) { s.joints[0].body_a = BodyId(0); }}});
  check_each(
      jointed(Space::planar, WheelJoint{Spring{0, 0, 2, 0.5}, std::nullopt, std::nullopt}), kElbow,
      {{"suspension", "is zero", [](Scene& s) { type_of<WheelJoint>(s).suspension = Spring{}; }}});
  check_each(jointed(Space::planar, DistanceJoint{}), kElbow,
             {{"length", "is -1 m, must be >= 0",
               [](Scene& s) { type_of<DistanceJoint>(s).length = -1; }}});
}

TEST_CASE("all problems of all joints are listed at once", "[fast][validate][joint]") {
  Scene scene = jointed(Space::spatial, HingeJoint{});
  scene.joints[0].body_a = BodyId(7);
  scene.joints.push_back(scene.joints[0]);
  scene.joints[1].name.clear();
  scene.joints[1].body_a = BodyId(1);
  scene.joints[1].body_b = BodyId(1);
  scene.bodies[1].position.x() = kNan;
  CHECK(places(scene) ==
        std::vector<std::string>{"body 1: position.x", kElbow + "body_a", "joint 1: body_b"});
}

}  // namespace manyworlds::test
