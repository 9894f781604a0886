// Trees of joints solved at once, against the whole system of equations in double precision.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/joint_twin.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

JointType random_twin_type(Random& random, Space space) {
  const Spring spring{random.uniform(0, 500), random.uniform(0.1, 20), 0, 0};
  std::optional<Drive> drive;
  if (random.chance(0.4)) drive = Drive{random.uniform(-1, 1), random.uniform(-1, 1), spring};
  switch (random.integer(space == Space::planar ? 1 : 0, 4)) {
    case 0: return BallJoint{};
    case 1: return HingeJoint{std::nullopt, drive};
    case 2: return SliderJoint{std::nullopt, drive};
    case 3: return FixedJoint{};
    default: return WheelJoint{spring};
  }
}

// Up to 20 bodies that branch, on the world or free, with the child on either side of its joint;
// somewhat apart, and in motion.
Scene random_tree(Random& random, Space space) {
  Scene scene = empty_scene(space, 10);
  scene.options.dt = 1e-3, scene.options.substeps = 1;
  scene.options.joint.method = JointMethod::tree;
  const bool planar = space == Space::planar;
  const int bodies = random.integer(1, 20);
  const bool anchored = bodies == 1 || random.chance(0.6);
  const auto place = [&](double size) {
    Vec3 p = random.in_cube(size);
    if (planar) p.z() = 0;
    return p;
  };
  const auto turn = [&] {
    return planar ? Quat(Eigen::AngleAxisd(random.uniform(-3, 3), Vec3::UnitZ()))
                  : random.rotation();
  };
  std::vector<Vec3> places;
  for (int i = 0; i < bodies; ++i) {
    const int hangs_on = i == 0 ? -1 : random.integer(0, i - 1);
    const Vec3 on = hangs_on < 0 ? Vec3::Zero() : places[static_cast<std::size_t>(hangs_on)];
    const Vec3 at = on + place(1);
    places.push_back(at);
    const double mass = std::pow(10, random.uniform(-1, 1.5));
    Vec3 inertia = Vec3::Constant(mass * std::pow(10, random.uniform(-3, -0.5)));
    inertia.x() *= random.uniform(1, 1.8);
    const BodyId body = scene.add(lump(space, mass, inertia, at));
    scene.bodies.back().rotation = turn();
    if (hangs_on < 0 && !anchored) continue;
    const BodyId other = hangs_on < 0 ? BodyId{} : BodyId(hangs_on);
    const Frame frame{on + place(0.5), turn()};
    const JointType type = random_twin_type(random, space);
    const bool reversed = other && random.chance(0.5);
    scene.add(reversed ? joint_at(scene, body, other, frame, type)
                       : joint_at(scene, other, body, frame, type));
  }
  for (Body& body : scene.bodies) {
    body.position += place(1e-3);
    body.linear_velocity = place(1);
  }
  return scene;
}

int freedom(const JointType& type) {
  if (std::holds_alternative<BallJoint>(type)) return 3;
  if (std::holds_alternative<WheelJoint>(type)) return 2;
  return std::holds_alternative<FixedJoint>(type) ? 0 : 1;
}
// Joints that close loops, between bodies that others leave free enough; returns how many.
int add_closures(Random& random, Scene& scene) {
  const bool planar = scene.space == Space::planar;
  const auto bodies = static_cast<int>(scene.bodies.size());
  std::vector<int> parent(scene.bodies.size(), -1), free(scene.bodies.size(), 0);
  for (const Joint& joint : scene.joints) {
    const int a = joint.body_a ? joint.body_a.index() : -1;
    const int b = joint.body_b ? joint.body_b.index() : -1;
    const auto child = static_cast<std::size_t>(std::max(a, b));
    parent[child] = std::min(a, b), free[child] = freedom(joint.type);
  }
  const auto up_to = [&](int body, int other) {  // where both meet
    int sum = 0;
    for (int a = body, b = other; a != b; a = parent[static_cast<std::size_t>(a)]) {
      if (a < b) std::swap(a, b);
      sum += free[static_cast<std::size_t>(a)];
    }
    return sum;
  };
  int closures = 0;
  for (int tries = 0; tries < 20 && closures < 3; ++tries) {
    const int a = random.integer(0, bodies - 1), b = random.integer(0, bodies - 1);
    if (a == b || up_to(a, b) < (planar ? 4 : 6)) continue;
    const Vec3 on = (scene.at(BodyId(a)).position + scene.at(BodyId(b)).position) / 2;
    const JointType type = planar ? JointType(HingeJoint{}) : JointType(BallJoint{});
    scene.add(joint_at(scene, BodyId(a), BodyId(b), Frame{on, Quat::Identity()}, type));
    ++closures;
  }
  return closures;
}

// A body that hangs on no joint, and a spring between two that are not joined, or to the world. It
// has the stiffness that it takes to move a body in a step, or a thousandth or thousand times that.
void add_spring(Random& random, Scene& scene) {
  const bool planar = scene.space == Space::planar;
  const auto place = [&](double size) {
    Vec3 p = random.in_cube(size);
    if (planar) p.z() = 0;
    return p;
  };
  const double mass = std::pow(10, random.uniform(-1, 1.5));
  const Vec3 inertia = Vec3::Constant(mass * std::pow(10, random.uniform(-3, -0.5)));
  scene.add(lump(scene.space, mass, inertia, place(3)));
  const auto bodies = static_cast<int>(scene.bodies.size());
  Joint joint;
  const BodyId a(random.integer(-1, bodies - 1)), b(random.integer(0, bodies - 2));
  if (a != b && a.index() >= 0) joint.body_a = a;
  joint.body_b = b;
  joint.frame_a.position = place(0.5), joint.frame_b.position = place(0.5);
  const double length = (frame_in_world(scene, joint.body_b, joint.frame_b).position -
                         frame_in_world(scene, joint.body_a, joint.frame_a).position)
                            .norm();
  const double dt = scene.options.dt, damping = mass / dt * std::pow(10, random.uniform(-3, 3));
  joint.type = DistanceJoint{std::abs(length + random.uniform(-2e-3, 2e-3)), std::nullopt,
                             Spring{damping / dt * random.uniform(0, 1), damping}};
  scene.add(joint);
}

double fastest_of(const JointTwin& twin) {
  double fastest = 1;
  for (const TwinBody& b : twin.closing()) fastest = std::max(fastest, b.linear.norm());
  return fastest;
}
// A step of the scene does what one of the twin has done.
void check_step(const Scene& scene, const JointTwin& twin, const Table& table, double fastest) {
  Batch batch(compile(scene), options_of(table));
  REQUIRE(batch.plan().resolved().joint.method == JointMethod::tree);
  batch.step();
  double moved = 0, turned = 0, speed = 0;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const auto& start = scene.bodies[static_cast<std::size_t>(i)];
    const TwinBody& closing = twin.closing()[static_cast<std::size_t>(i)];
    const TwinBody& end = twin.bodies()[static_cast<std::size_t>(i)];
    const Vec3 way = position(batch, 0, i) - start.position;
    moved = std::max(moved, (way - scene.options.dt * closing.linear).norm());
    const Quat off = rotation(batch, 0, i) * end.rotation.conjugate();
    turned = std::max(turned, 2 * off.vec().norm());
    speed = std::max(speed, (velocity(batch, 0, i) - end.linear).norm());
  }
  INFO(name(table) << ", " << scene.bodies.size() << " bodies, fastest " << fastest);
  CHECK(moved < pick(table, 2e-6, 1e-11) * fastest);
  CHECK(turned < pick(table, 2e-4, 1e-7) * fastest);
  CHECK(speed < pick(table, 5e-4, 1e-8) * fastest);
}

}  // namespace

TEST_CASE("trees of joints move as the whole system of equations says", "[fast][joint]") {
  Random random(20);
  int looped = 0;
  for (const Space space : {Space::planar, Space::spatial}) {
    for (int k = 0; k < 90; ++k) {
      Scene scene = random_tree(random, space);
      const int closures = k < 60 ? 0 : add_closures(random, scene);
      JointTwin twin(scene);
      twin.step(scene.options.dt);
      const double fastest = fastest_of(twin);
      if (closures > 0 && fastest > 15) continue;  // all but singular
      looped += closures > 0;
      for (const Table& table : widest_tables()) {
        // In float32 the floor of loops shows where they hardly give way (loops.hpp).
        if (closures > 0 && table.precision == Precision::f32) continue;
        INFO((space == Space::planar ? "planar" : "spatial")
             << " tree " << k << ", loops " << closures);
        check_step(scene, twin, table, fastest);
      }
    }
  }
  CHECK(looped > 30);
}

TEST_CASE("trees with a spring attached move as the whole system of equations says",
          "[fast][joint]") {
  Random random(21);
  for (const Space space : {Space::planar, Space::spatial}) {
    for (int k = 0; k < 60; ++k) {
      Scene scene = random_tree(random, space);
      add_spring(random, scene);
      scene.options.gravity.setZero();  // one that is free moves by its mean speed
      JointTwin twin(scene);
      twin.step(scene.options.dt);
      for (const Table& table : widest_tables()) {
        INFO((space == Space::planar ? "planar" : "spatial") << " tree " << k);
        check_step(scene, twin, table, fastest_of(twin));
      }
    }
  }
}

}  // namespace manyworlds::test
