// What validate() says about shapes: each bad input gives exactly one issue at its place.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_cases.hpp"

namespace manyworlds {
namespace {

using test::BadInput;
using test::check_each;
using test::circle_scene;

using test::kInf;
using test::kNan;
using test::sphere_scene;

// Body 1, shape 0 of each scene is what the cases change.
Scene box_scene() { return test::spatial_scene_with(Box{{0.5, 0.4, 0.3}}); }
Scene polygon_scene(std::vector<Vec2> vertices) {
  return test::planar_scene_with(Polygon{std::move(vertices)});
}
std::vector<Vec2> regular(int count, int step = 1) {
  std::vector<Vec2> vertices;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * i * step / count;
    vertices.emplace_back(std::cos(angle), std::sin(angle));
  }
  return vertices;
}

template <class G>
G& geometry(Scene& scene, std::size_t body = 1) {
  return std::get<G>(scene.bodies[body].shapes[0].geometry);
}

const char* const kShape = "body 1 'crate', shape 0 'hull': ";

// Body 0, shape 0 is what the cases change.
Scene ground_scene(Geometry ground) {
  return test::scene_with(Space::planar, std::move(ground), Circle{0.5});
}
const char* const kGround = "body 0 'ground', shape 0: ";

}  // namespace

TEST_CASE("bad capsules are named with their value", "[fast][scene]") {
  for (const Scene& scene :
       {test::spatial_scene_with(Capsule{0.5, 1}), test::planar_scene_with(Capsule{0.5, 1})}) {
    const auto capsule = [](Scene& s) -> Capsule& { return geometry<Capsule>(s); };
    check_each(
        scene, kShape,
        {{"radius", "is 0 m, must be > 0", [&](Scene& s) { capsule(s).radius = 0; }},
         {"radius", "is nan m", [&](Scene& s) { capsule(s).radius = kNan; }},
         {"half_length", "is -1 m, must be > 0", [&](Scene& s) { capsule(s).half_length = -1; }},
         {"half_length", "is inf m", [&](Scene& s) { capsule(s).half_length = kInf; }},
         {"half_length", "is 1e+09 m", [&](Scene& s) { capsule(s).half_length = 1e9; }}});
  }
}

TEST_CASE("bad segments and terrains are named with their value", "[fast][scene]") {
  const auto segment = [](Scene& s) -> Segment& { return geometry<Segment>(s, 0); };
  check_each(ground_scene(Segment{{0, 0}, {1, 0}}), kGround,
             {{"a.x", "is nan m", [&](Scene& s) { segment(s).a.x() = kNan; }},
              {"b.y", "is 1e+09 m", [&](Scene& s) { segment(s).b.y() = 1e9; }},
              {"b", "the same as a", [&](Scene& s) { segment(s).b = segment(s).a; }}});
  const auto points = [](Scene& s) -> std::vector<Vec2>& { return geometry<Terrain>(s, 0).points; };
  const Scene open = ground_scene(Terrain{{{0, 0}, {1, 0}, {2, 1}}});
  check_each(open, kGround,
             {{"points", "are 1, must be at least 2", [&](Scene& s) { points(s).resize(1); }},
              {"points[1].x", "is inf m", [&](Scene& s) { points(s)[1].x() = kInf; }},
              {"points[2]", "the same as points[1]",
               [&](Scene& s) {
                 points(s)[2] = {1, 0};
               }},
              {"points[1]", "folds back", [&](Scene& s) {
                 points(s)[2] = {-1, 0};
               }}});
  const Scene loop = ground_scene(Terrain{{{0, 0}, {1, 1}, {2, 0}}, true});
  check_each(
      loop, kGround,
      {{"points", "at least 3 in a loop", [&](Scene& s) { points(s).resize(2); }},
       {"points[0]", "the same as points[3]", [&](Scene& s) { points(s).emplace_back(0, 0); }}});
}

TEST_CASE("segments and terrains belong to fixed bodies of planar scenes", "[fast][scene]") {
  for (const Geometry& line : {Geometry(Segment{}), Geometry(Terrain{{{0, 0}, {1, 0}}})}) {
    const char* const kFixed = "on a body that can move, must be on a fixed body";
    const std::vector<Issue> moving = validate(test::planar_scene_with(line));
    REQUIRE(!moving.empty());
    CHECK_THAT(moving.front().message, Catch::Contains(kFixed));
    const std::vector<Issue> spatial =
        validate(test::scene_with(Space::spatial, line, Sphere{0.5}));
    REQUIRE(spatial.size() == 1);
    CHECK_THAT(spatial.front().message, Catch::Contains("a spatial scene takes"));
  }
}

TEST_CASE("bad radii and half extents are named with their value", "[fast][scene]") {
  const auto radius = [](Scene& s, double r) { geometry<Sphere>(s).radius = r; };
  check_each(sphere_scene(), kShape,
             {{"radius", "is -0.5 m, must be > 0", [&](Scene& s) { radius(s, -0.5); }},
              {"radius", "is 0 m, must be > 0", [&](Scene& s) { radius(s, 0); }},
              {"radius", "is nan m, must be > 0", [&](Scene& s) { radius(s, kNan); }},
              {"radius", "is nan m, must be > 0", [&](Scene& s) { radius(s, -kNan); }},
              {"radius", "is inf m", [&](Scene& s) { radius(s, kInf); }},
              {"radius", "is 1e-310 m", [&](Scene& s) { radius(s, 1e-310); }},
              {"radius", "is 1e+09 m", [&](Scene& s) { radius(s, 1e9); }}});
  const auto extents = [](Scene& s) -> Vec3& { return geometry<Box>(s).half_extents; };
  check_each(
      box_scene(), kShape,
      {{"half_extents.x", "is 0 m, must be > 0", [&](Scene& s) { extents(s).x() = 0; }},
       {"half_extents.y", "is -0.2 m, must be > 0", [&](Scene& s) { extents(s).y() = -0.2; }},
       {"half_extents.z", "is nan m, must be > 0", [&](Scene& s) { extents(s).z() = kNan; }}});
  check_each(circle_scene(), kShape,
             {{"radius", "is 0 m, must be > 0", [](Scene& s) { geometry<Circle>(s).radius = 0; }},
              {"radius", "is nan m", [](Scene& s) { geometry<Circle>(s).radius = kNan; }}});
}

TEST_CASE("bad polygons are named with the vertex", "[fast][scene]") {
  const auto set = [](std::vector<Vec2> vertices) {
    return [vertices](Scene& s) { geometry<Polygon>(s).vertices = vertices; };
  };
  const std::vector<Vec2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  check_each(polygon_scene(square), kShape,
             {{"vertices", "are 0, must be 3 to 8", set({})},
              {"vertices", "are 2, must be 3 to 8", set({{0, 0}, {1, 0}})},
              {"vertices", "are 9, must be 3 to 8", set(regular(9))},
              {"vertices", "clockwise", set({{0, 0}, {0, 1}, {1, 1}, {1, 0}})},
              {"vertices[2]", "bends inwards", set({{0, 0}, {1, 0}, {0.4, 0.4}, {0, 1}})},
              {"vertices[1]", "on a line", set({{0, 0}, {0.5, 0}, {1, 0}, {1, 1}})},
              {"vertices[1]", "on a line", set({{0, 0}, {0.5, 1e-7}, {1, 0}, {1, 1}, {0, 1}})},
              {"vertices[2]", "the same as vertices[1]", set({{0, 0}, {1, 0}, {1, 0}, {0, 1}})},
              {"vertices[3]", "the same as vertices[0]", set({{0, 0}, {1, 0}, {0, 1}, {0, 0}})},
              {"vertices", "enclose 0 m^2", set({{0, 0}, {1, 0}, {2, 0}})},
              {"vertices", "enclose 0 m^2", set({{0, 0}, {1, 1}, {1, 0}, {0, 1}})},
              {"vertices", "enclose", set({{0, 0}, {1, 0}, {0.5, 1e-7}})},
              {"vertices", "go around more than once", set(regular(5, 2))},
              {"vertices[1].x", "is nan m, must be finite", set({{0, 0}, {kNan, 0}, {0, 1}})},
              {"vertices[2].y", "is -inf m, must be finite", set({{0, 0}, {1, 0}, {0, -kInf}})},
              {"vertices[1].x", "is 2e+08 m", set({{0, 0}, {2e8, 0}, {0, 1e8}})}});
}

TEST_CASE("a clockwise polygon with a dent has both issues", "[fast][scene]") {
  const std::vector<Issue> issues = validate(polygon_scene({{0, 1}, {0.4, 0.4}, {1, 0}, {0, 0}}));
  REQUIRE(issues.size() == 2);
  CHECK(issues[0].place == std::string(kShape) + "vertices");
  CHECK(issues[1].place == std::string(kShape) + "vertices[1]");
}

TEST_CASE("convex polygons of 3 to 8 vertices are valid anywhere", "[fast][scene]") {
  for (int count = 3; count <= 8; ++count) {
    for (const double shift : {0.0, 1000.0}) {
      std::vector<Vec2> vertices = regular(count);
      for (Vec2& vertex : vertices) vertex.x() += shift;
      CHECK(validate(polygon_scene(vertices)).empty());
    }
  }
  CHECK(validate(test::planar_scene_with(Polygon::box(0.001, 0.2))).empty());
}

TEST_CASE("planes must be unit and on fixed bodies", "[fast][scene]") {
  // Body 0 of both scenes is the ground.
  const auto plane = [](Scene& s) -> Plane& { return geometry<Plane>(s, 0); };
  const auto half_plane = [](Scene& s) -> HalfPlane& { return geometry<HalfPlane>(s, 0); };
  const char* const place = "body 0 'ground', shape 0: ";
  check_each(sphere_scene(), place,
             {{"normal", "has length 0, must be 1", [&](Scene& s) { plane(s).normal.setZero(); }},
              {"normal", "has length 2, must be 1",
               [&](Scene& s) {
                 plane(s).normal = {0, 0, 2};
               }},
              {"normal", "has length",
               [&](Scene& s) {
                 plane(s).normal = {0, 0, 1 + 1e-5};
               }},
              {"normal.y", "is nan, must be finite", [&](Scene& s) { plane(s).normal.y() = kNan; }},
              {"normal.z", "is inf, must be finite", [&](Scene& s) { plane(s).normal.z() = kInf; }},
              {"offset", "is nan m", [&](Scene& s) { plane(s).offset = kNan; }},
              {"offset", "is 1e+30 m", [&](Scene& s) { plane(s).offset = 1e30; }},
              {"geometry", "is a plane on a body that can move",
               [](Scene& s) { s.bodies[0].motion = Motion::kinematic; }}});
  check_each(circle_scene(), place,
             {{"normal", "has length 0", [&](Scene& s) { half_plane(s).normal.setZero(); }},
              {"normal.x", "is nan", [&](Scene& s) { half_plane(s).normal.x() = kNan; }},
              {"offset", "is inf m", [&](Scene& s) { half_plane(s).offset = kInf; }},
              {"geometry", "is a half-plane on a body that can move",
               [](Scene& s) { s.bodies[0].motion = Motion::kinematic; }}});

  Scene nearly_unit = sphere_scene();
  plane(nearly_unit).normal = {0, 0, 1 + 5e-7};
  CHECK(validate(nearly_unit).empty());
  Scene falling_plane = sphere_scene();
  falling_plane.bodies[1].shapes[0].geometry = Plane{};
  CHECK(test::places(falling_plane) == std::vector<std::string>{std::string(kShape) + "geometry"});
}

TEST_CASE("shapes of the other dimension are refused", "[fast][scene]") {
  const auto set = [](const Geometry& g) {
    return [g](Scene& s) { s.bodies[1].shapes[0].geometry = g; };
  };
  check_each(sphere_scene(), kShape,
             {{"geometry", "is a circle, a spatial scene takes", set(Circle{})},
              {"geometry", "is a polygon, a spatial scene takes", set(Polygon::box(1, 1))}});
  check_each(circle_scene(), kShape,
             {{"geometry", "is a sphere, a planar scene takes", set(Sphere{})},
              {"geometry", "is a box, a planar scene takes", set(Box{})}});
  const auto ground = [](const Geometry& g) {
    return [g](Scene& s) { s.bodies[0].shapes[0].geometry = g; };
  };
  const char* const place = "body 0 'ground', shape 0: ";
  check_each(sphere_scene(), place, {{"geometry", "is a half-plane", ground(HalfPlane{})}});
  check_each(circle_scene(), place, {{"geometry", "is a plane", ground(Plane{})}});
}

TEST_CASE("shape poses, densities and materials are checked", "[fast][scene]") {
  const auto shape = [](Scene& s) -> Shape& { return s.bodies[1].shapes[0]; };
  const auto common = [&]() -> std::vector<BadInput> {
    return {
        {"position.x", "is nan m", [&](Scene& s) { shape(s).position.x() = kNan; }},
        {"position.y", "is 1e+09 m", [&](Scene& s) { shape(s).position.y() = 1e9; }},
        {"rotation", "must not be zero", [&](Scene& s) { shape(s).rotation.coeffs().setZero(); }},
        {"rotation.w", "is nan", [&](Scene& s) { shape(s).rotation.w() = kNan; }},
        {"density", "is 0 kg", [&](Scene& s) { shape(s).density = 0; }},
        {"density", "is -1 kg", [&](Scene& s) { shape(s).density = -1; }},
        {"density", "is nan kg", [&](Scene& s) { shape(s).density = kNan; }},
        {"density", "is inf kg", [&](Scene& s) { shape(s).density = kInf; }},
        {"material.friction", "is -0.1, must be >= 0",
         [&](Scene& s) { shape(s).material.friction = -0.1; }},
        {"material.friction", "is nan", [&](Scene& s) { shape(s).material.friction = kNan; }},
        {"material.friction", "is inf", [&](Scene& s) { shape(s).material.friction = kInf; }},
        {"material.restitution", "is 2, must be between 0 and 1",
         [&](Scene& s) { shape(s).material.restitution = 2; }},
        {"material.restitution", "is -0.5",
         [&](Scene& s) { shape(s).material.restitution = -0.5; }},
        {"material.restitution", "is nan",
         [&](Scene& s) { shape(s).material.restitution = kNan; }}};
  };
  check_each(sphere_scene(), kShape, common());
  check_each(circle_scene(), kShape, common());
  check_each(
      circle_scene(), kShape,
      {{"position.z", "is 1 m, must be 0 in a planar scene",
        [&](Scene& s) { shape(s).position.z() = 1; }},
       {"rotation", "must be about z", [&](Scene& s) { shape(s).rotation = Quat(0, 1, 0, 0); }}});

  Scene extreme = sphere_scene();
  shape(extreme).material = {1e9, 1};
  shape(extreme).rotation = Quat(0, 3, 0, -4);  // any length but zero
  CHECK(validate(extreme).empty());
}

}  // namespace manyworlds
