// Ellipsoids: pairs against the slow twins, rays, casts, mass, and motion on planes and fields.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "manyworlds/query.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

Geometry any_ellipsoid(Random& r) {
  return Ellipsoid{{r.uniform(0.1, 0.6), r.uniform(0.1, 0.6), r.uniform(0.1, 0.6)}};
}

// `twin`: m, by which the twin's own search may be wrong.
void check_ellipsoid(ShapeMaker first, Motion first_motion, ShapeMaker second, double twin) {
  PairPromise promise;
  promise.twin = twin;
  promise.local_below = twin > 0 ? 0.05 : 0;
  promise.reach = 1.5;
  for (const Table& table : widest_tables()) {
    const PairResult sum = check_random_pairs({first, first_motion, second}, Space::spatial, table,
                                              promise, 2, 256, Random(20261123));
    INFO(name(table) << ": " << sum.deviations << " deviations in " << sum.poses << " poses\n"
                     << sum.report);
    CHECK(sum.deviations == 0);
    CHECK(sum.local <= sum.poses / 100);
    CHECK(sum.overlapping > sum.poses / 3);
    CHECK(sum.with_contacts >= sum.overlapping - sum.poses / 1000);
  }
}
constexpr double kEllipsoidSearched = 4e-6;

}  // namespace

TEST_CASE("ellipsoid-plane agrees with its twin", "[slow][collide]") {
  check_ellipsoid(any_plane, Motion::fixed, any_ellipsoid, 0);
}
TEST_CASE("ellipsoid-sphere agrees with its twin", "[slow][collide]") {
  check_ellipsoid(any_ellipsoid, Motion::dynamic, any_sphere, kEllipsoidSearched);
  check_ellipsoid(any_sphere, Motion::fixed, any_ellipsoid, kEllipsoidSearched);
}
TEST_CASE("ellipsoid-capsule agrees with its twin", "[slow][collide]") {
  check_ellipsoid(any_ellipsoid, Motion::dynamic, any_capsule, kEllipsoidSearched);
  check_ellipsoid(any_capsule, Motion::fixed, any_ellipsoid, kEllipsoidSearched);
}
TEST_CASE("ellipsoid-box agrees with its twin", "[slow][collide]") {
  check_ellipsoid(any_box, Motion::dynamic, any_ellipsoid, kEllipsoidSearched);
  check_ellipsoid(any_ellipsoid, Motion::fixed, any_box, kEllipsoidSearched);
}
TEST_CASE("ellipsoid-cylinder agrees with its twin", "[slow][collide]") {
  check_ellipsoid(any_cylinder, Motion::dynamic, any_ellipsoid, kEllipsoidSearched);
}
TEST_CASE("ellipsoid-hull agrees with its twin", "[slow][collide]") {
  check_ellipsoid(any_hull, Motion::dynamic, any_ellipsoid, kEllipsoidSearched);
}
TEST_CASE("ellipsoid-ellipsoid agrees with its twin", "[slow][collide]") {
  check_ellipsoid(any_ellipsoid, Motion::dynamic, any_ellipsoid, kEllipsoidSearched);
  check_ellipsoid(any_ellipsoid, Motion::fixed, any_ellipsoid, kEllipsoidSearched);
}

TEST_CASE("the mass of an ellipsoid is 4/3 pi abc rho, its inertia m (b^2 + c^2) / 5",
          "[fast][collide]") {
  Scene scene = empty_scene(Space::spatial);
  Shape shape;
  shape.geometry = Ellipsoid{{0.1, 0.2, 0.3}};
  shape.density = 1000;
  Body body;
  body.shapes = {shape};
  const MassProperties m = mass_properties(scene, body);
  const double mass = 1000 * 4.0 / 3.0 * M_PI * 0.006;
  CHECK(m.mass == Approx(mass).epsilon(1e-14));
  CHECK(m.center.norm() == 0);
  CHECK(m.inertia(0, 0) == Approx(mass * 0.13 / 5).epsilon(1e-14));
  CHECK(m.inertia(1, 1) == Approx(mass * 0.10 / 5).epsilon(1e-14));
  CHECK(m.inertia(2, 2) == Approx(mass * 0.05 / 5).epsilon(1e-14));
}

TEST_CASE("an ellipsoid of a planar scene is named", "[fast][collide]") {
  Scene scene = empty_scene(Space::planar);
  scene.add(body_of(shape_of(Ellipsoid{}), Vec3::Zero()));
  const std::vector<Issue> issues = validate(scene);
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].message ==
        "is an ellipsoid, a planar scene takes circle, polygon, capsule, half-plane, segment and "
        "terrain");
}

TEST_CASE("rays hit ellipsoids where the quadric says", "[fast][observe]") {
  const Vec3 radii(0.5, 0.3, 0.2);
  Shape shape;
  shape.geometry = Ellipsoid{radii};
  const auto hit = [&](const Vec3& from, const Vec3& way) {
    Ray ray;
    ray.origin = from, ray.direction = way;
    return ray_cast(shape, {}, ray);
  };
  CHECK(hit({-2, 0, 0}, {1, 0, 0})->distance == Approx(1.5));
  CHECK(hit({0, 2, 0}, {0, -1, 0})->distance == Approx(1.7));
  CHECK(hit({0, 0, 2}, {0, 0, -1})->distance == Approx(1.8));
  CHECK(hit({0.1, 0.1, 0.05}, {1, 0, 0})->distance == 0);
  CHECK_FALSE(hit({-2, 0.31, 0}, {1, 0, 0}));
  CHECK_FALSE(hit({2, 0, 0}, {1, 0, 0}));
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 on = random.direction().cwiseProduct(radii);
    const Vec3 normal = on.cwiseQuotient(radii.cwiseAbs2()).normalized();
    Vec3 way = random.direction();
    if (way.dot(normal) > -0.1) continue;
    const auto found = hit(on - 0.7 * way, way);
    REQUIRE(found);
    CHECK(found->distance == approx(0.7, 1e-5));
    CHECK((found->normal - normal).norm() < 1e-4);
  }
}

TEST_CASE("an ellipsoid comes to rest on its flat side", "[fast][collide]") {
  for (const Geometry& below : {Geometry(Plane{}), Geometry(Box{{3, 3, 1}})}) {
    const double top = std::holds_alternative<Plane>(below) ? 0 : 1;
    Scene scene = empty_scene(Space::spatial);
    scene.add(body_of(shape_of(below), Vec3::Zero(), Motion::fixed));
    scene.add(body_of(shape_of(Ellipsoid{{0.4, 0.3, 0.15}}), Vec3(0.1, 0, top + 0.25)));
    scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(0.2, Vec3::UnitX()));
    scene.bodies[1].angular_drag = 3;  // a point without rolling friction would rock on
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 4));
      batch.step(900);
      INFO(name(table) << " x " << position(batch, 0, 0).transpose());
      CHECK(batch.contacts(0).size() == 1);
      CHECK(std::abs(position(batch, 0, 0).z() - top - 0.15) < 3e-3);
      CHECK(max_speed(batch, 0) < 5e-3);
    }
  }
}

TEST_CASE("ellipsoids of 1 cm to 100 m, flat and round, rest alike", "[fast][collide]") {
  // A flat one wobbles faster than steps can follow, since its point of contact runs: by how much
  // its centre then moves, in lengths per second.
  struct Rest {
    Vec3 radii;
    double speed;
  };
  const Rest rests[] = {{{0.4, 0.3, 0.15}, 0.01}, {{0.5, 0.5, 0.05}, 0.1}, {{0.1, 0.1, 0.1}, 0.01}};
  for (const double scale : {0.01, 1.0, 100.0}) {
    for (const auto& [radii, speed] : rests) {
      Scene scene = empty_scene(Space::spatial);
      scene.options.length_unit = scale;
      scene.options.gravity = Vec3(0, 0, -10 * scale);  // so that times are the same
      scene.add(body_of(shape_of(Box{Vec3(3, 3, 1) * scale}), Vec3::Zero(), Motion::fixed));
      scene.add(
          body_of(shape_of(Ellipsoid{radii * scale}), Vec3(0.1, 0, 1 + radii.z() + 0.05) * scale));
      scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitY()));
      scene.bodies[1].angular_drag = 3;
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(900);
        INFO(name(table) << " scale " << scale << " radii " << radii.transpose());
        CHECK(batch.status(0) == Status::ok);
        CHECK(std::abs(position(batch, 0, 0).z() / scale - 1 - radii.z()) < 4e-3);
        CHECK(max_speed(batch, 0) < speed * scale);
      }
    }
  }
}

TEST_CASE("a fast ellipsoid stops at a thin wall", "[fast][collide]") {
  Scene scene = empty_scene(Space::spatial);
  scene.options.gravity.setZero();
  scene.add(body_of(shape_of(Box{{0.01, 2, 2}}), Vec3(1, 0, 0), Motion::fixed));
  scene.add(body_of(shape_of(Ellipsoid{{0.2, 0.1, 0.1}}), Vec3::Zero()));
  scene.bodies[1].linear_velocity = {300, 0, 0};
  // And the other way round: a small ball at a fixed ellipsoid.
  scene.add(body_of(shape_of(Ellipsoid{{0.02, 1, 1}}), Vec3(1, 10, 0), Motion::fixed));
  scene.add(body_of(shape_of(Sphere{0.05}), Vec3(0, 10, 0)));
  scene.bodies[3].linear_velocity = {300, 0, 0};
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(30);
    INFO(name(table));
    CHECK(position(batch, 0, 0).x() < 1);
    CHECK(position(batch, 0, 1).x() < 1);
  }
}

TEST_CASE("an ellipsoid on a height field rests as on a plane", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial);
    HeightField field;
    field.columns = 9, field.cell = {0.5, 0.4};
    field.heights.assign(63, 0.0);
    scene.add(body_of(shape_of(field), Vec3::Zero(), Motion::fixed));
    scene.add(body_of(shape_of(Ellipsoid{{0.3, 0.25, 0.15}}), {0.13, 0.07, 0.25}));
    Batch batch(compile(scene), options_of(table));
    batch.step(240);
    INFO(name(table));
    CHECK(position(batch, 0, 0).z() == approx(0.15, 3e-3));
    CHECK(velocity(batch, 0, 0).norm() < 1e-2);
  }
}

TEST_CASE("a pile of ellipsoids has the same bits everywhere", "[fast][bits]") {
  Scene scene = empty_scene(Space::spatial);
  scene.add(body_of(shape_of(Plane{}), Vec3::Zero(), Motion::fixed));
  scene.add(body_of(shape_of(Ellipsoid{{1, 1.5, 0.4}}), Vec3(0.2, 0, 0.1), Motion::fixed));
  for (int i = 0; i < 12; ++i) {
    Body body = body_of(shape_of(Ellipsoid{{0.2 + 0.01 * i, 0.3, 0.15}}),
                        Vec3(0.3 * (i % 3), 0.1 * i, 1 + 0.5 * i));
    if (i % 4 == 1) body.shapes[0].geometry = Box{{0.2, 0.2, 0.2}};
    if (i % 4 == 2) body.shapes[0].geometry = Capsule{0.15, 0.2};
    if (i % 4 == 3) body.shapes[0].position.x() = 0.1;
    body.jitter.position = {0.1, 0.1, 0.1}, body.jitter.any_orientation = true;
    scene.add(std::move(body));
  }
  const Plan plan = compile(scene);
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<std::uint64_t> reference;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      for (const ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
        BatchOptions options = options_of(table, 37, 2);
        options.layout = layout;
        const auto found = hashes_after(plan, options, 150);
        INFO(name(table) << ' ' << to_string(layout));
        if (reference.empty()) reference = found;
        CHECK(found == reference);
        options.worlds = 5, options.seed += 16, options.threads = 1;
        const auto some = hashes_after(plan, options, 150);
        CHECK(std::equal(some.begin(), some.end(), reference.begin() + 16));
      }
    }
  }
}

}  // namespace manyworlds::test
