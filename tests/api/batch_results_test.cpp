// What a Batch reports: statuses, contacts, stage times; several kinds of world; compounds.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {}  // namespace

TEST_CASE("statuses have names and lost worlds are counted", "[fast][batch]") {
  CHECK(to_string(Status::ok) == "ok");
  CHECK(to_string(Status::non_finite) == "non_finite");
  CHECK(to_string(Status::out_of_range) == "out_of_range");
  CHECK(to_string(Status::out_of_bounds | Status::contact_overflow) ==
        "out_of_bounds|contact_overflow");
  Scene scene = one_crate(Space::spatial, 10);
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-5, -5, -1), Vec3(5, 5, 5));
  for (const Table& table : all_tables()) {
    Batch batch(compile(scene), options_of(table, 4));
    set_vector(batch, Field::linear_velocity, 2, 0, Vec3(0, 0, 8));
    batch.step(30);  // the others fell 1.25 m
    CHECK(batch.status(2) == Status::ok);
    for (int w : {0, 1, 3}) {
      CHECK(batch.status(w) == Status::out_of_bounds);
      CHECK(position(batch, w, 0).z() == approx(-1.25, 1e-4));  // it still steps
    }
    CHECK(batch.lost_worlds() == 3);
    batch.reset();
    CHECK(batch.lost_worlds() == 0);
  }
}

TEST_CASE("several kinds in one batch move as they do alone", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan many = compile(crowd(space)), few = compile(crowd(space, 3));
    const Plan free = compile(one_crate(space, 10));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      BatchOptions options = options_of(table);
      options.seed = 50;
      Batch mixed({{many, 11}, {free, 2}, {few, 9}}, options);
      CHECK(mixed.worlds() == 22);
      CHECK(mixed.kinds() == 3);
      CHECK(mixed.kind_of(10) == 0);
      CHECK(mixed.kind_of(11) == 1);
      CHECK(mixed.kind_of(13) == 2);
      CHECK(mixed.bodies(0) == 8);
      CHECK(mixed.bodies(12) == 1);
      CHECK(mixed.bodies(21) == 3);
      const std::size_t bodies = 11 * 8 + 2 * 1 + 9 * 3;
      CHECK(mixed.size(Field::linear_velocity) ==
            bodies * static_cast<std::size_t>(components(Field::linear_velocity, space)));
      mixed.step(25);
      struct Part {
        const Plan* plan;
        int first, count;
      };
      std::vector<double> expected;
      for (const Part& part : {Part{&many, 0, 11}, Part{&free, 11, 2}, Part{&few, 13, 9}}) {
        options.worlds = part.count;
        options.seed = 50 + static_cast<std::uint64_t>(part.first);
        Batch alone(*part.plan, options);
        alone.step(25);
        for (int w = 0; w < part.count; ++w) {
          INFO("world " << part.first + w);
          CHECK(alone.hash(w) == mixed.hash(part.first + w));
        }
        const std::vector<double> v = read_all(alone, Field::linear_velocity);
        expected.insert(expected.end(), v.begin(), v.end());
      }
      CHECK(read_all(mixed, Field::linear_velocity) == expected);
    }
  }
}

TEST_CASE("a compound of two half boxes moves as the whole box", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Geometry whole = box_of(space, Vec3(0.8, 0.3, 0.3));
    const Geometry half = box_of(space, Vec3(0.4, 0.3, 0.3));
    const auto scene_with = [&](bool compound) {
      Scene scene = empty_scene(space);
      Body body = body_of(shape_of(compound ? half : whole), 3 * up_of(space));
      if (compound) {
        body.shapes[0].position = Vec3(-0.4, 0, 0);
        body.shapes.push_back(shape_of(half));
        body.shapes[1].position = Vec3(0.4, 0, 0);
      }
      body.angular_velocity = Vec3(0, 0, 2);
      body.linear_velocity = Vec3(1, 0, 0);
      scene.add(body);
      scene.add(ground(space));
      return scene;
    };
    const Scene one = scene_with(false), two = scene_with(true);
    const MassProperties a = mass_properties(one, one.bodies[0]);
    const MassProperties b = mass_properties(two, two.bodies[0]);
    CHECK(b.mass == Approx(a.mass).epsilon(1e-12));
    CHECK((b.center - a.center).norm() < 1e-12);
    CHECK(b.inertia(2, 2) == Approx(a.inertia(2, 2)).epsilon(1e-12));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch first(compile(one), options_of(table)), second(compile(two), options_of(table));
      first.step(40);
      second.step(40);
      const double tight = pick(table, 1e-4, 1e-10);
      CHECK((position(first, 0, 0) - position(second, 0, 0)).norm() < tight);
      CHECK((rotation(first, 0, 0).conjugate() * rotation(second, 0, 0)).vec().norm() < tight);
      first.step(500);  // the impact differs by the extra contacts, the rest does not
      second.step(500);
      CHECK(max_speed(second, 0) < 0.01);
      CHECK(std::abs(position(first, 0, 0).dot(up_of(space)) -
                     position(second, 0, 0).dot(up_of(space))) < 2e-3);
    }
  }
}

TEST_CASE("contact summary agrees with the contacts", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Scene scene = crowd(space);
    Batch batch(compile(scene), {.worlds = 6, .threads = 1});
    batch.step(40);
    const std::uint64_t hash = batch.hash();
    double points = 0, deepest = 0;
    for (int w = 0; w < 6; ++w) {
      for (const Contact& c : batch.contacts(w)) {
        if (c.separation < 4 * *batch.plan().resolved().contact.slop) points += 1.0 / 6;
        deepest = std::max(deepest, -c.separation);
      }
    }
    const ContactSummary summary = batch.measure_contacts();
    CHECK(points > 1);
    CHECK(summary.points_per_world == Approx(points));
    CHECK(summary.max_penetration == approx(deepest, 1e-6));
    CHECK(summary.manifolds_per_world > 0);
    CHECK(summary.manifolds_per_world <= summary.points_per_world + 1e-9);
    CHECK(batch.hash() == hash);  // looking changes nothing
    batch.step();
    Batch unseen(compile(scene), {.worlds = 6, .threads = 1});
    unseen.step(41);
    CHECK(unseen.hash() == batch.hash());
  }
}

TEST_CASE("profiling changes no bits and names the stages", "[fast][batch]") {
  Batch plain(compile(crowd(Space::spatial)), {.worlds = 9}),
      timed(compile(crowd(Space::spatial)), {.worlds = 9});
  CHECK(timed.take_stage_times().empty());
  timed.profile(true);
  plain.step(20);
  timed.step(20);
  CHECK(plain.hash() == timed.hash());
  const auto times = timed.take_stage_times();
  CHECK(!times.empty());
  double sum = 0;
  for (const StageTime& t : times) {
    CHECK(!t.stage.empty());
    CHECK(t.seconds >= 0);
    sum += t.seconds;
  }
  CHECK(sum > 0);
}

}  // namespace manyworlds::test
