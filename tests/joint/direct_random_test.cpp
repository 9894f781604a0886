// Random trees of joints that fall on the ground and on what lies about.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

#include "tests/support/joints.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

std::optional<Limit> random_limit(Random& random, double width) {
  if (random.chance(0.5)) return std::nullopt;
  Limit limit{-random.uniform(0.1, 1) * width, random.uniform(0.1, 1) * width, std::nullopt};
  if (random.chance(0.3)) limit.spring = Spring{0, 0, 5, 0.7};
  return limit;
}
// Motors have a largest force, springs may.
std::optional<Drive> random_drive(Random& random, double width, double mass) {
  if (random.chance(0.5)) return std::nullopt;
  Drive drive;
  drive.target_position = random.uniform(-0.5, 0.5) * width;
  drive.target_speed = random.chance(0.3) ? random.uniform(-3, 3) : 0;
  if (random.chance(0.7)) drive.spring = Spring{0, 0, random.uniform(1, 10), 0.7};
  if (!drive.spring || random.chance(0.6)) drive.max_force = mass * random.uniform(1, 50);
  return drive;
}
JointType random_type(Random& random, Space space, double mass) {
  switch (random.integer(0, 9)) {
    case 0: return FixedJoint{};
    case 1:
    case 2: {
      const auto limit = random_limit(random, 0.3);
      return SliderJoint{limit, random_drive(random, 0.3, mass)};
    }
    case 3: return space == Space::planar ? JointType(HingeJoint{}) : JointType(BallJoint{});
    case 4: {
      const Spring suspension{0, 0, random.uniform(2, 8), 0.7};
      const auto travel = random_limit(random, 0.2);
      return WheelJoint{suspension, travel, random_drive(random, 1, mass)};
    }
    default: {
      const auto limit = random_limit(random, 1);
      return HingeJoint{limit, random_drive(random, 1, mass)};
    }
  }
}

// Up to eight boxes of up to a hundred times the density of others, that do not touch one another.
void add_tree(Random& random, Scene& scene, const Vec3& base) {
  const Space space = scene.space;
  const bool flat = space == Space::planar, anchored = random.chance(0.3);
  const double spread = random.chance(0.5) ? 0 : random.uniform(0, 1);
  struct Link {
    BodyId id;
    Vec3 place, half;
  };
  std::vector<Link> links;
  const Vec3 velocity = anchored ? Vec3(Vec3::Zero()) : Vec3(random.planar_direction() * 2);
  for (int i = 0, n = random.integer(2, 8); i < n; ++i) {
    Vec3 half{random.uniform(0.05, 0.3), random.uniform(0.03, 0.15), random.uniform(0.03, 0.15)};
    if (flat) half.z() = 0;
    const Link* on = nullptr;
    if (i > 0)
      on = &links[static_cast<std::size_t>(random.chance(0.6) ? i - 1 : random.integer(0, i - 1))];
    const double side = random.chance(0.8) ? 1 : -1;
    Vec3 anchor = base - half.x() * Vec3::UnitX(), place = base;
    if (on) {
      anchor = on->place + Vec3(side * on->half.x(), random.uniform(-0.5, 0.5) * on->half.y(), 0);
      place = anchor + side * half.x() * Vec3::UnitX();
    }
    Body body = body_of(shape_of(box_of(space, half), random.uniform(0, 1)), place);
    body.shapes[0].filter = {2, 1};
    body.shapes[0].density = 1000 * std::pow(10, spread * random.uniform(-1, 1));
    body.linear_velocity = velocity;
    if (i == 0 && !anchored) body.jitter.angle = 0.5;
    if (i > 0) body.jitter.with = links[0].id;
    const double mass = mass_properties(scene, body).mass;
    const BodyId id = scene.add(body);
    if (on || anchored) {
      const Frame frame{anchor, random.chance(0.5) ? Quat(Quat::Identity()) : hinge_axes(space)};
      const JointType type = random_type(random, space, mass);
      scene.add(joint_at(scene, on ? on->id : BodyId{}, id, frame, type));
    }
    links.push_back({id, place, half});
  }
}
Scene random_scene(Random& random, Space space) {
  Scene scene = tree_scene(space);
  scene.options.substeps = 4;
  scene.add(ground(space, random.uniform(0, 1)));
  const Vec3 up = up_of(space);
  for (int i = 0, n = random.integer(1, 3); i < n; ++i) {
    add_tree(random, scene, 12.0 * i * Vec3::UnitX() + random.uniform(1.2, 2.5) * up);
  }
  for (int i = 0, n = random.integer(0, 3); i < n; ++i) {
    const Geometry shape = random.chance(0.5) ? cube_of(space, 0.1) : round_of(space, 0.1);
    const Vec3 place = random.uniform(-1, 4) * Vec3::UnitX() + (4 + 0.5 * i) * up;
    scene.add(body_of(shape_of(shape), place));
  }
  return scene;
}

// Up to two joints that close loops between bodies nearby, all of which others hold already.
int add_loops(Random& random, Scene& scene) {
  const std::vector<Joint> joints = scene.joints;
  const auto joined = [&](BodyId a, BodyId b) {
    return std::any_of(joints.begin(), joints.end(), [&](const Joint& j) {
      return (j.body_a == a && j.body_b == b) || (j.body_a == b && j.body_b == a);
    });
  };
  const auto held = [&](BodyId body) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const Joint& j) { return j.body_a == body || j.body_b == body; });
  };
  const int last = static_cast<int>(scene.bodies.size()) - 1;
  int loops = 0;
  for (int tries = 0; tries < 20 && loops < 2; ++tries) {
    const BodyId a(random.integer(1, last)), b(random.integer(1, last));
    if (a == b || joined(a, b) || !held(a) || !held(b)) continue;
    const Vec3 from = scene.at(a).position, to = scene.at(b).position;
    if ((to - from).norm() > 2) continue;
    const bool hinge = scene.space == Space::planar || random.chance(0.3);
    const JointType type = hinge ? JointType(HingeJoint{}) : JointType(BallJoint{});
    scene.add(joint_at(scene, a, b, Frame{(from + to) / 2, hinge_axes(scene.space)}, type));
    ++loops;
  }
  return loops;
}

// Rods, ropes, springs, pulleys and targets on bodies nearby, those of trees and others, or on the
// world; returns how many.
int add_rows(Random& random, Scene& scene) {
  const int last = static_cast<int>(scene.bodies.size()) - 1;
  const Vec3 up = up_of(scene.space);
  int rows = 0;
  for (int tries = 0; tries < 20 && rows < 3; ++tries) {
    const BodyId a(random.integer(1, last)), b(random.integer(1, last));
    const Vec3 from = scene.at(a).position, to = scene.at(b).position;
    const double mass = mass_properties(scene, scene.at(b)).mass;
    if (a == b || (to - from).norm() > 3) continue;
    const bool held = random.chance(0.2);  // to the world
    const double length = (to - from - (held ? up : Vec3(Vec3::Zero()))).norm();
    Joint joint;
    joint.body_b = b;
    held ? void(joint.frame_a.position = from + up) : void(joint.body_a = a);
    const Spring spring{0, 0, random.uniform(1, 20), random.uniform(0, 1)};
    switch (random.integer(0, 4)) {
      case 0: joint.type = DistanceJoint{}; break;
      case 1: joint.type = DistanceJoint{std::nullopt, Limit{0, 1.1 * length + 1, {}}, {}}; break;
      case 2: joint.type = DistanceJoint{length, std::nullopt, spring}; break;
      case 3: {
        if (held) continue;
        joint.type = PulleyJoint{from + 3 * up, to + 3 * up, random.uniform(0.3, 3), {}};
        break;
      }
      default:
        joint.body_a = {};
        joint.frame_a.position = to + 0.2 * up;
        joint.type = TargetJoint{spring, mass * random.uniform(1, 50)};
    }
    scene.add(joint);
    ++rows;
  }
  return rows;
}

// Ball joints with limits, in places of hinges and of what is fixed; returns how many.
int limit_balls(Random& random, Scene& scene) {
  int balls = 0;
  for (Joint& joint : scene.joints) {
    const bool hinge = std::holds_alternative<HingeJoint>(joint.type);
    if (!hinge && !std::holds_alternative<FixedJoint>(joint.type)) continue;
    BallJoint ball;
    ball.cone = random.uniform(0.01, 1.5);
    if (random.chance(0.8)) ball.twist = Limit{-random.uniform(0, 1), random.uniform(0, 1), {}};
    if (random.chance(0.2) && ball.twist) ball.twist->spring = Spring{0, 0, 5, 0.7};
    joint.type = ball;
    ++balls;
  }
  return balls;
}

void check_energies(const Scene& scene, std::uint64_t seed) {
  BatchOptions options = options_of({widest_of(Precision::f32), Precision::f32}, 8);
  options.audit_every = 1;
  Batch batch(compile(scene), options);
  batch.step(240);
  for (int w = 0; w < 8; ++w) {
    INFO("seed " << seed << " world " << w);
    CHECK(batch.status(w) == Status::ok);
  }
}

}  // namespace

// Of these, 1959, 4643 and 9034 lose worlds where limits and drives hold against contacts after
// they gave way, and 2008 where the relaxing pass ends with its first round.
TEST_CASE("random trees that fall gain no energy", "[joint][slow]") {
  std::vector<std::uint64_t> seeds{1959, 2008, 4643, 9034};
  for (std::uint64_t seed = 0; seed < 60; ++seed) seeds.push_back(seed);
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    const Scene scene = random_scene(random, seed % 2 == 0 ? Space::planar : Space::spatial);
    check_energies(scene, seed);
  }
}

TEST_CASE("random trees of ball joints with limits that fall gain no energy", "[joint][slow]") {
  int balls = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    Scene scene = random_scene(random, Space::spatial);
    balls += limit_balls(random, scene);
    check_energies(scene, seed);
  }
  CHECK(balls > 200);
}

// Of these, 6, 22, 87, 102, 110 and 112 gain energy where limits and bounded drives add to the
// effective masses of attached rows.
TEST_CASE("random trees with rods, ropes and springs that fall gain no energy", "[joint][slow]") {
  int rows = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    Random random(seed);
    Scene scene = random_scene(random, seed % 2 == 0 ? Space::planar : Space::spatial);
    rows += add_rows(random, scene);
    for (Body& body : scene.bodies) body.jitter = {};
    check_energies(scene, seed);
  }
  CHECK(rows > 240);
}

// Of these, 739 and 1577 lose worlds with a floor of 1e-5 (loops.hpp).
TEST_CASE("random loops that fall gain no energy", "[joint][slow]") {
  std::vector<std::uint64_t> seeds{739, 1577};
  for (std::uint64_t seed = 0; seed < 60; ++seed) seeds.push_back(seed);
  int looped = 0;
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    Scene scene = random_scene(random, seed % 2 == 0 ? Space::planar : Space::spatial);
    if (add_loops(random, scene) == 0) continue;
    for (Body& body : scene.bodies) body.jitter = {};
    check_energies(scene, seed);
    ++looped;
  }
  CHECK(looped > 40);
}

}  // namespace manyworlds::test
