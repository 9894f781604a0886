// Made from scenes/mjcf/robot_hopper.xml by tests/mjcf/mjcf_robots_test.cpp; change it there.
#include "scenes/makers.hpp"

namespace manyworlds::scenes {

Scene hopper() {
  Scene scene;
  scene.name = "hopper";
  scene.options.dt = 0.004;
  scene.options.substeps = 1;
  scene.options.gravity = Vec3(0, 0, -9.81);
  scene.options.length_unit = 0.51;
  scene.options.solver.method = Solver::newton;
  scene.options.solver.iterations = 100;
  scene.add(Body{
      .name = "world",
      .motion = Motion::fixed,
      .shapes = {Shape{
          .geometry = Plane{},
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0.8,
                                                                            .max_impedance = 0.9,
                                                                            .width = 0.01}}},
          .filter = Filter{.mask = 0x1},
          .name = "ground"}}});
  scene.add(Body{
      .name = "torso",
      .position = Vec3(0, 0, 1.17),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.06, .half_length = 0.2},
          .position = Vec3(0, 0, 0.05),
          .rotation = Quat(0, 1, 0, 0),
          .material = Material{.friction = 0.9,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0.8,
                                                                            .max_impedance = 0.9,
                                                                            .width = 0.01}}},
          .filter = Filter{.mask = 0x1},
          .name = "torso"}},
      .mass_properties =
          MassProperties{.mass = 4.88580489486285,
                         .center = Vec3(0, 0, 0.05),
                         .inertia = (Mat3() << 0.0990244078746591, 0, 0, 0, 0.0990244078746591, 0,
                                     0, 0, 0.00850130051706135)
                                        .finished()}});
  scene.add(Body{
      .name = "thigh",
      .position = Vec3(0, 0, 0.97),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.045, .half_length = 0.21},
          .position = Vec3(0, 0, -0.21),
          .material = Material{.friction = 0.9,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0.8,
                                                                            .max_impedance = 0.9,
                                                                            .width = 0.01}}},
          .filter = Filter{.mask = 0x1},
          .name = "thigh"}},
      .mass_properties =
          MassProperties{.mass = 2.74826525336035,
                         .center = Vec3(0, 0, -0.21),
                         .inertia = (Mat3() << 0.0544298227592476, 0, 0, 0, 0.0544298227592476, 0,
                                     0, 0, 0.00271305310480167)
                                        .finished()}});
  scene.add(Body{
      .name = "shin",
      .position = Vec3(0, 0, 0.55),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.035, .half_length = 0.225},
          .position = Vec3(0, 0, -0.225),
          .material = Material{.friction = 0.9,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0.8,
                                                                            .max_impedance = 0.9,
                                                                            .width = 0.01}}},
          .filter = Filter{.mask = 0x1},
          .name = "shin"}},
      .mass_properties =
          MassProperties{.mass = 1.72025759728943,
                         .center = Vec3(0, 0, -0.225),
                         .inertia = (Mat3() << 0.0359957119337925, 0, 0, 0, 0.0359957119337925, 0,
                                     0, 0, 0.00103385749794145)
                                        .finished()}});
  scene.add(Body{
      .name = "foot",
      .position = Vec3(0, 0, 0.0999999999999999),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.05, .half_length = 0.15},
                       .position = Vec3(0.03, 0, -0.03),
                       .rotation = Quat(0.707106781186548, 0, -0.707106781186547, 0),
                       .material = Material{.friction = 1.6,
                                            .soft = SoftContact{.compliance =
                                                                    Compliance{.min_impedance = 0.8,
                                                                               .max_impedance = 0.9,
                                                                               .width = 0.01},
                                                                .priority = 1}},
                       .filter = Filter{.mask = 0x1},
                       .name = "sole"},
                 Shape{.geometry = Sphere{.radius = 0.055},
                       .position = Vec3(0.24, 0, -0.025),
                       .material =
                           Material{
                               .friction = 0.9,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0.8,
                                                                            .max_impedance = 0.9,
                                                                            .width = 0.01},
                                                   .margin = 0.005}},
                       .filter = Filter{.mask = 0x1},
                       .name = "toe"}},
      .mass_properties = MassProperties{
          .mass = 3.21903291250078,
          .center = Vec3(0.0709178743961353, 0, -0.0290257648953301),
          .inertia = (Mat3() << 0.00389351783780658, 0, -0.000530257586114073, 0,
                      0.0539968838699945, 0, -0.000530257586114073, 0, 0.0539842586893727)
                         .finished()}});
  scene.add(Joint{.name = "forward",
                  .type = SliderJoint{},
                  .body_b = BodyId(1),
                  .frame_a = Frame{.position = Vec3(0, 0, 1.17)}});
  scene.add(Joint{.name = "height",
                  .type = SliderJoint{},
                  .body_b = BodyId(1),
                  .frame_a = Frame{.rotation = Quat(0.707106781186548, 0, -0.707106781186547, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, 0, -0.707106781186547, 0)},
                  .after = JointId(0),
                  .dynamics = JointDynamics{.reference = 1.17}});
  scene.add(Joint{.name = "pitch",
                  .body_b = BodyId(1),
                  .frame_a = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .after = JointId(1)});
  scene.add(
      Joint{.name = "hip",
            .type = HingeJoint{.limit = Limit{.low = -2.2,
                                              .high = 0.3,
                                              .compliance = Compliance{.time_constant = 0.03}}},
            .body_a = BodyId(1),
            .body_b = BodyId(2),
            .frame_a = Frame{.position = Vec3(0, 0, -0.2),
                             .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
            .frame_b = Frame{.rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
            .dynamics = JointDynamics{.armature = 0.5, .damping = 0.8}});
  scene.add(Joint{
      .name = "knee",
      .type = HingeJoint{.limit = Limit{.low = -2.4,
                                        .high = -0.02,
                                        .compliance = Compliance{.time_constant = 0.03},
                                        .margin = 0.02}},
      .body_a = BodyId(2),
      .body_b = BodyId(3),
      .frame_a = Frame{.position = Vec3(0, 0, -0.42),
                       .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
      .frame_b = Frame{.rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
      .dynamics = JointDynamics{.armature = 0.5, .damping = 0.8, .stiffness = 2, .rest = -0.6}});
  scene.add(
      Joint{.name = "ankle",
            .type = HingeJoint{.limit = Limit{.low = -0.8,
                                              .high = 0.8,
                                              .compliance = Compliance{.time_constant = 0.03}}},
            .body_a = BodyId(3),
            .body_b = BodyId(4),
            .frame_a = Frame{.position = Vec3(0, 0, -0.45),
                             .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
            .frame_b = Frame{.rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
            .dynamics = JointDynamics{.armature = 0.5, .damping = 0.8, .stiffness = 6}});
  scene.add(Control{.name = "hip",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(3),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "knee",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(4),
                    .actuator = Actuator{.gear = 110}});
  scene.add(Control{.name = "ankle",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(5),
                    .actuator = Actuator{.gear = 70}});
  scene.exclusions = {Exclusion{.body_a = BodyId(1), .body_b = BodyId(3)}};
  return scene;
}

}  // namespace manyworlds::scenes
