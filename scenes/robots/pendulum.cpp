// Made from scenes/mjcf/robot_pendulum.xml by tests/mjcf/mjcf_robots_test.cpp; change it there.
#include "scenes/makers.hpp"

namespace manyworlds::scenes {

Scene pendulum() {
  Scene scene;
  scene.name = "pendulum";
  scene.options.dt = 0.01;
  scene.options.substeps = 1;
  scene.options.gravity = Vec3(0, 0, -9.81);
  scene.options.length_unit = 0.86;
  scene.options.solver.method = Solver::newton;
  scene.options.solver.iterations = 100;
  scene.add(Body{.name = "post",
                 .motion = Motion::fixed,
                 .position = Vec3(0.28, 0, 0.33),
                 .shapes = {Shape{.geometry = Sphere{.radius = 0.1},
                                  .material = Material{.friction = 1},
                                  .filter = Filter{.mask = 0x1},
                                  .name = "east"}}});
  scene.add(Body{.name = "stop",
                 .motion = Motion::fixed,
                 .position = Vec3(-0.32, 0, 0.36),
                 .shapes = {Shape{.geometry = Sphere{.radius = 0.1},
                                  .material = Material{.friction = 0.2},
                                  .filter = Filter{.mask = 0x1},
                                  .name = "west"}}});
  scene.add(Body{
      .name = "pole",
      .position = Vec3(0, 0, 1.2),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.03, .half_length = 0.4},
                       .position = Vec3(0, 0, -0.4),
                       .material = Material{.friction = 1},
                       .filter = Filter{.category = 0x0, .mask = 0x0},
                       .name = "rod"},
                 Shape{.geometry = Sphere{.radius = 0.09},
                       .position = Vec3(0, 0, -0.9),
                       .material = Material{.friction = 1},
                       .filter = Filter{.mask = 0x1},
                       .name = "tip"}},
      .mass_properties = MassProperties{.mass = 1.92502642766833,
                                        .center = Vec3(0, 0, -0.529868346951896),
                                        .inertia = (Mat3() << 0.178333069653802, 0, 0, 0,
                                                    0.178333069653802, 0, 0, 0, 0.00225515463633217)
                                                       .finished()}});
  scene.add(Joint{.name = "pivot",
                  .body_b = BodyId(2),
                  .frame_a = Frame{.position = Vec3(0, 0, 1.2),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 0.05}});
  scene.add(Control{.name = "push",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(0),
                    .actuator = Actuator{.gear = 12}});
  return scene;
}

}  // namespace manyworlds::scenes
