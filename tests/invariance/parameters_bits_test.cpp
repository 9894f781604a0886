// Numbers of the scene that differ from world to world: bits, snapshots, copies.
#include <catch2/catch.hpp>

#include "tests/support/hashes.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

// The scene with the numbers of one world of a batch written into it.
Scene scene_of(const Batch& batch, int world) {
  Scene scene = batch.plan(0).scene();
  scene.variations.clear();
  const auto all = [&](Parameter p) { return numbers(batch, p, world); };
  const auto size = all(Parameter::size), density = all(Parameter::density),
             friction = all(Parameter::friction), restitution = all(Parameter::restitution),
             rolling = all(Parameter::rolling_resistance),
             torsional = all(Parameter::torsional_resistance), mass = all(Parameter::mass),
             scale = all(Parameter::gravity_scale), linear = all(Parameter::linear_drag),
             angular = all(Parameter::angular_drag), gravity = all(Parameter::gravity);
  scene.options.gravity = Vec3(gravity[0], gravity[1], gravity[2]);
  std::size_t shape = 0, state_body = 0;
  for (Body& body : scene.bodies) {
    for (Shape& s : body.shapes) {
      const double* extent = &size[3 * shape];
      if (auto* round = std::get_if<Sphere>(&s.geometry)) round->radius = extent[0];
      if (auto* round = std::get_if<Circle>(&s.geometry)) round->radius = extent[0];
      if (auto* box = std::get_if<Box>(&s.geometry)) {
        box->half_extents = Vec3(extent[0], extent[1], extent[2]);
      }
      if (auto* capsule = std::get_if<Capsule>(&s.geometry)) *capsule = {extent[0], extent[1]};
      if (auto* cylinder = std::get_if<Cylinder>(&s.geometry)) *cylinder = {extent[0], extent[1]};
      if (auto* hull = std::get_if<Hull>(&s.geometry)) {
        Vec3 low = hull->vertices[0], high = low;
        for (const Vec3& v : hull->vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
        for (Vec3& v : hull->vertices) {
          for (int c = 0; c < 3; ++c) v[c] *= extent[c] / ((high[c] - low[c]) / 2);
        }
      }
      if (auto* polygon = std::get_if<Polygon>(&s.geometry)) {
        Vec2 low(1e9, 1e9), high(-1e9, -1e9);
        for (const Vec2& v : polygon->vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
        for (Vec2& v : polygon->vertices) {
          for (int c = 0; c < 2; ++c) v[c] *= extent[c] / ((high[c] - low[c]) / 2);
        }
      }
      s.density = density[shape];
      s.material = {friction[shape], restitution[shape], rolling[shape],
                    torsional.empty() ? 0 : torsional[shape]};
      ++shape;
    }
    if (body.motion == Motion::fixed) continue;
    body.gravity_scale = scale[state_body];
    body.linear_drag = linear[state_body], body.angular_drag = angular[state_body];
    const MassProperties own = mass_properties(scene, body);
    // Only of those whose mass is drawn, and not what their sizes and densities make.
    if (own.mass != mass[state_body]) {
      body.mass_properties = own;
      body.mass_properties->inertia *= mass[state_body] / own.mass;
      body.mass_properties->mass = mass[state_body];
    }
    ++state_body;
  }
  return scene;
}

}  // namespace

TEST_CASE("a world with numbers of its own is one of the scene that has them, bit for bit",
          "[fast][parameters][bits][one_thread]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (bool polygons : {false, true}) {
      const auto same_energy = [](const Batch& batch, int w, const Batch& alone) {
        CHECK(batch.status(w) == Status::ok);
        const Energy e = batch.energy(w), f = alone.energy(0);
        CHECK(e.kinetic == f.kinetic);
        CHECK(e.potential == f.potential);
      };
      check_worlds_are_those_of_scenes(varied_crowd(space, polygons), polygons ? "polygons" : "",
                                       11, 60, scene_of, same_energy);
    }
  }
}

TEST_CASE("bits do not depend on instruction set, batch, threads, layout or sleep's packing",
          "[fast][parameters][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = varied_crowd(space);
    scene.options.sleep.time = 0.1;
    scene.options.sleep.speed = 1;
    for (Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<std::uint64_t> expected[2];
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        for (bool sleep : {false, true}) {
          for (int threads : {1, 3}) {
            BatchOptions options = options_of(table, 21, threads);
            options.sleep = sleep;
            options.layout = threads == 1 ? ContactLayout::dense : ContactLayout::rows;
            Batch batch(compile(scene), options);
            for (int i = 0; i < 25; ++i) {
              batch.step(4);
              if (i == 12) batch.add_impulse(3, batch.body_in_row(1), Vec3(100, 0, 0));
            }
            const auto worlds = hashes(batch);
            if (expected[sleep].empty()) expected[sleep] = worlds;
            INFO(name(table) << " sleep " << sleep << " threads " << threads);
            CHECK(worlds == expected[sleep]);
          }
        }
      }
    }
  }
}

TEST_CASE("snapshots and copies take a world's numbers along", "[fast][parameters][snapshot]") {
  Scene scene = varied_crowd(Space::spatial);
  const Plan plan = compile(scene);
  Batch batch(plan, {.worlds = 12, .threads = 1, .seed = 1});
  batch.step(20);
  const Snapshot saved = batch.save();
  batch.step(20);
  const auto expected = state(batch, 4);

  Batch other(plan, {.worlds = 5, .threads = 1, .seed = 77, .isa = Isa::scalar});
  other.restore(saved, 4, 2);
  CHECK(numbers(other, Parameter::mass, 2) == numbers(batch, Parameter::mass, 4));
  other.copy_world(2, 0);
  CHECK(numbers(other, Parameter::size, 0) == numbers(batch, Parameter::size, 4));
  other.step(20);
  CHECK(state(other, 2) == expected);
  CHECK(state(other, 0) == expected);
  CHECK(state(other, 1) != expected);

  // What this scene lets vary otherwise is another plan.
  scene.variations[2].high.x() = 0.95;
  Batch foreign(compile(scene), {.worlds = 12, .threads = 1});
  CHECK_THROWS_AS(foreign.restore(saved), SnapshotError);
}

// Whether a body is cast against planes follows from its own size.
TEST_CASE("worlds with sizes of their own cast as scenes with these sizes", "[fast][parameters]") {
  Scene scene = empty_scene(Space::spatial, 10);
  scene.add(ground(Space::spatial));
  Body plate = body_of(shape_of(Box{Vec3(0.1, 0.1, 0.1)}), Vec3(0, 0, 0.12));
  plate.angular_velocity = Vec3(40, 10, 0), plate.linear_velocity = Vec3(0, 0, -3);
  scene.add(plate);
  scene.variations = {vary_three(Parameter::size, Vec3(0.1, 0.1, 0.005), Vec3(0.1, 0.1, 0.1))};
  scene.variations[0].shape = ShapeId(BodyId(1), 0);
  check_worlds_are_those_of_scenes(scene, "", 9, 30);
}

}  // namespace manyworlds::test
