// Made from scenes/mjcf/robot_humanoid.xml by tests/mjcf/mjcf_robots_test.cpp; change it there.
// This file has over 400 lines because a program wrote it, a line per number.
#include "scenes/makers.hpp"

namespace manyworlds::scenes {

Scene humanoid() {
  Scene scene;
  scene.name = "humanoid";
  scene.options.dt = 0.005;
  scene.options.substeps = 1;
  scene.options.gravity = Vec3(0, 0, -9.81);
  scene.options.length_unit = 0.25;
  scene.options.solver.method = Solver::newton;
  scene.options.solver.iterations = 100;
  scene.add(Body{
      .name = "world",
      .motion = Motion::fixed,
      .shapes = {Shape{
          .geometry = Plane{},
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "ground"}}});
  scene.add(Body{.name = "chest",
                 .position = Vec3(0, 0, 1.32),
                 .shapes = {Shape{
                                .geometry = Capsule{.radius = 0.075, .half_length = 0.08},
                                .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0),
                                .material = Material{.friction = 0.7,
                                                     .soft = SoftContact{.dimensions = 1,
                                                                         .compliance =
                                                                             Compliance{
                                                                                 .time_constant = 0.015, .max_impedance = 0.99, .width = 0.003}}},
                                .filter = Filter{.mask = 0x1},
                                .name = "chest"},
                            Shape{
                                .geometry = Sphere{.radius = 0.095},
                                .position = Vec3(0, 0, 0.2),
                                .material = Material{.friction = 0.7,
                                                     .soft = SoftContact{.dimensions = 1,
                                                                         .compliance = Compliance{.time_constant =
                                                                                                      0.015,
                                                                                                  .max_impedance = 0.99,
                                                                                                  .width = 0.003}}},
                                .filter = Filter{.mask = 0x1},
                                .name = "head"},
                            Shape{
                                .geometry = Capsule{.radius = 0.065, .half_length = 0.06},
                                .position = Vec3(-0.01, 0, -0.12),
                                .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0),
                                .material = Material{.friction = 0.7,
                                                     .soft = SoftContact{.dimensions = 1,
                                                                         .compliance = Compliance{.time_constant =
                                                                                                      0.015,
                                                                                                  .max_impedance = 0.99,
                                                                                                  .width = 0.003}}},
                                .filter = Filter{.mask = 0x1},
                                .name = "belly"},
                            Shape{
                                .geometry = Cylinder{.radius = 0.06, .half_length = 0.1},
                                .position = Vec3(-0.1, 0, -0.02),
                                .material = Material{.friction = 0.7,
                                                     .soft = SoftContact{.dimensions = 1,
                                                                         .compliance = Compliance{.time_constant =
                                                                                                      0.015,
                                                                                                  .max_impedance = 0.99,
                                                                                                  .width = 0.003}}},
                                .filter = Filter{.category = 0x0, .mask = 0x0},
                                .name = "satchel"}},
                 .mass_properties = MassProperties{
                     .mass = 12.5314727559655,
                     .center = Vec3(-0.0192271662763466, 0, 0.0260675584487755),
                     .inertia = (Mat3() << 0.231730708134632, 0, -0.0137057118138215, 0,
                                 0.221247103968257, 0, -0.0137057118138215, 0, 0.0772761603875196)
                                    .finished()}});
  scene.add(Body{
      .name = "waist",
      .position = Vec3(-0.01, 0, 1.08),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.065, .half_length = 0.06},
          .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "waist"}},
      .mass_properties = MassProperties{.mass = 2.60597728609151,
                                        .inertia = (Mat3() << 0.0123916321548237, 0, 0, 0,
                                                    0.0050434066864213, 0, 0, 0, 0.0123916321548237)
                                                       .finished()}});
  scene.add(Body{
      .name = "pelvis",
      .position = Vec3(-0.01, 0, 0.93),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.085, .half_length = 0.07},
          .position = Vec3(-0.02, 0, 0),
          .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "seat"}},
      .mass_properties = MassProperties{.mass = 5.46265366593949,
                                        .center = Vec3(-0.02, 0, 0),
                                        .inertia = (Mat3() << 0.0403264234558051, 0, 0, 0,
                                                    0.0179681773247353, 0, 0, 0, 0.0403264234558051)
                                                       .finished()}});
  scene.add(Body{
      .name = "thigh_right",
      .position = Vec3(-0.01, -0.1, 0.89),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.058, .half_length = 0.170073513516949},
          .position = Vec3(0, 0.005, -0.17),
          .rotation = Quat(0.999891932776826, 0.014701114509569, 0, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "thigh_right"}},
      .mass_properties = MassProperties{
          .mass = 4.19146182249347,
          .center = Vec3(0, 0.005, -0.17),
          .inertia = (Mat3() << 0.0650455278859889, 0, 0, 0, 0.0649951763937879,
                      0.00171195073483573, 0, 0.00171195073483573, 0.00683920290157392)
                         .finished()}});
  scene.add(Body{
      .name = "shin_right",
      .position = Vec3(-0.01, -0.09, 0.49),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.047, .half_length = 0.15},
          .position = Vec3(0, 0, -0.15),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "shin_right"}},
      .mass_properties =
          MassProperties{.mass = 2.39098490611722,
                         .center = Vec3(0, 0, -0.15),
                         .inertia = (Mat3() << 0.0277714474719745, 0, 0, 0, 0.0277714474719745, 0,
                                     0, 0, 0.00254957840751683)
                                        .finished()}});
  scene.add(Body{
      .name = "foot_right",
      .position = Vec3(-0.01, -0.09, 0.0999999999999999),
      .shapes = {Shape{.geometry = Sphere{.radius = 0.035},
                       .position = Vec3(-0.06, 0, 0),
                       .material =
                           Material{.friction = 1,
                                    .soft = SoftContact{.compliance =
                                                            Compliance{.time_constant = 0.015,
                                                                       .max_impedance = 0.99,
                                                                       .width = 0.003},
                                                        .priority = 1}},
                       .filter = Filter{.mask = 0x1},
                       .name = "heel_right"},
                 Shape{.geometry = Sphere{.radius = 0.035},
                       .position = Vec3(0.12, 0.03, 0),
                       .material =
                           Material{.friction = 1,
                                    .soft = SoftContact{.compliance = Compliance{.time_constant = 0.015,
                                                                                 .max_impedance = 0.99,
                                                                                 .width = 0.003},
                                                        .priority = 1}},
                       .filter = Filter{.mask = 0x1},
                       .name = "toe_in_right"},
                 Shape{.geometry = Sphere{.radius = 0.035},
                       .position = Vec3(0.11, -0.04, 0),
                       .material =
                           Material{
                               .friction = 1,
                               .soft = SoftContact{.compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003},
                                                   .priority = 1}},
                       .filter = Filter{.mask = 0x1},
                       .name = "toe_out_right"}},
      .mass_properties = MassProperties{
          .mass = 0.511843983086117,
          .center = Vec3(0.0566666666666667, -0.00333333333333333, 0),
          .inertia = (Mat3() << 0.000671653048916344, 3.98100875733649e-05, 0, 3.98100875733649e-05,
                      0.00374271694743311, 0, 0, 0, 0.00416356644463722)
                         .finished()}});
  scene.add(Body{
      .name = "thigh_left",
      .position = Vec3(-0.01, 0.1, 0.89),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.058, .half_length = 0.170073513516949},
          .position = Vec3(0, -0.005, -0.17),
          .rotation = Quat(0.999891932776826, -0.014701114509569, 0, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "thigh_left"}},
      .mass_properties = MassProperties{
          .mass = 4.19146182249347,
          .center = Vec3(0, -0.005, -0.17),
          .inertia = (Mat3() << 0.0650455278859889, 0, 0, 0, 0.0649951763937879,
                      -0.00171195073483573, 0, -0.00171195073483573, 0.00683920290157392)
                         .finished()}});
  scene.add(Body{
      .name = "shin_left",
      .position = Vec3(-0.01, 0.09, 0.49),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.047, .half_length = 0.15},
          .position = Vec3(0, 0, -0.15),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "shin_left"}},
      .mass_properties =
          MassProperties{.mass = 2.39098490611722,
                         .center = Vec3(0, 0, -0.15),
                         .inertia = (Mat3() << 0.0277714474719745, 0, 0, 0, 0.0277714474719745, 0,
                                     0, 0, 0.00254957840751683)
                                        .finished()}});
  scene.add(Body{
      .name = "foot_left",
      .position = Vec3(-0.01, 0.09, 0.0999999999999999),
      .shapes = {Shape{.geometry = Sphere{.radius = 0.035},
                       .position = Vec3(-0.06, 0, 0),
                       .material =
                           Material{
                               .friction = 1,
                               .soft = SoftContact{.compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003},
                                                   .priority = 1}},
                       .filter = Filter{.mask = 0x1},
                       .name = "heel_left"},
                 Shape{.geometry = Sphere{.radius = 0.035},
                       .position = Vec3(0.12, -0.03, 0),
                       .material =
                           Material{.friction = 1,
                                    .soft = SoftContact{.compliance = Compliance{.time_constant = 0.015,
                                                                                 .max_impedance = 0.99,
                                                                                 .width = 0.003},
                                                        .priority = 1}},
                       .filter = Filter{.mask = 0x1},
                       .name = "toe_in_left"},
                 Shape{.geometry = Sphere{.radius = 0.035},
                       .position = Vec3(0.11, 0.04, 0),
                       .material =
                           Material{
                               .friction = 1,
                               .soft = SoftContact{.compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003},
                                                   .priority = 1}},
                       .filter = Filter{.mask = 0x1},
                       .name = "toe_out_left"}},
      .mass_properties = MassProperties{
          .mass = 0.511843983086117,
          .center = Vec3(0.0566666666666667, 0.00333333333333333, 0),
          .inertia = (Mat3() << 0.000671653048916344, -3.98100875733649e-05, 0,
                      -3.98100875733649e-05, 0.00374271694743311, 0, 0, 0, 0.00416356644463722)
                         .finished()}});
  scene.add(Body{
      .name = "arm_right",
      .position = Vec3(0, -0.18, 1.37),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.04, .half_length = 0.124197423483742},
          .position = Vec3(0.07, -0.07, -0.075),
          .rotation = Quat(0.895510262831017, -0.314691411675249, -0.314691411675249, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "arm_right"}},
      .mass_properties = MassProperties{
          .mass = 1.44081869261338,
          .center = Vec3(0.07, -0.07, -0.075),
          .inertia = (Mat3() << 0.00827750986951774, 0.00333600541435079, 0.00357429151537585,
                      0.00333600541435079, 0.00827750986951774, -0.00357429151537585,
                      0.00357429151537585, -0.00357429151537585, 0.00778391723168012)
                         .finished()}});
  scene.add(Body{
      .name = "forearm_right",
      .position = Vec3(0.17, -0.35, 1.19),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.032, .half_length = 0.121243556529821},
          .position = Vec3(0.08, 0.08, 0.08),
          .rotation = Quat(0.459700843380983, 0.627963030199554, -0.627963030199554, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "forearm_right"}},
      .mass_properties = MassProperties{
          .mass = 0.871470252600278,
          .center = Vec3(0.08, 0.08, 0.08),
          .inertia = (Mat3() << 0.00425803626557848, -0.00191259799073778, -0.00191259799073778,
                      -0.00191259799073778, 0.00425803626557848, -0.00191259799073778,
                      -0.00191259799073778, -0.00191259799073778, 0.00425803626557848)
                         .finished()}});
  scene.add(Body{
      .name = "hand_right",
      .position = Vec3(0.35, -0.17, 1.37),
      .shapes = {Shape{
          .geometry = Sphere{.radius = 0.04},
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003},
                                                   .margin = 0.004,
                                                   .gap = 0.002,
                                                   .weight = 2}},
          .filter = Filter{.mask = 0x1},
          .name = "hand_right"}},
      .mass_properties =
          MassProperties{.mass = 0.254678444451013,
                         .inertia = (Mat3() << 0.000162994204448648, 0, 0, 0, 0.000162994204448648,
                                     0, 0, 0, 0.000162994204448648)
                                        .finished()}});
  scene.add(Body{
      .name = "arm_left",
      .position = Vec3(0, 0.18, 1.37),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.04, .half_length = 0.124197423483742},
          .position = Vec3(0.07, 0.07, -0.075),
          .rotation = Quat(0.895510262831017, 0.314691411675249, -0.314691411675249, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "arm_left"}},
      .mass_properties = MassProperties{
          .mass = 1.44081869261338,
          .center = Vec3(0.07, 0.07, -0.075),
          .inertia = (Mat3() << 0.00827750986951774, -0.00333600541435079, 0.00357429151537585,
                      -0.00333600541435079, 0.00827750986951774, 0.00357429151537585,
                      0.00357429151537585, 0.00357429151537585, 0.00778391723168012)
                         .finished()}});
  scene.add(Body{
      .name = "forearm_left",
      .position = Vec3(0.17, 0.35, 1.19),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.032, .half_length = 0.121243556529821},
          .position = Vec3(0.08, -0.08, 0.08),
          .rotation = Quat(0.459700843380983, -0.627963030199554, -0.627963030199554, 0),
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003}}},
          .filter = Filter{.mask = 0x1},
          .name = "forearm_left"}},
      .mass_properties = MassProperties{
          .mass = 0.871470252600278,
          .center = Vec3(0.08, -0.08, 0.08),
          .inertia = (Mat3() << 0.00425803626557848, 0.00191259799073778, -0.00191259799073778,
                      0.00191259799073778, 0.00425803626557848, 0.00191259799073778,
                      -0.00191259799073778, 0.00191259799073778, 0.00425803626557848)
                         .finished()}});
  scene.add(Body{
      .name = "hand_left",
      .position = Vec3(0.35, 0.17, 1.37),
      .shapes = {Shape{
          .geometry = Sphere{.radius = 0.04},
          .material = Material{.friction = 0.7,
                               .soft = SoftContact{.dimensions = 1,
                                                   .compliance = Compliance{.time_constant = 0.015,
                                                                            .max_impedance = 0.99,
                                                                            .width = 0.003},
                                                   .margin = 0.004,
                                                   .gap = 0.002,
                                                   .weight = 2}},
          .filter = Filter{.mask = 0x1},
          .name = "hand_left"}},
      .mass_properties =
          MassProperties{.mass = 0.254678444451013,
                         .inertia = (Mat3() << 0.000162994204448648, 0, 0, 0, 0.000162994204448648,
                                     0, 0, 0, 0.000162994204448648)
                                        .finished()}});
  scene.add(Joint{.name = "waist_z",
                  .type = HingeJoint{.limit = Limit{.low = -0.785398163397448,
                                                    .high = 0.785398163397448,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(2),
                  .frame_a = Frame{.position = Vec3(-0.01, 0, -0.18)},
                  .frame_b = Frame{.position = Vec3(0, 0, 0.06)},
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "waist_y",
                  .type = HingeJoint{.limit = Limit{.low = -1.22173047639603,
                                                    .high = 0.523598775598299,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(2),
                  .frame_a = Frame{.position = Vec3(0, 0, 0.06),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.position = Vec3(0, 0, 0.06),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .after = JointId(0),
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "waist_x",
                  .type = HingeJoint{.limit = Limit{.low = -0.610865238198015,
                                                    .high = 0.610865238198015,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(2),
                  .body_b = BodyId(3),
                  .frame_a = Frame{.position = Vec3(0, 0, -0.06),
                                   .rotation = Quat(0.707106781186548, 0, 0.707106781186547, 0)},
                  .frame_b = Frame{.position = Vec3(0, 0, 0.09),
                                   .rotation = Quat(0.707106781186548, 0, 0.707106781186547, 0)},
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "hip_x_right",
                  .type = HingeJoint{.limit = Limit{.low = -0.349065850398866,
                                                    .high = 0.610865238198015,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(3),
                  .body_b = BodyId(4),
                  .frame_a = Frame{.position = Vec3(0, -0.1, -0.04),
                                   .rotation = Quat(0.707106781186548, 0, -0.707106781186547, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, 0, -0.707106781186547, 0)},
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "hip_z_right",
                  .type = HingeJoint{.limit = Limit{.low = -0.610865238198015,
                                                    .high = 0.872664625997165,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(3),
                  .body_b = BodyId(4),
                  .frame_a = Frame{.rotation = Quat(0, -1, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0, -1, 0, 0)},
                  .after = JointId(3),
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "hip_y_right",
                  .type = HingeJoint{.limit = Limit{.low = -2.00712863979348,
                                                    .high = 0.436332312998582,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(3),
                  .body_b = BodyId(4),
                  .frame_a = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .after = JointId(4),
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "knee_right",
                  .type = HingeJoint{.limit = Limit{.low = -2.70526034059121,
                                                    .high = 0.0349065850398866,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(4),
                  .body_b = BodyId(5),
                  .frame_a = Frame{.position = Vec3(0, 0.01, -0.38),
                                   .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
                  .frame_b = Frame{.position = Vec3(0, 0, 0.02),
                                   .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 2}});
  scene.add(Joint{.name = "ankle_y_right",
                  .type = HingeJoint{.limit = Limit{.low = -0.872664625997165,
                                                    .high = 0.872664625997165,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(5),
                  .body_b = BodyId(6),
                  .frame_a = Frame{.position = Vec3(0, 0, -0.32),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.position = Vec3(0, 0, 0.07),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 6}});
  scene.add(
      Joint{.name = "ankle_x_right",
            .type = HingeJoint{.limit = Limit{.low = -0.785398163397448,
                                              .high = 0.785398163397448,
                                              .compliance = Compliance{.min_impedance = 0,
                                                                       .max_impedance = 0.99,
                                                                       .width = 0.01}}},
            .body_a = BodyId(5),
            .body_b = BodyId(6),
            .frame_a = Frame{.position = Vec3(0, 0, 0.07),
                             .rotation = Quat(0.828067230469273, 0, 0.560628809305184, 0)},
            .frame_b = Frame{.position = Vec3(0, 0, 0.07),
                             .rotation = Quat(0.828067230469273, 0, 0.560628809305184, 0)},
            .after = JointId(7),
            .dynamics = JointDynamics{
                .armature = 0.01, .damping = 1.5, .stiffness = 4, .rest = 0.0872664625997165}});
  scene.add(Joint{.name = "hip_x_left",
                  .type = HingeJoint{.limit = Limit{.low = -0.349065850398866,
                                                    .high = 0.610865238198015,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(3),
                  .body_b = BodyId(7),
                  .frame_a = Frame{.position = Vec3(0, 0.1, -0.04),
                                   .rotation = Quat(0.707106781186548, 0, 0.707106781186547, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, 0, 0.707106781186547, 0)},
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "hip_z_left",
                  .type = HingeJoint{.limit = Limit{.low = -0.610865238198015,
                                                    .high = 0.872664625997165,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(3),
                  .body_b = BodyId(7),
                  .after = JointId(9),
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "hip_y_left",
                  .type = HingeJoint{.limit = Limit{.low = -2.00712863979348,
                                                    .high = 0.436332312998582,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(3),
                  .body_b = BodyId(7),
                  .frame_a = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .after = JointId(10),
                  .dynamics = JointDynamics{.armature = 0.02, .damping = 5, .stiffness = 12}});
  scene.add(Joint{.name = "knee_left",
                  .type = HingeJoint{.limit = Limit{.low = -2.70526034059121,
                                                    .high = 0.0349065850398866,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(7),
                  .body_b = BodyId(8),
                  .frame_a = Frame{.position = Vec3(0, -0.01, -0.38),
                                   .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
                  .frame_b = Frame{.position = Vec3(0, 0, 0.02),
                                   .rotation = Quat(0.707106781186548, 0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 2}});
  scene.add(Joint{.name = "ankle_y_left",
                  .type = HingeJoint{.limit = Limit{.low = -0.872664625997165,
                                                    .high = 0.872664625997165,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(8),
                  .body_b = BodyId(9),
                  .frame_a = Frame{.position = Vec3(0, 0, -0.32),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.position = Vec3(0, 0, 0.07),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 6}});
  scene.add(
      Joint{.name = "ankle_x_left",
            .type = HingeJoint{.limit = Limit{.low = -0.785398163397448,
                                              .high = 0.785398163397448,
                                              .compliance = Compliance{.min_impedance = 0,
                                                                       .max_impedance = 0.99,
                                                                       .width = 0.01}}},
            .body_a = BodyId(8),
            .body_b = BodyId(9),
            .frame_a = Frame{.position = Vec3(0, 0, 0.07),
                             .rotation = Quat(0.828067230469273, 0, 0.560628809305184, 0)},
            .frame_b = Frame{.position = Vec3(0, 0, 0.07),
                             .rotation = Quat(0.828067230469273, 0, 0.560628809305184, 0)},
            .after = JointId(13),
            .dynamics = JointDynamics{
                .armature = 0.01, .damping = 1.5, .stiffness = 4, .rest = 0.0872664625997165}});
  scene.add(Joint{
      .name = "shoulder_a_right",
      .type = HingeJoint{.limit = Limit{.low = -1.39626340159546,
                                        .high = 1.0471975511966,
                                        .compliance = Compliance{.min_impedance = 0,
                                                                 .max_impedance = 0.99,
                                                                 .width = 0.01}}},
      .body_a = BodyId(1),
      .body_b = BodyId(10),
      .frame_a =
          Frame{.position = Vec3(0, -0.18, 0.05),
                .rotation = Quat(0.839121055171381, -0.243259472484863, 0.486518944969726, 0)},
      .frame_b =
          Frame{.rotation = Quat(0.839121055171381, -0.243259472484863, 0.486518944969726, 0)},
      .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 2}});
  scene.add(Joint{.name = "shoulder_b_right",
                  .type = HingeJoint{.limit = Limit{.low = -1.39626340159546,
                                                    .high = 1.0471975511966,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(10),
                  .frame_a = Frame{.rotation = Quat(0.923879532511287, 0.38268343236509, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.923879532511287, 0.38268343236509, 0, 0)},
                  .after = JointId(15),
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 2}});
  scene.add(Joint{.name = "elbow_right",
                  .type = HingeJoint{.limit = Limit{.low = -1.48352986419518,
                                                    .high = 0.959931088596881,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01},
                                                    .margin = 1}},
                  .body_a = BodyId(10),
                  .body_b = BodyId(11),
                  .frame_a = Frame{.position = Vec3(0.17, -0.17, -0.18),
                                   .rotation = Quat(0.923879532511287, -0.38268343236509, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.923879532511287, -0.38268343236509, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5}});
  scene.add(Joint{.type = FixedJoint{},
                  .body_a = BodyId(11),
                  .body_b = BodyId(12),
                  .frame_a = Frame{.position = Vec3(0.18, 0.18, 0.18)}});
  scene.add(
      Joint{.name = "shoulder_a_left",
            .type = HingeJoint{.limit = Limit{.low = -1.39626340159546,
                                              .high = 1.0471975511966,
                                              .compliance = Compliance{.min_impedance = 0,
                                                                       .max_impedance = 0.99,
                                                                       .width = 0.01}}},
            .body_a = BodyId(1),
            .body_b = BodyId(13),
            .frame_a =
                Frame{.position = Vec3(0, 0.18, 0.05),
                      .rotation = Quat(0.839121055171381, 0.243259472484863, 0.486518944969726, 0)},
            .frame_b =
                Frame{.rotation = Quat(0.839121055171381, 0.243259472484863, 0.486518944969726, 0)},
            .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 2}});
  scene.add(Joint{.name = "shoulder_b_left",
                  .type = HingeJoint{.limit = Limit{.low = -1.39626340159546,
                                                    .high = 1.0471975511966,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01}}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(13),
                  .frame_a = Frame{.rotation = Quat(0.923879532511287, -0.38268343236509, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.923879532511287, -0.38268343236509, 0, 0)},
                  .after = JointId(19),
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5, .stiffness = 2}});
  scene.add(Joint{.name = "elbow_left",
                  .type = HingeJoint{.limit = Limit{.low = -1.48352986419518,
                                                    .high = 0.959931088596881,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.99,
                                                                             .width = 0.01},
                                                    .margin = 1}},
                  .body_a = BodyId(13),
                  .body_b = BodyId(14),
                  .frame_a = Frame{.position = Vec3(0.17, 0.17, -0.18),
                                   .rotation = Quat(0.923879532511287, 0.38268343236509, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.923879532511287, 0.38268343236509, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.01, .damping = 1.5}});
  scene.add(Joint{.type = FixedJoint{},
                  .body_a = BodyId(14),
                  .body_b = BodyId(15),
                  .frame_a = Frame{.position = Vec3(0.18, -0.18, 0.18)}});
  scene.add(Control{.name = "waist_z",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(0),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 40, .low = -40, .high = 40}});
  scene.add(Control{.name = "waist_y",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(1),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 40, .low = -40, .high = 40}});
  scene.add(Control{.name = "waist_x",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(2),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 40, .low = -40, .high = 40}});
  scene.add(Control{.name = "hip_x_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(3),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 40, .low = -40, .high = 40}});
  scene.add(Control{.name = "hip_z_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(4),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 40, .low = -40, .high = 40}});
  scene.add(Control{.name = "hip_y_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(5),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 110, .low = -40, .high = 40}});
  scene.add(Control{.name = "knee_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(6),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 70, .low = -40, .high = 40}});
  scene.add(Control{.name = "ankle_y_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(7),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 20, .low = -40, .high = 40}});
  scene.add(Control{.name = "ankle_x_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(8),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 20, .low = -40, .high = 40}});
  scene.add(Control{.name = "hip_x_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(9),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 40, .low = -40, .high = 40}});
  scene.add(Control{.name = "hip_z_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(10),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 40, .low = -40, .high = 40}});
  scene.add(Control{.name = "hip_y_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(11),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 110, .low = -40, .high = 40}});
  scene.add(Control{.name = "knee_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(12),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 70, .low = -40, .high = 40}});
  scene.add(Control{.name = "ankle_y_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(13),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 20, .low = -40, .high = 40}});
  scene.add(Control{.name = "ankle_x_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(14),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{.gear = 20, .low = -40, .high = 40}});
  scene.add(Control{.name = "shoulder_a_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(15),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{
                        .gain = Vec3(25, 0, 0), .bias = Vec3(0, -25, -1), .low = -40, .high = 40}});
  scene.add(Control{.name = "shoulder_b_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(16),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{
                        .gain = Vec3(25, 0, 0), .bias = Vec3(0, -25, -1), .low = -40, .high = 40}});
  scene.add(Control{.name = "elbow_right",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(17),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{
                        .gain = Vec3(25, 0, 0), .bias = Vec3(0, -25, -1), .low = -40, .high = 40}});
  scene.add(Control{.name = "shoulder_a_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(19),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{
                        .gain = Vec3(25, 0, 0), .bias = Vec3(0, -25, -1), .low = -40, .high = 40}});
  scene.add(Control{.name = "shoulder_b_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(20),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{
                        .gain = Vec3(25, 0, 0), .bias = Vec3(0, -25, -1), .low = -40, .high = 40}});
  scene.add(Control{.name = "elbow_left",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(21),
                    .low = -1.2,
                    .high = 1.2,
                    .actuator = Actuator{
                        .gain = Vec3(25, 0, 0), .bias = Vec3(0, -25, -1), .low = -40, .high = 40}});
  scene.exclusions = {Exclusion{.body_a = BodyId(1), .body_b = BodyId(3)},
                      Exclusion{.body_a = BodyId(1), .body_b = BodyId(11)},
                      Exclusion{.body_a = BodyId(1), .body_b = BodyId(14)},
                      Exclusion{.body_a = BodyId(2), .body_b = BodyId(4)},
                      Exclusion{.body_a = BodyId(2), .body_b = BodyId(7)},
                      Exclusion{.body_a = BodyId(10), .body_b = BodyId(12)},
                      Exclusion{.body_a = BodyId(13), .body_b = BodyId(15)}};
  return scene;
}

}  // namespace manyworlds::scenes
