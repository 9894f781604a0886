// What observers see of worlds of Solver::newton.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "manyworlds/task.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

TEST_CASE("what needs trees is refused where there are none, with what to use instead",
          "[fast][observe]") {
  Scene scene;
  scene.name = "one ball";
  Body ball;
  ball.shapes.emplace_back();
  scene.add(ball);
  Task task;
  task.scene = scene;
  task.observations = {{"one", 1}};
  const auto refuses = [&](Observer observer, Observed what, const char* instead) {
    INFO(to_string(what));
    CHECK_FALSE(observable(observer, scene));
    BatchOptions options;
    options.observe.what = {observer};
    CHECK_THROWS_WITH(
        Batch(compile(scene), options),
        Catch::Contains(std::string("is ") + to_string(observer) +
                        ": the scene 'one ball' does not support it: its solver is tgs-soft"));
    task.observations[0].value = terms::observed(what);
    const std::vector<Issue> issues = validate(task);
    REQUIRE(issues.size() == 1);
    CHECK_THAT(issues[0].message, Catch::Contains(instead));
  };
  refuses(Observer::link_inertias, Observed::link_mass, "use the parameter mass of the body");
  refuses(Observer::link_velocities, Observed::link_velocity, "use the linear velocity");
  refuses(Observer::dof_forces, Observed::actuator_force, "use drive_force of the joint");
  refuses(Observer::tendons, Observed::tendon_length, "use joint_position of its joints");
  CHECK(observable(Observer::link_forces, scene));
  CHECK(observable(Observer::links, scene));
  CHECK(observable(Observer::residual, scene));
}

TEST_CASE("worlds of the newton solver have some observers", "[fast][newton]") {
  const Plan plan = compile(newton_robot());
  BatchOptions options = options_of(widest_tables().front(), 2);
  for (int i = 0; i < kObserverCount; ++i) {
    const auto observer = static_cast<Observer>(i);
    if (observer == Observer::rays || observer == Observer::points) continue;
    INFO(to_string(observer));
    options.observe.what = {Observer::motion, observer};
    if (observer != Observer::residual) {
      CHECK_NOTHROW(Batch(plan, options));
      continue;
    }
    CHECK_FALSE(observable(observer, plan.scene()));
    CHECK_THROWS_WITH(Batch(plan, options),
                      Catch::Contains("observe.what[1] is residual: ") &&
                          Catch::Contains("use SolverOptions::tolerance instead"));
  }

  Scene swing = newton_pendulum();
  swing.bodies[0].shapes[0].filter.mask = 0xffffffff;
  options.observe = {};
  options.observe.what = {Observer::motion, Observer::acceleration};
  Ray down;
  down.origin = Vec3(kLength, 0, 5), down.direction = Vec3(0, 0, -1);
  options.observe.rays = {down};
  Point tip;
  tip.body = BodyId(0), tip.position = Vec3(0.2, 0, 0);
  options.observe.points = {tip};
  Batch batch(compile(swing), options);
  batch.look();
  CHECK(batch.ray_hits(0)[0].body == BodyId(0));
  CHECK(batch.ray_hits(0)[0].distance == Approx(5 - 0.1).epsilon(1e-5));
  const auto observed = [&](Observed what) {
    Numbers out(batch.size(what) / 2);
    batch.read(what, 0, out);
    return out;
  };
  CHECK(observed(Observed::point_position)[0] == Approx(kLength + 0.2));
  batch.step();
  // It falls about its hinge.
  const double turn = kMass * 10 * kLength / kAboutHinge;
  CHECK(of(batch, Field::generalized_acceleration)[0] == Approx(turn).epsilon(1e-5));
  CHECK(observed(Observed::angular_acceleration)[1] == Approx(turn).epsilon(1e-4));
  CHECK(observed(Observed::kinetic_energy)[0] ==
        Approx(kAboutHinge * std::pow(turn * 0.01, 2) / 2).epsilon(1e-3));
}

TEST_CASE("where nothing can touch, no contacts are observed", "[fast][newton]") {
  BatchOptions options = options_of(widest_tables().front(), 2);
  options.observe.what = {Observer::contacts, Observer::touching, Observer::penetration};
  Batch batch(compile(newton_pendulum()), options);
  for (int i = 0; i < 3; ++i) {
    batch.step();
    for (const Observed what :
         {Observed::contact_count, Observed::touching, Observed::penetration}) {
      Numbers out(batch.size(what));
      batch.read(what, out);
      CHECK(out == Numbers(out.size(), 0.0));
    }
    CHECK(batch.step_contacts(1).empty());
  }
}

// A crate at rest on a slope, and a ball on a hinge that hangs clear of it.
TEST_CASE("contacts of the newton solver carry what rests on them", "[fast][newton]") {
  Scene scene = newton_scene();
  const double slope = 0.2, friction = 0.6;
  scene.options.gravity = 10 * Vec3(std::sin(slope), 0, -std::cos(slope));
  Body floor = ground(Space::spatial, friction);
  scene.add(std::move(floor));
  scene.add(body_of(shape_of(Box{{0.3, 0.2, 0.1}}, friction), Vec3(0, 0, 0.099)));
  scene.add(body_of(shape_of(Sphere{0.1}), Vec3(3, 0, 2)));
  scene.add(joint_at(scene, BodyId(), BodyId(2), at({3, 0, 3}, z_to_y()), HingeJoint{}));
  for (const int substeps : {1, 2}) {
    scene.options.substeps = substeps;
    for (const Table& table : widest_tables()) {
      INFO(name(table) << ", " << substeps);
      BatchOptions options = options_of(table, 2);
      options.observe.what = {Observer::contacts, Observer::touching, Observer::penetration};
      Batch batch(compile(scene), options);
      batch.step(200);
      const double weight =
          batch.plan().scene().options.dt * 10 * mass_properties(scene, scene.at(BodyId(1))).mass;
      const double slack = weight * pick(table, 0.02, 0.01);
      for (const int world : {0, 1}) {
        const auto contacts = batch.step_contacts(world);
        REQUIRE(contacts.size() == 4);
        Vec3 total = Vec3::Zero(), moment = Vec3::Zero();
        const Vec3 center = position(batch, world, BodyId(1));
        for (const StepContact& c : contacts) {
          CHECK(c.body_a == BodyId(0));
          CHECK(c.body_b == BodyId(1));
          CHECK(c.normal_impulse > 0);
          CHECK(c.separation < 0);
          CHECK(std::abs(c.point.z()) < 0.01);
          const Vec3 force = c.normal * c.normal_impulse + c.friction_impulse;
          total += force, moment += (c.point - center).cross(force);
        }
        CHECK(total.z() == approx(weight * std::cos(slope), slack));
        CHECK(total.x() == approx(-weight * std::sin(slope), slack));
        CHECK(std::abs(total.y()) < slack);
        CHECK(moment.norm() < 0.1 * slack);
        const auto observed = [&](Observed what) {
          Numbers out(batch.size(what) / 2);
          batch.read(what, world, out);
          return out;
        };
        CHECK(observed(Observed::touching) == Numbers{1, 0});
        CHECK(observed(Observed::contact_count) == Numbers{4});
        CHECK(observed(Observed::penetration)[0] > 0);
        CHECK(observed(Observed::penetration)[0] < 0.01);
      }
    }
  }
}

}  // namespace manyworlds::test
