// Batches of worlds of Solver::newton: their coordinates and bodies, what a Batch refuses of them,
// and the promises that every world is given.
#include <catch2/catch.hpp>

#include <cmath>
#include <stdexcept>

#include "tests/support/approx.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Quat quaternion_at(const Numbers& q, std::size_t at) {
  return Quat(q[at], q[at + 1], q[at + 2], q[at + 3]);
}
const char* const kPlacedByJoints =
    ": with the newton solver, bodies are always enabled; set generalized_position and "
    "generalized_velocity to move them";

}  // namespace

TEST_CASE("coordinates and velocities place the bodies", "[fast][newton]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(compile(newton_pendulum()), options_of(table, 3));
    const double slack = pick(table, 2e-6, 1e-14);
    CHECK(of(batch, Field::generalized_position) == Numbers{0});
    for (const double angle : {0.0, 0.7, -2.5, 9.0}) {
      const double speed = 1.5;
      put_angle(batch, angle, speed);
      const Vec3 arm(kLength * std::cos(angle), 0, -kLength * std::sin(angle));
      const Vec3 turn(0, speed, 0);
      CHECK((position(batch, 0, BodyId(0)) - arm).norm() < slack);
      CHECK((velocity(batch, 0, BodyId(0)) - turn.cross(arm)).norm() < slack);
      CHECK((spin(batch, 0, BodyId(0)) - turn).norm() < slack);
      const Quat q(Eigen::AngleAxisd(angle, Vec3::UnitY()));
      CHECK(q.angularDistance(rotation(batch, 0, 0)) < 2 * slack);
      const Energy e = batch.energy(0);
      CHECK(e.kinetic == Approx(kAboutHinge * speed * speed / 2).epsilon(1e-5));
      CHECK(e.potential == approx(kMass * 10 * arm.z(), 1e-4));
      CHECK(of(batch, Field::generalized_position)[0] == approx(angle, slack));
      // The other worlds stay where they are.
      CHECK(of(batch, Field::generalized_position, 1) == Numbers{0});
      CHECK((position(batch, 1, BodyId(0)) - Vec3(kLength, 0, 0)).norm() < slack);
    }
    // All worlds in one call.
    const Numbers all = {0.1, 0.2, 0.3};
    batch.write(Field::generalized_position, std::span<const double>(all));
    for (int w = 0; w < 3; ++w) {
      const double angle = all[static_cast<std::size_t>(w)];
      CHECK(position(batch, w, BodyId(0)).z() == approx(-kLength * std::sin(angle), slack));
    }
    CHECK(batch.size(Field::generalized_acceleration) == 3);
    CHECK(batch.lane_blocks(Field::generalized_position).items == 1);
  }
}

TEST_CASE("free and ball joints have positions and quaternions", "[fast][newton]") {
  Scene scene = newton_robot();
  scene.bodies[1].jitter = {};
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), options_of(table));
    const double slack = pick(table, 2e-6, 1e-14);
    const Plan& plan = batch.plan();
    CHECK(plan.items(ItemKind::coordinate) == kCoordinates);
    CHECK(plan.items(ItemKind::dof) == kDofs);
    CHECK(plan.first_coordinate(JointId(0)) == 7);
    CHECK(plan.first_coordinate(JointId(1)) == 8);

    const Quat torso = Quat(0.5, -0.1, 0.7, 0.2).normalized(), hand(0, 0, 0.6, 0.8);
    const Numbers q = {1,
                       2,
                       3,
                       2 * torso.w(),
                       2 * torso.x(),
                       2 * torso.y(),
                       2 * torso.z(),  //
                       0.25,
                       hand.w(),
                       hand.x(),
                       hand.y(),
                       hand.z(),  //
                       4,
                       5,
                       6,
                       0,
                       1,
                       0,
                       0};
    put(batch, Field::generalized_position, q);
    const Quat arm = torso * Eigen::AngleAxisd(0.25, Vec3::UnitY());
    const Vec3 elbow = Vec3(1, 2, 3) + torso * Vec3(0.2, 0, 0);
    const Vec3 wrist = elbow + arm * Vec3(0.4, 0, 0);
    CHECK((position(batch, 0, BodyId(1)) - Vec3(1, 2, 3)).norm() < slack);
    CHECK(torso.angularDistance(rotation(batch, 0, 0)) < 2 * slack);
    CHECK((position(batch, 0, BodyId(2)) - (elbow + arm * Vec3(0.2, 0, 0))).norm() < slack);
    CHECK(arm.angularDistance(rotation(batch, 0, 1)) < 2 * slack);
    CHECK((position(batch, 0, BodyId(3)) - (wrist + arm * hand * Vec3(0.2, 0, 0))).norm() < slack);
    CHECK((position(batch, 0, BodyId(4)) - Vec3(4, 5, 6)).norm() < slack);

    // World axes for what is linear, the body's own for what turns.
    Numbers v(kDofs, 0.0);
    v[0] = 1, v[4] = 2, v[6] = 3;
    put(batch, Field::generalized_velocity, v);
    const Vec3 of_torso = torso * Vec3(0, 2, 0), of_arm = of_torso + torso * Vec3(0, 3, 0);
    CHECK((velocity(batch, 0, BodyId(1)) - Vec3(1, 0, 0)).norm() < slack);
    CHECK((spin(batch, 0, BodyId(1)) - of_torso).norm() < 4 * slack);
    CHECK((spin(batch, 0, BodyId(2)) - of_arm).norm() < 4 * slack);
    const Vec3 at_elbow = Vec3(1, 0, 0) + of_torso.cross(elbow - Vec3(1, 2, 3));
    const Vec3 at_arm = at_elbow + of_arm.cross(arm * Vec3(0.2, 0, 0));
    CHECK((velocity(batch, 0, BodyId(2)) - at_arm).norm() < 4 * slack);
  }
}

TEST_CASE("a batch names what it does not do to bodies of the newton solver", "[fast][newton]") {
  Batch batch(compile(newton_robot()), options_of(widest_tables().front(), 2));
  batch.step(3);
  const std::uint64_t hash = batch.hash();
  const auto refuses = [&](const std::string& text, auto&& call) {
    INFO(text);
    CHECK_THROWS_WITH(call(), text);
    CHECK(batch.hash() == hash);
  };
  for (const Field field :
       {Field::position, Field::orientation, Field::linear_velocity, Field::angular_velocity}) {
    const Numbers one = of(batch, field), all(batch.size(field), 0.0);
    const std::string text = std::string(info(field).name) + kPlacedByJoints;
    refuses(text, [&] { batch.write(field, 1, one); });
    refuses(text, [&] { batch.write(field, std::span<const double>(all)); });
    refuses(text, [&] { batch.set_initial(field, all); });
  }
  const std::string set = std::string("set_enabled") + kPlacedByJoints;
  refuses(set, [&] { batch.set_enabled(0, BodyId(1), false); });
  refuses(set, [&] { batch.set_enabled(0, BodyId(1), true); });
  refuses(std::string("spawn") + kPlacedByJoints, [&] { batch.spawn(0, BodyId(4), {}); });
  refuses(std::string("set_joint_enabled") + kPlacedByJoints,
          [&] { batch.set_joint_enabled(0, JointId(0), false); });
  refuses(std::string("add_impulse") + kPlacedByJoints,
          [&] { batch.add_impulse(0, BodyId(1), Vec3::UnitX()); });
  refuses(std::string("add_angular_impulse") + kPlacedByJoints,
          [&] { batch.add_angular_impulse(0, BodyId(1), Vec3::UnitX()); });
  refuses(std::string("add_impulse_at") + kPlacedByJoints,
          [&] { batch.add_impulse_at(0, BodyId(1), Vec3::UnitX(), Vec3::Zero()); });
  const Numbers wrong(3, 0.0);
  refuses("generalized_position has " + std::to_string(kCoordinates) + " values, the buffer has 3",
          [&] { batch.write(Field::generalized_position, 0, wrong); });
  CHECK(batch.enabled(0, BodyId(1)));
  CHECK(batch.joint_enabled(0, JointId(0)));
}

TEST_CASE("trees begin where their root is drawn, and where they are told", "[fast][newton]") {
  Scene scene = newton_robot(), soft = newton_robot();
  soft.options.solver.method = Solver::tgs_soft;
  soft.joints.clear(), soft.controls.clear();
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    const double slack = pick(table, 3e-6, 1e-13);
    constexpr int kWorlds = 5;
    Batch batch(compile(scene), options_of(table, kWorlds)),
        other(compile(soft), options_of(table, kWorlds));
    for (int w = 0; w < kWorlds; ++w) {
      // As bodies of any solver draw it.
      CHECK((position(batch, w, BodyId(1)) - position(other, w, BodyId(1))).norm() < slack);
      CHECK((velocity(batch, w, BodyId(1)) - velocity(other, w, BodyId(1))).norm() < slack);
      const Quat torso = rotation(batch, w, 0);
      CHECK(torso.angularDistance(rotation(other, w, 0)) < 4 * slack);
      const Numbers q = of(batch, Field::generalized_position, w);
      CHECK((Vec3(q[0], q[1], q[2]) - position(batch, w, BodyId(1))).norm() < slack);
      CHECK(quaternion_at(q, 3).angularDistance(torso) < 4 * slack);
      // What hangs on it moves along.
      CHECK(
          (position(batch, w, BodyId(2)) - position(batch, w, BodyId(1)) - torso * Vec3(0.4, 0, 0))
              .norm() < 2 * slack);
      CHECK(q[7] == Approx(0).margin(slack));
    }
    const auto first = hashes(batch);
    CHECK(first[0] != first[1]);
    batch.step(30);
    batch.reset();
    CHECK(hashes(batch) == first);
    batch.step(7);
    const auto later = hashes(batch);
    const std::vector<std::uint8_t> mask = {0, 1, 0, 1, 0};
    batch.reset(mask);
    for (std::size_t w = 0; w < kWorlds; ++w) {
      CHECK((batch.hash(static_cast<int>(w)) == later[w]) == (mask[w] == 0));
      // Another draw.
      CHECK((batch.hash(static_cast<int>(w)) == first[w]) == false);
    }

    Numbers start;
    for (int w = 0; w < kWorlds; ++w) {
      const Numbers q = {1.0 + w, 2, 3, 1, 0, 0, 0, 0.5, 1, 0, 0, 0, 4, 5, 6, 0, 1, 0, 0};
      start.insert(start.end(), q.begin(), q.end());
    }
    batch.set_initial(Field::generalized_position, start);
    CHECK(of(batch, Field::generalized_position)[0] != 1);  // of resets alone
    batch.reset(mask);
    CHECK(of(batch, Field::generalized_position)[0] != 1);
    CHECK((position(batch, 3, BodyId(1)) - Vec3(4, 2, 3)).norm() < slack);
    CHECK(of(batch, Field::generalized_position, 1)[7] == Approx(0.5));
    const Vec3 elbow(4.2, 2, 3);
    const Vec3 arm = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY())) * Vec3(0.2, 0, 0);
    CHECK((position(batch, 3, BodyId(2)) - elbow - arm).norm() < 2 * slack);
    batch.set_initial(Field::generalized_position, {});
    batch.reset();
    CHECK(hashes(batch) == first);
  }
}

TEST_CASE("worlds of the newton solver go on bit by bit", "[fast][newton][bits]") {
  constexpr int kWorlds = 21;
  const Plan plan = compile(newton_robot());
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(plan, options_of(table, kWorlds, 2));
    const auto begin = hashes(batch);
    const Numbers controls(kWorlds, 0.7);
    batch.set_controls(std::span<const double>(controls));
    batch.step(40);
    const Snapshot saved = batch.save();
    const auto now = hashes(batch);
    CHECK(now != begin);
    batch.step(60);
    const auto then = hashes(batch);
    batch.restore(saved);
    CHECK(hashes(batch) == now);
    batch.step(60);
    CHECK(hashes(batch) == then);

    // By single steps, one by one, elsewhere.
    Batch single(plan, options_of(table, kWorlds));
    CHECK(hashes(single) == begin);
    single.set_controls(std::span<const double>(controls));
    for (int i = 0; i < 40; ++i) single.step();
    CHECK(hashes(single) == now);
    Batch one(plan, options_of(table, 1));
    for (const int world : {0, 13, kWorlds - 1}) {
      one.restore(saved, world, 0);
      one.step(60);
      CHECK(one.hash(0) == then[static_cast<std::size_t>(world)]);
    }
    batch.restore(saved);
    batch.copy_world(3, 4);
    batch.step(60);
    CHECK(batch.hash(4) == then[3]);

    // Worlds of a mask.
    batch.restore(saved);
    std::vector<std::uint8_t> odd(kWorlds), even(kWorlds);
    for (std::size_t w = 0; w < kWorlds; ++w) (w % 2 == 1 ? odd : even)[w] = 1;
    batch.step(odd, 60);
    for (std::size_t w = 0; w < kWorlds; ++w) {
      CHECK(batch.hash(static_cast<int>(w)) == (w % 2 == 1 ? then : now)[w]);
    }
    batch.step(even, 25), batch.step(even, 35);
    CHECK(hashes(batch) == then);
  }
  // The robots are on the ground by now, and none is lost.
  Batch batch(plan, options_of(widest_tables().front(), kWorlds));
  batch.step(400);
  CHECK(batch.lost_worlds() == 0);
  for (int w = 0; w < kWorlds; ++w) {
    for (int b = 1; b < 5; ++b) CHECK(position(batch, w, BodyId(b)).z() > 0.05);
    CHECK(position(batch, w, BodyId(1)).z() < 0.4);
  }
}

TEST_CASE("links have another mass in every world", "[fast][newton]") {
  const auto pendulum = [](double factor) {
    Scene scene = newton_scene();
    scene.add(
        lump(Space::spatial, factor * kMass, factor * Vec3(0.1, kAcross, 0.3), {kLength, 0, 0}));
    scene.add(joint_at(scene, BodyId(), BodyId(0), at(Vec3::Zero(), z_to_y()), HingeJoint{}));
    Control motor;
    motor.kind = ControlKind::joint_force, motor.joint = JointId(0);
    scene.add(motor);
    return scene;
  };
  Scene varied = pendulum(1);
  varied.variations = {vary(Parameter::mass, kMass, 8 * kMass, Draw::none)};
  for (const Table& table : all_tables()) {
    INFO(name(table));
    const Numbers factors = {4, 1, 8}, torques(3, 5);
    Batch batch(compile(varied), options_of(table, 3));
    Numbers masses;
    for (const double factor : factors) masses.push_back(factor * kMass);
    batch.write(Parameter::mass, std::span<const double>(masses));
    batch.set_controls(std::span<const double>(torques));
    batch.step(80);
    for (int w = 0; w < 3; ++w) {
      Batch alone(compile(pendulum(factors[static_cast<std::size_t>(w)])), options_of(table, 1));
      alone.set_controls(std::span<const double>(torques).first(1));
      alone.step(80);
      CHECK(of(batch, Field::generalized_position, w) == of(alone, Field::generalized_position));
      CHECK(of(batch, Field::generalized_velocity, w) == of(alone, Field::generalized_velocity));
    }
    CHECK(of(batch, Field::generalized_position, 0) != of(batch, Field::generalized_position, 2));
  }
}

TEST_CASE("worlds of the newton solver are kinds among others", "[fast][newton]") {
  Scene balls = empty_scene(Space::spatial);
  balls.options.dt = 0.01;
  balls.add(ground(Space::spatial));
  balls.add(body_of(shape_of(Sphere{0.2}), Vec3(0, 0, 1)));
  Scene still = newton_robot();
  still.bodies[1].jitter = {};
  const Plan robots = compile(still), others = compile(balls);
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch both({{robots, 3}, {others, 2}}, options_of(table));
    Batch first(robots, options_of(table, 3)), second(others, options_of(table, 2));
    CHECK(both.size(Field::generalized_position) == 3 * kCoordinates);
    CHECK(both.size(Field::position) == 3 * 4 * 3 + 2 * 3);
    const Numbers pushed(3, 0.5);
    both.set_controls(std::span<const double>(pushed));
    first.set_controls(std::span<const double>(pushed));
    both.add_impulse(3, BodyId(1), Vec3(1, 0, 0));
    second.add_impulse(0, BodyId(1), Vec3(1, 0, 0));
    CHECK_THROWS_AS(both.add_impulse(0, BodyId(1), Vec3(1, 0, 0)), std::invalid_argument);
    both.step(80), first.step(80), second.step(80);
    for (int w = 0; w < 3; ++w) CHECK(both.hash(w) == first.hash(w));
    for (int w = 0; w < 2; ++w) CHECK(both.hash(3 + w) == second.hash(w));
    // A field of bodies may be written in the worlds whose solver lets it.
    const Numbers high = {0, 0, 3};
    both.write(Field::position, 4, high);
    CHECK(position(both, 4, BodyId(1)).z() == Approx(3));
    CHECK_THROWS_AS(both.write(Field::position, 0, of(both, Field::position, 0)),
                    std::invalid_argument);
    const Numbers all(both.size(Field::position), 0.0);
    CHECK_THROWS_AS(both.write(Field::position, std::span<const double>(all)),
                    std::invalid_argument);
    CHECK(of(both, Field::generalized_position, 3).empty());
    const Snapshot saved = both.save();
    both.step(20);
    const auto then = hashes(both);
    both.restore(saved);
    both.step(20);
    CHECK(hashes(both) == then);
  }
}

}  // namespace manyworlds::test
