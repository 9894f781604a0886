// Arches and towers of planks at default settings: the plan's static estimate gives arches the
// stiffness that they need, and impulses are carried over when the reference face of a contact
// changes.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/arch.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

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
