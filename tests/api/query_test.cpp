// Queries on single shapes. A distance d with its normal and points is proved by themselves: the
// points are d apart, and along the normal the shapes are; for overlaps no other direction that is
// tried separates them more.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "manyworlds/query.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

using Place = manyworlds::Pose;

Place at(double x, double y, double z = 0) { return {Vec3(x, y, z), Quat::Identity()}; }

Shape random_shape(Random& random, Space space, int kind) {
  Shape shape;
  if (kind == 0) shape.geometry = round_of(space, random.uniform(0.1, 0.6));
  if (kind == 1) shape.geometry = random_capsule(random);
  if (kind == 2) {
    shape.geometry = random_box(random);
    if (space == Space::planar) shape.geometry = random_polygon(random, random.integer(3, 8));
  }
  shape.position = space == Space::planar ? Vec3(0.1, -0.2, 0) : Vec3(0.1, -0.2, 0.3);
  shape.rotation = space == Space::planar ? random.planar_rotation() : random.rotation();
  return shape;
}

Place random_pose(Random& random, Space space) {
  Place pose;
  pose.position = random.in_cube(0.7);
  pose.rotation = random.rotation();
  if (space == Space::planar) {
    pose.position.z() = 0;
    pose.rotation = random.planar_rotation();
  }
  return pose;
}

Solid solid_of(const Shape& shape, const Place& pose, Space space) {
  return make_solid(shape, {pose.position, pose.rotation}, space);
}

// m, what manifolds and rays may round off: a library without float64 kernels has float32 ones.
double rounding() { return has_table({Isa::scalar, Precision::f64}) ? 1e-12 : 2e-6; }

}  // namespace

// The way between the nearest points is then nothing but rounding.
TEST_CASE("hulls that touch exactly have the normal of the face", "[fast][query]") {
  Random random(11);
  for (int round = 0; round < 300; ++round) {
    const Quat turn = random.rotation();
    const Vec3 normal = turn * Vec3::UnitZ(), at = random.in_cube(2);
    Shape shapes[2];
    Place places[2];
    for (const int i : {0, 1}) {
      const double half = random.uniform(0.1, 1), wide = random.uniform(0.2, 1);
      Hull hull;
      for (int k = 0; k < 12; ++k) {
        const double angle = 2 * kPi * (k / 2 + 0.3 * i) / 6;
        hull.vertices.push_back(
            {wide * std::cos(angle), wide * std::sin(angle), k % 2 == 0 ? -half : half});
      }
      shapes[i].geometry = hull;
      places[i] = {at + (i == 0 ? -half : half) * normal, turn};
    }
    const Separation s = distance(shapes[0], places[0], shapes[1], places[1], Space::spatial);
    CHECK(std::abs(s.distance) < 1e-6);
    CHECK((s.normal - normal).norm() < 1e-5);
  }
}

TEST_CASE("distances prove themselves", "[fast][query]") {
  Random random(3);
  for (Space space : {Space::planar, Space::spatial}) {
    for (int kinds = 0; kinds < 9; ++kinds) {
      int overlapping = 0;
      for (int round = 0; round < 200; ++round) {
        const Shape a = random_shape(random, space, kinds / 3);
        const Shape b = random_shape(random, space, kinds % 3);
        const Place pose_a = random_pose(random, space), pose_b = random_pose(random, space);
        const Separation s = distance(a, pose_a, b, pose_b, space);
        const Solid solid_a = solid_of(a, pose_a, space), solid_b = solid_of(b, pose_b, space);
        INFO((space == Space::planar ? "planar" : "spatial")
             << " kinds " << kinds << " round " << round << " distance " << s.distance);
        CHECK(s.normal.norm() == Approx(1));
        CHECK((s.point_b - s.point_a - s.distance * s.normal).norm() < 1e-12);
        CHECK(separation_along(solid_a, solid_b, s.normal) == approx(s.distance, 1e-9));
        CHECK(std::abs(signed_distance(solid_a, s.point_a)) < 1e-9);
        CHECK(std::abs(signed_distance(solid_b, s.point_b)) < 1e-9);
        CHECK(separation(solid_a, solid_b) == approx(s.distance, 1e-9));
        CHECK(overlap(a, pose_a, b, pose_b, space) == (s.distance <= 0));
        if (s.distance < 0) {
          ++overlapping;
          for (int i = 0; i < 50; ++i) {
            const Vec3 n = space == Space::planar ? random.planar_direction() : random.direction();
            CHECK(separation_along(solid_a, solid_b, n) < s.distance + 1e-9);
          }
        }
        const Separation turned = distance(b, pose_b, a, pose_a, space);
        CHECK(turned.distance == approx(s.distance, 1e-12));
      }
      CHECK(overlapping > 20);
      CHECK(overlapping < 190);
    }
  }
}

TEST_CASE("distances of cylinders and hulls prove themselves", "[fast][query]") {
  Random random(4);
  for (int kinds = 0; kinds < 8; ++kinds) {
    int overlapping = 0;
    for (int round = 0; round < 100; ++round) {
      Shape a = random_shape(random, Space::spatial, kinds / 2 % 4);
      Shape b = random_shape(random, Space::spatial, 0);
      if (kinds >= 6) a.geometry = random_hull(random, 9);
      b.geometry = random_cylinder(random);
      if (kinds % 2 == 1) b.geometry = random_hull(random, 9);
      const Place pose_a = random_pose(random, Space::spatial);
      const Place pose_b = random_pose(random, Space::spatial);
      const Separation s = distance(a, pose_a, b, pose_b);
      const Solid solid_a = solid_of(a, pose_a, Space::spatial);
      const Solid solid_b = solid_of(b, pose_b, Space::spatial);
      INFO("kinds " << kinds << " round " << round << " distance " << s.distance);
      CHECK(s.normal.norm() == Approx(1));
      CHECK((s.point_b - s.point_a - s.distance * s.normal).norm() < 1e-12);
      CHECK(separation_along(solid_a, solid_b, s.normal) == approx(s.distance, 1e-9));
      // Where rounds meet, the search gets near.
      CHECK(std::abs(signed_distance(solid_a, s.point_a)) < 1e-6);
      CHECK(std::abs(signed_distance(solid_b, s.point_b)) < 1e-6);
      // It is one (above), and the twin, which climbs in steps, knows none better.
      CHECK(separation(solid_a, solid_b) < s.distance + 1e-6);
      if (s.distance < 0) {
        ++overlapping;
        for (int i = 0; i < 50; ++i)
          CHECK(separation_along(solid_a, solid_b, random.direction()) < s.distance + 1e-9);
      }
      const Separation turned = distance(b, pose_b, a, pose_a);
      CHECK(turned.distance == approx(s.distance, 1e-9));
    }
    CHECK(overlapping > 5);
    CHECK(overlapping < 95);
  }
}

TEST_CASE("distances from planes, segments and terrains", "[fast][query]") {
  const Shape box = shape_of(Box{Vec3(0.5, 0.3, 0.2)}), ball = shape_of(Sphere{0.5});
  Separation s = distance(shape_of(Plane{}), at(0, 0, 1), box, at(4, 5, 3));
  CHECK(s.distance == Approx(1.8));
  CHECK((s.normal - Vec3::UnitZ()).norm() < 1e-12);
  CHECK(s.point_a.z() == Approx(1));
  CHECK(s.point_b.z() == Approx(2.8));
  s = distance(ball, at(4, 5, 0.75), shape_of(Plane{}), at(0, 0, 1));
  CHECK(s.distance == Approx(-0.75));
  CHECK((s.normal + Vec3::UnitZ()).norm() < 1e-12);

  const Shape segment = shape_of(Segment{{-1, 0}, {1, 0}});
  const Shape disc = shape_of(Circle{0.5});
  CHECK(distance(segment, at(0, 0), disc, at(0.5, 2)).distance == Approx(1.5));
  CHECK(distance(segment, at(0, 0), disc, at(4, 4)).distance == Approx(4.5));
  CHECK(distance(segment, at(0, 0), disc, at(0, 0.2)).distance == Approx(-0.3));
  CHECK(distance(segment, at(0, 0), segment, at(3, 0)).distance == Approx(1));
  CHECK(distance(segment, at(0, 0), segment, at(1, 2)).distance == Approx(2));
  Place upright = at(0.25, 0);
  upright.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  CHECK(overlap(segment, at(0, 0), segment, upright));

  const Shape terrain = shape_of(Terrain{{{-4, 0}, {0, 0}, {3, 3}}});
  CHECK(distance(terrain, at(0, 0), disc, at(-2, 2)).distance == Approx(1.5));
  CHECK(distance(disc, at(0, 2), terrain, at(0, 0)).distance == Approx(std::sqrt(2.0) - 0.5));
}

TEST_CASE("shapes that cannot be asked about say why", "[fast][query]") {
  CHECK_THROWS_WITH(distance(shape_of(Sphere{-1}), at(0, 0), shape_of(Sphere{}), at(0, 0)),
                    Catch::Contains("body 0 'a', shape 0: geometry.radius") ||
                        Catch::Contains("body 0 'a', shape 0: radius is -1"));
  CHECK_THROWS_WITH(overlap(shape_of(Sphere{}), at(0, 0), shape_of(Circle{}), at(0, 0)),
                    Catch::Contains("body 0 'a'"));
  Place lost = at(0, 0);
  lost.position.x() = std::nan("");
  CHECK_THROWS_WITH(distance(shape_of(Sphere{}), at(0, 0), shape_of(Sphere{}), lost),
                    Catch::Contains("body 1 'b': position.x is nan"));
  CHECK_THROWS_WITH(distance(shape_of(Plane{}), at(0, 0), shape_of(Plane{}), at(0, 0)),
                    Catch::Contains("both shapes are planes"));
  CHECK_THROWS_WITH(manifold(shape_of(Plane{}), at(0, 0), shape_of(Plane{}), at(0, 0)),
                    Catch::Contains("neither shape can belong to a body that moves"));
  CHECK_THROWS_WITH(manifold(shape_of(Sphere{}), at(0, 0), shape_of(Sphere{}), at(0, 0), -1),
                    Catch::Contains("margin"));
  Ray nowhere;
  nowhere.direction.setZero();
  CHECK_THROWS_WITH(ray_cast(shape_of(Sphere{}), at(0, 0), nowhere), Catch::Contains("ray_cast"));
}

TEST_CASE("manifolds of known pairs", "[fast][query]") {
  const Shape cube = shape_of(Box{});
  const auto on_plane = manifold(shape_of(Plane{}), at(0, 0), cube, at(2, 3, 0.49));
  REQUIRE(on_plane.size() == 4);
  for (const ManifoldPoint& p : on_plane) {
    CHECK((p.normal - Vec3::UnitZ()).norm() < 1e-12);
    CHECK(p.separation == Approx(-0.01));
    CHECK(std::abs(p.point.x() - 2) == Approx(0.5));
    CHECK(p.point.z() == Approx(-0.005));
  }
  CHECK(manifold(cube, at(0, 0), cube, at(0, 0, 1.01)).empty());
  CHECK(manifold(cube, at(0, 0), cube, at(0, 0, 1.01), 0.02).size() == 4);
  CHECK(manifold(cube, at(0, 0), cube, at(0, 0, 3), 2.5).size() == 4);
  const auto balls = manifold(shape_of(Sphere{}), at(0, 0), shape_of(Sphere{}), at(0.9, 0));
  REQUIRE(balls.size() == 1);
  CHECK((balls[0].point - Vec3(0.45, 0, 0)).norm() < rounding());
  const auto squares = manifold(shape_of(Polygon::box(0.5, 0.5)), at(0, 0),
                                shape_of(Polygon::box(0.5, 0.5)), at(0.2, 0.99));
  REQUIRE(squares.size() == 2);
  CHECK(squares[0].feature != squares[1].feature);
}

TEST_CASE("manifolds go with distances and turn with their order", "[fast][query]") {
  Random random(5);
  for (Space space : {Space::planar, Space::spatial}) {
    for (int kinds = 0; kinds < 9; ++kinds) {
      int touching = 0;
      for (int round = 0; round < 25; ++round) {
        const Shape a = random_shape(random, space, kinds / 3);
        const Shape b = random_shape(random, space, kinds % 3);
        const Place pose_a = random_pose(random, space), pose_b = random_pose(random, space);
        const Separation s = distance(a, pose_a, b, pose_b, space);
        const auto points = manifold(a, pose_a, b, pose_b, 0, space);
        const auto turned = manifold(b, pose_b, a, pose_a, 0, space);
        INFO((space == Space::planar ? "planar" : "spatial")
             << " kinds " << kinds << " round " << round << " distance " << s.distance);
        CHECK(points.empty() == (s.distance > 0));
        CHECK(points.size() == turned.size());
        if (points.empty() || turned.empty()) continue;
        ++touching;
        const auto deepest = [](const auto& all) {
          return std::min_element(
                     all.begin(), all.end(),
                     [](const auto& p, const auto& q) { return p.separation < q.separation; })
              ->separation;
        };
        // Box-box prefers faces a little to the least overlap.
        CHECK(deepest(points) < s.distance + std::max(1e-9, rounding()));
        CHECK(deepest(points) > s.distance - 0.01 - 0.1 * std::abs(s.distance));
        CHECK(deepest(turned) == approx(deepest(points), 1e-3));
        CHECK(points[0].normal.norm() == Approx(1));
        CHECK(points[0].normal.dot(turned[0].normal) < 0);
      }
      CHECK(touching > 2);
    }
  }
}

TEST_CASE("a ray against a single shape", "[fast][query]") {
  Ray ray;
  ray.origin = Vec3(-3, 0, 0);
  const auto hit = ray_cast(shape_of(Sphere{}), at(1, 0), ray);
  REQUIRE(hit);
  CHECK(hit->distance == Approx(3.5));
  CHECK((hit->normal + Vec3::UnitX()).norm() < 1e-12);
  CHECK(hit->body == BodyId(0));
  CHECK_FALSE(ray_cast(shape_of(Sphere{}), at(1, 1), ray));
  ray.length = 3.4;
  CHECK_FALSE(ray_cast(shape_of(Sphere{}), at(1, 0), ray));
  ray.length = 10;
  Shape wheel = shape_of(Capsule{0.25, 1});  // along y in the plane
  CHECK(ray_cast(wheel, at(0, 1), ray, Space::planar)->distance == Approx(2.75));
  CHECK_FALSE(ray_cast(wheel, at(0, 1), ray, Space::spatial));
  const auto ground = ray_cast(shape_of(Terrain{{{-1, -1}, {0, -1}, {4, 3}}}), at(0, 0), ray);
  REQUIRE(ground);
  CHECK(ground->distance == Approx(4));
  CHECK((ground->normal - Vec3(-1, 1, 0).normalized()).norm() < rounding());
}

}  // namespace manyworlds::test
