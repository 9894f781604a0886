// Made from scenes/mjcf/robot_ant.xml by tests/mjcf/mjcf_robots_test.cpp; change it there.
#include "scenes/makers.hpp"

namespace manyworlds::scenes {

Scene ant() {
  Scene scene;
  scene.name = "ant";
  scene.options.dt = 0.01;
  scene.options.substeps = 1;
  scene.options.gravity = Vec3(0, 0, -9.81);
  scene.options.length_unit = 0.42;
  scene.options.solver.method = Solver::newton;
  scene.options.solver.iterations = 100;
  scene.add(Body{
      .name = "world",
      .motion = Motion::fixed,
      .shapes = {Shape{.geometry = Plane{},
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "ground"}}});
  scene.add(Body{
      .name = "trunk",
      .position = Vec3(0, 0, 0.75),
      .shapes = {Shape{.geometry = Sphere{.radius = 0.24},
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "trunk"},
                 Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(0.1, 0.1, 0),
                       .rotation = Quat(0.707106781186548, 0.5, -0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "hip_fl"},
                 Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(-0.1, 0.1, 0),
                       .rotation = Quat(0.707106781186548, 0.5, 0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "hip_hl"},
                 Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(-0.1, -0.1, 0),
                       .rotation = Quat(0.707106781186548, -0.5, 0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "hip_hr"},
                 Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(0.1, -0.1, 0),
                       .rotation = Quat(0.707106781186548, -0.5, -0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "hip_fr"}},
      .mass_properties = MassProperties{.mass = 0.486413742417089,
                                        .inertia = (Mat3() << 0.0104754390635944, 0, 0, 0,
                                                    0.0104754390635944, 0, 0, 0, 0.012622373743924)
                                                       .finished()}});
  scene.add(Body{
      .name = "leg_fl",
      .position = Vec3(0.2, 0.2, 0.75),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(0.1, 0.1, 0),
                       .rotation = Quat(0.707106781186548, 0.5, -0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "leg_fl"}},
      .mass_properties = MassProperties{
          .mass = 0.0347446819178216,
          .center = Vec3(0.1, 0.1, 0),
          .inertia = (Mat3() << 0.000270187261784538, -0.000189286850904185, 0,
                      -0.000189286850904185, 0.000270187261784538, 0, 0, 0, 0.000459474112688723)
                         .finished()}});
  scene.add(Body{
      .name = "shin_fl",
      .position = Vec3(0.4, 0.4, 0.75),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.07, .half_length = 0.275},
          .position = Vec3(0.15, 0.15, -0.175),
          .rotation = Quat(0.904534033733291, 0.301511344577764, -0.301511344577764, 0),
          .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
          .filter = Filter{.mask = 0x1},
          .name = "shin_fl"}},
      .mass_properties = MassProperties{
          .mass = 0.0594200834499974,
          .center = Vec3(0.15, 0.15, -0.175),
          .inertia = (Mat3() << 0.00154261113988812, -0.000593473127401669, 0.000692385315301948,
                      -0.000593473127401669, 0.00154261113988812, 0.000692385315301948,
                      0.000692385315301948, 0.000692385315301948, 0.00132830139943752)
                         .finished()}});
  scene.add(Body{
      .name = "leg_hl",
      .position = Vec3(-0.2, 0.2, 0.75),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(-0.1, 0.1, 0),
                       .rotation = Quat(0.707106781186548, 0.5, 0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "leg_hl"}},
      .mass_properties = MassProperties{
          .mass = 0.0347446819178216,
          .center = Vec3(-0.1, 0.1, 0),
          .inertia = (Mat3() << 0.000270187261784538, 0.000189286850904185, 0, 0.000189286850904185,
                      0.000270187261784538, 0, 0, 0, 0.000459474112688723)
                         .finished()}});
  scene.add(Body{
      .name = "shin_hl",
      .position = Vec3(-0.4, 0.4, 0.75),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.275},
                       .position = Vec3(-0.15, 0.15, -0.175),
                       .rotation = Quat(0.904534033733291, 0.301511344577764, 0.301511344577764, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "shin_hl"}},
      .mass_properties = MassProperties{
          .mass = 0.0594200834499974,
          .center = Vec3(-0.15, 0.15, -0.175),
          .inertia = (Mat3() << 0.00154261113988812, 0.000593473127401669, -0.000692385315301948,
                      0.000593473127401669, 0.00154261113988812, 0.000692385315301948,
                      -0.000692385315301948, 0.000692385315301948, 0.00132830139943752)
                         .finished()}});
  scene.add(Body{
      .name = "leg_hr",
      .position = Vec3(-0.2, -0.2, 0.75),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(-0.1, -0.1, 0),
                       .rotation = Quat(0.707106781186548, -0.5, 0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "leg_hr"}},
      .mass_properties = MassProperties{
          .mass = 0.0347446819178216,
          .center = Vec3(-0.1, -0.1, 0),
          .inertia = (Mat3() << 0.000270187261784538, -0.000189286850904185, 0,
                      -0.000189286850904185, 0.000270187261784538, 0, 0, 0, 0.000459474112688723)
                         .finished()}});
  scene.add(Body{
      .name = "shin_hr",
      .position = Vec3(-0.4, -0.4, 0.75),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.07, .half_length = 0.275},
          .position = Vec3(-0.15, -0.15, -0.175),
          .rotation = Quat(0.904534033733291, -0.301511344577764, 0.301511344577764, 0),
          .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
          .filter = Filter{.mask = 0x1},
          .name = "shin_hr"}},
      .mass_properties = MassProperties{
          .mass = 0.0594200834499974,
          .center = Vec3(-0.15, -0.15, -0.175),
          .inertia = (Mat3() << 0.00154261113988812, -0.000593473127401669, -0.000692385315301948,
                      -0.000593473127401669, 0.00154261113988812, -0.000692385315301948,
                      -0.000692385315301948, -0.000692385315301948, 0.00132830139943752)
                         .finished()}});
  scene.add(Body{
      .name = "leg_fr",
      .position = Vec3(0.2, -0.2, 0.75),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.07, .half_length = 0.14142135623731},
                       .position = Vec3(0.1, -0.1, 0),
                       .rotation = Quat(0.707106781186548, -0.5, -0.5, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "leg_fr"}},
      .mass_properties = MassProperties{
          .mass = 0.0347446819178216,
          .center = Vec3(0.1, -0.1, 0),
          .inertia = (Mat3() << 0.000270187261784538, 0.000189286850904185, 0, 0.000189286850904185,
                      0.000270187261784538, 0, 0, 0, 0.000459474112688723)
                         .finished()}});
  scene.add(Body{
      .name = "shin_fr",
      .position = Vec3(0.4, -0.4, 0.75),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.07, .half_length = 0.275},
          .position = Vec3(0.15, -0.15, -0.175),
          .rotation = Quat(0.904534033733291, -0.301511344577764, -0.301511344577764, 0),
          .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
          .filter = Filter{.mask = 0x1},
          .name = "shin_fr"}},
      .mass_properties = MassProperties{
          .mass = 0.0594200834499974,
          .center = Vec3(0.15, -0.15, -0.175),
          .inertia = (Mat3() << 0.00154261113988812, 0.000593473127401669, 0.000692385315301948,
                      0.000593473127401669, 0.00154261113988812, -0.000692385315301948,
                      0.000692385315301948, -0.000692385315301948, 0.00132830139943752)
                         .finished()}});
  scene.add(Body{
      .name = "tail",
      .position = Vec3(-0.26, 0, 0.8),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.04, .half_length = 0.190394327646598},
                       .position = Vec3(-0.225, 0, 0.075),
                       .rotation = Quat(0.550491008746207, 0, 0.834841092238268, 0),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.mask = 0x1},
                       .name = "tail"},
                 Shape{.geometry = Ellipsoid{.radii = Vec3(0.08, 0.05, 0.05)},
                       .position = Vec3(-0.42, 0, 0.15),
                       .material = Material{.friction = 1, .soft = SoftContact{.margin = 0.01}},
                       .filter = Filter{.category = 0x0, .mask = 0x0},
                       .name = "tuft"}},
      .mass_properties = MassProperties{
          .mass = 0.0181193589679603,
          .center = Vec3(-0.279095562081044, 0, 0.0958059854157862),
          .inertia = (Mat3() << 6.69677972920658e-05, 0, 0.000126138349302467, 0,
                      0.000379376579067616, 0, 0.000126138349302467, 0, 0.000327652219328886)
                         .finished()}});
  scene.add(Joint{.name = "hip_fl",
                  .type = HingeJoint{.limit = Limit{.low = -0.6, .high = 0.6}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(2),
                  .frame_a = Frame{.position = Vec3(0.2, 0.2, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9}});
  scene.add(Joint{.name = "knee_fl",
                  .type = HingeJoint{.limit = Limit{.low = 0.5, .high = 1.3}},
                  .body_a = BodyId(2),
                  .body_b = BodyId(3),
                  .frame_a = Frame{.position = Vec3(0.2, 0.2, 0),
                                   .rotation = Quat(0.707106781186548, -0.5, -0.5, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.5, -0.5, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9, .reference = 0.6}});
  scene.add(Joint{.name = "hip_hl",
                  .type = HingeJoint{.limit = Limit{.low = -0.6, .high = 0.6}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(4),
                  .frame_a = Frame{.position = Vec3(-0.2, 0.2, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9}});
  scene.add(Joint{.name = "knee_hl",
                  .type = HingeJoint{.limit = Limit{.low = 0.5, .high = 1.3}},
                  .body_a = BodyId(4),
                  .body_b = BodyId(5),
                  .frame_a = Frame{.position = Vec3(-0.2, 0.2, 0),
                                   .rotation = Quat(0.707106781186548, 0.5, -0.5, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, 0.5, -0.5, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9, .reference = 0.6}});
  scene.add(Joint{.name = "hip_hr",
                  .type = HingeJoint{.limit = Limit{.low = -0.6, .high = 0.6}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(6),
                  .frame_a = Frame{.position = Vec3(-0.2, -0.2, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9}});
  scene.add(Joint{.name = "knee_hr",
                  .type = HingeJoint{.limit = Limit{.low = 0.5, .high = 1.3}},
                  .body_a = BodyId(6),
                  .body_b = BodyId(7),
                  .frame_a = Frame{.position = Vec3(-0.2, -0.2, 0),
                                   .rotation = Quat(0.707106781186548, 0.5, 0.5, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, 0.5, 0.5, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9, .reference = 0.6}});
  scene.add(Joint{.name = "hip_fr",
                  .type = HingeJoint{.limit = Limit{.low = -0.6, .high = 0.6}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(8),
                  .frame_a = Frame{.position = Vec3(0.2, -0.2, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9}});
  scene.add(Joint{.name = "knee_fr",
                  .type = HingeJoint{.limit = Limit{.low = 0.5, .high = 1.3}},
                  .body_a = BodyId(8),
                  .body_b = BodyId(9),
                  .frame_a = Frame{.position = Vec3(0.2, -0.2, 0),
                                   .rotation = Quat(0.707106781186548, -0.5, 0.5, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.5, 0.5, 0)},
                  .dynamics = JointDynamics{.armature = 0.8, .damping = 0.9, .reference = 0.6}});
  scene.add(Joint{.name = "tail",
                  .type = BallJoint{},
                  .body_a = BodyId(1),
                  .body_b = BodyId(10),
                  .frame_a = Frame{.position = Vec3(-0.26, 0, 0.05)},
                  .dynamics = JointDynamics{.armature = 0.05, .damping = 0.2}});
  scene.add(Control{.name = "hip_fl",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(0),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "knee_fl",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(1),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "hip_hl",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(2),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "knee_hl",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(3),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "hip_hr",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(4),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "knee_hr",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(5),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "hip_fr",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(6),
                    .actuator = Actuator{.gear = 120}});
  scene.add(Control{.name = "knee_fr",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(7),
                    .actuator = Actuator{.gear = 120}});
  return scene;
}

}  // namespace manyworlds::scenes
