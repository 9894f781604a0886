// Integrators: discrete closed forms, stiff springs, contacts beside free flight, equal bits.
#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr Integrator kAllIntegrators[] = {Integrator::symplectic_euler, Integrator::explicit_euler,
                                          Integrator::implicit_euler,   Integrator::verlet,
                                          Integrator::velocity_verlet,  Integrator::runge_kutta4};

// Euler's symplectic method as textbooks have it is the one that does not split rotations.
void choose_integrator(Scene& scene, Integrator integrator) {
  scene.options.integrator = integrator;
  if (integrator == Integrator::symplectic_euler) scene.options.rotation = Rotation::exponential;
}

// A mass of 1 kg on a spring to the origin, released at x = 1 m.
Scene oscillator(Space space, double stiffness, double h) {
  Scene scene = empty_scene(space, 0);
  scene.options.dt = h, scene.options.substeps = 1;
  scene.add(lump(space, 1, {0.1, 0.1, 0.1}, {1, 0, 0}));
  Joint joint;
  TargetJoint target;
  target.spring.stiffness = stiffness;
  joint.type = target, joint.body_b = BodyId(0);
  scene.add(joint);
  return scene;
}

// Bodies on springs among bodies that touch: a crowd of which some are tied.
Scene tied_crowd(Space space) {
  Scene scene = crowd(space, 12);
  const auto tie = [&](int a, int b, JointType type) {
    Joint joint;
    joint.type = std::move(type), joint.body_a = BodyId(a), joint.body_b = BodyId(b);
    joint.frame_b.position = {0.1, 0.2, 0};
    joint.collide = true;
    scene.add(joint);
  };
  TargetJoint target;
  target.spring.stiffness = 400, target.spring.damping = 5;
  DistanceJoint line;
  line.length = 1, line.spring = Spring{300, 2, 0, 0};
  tie(-1, 2, target), tie(3, 4, line), tie(5, 6, target), tie(7, 8, line);
  scene.attractors = {{Vec3::UnitX() + up_of(space), 2, 0.5}};
  return scene;
}

}  // namespace

TEST_CASE("bodies fall as each integrator's sum says", "[fast][integrator]") {
  for (const Table& table : widest_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      for (Integrator integrator : kAllIntegrators) {
        Scene scene = empty_scene(space, 9.81);
        choose_integrator(scene, integrator);
        scene.options.dt = 0.04, scene.options.substeps = 2;
        Body ball = body_of(shape_of(round_of(space, 0.1)), Vec3::Zero());
        ball.linear_velocity = 3 * up_of(space);
        scene.add(ball);
        Batch batch(compile(scene), options_of(table));
        batch.step(50);
        const double n = 100, h = 0.02, t = n * h;
        const double steps =
            integrator == Integrator::explicit_euler ? n * (n - 1)
            : integrator == Integrator::symplectic_euler || integrator == Integrator::implicit_euler
                ? n * (n + 1)
                : n * n;
        INFO(name(table) << ' ' << to_string(integrator));
        const double fallen = 3 * t - 9.81 * h * h / 2 * steps;
        CHECK(up_of(space).dot(position(batch, 0, 0)) ==
              Approx(fallen).epsilon(pick(table, 3e-6, 1e-13)));
        CHECK(up_of(space).dot(velocity(batch, 0, 0)) ==
              Approx(3 - 9.81 * t).epsilon(pick(table, 3e-6, 1e-13)));
      }
    }
  }
}

TEST_CASE("each integrator changes the energy of a spring as its recurrence says",
          "[fast][integrator]") {
  if (!has_table(double_table())) return;
  const double k = 40, h = 0.02, z2 = h * h * k;
  for (Space space : {Space::planar, Space::spatial}) {
    for (Integrator integrator : kAllIntegrators) {
      Scene scene = oscillator(space, k, h);
      choose_integrator(scene, integrator);
      Batch batch(compile(scene), options_of(double_table()));
      // What stays the same but for a factor per step (numerics.md 0.4).
      const auto kept = [&] {
        const double x = position(batch, 0, 0).x(), v = velocity(batch, 0, 0).x();
        switch (integrator) {
          case Integrator::symplectic_euler: return v * v + k * x * x - h * k * x * v;
          case Integrator::verlet: return v * v * (1 - z2 / 4) + k * x * x;
          case Integrator::velocity_verlet: return v * v + k * x * x * (1 - z2 / 4);
          default: return v * v + k * x * x;
        }
      };
      const double factor = integrator == Integrator::explicit_euler   ? 1 + z2
                            : integrator == Integrator::implicit_euler ? 1 / (1 + z2)
                            : integrator == Integrator::runge_kutta4
                                ? 1 - std::pow(z2, 3) / 72 + std::pow(z2, 4) / 576
                                : 1;
      const double start = kept();
      batch.step(200);
      INFO(to_string(integrator));
      CHECK(kept() / start == Approx(std::pow(factor, 200)).epsilon(1e-11));
    }
  }
}

TEST_CASE("implicit Euler takes springs of any stiffness", "[fast][integrator]") {
  for (const Table& table : widest_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      for (double stiffness : {1e2, 1e5, 1e8}) {
        // A chain of four on springs, held off-centre, that swings down and comes to rest.
        Scene scene = empty_scene(space, 10);
        scene.options.integrator = Integrator::implicit_euler;
        scene.options.substeps = 1;
        for (int i = 0; i < 4; ++i) {
          scene.add(lump(space, 1, {0.1, 0.1, 0.1}, {0.5 + 0.7 * i, 0, 0}));
          scene.bodies.back().linear_drag = scene.bodies.back().angular_drag = 1;
          DistanceJoint line;
          line.length = 0.3, line.spring = Spring{stiffness, 1, 0, 0};
          Joint joint;
          joint.type = line, joint.body_a = BodyId(i - 1), joint.body_b = BodyId(i);
          if (i > 0) joint.frame_a.position = {0.2, 0, 0};
          joint.frame_b.position = {-0.2, 0, 0};
          scene.add(joint);
        }
        Batch batch(compile(scene), options_of(table));
        double most = 0;
        for (int i = 0; i < 600; ++i) {
          batch.step();
          most = std::max(most, max_speed(batch, 0));
        }
        INFO(name(table) << " stiffness " << stiffness << " fastest " << most);
        CHECK(batch.status(0) == Status::ok);
        CHECK(most < 20);
        // It hangs: each spring bears what is below it.
        CHECK(max_speed(batch, 0) < 0.3);
        const double low = up_of(space).dot(position(batch, 0, 3));
        const double sag = 10 * (4 + 3 + 2 + 1) / stiffness;
        CHECK(low == approx(-(4 * 0.3 + 7 * 0.2 + sag), 0.1));
      }
    }
  }
}

TEST_CASE("a world that explicit Euler blows up is frozen, and its neighbours keep their bits",
          "[fast][integrator]") {
  for (const Table& table : all_tables()) {
    Scene scene = oscillator(Space::spatial, 1e8, 1.0 / 60);
    scene.options.integrator = Integrator::explicit_euler;
    scene.options.gravity = {0, 0, -1};
    const Plan plan = compile(scene);
    Batch batch(plan, options_of(table, 7)), calm(plan, options_of(table, 7));
    // At the spring's end only gravity acts, but for one world.
    for (int w = 0; w < 7; ++w) {
      for (Batch* b : {&batch, &calm}) set_vector(*b, Field::position, w, 0, Vec3::Zero());
    }
    set_vector(batch, Field::position, 3, 0, {1, 0, 0});
    batch.step(1), calm.step(1);
    batch.step(3), calm.step(3);
    INFO(name(table) << ' ' << to_string(batch.status(3)));
    CHECK(frozen(batch.status(3)));
    for (int w = 0; w < 7; ++w) CHECK((batch.hash(w) == calm.hash(w)) == (w != 3));
  }
}

TEST_CASE("bits do not depend on anything else whatever the integrator", "[fast][integrator]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (Integrator integrator : kAllIntegrators) {
      for (bool contacts : {false, true}) {
        Scene scene = tied_crowd(space);
        choose_integrator(scene, integrator);
        for (Body& body : scene.bodies) {
          if (!contacts) body.shapes[0].filter.mask = 0;
        }
        const Plan plan = compile(scene);
        for (Precision precision : {Precision::f32, Precision::f64}) {
          std::vector<std::uint64_t> wanted;
          for (const Table& table : all_tables()) {
            if (table.precision != precision) continue;
            INFO(name(table) << ' ' << to_string(integrator) << " contacts " << contacts);
            BatchOptions options = options_of(table, 19);
            const auto all = hashes_after(plan, options, 15);
            if (wanted.empty()) wanted = all;
            CHECK(all == wanted);
            options.threads = 3;
            CHECK(hashes_after(plan, options, 15) == wanted);
            options.threads = 1, options.worlds = 5, options.seed = 7;
            CHECK(hashes_after(plan, options, 15) ==
                  std::vector<std::uint64_t>(wanted.begin() + 7, wanted.begin() + 12));
            if (!contacts) continue;
            for (ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
              options.layout = layout;
              CHECK(hashes_after(plan, options, 15) ==
                    std::vector<std::uint64_t>(wanted.begin() + 7, wanted.begin() + 12));
            }
          }
        }
      }
    }
  }
}

TEST_CASE("bodies fly by the integrator until they meet something", "[fast][integrator]") {
  for (const Table& table : widest_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      for (Integrator integrator : kAllIntegrators) {
        Scene alone = empty_scene(space), met = empty_scene(space);
        Body ball = body_of(shape_of(round_of(space, 0.2)), 4 * up_of(space));
        ball.linear_velocity = {3, 0, 0};
        alone.add(ball);
        met.add(ground(space)), met.add(ball), met.add(ball);
        met.bodies[2].position += Vec3(-6, 0, 0);
        for (Scene* scene : {&alone, &met}) {
          choose_integrator(*scene, integrator);
          scene->attractors = {{up_of(space), 2, 1}};
        }
        Batch one(compile(alone), options_of(table)), both(compile(met), options_of(table));
        one.step(20), both.step(20);
        INFO(name(table) << ' ' << to_string(integrator));
        const Vec3 gap = position(one, 0, 0) - position(both, 0, 0);
        CHECK(gap.norm() < pick(table, 1e-5, 1e-13));
        both.step(280);
        CHECK(both.status(0) == Status::ok);
        for (int b : {0, 1}) {
          CHECK(up_of(space).dot(position(both, 0, b)) == approx(0.2, 0.02));
        }
      }
    }
  }
}

TEST_CASE("a pile stands and sleeps whatever the integrator", "[fast][integrator]") {
  for (Integrator integrator : kAllIntegrators) {
    Scene scene = empty_scene(Space::spatial);
    choose_integrator(scene, integrator);
    scene.add(ground(Space::spatial));
    for (int i = 0; i < 4; ++i) {
      scene.add(body_of(shape_of(Box{Vec3::Constant(0.5)}), {0, 0, 0.5 + i}));
    }
    BatchOptions options = options_of(widest_tables().front());
    options.sleep = true;
    Batch batch(compile(scene), options);
    batch.step(180);
    INFO(to_string(integrator));
    CHECK(batch.asleep(0, batch.body_in_row(3)));
    CHECK(position(batch, 0, 3).z() == approx(3.5, 0.02));
    CHECK(max_penetration(batch, 0) < 0.01);
  }
}

TEST_CASE("spins as angular momenta keep them", "[fast][integrator]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial, 0);
    scene.options.dt = 1.0 / 200, scene.options.substeps = 1;
    scene.options.integrator = Integrator::explicit_euler;
    scene.options.angular_momentum = true;
    scene.add(lump(Space::spatial, 1, {0.3, 0.2, 0.1}, Vec3::Zero()));
    scene.bodies[0].angular_velocity = {0.1, 5, 0.1};
    Batch batch(compile(scene), options_of(table));
    const Vec3 before = momenta(batch, 0).angular;
    batch.step(2000);
    INFO(name(table));
    CHECK((momenta(batch, 0).angular - before).norm() < pick(table, 2e-4, 1e-12) * before.norm());
  }
}

TEST_CASE("springs as forces can be looked at, let go and copied", "[fast][integrator]") {
  for (const Table& table : widest_tables()) {
    Scene scene = oscillator(Space::planar, 20, 1.0 / 60);
    scene.options.integrator = Integrator::velocity_verlet;
    BatchOptions options = options_of(table, 3);
    options.observe.what = {Observer::joint_loads};
    Batch batch(compile(scene), options);
    batch.step(10);
    std::vector<double> force(2);
    batch.read(Observed::joint_force, 1, force);
    INFO(name(table));
    CHECK(force[0] == Approx(-20 * position(batch, 1, 0).x()).epsilon(1e-5));
    const Snapshot snapshot = batch.save();
    batch.set_joint_enabled(1, JointId(0), false);
    const Vec3 v = velocity(batch, 1, 0);
    batch.step(10);
    CHECK((velocity(batch, 1, 0) - v).norm() < 1e-6);
    CHECK((velocity(batch, 2, 0) - v).norm() > 0.1);
    const auto after = batch.hash(2);
    batch.restore(snapshot);
    batch.step(10);
    CHECK(batch.hash(1) == after);
  }
}

TEST_CASE("a force or a NaN in one world is seen in no other", "[fast][integrator]") {
  for (const Table& table : all_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      for (Integrator integrator : kAllIntegrators) {
        Scene scene = tied_crowd(space);
        choose_integrator(scene, integrator);
        for (Body& body : scene.bodies) {
          body.shapes[0].filter.mask = 0;
          if (body.motion == Motion::dynamic) body.linear_velocity.x() = -0.0;
        }
        const Plan plan = compile(scene);
        Batch disturbed(plan, options_of(table, 19)), quiet(plan, options_of(table, 19));
        for (int i = 0; i < 3; ++i) {
          disturbed.add_force(4, disturbed.body_in_row(1), Vec3(3, 2, 0));
          if (i == 1)
            disturbed.add_force(7, disturbed.body_in_row(2), Vec3::Constant(std::nan("")));
          disturbed.step(2), quiet.step(2);
        }
        INFO(name(table) << ' ' << to_string(integrator));
        CHECK(frozen(disturbed.status(7)));
        for (int w = 0; w < 19; ++w) {
          CHECK((disturbed.hash(w) == quiet.hash(w)) == (w != 4 && w != 7));
          if (w != 7) CHECK(disturbed.status(w) == quiet.status(w));
        }
      }
    }
  }
}

TEST_CASE("what a spring bears is kept while its bodies sleep, whoever is beside them",
          "[fast][integrator]") {
  Scene scene = empty_scene(Space::spatial);
  scene.options.integrator = Integrator::runge_kutta4;
  scene.add(ground(Space::spatial));
  for (double x : {-0.7, 0.7}) {
    scene.add(body_of(shape_of(Box{Vec3::Constant(0.5)}), {x, 0, 0.5}));
  }
  DistanceJoint line;
  line.length = 1, line.spring = Spring{300, 1, 0, 0};
  Joint joint;
  joint.type = line, joint.body_a = BodyId(1), joint.body_b = BodyId(2);
  scene.add(joint);
  BatchOptions options = options_of(widest_tables().front(), 2);
  options.sleep = true, options.observe.what = {Observer::joint_loads};
  const Plan plan = compile(scene);
  Batch calm(plan, options), beside(plan, options);
  for (int i = 0; i < 180; ++i) {
    beside.add_force(1, beside.body_in_row(0), Vec3(0, 100 * (i % 2), 0));
    calm.step(), beside.step();
  }
  REQUIRE(calm.asleep(0));
  REQUIRE(beside.asleep(0));
  CHECK_FALSE(beside.asleep(1));
  std::vector<double> one(3), other(3);
  calm.read(Observed::joint_force, 0, one), beside.read(Observed::joint_force, 0, other);
  CHECK(one == other);
  CHECK(one[0] == Approx(-300 * 0.4).epsilon(1e-2));
}

TEST_CASE("a world that is lost keeps its forces, in one call or several", "[fast][integrator]") {
  for (const Table& table : widest_tables()) {
    Scene scene = oscillator(Space::planar, 1e6, 1.0 / 60);
    scene.options.integrator = Integrator::explicit_euler;
    BatchOptions options = options_of(table);
    options.observe.what = {Observer::joint_loads};
    Batch one(compile(scene), options), many(compile(scene), options);
    for (int i = 0; i < 40; ++i) one.step();
    many.step(40);
    REQUIRE(frozen(many.status(0)));
    std::vector<double> force(2), other(2);
    one.read(Observed::joint_force, 0, force), many.read(Observed::joint_force, 0, other);
    INFO(name(table));
    CHECK(force == other);
    CHECK(one.hash(0) == many.hash(0));
  }
}

}  // namespace manyworlds::test
