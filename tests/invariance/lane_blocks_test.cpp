// State in place (Batch::lane_blocks): it is what read() and write() see, where a body's own frame
// is the one that the kernels keep.
#include <catch2/catch.hpp>

#include <cstddef>
#include <span>
#include <vector>

#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Scene two_crates(Space space) {
  Scene scene = empty_scene(space, 0);
  for (const double x : {0.0, 5.0}) {
    Body body = body_of(shape_of(box_of(space, {0.3, 0.2, 0.1})), Vec3(x, 0, 0));
    // Given, the centre of mass is the body's origin to the last bit.
    body.mass_properties = MassProperties{};
    body.jitter = {.position = {1, 1, 0}, .linear_velocity = {1, 1, 0}, .angle = 1};
    scene.add(body);
  }
  return scene;
}

template <class Real>
std::vector<Real> gathered(Batch& batch, Field field) {
  const LaneBlocks at = batch.lane_blocks(field);
  std::vector<Real> out;
  for (int w = 0; w < batch.worlds(); ++w) {
    const auto group = static_cast<std::size_t>(batch.lane_index(w) / at.lanes);
    const auto lane = static_cast<std::size_t>(batch.lane_index(w) % at.lanes);
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.items); ++b) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(at.components); ++c) {
        out.push_back(
            static_cast<const Real*>(at.data)[group * at.group_stride + b * at.item_stride +
                                              c * at.component_stride + lane]);
      }
    }
  }
  return out;
}

template <class Real>
void check_fields(Batch& batch) {
  batch.step(3);
  for (const Field field : kFields) {
    CAPTURE(info(field).name);
    std::vector<Real> read(batch.size(field));
    batch.read(field, std::span<Real>(read));
    CHECK(gathered<Real>(batch, field) == read);
  }
}

}  // namespace

TEST_CASE("lane blocks hold what read() gives, in float32 and float64", "[batch][fast]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(two_crates(space));
    for (const Table& table : widest_tables()) {
      CAPTURE(name(table));
      Batch batch(plan, options_of(table, 11));
      table.precision == Precision::f32 ? check_fields<float>(batch) : check_fields<double>(batch);
    }
  }
}

TEST_CASE("what is written into lane blocks is read and stepped", "[batch][fast]") {
  Batch batch(compile(two_crates(Space::planar)), {.worlds = 3, .threads = 1});
  const LaneBlocks at = batch.lane_blocks(Field::linear_velocity);
  const int index = batch.lane_index(2);
  static_cast<float*>(at.data)[static_cast<std::size_t>(index / at.lanes) * at.group_stride +
                               at.item_stride + static_cast<std::size_t>(index % at.lanes)] = 6;
  std::vector<double> before(4), velocity(4), after(4);
  batch.read(Field::linear_velocity, 2, velocity);
  CHECK(velocity[2] == 6);
  batch.read(Field::position, 2, before);
  batch.step();
  batch.read(Field::position, 2, after);
  CHECK(after[2] - before[2] == Approx(0.1).epsilon(1e-4));
}

TEST_CASE("lane blocks follow the worlds that sleep packs together", "[batch][fast]") {
  Scene scene = two_crates(Space::spatial);
  scene.options.sleep.time = 0.1;
  Batch batch(compile(scene), {.worlds = 20, .threads = 1, .sleep = true});
  std::vector<double> rest(6, 0.0);
  for (int w = 0; w < 20; w += 2) {
    batch.write(Field::linear_velocity, w, rest);
    batch.write(Field::angular_velocity, w, rest);
  }
  batch.step(30);
  check_fields<float>(batch);
}

TEST_CASE("a plan without orientation has no lane blocks of it", "[batch][fast]") {
  Scene scene = empty_scene(Space::spatial, 10);
  scene.add(body_of(shape_of(Sphere{}), Vec3::Zero()));
  Batch batch(compile(scene), {.worlds = 2});
  CHECK(batch.lane_blocks(Field::orientation).data == nullptr);
  CHECK(batch.lane_blocks(Field::position).data != nullptr);
  CHECK_THROWS_WITH(batch.lane_blocks(Field::position, 1), "kind is 1, must be 0 to 0");
}

}  // namespace manyworlds::test
