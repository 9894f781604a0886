// Height fields: bodies on flat ones move as on planes, on rough ones nobody falls through or
// catches on an edge.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/height_field.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Hull wedge() {
  return Hull{{{-0.3, -0.2, -0.2},
               {0.3, -0.2, -0.2},
               {0.3, 0.2, -0.2},
               {-0.3, 0.2, -0.2},
               {-0.3, 0, 0.3},
               {0.3, 0, 0.3}}};
}
struct Sample {
  const char* name;
  Geometry geometry;
  double rest;  // m, of the origin above flat ground
};
std::vector<Sample> samples() {
  return {{"sphere", Sphere{0.25}, 0.25},
          {"box", Box{{0.3, 0.2, 0.25}}, 0.25},
          {"cylinder", Cylinder{0.25, 0.3}, 0.3},
          {"hull", wedge(), 0.2}};
}

}  // namespace

TEST_CASE("bodies come to rest on a flat height field as on a plane", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (const Sample& sample : samples()) {
      Scene scene = empty_scene(Space::spatial);
      scene.add(land(field_of(9, 7, {0.5, 0.4}, flat)));
      scene.add(body_of(shape_of(sample.geometry), {0.13, 0.07, sample.rest + 0.2}));
      Batch batch(compile(scene), options_of(table));
      batch.step(180);
      INFO(name(table) << " " << sample.name);
      CHECK(position(batch, 0, 0).z() == approx(sample.rest, 3e-3));
      CHECK((position(batch, 0, 0).head<2>() - Vec2(0.13, 0.07)).norm() < 2e-3);
      CHECK(velocity(batch, 0, 0).norm() < 1e-3);
      CHECK(spin(batch, 0, 0).norm() < 1e-3);
    }
  }
}

TEST_CASE("what slides over flat triangles does not catch on their edges", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (const Sample& sample : samples()) {
      Scene scene = empty_scene(Space::spatial);
      scene.add(land(field_of(41, 21, {0.3, 0.35}, flat), 0));
      Body body = body_of(shape_of(sample.geometry, 0), {-4, -1.5, sample.rest});
      body.linear_velocity = {3, 1.1, 0};
      scene.add(body);
      Batch batch(compile(scene), options_of(table));
      double bounce = 0;
      for (int i = 0; i < 120; ++i) {
        batch.step();
        bounce = std::max(bounce, std::abs(velocity(batch, 0, 0).z()));
      }
      INFO(name(table) << " " << sample.name);
      CHECK((velocity(batch, 0, 0).head<2>() - Vec2(3, 1.1)).norm() < 1e-4);
      CHECK(bounce < 0.06);  // it settles by a slop at first
      CHECK(spin(batch, 0, 0).norm() < 5e-3);
    }
  }
}

TEST_CASE("a ball that rolls over flat triangles rolls on", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial);
    scene.add(land(field_of(41, 21, {0.3, 0.35}, flat)));
    Body ball = body_of(shape_of(Sphere{0.25}), {-4, -1, 0.25});
    ball.linear_velocity = {3, 1, 0};
    ball.angular_velocity = {-4, 12, 0};
    scene.add(ball);
    Batch batch(compile(scene), options_of(table));
    batch.step(120);
    INFO(name(table));
    CHECK((velocity(batch, 0, 0) - Vec3(3, 1, 0)).norm() < 5e-3);
    CHECK((position(batch, 0, 0).head<2>() - Vec2(2, 1)).norm() < 0.01);
  }
}

TEST_CASE("a height field that is an inclined plane carries as that plane does", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (const double friction : {0.1, 0.6}) {
      Vec3 end[2];
      for (const bool as_plane : {false, true}) {
        Scene scene = empty_scene(Space::spatial);
        const Vec3 up = Vec3(-0.25, 0.1, 1).normalized();
        if (as_plane) {
          scene.add(land(Plane{up, 0}, friction));
        } else {
          scene.add(land(
              field_of(31, 31, {0.5, 0.5}, [](double x, double y) { return 0.25 * x - 0.1 * y; }),
              friction));
        }
        Body box = body_of(shape_of(Box{{0.3, 0.3, 0.2}}, friction), 0.21 * up + Vec3(2, 0, 0.5));
        box.rotation = rotation_to(Vec3::UnitZ(), up);
        scene.add(box);
        Batch batch(compile(scene), options_of(table));
        batch.step(90);
        end[as_plane ? 1 : 0] = position(batch, 0, 0);
      }
      INFO(name(table) << " friction " << friction);
      // Of about 1.8 m: friction is that of many manifolds instead of one.
      CHECK((end[0] - end[1]).norm() < 0.03);
      CHECK((end[0] - Vec3(2, 0, 0.7)).head<2>().norm() > (friction < 0.2 ? 0.5 : 0.0));
    }
  }
}

TEST_CASE("a ball rests in a valley and rolls off a ridge", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial);
    const auto saw = [](double x, double) { return std::abs(x); };
    scene.add(land(field_of(9, 5, {0.5, 1}, saw)));
    scene.add(body_of(shape_of(Sphere{0.3}), {0.4, 0.2, 1.2}));
    Batch valley(compile(scene), options_of(table));
    valley.step(400);
    INFO(name(table));
    // Both slopes at 45 degrees carry it.
    CHECK(position(valley, 0, 0).x() == Approx(0).margin(5e-3));
    CHECK(position(valley, 0, 0).z() == approx(0.3 * std::sqrt(2.0), 6e-3));
    CHECK(valley.contacts(0).size() >= 2);

    scene.bodies[0] =
        land(field_of(9, 5, {0.5, 1}, [&](double x, double y) { return -saw(x, y); }));
    scene.bodies[1].position = {-0.02, 0.2, 0.32};
    scene.bodies[1].linear_velocity = {0.5, 0, 0};
    Batch ridge(compile(scene), options_of(table));
    for (int i = 0; i < 12; ++i) {
      ridge.step();
      // It stays a radius off the ridge.
      const Vec3 x = position(ridge, 0, 0);
      CHECK(std::hypot(x.x(), x.z()) > 0.3 - 6e-3);
    }
    ridge.step(30);
    CHECK(position(ridge, 0, 0).x() > 0.3);
  }
}

TEST_CASE("a box lies across a ridge", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial);
    scene.add(
        land(field_of(9, 5, {0.5, 1}, [](double x, double) { return -0.5 * std::abs(x); }), 1));
    scene.add(body_of(shape_of(Box{{0.4, 0.3, 0.1}}, 1), {0.0, 0.1, 0.11}));
    Batch batch(compile(scene), options_of(table));
    batch.step(60);
    INFO(name(table));
    CHECK(position(batch, 0, 0).z() == approx(0.1, 0.02));
    CHECK(std::abs(position(batch, 0, 0).x()) < 0.05);
  }
}

TEST_CASE("a strip of one cell carries what lies across its borders", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (const Vec2& at : {Vec2(-0.3, 0), Vec2(0.3, 0), Vec2(0, -2.4), Vec2(0, 2.4)}) {
      Scene scene = empty_scene(Space::spatial);
      scene.add(land(field_of(2, 6, {1, 1}, flat)));
      scene.add(body_of(shape_of(Box{{0.4, 0.4, 0.2}}), {at.x(), at.y(), 0.25}));
      Batch batch(compile(scene), options_of(table));
      batch.step(60);
      INFO(name(table) << " at " << at.transpose());
      CHECK(position(batch, 0, 0).z() == approx(0.2, 5e-3));
    }
  }
}

TEST_CASE("what has sunk below a valley comes up", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    const auto valley = [](double x, double) { return std::abs(x); };
    for (const Sample& sample : samples()) {
      Scene scene = empty_scene(Space::spatial);
      scene.add(land(field_of(9, 5, {0.5, 1}, valley)));
      scene.add(body_of(shape_of(sample.geometry), {0.02, 0.1, -0.6}));
      Batch batch(compile(scene), options_of(table));
      batch.step(240);
      INFO(name(table) << " " << sample.name);
      CHECK(position(batch, 0, 0).z() > 0.1);
    }
  }
}

TEST_CASE("nobody falls through hills", "[slow][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial);
    // A bowl with hills in it.
    const auto bowl = [](double x, double y) { return hills(x, y) + 0.03 * (x * x + y * y); };
    const HeightField field = field_of(41, 41, {0.4, 0.4}, bowl);
    scene.add(land(field));
    Random random(7);
    for (int i = 0; i < 24; ++i) {
      const auto all = samples();
      Geometry g = i % 5 == 4 ? Geometry(Capsule{0.15, 0.25})
                              : all[static_cast<std::size_t>(i % 5)].geometry;
      Body body = body_of(shape_of(std::move(g)),
                          {random.uniform(-4, 4), random.uniform(-4, 4), 2.5 + 0.3 * i});
      body.jitter.any_orientation = true;
      body.jitter.position = {0.3, 0.3, 0.1};
      scene.add(body);
    }
    Batch batch(compile(scene), options_of(table, 8));
    INFO(name(table));
    for (int i = 0; i < 10; ++i) {
      batch.step(60);
      for (int w = 0; w < 8; ++w) {
        for (int b = 0; b < 24; ++b) {
          const Vec3 x = position(batch, w, b);
          INFO("step " << 60 * i << " world " << w << " body " << b);
          CHECK(x.z() > surface(field, x.x(), x.y()) + 0.1);
          CHECK(x.head<2>().norm() < 8.2);
        }
      }
    }
    CHECK(batch.lost_worlds() == 0);
    CHECK(batch.measure_contacts().max_penetration < 0.02);
    for (int w = 0; w < 8; ++w) CHECK(batch.status(w) == Status::ok);
  }
}

TEST_CASE("height fields have the same bits on every table, layout and thread count, in any place",
          "[fast][field][bits]") {
  Scene scene = empty_scene(Space::spatial, 9.81);
  Body ground = land(field_of(17, 15, {0.7, 0.6}, hills));
  ground.position = {0.3, -0.2, 0.1};
  ground.rotation = Quat(Eigen::AngleAxisd(0.2, Vec3(0.3, 1, 2).normalized()));
  ground.shapes[0].position = {0.1, 0.2, 0};
  scene.add(ground);
  for (const Sample& sample : samples()) {
    Body body = body_of(shape_of(sample.geometry),
                        {0.6 * static_cast<double>(scene.bodies.size()) - 1.5, 0, 1.2});
    body.jitter.position = {0.5, 0.5, 0.3}, body.jitter.any_orientation = true;
    scene.add(body);
  }
  scene.add(body_of(shape_of(Capsule{0.2, 0.3}), {0, 1.5, 1}));
  const Plan plan = compile(scene);
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<std::uint64_t> reference;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      for (const ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
        BatchOptions options = options_of(table, 13, layout == ContactLayout::rows ? 3 : 1);
        options.layout = layout;
        Batch batch(plan, options);
        batch.step(50);
        INFO(name(table));
        const auto worlds = hashes(batch);
        if (reference.empty()) reference = worlds;
        CHECK(worlds == reference);
        options.worlds = 1, options.seed = 5, options.threads = 1;
        Batch alone(plan, options);
        alone.step(50);
        CHECK(alone.hash(0) == reference[5]);
      }
    }
  }
  // And without tables of pairs.
  PlanOptions sparse;
  sparse.broad_phase = BroadPhase::sparse;
  const Table table = widest_tables().front();
  Batch one(plan, options_of(table, 3)), other(compile(scene, sparse), options_of(table, 3));
  one.step(50), other.step(50);
  for (int w = 0; w < 3; ++w) CHECK(position(one, w, 0).isApprox(position(other, w, 0), 1e-2));
}

TEST_CASE("height fields are checked", "[fast][scene]") {
  Scene scene = empty_scene(Space::spatial);
  HeightField bad = field_of(3, 3, {1, 1}, flat);
  bad.heights[4] = std::nan("");
  bad.cell.y() = 0;
  HeightField ragged;
  ragged.columns = 3, ragged.heights = {0, 0, 0, 0};
  HeightField thin = ragged;
  thin.columns = 1;
  Body all = land(bad);
  all.shapes.push_back(shape_of(ragged));
  all.shapes.push_back(shape_of(thin));
  scene.add(all);
  scene.add(body_of(shape_of(field_of(2, 2, {1, 1}, flat)), Vec3::Zero()));
  std::string issues;
  for (const Issue& issue : validate(scene)) issues += to_string(issue) + "\n";
  CHECK_THAT(issues, Catch::Contains("body 0, shape 0: cell.y is 0 m"));
  CHECK_THAT(issues, Catch::Contains("body 0, shape 0: heights[4] is nan"));
  CHECK_THAT(issues, Catch::Contains("body 0, shape 1: heights are 4, must be two rows"));
  CHECK_THAT(issues, Catch::Contains("body 0, shape 2: columns is 1, must be at least 2"));
  CHECK_THAT(issues, Catch::Contains("body 1, shape 0: geometry is a height field on a body that"));

  Scene fine = empty_scene(Space::spatial);
  fine.add(land(field_of(200, 200, {0.01, 0.01}, flat)));
  fine.add(body_of(shape_of(Sphere{1}), {0, 0, 2}));
  const auto list = validate(fine);
  REQUIRE(list.size() == 1);
  CHECK_THAT(to_string(list[0]), Catch::Contains("body 0, shape 0: cell is (0.01, 0.01) m") &&
                                     Catch::Contains("must be at most 128"));
}

}  // namespace manyworlds::test
