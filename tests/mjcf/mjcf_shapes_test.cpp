// Cylinders, meshes and height fields from MJCF: their numbers, judged by MuJoCo's own model and
// rays, and where they come to rest.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>
#include <catch2/catch.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"

#include "tests/mjcf/mujoco_reference.hpp"

namespace manyworlds {
namespace {

using test::Reference;

std::string world_of(const std::string& content, const std::string& assets = "") {
  return "<mujoco><asset>" + assets + "</asset><worldbody>" + content + "</worldbody></mujoco>";
}

// A brick of 0.2 x 0.4 x 0.6 m, turned and away from the origin of its vertices.
struct Brick {
  Vec3 half{0.1, 0.2, 0.3};
  Vec3 center{1, -2, 0.5};
  Quat turn{Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized())};

  std::vector<Vec3> corners() const {
    std::vector<Vec3> result;
    for (int i = 0; i < 8; ++i) {
      const Vec3 sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      result.push_back(center + turn * half.cwiseProduct(sign));
    }
    return result;
  }
};

std::string mesh_of(const std::vector<Vec3>& vertices, const std::string& attributes = "") {
  std::string text = "<mesh name='m' " + attributes + " vertex='";
  for (const Vec3& v : vertices) {
    for (int i = 0; i < 3; ++i) text += std::to_string(v[i]) + " ";
  }
  return text + "'/>";
}

std::vector<Vec3> ball_points(int count) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(0.3 * Vec3(normal(random), normal(random), normal(random)).normalized());
  }
  return points;
}

// Of the triangles on either side of the diagonals from the corners of low x and y.
double surface(const HeightField& f, double x, double y) {
  const double u = x / f.cell.x() + 0.5 * (f.columns - 1);
  const double v = y / f.cell.y() + 0.5 * (f.rows() - 1);
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const double s = u - i, t = v - j;
  const auto height = [&](int column, int row) {
    return f.heights[static_cast<std::size_t>(column + row * f.columns)];
  };
  const double low = height(i, j), high = height(i + 1, j + 1);
  return s >= t ? low + s * (height(i + 1, j) - low) + t * (high - height(i + 1, j))
                : low + t * (height(i, j + 1) - low) + s * (high - height(i, j + 1));
}

// 5 points along x, 4 along y. The highest four are around the cell (x, y) = (0.5, -1).
const char* const kHeightField =
    "<hfield name='h' nrow='4' ncol='5' size='1 1.5 0.8 0.1' elevation='"
    "0   0   0.1 0   0 "
    "0.2 0   0   0.3 0 "
    "0   0.4 0   2   2 "
    "0   0   0   2   2'/>";

Vec3 last_position(const Scene& scene, int steps) {
  BatchOptions options;
  options.worlds = 1;
  options.threads = 1;
  options.precision = Precision::f64;
  Batch batch(compile(scene), options);
  batch.step(steps);
  std::vector<double> x(static_cast<std::size_t>(3 * batch.bodies()));
  batch.read(Field::position, 0, x);
  const std::size_t at = x.size() - 3;
  return {x[at], x[at + 1], x[at + 2]};
}

}  // namespace

TEST_CASE("cylinders keep MuJoCo's size, axis and mass", "[mjcf][fast]") {
  for (const std::string geom :
       {"size='.1 .25' pos='.25 0 0' zaxis='1 0 0'", "size='.1' fromto='0 0 0 .5 0 0'"}) {
    const Scene scene =
        load_mjcf_string(
            world_of("<body name='b'><freejoint/><geom type='cylinder' density='500' " + geom +
                     "/></body>"))
            .scene;
    const Body& body = scene.bodies.at(0);
    REQUIRE(body.shapes.size() == 1);
    const auto& cylinder = std::get<Cylinder>(body.shapes[0].geometry);
    CHECK(cylinder.radius == Approx(0.1));
    CHECK(cylinder.half_length == Approx(0.25));
    CHECK((body.shapes[0].position - Vec3(0.25, 0, 0)).norm() < 1e-12);
    CHECK(std::abs((body.shapes[0].rotation * Vec3::UnitZ()).x()) == Approx(1));
    Body own = body;
    own.mass_properties.reset();
    own.shapes[0].density = 500;
    const MassProperties given = mass_properties(scene, body),
                         derived = mass_properties(scene, own);
    CHECK(derived.mass == Approx(given.mass).epsilon(1e-12));
    CHECK((derived.center - given.center).norm() < 1e-12);
    CHECK((derived.inertia - given.inertia).norm() < 1e-9 * given.inertia.norm());
    CHECK(*scene.options.length_unit == Approx(0.54));  // 2 sqrt(0.1^2 + 0.25^2)
  }
}

TEST_CASE("ellipsoids keep MuJoCo's radii, axes and mass", "[mjcf][fast]") {
  const Scene scene =
      load_mjcf_string(world_of("<body name='b'><freejoint/><geom type='ellipsoid' size='.1 .2 .3' "
                                "density='500' pos='.1 0 0' euler='30 20 10'/></body>"))
          .scene;
  const Body& body = scene.bodies.at(0);
  REQUIRE(body.shapes.size() == 1);
  CHECK(std::get<Ellipsoid>(body.shapes[0].geometry).radii == Vec3(0.1, 0.2, 0.3));
  Body own = body;
  own.mass_properties.reset();
  own.shapes[0].density = 500;
  const MassProperties given = mass_properties(scene, body), derived = mass_properties(scene, own);
  CHECK(derived.mass == Approx(given.mass).epsilon(1e-12));
  CHECK((derived.center - given.center).norm() < 1e-12);
  CHECK((derived.inertia - given.inertia).norm() < 1e-9 * given.inertia.norm());
}

TEST_CASE("a mesh is the hull of its vertices where the file has them", "[mjcf][fast]") {
  const Brick brick;
  std::vector<Vec3> points = brick.corners();
  points.push_back(brick.center);  // no corner
  const Vec3 shift(0.2, 0.1, -0.3);
  const Quat turn(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  const Scene scene =
      load_mjcf_string(world_of("<body name='b' pos='0 0 5'><freejoint/><geom name='g' type='mesh' "
                                "mesh='m' pos='.2 .1 -.3' euler='0 28.6478897565 0'/></body>",
                                mesh_of(points)))
          .scene;
  const Body& body = scene.bodies.at(0);
  REQUIRE(body.shapes.size() == 1);
  const Shape& shape = body.shapes[0];
  const auto& hull = std::get<Hull>(shape.geometry);
  REQUIRE(hull.vertices.size() == 8);
  // MuJoCo moves vertices to the centre of mass and its axes; the geom's pose takes that back.
  for (const Vec3& corner : brick.corners()) {
    double nearest = 1;
    for (const Vec3& v : hull.vertices) {
      nearest =
          std::min(nearest, (shape.position + shape.rotation * v - shift - turn * corner).norm());
    }
    CHECK(nearest < 2e-6);  // the file has 6 digits, MuJoCo keeps floats
  }
  const MassProperties& mass = *body.mass_properties;
  CHECK(mass.mass == Approx(1000 * 8 * 0.1 * 0.2 * 0.3).epsilon(1e-5));
  CHECK((mass.center - shift - turn * brick.center).norm() < 1e-5);
  Body own = body;
  own.mass_properties.reset();
  const MassProperties derived = mass_properties(scene, own);
  CHECK((derived.inertia - mass.inertia).norm() < 1e-5 * mass.inertia.norm());
  CHECK(*scene.options.length_unit == Approx(0.75).epsilon(0.2));
}

TEST_CASE("a mesh of too many corners is an error that maxhullvert mends", "[mjcf][fast]") {
  const std::string geom =
      "<body name='b'><freejoint/><geom name='g' type='mesh' mesh='m'/></body>";
  try {
    load_mjcf_string(world_of(geom, mesh_of(ball_points(9000))));
    FAIL("expected an error");
  } catch (const MjcfError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK_THAT(error.what(), Catch::Contains("geom 'g' of body 'b'") &&
                                 Catch::Contains("mesh 'm' has a convex hull of more than 8192 "
                                                 "corners; expected at most 8192") &&
                                 Catch::Contains("maxhullvert"));
  }
  const Scene scene =
      load_mjcf_string(world_of(geom, mesh_of(ball_points(200), "maxhullvert='64'"))).scene;
  const std::size_t corners =
      std::get<Hull>(scene.bodies.at(0).shapes.at(0).geometry).vertices.size();
  CHECK(corners <= 64);
  CHECK(corners > 50);
}

TEST_CASE("meshes that are only seen are left out, but weigh", "[mjcf][fast]") {
  const Scene scene =
      load_mjcf_string(world_of("<body><freejoint/><geom size='.1' mass='1'/>"
                                "<geom type='mesh' mesh='m' contype='0' conaffinity='0' mass='2'/>"
                                "</body>",
                                mesh_of(ball_points(200))))
          .scene;
  CHECK(scene.bodies.at(0).shapes.size() == 1);
  CHECK(scene.bodies.at(0).mass_properties->mass == Approx(3));
}

TEST_CASE("a height field has MuJoCo's surface", "[mjcf][fast]") {
  const std::string xml = world_of(
      "<body name='land' pos='0.3 -0.2 0.1' euler='0 0 30'><geom name='g' type='hfield' "
      "hfield='h' pos='0 0 0.2'/></body>",
      kHeightField);
  const MjcfResult result = load_mjcf_string(xml);
  REQUIRE(result.warnings.size() == 1);
  CHECK_THAT(result.warnings[0], Catch::Contains("geom 'g' of body 'land', line 1: is solid "
                                                 "to any depth below its surface") &&
                                     Catch::Contains("0.1 m"));
  const Body& body = result.scene.bodies.at(0);
  CHECK(body.motion == Motion::fixed);
  const Shape& shape = body.shapes.at(0);
  const auto& field = std::get<HeightField>(shape.geometry);
  CHECK(field.columns == 5);
  CHECK(field.rows() == 4);
  CHECK((field.cell - Vec2(0.5, 1)).norm() < 1e-15);
  CHECK(*std::max_element(field.heights.begin(), field.heights.end()) == Approx(0.8));

  // Rays find row order, scale and diagonals.
  const Reference reference(xml);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-0.98, 0.98);
  double apart = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = unit(random), y = 1.5 * unit(random), high = 3;
    const Vec3 start =
        body.position + body.rotation * (shape.position + shape.rotation * Vec3(x, y, high));
    const Vec3 down = -Vec3::UnitZ();
    int geom = -1;
    const double length = mj_ray(reference.model.get(), reference.data.get(), start.data(),
                                 down.data(), nullptr, 1, -1, &geom, nullptr);
    REQUIRE(length > 0);
    apart = std::max(apart, std::abs(surface(field, x, y) - (high - length)));
  }
  CHECK(apart < 1e-6);  // MuJoCo keeps floats
}

TEST_CASE("shapes from MJCF rest where they should", "[mjcf]") {
  struct Case {
    const char* what;
    std::string body;
    double height;  // m, of the body's origin
  };
  const std::vector<Case> table = {
      {"upright cylinder", "<geom type='cylinder' size='.2 .15'/>", 0.15},
      {"lying cylinder", "<geom type='cylinder' size='.2 .3' zaxis='1 0 0'/>", 0.2},
      {"mesh", "<geom type='mesh' mesh='m'/>", 0.3},
  };
  // A pyramid on its base, with the body's origin 0.3 m above the base.
  const std::string pyramid = mesh_of(
      {{-0.2, -0.2, -0.3}, {0.2, -0.2, -0.3}, {0.2, 0.2, -0.3}, {-0.2, 0.2, -0.3}, {0, 0, 0.2}});
  for (const Case& c : table) {
    INFO(c.what);
    const Scene scene =
        load_mjcf_string(world_of("<geom type='plane' size='1 1 1'/><body pos='0.1 0.2 0.5'>"
                                  "<freejoint/>" +
                                      c.body + "</body>",
                                  pyramid))
            .scene;
    const Vec3 x = last_position(scene, 1000);
    CHECK(std::abs(x.z() - c.height) < 4 * *compile(scene).resolved().contact.slop);
    CHECK((x.head<2>() - Vec2(0.1, 0.2)).norm() < 0.01);
  }
}

TEST_CASE("a ball dropped on the highest cell of a height field stays there", "[mjcf]") {
  // The last rows of the file are those of low y; the cell is from (0.5, -1.5) to (1, -0.5).
  const Scene scene = load_mjcf_string(world_of("<geom type='hfield' hfield='h' pos='0 0 1'/>"
                                                "<body pos='0.75 -1 2.2'><freejoint/>"
                                                "<geom size='0.1'/></body>",
                                                kHeightField))
                          .scene;
  const Vec3 x = last_position(scene, 1000);
  CHECK((x - Vec3(0.75, -1, 1 + 0.8 + 0.1)).norm() < 4 * 0.005 * 0.2);
}

}  // namespace manyworlds
