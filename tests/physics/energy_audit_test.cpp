// Status::diverged: worlds that gain energy from nothing are flagged, and no others are.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/random_scene.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

BatchOptions audited(int worlds, int every = 1) {
  BatchOptions o = options_of(widest_tables()[0], worlds);
  o.audit_every = every;
  return o;
}
int diverged(const Batch& batch) {
  int n = 0;
  for (int w = 0; w < batch.worlds(); ++w) n += has(batch.status(w), Status::diverged) ? 1 : 0;
  return n;
}
int diverged_after(const Scene& scene, int steps, int worlds = 8) {
  Batch batch(compile(scene), audited(worlds));
  batch.step(steps);
  return diverged(batch);
}

Joint grip_of(double stiffness) {
  Joint joint;
  joint.type = TargetJoint{.spring = Spring{.stiffness = stiffness}};
  joint.body_b = BodyId(0);
  return joint;
}

// The largest gain of a world's mechanical energy in a step, of its kinetic energy before.
double most_gain(const Scene& scene, int world) {
  Batch batch(compile(scene), audited(8));
  double most = 0;
  while (!has(batch.status(world), Status::diverged)) {
    const Energy before = batch.energy(world);
    batch.step();
    const Energy after = batch.energy(world);
    const double gain = after.kinetic + after.potential - before.kinetic - before.potential;
    most = std::max(most, gain / before.kinetic);
  }
  return most;
}

// A ball of 1 kg that a spring draws to a point 1 m away.
Scene spring_of(Space space, double stiffness, Integrator integrator) {
  Scene scene;
  scene.space = space;
  scene.options.gravity.setZero();
  scene.options.integrator = integrator;
  scene.options.substeps = 1;
  Body ball;
  ball.mass_properties = MassProperties{.mass = 1};
  ball.position = {1, 0, 0};
  scene.add(ball);
  scene.add(grip_of(stiffness));
  return scene;
}

// A bar of 1 m on a hinge at its end.
Scene bar_on_hinge(Space space) {
  Scene scene;
  scene.space = space;
  scene.options.gravity = {0, -10, 0};
  Body bar;
  bar.shapes = {
      {space == Space::planar ? Geometry(Polygon::box(0.5, 0.1)) : Geometry(Box{{0.5, 0.1, 0.1}})}};
  bar.position = {0.5, 0, 0};
  scene.add(bar);
  Joint hinge;
  hinge.type = HingeJoint{};
  hinge.body_b = BodyId(0);
  hinge.frame_b.position = {-0.5, 0, 0};
  scene.add(hinge);
  return scene;
}

Scene driven_bar(Space space, Solver solver, const Drive& drive) {
  Scene scene = bar_on_hinge(space);
  scene.options.solver.method = solver;
  std::get<HingeJoint>(scene.joints[0].type).drive = drive;
  return scene;
}

std::vector<std::uint8_t> mask_of(const Batch& batch, int world) {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(batch.worlds()));
  mask[static_cast<std::size_t>(world)] = 1;
  return mask;
}

}  // namespace

TEST_CASE("named scenes gain no energy from nothing, and audits change no bit",
          "[fast][audit][long]") {
  for (const auto& entry : scenes::all()) {
    INFO(entry.name);
    const Plan plan = compile(entry.make());
    Batch often(plan, audited(8)), never(plan, audited(8, 0));
    often.step(240), never.step(240);
    CHECK(diverged(often) == 0);
    CHECK(often.hash() == never.hash());
  }
}

TEST_CASE("alarms in random scenes are true", "[audit]") {
  int flagged = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    INFO("seed " << seed);
    const Scene scene = random_scene(seed).scene;
    Batch batch(compile(scene), audited(8));
    batch.step(240);
    for (int w = 0; w < batch.worlds(); ++w) {
      if (!has(batch.status(w), Status::diverged)) continue;
      ++flagged;
      INFO("world " << w);
      CHECK(most_gain(scene, w) > 0.5);
    }
  }
  // One so far: a thin box that spins by 4 rad in a step as it meets a wall.
  CHECK(flagged <= 1);
}

TEST_CASE("an explicit integrator diverges where the step is too long, and nothing else does",
          "[fast][audit]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    // Explicit Euler multiplies the energy by 1 + (w h)^2 in each step, here by 1.03 and by 3.8.
    for (const double k : {100.0, 1e4}) {
      CHECK(diverged_after(spring_of(space, k, Integrator::explicit_euler), 240) == 8);
      CHECK(diverged_after(spring_of(space, k, Integrator::implicit_euler), 240) == 0);
      CHECK(diverged_after(spring_of(space, k, Integrator::symplectic_euler), 240) == 0);
    }
    CHECK(diverged_after(spring_of(space, 100, Integrator::runge_kutta4), 240) == 0);
    CHECK(diverged_after(spring_of(space, 4e4, Integrator::runge_kutta4), 240) == 8);
  }
}

TEST_CASE("inputs give energy that a world may have", "[fast][audit]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    Scene scene = spring_of(space, 1, Integrator::symplectic_euler);
    scene.joints.clear();
    const auto run = [&](auto&& input) {
      Batch batch(compile(scene), audited(9));
      for (int step = 0; step < 120; ++step) {
        for (int w = 0; w < batch.worlds(); ++w) input(batch, w, step);
        batch.step();
      }
      return diverged(batch);
    };
    scene.joints = {grip_of(1e-3)};  // so that it is audited at all
    CHECK(run([](Batch& b, int w, int) { b.add_force(w, BodyId(0), Vec3(1e4, 5e3, 0)); }) == 0);
    CHECK(run([](Batch& b, int w, int) { b.add_torque(w, BodyId(0), Vec3(0, 0, 1e3)); }) == 0);
    CHECK(run([](Batch& b, int w, int step) {
            b.add_impulse(w, BodyId(0), {step % 2 == 0 ? 100.0 : -90.0, 0, 0});
          }) == 0);
    CHECK(run([](Batch& b, int w, int step) {
            set_vector(b, Field::linear_velocity, w, 0, Vec3(step, step % 7, 0));
          }) == 0);
    CHECK(run([](Batch& b, int w, int step) {
            if (step % 10 == w) b.reset(mask_of(b, w));
          }) == 0);
    // A spring that is stretched far, or stiff, gives what it holds.
    scene.joints = {grip_of(1e6)};
    CHECK(run([](Batch& b, int w, int step) {
            if (step % 20 == 0) set_vector(b, Field::position, w, 0, Vec3(10, 3, 0));
          }) == 0);
  }
}

TEST_CASE("drives give energy that a world may have", "[fast][audit]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    for (const Solver solver :
         {Solver::tgs_soft, Solver::sequential_impulse, Solver::sor, Solver::nncg}) {
      INFO(to_string(solver));
      // Motors and servos that start a bar from rest, and a springy limit.
      const Drive motor{.target_speed = 30}, weak{.target_speed = 30, .max_force = 3};
      const Drive soft{.target_position = 2,
                       .spring = Spring{.frequency = 10, .damping_ratio = 0.5}};
      for (const Drive& drive : {motor, weak, soft}) {
        CHECK(diverged_after(driven_bar(space, solver, drive), 240) == 0);
      }
      Scene scene = bar_on_hinge(space);
      scene.options.solver.method = solver;
      scene.bodies[0].angular_velocity = {0, 0, 10};
      std::get<HingeJoint>(scene.joints[0].type).limit =
          Limit{.low = -0.3, .high = 0.3, .spring = Spring{.stiffness = 1000}};
      CHECK(diverged_after(scene, 240) == 0);
    }
  }
}

TEST_CASE("an arm that its servos whirl has diverged", "[fast][audit]") {
  // Four links whose stiff servos are swept over, one after the other.
  Scene scene;
  scene.space = Space::planar;
  scene.options.gravity.setZero();
  BodyId last;
  for (int i = 0; i < 4; ++i) {
    Body link = body_of(shape_of(Polygon::box(0.5, 0.05)), {0.5 + i, 0, 0});
    link.shapes[0].filter.mask = 0;
    const BodyId id = scene.add(link);
    HingeJoint servo;
    servo.drive = Drive{.target_position = i % 2 == 0 ? 1.5 : -1.0,
                        .spring = Spring{.stiffness = 1e6, .damping = 1e3}};
    scene.add(joint_at(scene, last, id, Frame{Vec3(i, 0, 0)}, servo));
    last = id;
  }
  scene.options.joint.method = JointMethod::sweep;
  CHECK(diverged_after(scene, 240) == 8);
  scene.options.joint.method = JointMethod::tree;
  CHECK(diverged_after(scene, 240) == 0);
}

TEST_CASE("kinematic bodies give energy that a world may have", "[fast][audit]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    Scene scene = bar_on_hinge(space);
    scene.joints.clear();
    // A bar that spins by hand bats what rests beside it.
    scene.bodies[0].motion = Motion::kinematic;
    scene.bodies[0].angular_velocity = {0, 0, 20};
    for (const double y : {-0.5, 0.5}) {
      Body ball;
      ball.shapes = {{space == Space::planar ? Geometry(Circle{0.2}) : Geometry(Sphere{0.2})}};
      ball.position = {0.8, y, 0};
      scene.add(ball);
    }
    CHECK(diverged_after(scene, 240) == 0);
  }
}

TEST_CASE("kinematic bodies may lift others for as long as they like", "[fast][audit]") {
  for (const Space space : kSpaces) {
    for (const double speed : {0.05, 0.5, 5.0}) {
      for (const bool welded : {false, true}) {
        INFO(speed << " m/s, welded " << welded);
        Scene scene = empty_scene(space, 9.81);
        const Vec3 up = up_of(space);
        Body plate = body_of(shape_of(box_of(space, {1, 0.1, 1})), Vec3::Zero());
        if (space == Space::spatial) plate.shapes = {shape_of(box_of(space, {1, 1, 0.1}))};
        plate.motion = Motion::kinematic;
        plate.linear_velocity = speed * up;
        const BodyId lift = scene.add(plate);
        Body load = body_of(shape_of(cube_of(space, 0.2)), (welded ? 2 : 0.3) * up);
        load.linear_velocity = speed * up;
        const BodyId cube = scene.add(load);
        const Frame frame{0.2 * up, Quat::Identity()};
        if (welded) scene.add(joint_at(scene, lift, cube, frame, FixedJoint{}));
        CHECK(diverged_after(scene, 300) == 0);
      }
    }
  }
}

TEST_CASE("what is audited is a world's own", "[fast][audit][bits]") {
  // Some worlds diverge, and when they are flagged depends on nothing but themselves.
  Scene scene = spring_of(Space::spatial, 2500, Integrator::explicit_euler);
  scene.bodies[0].jitter.position = {0.9, 0, 0};
  constexpr int kWorlds = 21, kSteps = 37;
  const auto statuses = [&](BatchOptions o, int first, int at_once) {
    o.seed = static_cast<std::uint64_t>(first);
    Batch batch(compile(scene), o);
    for (int left = kSteps; left > 0; left -= at_once) batch.step(std::min(left, at_once));
    std::vector<Status> out;
    for (int w = 0; w < batch.worlds(); ++w) out.push_back(batch.status(w));
    return out;
  };
  for (const int every : {1, 3, 16}) {
    const std::vector<Status> expected = statuses(audited(kWorlds, every), 0, 1);
    for (const Table& table : all_tables()) {
      if (table.precision != widest_tables()[0].precision) continue;
      BatchOptions o = options_of(table, kWorlds);
      o.audit_every = every;
      CHECK(statuses(o, 0, 1) == expected);
      CHECK(statuses(o, 0, 5) == expected);
      CHECK(statuses(o, 0, kSteps) == expected);
      o.threads = 2;
      CHECK(statuses(o, 0, 7) == expected);
      o.threads = 1, o.worlds = 4;
      const std::vector<Status> part(expected.begin() + 7, expected.begin() + 11);
      CHECK(statuses(o, 7, 3) == part);
    }
  }
}

TEST_CASE("a flagged world goes on, and a reset takes the flag away", "[fast][audit]") {
  const Scene scene = spring_of(Space::spatial, 100, Integrator::explicit_euler);
  BatchOptions often = audited(2), never = audited(2, 0), defaults = audited(2, 16);
  Batch a(compile(scene), often), b(compile(scene), never), c(compile(scene), defaults);
  for (Batch* batch : {&a, &b, &c}) batch->step(400);
  CHECK(a.status(0) == Status::diverged);
  CHECK(to_string(a.status(0)) == "diverged");
  CHECK(b.status(0) == Status::ok);
  CHECK(c.status(0) == Status::diverged);
  CHECK(a.hash(0) == b.hash(0));
  CHECK(a.lost_worlds() == 0);
  const Snapshot saved = a.save();
  a.reset();
  CHECK(a.status(0) == Status::ok);
  a.restore(saved);
  CHECK(a.status(1) == Status::diverged);
  CHECK_THROWS_WITH(Batch(compile(scene), audited(1, 256)), "audit_every is 256, must be 0 to 255");
  CHECK_THROWS_WITH(Batch(compile(scene), audited(1, -1)), "audit_every is -1, must be 0 to 255");
}

}  // namespace manyworlds::test
