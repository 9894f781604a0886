// The same scene in other units, its times and masses by the laws of similarity: lengths by s,
// times by sqrt(s), speeds by sqrt(s). Nothing of the contact model has a length or a time of its
// own, so it does so bit for bit.
#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Powers of 4: those of lengths, times and masses are powers of 2, and round nothing.
constexpr double kScales[] = {1.0 / 1024, 1.0 / 16, 1024};

// Boxes and balls that fall on each other, and a column.
Scene pile(Space space, double s) {
  Scene scene = empty_scene(space);
  scene.options.dt = std::sqrt(s) / 60, scene.options.sleep.time *= std::sqrt(s);
  scene.add(ground(space, 0.5));
  const Vec3 up = up_of(space);
  const auto add = [&](const Geometry& geometry, double x, double height) {
    Body body = body_of(shape_of(geometry, 0.5, 0.3), s * (x * Vec3::UnitX() + height * up));
    scene.add(body);
  };
  for (int i = 0; i < 4; ++i) add(cube_of(space, 0.25 * s), 0, 0.26 + 0.51 * i);
  for (int i = 0; i < 3; ++i) add(cube_of(space, 0.2 * s), 2 + 0.1 * i, 0.5 + 0.6 * i);
  for (int i = 0; i < 3; ++i) add(round_of(space, 0.15 * s), 3.5 + 0.05 * i, 0.5 + 0.5 * i);
  Hull wedge{
      {{-0.2, -0.2, -0.1}, {0.2, -0.2, -0.1}, {0.2, 0.2, -0.1}, {-0.2, 0.2, -0.1}, {0, 0, 0.2}}};
  Polygon triangle{{{-0.2, -0.1}, {0.2, -0.1}, {0, 0.2}}};
  for (Vec3& v : wedge.vertices) v *= s;
  for (Vec2& v : triangle.vertices) v *= s;
  const bool planar = space == Space::planar;
  for (int i = 0; i < 2; ++i) {
    add(Capsule{0.2 * s, 0.1 * s}, 5, 0.5 + 1.2 * i);
    add(planar ? Geometry(triangle) : Geometry(wedge), 5.1, 0.9 + 1.2 * i);
    add(planar ? cube_of(space, 0.2 * s) : Geometry(Cylinder{0.15 * s, 0.2 * s}), 4.9,
        1.3 + 1.2 * i);
  }
  return scene;
}

std::vector<double> after(const Table& table, Space space, double s, int steps) {
  Batch batch(compile(pile(space, s)), options_of(table));
  batch.step(steps);
  std::vector<double> out;
  for (int b = 0; b < batch.bodies(); ++b) {
    for (const double x : position(batch, 0, b)) out.push_back(x / s);
    for (const double v : velocity(batch, 0, b)) out.push_back(v / std::sqrt(s));
  }
  return out;
}

}  // namespace

TEST_CASE("a scene does the same in millimetres, metres and kilometres", "[fast][similarity]") {
  constexpr int kSteps = 90;
  for (const Table& table : widest_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      const std::vector<double> metres = after(table, space, 1, kSteps);
      for (const double s : kScales) {
        INFO(name(table) << (space == Space::planar ? " 2D " : " 3D ") << s);
        CHECK(after(table, space, s, kSteps) == metres);
      }
    }
  }
}

TEST_CASE("a plan chooses as many substeps in other units", "[fast][similarity][plan]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Options metres = compile(pile(space, 1)).resolved();
    for (const double s : {1e-3, 0.03, 1e3, 1.0 / 1024}) {
      const Options here = compile(pile(space, s)).resolved();
      CHECK(*here.substeps == *metres.substeps);
      CHECK(*here.length_unit == Approx(s * *metres.length_unit));
      CHECK(*here.contact.slop == Approx(s * *metres.contact.slop));
      CHECK(*here.contact.push_out_speed == Approx(std::sqrt(s) * *metres.contact.push_out_speed));
      CHECK(*here.sleep.speed == Approx(std::sqrt(s) * *metres.sleep.speed));
      CHECK(*here.contact.frequency == Approx(*metres.contact.frequency / std::sqrt(s)));
    }
  }
}

}  // namespace manyworlds::test
