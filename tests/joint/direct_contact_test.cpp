// Contacts of bodies of trees: the whole tree stands behind them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr Space kSpaces[] = {Space::planar, Space::spatial};

Scene tree_scene(Space space) {
  Scene scene = empty_scene(space, 10);
  scene.options.joint.method = JointMethod::tree;
  scene.options.substeps = 4;
  scene.add(ground(space));
  return scene;
}
Body block(Space space, double mass, const Vec3& half, const Vec3& place) {
  Body body = body_of(shape_of(box_of(space, half)), place);
  const Vec3 square = half.cwiseProduct(half);
  const Vec3 moments = mass / 3 * (Vec3::Constant(square.sum()) - square);
  body.mass_properties = MassProperties{mass, Vec3::Zero(), moments.asDiagonal()};
  return body;
}

// A plate on legs of three welded links of 0.1 kg each, 5 cm above the ground.
Scene table_of(Space space, double mass) {
  Scene scene = tree_scene(space);
  const Vec3 up = up_of(space);
  const Vec3 thin = space == Space::planar ? Vec3(0.3, 0.05, 0) : Vec3(0.3, 0.3, 0.05);
  const BodyId plate = scene.add(block(space, mass, thin, 0.4 * up));
  scene.bodies.back().shapes[0].filter.mask = 0;
  for (const double x : {-0.2, 0.2}) {
    for (const double y : {-0.2, 0.2}) {
      if (space == Space::planar && y > 0) continue;
      BodyId last = plate;
      for (int i = 0; i < 3; ++i) {
        const Vec3 top = Vec3(x, space == Space::planar ? 0 : y, 0) + (0.35 - 0.1 * i) * up;
        const Vec3 half = space == Space::planar ? Vec3(0.02, 0.05, 0) : Vec3(0.02, 0.02, 0.05);
        const BodyId link = scene.add(block(space, 0.1, half, top - 0.05 * up));
        if (i < 2) scene.bodies.back().shapes[0].filter.mask = 0;
        scene.add(joint_at(scene, last, link, at(top), FixedJoint{}));
        last = link;
      }
    }
  }
  return scene;
}

}  // namespace

TEST_CASE("welded legs bear a thousand times their mass", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double mass : {1.0, 10.0, 100.0, 1000.0}) {
      const Scene scene = table_of(space, mass);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        double deepest = 0, speed = 0, gap = 0;
        for (int i = 0; i < 300; ++i) {
          batch.step();
          deepest = std::max(deepest, max_penetration(batch, 0));
          gap = std::max(gap, worst_gap(batch, 0));
          if (i >= 240) speed = std::max(speed, max_speed(batch, 0));
        }
        INFO(name(table) << " " << (space == Space::planar ? "planar " : "spatial ") << mass
                         << " kg, deepest " << deepest << " gap " << gap << " speed " << speed
                         << " rests " << max_penetration(batch, 0));
        CHECK(batch.status(0) == Status::ok);
        CHECK(max_penetration(batch, 0) < 1e-3);
        CHECK(deepest < 3e-3);
        CHECK(gap < 1e-4);
        CHECK(speed < 1e-3);
      }
    }
  }
}

namespace {

// Ten links of 0.1 kg and 10 cm with a load on top, nearly upright, that touch the ground alone.
Scene rope_of(Space space, double load, double friction) {
  Scene scene = tree_scene(space);
  const bool flat = space == Space::planar;
  scene.bodies[0].shapes[0].material.friction = friction;
  const Vec3 up = up_of(space);
  const JointType type = flat ? JointType(HingeJoint{}) : JointType(BallJoint{});
  BodyId last;
  for (int i = 0; i < 11; ++i) {
    const Vec3 half = i == 10 ? Vec3(0.05, 0.05, flat ? 0 : 0.05)
                              : (flat ? Vec3(0.01, 0.04, 0) : Vec3(0.01, 0.01, 0.04));
    Body link = block(space, i == 10 ? load : 0.1, half, (0.1 + 0.1 * i) * up);
    link.shapes[0].material.friction = friction;
    link.shapes[0].filter = {2, 1};
    link.jitter.position = {0.003, 0, 0};
    link.jitter.angle = 0.02;
    const BodyId id = scene.add(link);
    if (last) scene.add(joint_at(scene, last, id, at((0.05 + 0.1 * i) * up), type));
    last = id;
  }
  return scene;
}

}  // namespace

TEST_CASE("ropes fold under a hundred times a link's mass", "[joint][fast]") {
  constexpr int kWorlds = 16;
  for (const Space space : kSpaces) {
    for (const double friction : {0.0, 0.6}) {
      const Scene scene = rope_of(space, 10, friction);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table, kWorlds));
        double gain = 0, gap = 0, rests = 0;
        std::vector<double> start;
        for (int w = 0; w < kWorlds; ++w) start.push_back(energy_of(batch, w));
        for (int i = 0; i < 300; ++i) {
          batch.step();
          for (int w = 0; w < kWorlds; ++w) {
            gain = std::max(gain, energy_of(batch, w) - start[static_cast<std::size_t>(w)]);
            gap = std::max(gap, worst_gap(batch, w));
            if (i == 299) rests = std::max(rests, max_penetration(batch, w));
          }
        }
        INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " friction "
                         << friction << " gain " << gain << " rests " << rests << " gap " << gap);
        for (int w = 0; w < kWorlds; ++w) CHECK(batch.status(w) == Status::ok);
        CHECK(gain < 0.01);  // J; it falls by 100 J
        CHECK(rests < 2e-3);
        CHECK(gap < 0.1);  // links lash by 20 m/s where the load strikes them
      }
    }
  }
}

TEST_CASE("free trees that collide keep their momentum", "[joint][fast]") {
  if (!has_table(double_table())) return;
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    scene.options.joint.method = JointMethod::tree;
    const bool flat = space == Space::planar;
    const Vec3 half = flat ? Vec3(0.2, 0.1, 0) : Vec3(0.2, 0.1, 0.15);
    for (const double side : {-1.0, 1.0}) {
      BodyId last;
      for (int i = 0; i < 4; ++i) {
        Body body = block(space, 1 + i, half, {side * 0.45 * (i + 0.7), 0.06 * side, 0});
        body.linear_velocity = {-2 * side, 0.3, 0};
        const BodyId id = scene.add(body);
        const Frame frame = at({side * 0.45 * (i + 0.2), 0.06 * side, 0}, hinge_axes(space));
        const JointType types[] = {HingeJoint{Limit{-0.3, 0.5, std::nullopt}, std::nullopt},
                                   SliderJoint{Limit{-0.05, 0.05, std::nullopt}, std::nullopt},
                                   FixedJoint{},
                                   flat ? JointType(HingeJoint{}) : JointType(BallJoint{})};
        if (last) scene.add(joint_at(scene, last, id, frame, types[i]));
        last = id;
      }
    }
    Batch batch(compile(scene), options_of(double_table()));
    const Momenta start = momenta(batch, 0);
    const double energy = energy_of(batch, 0);

    for (int i = 0; i < 120; ++i) {
      batch.step();
    }
    const Momenta end = momenta(batch, 0);
    INFO((flat ? "planar" : "spatial") << " " << (end.linear - start.linear).norm() << " "
                                       << (end.angular - start.angular).norm());

    CHECK(energy_of(batch, 0) < 0.8 * energy);
    CHECK((end.linear - start.linear).norm() < 1e-9);
    CHECK((end.angular - start.angular).norm() < 0.02);  // of 8; rows keep the step's arms
  }
}

// What a joint holds along a normal may leave rounding alone of how it gives way.
TEST_CASE("a body on a rail beside a wall slides along it", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double overlap : {-5e-4, 0.0, 1e-3}) {
      for (const double slope : {0.2, 0.3, 0.5}) {
        Scene scene = empty_scene(space, 10);
        scene.options.joint.method = JointMethod::tree;
        const bool flat = space == Space::planar;
        const Vec3 across = flat ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitY());
        const Quat tilt(Eigen::AngleAxisd(slope, across));
        const Vec3 normal = tilt * up_of(space), along = tilt * Vec3::UnitX();
        Body wall = ground(space, 0.0);
        wall.rotation = tilt;
        scene.add(wall);
        const Vec3 half = flat ? Vec3(0.2, 0.1, 0) : Vec3(0.2, 0.1, 0.1);
        const double height = 0.1 - overlap;
        Body box = block(space, 3, half, height * normal);
        box.rotation = tilt;
        box.shapes[0].material.friction = 0;
        const BodyId id = scene.add(box);
        scene.add(joint_at(scene, {}, id, at(box.position, tilt), SliderJoint{}));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          batch.step(60);
          const double speed = 10 * std::sin(slope);
          INFO(name(table) << " slope " << slope << " overlap " << overlap);
          CHECK(batch.status(0) == Status::ok);
          CHECK(velocity(batch, 0, 0).dot(along) == Approx(-speed).epsilon(2e-3));
        }
      }
    }
  }
}

// Knees that limits or motors hold, up to 67 times heavier above than below.
TEST_CASE("legs that limits and motors hold stand still", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double mass : {1.0, 5.0, 20.0}) {
      for (const bool motor : {false, true}) {
        Scene scene = tree_scene(space);
        scene.bodies[0].shapes[0].material.friction = 0.8;
        const Vec3 up = up_of(space);
        const BodyId torso = scene.add(lump(space, mass, Vec3::Constant(0.05 * mass), 0.45 * up));
        for (int k = 0; k < (space == Space::planar ? 2 : 4); ++k) {
          const double side = (k & 1) != 0 ? 1 : -1;
          const double y = space == Space::planar ? 0 : ((k & 2) != 0 ? 0.2 : -0.2);
          Vec3 top = Vec3(0.25 * side, y, 0) + 0.45 * up;
          BodyId last = torso;
          for (const double lean : {0.5, -0.3}) {
            const Vec3 way = 0.22 * (Vec3(lean * side, 0, 0) - up).normalized();
            Body link = lump(space, 0.3, Vec3::Constant(0.0015), top + way / 2);
            link.shapes.clear();
            if (lean < 0) {
              link.shapes = {shape_of(round_of(space, 0.02), 0.8)};
              link.shapes[0].position = way / 2;
            }
            HingeJoint hinge;
            if (motor) {
              hinge.drive = Drive{0, 0, std::nullopt, 20 * mass};
            } else {
              hinge.limit = Limit{-0.001, 0.001, std::nullopt};
            }
            const BodyId id = scene.add(link);
            scene.add(joint_at(scene, last, id, at(top, hinge_axes(space)), hinge));
            last = id, top += way;
          }
        }
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          batch.step(600);
          double speed = 0;
          for (int i = 0; i < 60; ++i) {
            batch.step();
            speed = std::max(speed, max_speed(batch, 0));
          }
          INFO(name(table) << (space == Space::planar ? " planar " : " spatial ") << mass
                           << (motor ? " kg on motors, " : " kg on limits, ") << speed);
          CHECK(batch.status(0) == Status::ok);
          CHECK(speed < 1e-3);
          CHECK(max_penetration(batch, 0) < 1e-4);
        }
      }
    }
  }
}

// A hand with two fingers on an arm of two driven links lifts a box of 2 kg.
TEST_CASE("fingers on a hand on an arm hold what they grip", "[joint][fast]") {
  for (const double mass : {0.5, 2.0}) {
    Scene scene = tree_scene(Space::spatial);
    scene.options.substeps.reset();  // small bodies ask for more
    const auto link = [&](double kg, const Vec3& half, const Vec3& place) {
      Body body = block(Space::spatial, kg, half, place);
      body.shapes[0].filter = {2, 4};
      return scene.add(body);
    };
    const auto hinge = [&](BodyId a, BodyId b, const Vec3& where) {
      Drive drive{0, 0, Spring{2e4, 400, 0, 0}};
      scene.add(joint_at(scene, a, b, at(where, z_to_y()), HingeJoint{std::nullopt, drive}));
    };
    const BodyId upper = link(2, {0.25, 0.04, 0.04}, {0.25, 0, 1}),
                 lower = link(1.5, {0.25, 0.03, 0.03}, {0.75, 0, 1}),
                 hand = link(0.5, {0.03, 0.08, 0.02}, {1.03, 0, 1});
    hinge({}, upper, {0, 0, 1}), hinge(upper, lower, {0.5, 0, 1});
    scene.add(joint_at(scene, lower, hand, at({1, 0, 1}), FixedJoint{}));
    for (const double side : {-1.0, 1.0}) {
      const BodyId finger = link(0.05, {0.01, 0.01, 0.05}, {1.03, side * 0.0401, 0.93});
      // Along y: closed by at most 60 N.
      const Quat along(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
      const Drive grip{-side * 0.05, 0, Spring{1e4, 50, 0, 0}, 60};
      scene.add(joint_at(scene, hand, finger, at({1.03, side * 0.0401, 0.98}, along),
                         SliderJoint{std::nullopt, grip}));
    }
    Body box = block(Space::spatial, mass, {0.03, 0.03, 0.03}, {1.03, 0, 0.9});
    box.shapes[0].filter = {4, 2};
    box.shapes[0].material.friction = 1;
    scene.add(box);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      // Across the fingers, from the hand: along them two forces of a size hold it nowhere.
      const auto place = [&] {
        const Vec3 from = position(batch, 0, 5) - position(batch, 0, 2);
        const Vec3 at = rotation(batch, 0, 2).inverse() * from;
        return Vec3(at.x(), 0, at.z());
      };
      batch.step(60);
      const Vec3 start = place();
      double gap = 0;
      for (int i = 0; i < 600; ++i) {
        batch.step();
        gap = std::max(gap, anchor_gap(batch, 0, 2));
      }
      INFO(name(table) << " " << mass << " kg, slipped " << (place() - start).norm() << " from "
                       << start.transpose());
      CHECK(batch.status(0) == Status::ok);
      CHECK((place() - start).norm() < 1e-3);
      CHECK(start.z() > -0.12);
      CHECK(gap < 1e-4);
    }
  }
}

}  // namespace manyworlds::test
