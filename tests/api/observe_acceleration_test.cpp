// Accelerations of bodies against closed forms and differences of velocities.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/observed.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

Vec3 observed(const Batch& batch, Observed what, int row, int world = 0) {
  std::vector<double> v(batch.size(what) / static_cast<std::size_t>(batch.worlds()));
  batch.read(what, world, v);
  const auto n = static_cast<std::size_t>(components(what, space_of(batch)));
  const double* own = v.data() + static_cast<std::size_t>(row) * n;
  if (n == 1) return {0, 0, own[0]};
  return {own[0], own[1], n == 3 ? own[2] : 0};
}
Vec3 linear(const Batch& b, int row, int world = 0) {
  return observed(b, Observed::linear_acceleration, row, world);
}
Vec3 angular(const Batch& b, int row, int world = 0) {
  return observed(b, Observed::angular_acceleration, row, world);
}
Vec3 proper(const Batch& b, int row, int world = 0) {
  return observed(b, Observed::proper_acceleration, row, world);
}

bool close(const Vec3& a, const Vec3& b, double most) { return (a - b).norm() <= most; }

// Its shape lies askew and off the middle, so that its frame is not that of its principal axes.
Body askew(Space space, const Vec3& place) {
  Shape shape = shape_of(box_of(space, {0.4, 0.3, 0.2}));
  shape.position = {0.5, 0.1, 0};
  shape.rotation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
  if (space == Space::spatial) {
    shape.rotation = shape.rotation * Quat(Eigen::AngleAxisd(0.7, Vec3::UnitX()));
  }
  return body_of(shape, place);
}

}  // namespace

TEST_CASE("in free fall the acceleration is gravity and an accelerometer tells 0",
          "[fast][observe]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    scene.add(askew(space, Vec3::Zero()));
    scene.bodies[0].angular_velocity = {0, 0, 2};
    scene.bodies[0].gravity_scale = 0.5;
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), observing(table, {Observer::acceleration}));
      for (int steps : {1, 3}) {
        batch.step(steps);
        CHECK(close(linear(batch, 0), -5 * up_of(space), pick(table, 1e-3, 1e-9)));
        CHECK(close(proper(batch, 0), Vec3::Zero(), pick(table, 1e-3, 1e-9)));
      }
    }
  }
}

TEST_CASE("at rest an accelerometer tells g upwards, in the axes of the body", "[fast][observe]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    scene.add(ground(space));
    Body box = askew(space, 0.4 * up_of(space));
    box.rotation = box.shapes[0].rotation.conjugate();  // the shape lies flat
    scene.add(box);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), observing(table, {Observer::acceleration}));
      batch.step(300);
      CHECK(close(linear(batch, 0), Vec3::Zero(), 0.02));
      CHECK(close(angular(batch, 0), Vec3::Zero(), 0.05));
      const Vec3 up = rotation(batch, 0, 0).conjugate() * up_of(space);
      CHECK(close(proper(batch, 0), 10 * up, 0.02));
      CHECK((up - up_of(space)).norm() > 0.1);
    }
  }
}

TEST_CASE("a constant force and a torque give F / m and T / I", "[fast][observe]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    scene.add(body_of(shape_of(cube_of(space, 0.5)), Vec3::Zero()));
    scene.bodies[0].shapes[0].density = 2;
    const double mass = 2, inertia = 2.0 / 6;  // of a square or a cube with sides of 1 m
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), observing(table, {Observer::acceleration}));
      batch.add_force(0, BodyId(0), {3, -4, 0});
      batch.add_torque(0, BodyId(0), {0, 0, 0.5});
      batch.step(4);
      const double near = pick(table, 1e-3, 1e-9);
      CHECK(close(linear(batch, 0), Vec3(3, -4, 0) / mass, near));
      CHECK(close(angular(batch, 0), Vec3(0, 0, 0.5 / inertia), near));
      CHECK(linear(batch, 0).isApprox(rotation(batch, 0, 0) * proper(batch, 0), 1e-4));
      batch.step();  // the force is over
      CHECK(close(linear(batch, 0), Vec3::Zero(), near));
    }
  }
}

TEST_CASE("the acceleration is the change of velocity in the last step, impacts included",
          "[fast][observe]") {
  for (Space space : kSpaces) {
    const Plan plan = compile(varied_crowd(space));
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      Batch batch(plan, observing(table, {Observer::acceleration}, 5)),
          twin(plan, options_of(table, 5));
      const double per_step = 1 / plan.scene().options.dt, near = pick(table, 0.02, 1e-6);
      double hardest = 0;
      for (int call = 0; call < 20; ++call) {
        batch.step(3);
        twin.step(2);
        std::vector<Vec3> v, w;
        for (int i = 0; i < 5 * twin.bodies(); ++i) {
          v.push_back(velocity(twin, i / twin.bodies(), i % twin.bodies()));
          w.push_back(spin(twin, i / twin.bodies(), i % twin.bodies()));
        }
        twin.step();
        REQUIRE(batch.hash() == twin.hash());
        for (int i = 0; i < 5 * twin.bodies(); ++i) {
          const int world = i / twin.bodies(), body = i % twin.bodies();
          const auto at = static_cast<std::size_t>(i);
          const Vec3 a = (velocity(twin, world, body) - v[at]) * per_step;
          REQUIRE(close(linear(batch, body, world), a, near));
          REQUIRE(close(angular(batch, body, world), (spin(twin, world, body) - w[at]) * per_step,
                        near));
          // Each world has its own gravity, and its own sizes and so principal axes.
          const auto g = numbers(batch, Parameter::gravity, world);
          const double scale =
              numbers(batch, Parameter::gravity_scale, world)[static_cast<std::size_t>(body)];
          const Vec3 felt = a - scale * Vec3(g[0], g[1], space == Space::planar ? 0 : g[2]);
          const auto scene_body = static_cast<std::size_t>(plan.body_in_row(body).index());
          if (plan.scene().bodies[scene_body].motion == Motion::dynamic) {
            REQUIRE(close(rotation(batch, world, body) * proper(batch, body, world), felt,
                          near + 1e-5 * felt.norm()));
          }
          hardest = std::max(hardest, a.norm());
        }
      }
      CHECK(hardest > 50);
    }
  }
}

TEST_CASE("what does not move has no acceleration", "[fast][observe]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    scene.add(ground(space));
    for (int i = 0; i < 3; ++i) {
      Body body = body_of(shape_of(cube_of(space, 0.5)), Vec3(3 * i, 0, 0) + 0.5 * up_of(space));
      scene.add(body);
    }
    scene.bodies[3].motion = Motion::kinematic;
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      BatchOptions options = observing(table, {Observer::acceleration}, 3);
      options.sleep = true;
      Batch batch(compile(scene), options);
      const Vec3 zero = Vec3::Zero(), up = 10 * up_of(space);
      batch.set_enabled(1, BodyId(2), false);
      batch.step(300);
      REQUIRE(batch.asleep(0, BodyId(1)));
      for (int calls = 0; calls < 2; ++calls) {
        CHECK(linear(batch, 0, 0) == zero);
        CHECK(angular(batch, 0, 0) == zero);
        CHECK(close(proper(batch, 0, 0), up, 1e-3));
        CHECK(proper(batch, 1, 1) == zero);  // disabled
        CHECK(linear(batch, 2, 0) == zero);  // kinematic: gravity gives it nothing
        CHECK(proper(batch, 2, 0) == zero);
        batch.step(7);
      }
      // A state that is looked at has none.
      set_vector(batch, Field::linear_velocity, 2, 0, up);
      batch.look();
      CHECK(linear(batch, 0, 2) == zero);
      CHECK(close(rotation(batch, 2, 0) * proper(batch, 0, 2), up, 1e-3));
      batch.step();
      CHECK(linear(batch, 0, 2) != zero);
      set_vector(batch, Field::linear_velocity, 2, 0, 1e9 * up);
      batch.step();
      REQUIRE(frozen(batch.status(2)));
      CHECK(linear(batch, 0, 2) == zero);
      CHECK(proper(batch, 0, 2) == zero);
    }
  }
}

TEST_CASE("the pull of an attractor is gravity, too", "[fast][observe]") {
  Scene scene = empty_scene(Space::spatial, 0);
  scene.add(body_of(shape_of(Sphere{0.1}), {2, 0, 0}));
  scene.bodies[0].linear_velocity = {0, std::sqrt(8 / 2.0), 0};
  scene.attractors.push_back({.strength = 8});
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), observing(table, {Observer::acceleration}));
    batch.step(40);
    CHECK(linear(batch, 0).norm() == Approx(2).epsilon(0.01));
    CHECK(close(proper(batch, 0), Vec3::Zero(), 0.01));
  }
}

}  // namespace manyworlds::test
