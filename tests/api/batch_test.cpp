// Batch as its users see it: shape, reading and writing, resets and the clock.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {}  // namespace

TEST_CASE("a batch tells its shape", "[fast][batch]") {
  const Plan plan = compile(crowd(Space::spatial));
  for (const Table& table : all_tables()) {
    BatchOptions options = options_of(table, 11, 2);
    const Batch batch(plan, options);
    CHECK(batch.worlds() == 11);
    CHECK(batch.kinds() == 1);
    CHECK(batch.bodies() == 8);
    CHECK(batch.plan().bodies() == 8);
    CHECK(batch.threads() == 2);
    CHECK(batch.precision() == table.precision);
    CHECK(batch.size(Field::position) == 11 * 8 * 3);
    CHECK(batch.size(Field::orientation) == 11 * 8 * 4);
    CHECK(batch.time() == 0);
    CHECK(batch.steps() == 0);
    CHECK(batch.lost_worlds() == 0);
    CHECK(batch.bytes_per_world() > 8 * 13 * sizeof(float));
    CHECK(batch.scratch_bytes() <= 512 * 1024);
    CHECK(batch.lanes() >= 1);
    CHECK(batch.kernel_table().find(to_string(table.precision)) != std::string::npos);
    CHECK(batch.kernel_table().find("x" + std::to_string(batch.lanes())) != std::string::npos);
  }
  CHECK(Batch(plan).threads() >= 1);
  CHECK(Batch(compile(crowd(Space::planar))).size(Field::angular_velocity) == 8);
}

TEST_CASE("options that make no sense are refused", "[fast][batch]") {
  const Plan plan = compile(crowd(Space::spatial));
  CHECK_THROWS_AS(Batch(plan, {.worlds = 0}), std::invalid_argument);
  CHECK_THROWS_AS(Batch(plan, {.worlds = -3}), std::invalid_argument);
  CHECK_THROWS_AS(Batch(plan, {.worlds = 1, .threads = -1}), std::invalid_argument);
  CHECK_THROWS_AS(Batch(std::vector<Batch::Kind>{}), std::invalid_argument);
  CHECK_THROWS_AS(Batch({{plan, 1}, {compile(crowd(Space::planar)), 1}}), std::invalid_argument);
  CHECK_THROWS_AS(Batch({{plan, 0}}), std::invalid_argument);
}

TEST_CASE("what is written is read back", "[fast][batch]") {
  Random random(1);
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(plan, options_of(table, 13));
      for (int f = 0; f < kFieldCount; ++f) {
        const Field field = static_cast<Field>(f);
        INFO(info(field).name);
        const int n = components(field, space);
        std::vector<float> written(batch.size(field));
        for (std::size_t i = 0; i < written.size(); i += static_cast<std::size_t>(n)) {
          double norm = 0;
          std::vector<double> item;
          for (int k = 0; k < n; ++k) {
            item.push_back(random.uniform(-1, 1));
            norm += item.back() * item.back();
          }
          for (int k = 0; k < n; ++k) {
            const double v = item[static_cast<std::size_t>(k)];
            written[i + static_cast<std::size_t>(k)] =
                static_cast<float>(field == Field::orientation ? v / std::sqrt(norm) : v);
          }
        }
        batch.write(field, std::span<const float>(written));
        std::vector<float> floats(batch.size(field));
        batch.read(field, std::span<float>(floats));
        // Unit orientations may be normalised again; everything else is stored as it is.
        const double slack = field == Field::orientation ? 2e-7 : 0;
        for (std::size_t i = 0; i < written.size(); ++i)
          REQUIRE(std::abs(floats[i] - written[i]) <= slack);
        const std::vector<double> doubles = read_all(batch, field);
        for (std::size_t i = 0; i < written.size(); ++i)
          REQUIRE(std::abs(doubles[i] - static_cast<double>(floats[i])) <= slack);
        // One world at a time sees the same numbers, and writing them back changes nothing.
        const std::uint64_t hash = batch.hash();
        const std::size_t stride = written.size() / 13;
        for (int w = 0; w < 13; ++w) {
          const std::vector<double> part = values(batch, field, w);
          REQUIRE(part.size() == stride);
          for (std::size_t i = 0; i < stride; ++i)
            REQUIRE(part[i] == doubles[static_cast<std::size_t>(w) * stride + i]);
          batch.write(field, w, part);
        }
        CHECK(batch.hash() == hash);
        batch.write(field, std::span<const double>(doubles));
        CHECK(batch.hash() == hash);
        // A write to one world is seen by that world only.
        std::vector<double> changed = values(batch, field, 6);
        CHECK(changed.empty() == (info(field).item != ItemKind::body));  // of trees: there are none
        if (changed.empty()) continue;
        if (field == Field::orientation) {
          changed[0] = -changed[0];
        } else {
          changed[0] += 0.5;
        }
        const std::uint64_t before = batch.hash(5), mine = batch.hash(6);
        batch.write(field, 6, changed);
        CHECK(batch.hash(5) == before);
        CHECK(batch.hash(6) != mine);
        CHECK(batch.hash() != hash);
      }
    }
  }
}

TEST_CASE("wrong sizes and indices are refused", "[fast][batch]") {
  Batch batch(compile(crowd(Space::spatial)), {.worlds = 5});
  std::vector<float> floats(batch.size(Field::position) - 1);
  std::vector<double> doubles(batch.size(Field::position) + 1);
  CHECK_THROWS_AS(batch.read(Field::position, std::span<float>(floats)), std::invalid_argument);
  CHECK_THROWS_AS(batch.read(Field::position, std::span<double>(doubles)), std::invalid_argument);
  CHECK_THROWS_AS(batch.write(Field::position, std::span<const float>(floats)),
                  std::invalid_argument);
  CHECK_THROWS_AS(batch.write(Field::position, std::span<const double>(doubles)),
                  std::invalid_argument);
  CHECK_THROWS_AS(batch.read(Field::position, 0, std::span<double>(doubles)),
                  std::invalid_argument);
  CHECK_THROWS_AS(batch.write(Field::position, 0, std::span<const double>(doubles)),
                  std::invalid_argument);
  const std::vector<std::uint8_t> mask(4, 1);
  CHECK_THROWS_AS(batch.reset(mask), std::invalid_argument);
}

TEST_CASE("a reset of all worlds repeats the first run", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : all_tables()) {
      Batch batch(plan, options_of(table, 17));
      const std::uint64_t start = batch.hash();
      batch.step(20);
      const std::uint64_t end = batch.hash();
      CHECK(end != start);
      const std::vector<std::uint8_t> some = {1, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 1};
      batch.reset(some);
      batch.step(3);
      batch.reset();
      CHECK(batch.hash() == start);
      CHECK(batch.time() == 0);
      CHECK(batch.steps() == 0);
      batch.step(20);
      CHECK(batch.hash() == end);  // no impulse of the first run is left over
    }
  }
}

TEST_CASE("a masked reset draws anew for its worlds and leaves the others", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(plan, options_of(table, 17)), twin(plan, options_of(table, 17));
      std::vector<std::uint64_t> first;
      for (int w = 0; w < 17; ++w) first.push_back(batch.hash(w));
      batch.step(20);
      twin.step(20);
      std::vector<std::uint8_t> mask(17, 0);
      for (int w : {0, 2, 7, 8, 16}) mask[static_cast<std::size_t>(w)] = 255;
      batch.reset(mask);
      for (int w = 0; w < 17; ++w) {
        INFO("world " << w);
        if (mask[static_cast<std::size_t>(w)] == 0) {
          CHECK(batch.hash(w) == twin.hash(w));
        } else {
          CHECK(batch.hash(w) != twin.hash(w));
          CHECK(batch.hash(w) != first[static_cast<std::size_t>(w)]);  // a new draw
        }
      }
      // The draw of the second episode is as reproducible as that of the first.
      twin.reset(mask);
      batch.step(20);
      twin.step(20);
      CHECK(batch.hash() == twin.hash());
      CHECK(batch.steps() == 40);
      // A fresh world behaves as one that never ran: no stored impulse is left.
      Batch clean(plan, options_of(table, 17));
      clean.reset(mask);
      clean.step(20);
      for (int w : {0, 2, 7, 8, 16}) CHECK(clean.hash(w) == batch.hash(w));
    }
  }
}

TEST_CASE("jitter stays within its range and differs between worlds and bodies", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    for (int i = 0; i < 2; ++i) {
      Body body = body_of(shape_of(cube_of(space, 0.5)), Vec3(2.0 * i, 0, 0));
      body.linear_velocity = Vec3(1, 2, 0);
      body.jitter.position = Vec3(0.1, 0.2, 0);
      body.jitter.linear_velocity = Vec3(0, 0.5, 0);
      body.jitter.angle = 0.3;
      scene.add(body);
    }
    Batch batch(compile(scene), options_of(widest_tables().back(), 2000));
    std::set<double> seen;
    Vec3 mean = Vec3::Zero(), low = Vec3::Constant(9), high = Vec3::Constant(-9);
    for (int w = 0; w < 2000; ++w) {
      for (int b = 0; b < 2; ++b) {
        const Vec3 d = position(batch, w, b) - Vec3(2.0 * b, 0, 0);
        const double angle = 2 * std::atan2(rotation(batch, w, b).z(), rotation(batch, w, b).w());
        REQUIRE(std::abs(d.x()) <= 0.1 + 1e-6);
        REQUIRE(std::abs(d.y()) <= 0.2 + 1e-6);
        REQUIRE(d.z() == 0);
        REQUIRE(std::abs(angle) <= 0.3 + 1e-6);
        REQUIRE(velocity(batch, w, b).x() == 1);
        REQUIRE(std::abs(velocity(batch, w, b).y() - 2) <= 0.5 + 1e-6);
        const Vec3 draw(d.x() / 0.1, d.y() / 0.2, angle / 0.3);
        seen.insert(draw.x());
        mean += draw / 4000;
        low = low.cwiseMin(draw);
        high = high.cwiseMax(draw);
      }
    }
    CHECK(seen.size() > 3990);
    CHECK(mean.cwiseAbs().maxCoeff() < 0.05);  // 5 sigma of a uniform draw
    CHECK(low.maxCoeff() < -0.99);
    CHECK(high.minCoeff() > 0.99);
  }
}

TEST_CASE("angular velocities are drawn within their range", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const bool planar = space == Space::planar;
    Scene scene = empty_scene(space, 0);
    Body body = body_of(shape_of(cube_of(space, 0.5)), Vec3::Zero());
    body.angular_velocity = Vec3(0, 0, 3);
    body.jitter.angular_velocity = planar ? Vec3(0, 0, 2) : Vec3(1, 0, 2);
    scene.add(body);
    Batch batch(compile(scene), options_of(widest_tables().back(), 1000));
    Vec3 low = Vec3::Constant(9), high = Vec3::Constant(-9);
    for (int w = 0; w < 1000; ++w) {
      const Vec3 spin = scenes::spin(batch, w, 0);
      REQUIRE(velocity(batch, w, 0) == Vec3::Zero());
      low = low.cwiseMin(spin), high = high.cwiseMax(spin);
    }
    CHECK(low.z() == approx(1, 0.02));
    CHECK(high.z() == approx(5, 0.02));
    CHECK(low.x() == approx(planar ? 0 : -1, 0.02));
    CHECK(high.x() == approx(planar ? 0 : 1, 0.02));
    CHECK(low.y() == 0);
    CHECK(high.y() == 0);
  }
}

TEST_CASE("what is drawn for the bodies of a chain moves those after them as one piece",
          "[fast][batch]") {
  Scene scene = empty_scene(Space::spatial, 0);
  for (int i = 0; i < 3; ++i) {
    Body body = body_of(shape_of(Box{{0.2, 0.3, 0.4}}), Vec3(i, 0, 0));
    body.mass_properties = mass_properties(scene, body);
    body.mass_properties->center = Vec3(0, 0.25, 0);
    if (i > 0) body.jitter.with = BodyId(i - 1);
    scene.add(body);
  }
  scene.bodies[0].jitter.position = Vec3(1, 1, 1);
  scene.bodies[0].jitter.any_orientation = true;
  scene.bodies[0].jitter.linear_velocity = scene.bodies[0].jitter.angular_velocity = Vec3(1, 2, 3);
  scene.bodies[1].jitter.angle = 1;
  scene.bodies[1].jitter.angular_velocity = Vec3(0, 5, 0);
  constexpr int kWorlds = 17;
  Batch batch(compile(scene), options_of(widest_tables().back(), kWorlds));
  for (int w = 0; w < kWorlds; ++w) {
    Quat turn[3];
    Vec3 at[3], center[3], linear[3], spin[3];
    for (int b = 0; b < 3; ++b) {
      turn[b] = rotation(batch, w, b), at[b] = position(batch, w, b);
      center[b] = at[b] + turn[b] * Vec3(0, 0.25, 0);
      linear[b] = velocity(batch, w, b);
      spin[b] = scenes::spin(batch, w, b);
    }
    // The second turns about its own origin, and the third with it.
    CHECK((at[1] - at[0]).isApprox(turn[0] * Vec3(1, 0, 0), 1e-5));
    CHECK((at[2] - at[1]).isApprox(turn[1] * Vec3(1, 0, 0), 1e-5));
    const double by = Eigen::AngleAxisd(turn[1] * turn[0].conjugate()).angle();
    CHECK(by > 0);
    CHECK(by < 1 + 1e-5);
    CHECK(turn[2].angularDistance(turn[1]) < 1e-5);
    // Speeds of the centres of mass.
    CHECK(spin[1].x() == approx(spin[0].x(), 1e-5));
    CHECK(spin[1].z() == approx(spin[0].z(), 1e-5));
    CHECK(std::abs(spin[1].y() - spin[0].y()) <= 5 + 1e-5);
    CHECK((spin[2] - spin[1]).norm() < 1e-5);
    CHECK((linear[2] - linear[1] - spin[2].cross(center[2] - center[1])).norm() < 1e-4);
  }
}

TEST_CASE("orientations are uniform over all rotations when asked for", "[fast][batch]") {
  Scene scene = one_crate(Space::spatial);
  scene.bodies[0].jitter.any_orientation = true;
  Batch batch(compile(scene), {.worlds = 4000, .threads = 1});
  Mat3 second = Mat3::Zero();
  Vec3 first = Vec3::Zero();
  for (int w = 0; w < 4000; ++w) {
    REQUIRE(rotation(batch, w, 0).norm() == approx(1, 1e-6));
    const Vec3 z = rotation(batch, w, 0).normalized() * Vec3::UnitZ();
    first += z / 4000;
    second += z * z.transpose() / 4000;
  }
  CHECK(first.norm() < 0.06);
  CHECK((second - Mat3::Identity() / 3).norm() < 0.05);
}

TEST_CASE("the clock takes whole steps and drops what a stalled host cannot catch up",
          "[fast][batch]") {
  Scene scene = one_crate(Space::spatial, 10);
  scene.options.dt = 0.01;
  Batch batch(compile(scene));
  CHECK(batch.step_to(0.005) == 0);
  CHECK(batch.step_to(0.0351) == 3);
  CHECK(batch.steps() == 3);
  CHECK(batch.time() == Approx(0.03));
  CHECK(batch.step_to(0.0351) == 0);
  CHECK(batch.step_to(0.05) == 2);  // exactly on a step
  CHECK(batch.step_to(1.05, 5) == 5);
  CHECK(batch.steps() == 10);
  // The rest of that second is gone: the next call goes on from there.
  CHECK(batch.step_to(1.07, 100) == 2);
  int taken = 0;
  for (int i = 1; i <= 600; ++i) taken += batch.step_to(1.07 + i / 60.0);
  CHECK(taken == 1000);  // ten seconds, no drift
}

TEST_CASE("a world without bodies steps with sleep on", "[fast][batch][sleep]") {
  PlanOptions options;
  options.keep = {Feature::contacts};
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::planar);
    scene.add(ground(Space::planar));
    BatchOptions three = options_of(table, 3);
    three.sleep = true;
    Batch batch(compile(scene, options), three);
    batch.step(2);
    CHECK(batch.bodies() == 0);
    CHECK(batch.status(0) == Status::ok);
    CHECK(batch.time() > 0);
  }
}

TEST_CASE("a batch can be moved", "[fast][batch]") {
  Batch a(compile(crowd(Space::spatial)), {.worlds = 3});
  a.step(3);
  const std::uint64_t hash = a.hash();
  Batch b = std::move(a);
  CHECK(b.hash() == hash);
  a = std::move(b);
  CHECK(a.hash() == hash);
  a.step();
  CHECK(a.hash() != hash);
}

}  // namespace manyworlds::test
