// Mass properties of triangle meshes against closed forms, shapes, and each other.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "manyworlds/mesh.hpp"
#include "manyworlds/plan.hpp"
#include "tests/support/mass.hpp"
#include "tests/support/meshes.hpp"

namespace manyworlds {
namespace {

using test::body_of;
using test::box_mesh;
using test::check_equal;
using test::icosphere;
using test::inside_out;
using test::moved;
using test::rotation_of;
using test::shape;
using test::tetrahedron;
using test::together;
using test::torus_mesh;

constexpr double kDensity = 700;

// Of the same solid made of shapes, whose closed forms have their own tests.
MassProperties of_shapes(std::vector<Shape> shapes) {
  Scene scene;
  scene.options.density = kDensity;
  return mass_properties(scene, body_of(std::move(shapes)));
}
MassProperties of_mesh(const TriangleMesh& mesh) { return mass_properties(mesh, kDensity); }

Mat3 diagonal(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }
Mat3 rotated(const Mat3& inertia, const Quat& rotation) {
  const Mat3 r = rotation.normalized().toRotationMatrix();
  return r * inertia * r.transpose();
}

// Largest relative error of mass and inertia; the centre must be that of the closed form.
double error(const MassProperties& got, const MassProperties& exact) {
  CHECK((got.center - exact.center).norm() <= 1e-14);
  return std::max(std::abs(got.mass / exact.mass - 1),
                  (got.inertia - exact.inertia).norm() / exact.inertia.norm());
}

const Quat kRotation = rotation_of(0.7, {1, 2, -1});

}  // namespace

TEST_CASE("a mesh of a box has the box's mass properties", "[fast][scene]") {
  for (const Vec3& half : {Vec3(1, 1, 1), Vec3(0.3, 0.02, 7), Vec3(1, 1, 1e-6)}) {
    const TriangleMesh mesh = box_mesh(half);
    check_equal(of_mesh(mesh), of_shapes({shape(Box{half})}));
    CHECK(volume(mesh) == Approx(8 * half.prod()).epsilon(1e-14));
    CHECK(of_mesh(mesh).mass == kDensity * volume(mesh));
  }
}

TEST_CASE("a regular tetrahedron has a^3 / (6 sqrt 2) and m a^2 / 20", "[fast][scene]") {
  const TriangleMesh mesh = tetrahedron({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1});
  const double a = 2 * std::sqrt(2.0);
  const double mass = kDensity * a * a * a / (6 * std::sqrt(2.0));
  check_equal(of_mesh(mesh), {mass, Vec3::Zero(), mass * a * a / 20 * Mat3::Identity()});
}

TEST_CASE("the corner of a box has 3/80 m (b^2 + c^2) and m a b / 80", "[fast][scene]") {
  const double a = 0.5;
  const double b = 2;
  const double c = 3;
  const double mass = kDensity * a * b * c / 6;
  Mat3 inertia = 3 * diagonal(b * b + c * c, c * c + a * a, a * a + b * b);
  inertia(0, 1) = inertia(1, 0) = a * b;
  inertia(1, 2) = inertia(2, 1) = b * c;
  inertia(2, 0) = inertia(0, 2) = c * a;
  const Vec3 corner(-3, 5, 0.1);
  const TriangleMesh mesh = tetrahedron({a, 0, 0}, {0, b, 0}, {0, 0, c}, {0, 0, 0});
  const MassProperties expected{mass, corner + Vec3(a, b, c) / 4, mass / 80 * inertia};
  check_equal(of_mesh(moved(mesh, corner)), expected, 5);
}

TEST_CASE("icospheres converge to the sphere with the square of the edge", "[fast][scene]") {
  const double radius = 0.3;
  const MassProperties sphere = of_shapes({shape(Sphere{radius})});
  double before = error(of_mesh(icosphere(radius, 1)), sphere);
  for (int cuts = 2; cuts <= 5; ++cuts) {
    const double now = error(of_mesh(icosphere(radius, cuts)), sphere);
    CAPTURE(cuts, before, now);
    CHECK(before / now == Approx(4).epsilon(0.5 / (1 << cuts)));
    before = now;
  }
  CHECK(before < 3e-3);  // 20480 triangles
}

TEST_CASE("tori converge to 2 pi^2 R r^2 and m (R^2 + 3/4 r^2)", "[fast][scene]") {
  const double ring = 1;
  const double tube = 0.4;
  const double mass = kDensity * 2 * std::numbers::pi * std::numbers::pi * ring * tube * tube;
  const double across = mass * (ring * ring / 2 + 5 * tube * tube / 8);
  const double axial = mass * (ring * ring + 3 * tube * tube / 4);
  const MassProperties torus{mass, Vec3::Zero(), diagonal(across, across, axial)};
  double before = error(of_mesh(torus_mesh(ring, tube, 16, 8)), torus);
  for (int n = 2; n <= 16; n *= 2) {
    const double now = error(of_mesh(torus_mesh(ring, tube, 16 * n, 8 * n)), torus);
    CAPTURE(n, before, now);
    CHECK(before / now == Approx(4).epsilon(0.25 / n));
    before = now;
  }
  CHECK(before < 1e-3);  // 65536 triangles
}

TEST_CASE("a rotated and moved mesh has the rotated tensor and the moved centre", "[fast][scene]") {
  const Vec3 position(0.3, -2, 1);
  const MassProperties box = of_shapes({shape(Box{{1, 2, 3}})});
  check_equal(of_mesh(moved(box_mesh({1, 2, 3}), position, kRotation)),
              {box.mass, position, rotated(box.inertia, kRotation)}, 3);
  check_equal(of_mesh(moved(box_mesh({1, 2, 3}), position, kRotation)),
              of_shapes({shape(Box{{1, 2, 3}}, position, kRotation)}), 3);
}

TEST_CASE("a mesh 1e6 m away loses the digits of its coordinates and no others", "[fast][scene]") {
  const Vec3 offset(1e6, -2e6, 5e5);
  const MassProperties box = of_shapes({shape(Box{{1, 2, 3}})});
  // Whole numbers: the coordinates lose nothing.
  check_equal(of_mesh(moved(box_mesh({1, 2, 3}), offset)), {box.mass, offset, box.inertia}, 1);

  const TriangleMesh far = moved(icosphere(0.3, 3), offset, kRotation);
  const MassProperties there = of_mesh(far);
  // Moving back is exact: what remains is what rounding made of the coordinates.
  const MassProperties here = of_mesh(moved(far, -offset));
  check_equal(there, {here.mass, offset + here.center, here.inertia}, 1e6);
  CHECK((there.center - offset - here.center).norm() <= 2.4e-10);  // one rounding at 2e6 m

  // And that is half a unit in the last place, 1.2e-10 m of 0.3 m.
  check_equal(there, of_mesh(moved(icosphere(0.3, 3), offset)), 1e6, 1e-9);
}

TEST_CASE("vertices without a triangle weigh nothing, however far away", "[fast][scene]") {
  TriangleMesh mesh = box_mesh({1, 2, 3});
  mesh.vertices.emplace_back(1e30, 0, 0);
  check_equal(of_mesh(mesh), of_shapes({shape(Box{{1, 2, 3}})}));
}

TEST_CASE("a concave prism equals the two boxes it is made of", "[fast][scene]") {
  const TriangleMesh mesh = test::prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 0.5);
  const MassProperties expected = of_shapes(
      {shape(Box{{1, 0.5, 0.25}}, {1, 0.5, 0.25}), shape(Box{{0.5, 1, 0.25}}, {0.5, 2, 0.25})});
  CHECK(expected.inertia(0, 1) != 0);
  check_equal(of_mesh(mesh), expected);
  check_equal(of_mesh(moved(mesh, {5, 0, -3}, kRotation)),
              {expected.mass, Vec3(5, 0, -3) + kRotation * expected.center,
               rotated(expected.inertia, kRotation)},
              5);
}

TEST_CASE("parts add and cavities are taken away", "[fast][scene]") {
  const Vec3 apart(4, -1, 2);
  check_equal(of_mesh(together(box_mesh({1, 2, 3}), moved(box_mesh({0.5, 0.5, 1}), apart))),
              of_shapes({shape(Box{{1, 2, 3}}), shape(Box{{0.5, 0.5, 1}}, apart)}), 5);

  // A ball with a ball left out at an offset, by the parallel-axis theorem.
  const TriangleMesh ball = icosphere(1, 3);
  const TriangleMesh hole = moved(icosphere(0.4, 2), {0.3, -0.1, 0.2});
  const MassProperties whole = of_mesh(ball);
  const MassProperties part = of_mesh(hole);
  MassProperties rest;
  rest.mass = whole.mass - part.mass;
  rest.center = (whole.mass * whole.center - part.mass * part.center) / rest.mass;
  const auto about_rest = [&](const MassProperties& p) {
    const Vec3 d = p.center - rest.center;
    return Mat3(p.inertia + p.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose()));
  };
  rest.inertia = about_rest(whole) - about_rest(part);
  check_equal(of_mesh(together(ball, inside_out(hole))), rest);
}

TEST_CASE("mass grows with the cube of the size and inertia with its fifth power",
          "[fast][scene]") {
  const TriangleMesh mesh = moved(test::prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 1),
                                  {0.5, 0, 0}, kRotation);
  const MassProperties one = of_mesh(mesh);
  for (const double s : {1e-6, 0.37, 3.0, 1e6}) {
    const MassProperties got = of_mesh(moved(mesh, Vec3::Zero(), Quat::Identity(), s));
    check_equal(got, {one.mass * std::pow(s, 3), s * one.center, std::pow(s, 5) * one.inertia}, s);
  }
  check_equal(mass_properties(mesh, 3 * kDensity), {3 * one.mass, one.center, 3 * one.inertia});
}

TEST_CASE("bodies take the mass properties of meshes", "[fast][scene]") {
  const std::vector<TriangleMesh> meshes = {
      box_mesh({1, 2, 3}),
      // Plates and rods are on the edge of what the triangle inequality of the moments allows.
      moved(box_mesh({1, 1, 1e-4}), {0.1, 0, 0}, kRotation),
      moved(box_mesh({1, 1e-4, 1e-4}), {0.1, 0, 0}, kRotation),
      tetrahedron({1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {0, 0, 0}),
      torus_mesh(1, 0.3, 12, 6),
      together(icosphere(1, 2), inside_out(icosphere(0.9, 2))),
  };
  Scene scene;
  for (const TriangleMesh& mesh : meshes) {
    Body body = body_of({shape(Sphere{0.5})});
    body.mass_properties = of_mesh(mesh);
    const Mat3& inertia = body.mass_properties->inertia;
    CHECK(inertia == Mat3(inertia.transpose()));
    scene.add(body);
  }
  CHECK(validate(scene).empty());
  CHECK_NOTHROW(compile(scene));
}

}  // namespace manyworlds
