// What validate() says about scenes of Solver::newton, and about its members in others.
#include <catch2/catch.hpp>

#include <cmath>

#include "manyworlds/plan.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/scene_cases.hpp"

namespace manyworlds::test {
namespace {

std::vector<std::string> issues_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const Issue& issue : validate(scene)) out.push_back(to_string(issue));
  return out;
}
using Issues = std::vector<std::string>;

Body box_at(const char* name, const Vec3& position) {
  Body body = body_of(shape_of(cube_of(Space::spatial, 0.1)), position);
  body.name = name;
  return body;
}
// Body 0 'ground', fixed; 1 'torso', free; 2 'arm' on a hinge, with a limit and a motor; 3 'hand'
// on a ball joint; 4 'cart' on a slider at the ground.
Scene robot() {
  Scene scene = empty_scene(Space::spatial);
  scene.options.solver.method = Solver::newton;
  Body floor = ground(Space::spatial);
  floor.name = "ground";
  scene.add(floor);
  scene.add(box_at("torso", {0, 0, 2}));
  scene.add(box_at("arm", {1, 0, 2}));
  scene.add(box_at("hand", {2, 0, 2}));
  scene.add(box_at("cart", {0, 5, 1}));
  HingeJoint hinge;
  hinge.limit = Limit{-1, 1};
  const auto join = [&](const char* name, int a, int b, const Vec3& where, JointType type) {
    Joint joint = joint_at(scene, BodyId(a), BodyId(b), at(where), std::move(type));
    joint.name = name;
    scene.add(joint);
  };
  join("elbow", 1, 2, {0.5, 0, 2}, hinge);
  join("wrist", 2, 3, {1.5, 0, 2}, BallJoint{});
  join("rail", 0, 4, {0, 5, 1}, SliderJoint{});
  Control motor;
  motor.name = "motor";
  motor.kind = ControlKind::joint_force, motor.joint = JointId(0);
  scene.add(motor);
  return scene;
}
// As above, each body on its joint alone, that of body 2 being a series of three hinges.
Scene shoulder() {
  Scene scene = robot();
  scene.joints.resize(1);
  scene.controls.clear();
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    const Quat turn(Eigen::AngleAxisd(kPi / 2, axis));
    Joint joint;
    joint.type = HingeJoint{};
    joint.body_a = BodyId(1), joint.body_b = BodyId(2);
    joint.after = JointId(static_cast<int>(scene.joints.size()) - 1);
    // In the frame of B, which the one before moves.
    joint.frame_a = {{-0.5, 0, 0}, turn}, joint.frame_b = joint.frame_a;
    scene.add(joint);
  }
  return scene;
}
HingeJoint& hinge_of(Scene& scene) { return std::get<HingeJoint>(scene.joints[0].type); }
BallJoint& ball_of(Scene& scene) { return std::get<BallJoint>(scene.joints[1].type); }

}  // namespace

TEST_CASE("the newton solver names all that it does not take, at once",
          "[fast][validate][newton]") {
  Scene scene = robot();
  scene.options.integrator = Integrator::verlet;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-9, -9, -9), Vec3(9, 9, 9));
  scene.bodies[1].enabled = false;
  scene.bodies[1].linear_drag = 0.1, scene.bodies[1].angular_drag = 0.2;
  scene.bodies[1].shapes[0].material.restitution = 0.5;
  scene.bodies[1].linear_velocity.x() = 1;  // of a free body
  scene.bodies[1].jitter.angle = 1;
  scene.bodies[2].linear_velocity.x() = 1, scene.bodies[2].angular_velocity.y() = 1;
  scene.bodies[2].jitter.angle = 1;
  Body moved = box_at("lift", {0, 9, 1});
  moved.motion = Motion::kinematic;
  scene.add(moved);
  const Spring spring{10, 1, 0, 0};
  hinge_of(scene) = {Limit{-1, 1, spring}, Drive{0, 0, spring, 5}};
  scene.joints[0].break_force = 10, scene.joints[0].break_torque = 20;
  ball_of(scene) = {1.0, Limit{-1, 1}, Limit{0, 1, spring}};
  scene.joints[1].dynamics.stiffness = 1, scene.joints[1].dynamics.rest = 0.5;
  const auto join = [&](int b, JointType type) -> Joint& {
    Joint joint;
    joint.body_a = BodyId(1), joint.body_b = BodyId(b), joint.type = std::move(type);
    scene.add(joint);
    return scene.joints.back();
  };
  Joint& welded = join(3, FixedJoint{});
  welded.dynamics.armature = 1, welded.dynamics.rest = 0.5;
  join(3, DistanceJoint{});
  join(3, WheelJoint{spring, std::nullopt, std::nullopt});
  join(3, PulleyJoint{});
  join(3, TargetJoint{spring, 12});
  Control speed;
  speed.kind = ControlKind::target_speed, speed.joint = JointId(0);
  scene.add(speed);
  Control thrust;
  thrust.name = "jet", thrust.kind = ControlKind::thrust, thrust.body = BodyId(1);
  scene.add(thrust);
  scene.attractors.emplace_back();
  scene.variations = {vary(Parameter::friction, 0.1, 1), vary(Parameter::restitution, 0, 0.5)};
  CHECK(
      issues_of(scene) ==
      Issues{
          "options.integrator is verlet, the newton solver supports symplectic-euler, runge-kutta4 "
          "and implicit-fast",
          "options.bounds are given, the newton solver supports none",
          "body 1 'torso': enabled is false, the newton solver supports enabled bodies only",
          "body 1 'torso': linear_drag is not 0, the newton solver supports none",
          "body 1 'torso': angular_drag is not 0, the newton solver supports none",
          "body 1 'torso', shape 0: material.restitution is not 0, the newton solver supports 0 "
          "only: contacts do not bounce",
          "body 2 'arm': linear_velocity is not 0, the newton solver supports it for free bodies "
          "only",
          "body 2 'arm': angular_velocity is not 0, the newton solver supports it for free bodies "
          "only",
          "body 2 'arm': jitter is given, the newton solver supports it for free bodies only: "
          "jointed bodies move along",
          "body 5 'lift': motion is kinematic, the newton solver supports dynamic and fixed bodies",
          "joint 0 'elbow': drive is given, the newton solver supports Joint::dynamics and "
          "controls of kind joint_force instead",
          "joint 0 'elbow': limit.spring is given, the newton solver supports Limit::compliance "
          "instead",
          "joint 0 'elbow': break_force is given, the newton solver supports none",
          "joint 0 'elbow': break_torque is given, the newton solver supports none",
          "joint 1 'wrist': cone is given, the newton solver supports BallJoint::limit instead",
          "joint 1 'wrist': twist is given, the newton solver supports BallJoint::limit instead",
          "joint 1 'wrist': limit.spring is given, the newton solver supports Limit::compliance "
          "instead",
          "joint 1 'wrist': dynamics have a rest or reference, the newton solver supports them for "
          "hinges and sliders only",
          "joint 3: dynamics have a spring or reference, the newton solver supports them for "
          "hinges and sliders only",
          "joint 3: dynamics have armature or damping, the newton solver supports none for a fixed "
          "joint",
          "joint 4: type is distance, the newton solver supports hinge, slider, ball and fixed",
          "joint 5: type is wheel, the newton solver supports hinge, slider, ball and fixed",
          "joint 6: type is pulley, the newton solver supports hinge, slider, ball and fixed",
          "joint 7: type is target, the newton solver supports hinge, slider, ball and fixed",
          "control 1: kind is target_speed, the newton solver supports joint_force only",
          "control 2 'jet': kind is thrust, the newton solver supports joint_force only",
          "attractors are given, the newton solver supports none",
          "variation 1: parameter is restitution, the newton solver supports all but restitution, "
          "rolling_resistance, torsional_resistance, linear_drag and angular_drag",
          "joint 3: body_b is 3, which joint 1 holds already: the newton solver supports trees, or "
          "a series of joints by Joint::after",
          "joint 4: body_b is 3, which joint 1 holds already: the newton solver supports trees, or "
          "a series of joints by Joint::after",
          "joint 5: body_b is 3, which joint 1 holds already: the newton solver supports trees, or "
          "a series of joints by Joint::after",
          "joint 6: body_b is 3, which joint 1 holds already: the newton solver supports trees, or "
          "a series of joints by Joint::after",
          "joint 7: body_b is 3, which joint 1 holds already: the newton solver supports trees, or "
          "a series of joints by Joint::after",
      });

  Scene flat = empty_scene(Space::planar);
  flat.options.solver.method = Solver::newton;
  flat.add(body_of(shape_of(Circle{}), Vec3::Zero()));
  CHECK(issues_of(flat) ==
        Issues{"space is planar, the newton solver supports spatial scenes only"});
}

TEST_CASE("numbers of joints and materials of the newton solver have ranges",
          "[fast][validate][newton]") {
  const auto limit = [](Scene& s) -> Limit& { return *hinge_of(s).limit; };
  const auto dynamics = [](Scene& s) -> JointDynamics& { return s.joints[0].dynamics; };
  check_each(
      robot(), "joint 0 'elbow': ",
      {{"limit.compliance.time_constant", "is nan, must be finite",
        [&](Scene& s) { limit(s).compliance.time_constant = kNan; }},
       {"limit.compliance.damping_ratio", "is inf",
        [&](Scene& s) { limit(s).compliance.damping_ratio = kInf; }},
       {"limit.compliance.damping_ratio",
        "is -1, must be > 0 as time_constant is, or neither (both are then -stiffness and "
        "-damping)",
        [&](Scene& s) { limit(s).compliance.damping_ratio = -1; }},
       {"limit.compliance.min_impedance", "is 1.5, must be between 0 and 1",
        [&](Scene& s) { limit(s).compliance.min_impedance = 1.5; }},
       {"limit.compliance.max_impedance", "is -0.5, must be between 0 and 1",
        [&](Scene& s) { limit(s).compliance.max_impedance = -0.5; }},
       {"limit.compliance.width", "is -1, must be >= 0",
        [&](Scene& s) { limit(s).compliance.width = -1; }},
       {"limit.compliance.midpoint", "is 2, must be between 0 and 1",
        [&](Scene& s) { limit(s).compliance.midpoint = 2; }},
       {"limit.compliance.power", "is 1.5, must be a whole number from 1 to 100",
        [&](Scene& s) { limit(s).compliance.power = 1.5; }},
       {"limit.compliance.power", "is 101, must be a whole number from 1 to 100",
        [&](Scene& s) { limit(s).compliance.power = 101; }},
       {"limit.margin", "is -0.1, must be >= 0", [&](Scene& s) { limit(s).margin = -0.1; }},
       {"dynamics.armature", "is -1, must be >= 0", [&](Scene& s) { dynamics(s).armature = -1; }},
       {"dynamics.damping", "is inf", [&](Scene& s) { dynamics(s).damping = kInf; }},
       {"dynamics.stiffness", "is -1, must be >= 0", [&](Scene& s) { dynamics(s).stiffness = -1; }},
       {"dynamics.rest", "is nan", [&](Scene& s) { dynamics(s).rest = kNan; }},
       {"dynamics.reference", "is inf", [&](Scene& s) { dynamics(s).reference = kInf; }},
       {"after", "is 7, must be a joint, 0 to 2",
        [](Scene& s) { s.joints[0].after = JointId(7); }}});
  const auto soft = [](Scene& s) -> SoftContact& { return s.bodies[1].shapes[0].material.soft; };
  check_each(robot(), "body 1 'torso', shape 0: material.soft.",
             {{"dimensions", "is 4, must be 1 or 3", [&](Scene& s) { soft(s).dimensions = 4; }},
              {"compliance.power", "is 0, must be a whole number from 1 to 100",
               [&](Scene& s) { soft(s).compliance.power = 0; }},
              {"margin", "is -1 m, must be >= 0", [&](Scene& s) { soft(s).margin = -1; }},
              {"gap", "is nan m", [&](Scene& s) { soft(s).gap = kNan; }},
              {"weight", "is -1, must be >= 0", [&](Scene& s) { soft(s).weight = -1; }}});
  check_each(robot(), "exclusion 0: ",
             {{"body_a", "is -1, must be a body, 0 to 4",
               [](Scene& s) {
                 s.exclusions.push_back({BodyId(), BodyId(1)});
               }},
              {"body_b", "is 5, must be a body, 0 to 4", [](Scene& s) {
                 s.exclusions.push_back({BodyId(1), BodyId(5)});
               }}});
  Scene direct = robot();
  limit(direct).compliance.time_constant = -100, limit(direct).compliance.damping_ratio = -10;
  CHECK(issues_of(direct).empty());
}

TEST_CASE("forces of joints may have any range, and joints of one coordinate",
          "[fast][validate][newton]") {
  const auto motor = [](Scene& s) -> Control& { return s.controls[0]; };
  check_each(
      robot(), "control 0 'motor': ",
      {{"joint", "is -1, must be a joint, 0 to 2", [&](Scene& s) { motor(s).joint = {}; }},
       {"joint", "is 1, must be a hinge or slider", [&](Scene& s) { motor(s).joint = JointId(1); }},
       {"actuator.gear", "is nan", [&](Scene& s) { motor(s).actuator.gear = kNan; }},
       {"actuator.gain.y", "is inf", [&](Scene& s) { motor(s).actuator.gain.y() = kInf; }},
       {"actuator.bias.z", "is nan", [&](Scene& s) { motor(s).actuator.bias.z() = kNan; }},
       {"actuator.low", "is 2, must not be above high, which is 1",
        [&](Scene& s) { motor(s).actuator.low = 2, motor(s).actuator.high = 1; }},
       {"low", "is nan", [&](Scene& s) { motor(s).low = kNan; }},
       {"initial", "is 3, must be between -1 and 1", [&](Scene& s) { motor(s).initial = 3; }}});
  Scene open = robot();
  motor(open).low = -kInf, motor(open).high = kInf, motor(open).initial = 1e6;
  CHECK(issues_of(open).empty());
  // Of other kinds the range is finite.
  Scene jet = robot();
  jet.options.solver.method = Solver::tgs_soft;
  motor(jet).kind = ControlKind::thrust, motor(jet).body = BodyId(1), motor(jet).high = kInf;
  CHECK(places(jet) == Issues{"control 0 'motor': high"});
}

TEST_CASE("series of joints go from A to B, each after the last", "[fast][validate][newton]") {
  REQUIRE(issues_of(shoulder()).empty());
  CHECK(compile(shoulder()).items(ItemKind::dof) == 6 + 3 + 6 + 6);  // torso and arm; hand; cart
  const std::string message = ", must be the last joint before this one that has the same A and B";
  const auto spoilt = [](auto spoil) {
    Scene scene = shoulder();
    spoil(scene);
    return issues_of(scene);
  };
  CHECK(spoilt([](Scene& s) { s.joints[2].after = JointId(0); }) ==
        Issues{"joint 2: after is 0" + message});
  CHECK(spoilt([](Scene& s) { s.joints[0].after = JointId(2); }) ==
        Issues{"joint 0 'elbow': after is 2" + message});
  CHECK(spoilt([](Scene& s) { s.joints[1].after = JointId(1); }) ==
        Issues{"joint 1: after is 1" + message});
  CHECK(spoilt([](Scene& s) { s.joints[2].body_a = BodyId(3); }) ==
        Issues{"joint 2: after is 1" + message});
  CHECK(spoilt([](Scene& s) { s.joints[2].body_b = BodyId(3); }) ==
        Issues{"joint 2: after is 1" + message});
  CHECK(spoilt([](Scene& s) { s.joints[2].after = {}; }) ==
        Issues{"joint 2: body_b is 2, which joint 0 holds already: the newton solver supports "
               "trees, or a series of joints by Joint::after"});
  CHECK(spoilt([](Scene& s) { s.joints[1].frame_a.position.x() += 0.25; }) ==
        Issues{"body 2 'arm': position and rotation are 0.25 m and 0 rad from the pose that joint "
               "0's series gives it with coinciding frames, must match it for the newton solver"});
}

TEST_CASE("the newton solver takes trees whose bodies begin in their joints",
          "[fast][validate][newton]") {
  REQUIRE(issues_of(robot()).empty());
  const auto spoilt = [](auto spoil) {
    Scene scene = robot();
    spoil(scene);
    return issues_of(scene);
  };
  const auto apart = [](const char* body, const char* gap, int joint) {
    return Issues{"body " + std::string(body) + ": position and rotation are " + gap +
                  " from the pose that joint " + std::to_string(joint) +
                  " gives it, must match it for the newton solver"};
  };
  CHECK(spoilt([](Scene& s) { s.joints[0].frame_a.position.y() += 0.25; }) ==
        apart("2 'arm'", "0.25 m and 0 rad", 0));
  CHECK(spoilt([](Scene& s) { s.joints[0].frame_a.rotation = Quat(0, 1, 0, 0); }) ==
        apart("2 'arm'", "0 m and 3.141592653589793 rad", 0));
  CHECK(spoilt([](Scene& s) { s.joints[1].frame_b.position.z() += 0.5; }) ==
        apart("3 'hand'", "0.5 m and 0 rad", 1));
  CHECK(spoilt([](Scene& s) { s.joints[2].frame_a.position.y() += 0.5; }) ==
        apart("4 'cart'", "0.5 m and 0 rad", 2));
  CHECK(spoilt([](Scene& s) { s.joints[2].frame_a.rotation = Quat(0, 0, 0, 1); }) ==
        apart("4 'cart'", "0 m and 3.141592653589793 rad", 2));
  CHECK(spoilt([](Scene& s) { s.joints[1].type = FixedJoint{}; }).empty());
  // What the joints let go.
  CHECK(spoilt([](Scene& s) {
          s.joints[0].frame_a.rotation = Quat(Eigen::AngleAxisd(1, Vec3::UnitZ()));
          s.joints[1].frame_a.rotation = Quat(Eigen::AngleAxisd(2, Vec3::UnitX()));
          s.joints[2].frame_a.position.x() += 0.5;
        }).empty());

  // Joints that hold one body, circles, and what hangs on one.
  const auto join = [](Scene& scene, int a, int b) {
    const Vec3 between = 0.5 * (scene.bodies[static_cast<std::size_t>(a)].position +
                                scene.bodies[static_cast<std::size_t>(b)].position);
    scene.add(joint_at(scene, BodyId(a), BodyId(b), at(between), BallJoint{}));
  };
  CHECK(spoilt([&](Scene& s) { join(s, 4, 2); }) ==
        Issues{"joint 3: body_b is 2, which joint 0 holds already: the newton solver supports "
               "trees, or a series of joints by Joint::after"});
  const Issues circle = {
      "body 1 'torso': joints form a loop through it, the newton solver supports trees only"};
  CHECK(spoilt([&](Scene& s) { join(s, 3, 1); }) == circle);
  CHECK(spoilt([&](Scene& s) {
          s.joints.pop_back();
          join(s, 3, 4), join(s, 4, 1);
        }) == circle);
  Scene hanging = empty_scene(Space::spatial);
  hanging.options.solver.method = Solver::newton;
  for (const char* name : {"low", "middle", "high", "other", "another"}) {
    hanging.add(box_at(name, Vec3(static_cast<double>(hanging.bodies.size()), 0, 0)));
  }
  join(hanging, 1, 0), join(hanging, 1, 2), join(hanging, 2, 1);
  join(hanging, 3, 4), join(hanging, 4, 3);
  CHECK(
      issues_of(hanging) ==
      Issues{
          "body 1 'middle': joints form a loop through it, the newton solver supports trees only",
          "body 3 'other': joints form a loop through it, the newton solver supports trees only"});

  CHECK(spoilt([&](Scene& s) {
          s.bodies[4].motion = Motion::kinematic;
          s.joints[2].body_a = BodyId(1);
        }) ==
        Issues{"body 4 'cart': motion is kinematic, the newton solver supports dynamic and fixed "
               "bodies",
               "joint 2 'rail': body_b is not dynamic, the newton solver needs a dynamic body "
               "there: exchange A and B"});
}

TEST_CASE("limits of hinges may be beyond half a turn for the newton solver alone",
          "[fast][validate][newton]") {
  Scene scene = robot();
  hinge_of(scene).limit = Limit{-7, 20};
  CHECK(issues_of(scene).empty());
  hinge_of(scene).limit = Limit{2, 1};
  CHECK(issues_of(scene) ==
        Issues{"joint 0 'elbow': limit is from 2 to 1, low must not be above high"});
  hinge_of(scene).limit = Limit{-7, 20};
  scene.controls.clear();
  scene.options.solver.method = Solver::tgs_soft;
  CHECK(issues_of(scene) ==
        Issues{"joint 0 'elbow': limit.low is -7 rad, must be between -pi and pi",
               "joint 0 'elbow': limit.high is 20 rad, must be between -pi and pi"});
}

TEST_CASE("other solvers name all that is the newton solver's", "[fast][validate][newton]") {
  Scene scene = robot();
  hinge_of(scene).limit->margin = 0.1, hinge_of(scene).limit->compliance.width = 0.1;
  scene.joints[0].dynamics.damping = 1;
  scene.joints[1].after = JointId(0);
  for (const Solver solver : {Solver::tgs_soft, Solver::nncg, Solver::penalty}) {
    scene.options.solver.method = solver;
    const std::string needs =
        std::string(" is given, which requires the newton solver, not ") + to_string(solver);
    CHECK(
        issues_of(scene) ==
        Issues{
            "joint 0 'elbow': dynamics" + needs, "joint 0 'elbow': limit.margin" + needs,
            "joint 0 'elbow': limit.compliance" + needs, "joint 1 'wrist': after" + needs,
            std::string(
                "control 0 'motor': kind is joint_force, which requires the newton solver, not ") +
                to_string(solver)});
  }
  // A material may be that of either.
  Scene plain = robot();
  plain.controls.clear();
  plain.options.solver.method = Solver::tgs_soft;
  plain.bodies[1].shapes[0].material.soft.margin = 0.1;
  CHECK(issues_of(plain).empty());
}

}  // namespace manyworlds::test
