// Made from scenes/mjcf/robot_cheetah.xml by tests/mjcf/mjcf_robots_test.cpp; change it there.
#include "scenes/makers.hpp"

namespace manyworlds::scenes {

Scene cheetah() {
  Scene scene;
  scene.name = "cheetah";
  scene.options.dt = 0.01;
  scene.options.substeps = 1;
  scene.options.gravity = Vec3(0, 0, -9.81);
  scene.options.length_unit = 0.38;
  scene.options.solver.method = Solver::newton;
  scene.options.solver.iterations = 100;
  scene.add(Body{
      .name = "world",
      .motion = Motion::fixed,
      .shapes = {Shape{
          .geometry = Plane{},
          .material = Material{.friction = 0.45,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0,
                                                                            .max_impedance = 0.8,
                                                                            .width = 0.01}}},
          .filter = Filter{.mask = 0x2},
          .name = "ground"}}});
  scene.add(Body{
      .name = "trunk",
      .position = Vec3(0, 0, 0.72),
      .shapes = {Shape{.geometry = Capsule{.radius = 0.05, .half_length = 0.490102030193714},
                       .position = Vec3(0.01, 0, 0.01),
                       .rotation = Quat(0.699855729896341, 0, -0.714284227273191, 0),
                       .material = Material{.friction = 0.45,
                                            .soft = SoftContact{.compliance =
                                                                    Compliance{.min_impedance = 0,
                                                                               .max_impedance = 0.8,
                                                                               .width = 0.01}}},
                       .filter = Filter{.category = 0x2, .mask = 0x1},
                       .name = "back"},
                 Shape{.geometry = Capsule{.radius = 0.05, .half_length = 0.14},
                       .position = Vec3(0.6, 0, 0.12),
                       .rotation = Quat(0.921060994002885, 0, 0.389418342308651, 0),
                       .material = Material{.friction = 0.45,
                                            .soft = SoftContact{.compliance =
                                                                    Compliance{.min_impedance = 0,
                                                                               .max_impedance = 0.8,
                                                                               .width = 0.01}}},
                       .filter = Filter{.category = 0x2, .mask = 0x1},
                       .name = "head"}},
      .mass_properties = MassProperties{
          .mass = 7.66137196757767,
          .center = Vec3(0.156772762794134, 0, 0.0373644134022962),
          .inertia = (Mat3() << 0.0357714298603927, -2.53200526582495e-15, -0.112686439367586,
                      -2.53200526582495e-15, 1.06620310002346, -2.78686435109426e-15,
                      -0.112686439367586, -2.78686435109426e-15, 1.03982512555108)
                         .finished()}});
  scene.add(Body{
      .name = "thigh_hind",
      .position = Vec3(-0.47, 0, 0.72),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.048, .half_length = 0.152069063257456},
          .position = Vec3(0.07, 0, -0.135),
          .rotation = Quat(0.971533460939182, 0, -0.236902372878651, 0),
          .material = Material{.friction = 0.45,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0,
                                                                            .max_impedance = 0.8,
                                                                            .width = 0.01}}},
          .filter = Filter{.category = 0x2, .mask = 0x1},
          .name = "thigh_hind"}},
      .mass_properties = MassProperties{
          .mass = 1.86526776645709,
          .center = Vec3(0.07, 0, -0.135),
          .inertia = (Mat3() << 0.0180450259256192, 0, 0.00828123327330528, 0, 0.0223389987339998,
                      0, 0.00828123327330528, 0, 0.00636804884976814)
                         .finished()}});
  scene.add(Body{
      .name = "shin_hind",
      .position = Vec3(-0.33, 0, 0.45),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.042, .half_length = 0.148660687473185},
          .position = Vec3(-0.1, 0, -0.11),
          .rotation = Quat(0.932721843154738, 0, 0.360596676776185, 0),
          .material = Material{.friction = 0.45,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0,
                                                                            .max_impedance = 0.8,
                                                                            .width = 0.01}}},
          .filter = Filter{.category = 0x2, .mask = 0x1},
          .name = "shin_hind"}},
      .mass_properties = MassProperties{
          .mass = 1.37061791895421,
          .center = Vec3(-0.1, 0, -0.11),
          .inertia = (Mat3() << 0.00872959126697018, 0, -0.00687184266647663, 0, 0.0149767209637671,
                      0, -0.00687184266647663, 0, 0.00741769403064283)
                         .finished()}});
  scene.add(Body{
      .name = "foot_hind",
      .position = Vec3(-0.53, 0, 0.23),
      .shapes = {Shape{
          .geometry = Box{.half_extents = Vec3(0.09, 0.05, 0.025)},
          .position = Vec3(0.06, 0, -0.07),
          .rotation = Quat(0.921060994002885, 0, 0.389418342308651, 0),
          .material = Material{.friction = 0.45,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0,
                                                                            .max_impedance = 0.8,
                                                                            .width = 0.01}}},
          .filter = Filter{.category = 0x2, .mask = 0x1},
          .name = "foot_hind"}},
      .mass_properties =
          MassProperties{.mass = 0.63,
                         .center = Vec3(0.06, 0, -0.07),
                         .inertia = (Mat3() << 0.00146404297506622, 0, 0.000784540331687201, 0,
                                     0.00183225, 0, 0.000784540331687201, 0, 0.00141820702493378)
                                        .finished()}});
  scene.add(Body{
      .name = "thigh_fore",
      .position = Vec3(0.48, 0, 0.72),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.045, .half_length = 0.143265487818944},
          .position = Vec3(-0.07, 0, -0.125),
          .rotation = Quat(0.967601678365049, 0, 0.252481666710952, 0),
          .material = Material{.friction = 0.45,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0,
                                                                            .max_impedance = 0.8,
                                                                            .width = 0.01}}},
          .filter = Filter{.category = 0x2, .mask = 0x1},
          .name = "thigh_fore"}},
      .mass_properties = MassProperties{
          .mass = 1.54317436965525,
          .center = Vec3(-0.07, 0, -0.125),
          .inertia = (Mat3() << 0.0128207311447088, 0, -0.0063349291978607, 0, 0.0163682914955108,
                      0, -0.0063349291978607, 0, 0.00505591792790241)
                         .finished()}});
  scene.add(Body{
      .name = "shin_fore",
      .position = Vec3(0.34, 0, 0.47),
      .shapes = {Shape{
          .geometry = Capsule{.radius = 0.04, .half_length = 0.109658560997307},
          .position = Vec3(0.045, 0, -0.1),
          .rotation = Quat(0.977732454502536, 0, -0.2098553011302, 0),
          .material = Material{.friction = 0.45,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0,
                                                                            .max_impedance = 0.8,
                                                                            .width = 0.01}}},
          .filter = Filter{.category = 0x2, .mask = 0x1},
          .name = "shin_fore"}},
      .mass_properties = MassProperties{
          .mass = 0.959343467550931,
          .center = Vec3(0.045, 0, -0.1),
          .inertia = (Mat3() << 0.00544300686894273, 0, 0.00211750080439045, 0, 0.00639588223091844,
                      0, 0.00211750080439045, 0, 0.00169032488782854)
                         .finished()}});
  scene.add(Body{
      .name = "foot_fore",
      .position = Vec3(0.43, 0, 0.27),
      .shapes = {Shape{
          .geometry = Box{.half_extents = Vec3(0.08, 0.05, 0.025)},
          .position = Vec3(0.02, 0, -0.07),
          .rotation = Quat(0.825335614909678, 0, 0.564642473395035, 0),
          .material = Material{.friction = 0.45,
                               .soft = SoftContact{.compliance = Compliance{.min_impedance = 0,
                                                                            .max_impedance = 0.8,
                                                                            .width = 0.01}}},
          .filter = Filter{.category = 0x2, .mask = 0x1},
          .name = "foot_fore"}},
      .mass_properties = MassProperties{
          .mass = 0.56,
          .center = Vec3(0.02, 0, -0.07),
          .inertia = (Mat3() << 0.00151978854601007, 0, 0.00036407465431707, 0, 0.00131133333333333,
                      0, 0.00036407465431707, 0, 0.000724878120656602)
                         .finished()}});
  scene.add(Joint{.name = "forward",
                  .type = SliderJoint{},
                  .body_b = BodyId(1),
                  .frame_a = Frame{.position = Vec3(0, 0, 0.72)}});
  scene.add(Joint{.name = "height",
                  .type = SliderJoint{},
                  .body_b = BodyId(1),
                  .frame_a = Frame{.rotation = Quat(0.707106781186548, 0, -0.707106781186547, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, 0, -0.707106781186547, 0)},
                  .after = JointId(0)});
  scene.add(Joint{.name = "pitch",
                  .body_b = BodyId(1),
                  .frame_a = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .after = JointId(1)});
  scene.add(Joint{.name = "hip_hind",
                  .type = HingeJoint{.limit = Limit{.low = -0.5,
                                                    .high = 1,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.8,
                                                                             .width = 0.03}}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(2),
                  .frame_a = Frame{.position = Vec3(-0.47, 0, 0),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.1, .damping = 6, .stiffness = 220}});
  scene.add(Joint{.name = "knee_hind",
                  .type = HingeJoint{.limit = Limit{.low = -0.75,
                                                    .high = 0.75,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.8,
                                                                             .width = 0.03}}},
                  .body_a = BodyId(2),
                  .body_b = BodyId(3),
                  .frame_a = Frame{.position = Vec3(0.14, 0, -0.27),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.1, .damping = 4.5, .stiffness = 170}});
  scene.add(Joint{.name = "ankle_hind",
                  .type = HingeJoint{.limit = Limit{.low = -0.4,
                                                    .high = 0.8,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.8,
                                                                             .width = 0.03}}},
                  .body_a = BodyId(3),
                  .body_b = BodyId(4),
                  .frame_a = Frame{.position = Vec3(-0.2, 0, -0.22),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.1, .damping = 3, .stiffness = 110}});
  scene.add(Joint{.name = "hip_fore",
                  .type = HingeJoint{.limit = Limit{.low = -1,
                                                    .high = 0.7,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.8,
                                                                             .width = 0.03}}},
                  .body_a = BodyId(1),
                  .body_b = BodyId(5),
                  .frame_a = Frame{.position = Vec3(0.48, 0, 0),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.1, .damping = 4.5, .stiffness = 170}});
  scene.add(Joint{.name = "knee_fore",
                  .type = HingeJoint{.limit = Limit{.low = -1.2,
                                                    .high = 0.85,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.8,
                                                                             .width = 0.03}}},
                  .body_a = BodyId(5),
                  .body_b = BodyId(6),
                  .frame_a = Frame{.position = Vec3(-0.14, 0, -0.25),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.1, .damping = 3, .stiffness = 120}});
  scene.add(Joint{.name = "ankle_fore",
                  .type = HingeJoint{.limit = Limit{.low = -0.5,
                                                    .high = 0.5,
                                                    .compliance = Compliance{.min_impedance = 0,
                                                                             .max_impedance = 0.8,
                                                                             .width = 0.03}}},
                  .body_a = BodyId(6),
                  .body_b = BodyId(7),
                  .frame_a = Frame{.position = Vec3(0.09, 0, -0.2),
                                   .rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .frame_b = Frame{.rotation = Quat(0.707106781186548, -0.707106781186547, 0, 0)},
                  .dynamics = JointDynamics{.armature = 0.1, .damping = 1.5, .stiffness = 60}});
  scene.add(Control{.name = "hip_hind",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(3),
                    .actuator = Actuator{.gear = 110}});
  scene.add(Control{.name = "knee_hind",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(4),
                    .actuator = Actuator{.gear = 85}});
  scene.add(Control{.name = "ankle_hind",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(5),
                    .actuator = Actuator{.gear = 55}});
  scene.add(Control{.name = "hip_fore",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(6),
                    .actuator = Actuator{.gear = 100}});
  scene.add(Control{.name = "knee_fore",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(7),
                    .actuator = Actuator{.gear = 55}});
  scene.add(Control{.name = "ankle_fore",
                    .kind = ControlKind::joint_force,
                    .joint = JointId(8),
                    .actuator = Actuator{.gear = 30}});
  return scene;
}

}  // namespace manyworlds::scenes
