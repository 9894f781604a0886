// What validate() says about triangle meshes: every issue at its place, in its exact words.
#include <catch2/catch.hpp>
#include <string>

#include "manyworlds/mesh.hpp"
#include "manyworlds/plan.hpp"
#include "tests/support/mass.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/scene_cases.hpp"

namespace manyworlds {
namespace {

using test::box_mesh;
using test::inside_out;
using test::moved;
using test::together;
using Lines = std::vector<std::string>;

using test::kInf;
using test::kNan;

Lines lines(const TriangleMesh& mesh) {
  Lines result;
  for (const Issue& issue : validate(mesh)) result.push_back(to_string(issue));
  return result;
}

const TriangleMesh kCube = box_mesh({1, 1, 1});

const std::string kOnce = " used once, must be used twice, in opposite directions (open)";
const std::string kSame =
    " used twice in one direction, must be used twice, in opposite directions (one of its "
    "triangles is wound the other way)";

}  // namespace

TEST_CASE("closed meshes have no issues", "[fast][scene]") {
  CHECK(lines(kCube) == Lines{});
  CHECK(lines(test::icosphere(1e-4, 3)) == Lines{});
  CHECK(lines(moved(test::torus_mesh(1, 0.4, 16, 8), {1e6, 1e6, 1e6})) == Lines{});
  CHECK(lines(together(kCube, inside_out(moved(kCube, {0, 0, 0}, Quat::Identity(), 0.5)))) ==
        Lines{});
  // Thin, but solid.
  CHECK(lines(moved(box_mesh({1, 1, 1e-9}), {1, 0, 0}, test::rotation_of(1, {1, 2, 3}))) ==
        Lines{});
  CHECK(lines(moved(box_mesh({1, 1e-6, 1e-6}), {1, 0, 0}, test::rotation_of(1, {1, 2, 3}))) ==
        Lines{});
}

TEST_CASE("indices out of range are named, and nothing that follows from them", "[fast][scene]") {
  TriangleMesh mesh = kCube;
  mesh.triangles[3][1] = 8;
  mesh.triangles[7][0] = -1;
  CHECK(lines(mesh) ==
        Lines{"triangles[3][1] is 8, must be >= 0 and < 8, the number of vertices",
              "triangles[7][0] is -1, must be >= 0 and < 8, the number of vertices"});
}

TEST_CASE("vertices that are not finite are named by component", "[fast][scene]") {
  TriangleMesh mesh = kCube;
  mesh.vertices[2].z() = 1e300;
  mesh.vertices[7] = {-kInf, kNan, 1};
  CHECK(lines(mesh) == Lines{"vertices[2].z is 1e+300 m, must be finite in float32 (up to 3.4e38)",
                             "vertices[7].x is -inf m, must be finite",
                             "vertices[7].y is nan m, must be finite"});
  // Whether a triangle uses it or not.
  mesh = kCube;
  mesh.vertices.emplace_back(0, 0, kInf);
  CHECK(lines(mesh) == Lines{"vertices[8].z is inf m, must be finite"});
}

TEST_CASE("a mesh without triangles is no solid", "[fast][scene]") {
  CHECK(lines({}) == Lines{"triangles are missing, must enclose a volume"});
  CHECK(lines({kCube.vertices, {}}) == Lines{"triangles are missing, must enclose a volume"});
}

TEST_CASE("triangles without an area are named", "[fast][scene]") {
  TriangleMesh mesh = kCube;
  mesh.triangles.push_back({5, 6, 5});
  mesh.triangles.push_back({3, 1, 1});
  mesh.triangles.push_back({4, 4, 4});
  CHECK(lines(mesh) ==
        Lines{"triangles[12] has vertex 5 more than once, must have three different ones",
              "triangles[13] has vertex 1 more than once, must have three different ones",
              "triangles[14] has vertex 4 more than once, must have three different ones"});

  // A vertex in the middle of edge 0-2, of which one neighbour knows: closed by a flat triangle.
  mesh = kCube;
  mesh.vertices.emplace_back(-1, 0, -1);
  REQUIRE(mesh.triangles[0] == std::array<int, 3>{0, 2, 3});
  mesh.triangles[0] = {0, 8, 3};
  mesh.triangles.push_back({8, 2, 3});
  mesh.triangles.push_back({0, 2, 8});
  CHECK(lines(mesh) ==
        Lines{"triangles[13] has an area of 0 m^2 and an edge of 2 m, must not be degenerate"});
}

TEST_CASE("edges of a hole are open", "[fast][scene]") {
  TriangleMesh mesh = kCube;
  REQUIRE(mesh.triangles.back() == std::array<int, 3>{1, 7, 5});
  mesh.triangles.pop_back();
  CHECK(lines(mesh) == Lines{"edge 1-5 is" + kOnce, "edge 1-7 is" + kOnce, "edge 5-7 is" + kOnce});
}

TEST_CASE("edges of a triangle that is wound the other way run twice in one direction",
          "[fast][scene]") {
  TriangleMesh mesh = kCube;
  std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
  CHECK(lines(mesh) == Lines{"edge 1-5 is" + kSame, "edge 1-7 is" + kSame, "edge 5-7 is" + kSame});
}

TEST_CASE("edges with more than two triangles are not a manifold", "[fast][scene]") {
  TriangleMesh mesh = kCube;
  mesh.vertices.emplace_back(5, 5, 5);
  mesh.triangles.push_back({0, 1, 8});
  CHECK(lines(mesh) == Lines{"edge 0-1 is used 3 times, must be used twice, in opposite directions "
                             "(not a manifold)",
                             "edge 0-8 is" + kOnce, "edge 1-8 is" + kOnce});
  // The same triangles twice.
  mesh = kCube;
  mesh.triangles.insert(mesh.triangles.end(), kCube.triangles.begin(), kCube.triangles.end());
  CHECK(lines(mesh).size() == 11);  // of 18 edges
  CHECK(lines(mesh).back() ==
        "8 more edges are used more than twice, must be used twice, in opposite directions (not a "
        "manifold)");
}

TEST_CASE("a mesh that is inside out or flat encloses nothing", "[fast][scene]") {
  CHECK(lines(inside_out(kCube)) ==
        Lines{"volume is -8 m^3, must be > 0 (the triangles run clockwise seen from outside)"});
  // A cavity larger than what is around it.
  CHECK(lines(together(box_mesh({0.5, 0.5, 0.5}), inside_out(kCube))) ==
        Lines{"volume is -7 m^3, must be > 0 (the triangles run clockwise seen from outside)"});
  // A square of two sides with different diagonals, in any direction.
  const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                           {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  for (int i = 0; i < 20; ++i) {
    CHECK(lines(moved(sheet, {0.1 * i, 0, 3}, test::rotation_of(i, {1, 2, 0.3 * i}))) ==
          Lines{"volume is 0 m^3 up to rounding, must be > 0"});
  }
}

TEST_CASE("of ten thousand issues of one kind the first ten are listed", "[fast][scene]") {
  // Triangles that share no vertices, as many files have them.
  TriangleMesh soup;
  for (int i = 0; i < 4000; ++i) {
    for (const Vec3& corner : {Vec3(0, 0, i), Vec3(1, 0, i), Vec3(0, 1, i)}) {
      soup.vertices.push_back(corner);
    }
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  Lines got = lines(soup);
  REQUIRE(got.size() == 11);
  CHECK(got[0] == "edge 0-1 is" + kOnce);
  CHECK(got[9] == "edge 9-10 is" + kOnce);
  CHECK(got[10] == "11990 more edges are" + kOnce);

  TriangleMesh mesh = kCube;
  mesh.vertices.resize(20, Vec3(kNan, kNan, 0));
  got = lines(mesh);
  REQUIRE(got.size() == 21);
  CHECK(got[19] == "vertices[17].y is nan m, must be finite");
  CHECK(got[20] == "2 more vertices are not finite, must be finite");

  mesh = kCube;
  mesh.triangles.resize(17, {0, 1, 99});
  got = lines(mesh);
  CHECK(got.size() == 5);
  for (int i = 0; i < 7; ++i) mesh.triangles.push_back({0, 1, 99});
  got = lines(mesh);
  REQUIRE(got.size() == 11);
  CHECK(got[10] == "2 more indices are out of range, must be >= 0 and < 8, the number of vertices");

  mesh = kCube;
  mesh.triangles.resize(12 + 12, {1, 1, 2});
  got = lines(mesh);
  REQUIRE(got.size() == 11);
  CHECK(got[10] == "2 more triangles have a vertex more than once, must have three different ones");

  // All in one place: without area, and open.
  for (Vec3& vertex : soup.vertices) vertex = {1, 2, 3};
  got = lines(soup);
  REQUIRE(got.size() == 22);
  CHECK(got[0] == "triangles[0] has an area of 0 m^2 and an edge of 0 m, must not be degenerate");
  CHECK(got[10] == "3990 more triangles have no area, must not be degenerate");
  CHECK(got[21] == "11990 more edges are" + kOnce);

  // One sheet of a double one wound the other way.
  TriangleMesh flipped = test::icosphere(1, 1);
  for (std::size_t i = 0; i < flipped.triangles.size(); i += 4) {
    // The outer three of each four triangles.
    for (std::size_t j = i; j < i + 3; ++j) {
      std::swap(flipped.triangles[j][0], flipped.triangles[j][1]);
    }
  }
  got = lines(flipped);
  REQUIRE(got.size() == 11);
  CHECK(got[10] == "50 more edges are" + kSame);
}

TEST_CASE("issues of different kinds are listed together", "[fast][scene]") {
  TriangleMesh mesh = kCube;
  mesh.vertices[7].x() = kNan;
  mesh.triangles.pop_back();
  mesh.triangles.push_back({2, 2, 6});
  CHECK(lines(mesh) ==
        Lines{"vertices[7].x is nan m, must be finite",
              "triangles[11] has vertex 2 more than once, must have three different ones",
              "edge 1-5 is" + kOnce, "edge 1-7 is" + kOnce, "edge 5-7 is" + kOnce});
}

TEST_CASE("bad meshes and densities throw with all their issues", "[fast][scene]") {
  CHECK_THROWS_WITH(volume(inside_out(kCube)),
                    "the mesh has 1 issue:\n  volume is -8 m^3, must be > 0 (the triangles run "
                    "clockwise seen from outside)");
  CHECK_THROWS_AS(volume(TriangleMesh{}), SceneError);
  for (const auto& [density, message] :
       {std::pair{0.0, "is 0 kg/m^3, must be > 0"}, std::pair{-2.5, "is -2.5 kg/m^3, must be > 0"},
        std::pair{kNan, "is nan kg/m^3, must be > 0"},
        std::pair{kInf, "is inf kg/m^3, must be between 1e-30 and 1e+30"}}) {
    CHECK_THROWS_WITH(mass_properties(kCube, density),
                      std::string("the mesh has 1 issue:\n  density ") + message);
  }
  try {
    mass_properties(TriangleMesh{}, -1);
    FAIL("nothing was thrown");
  } catch (const SceneError& error) {
    CHECK(error.issues().size() == 2);
    CHECK(std::string(error.what()) ==
          "the mesh has 2 issues:\n  triangles are missing, must enclose a volume\n"
          "  density is -1 kg/m^3, must be > 0");
  }
}

}  // namespace manyworlds
