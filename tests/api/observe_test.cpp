// Observers against balances of momentum, double sums and closed forms.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/observed.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

const std::vector<Observer> kEverything = {Observer::contacts, Observer::touching,
                                           Observer::penetration, Observer::motion};

double number(const Batch& batch, Observed what, int world = 0) {
  double x = 0;
  batch.read(what, world, {&x, 1});
  return x;
}
Vec3 vector(const Batch& batch, Observed what, int world = 0) {
  std::vector<double> v(batch.size(what) / static_cast<std::size_t>(batch.worlds()));
  batch.read(what, world, v);
  if (v.size() == 1) return {0, 0, v[0]};
  return {v[0], v[1], v.size() == 3 ? v[2] : 0};
}

struct Sum {
  double normal = 0;
  Vec3 impulse = Vec3::Zero();  // that bodies B received
};
Sum sum_of(const std::vector<StepContact>& contacts) {
  Sum sum;
  for (const StepContact& c : contacts) {
    sum.normal += c.normal_impulse;
    sum.impulse += c.normal_impulse * c.normal + c.friction_impulse;
  }
  return sum;
}

}  // namespace

TEST_CASE("where nothing can touch, joints are no contacts", "[fast][observe][joint]") {
  for (const char* scene : {"chain2d", "chain3d"}) {
    const Plan plan = compile(scenes::find(scene)->make());
    for (const Table& table : all_tables()) {
      INFO(scene << " " << name(table));
      BatchOptions options = observing(table, kEverything, 3);
      options.observe.rays = {Ray{Vec3(0.5, 5, 0), {0, -1, 0}}};
      Batch batch(plan, options);
      batch.step(30);
      for (int w = 0; w < batch.worlds(); ++w) {
        CHECK(number(batch, Observed::contact_count, w) == 0);
        CHECK(number(batch, Observed::penetration, w) == 0);
        CHECK(number(batch, Observed::kinetic_energy, w) > 0);
        std::vector<double> touching(plan.scene().bodies.size());
        batch.read(Observed::touching, w, touching);
        CHECK(std::count(touching.begin(), touching.end(), 0.0) ==
              static_cast<std::ptrdiff_t>(touching.size()));
      }
    }
  }
}

TEST_CASE("a box at rest: the impulses of a step are its weight times dt", "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double restitution : {0.0, 0.5}) {  // the plan adds impulses up in different places
      Scene scene = empty_scene(space);
      scene.add(ground(space, 0.6, restitution));
      scene.add(body_of(shape_of(cube_of(space, 0.5)), 0.5 * up_of(space)));
      const double weight = 1000 * 10 * scene.options.dt;  // N s in a step
      for (const Table& table : all_tables()) {
        INFO(name(table) << " restitution " << restitution);
        Batch batch(compile(scene), observing(table, kEverything));
        batch.step(120);
        const auto contacts = batch.step_contacts(0);
        REQUIRE(contacts.size() == (space == Space::planar ? 2 : 4));
        CHECK(number(batch, Observed::contact_count) == static_cast<double>(contacts.size()));
        CHECK(sum_of(contacts).normal == Approx(weight).epsilon(1e-4));
        CHECK(sum_of(contacts).impulse.dot(up_of(space)) == Approx(weight).epsilon(1e-4));
        double deepest = 0;
        for (const StepContact& c : contacts) {
          CHECK(c.body_a == BodyId(0));
          CHECK(c.body_b == BodyId(1));
          CHECK((c.normal - up_of(space)).norm() < 1e-5);
          CHECK(std::abs(c.point.dot(up_of(space))) < 0.01);
          CHECK(std::abs(c.point.x()) == approx(0.5, 0.01));
          CHECK(c.normal_impulse ==
                Approx(weight / static_cast<double>(contacts.size())).epsilon(0.01));
          deepest = std::max(deepest, -c.separation);
        }
        CHECK(number(batch, Observed::penetration) == deepest);
        CHECK(batch.touching(0, batch.body_in_row(0)));
        CHECK(batch.touching(0, BodyId(1), BodyId(0)));
      }
    }
  }
}

TEST_CASE("a block on a slope: its friction is m g sin", "[fast][observe]") {
  const double slope = 20 * kPi / 180;
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.options.gravity =
        9.81 * (std::sin(slope) * Vec3::UnitX() - std::cos(slope) * up_of(space));
    scene.add(ground(space));
    scene.add(body_of(shape_of(cube_of(space, 0.5)), 0.5 * up_of(space)));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), observing(table, {Observer::contacts}));
      batch.step(240);
      Vec3 friction = Vec3::Zero();
      for (const StepContact& c : batch.step_contacts(0)) {
        CHECK(std::abs(c.friction_impulse.dot(c.normal)) < 1e-4);
        friction += c.friction_impulse;
      }
      const double pull = 1000 * 9.81 * std::sin(slope) * scene.options.dt;
      CHECK(friction.x() == Approx(-pull).epsilon(1e-3));
      CHECK((friction - friction.x() * Vec3::UnitX()).norm() < 1e-3 * pull);
    }
  }
}

TEST_CASE("what a body gains in a step is gravity and the impulses of its contacts",
          "[fast][observe]") {
  for (Scene scene : {crowd(Space::planar), crowd(Space::spatial), capsule_crowd(Space::planar),
                      capsule_crowd(Space::spatial)}) {
    for (bool bounces : {true, false}) {
      for (Body& body : scene.bodies) {
        body.linear_drag = body.angular_drag = 0;
        if (!bounces) body.shapes[0].material.restitution = 0;
      }
      const Plan plan = compile(scene);
      for (const Table& table : all_tables()) {
        INFO(scene.name << ' ' << name(table) << " bounces " << bounces);
        Batch batch(plan, observing(table, kEverything, 5));
        int touched_bodies = 0;
        for (int step = 0; step < 90; ++step) {
          std::vector<double> before = values(batch, Field::linear_velocity, 3);
          batch.step();
          const std::vector<double> after = values(batch, Field::linear_velocity, 3);
          const auto contacts = batch.step_contacts(3);
          const auto dim = before.size() / static_cast<std::size_t>(batch.bodies());
          double worst = 0;
          for (int b = 0; b < batch.bodies(); ++b) {
            const BodyId body = plan.body_in_row(b);
            const double mass = mass_properties(scene, scene.at(body)).mass;
            Vec3 gain = mass * scene.options.dt * scene.options.gravity;
            bool touched = false;
            for (const StepContact& c : contacts) {
              const Vec3 p = c.normal_impulse * c.normal + c.friction_impulse;
              if (c.body_b == body) gain += p;
              if (c.body_a == body) gain -= p;
              touched |= c.normal_impulse > 0 && (c.body_a == body || c.body_b == body);
            }
            CHECK(batch.touching(3, body) == touched);
            touched_bodies += touched ? 1 : 0;
            for (std::size_t c = 0; c < dim; ++c) {
              const std::size_t at = static_cast<std::size_t>(b) * dim + c;
              const double error =
                  mass * (after[at] - before[at]) - gain[static_cast<Eigen::Index>(c)];
              worst = std::max(worst, std::abs(error) / mass);
            }
          }
          CHECK(worst < pick(table, 2e-5, 1e-12));  // m/s
        }
        CHECK(touched_bodies > 100);
      }
    }
  }
}

TEST_CASE("energies and momenta are those of the state", "[fast][observe]") {
  for (Scene scene : {crowd(Space::planar), crowd(Space::spatial), capsule_crowd(Space::spatial)}) {
    scene.bodies[3].motion = Motion::kinematic;
    scene.bodies[4].enabled = false;
    const Plan plan = compile(scene);
    for (const Table& table : all_tables()) {
      INFO(scene.name << ' ' << name(table));
      Batch batch(plan, observing(table, {Observer::motion}, 11));
      batch.step(25);
      for (int w = 0; w < 11; ++w) {
        Batch alone(plan, options_of(table));
        const Energy energy = batch.energy(w);
        double mass = 0;
        Vec3 center = Vec3::Zero(), linear = Vec3::Zero();
        for (int b = 0; b < batch.bodies(); ++b) {
          const Body& body = scene.at(plan.body_in_row(b));
          if (body.motion != Motion::dynamic || !batch.enabled(w, batch.body_in_row(b))) continue;
          const double m = mass_properties(scene, body).mass;
          mass += m;
          center += m * position(batch, w, b);
          linear += m * velocity(batch, w, b);
        }
        const double near = pick(table, 3e-6, 1e-13);
        CHECK(number(batch, Observed::kinetic_energy, w) == Approx(energy.kinetic).epsilon(near));
        CHECK(number(batch, Observed::potential_energy, w) ==
              Approx(energy.potential).epsilon(near));
        CHECK(number(batch, Observed::total_mass, w) == Approx(mass).epsilon(near));
        CHECK((vector(batch, Observed::mass_center, w) - center / mass).norm() < 5 * near);
        CHECK((vector(batch, Observed::momentum, w) - linear).norm() < 5 * near * mass);
      }
    }
  }
}

TEST_CASE("angular momentum is that of the state", "[fast][observe]") {
  for (Scene scene : {crowd(Space::planar), crowd(Space::spatial), capsule_crowd(Space::spatial)}) {
    const Plan plan = compile(scene);
    for (const Table& table : all_tables()) {
      INFO(scene.name << ' ' << name(table));
      Batch batch(plan, observing(table, {Observer::motion}, 3));
      batch.step(10);
      const Momenta expected = momenta(batch, 2);
      const double near = pick(table, 1e-5, 1e-12);
      const Vec3 found = vector(batch, Observed::angular_momentum, 2);
      CHECK((found - expected.angular).norm() < near * (1 + 1000 * expected.angular.norm()));
      CHECK(number(batch, Observed::kinetic_energy, 2) ==
            Approx(kinetic_energy(batch, 2)).epsilon(near));
    }
  }
}

TEST_CASE("a free body keeps the momenta that it has", "[fast][observe]") {
  Scene scene = empty_scene(Space::spatial, 0);
  Body body = body_of(shape_of(Box{Vec3(0.5, 0.3, 0.1)}), Vec3(1, 2, 3));
  body.shapes[0].position = Vec3(0.2, 0, 0.1);
  body.linear_velocity = Vec3(1, -2, 0.5);
  body.angular_velocity = Vec3(3, 2, 1);
  scene.add(body);
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), observing(table, {Observer::motion}));
    batch.look();
    const Vec3 linear = vector(batch, Observed::momentum),
               angular = vector(batch, Observed::angular_momentum);
    CHECK(linear.norm() == Approx(120 * Vec3(1, -2, 0.5).norm()).epsilon(1e-6));
    batch.step(60);
    const double near = pick(table, 1e-4, 1e-7);
    CHECK((vector(batch, Observed::momentum) - linear).norm() < near * linear.norm());
    CHECK((vector(batch, Observed::angular_momentum) - angular).norm() < near * angular.norm());
  }
}

TEST_CASE("a pair asleep reports what it will wake with", "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.add(ground(space));
    for (int i = 0; i < 2; ++i) {
      scene.add(body_of(shape_of(cube_of(space, 0.5)), (0.5 + 1.0 * i) * up_of(space)));
    }
    for (const Table& table : all_tables()) {
      INFO(name(table));
      BatchOptions options = observing(table, kEverything, 3);
      options.sleep = true;
      Batch batch(compile(scene), options), at_once(compile(scene), options);
      for (int i = 0; i < 300; ++i) batch.step();
      at_once.step(300);
      REQUIRE(batch.asleep(1));
      const auto contacts = batch.step_contacts(1), others = at_once.step_contacts(1);
      REQUIRE(contacts.size() == (space == Space::planar ? 4 : 8));
      REQUIRE(others.size() == contacts.size());
      double ground_sum = 0;
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        CHECK(contacts[i].normal_impulse == others[i].normal_impulse);
        CHECK(contacts[i].point == others[i].point);
        if (contacts[i].body_a == BodyId(0)) ground_sum += contacts[i].normal_impulse;
      }
      CHECK(ground_sum == Approx(2 * 1000 * 10 * scene.options.dt).epsilon(1e-2));
      CHECK(batch.touching(1, batch.body_in_row(0)));
      CHECK(batch.touching(1, BodyId(2), BodyId(1)));
      // Restored into a batch that has never stepped it: the same.
      Batch fresh(compile(scene), options);
      fresh.restore(batch.save(), 1, 2);
      fresh.step();
      CHECK(fresh.step_contacts(2).size() == contacts.size());
      CHECK(fresh.step_contacts(2)[0].normal_impulse == contacts[0].normal_impulse);
      // Awake again, the step counts for itself.
      batch.wake(1);
      batch.step();
      double awake_sum = 0;
      for (const StepContact& c : batch.step_contacts(1)) {
        if (c.body_a == BodyId(0)) awake_sum += c.normal_impulse;
      }
      CHECK(awake_sum == Approx(2 * 1000 * 10 * scene.options.dt).epsilon(1e-3));
    }
  }
}

TEST_CASE("of two stacks one sleeps: every contact is reported once", "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.add(ground(space));
    for (double x : {-3.0, 3.0}) {
      for (int i = 0; i < 2; ++i) {
        scene.add(
            body_of(shape_of(cube_of(space, 0.5)), Vec3(x, 0, 0) + (0.5 + 1.0 * i) * up_of(space)));
      }
    }
    const std::size_t all = space == Space::planar ? 8 : 16;
    for (const Table& table : all_tables()) {
      INFO(name(table));
      BatchOptions options = observing(table, kEverything, 3);
      options.sleep = true;
      Batch batch(compile(scene), options);
      batch.step(300);
      REQUIRE(batch.asleep(0));
      for (int i = 0; i < 5; ++i) {
        batch.add_impulse(1, batch.body_in_row(3), 100 * up_of(space));  // keeps its stack awake
        batch.step();
        REQUIRE(batch.asleep(1, batch.body_in_row(0)));
        REQUIRE_FALSE(batch.asleep(1, batch.body_in_row(3)));
        for (int w = 0; w < 3; ++w) CHECK(batch.step_contacts(w).size() == all);
      }
      CHECK(number(batch, Observed::contact_count, 1) == static_cast<double>(all));
    }
  }
}

TEST_CASE("a frozen world touches nothing, a disabled body nobody", "[fast][observe]") {
  const Space space = Space::planar;
  Scene scene = empty_scene(space);
  scene.add(ground(space));
  scene.add(body_of(shape_of(cube_of(space, 0.5)), 0.5 * up_of(space)));
  scene.add(body_of(shape_of(cube_of(space, 0.5)), Vec3(3, 0.5, 0)));
  for (const Table& table : all_tables()) {
    Batch batch(compile(scene), observing(table, kEverything, 3));
    batch.step(30);
    set_vector(batch, Field::linear_velocity, 1, 1, Vec3(std::nan(""), 0, 0));
    batch.set_enabled(2, batch.body_in_row(0), false);
    batch.step(10);
    REQUIRE(frozen(batch.status(1)));
    CHECK(batch.step_contacts(0).size() == 4);
    CHECK(batch.step_contacts(1).empty());
    CHECK_FALSE(batch.touching(1, batch.body_in_row(0)));
    CHECK(batch.step_contacts(2).size() == 2);
    CHECK_FALSE(batch.touching(2, batch.body_in_row(0)));
    CHECK(batch.touching(2, batch.body_in_row(1)));
    CHECK(number(batch, Observed::total_mass, 2) == Approx(1000));
  }
}

TEST_CASE("contacts beyond the room for them are counted", "[fast][observe]") {
  Scene scene = crowd(Space::spatial);
  for (const Table& table : widest_tables()) {
    BatchOptions options = observing(table, {Observer::contacts}, 9);
    Batch all(compile(scene), options);
    options.observe.contacts_per_world = 3;
    Batch some(compile(scene), options);
    all.step(40), some.step(40);
    const auto full = all.step_contacts(5), cut = some.step_contacts(5);
    REQUIRE(full.size() > 3);
    REQUIRE(cut.size() == 3);
    CHECK(number(some, Observed::contact_count, 5) == static_cast<double>(full.size()));
    for (std::size_t i = 0; i < 3; ++i) CHECK(cut[i].normal_impulse == full[i].normal_impulse);
  }
}

TEST_CASE("observers that were not chosen say so", "[fast][observe]") {
  const Plan plan = compile(crowd(Space::planar));
  Batch none(plan, {.worlds = 2});
  double x = 0;
  CHECK_THROWS_WITH(none.read(Observed::total_mass, 0, {&x, 1}),
                    Catch::Contains("nothing is observed"));
  BatchOptions options{.worlds = 2};
  options.observe.what = {Observer::penetration};
  Batch batch(plan, options);
  CHECK_THROWS_WITH(batch.read(Observed::total_mass, 0, {&x, 1}),
                    Catch::Contains("total_mass is not observed: give Observer::motion"));
  CHECK_THROWS_WITH(batch.step_contacts(0), Catch::Contains("Observer::contacts"));
  std::vector<double> wrong(3);
  CHECK_THROWS_WITH(batch.read(Observed::penetration, wrong),
                    "penetration has 2 values, the buffer has 3");
  std::vector<float> right(2);
  batch.step(3);
  batch.read(Observed::penetration, std::span<float>(right));
  options.observe.contacts_per_world = -1;
  CHECK_THROWS_WITH(Batch(plan, options), Catch::Contains("contacts_per_world is -1"));
}

}  // namespace manyworlds::test
