// Mass, centre and inertia against closed forms, and against each other.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/mass.hpp"

namespace manyworlds {
namespace {

using test::body_of;
using test::check_equal;
using test::rotation_of;
using test::shape;

constexpr double kPi = 3.14159265358979323846;

Scene scene_of(Space space, double density) {
  Scene scene;
  scene.space = space;
  scene.options.density = density;
  return scene;
}
const Scene kSpatial = scene_of(Space::spatial, 1000);
const Scene kPlanar = scene_of(Space::planar, 2);

}  // namespace

TEST_CASE("a sphere has 4/3 pi r^3 and 2/5 m r^2", "[fast][scene]") {
  const MassProperties got = mass_properties(kSpatial, body_of({shape(Sphere{0.3})}));
  const double mass = 1000 * 4.0 / 3.0 * kPi * 0.027;
  check_equal(got, {mass, Vec3::Zero(), 0.4 * mass * 0.09 * Mat3::Identity()});
}

TEST_CASE("a capsule has a cylinder's and two half balls' mass and moments", "[fast][scene]") {
  const double r = 0.3, h = 0.7;
  const double cylinder = 1000 * kPi * r * r * 2 * h, ball = 1000 * 4.0 / 3.0 * kPi * r * r * r;
  const double along = cylinder * r * r / 2 + ball * 2 / 5 * r * r;
  // Half balls about their own centres of mass, 3/8 r beyond the ends of the cylinder.
  const double beyond = h + 3.0 / 8 * r;
  const double own = ball * (2.0 / 5 * r * r - 9.0 / 64 * r * r);
  const double across = cylinder * (3 * r * r + 4 * h * h) / 12 + own + ball * beyond * beyond;
  const MassProperties got = mass_properties(kSpatial, body_of({shape(Capsule{r, h})}));
  check_equal(got, {cylinder + ball, Vec3::Zero(), Vec3(across, across, along).asDiagonal()});
  // A very short one is a ball.
  check_equal(mass_properties(kSpatial, body_of({shape(Capsule{r, 1e-9})})),
              mass_properties(kSpatial, body_of({shape(Sphere{r})})), 1, 1e-8);
}

TEST_CASE("a planar capsule has a rectangle's and two half discs' area and moment",
          "[fast][scene]") {
  const double r = 0.3, h = 0.7;
  const double rectangle = 2 * 4 * r * h, disc = 2 * kPi * r * r, beyond = 4 * r / (3 * kPi);
  const double moment = rectangle * (4 * r * r + 4 * h * h) / 12 +
                        disc * (r * r / 2 - beyond * beyond + (h + beyond) * (h + beyond));
  check_equal(mass_properties(kPlanar, body_of({shape(Capsule{r, h})})),
              {rectangle + disc, Vec3::Zero(), moment * Mat3::Identity()});
}

TEST_CASE("a box has 8abc and m/3 (b^2 + c^2)", "[fast][scene]") {
  const MassProperties got = mass_properties(kSpatial, body_of({shape(Box{{1, 2, 3}})}));
  CHECK(got.mass == 48000);
  const Mat3 expected = Vec3(13, 10, 5).asDiagonal();
  check_equal(got, {48000, Vec3::Zero(), 16000 * expected});
}

TEST_CASE("a circle has pi r^2 and 1/2 m r^2", "[fast][scene]") {
  const MassProperties got = mass_properties(kPlanar, body_of({shape(Circle{0.5})}));
  const double mass = 2 * kPi * 0.25;
  CHECK(got.mass == Approx(mass).epsilon(1e-14));
  CHECK(got.inertia(2, 2) == Approx(0.125 * mass).epsilon(1e-14));
  // Planar tensors stay invertible.
  CHECK(got.inertia == Mat3(got.inertia(2, 2) * Mat3::Identity()));
}

TEST_CASE("a right triangle has its centroid at a third and m (b^2 + h^2) / 18", "[fast][scene]") {
  const MassProperties got =
      mass_properties(kPlanar, body_of({shape(Polygon{{{0, 0}, {3, 0}, {0, 6}}})}));
  check_equal(got, {18, {1, 2, 0}, 18 * (9 + 36) / 18.0 * Mat3::Identity()});
}

TEST_CASE("a rectangle as polygon has m/3 (a^2 + b^2)", "[fast][scene]") {
  const MassProperties got = mass_properties(kPlanar, body_of({shape(Polygon::box(1, 2))}));
  check_equal(got, {16, Vec3::Zero(), 16 * 5 / 3.0 * Mat3::Identity()});
}

TEST_CASE("a polygon prism agrees with the box of the same outline", "[fast][scene]") {
  // The planar moment of an area is that of a solid of unit height and the same outline about z.
  const Polygon outline = Polygon::box(0.7, 0.2);
  const MassProperties flat = mass_properties(kPlanar, body_of({shape(outline)}));
  const MassProperties solid =
      mass_properties(scene_of(Space::spatial, 2), body_of({shape(Box{{0.7, 0.2, 0.5}})}));
  CHECK(flat.mass == Approx(solid.mass).epsilon(1e-14));
  CHECK(flat.inertia(2, 2) == Approx(solid.inertia(2, 2)).epsilon(1e-14));
}

TEST_CASE("a hexagon equals the six triangles it is made of", "[fast][scene]") {
  std::vector<Vec2> ring;
  for (int i = 0; i < 6; ++i) {
    ring.emplace_back(0.3 + std::cos(i * kPi / 3), -0.2 + std::sin(i * kPi / 3));
  }
  std::vector<Shape> triangles;
  for (std::size_t i = 0; i < 6; ++i) {
    triangles.push_back(shape(Polygon{{{0.3, -0.2}, ring[i], ring[(i + 1) % 6]}}));
  }
  const MassProperties whole = mass_properties(kPlanar, body_of({shape(Polygon{ring})}));
  check_equal(mass_properties(kPlanar, body_of(triangles)), whole);
  // Regular hexagon of circumradius 1: area 3 sqrt(3) / 2, moment 5/12 m.
  CHECK(whole.mass == Approx(3 * std::sqrt(3.0)).epsilon(1e-13));
  CHECK(whole.inertia(2, 2) == Approx(5.0 / 12.0 * whole.mass).epsilon(1e-13));
}

TEST_CASE("a box equals the eight boxes it is cut into", "[fast][scene]") {
  const Vec3 half{0.4, 0.6, 1};
  std::vector<Shape> octants;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    octants.push_back(shape(Box{half / 2}, sign.cwiseProduct(half) / 2));
  }
  check_equal(mass_properties(kSpatial, body_of(octants)),
              mass_properties(kSpatial, body_of({shape(Box{half})})));
}

TEST_CASE("two balls on a line obey the parallel-axis theorem", "[fast][scene]") {
  const double d = 3;
  const MassProperties got = mass_properties(
      kSpatial, body_of({shape(Sphere{0.5}, {-1, 0, 0}), shape(Sphere{0.5}, {d - 1, 0, 0})}));
  const double mass = 1000 * 4.0 / 3.0 * kPi * 0.125;
  const double own = 2 * 0.4 * mass * 0.25;
  const double far = own + 2 * mass * d * d / 4;
  check_equal(got, {2 * mass, {d / 2 - 1, 0, 0}, Vec3(own, far, far).asDiagonal()});
}

TEST_CASE("densities weigh the centre of mass", "[fast][scene]") {
  std::vector<Shape> shapes = {shape(Circle{1}), shape(Circle{1}, {4, 0, 0})};
  shapes[0].density = 1;
  shapes[1].density = 3;
  const MassProperties got = mass_properties(kPlanar, body_of(shapes));
  CHECK(got.mass == Approx(4 * kPi).epsilon(1e-14));
  CHECK(got.center.x() == Approx(3).epsilon(1e-14));
  CHECK(got.inertia(2, 2) == Approx(4 * kPi / 2 + kPi * 9 + 3 * kPi * 1).epsilon(1e-14));
}

TEST_CASE("rotating a shape rotates its tensor, whatever the quaternion's length",
          "[fast][scene]") {
  const Quat rotation = rotation_of(0.7, {1, 2, -1});
  const Quat scaled(Eigen::Vector4d(-3.5 * rotation.coeffs()));
  const Vec3 position(0.3, -2, 1);
  const MassProperties plain = mass_properties(kSpatial, body_of({shape(Box{{1, 2, 3}})}));
  const Mat3 r = rotation.toRotationMatrix();
  const MassProperties expected{plain.mass, position, r * plain.inertia * r.transpose()};
  for (const Quat& q : {rotation, scaled}) {
    check_equal(mass_properties(kSpatial, body_of({shape(Box{{1, 2, 3}}, position, q)})), expected);
  }
}

TEST_CASE("a planar shape rotates about its frame", "[fast][scene]") {
  const Polygon polygon{{{0, 0}, {3, 0}, {0, 6}}};  // centroid (1, 2)
  const MassProperties got = mass_properties(
      kPlanar, body_of({shape(polygon, {10, 0, 0}, rotation_of(kPi / 2, {0, 0, 1}))}));
  check_equal(got, {18, {8, 1, 0}, 45 * Mat3::Identity()}, 10);
}

TEST_CASE("isotropic shapes stay exactly isotropic when rotated", "[fast][scene]") {
  const Quat rotation = rotation_of(0.7, {1, 2, -1});
  for (const Geometry& geometry : {Geometry(Sphere{0.3}), Geometry(Box{{0.3, 0.3, 0.3}})}) {
    const Mat3 inertia =
        mass_properties(kSpatial, body_of({shape(geometry, {1, 2, 3}, rotation)})).inertia;
    CHECK(inertia == Mat3(inertia(0, 0) * Mat3::Identity()));
  }
}

TEST_CASE("moving all shapes moves the centre and nothing else", "[fast][scene]") {
  const Quat rotation = rotation_of(1.1, {0, 1, 1});
  const std::vector<Shape> shapes = {shape(Box{{0.3, 0.1, 0.2}}, {0.1, 0, 0}, rotation),
                                     shape(Sphere{0.2}, {-0.3, 0.5, 0})};
  const MassProperties near = mass_properties(kSpatial, body_of(shapes));
  for (const double distance : {1.0, 1000.0}) {
    const Vec3 offset(distance, -2 * distance, distance / 2);
    std::vector<Shape> moved = shapes;
    for (Shape& s : moved) s.position += offset;
    // Positions themselves are rounded at this distance.
    check_equal(mass_properties(kSpatial, body_of(moved)),
                {near.mass, near.center + offset, near.inertia}, distance, 1e-12);
  }
  const std::vector<Vec2> outline = {{0, 0}, {1, 0}, {0.5, 0.75}};
  std::vector<Vec2> far = outline;
  for (Vec2& vertex : far) vertex += Vec2(4096, -8192);  // exact in binary
  const MassProperties here = mass_properties(kPlanar, body_of({shape(Polygon{outline})}));
  check_equal(mass_properties(kPlanar, body_of({shape(Polygon{far})})),
              {here.mass, here.center + Vec3(4096, -8192, 0), here.inertia}, 8192);
}

TEST_CASE("shapes in the same place add", "[fast][scene]") {
  const MassProperties one = mass_properties(kSpatial, body_of({shape(Sphere{0.5})}));
  const MassProperties two =
      mass_properties(kSpatial, body_of({shape(Sphere{0.5}), shape(Sphere{0.5})}));
  check_equal(two, {2 * one.mass, Vec3::Zero(), 2 * one.inertia});
}

TEST_CASE("planes and bodies without shapes have no mass", "[fast][scene]") {
  for (const Body& body : {body_of({shape(Plane{}), shape(Plane{})}), Body{}}) {
    const MassProperties got = mass_properties(kSpatial, body);
    CHECK(got.mass == 0);
    CHECK(got.center == Vec3::Zero());
    CHECK(got.inertia == Mat3::Zero());
  }
  // Nor do they pull at the others.
  const Shape box = shape(Box{{1, 2, 3}}, {1, 1, 1});
  check_equal(mass_properties(kSpatial, body_of({shape(Plane{}), box})),
              mass_properties(kSpatial, body_of({box})));
}

TEST_CASE("given mass properties are returned as they are", "[fast][scene]") {
  Body body = body_of({shape(Sphere{0.5})});
  body.mass_properties = MassProperties{7, {1, 2, 3}, Vec3(4, 5, 6).asDiagonal()};
  const MassProperties got = mass_properties(kSpatial, body);
  CHECK(got.mass == 7);
  CHECK(got.center == Vec3(1, 2, 3));
  CHECK(got.inertia == Mat3(Vec3(4, 5, 6).asDiagonal()));
}

}  // namespace manyworlds
