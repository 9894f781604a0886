// Bodies that come and go at run time.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// The first `bodies` state bodies of every field of bodies of a world.
std::vector<double> head_of(const Batch& batch, int world, int bodies) {
  std::vector<double> all;
  for (int f = 0; f < kFieldCount; ++f) {
    const Field field = static_cast<Field>(f);
    if (info(field).item != ItemKind::body) continue;
    const auto v = values(batch, field, world);
    const auto n = static_cast<std::ptrdiff_t>(components(field, space_of(batch)) * bodies);
    all.insert(all.end(), v.begin(), v.begin() + n);
  }
  return all;
}

}  // namespace

TEST_CASE("a disabled body leaves no trace in the others' bits", "[fast][enable][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene without = empty_scene(space);
    without.add(ground(space));
    for (int i = 0; i < 2; ++i) {
      Body box = body_of(shape_of(cube_of(space, 0.5)), (0.6 + 1.1 * i) * up_of(space));
      box.jitter.position = Vec3(0.3, 0, 0);
      box.jitter.angle = 0.3;
      without.add(box);
    }
    Scene with = without;
    // In the way of both, if it were there.
    Body third = body_of(shape_of(cube_of(space, 0.5)), up_of(space));
    third.enabled = false;
    with.add(third);
    for (const Table& table : all_tables()) {
      for (ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
        BatchOptions options = options_of(table, 11);
        options.layout = layout;
        Batch a(compile(without), options), b(compile(with), options);
        // In some lanes it is there for a while, at another place, without touching anything.
        for (int w = 1; w < 11; w += 3)
          b.spawn(w, b.body_in_row(2), {Vec3(50, 0, 0) + 0.5 * up_of(space)});
        a.step(30);
        b.step(30);
        for (int w = 1; w < 11; w += 3) b.set_enabled(w, b.body_in_row(2), false);
        a.step(30);
        b.step(30);
        for (int w = 0; w < 11; ++w) {
          INFO(name(table) << " world " << w);
          CHECK(head_of(a, w, 2) == head_of(b, w, 2));
          CHECK_FALSE(b.enabled(w, b.body_in_row(2)));
          CHECK(b.status(w) == Status::ok);
          CHECK(b.contacts(w).size() == a.contacts(w).size());
          CHECK(b.energy(w).kinetic == a.energy(w).kinetic);
        }
      }
    }
  }
}

TEST_CASE("disabled bodies stay put, in plans without contacts too", "[fast][enable]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (bool contacts : {false, true}) {
      Scene scene = empty_scene(space);
      if (contacts) scene.add(ground(space));
      for (int i = 0; i < 6; ++i) {
        Body body = body_of(shape_of(cube_of(space, 0.5)), Vec3(2 * i, 0, 0) + 5 * up_of(space));
        body.shapes[0].filter.mask = contacts ? 0xffffffffu : 0;
        body.angular_velocity = Vec3(0, 0, 1);
        scene.add(body);
      }
      for (const Table& table : all_tables()) {
        INFO(name(table) << " contacts " << contacts);
        Batch batch(compile(scene), options_of(table, 5)),
            all(compile(scene), options_of(table, 5));
        batch.set_enabled(2, batch.body_in_row(3), false);
        batch.step(20);
        all.step(20);
        CHECK(position(batch, 2, 3).dot(up_of(space)) == 5);
        CHECK(spin(batch, 2, 3) == Vec3(0, 0, 1));
        for (int w = 0; w < 5; ++w)
          for (int b = 0; b < 6; ++b)
            if (w != 2 || b != 3) CHECK(position(batch, w, b) == position(all, w, b));
        batch.set_enabled(2, batch.body_in_row(3), true);
        batch.step();
        CHECK(position(batch, 2, 3).dot(up_of(space)) < 5);
      }
    }
  }
}

TEST_CASE("a body is spawned where and how it was asked for", "[fast][enable]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    // Off its centre of mass and turned, so that the kernels' frame is another.
    Shape shape = shape_of(box_of(space, Vec3(0.5, 0.2, 0.1)));
    shape.position = Vec3(0.3, 0.1, 0);
    shape.rotation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
    Body body = body_of(shape, Vec3::Zero());
    body.enabled = false;
    scene.add(body);
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table, 3));
      CHECK_FALSE(batch.enabled(1, batch.body_in_row(0)));
      BodyState state;
      state.position = Vec3(1, 2, space == Space::planar ? 0 : 3);
      state.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
      state.linear_velocity = Vec3(0.1, 0.2, 0);
      state.angular_velocity = Vec3(0, 0, 0.5);
      batch.spawn(1, batch.body_in_row(0), state);
      const double slack = pick(table, 1e-6, 1e-14);
      CHECK(batch.enabled(1, batch.body_in_row(0)));
      CHECK_FALSE(batch.enabled(0, batch.body_in_row(0)));
      CHECK((position(batch, 1, 0) - state.position).norm() < slack);
      CHECK(rotation(batch, 1, 0).angularDistance(state.rotation) < 1e-3 * std::sqrt(slack));
      CHECK((velocity(batch, 1, 0) - state.linear_velocity).norm() < slack);
      CHECK((spin(batch, 1, 0) - state.angular_velocity).norm() < slack);
      batch.reset();
      CHECK_FALSE(batch.enabled(1, batch.body_in_row(0)));  // as the scene says
      state.rotation = Quat(0, 0, 0, 0);
      CHECK_THROWS_WITH(batch.spawn(1, batch.body_in_row(0), state),
                        Catch::Contains("rotation has length 0"));
      CHECK_THROWS_WITH(batch.set_enabled(1, BodyId(9), true),
                        Catch::Contains("body is 9, must be 0 to 0"));
    }
  }
}

TEST_CASE("disabling a body leaves other stacks on the same kinematic body alone",
          "[fast][enable]") {
  Scene scene = empty_scene(Space::spatial);
  scene.add(body_of(shape_of(box_of(Space::spatial, Vec3(10, 5, 0.5))), Vec3(0, 0, -0.5),
                    Motion::kinematic));
  for (double x : {-5.0, 5.0})
    for (int i = 0; i < 2; ++i)
      scene.add(body_of(shape_of(cube_of(Space::spatial, 0.5)), Vec3(x, 0, 0.5 + i)));
  const auto carried = [](const Batch& batch) {
    std::vector<double> all;
    for (const Contact& c : batch.contacts(0))
      if (c.body_b.index() >= 3) all.push_back(c.normal_impulse);
    return all;
  };
  for (const Table& table : widest_tables()) {
    for (bool sleep : {false, true}) {
      BatchOptions options = options_of(table);
      options.sleep = sleep;
      Batch batch(compile(scene), options);
      batch.step(120);
      const std::vector<double> before = carried(batch);
      CHECK(*std::max_element(before.begin(), before.end()) > 0);
      batch.set_enabled(0, batch.body_in_row(2), false);
      CHECK(carried(batch) == before);
    }
  }
}

TEST_CASE("forces on kinematic bodies are ignored, whatever they are", "[fast][enable]") {
  Scene scene = empty_scene(Space::spatial);
  scene.add(body_of(shape_of(Sphere{0.5}), Vec3(0, 0, 5)));
  scene.add(body_of(shape_of(Sphere{0.5}), Vec3(9, 0, 5), Motion::kinematic));
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.add_force(0, batch.body_in_row(1), Vec3(std::nan(""), 0, 0));
    batch.step();
    CHECK(batch.status(0) == Status::ok);
    // A reset world has no forces left from before.
    batch.add_force(0, batch.body_in_row(0), Vec3(std::nan(""), 0, 0));
    const std::vector<std::uint8_t> mask = {1};
    batch.reset(mask);
    batch.step();
    CHECK(batch.status(0) == Status::ok);
  }
}

// B12: what carried a heavy load does not jump when the load is gone.
TEST_CASE("taking a heavy load away makes nothing jump", "[fast][enable][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    // A load of a hundred times the mass of what carries it wants stiffer contacts: the depth at
    // rest is what comes back out when it is gone.
    scene.options.substeps = 8;
    scene.options.contact.frequency = 120;
    scene.add(ground(space));
    for (int i = 0; i < 3; ++i) {
      Body ball = body_of(shape_of(round_of(space, 0.5)), (0.5 + 1.0 * i) * up_of(space));
      if (i == 2) ball.shapes[0].density = 100 * scene.options.density;
      scene.add(ball);
    }
    for (const Table& table : widest_tables()) {
      for (bool sleep : {false, true}) {
        BatchOptions options = options_of(table);
        options.sleep = sleep;
        Batch batch(compile(scene), options);
        batch.step(120);
        const double load = mass_properties(scene, scene.bodies[3]).mass * 10;
        batch.set_enabled(0, batch.body_in_row(2), false);
        double highest = 0, energy = 0;
        for (int i = 0; i < 60; ++i) {
          batch.step();
          for (int b = 0; b < 2; ++b)  // above where they touch without a load
            highest = std::max(highest, position(batch, 0, b).dot(up_of(space)) - (0.5 + b));
          energy = std::max(energy, batch.energy(0).kinetic);
          if (i >= 2) CHECK(max_speed(batch, 0) < 0.05);
        }
        INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " sleep " << sleep
                         << " jump " << highest << " energy " << energy);
        CHECK(highest < 0.005);
        CHECK(energy < 0.01 * load * 2.5);
      }
    }
  }
}

}  // namespace manyworlds::test
