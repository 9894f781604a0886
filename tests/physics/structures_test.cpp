// Arches and towers of planks at default settings: the plan's static estimate gives arches the
// stiffness that they need, and impulses are carried over when the reference face of a contact
// changes.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Half a ring of voussoirs with 1 m inside, on the ground.
Scene arch(Space space, int count, double thick) {
  Scene scene = empty_scene(space);
  scene.add(ground(space, 1));
  const auto on = [](double radius, double angle) {
    return Vec2(radius * Vec2(std::cos(angle), std::sin(angle)));
  };
  for (int i = 0; i < count; ++i) {
    const double from = kPi * i / count, to = kPi * (i + 1) / count;
    const Vec2 outline[] = {on(1, from), on(1 + thick, from), on(1 + thick, to), on(1, to)};
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : outline) middle += p / 4;
    Polygon polygon;
    Hull hull;
    for (const Vec2& p : outline) {
      const Vec2 q = p - middle;
      polygon.vertices.push_back(q);
      for (const double side : {-0.2, 0.2}) hull.vertices.push_back({q.x(), side, q.y()});
    }
    const bool planar = space == Space::planar;
    const Geometry geometry = planar ? Geometry(polygon) : Geometry(hull);
    const Vec3 at = planar ? Vec3(middle.x(), middle.y(), 0) : Vec3(middle.x(), 0, middle.y());
    scene.add(body_of(shape_of(geometry, 1), at));
  }
  return scene;
}

// Layers of two planks, each across the one below; planar: a lintel on posts, twice.
Scene planks(Space space) {
  Scene scene = empty_scene(space);
  scene.add(ground(space, 0.5));
  if (space == Space::planar) {
    double height = 0;
    for (int storey = 0; storey < 2; ++storey) {
      for (const double x : {-0.8, 0.8}) {
        scene.add(body_of(shape_of(Polygon::box(0.2, 0.2), 0.5), Vec3(x, height + 0.2, 0)));
      }
      scene.add(body_of(shape_of(Polygon::box(1, 0.05), 0.5), Vec3(0, height + 0.45, 0)));
      height += 0.5;
    }
    return scene;
  }
  for (int layer = 0; layer < 6; ++layer) {
    const Quat turn(Eigen::AngleAxisd(layer % 2 == 0 ? 0 : kPi / 2, Vec3::UnitZ()));
    for (const double aside : {-0.3, 0.3}) {
      Body plank = body_of(shape_of(Box{{0.5, 0.15, 0.05}}, 0.5),
                           turn * Vec3(0, aside, 0) + Vec3(0, 0, 0.1 * layer + 0.05));
      plank.rotation = turn;
      scene.add(plank);
    }
  }
  return scene;
}

// m, the farthest motion of a body's centre in 20 s.
double moved(const Scene& scene, const Table& table) {
  Batch batch(compile(scene), options_of(table));
  batch.step(1200);
  double out = 0;
  for (int i = 0; i < batch.bodies(0); ++i) {
    const Vec3 start = scene.bodies[static_cast<std::size_t>(in_row(batch, 0, i).index())].position;
    out = std::max(out, (position(batch, 0, i) - start).norm());
  }
  CHECK(batch.status(0) == Status::ok);
  return out;
}

}  // namespace

TEST_CASE("arches of voussoirs stand at default settings", "[slow][stability]") {
  for (Space space : kSpaces) {
    for (const int count : {5, 11, 13}) {
      for (const Table& table : widest_tables()) {
        INFO(name(table) << ' ' << count << (space == Space::planar ? " planar" : " spatial"));
        // Each joint may close by the slop, 1 mm here.
        CHECK(moved(arch(space, count, 0.3), table) < 0.01);
      }
    }
  }
}

TEST_CASE("planks across each other and on posts stay", "[slow][stability]") {
  for (Space space : kSpaces) {
    for (const Table& table : widest_tables()) {
      INFO(name(table) << (space == Space::planar ? " planar" : " spatial"));
      CHECK(moved(planks(space), table) < 0.01);
    }
  }
}

}  // namespace manyworlds::test
