#include "tests/support/newton_scenes.hpp"

namespace manyworlds::test {

Scene newton_robot() {
  Scene scene = newton_scene();
  scene.add(ground(Space::spatial));
  for (int i = 0; i < 3; ++i) {
    scene.add(body_of(shape_of(cube_of(Space::spatial, 0.1)), Vec3(0.4 * i, 0, 1.5)));
  }
  scene.bodies[1].jitter.position = Vec3(0.3, 0.3, 0.1);
  scene.bodies[1].jitter.any_orientation = true;
  scene.bodies[1].jitter.linear_velocity = Vec3(1, 1, 1);
  HingeJoint hinge;
  hinge.limit = Limit{-1, 1};
  scene.add(joint_at(scene, BodyId(1), BodyId(2), at({0.2, 0, 1.5}, z_to_y()), hinge));
  scene.add(joint_at(scene, BodyId(2), BodyId(3), at({0.6, 0, 1.5}), BallJoint{}));
  // Undamped, such a chain may gain energy by Euler's steps, in MuJoCo as here.
  for (Joint& joint : scene.joints) joint.dynamics.damping = 0.5;
  scene.add(body_of(shape_of(Sphere{0.2}), Vec3(0, 2, 0.3)));
  Control motor;
  motor.kind = ControlKind::joint_force, motor.joint = JointId(0);
  motor.actuator.gear = 3;
  scene.add(motor);
  return scene;
}

}  // namespace manyworlds::test
