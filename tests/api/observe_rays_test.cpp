// Rays against closed forms: every kind of shape, fixed and moving, from every side.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Ray ray_of(const Vec3& origin, const Vec3& direction) {
  Ray ray;
  ray.origin = origin, ray.direction = direction;
  return ray;
}

// The shape on a body at `at` that does not move, or is fixed, and a ball out of every ray's way.
Scene target_scene(Space space, const Shape& shape, const Vec3& at, Motion motion) {
  Scene scene = empty_scene(space, 0);
  scene.add(body_of(shape, at, motion));
  scene.add(body_of(shape_of(round_of(space, 0.1)), Vec3(0, 1000, 0)));
  return scene;
}

std::vector<RayHit> look(const Scene& scene, const std::vector<Ray>& rays, const Table& table) {
  BatchOptions options = options_of(table, 3);
  options.observe.rays = rays;
  Batch batch(compile(scene), options);
  batch.look();
  return batch.ray_hits(2);
}

struct Case {
  Ray ray;
  double distance;  // infinite: a miss
  Vec3 normal = Vec3::Zero();
};

void check_cases(Space space, const Geometry& geometry, const std::vector<Case>& cases,
                 std::vector<Motion> motions = {Motion::dynamic, Motion::kinematic,
                                                Motion::fixed}) {
  const Vec3 at = space == Space::planar ? Vec3(3, -2, 0) : Vec3(3, -2, 5);
  for (Motion motion : motions) {
    const Scene scene = target_scene(space, shape_of(geometry), at, motion);
    std::vector<Ray> rays;
    for (const Case& c : cases) rays.push_back(ray_of(c.ray.origin + at, c.ray.direction));
    for (const Table& table : all_tables()) {
      const auto hits = look(scene, rays, table);
      const double near = pick(table, 2e-6, 1e-13);
      for (std::size_t i = 0; i < cases.size(); ++i) {
        INFO("shape " << geometry.index() << " ray " << i << ' ' << name(table) << " motion "
                      << static_cast<int>(motion));
        if (cases[i].distance == kInfinite) {
          CHECK(hits[i].distance == kInfinite);
          CHECK(hits[i].body == BodyId());
          CHECK(hits[i].shape == ShapeId());
          CHECK(hits[i].normal.norm() == 0);
        } else {
          CHECK(hits[i].distance == approx(cases[i].distance, 10 * near));
          CHECK((hits[i].normal - cases[i].normal).norm() < 10 * near);
          CHECK(hits[i].body == BodyId(0));
          CHECK(hits[i].shape.index() == 0);
        }
      }
    }
  }
}

const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY(), kZ = Vec3::UnitZ();
const double kHalfRoot = std::sqrt(0.5);

}  // namespace

TEST_CASE("rays against balls", "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    check_cases(space, round_of(space, 0.5),
                {{ray_of(-2 * kX, kX), 1.5, -kX},
                 {ray_of(-2 * kX, 7 * kX), 1.5, -kX},
                 {ray_of(-2 * kX, -kX), kInfinite},
                 {ray_of(Vec3(-2, 0.3, 0), kX), 1.6, Vec3(-0.8, 0.6, 0)},
                 {ray_of(Vec3(-2, 0.5 - 1e-5, 0), kX), 2 - std::sqrt(1e-5 * (1 - 1e-5)),
                  Vec3(-2 * std::sqrt(1e-5 * (1 - 1e-5)), 1 - 2e-5, 0)},
                 {ray_of(Vec3(-2, 0.501, 0), kX), kInfinite},
                 {ray_of(Vec3(0.1, 0, 0), kY), 0, -kY},
                 {ray_of(Vec3(1, 1, 0), Vec3(-1, -1, 0)), std::sqrt(2.0) - 0.5,
                  Vec3(kHalfRoot, kHalfRoot, 0)}});
  }
}

TEST_CASE("rays against boxes and rectangles", "[fast][observe]") {
  const std::vector<Case> cases = {
      {ray_of(-2 * kX, kX), 1.5, -kX},
      {ray_of(2 * kX, -kX), 1.5, kX},
      {ray_of(2 * kX, kX), kInfinite},
      {ray_of(2 * kY, -kY), 1.7, kY},
      {ray_of(-2 * kY, kY), 1.7, -kY},
      {ray_of(Vec3(-2, 0.29, 0), kX), 1.5, -kX},
      {ray_of(Vec3(-2, 0.31, 0), kX), kInfinite},
      {ray_of(Vec3(0.4, 0.2, 0), kX), 0, -kX},
      {ray_of(Vec3(0.4, 0.2, 0), -kX - kY), 0, Vec3(kHalfRoot, kHalfRoot, 0)},
      {ray_of(Vec3(0, 1.3, 0), Vec3(0.4, -1, 0)), std::sqrt(1.16), kY},
      {ray_of(Vec3(0, 1.3, 0), Vec3(0.6, -1, 0)), kInfinite}};
  check_cases(Space::spatial, Box{Vec3(0.5, 0.3, 0.2)}, cases);
  check_cases(Space::planar, Polygon::box(0.5, 0.3), cases);
  // The same as a polygon of five corners.
  check_cases(Space::planar,
              Polygon{{{-0.5, -0.3}, {0, -0.4}, {0.5, -0.3}, {0.5, 0.3}, {-0.5, 0.3}}},
              {cases[0],
               cases[1],
               cases[2],
               cases[3],
               cases[5],
               cases[6],
               cases[7],
               cases[9],
               cases[10],
               {ray_of(Vec3(-0.25, -2, 0), kY), 1.65, Vec3(-0.1, -0.5, 0).normalized()}});
}

TEST_CASE("rays against capsules", "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Vec3 up = up_of(space);
    check_cases(space, Capsule{0.25, 0.5},
                {{ray_of(-2 * kX, kX), 1.75, -kX},
                 {ray_of(-2 * kX + 0.4 * up, kX), 1.75, -kX},
                 {ray_of(-2 * kX + 0.65 * up, kX), 1.8, -0.8 * kX + 0.6 * up},
                 {ray_of(-2 * kX + 0.76 * up, kX), kInfinite},
                 {ray_of(2 * up, -up), 1.25, up},
                 {ray_of(-2 * up, up), 1.25, -up},
                 {ray_of(2 * up + 0.2 * kX, -up), 1.35, 0.6 * up + 0.8 * kX},
                 {ray_of(2 * up + 0.26 * kX, -up), kInfinite},
                 {ray_of(0.3 * up, kX), 0, -kX},
                 {ray_of(0.6 * up, up), 0, -up},
                 {ray_of(kX, kX), kInfinite}});
  }
}

TEST_CASE("rays against cylinders", "[fast][observe]") {
  check_cases(Space::spatial, Cylinder{0.5, 0.3},
              {{ray_of(-2 * kX, kX), 1.5, -kX},
               {ray_of(2 * kY, -kY), 1.5, kY},
               {ray_of(2 * kX, kX), kInfinite},
               {ray_of(2 * kZ, -kZ), 1.7, kZ},
               {ray_of(-2 * kZ, kZ), 1.7, -kZ},
               {ray_of(Vec3(-2, 0.3, 0.29), kX), 1.6, Vec3(-0.8, 0.6, 0)},
               {ray_of(Vec3(-2, 0, 0.31), kX), kInfinite},
               {ray_of(Vec3(-2, 0.51, 0), kX), kInfinite},
               {ray_of(Vec3(0.4, 0.2, 0), kX), 0, -kX},
               {ray_of(Vec3(0.3, 0.3, 2), -kZ), 1.7, kZ},
               {ray_of(Vec3(0.4, 0.4, 2), -kZ), kInfinite},
               {ray_of(Vec3(0, 0, 1.3), Vec3(0.4, 0, -1)), std::sqrt(1.16), kZ},
               {ray_of(Vec3(-1.5, 0, 0.9), Vec3(1, 0, -0.8)), std::sqrt(1.64), -kX}});
}

TEST_CASE("rays against hulls", "[fast][observe]") {
  Hull brick;
  for (int i = 0; i < 8; ++i)
    brick.vertices.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.3 : -0.3, i & 4 ? 0.2 : -0.2);
  check_cases(Space::spatial, brick,
              {{ray_of(-2 * kX, kX), 1.5, -kX},
               {ray_of(2 * kX, -kX), 1.5, kX},
               {ray_of(2 * kX, kX), kInfinite},
               {ray_of(2 * kY, -kY), 1.7, kY},
               {ray_of(Vec3(-2, 0.29, 0), kX), 1.5, -kX},
               {ray_of(Vec3(-2, 0.31, 0), kX), kInfinite},
               {ray_of(Vec3(0.4, 0.2, 0), kX), 0, -kX},
               {ray_of(Vec3(0, 1.3, 0), Vec3(0.4, -1, 0)), std::sqrt(1.16), kY},
               {ray_of(Vec3(0, 1.3, 0), Vec3(0.6, -1, 0)), kInfinite}});
  // A corner of a cube, cut off.
  check_cases(
      Space::spatial, Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {{ray_of(Vec3(1, 1, 1), Vec3(-1, -1, -1)), 2 / std::sqrt(3.0), Vec3(1, 1, 1).normalized()},
       {ray_of(Vec3(0.2, 0.2, -1), kZ), 1, -kZ},
       {ray_of(Vec3(0.6, 0.6, -1), kZ), kInfinite}});
}

TEST_CASE("rays against planes, segments and terrains", "[fast][observe]") {
  const auto kFixed = std::vector<Motion>{Motion::fixed};
  for (Space space : {Space::planar, Space::spatial}) {
    const Vec3 up = up_of(space);
    check_cases(space, ground_of(space),
                {{ray_of(2 * up, -up), 2, up},
                 {ray_of(2 * up, up), kInfinite},
                 {ray_of(2 * up, kX), kInfinite},
                 {ray_of(2 * up, kX - up), 2 * std::sqrt(2.0), up},
                 {ray_of(-up, up), 0, -up},
                 {ray_of(-up, kX), 0, -kX}},
                kFixed);
  }
  check_cases(Space::planar, Segment{{-1, 0}, {1, 0}},
              {{ray_of(kY, -kY), 1, kY},
               {ray_of(-kY, kY), 1, -kY},
               {ray_of(Vec3(0.999, 1, 0), -kY), 1, kY},
               {ray_of(Vec3(1.001, 1, 0), -kY), kInfinite},
               {ray_of(kY, kX), kInfinite}},
              kFixed);
  // A flat, a slope up, its free side above.
  check_cases(Space::planar, Terrain{{{-2, 0}, {0, 0}, {1, 1}}},
              {{ray_of(Vec3(-1, 1, 0), -kY), 1, kY},
               {ray_of(Vec3(-1, -1, 0), kY), kInfinite},
               {ray_of(Vec3(-1, 0.5, 0), kX), 1.5, Vec3(-kHalfRoot, kHalfRoot, 0)},
               {ray_of(Vec3(0, 1, 0), -kY), 1, kY},
               {ray_of(Vec3(2, 1, 0), -kY), kInfinite}},
              kFixed);
}

TEST_CASE("rays end where a slow march along them does", "[fast][observe]") {
  Random random(11);
  for (Space space : {Space::planar, Space::spatial}) {
    const bool planar = space == Space::planar;
    for (int round = 0; round < 60; ++round) {
      Geometry geometry = random_capsule(random);
      if (round % 3 == 1) geometry = round_of(space, random.uniform(0.1, 0.6));
      if (round % 3 == 2) {
        geometry = random_box(random);
        if (planar) geometry = random_polygon(random, random.integer(3, 8));
      }
      const Motion motion = round % 2 == 0 ? Motion::dynamic : Motion::fixed;
      Scene scene = empty_scene(space, 0);
      scene.add(random_body(geometry, motion, true, space, random));
      scene.add(body_of(shape_of(round_of(space, 0.1)), Vec3(0, 1000, 0)));
      Body& body = scene.bodies[0];
      body.rotation = planar ? random.planar_rotation() : random.rotation();
      const Solid solid = make_solid(body.shapes[0], {body.position, body.rotation}, space);
      const Vec3 middle = body.position + body.rotation.normalized() * body.shapes[0].position;
      std::vector<Ray> rays;
      for (int i = 0; i < 40; ++i) {
        const Vec3 way = planar ? random.planar_direction() : random.direction();
        Vec3 aside = random.in_cube(0.5);
        if (planar) aside.z() = 0;
        rays.push_back(ray_of(middle + aside - random.uniform(0.0, 2.0) * way, way));
      }
      for (const Table& table : all_tables()) {
        const auto hits = look(scene, rays, table);
        const double near = pick(table, 2e-5, 1e-9);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const auto height = [&](double along) {
            return signed_distance(solid, rays[i].origin + along * rays[i].direction);
          };
          INFO(name(table) << " round " << round << " ray " << i);
          if (!hits[i].body) {
            double nearest = 1;
            for (double t = 0; t < 5; t += 0.02) nearest = std::min(nearest, height(t));
            CHECK(nearest > -near);
            continue;
          }
          const double t = hits[i].distance;
          CHECK(hits[i].normal.norm() == approx(1, 1e-5));
          CHECK(hits[i].normal.dot(rays[i].direction) < 1e-3);
          if (t == 0) {
            CHECK(height(0) < near);
            continue;
          }
          CHECK(std::abs(height(t)) < near);  // on the surface, and nothing before it
          for (double s = 0; s < 1; s += 0.05) CHECK(height(s * t) > -near);
          CHECK(signed_distance(
                    solid, rays[i].origin + t * rays[i].direction + 1e-3 * hits[i].normal) > 0);
        }
      }
    }
  }
}

TEST_CASE("rays go with their body and do not see it", "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    Body eye = body_of(shape_of(cube_of(space, 0.2)), Vec3(1, 2, 0));
    eye.rotation = Quat(Eigen::AngleAxisd(kPi / 2, kZ));
    eye.shapes[0].position = Vec3(0.3, 0, 0);  // its centre of mass is off its origin
    eye.linear_velocity = Vec3(0, 6, 0);
    scene.add(eye);
    scene.add(body_of(shape_of(round_of(space, 0.5)), Vec3(1, 10, 0)));
    Body seen = body_of(shape_of(round_of(space, 0.5)), Vec3(-4, 2, 0));
    seen.shapes[0].filter.category = 4;
    scene.add(seen);
    Ray forward = ray_of(Vec3(-0.5, 0, 0), kX), left = ray_of(Vec3::Zero(), kY), blind = left;
    forward.body = left.body = blind.body = BodyId(0);
    blind.mask = ~4u;
    Ray shorter = forward;
    shorter.length = 2;
    for (const Table& table : all_tables()) {
      INFO(name(table));
      BatchOptions options = options_of(table, 5);
      options.observe.rays = {forward, left, blind, shorter};
      Batch batch(compile(scene), options);
      batch.look();
      auto hits = batch.ray_hits(3);
      CHECK(hits[0].distance == Approx(8));
      CHECK(hits[0].body == BodyId(1));
      CHECK(hits[1].distance == Approx(4.5));
      CHECK(hits[1].body == BodyId(2));
      CHECK((hits[1].normal - kX).norm() < 1e-5);
      CHECK(hits[2].body == BodyId());
      CHECK(hits[3].body == BodyId());
      CHECK(hits[3].distance == 2);
      batch.step(30);  // 3 m on
      hits = batch.ray_hits(3);
      CHECK(hits[0].distance == Approx(5).epsilon(1e-5));
      CHECK(hits[1].body == BodyId());
      batch.set_enabled(3, batch.body_in_row(1), false);
      batch.look();
      CHECK(batch.ray_hits(3)[0].body == BodyId());
      CHECK(batch.ray_hits(2)[0].body == BodyId(1));
    }
  }
}

TEST_CASE("rays change with set_rays, in one world or all", "[fast][observe]") {
  Scene scene = empty_scene(Space::spatial, 0);
  scene.add(body_of(shape_of(Sphere{0.5}), Vec3(3, 0, 0)));
  scene.add(body_of(shape_of(Sphere{0.5}), Vec3(0, 5, 0)));
  for (const Table& table : widest_tables()) {
    BatchOptions options = options_of(table, 20);
    options.sleep = true;
    options.observe.rays = {ray_of(Vec3::Zero(), kX)};
    Batch batch(compile(scene), options);
    const std::vector<Ray> up = {ray_of(Vec3::Zero(), kY)};
    batch.set_rays(7, up);
    batch.step();
    CHECK(batch.ray_hits(6)[0].distance == Approx(2.5));
    CHECK(batch.ray_hits(7)[0].distance == Approx(4.5));
    for (int i = 0; i < 60; ++i) batch.step();
    REQUIRE(batch.asleep(0));
    batch.set_rays(up);
    batch.step();
    for (int w = 0; w < 20; ++w) CHECK(batch.ray_hits(w)[0].distance == Approx(4.5));

    CHECK_THROWS_WITH(batch.set_rays(std::vector<Ray>(2)), Catch::Contains("made with 1"));
    std::vector<Ray> wrong = up;
    wrong[0].direction.setZero();
    CHECK_THROWS_WITH(batch.set_rays(wrong), Catch::Contains("rays[0].direction is 0 0 0"));
    wrong = up;
    wrong[0].length = 0;
    CHECK_THROWS_WITH(batch.set_rays(3, wrong), Catch::Contains("rays[0].length is 0"));
    wrong = up;
    wrong[0].body = BodyId(2);
    CHECK_THROWS_WITH(batch.set_rays(wrong), Catch::Contains("rays[0].body is 2, must be -1 to 1"));
    wrong[0].body = BodyId(1);
    CHECK_THROWS_WITH(batch.set_rays(3, wrong), Catch::Contains("same in all worlds"));
  }
}

}  // namespace manyworlds::test
