// Limits and springs of ball joints by hand: closed forms, and plans that leave them out.
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "src/plan/plan_data.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A box on a ball joint at its centre.
Scene top(double gravity = 0) {
  Scene scene = robot_scene(gravity);
  scene.options.dt = 0.002, scene.options.substeps = 1;
  RobotBuilder build(scene);
  Joint& joint = scene.at(build.ball({}, build.body(Box{{0.1, 0.2, 0.05}}, {0, 0, 1}), {0, 0, 1}));
  joint.dynamics = {};
  return scene;
}
double moment_about_z(const Scene& scene) {
  return mass_properties(scene, scene.bodies[0]).inertia(2, 2);
}
std::vector<double> read(const Batch& batch, Field field) {
  std::vector<double> out(batch.size(field));
  batch.read(field, out);
  return out;
}
// Turned about z.
std::vector<double> turned(double angle) {
  return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
}
// Within half a turn, since -q is the same rotation.
double angle_of(const std::vector<double>& q) {
  return 2 * std::atan2(std::copysign(1.0, q[0]) * q[3], std::abs(q[0]));
}

}  // namespace

TEST_CASE("after a ball joint a series has sliders only", "[robots][fast]") {
  const auto series = [](JointType first, JointType second, JointType third) {
    Scene scene = robot_scene();
    scene.add(body_of(shape_of(Sphere{0.1}), Vec3::Zero()));
    for (JointType* type : {&first, &second, &third}) {
      Joint joint;
      joint.type = *type, joint.body_b = BodyId(0);
      if (!scene.joints.empty()) joint.after = JointId(static_cast<int>(scene.joints.size()) - 1);
      scene.add(joint);
    }
    std::vector<std::string> out;
    for (const Issue& issue : validate(scene)) out.push_back(to_string(issue));
    return out;
  };
  CHECK(series(HingeJoint{}, SliderJoint{}, BallJoint{}).empty());
  CHECK(series(BallJoint{}, SliderJoint{}, SliderJoint{}).empty());
  CHECK(series(BallJoint{}, HingeJoint{}, SliderJoint{}) ==
        std::vector<std::string>{"joint 1: after is 0, which follows a ball joint: after a ball "
                                 "joint in a series, the newton solver supports sliders only"});
  CHECK(series(BallJoint{}, SliderJoint{}, BallJoint{}) ==
        std::vector<std::string>{"joint 2: after is 1, which follows a ball joint: after a ball "
                                 "joint in a series, the newton solver supports sliders only"});
}

TEST_CASE("a ball joint's spring swings at its frequency, far from rest, too", "[robots][fast]") {
  Scene scene = top();
  scene.options.integrator = Integrator::runge_kutta4;
  scene.joints[0].dynamics.stiffness = 40 * moment_about_z(scene);
  const Plan plan = compile(scene);
  const double time = 0.7, expected = 2.5 * std::cos(std::sqrt(40.0) * time);
  for (const Table& table : all_tables()) {
    INFO(name(table));
    for (const double sign : {1.0, -1.0}) {
      Batch batch(plan, options_of(table, 1));
      std::vector<double> q = turned(2.5);
      for (double& x : q) x *= sign;
      batch.write(Field::generalized_position, std::span<const double>(q));
      batch.step(350);
      CHECK(angle_of(read(batch, Field::generalized_position)) ==
            approx(expected, pick(table, 1e-4, 1e-8)));
    }
  }
}

TEST_CASE("a ball joint comes to rest on its limit", "[robots][fast]") {
  // A torque about an axis that is no principal one holds it there: D aref = torque.
  Scene scene = top();
  scene.joints[0].type = BallJoint{.limit = Limit{.high = 0.3}};
  scene.joints[0].dynamics.damping = 2;
  const Plan plan = compile(scene);
  const Vec3 axis = Vec3(1, -2, 2) / 3;
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(plan, options_of(table, 3));
    for (int i = 0; i < 3000; ++i) {
      for (int w = 0; w < 3; ++w) batch.add_torque(w, BodyId(0), (1 + 2 * w) * axis);
      batch.step();
    }
    double before = 0.3;
    for (int w = 0; w < 3; ++w) {
      std::vector<double> q(4), v(3);
      batch.read(Field::generalized_position, w, q);
      batch.read(Field::generalized_velocity, w, v);
      const Vec3 half(q[1], q[2], q[3]);
      const double angle = 2 * std::atan2(half.norm(), q[0]);
      CHECK((half.normalized() - axis).norm() < pick(table, 1e-3, 1e-6));
      CHECK(angle > before);  // it gives way, more to more
      CHECK(angle < 0.32);
      CHECK(Vec3(v[0], v[1], v[2]).norm() < 1e-4);
      before = angle;
    }
  }
}

TEST_CASE("plans have limits and springs of balls where they act", "[robots][fast]") {
  Scene scene = top();
  const auto trees = [&]() -> PlanTrees { return compile(scene).data().trees; };
  CHECK((trees().ball_limits.empty() && trees().ball_springs.empty()));
  scene.joints[0].dynamics.stiffness = 2;
  BallJoint ball;
  ball.limit = Limit{.high = 3};
  scene.joints[0].type = ball;
  CHECK((trees().ball_limits.size() == 1 && trees().ball_springs.size() == 1));
  ball.limit->high = 3.2;  // no rotation is that far
  scene.joints[0].type = ball;
  CHECK(trees().ball_limits.empty());
  ball.limit->margin = 0.1;
  scene.joints[0].type = ball;
  CHECK(trees().ball_limits.size() == 1);
  CHECK_FALSE(compile(scene).fingerprint() == compile(top()).fingerprint());
}

TEST_CASE("limits of ball joints are of an angle, and of the newton solver",
          "[validate][robots][fast]") {
  Scene scene = top();
  scene.joints[0].type = BallJoint{.limit = Limit{.high = 1}};
  const auto limit = [](Scene& s) -> Limit& {
    return *std::get<BallJoint>(s.joints[0].type).limit;
  };
  check_each(scene, "joint 0: ",
             {{"limit.low", "is 0.5 rad, must be 0: the angle of a rotation has no sign",
               [&](Scene& s) { limit(s).low = 0.5; }},
              {"limit", "is from 0 to -1, low must not be above high",
               [&](Scene& s) { limit(s).high = -1; }},
              {"limit.high", "is nan rad",
               [&](Scene& s) { limit(s).high = std::numeric_limits<double>::quiet_NaN(); }},
              {"limit.margin", "is -0.1, must be >= 0", [&](Scene& s) { limit(s).margin = -0.1; }},
              {"limit.compliance.width", "is -1, must be >= 0",
               [&](Scene& s) { limit(s).compliance.width = -1; }},
              {"limit", "is given, which requires the newton solver, not tgs-soft",
               [&](Scene& s) { s.options.solver.method = Solver::tgs_soft; }}});
}

}  // namespace manyworlds::test
