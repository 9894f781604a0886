// Contacts of bodies of trees: the whole tree stands behind them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "scenes/loaded_trees.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// On the ground, in 4 substeps.
Scene ground_scene(Space space) {
  Scene scene = tree_scene(space);
  scene.options.substeps = 4;
  scene.add(ground(space));
  return scene;
}

}  // namespace

TEST_CASE("welded legs bear a thousand times their mass", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double mass : {1.0, 10.0, 100.0, 1000.0}) {
      Scene scene = scenes::welded_table(space, mass);
      scene.options.substeps = 4;
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
  Scene scene = ground_scene(space);
  const bool flat = space == Space::planar;
  scene.bodies[0].shapes[0].material.friction = friction;
  const Vec3 up = up_of(space);
  const JointType type = flat ? JointType(HingeJoint{}) : JointType(BallJoint{});
  BodyId last;
  for (int i = 0; i < 11; ++i) {
    const Vec3 half = i == 10 ? Vec3(0.05, 0.05, flat ? 0 : 0.05)
                              : (flat ? Vec3(0.01, 0.04, 0) : Vec3(0.01, 0.01, 0.04));
    Body link = solid_box(space, i == 10 ? load : 0.1, half, (0.1 + 0.1 * i) * up);
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

// How far a joint opens where the load strikes is chance: some 2 of 256 worlds exceed 0.07 m.
TEST_CASE("ropes fold under a hundred times a link's mass", "[joint][fast][long]") {
  constexpr int kWorlds = 16;
  for (const Space space : kSpaces) {
    for (const double friction : {0.0, 0.6}) {
      const Scene scene = rope_of(space, 10, friction);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table, kWorlds));
        double gain = 0, rests = 0;
        std::vector<double> start, gaps(kWorlds, 0.0);
        for (int w = 0; w < kWorlds; ++w) start.push_back(energy_of(batch, w));
        for (int i = 0; i < 300; ++i) {
          batch.step();
          for (int w = 0; w < kWorlds; ++w) {
            gain = std::max(gain, energy_of(batch, w) - start[static_cast<std::size_t>(w)]);
            double& gap = gaps[static_cast<std::size_t>(w)];
            gap = std::max(gap, worst_gap(batch, w));
            if (i == 299) rests = std::max(rests, max_penetration(batch, w));
          }
        }
        std::sort(gaps.begin(), gaps.end());
        const double most = gaps[kWorlds - 2];  // of all but one
        INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " friction "
                         << friction << " gain " << gain << " rests " << rests << " gap " << most
                         << ", worst " << gaps.back());
        for (int w = 0; w < kWorlds; ++w) CHECK(batch.status(w) == Status::ok);
        CHECK(gain < 0.01);  // J; it falls by 100 J
        CHECK(rests < 2e-3);
        // The load strikes links that move at 20 m/s.
        CHECK(most < 0.07);
        CHECK(gaps.back() < 0.25);
      }
    }
  }
}

TEST_CASE("free trees that collide keep their momentum", "[joint][fast]") {
  if (!has_table(double_table())) return;
  for (const Space space : kSpaces) {
    Scene scene = tree_scene(space);
    scene.options.gravity.setZero();
    const bool flat = space == Space::planar;
    const Vec3 half = flat ? Vec3(0.2, 0.1, 0) : Vec3(0.2, 0.1, 0.15);
    for (const double side : {-1.0, 1.0}) {
      BodyId last;
      for (int i = 0; i < 4; ++i) {
        Body body = solid_box(space, 1 + i, half, {side * 0.45 * (i + 0.7), 0.06 * side, 0});
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
        Scene scene = tree_scene(space);
        const bool flat = space == Space::planar;
        const Vec3 across = flat ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitY());
        const Quat tilt(Eigen::AngleAxisd(slope, across));
        const Vec3 normal = tilt * up_of(space), along = tilt * Vec3::UnitX();
        Body wall = ground(space, 0.0);
        wall.rotation = tilt;
        scene.add(wall);
        const Vec3 half = flat ? Vec3(0.2, 0.1, 0) : Vec3(0.2, 0.1, 0.1);
        const double height = 0.1 - overlap;
        Body box = solid_box(space, 3, half, height * normal);
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
TEST_CASE("legs that limits and motors hold stand still", "[joint][fast][long]") {
  for (const Space space : kSpaces) {
    for (const double mass : {1.0, 5.0, 20.0}) {
      for (const bool motor : {false, true}) {
        Scene scene = ground_scene(space);
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
    const Scene scene = scenes::gripper(mass);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      // Across the fingers, from the hand: along them two forces of a size hold it nowhere.
      const auto place = [&] {
        const Vec3 from = position(batch, 0, scenes::kGripped) - position(batch, 0, scenes::kHand);
        const Vec3 at = rotation(batch, 0, scenes::kHand).inverse() * from;
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
