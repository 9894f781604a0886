#include "tests/support/contraption.hpp"

#include <iterator>
#include <optional>
#include <utility>

namespace manyworlds::test {

Scene contraption(Space space) {
  Scene scene = empty_scene(space, 9.81);
  scene.add(ground(space));
  const Vec3 up = up_of(space);
  const auto add = [&](const Vec3& place) {
    Body body = body_of(shape_of(box_of(space, {0.3, 0.2, 0.1})), place);
    body.jitter.position = Vec3::UnitX() * 0.05;
    body.jitter.angle = 0.1;
    return scene.add(body);
  };
  const auto join = [&](BodyId a, BodyId b, const Vec3& where, JointType type) {
    Joint joint = joint_at(scene, a, b, at(where, hinge_axes(space)), std::move(type));
    joint.break_force = space == Space::planar ? 4e4 : 1e4;
    joint.break_torque = joint.break_force;
    scene.add(joint);
  };
  const Spring spring{0, 0, 4, 0.5};
  BodyId last;
  const JointType types[] = {
      HingeJoint{Limit{-1, 1, std::nullopt}, std::nullopt},
      HingeJoint{std::nullopt, Drive{0.5, 0, spring, 100}},
      SliderJoint{Limit{-0.2, 0.2, spring}, Drive{0, 1, std::nullopt, 50}},
      FixedJoint{},
      DistanceJoint{std::nullopt, std::nullopt, spring},
      WheelJoint{spring, Limit{-0.1, 0.1, std::nullopt}, Drive{0, 10, std::nullopt, 20}},
      TargetJoint{spring, 1e3},
      DistanceJoint{},
  };
  for (std::size_t i = 0; i < std::size(types); ++i) {
    const double x = 0.7 * static_cast<double>(i);
    const BodyId body = add(Vec3(x, 0, 0) + 1.5 * up);
    join(last, body, Vec3(x - 0.35, 0, 0) + 1.5 * up, types[i]);
    last = body;
  }
  if (space == Space::spatial) {
    const BodyId ball = add({2, 2, 3});
    join({}, ball, {1.5, 2, 3}, BallJoint{0.6, Limit{-0.2, 0.2, std::nullopt}});
  }
  const BodyId a = add(Vec3(-3, 0, 0) + 2 * up), b = add(Vec3(-2, 0, 0) + 2 * up);
  Joint rope;
  rope.body_a = a, rope.body_b = b;
  rope.type = PulleyJoint{Vec3(-3, 0, 0) + 5 * up, Vec3(-2, 0, 0) + 5 * up, 1.5, std::nullopt};
  scene.add(rope);
  scene.options.wind = {3, 0, 0};
  for (std::size_t i = 1; i < scene.bodies.size(); i += 2) scene.bodies[i].linear_drag = 0.1;
  scene.attractors = {{Vec3(2, 0, 0) + 3 * up, 4, 0.5}};
  return scene;
}

Scene joint_trees(Space space) {
  Scene scene = empty_scene(space, 9.81);
  scene.options.joint.method = JointMethod::tree;
  scene.add(ground(space));
  const Vec3 up = up_of(space);
  const Spring spring{0, 0, 4, 0.5}, stiff{800, 20, 0, 0};
  const JointType types[] = {
      HingeJoint{Limit{-1, 1, std::nullopt}, std::nullopt},
      HingeJoint{std::nullopt, Drive{0.5, 0, spring, 100}},
      SliderJoint{Limit{-0.2, 0.2, spring}, Drive{0, 1, std::nullopt, 50}},
      FixedJoint{},
      WheelJoint{stiff, Limit{-0.1, 0.1, std::nullopt}, Drive{0, 10, std::nullopt, 20}},
      SliderJoint{std::nullopt, Drive{0.1, 0, stiff, 300}},
      space == Space::planar ? JointType(HingeJoint{}) : JointType(BallJoint{}),
  };
  const auto box = [&](const Vec3& place) {
    Body body = body_of(shape_of(box_of(space, {0.3, 0.2, 0.1})), place);
    body.jitter.position = Vec3::UnitX() * 0.05;
    body.jitter.angle = 0.1;
    return body;
  };
  Body carrier = box(3 * up);
  carrier.motion = Motion::kinematic;
  carrier.linear_velocity = {0.3, 0, 0};
  const BodyId driven = scene.add(carrier);
  int tree = 0;
  for (const BodyId root : {BodyId{}, driven, BodyId{}}) {
    BodyId last = root;
    for (std::size_t i = 0; i < std::size(types); ++i) {
      const Vec3 place = Vec3(0.7 * static_cast<double>(i) + 0.7, 3.0 * tree, 0) + 1.5 * up;
      const BodyId body =
          scene.add(box(space == Space::planar ? Vec3(place + 2.0 * tree * up) : place));
      const Vec3 between = scene.at(body).position - Vec3(0.35, 0, 0);
      if (last || tree == 0) {
        const Frame frame = at(between, hinge_axes(space));
        const bool reversed = last && i % 3 == 2;
        Joint joint = reversed ? joint_at(scene, body, last, frame, types[i])
                               : joint_at(scene, last, body, frame, types[i]);
        joint.break_force = 1e5, joint.break_torque = 1e5;
        scene.add(joint);
      }
      if (i != 3) last = body;  // what comes after the third hangs on the second, too
    }
    ++tree;
  }
  const BodyId a = scene.add(box(Vec3(-3, 0, 0) + 2 * up)),
               b = scene.add(box(Vec3(-2, 0, 0) + 2 * up));
  scene.add(joint_at(scene, a, b, at(Vec3(-2.5, 0, 0) + 2 * up), DistanceJoint{1.0, {}, {}}));
  return scene;
}

}  // namespace manyworlds::test
