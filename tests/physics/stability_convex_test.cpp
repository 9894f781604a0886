// Cylinders and hulls at rest, rolling and stacked.
#include <catch2/catch.hpp>

#include <cmath>

#include "manyworlds/hull.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Hull cube_hull(double half) {
  Hull hull;
  for (int i = 0; i < 8; ++i)
    hull.vertices.emplace_back(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
  return hull;
}

Scene stack_of(const Geometry& geometry, int count, double height, double turn) {
  Scene scene = empty_scene(Space::spatial);
  scene.add(ground(Space::spatial));
  for (int i = 0; i < count; ++i) {
    Body body = body_of(shape_of(geometry), Vec3(0, 0, (i + 0.5) * height));
    body.jitter.position = Vec3(1e-3, 1e-3, 0);
    body.jitter.angle = turn;
    scene.add(body);
  }
  return scene;
}

void check_stack(const Scene& scene, int count, double height, int steps, double sag, double lean) {
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table, 8));
    batch.step(steps);
    for (int w = 0; w < batch.worlds(); ++w) {
      const Vec3 top = position(batch, w, count - 1);
      INFO(name(table) << " world " << w << " top " << top.transpose() << " speed "
                       << max_speed(batch, w));
      CHECK(batch.status(w) == Status::ok);
      CHECK(top.z() == approx((count - 0.5) * height, sag));
      CHECK(top.head<2>().norm() < lean);
      CHECK(max_speed(batch, w) < 0.05);
    }
  }
}

// Turns a cylinder's axis to x.
Quat lying() { return Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY())); }

}  // namespace

TEST_CASE("a cylinder stands on its flat face", "[fast][collide]") {
  for (const Geometry& below : {Geometry(Plane{}), Geometry(Box{{2, 2, 1}}),
                                Geometry(Cylinder{2, 1}), Geometry(cube_hull(1))}) {
    const double top = std::holds_alternative<Plane>(below) ? 0 : 1;
    Scene scene = empty_scene(Space::spatial);
    scene.add(body_of(shape_of(below), Vec3::Zero(), Motion::fixed));
    scene.add(body_of(shape_of(Cylinder{0.3, 0.5}), Vec3(0.1, 0, top + 0.5)));
    scene.bodies[1].jitter.angle = 1;
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 4));
      batch.step(240);
      for (int w = 0; w < 4; ++w) {
        INFO("below " << below.index() << ' ' << name(table) << " x "
                      << position(batch, w, 0).transpose());
        CHECK(batch.contacts(w).size() >= 3);
        CHECK(std::abs(position(batch, w, 0).z() - top - 0.5) < 2e-3);
        CHECK(max_speed(batch, w) < 1e-3);
        CHECK(spin(batch, w, 0).norm() < 2e-3);
      }
    }
  }
}

TEST_CASE("a cylinder rolls on its side", "[fast][collide]") {
  for (const Geometry& below : {Geometry(Plane{}), Geometry(Box{{3, 3, 1}})}) {
    const double top = std::holds_alternative<Plane>(below) ? 0 : 1;
    Scene scene = empty_scene(Space::spatial);
    scene.add(body_of(shape_of(below), Vec3::Zero(), Motion::fixed));
    scene.add(body_of(shape_of(Cylinder{0.2, 0.5}), Vec3(0, -1, top + 0.2)));
    scene.bodies[1].rotation = lying();
    scene.bodies[1].linear_velocity = Vec3(0, 1, 0);
    scene.bodies[1].angular_velocity = Vec3(-5, 0, 0);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      for (int i = 0; i < 120; ++i) {
        batch.step();
        CHECK(batch.contacts(0).size() == 2);
      }
      INFO("below " << below.index() << ' ' << name(table) << " v "
                    << velocity(batch, 0, 0).transpose());
      CHECK(velocity(batch, 0, 0).y() == Approx(1).epsilon(2e-3));
      CHECK(position(batch, 0, 0).y() == Approx(1).epsilon(5e-3));
      CHECK(std::abs(position(batch, 0, 0).z() - top - 0.2) < 2e-3);
    }
  }
}

TEST_CASE("five stacked cylinders stand for 20 s", "[slow][stability]") {
  check_stack(stack_of(Cylinder{0.5, 0.5}, 5, 1, 1), 5, 1, 1200, 0.02, 0.05);
}

TEST_CASE("ten stacked cubes that are hulls stand as boxes do", "[slow][stability]") {
  check_stack(stack_of(cube_hull(0.5), 10, 1, 0), 10, 1, 1200, 0.01, 5e-3);
}

TEST_CASE("a fixed hull stands among fixed shapes of other kinds", "[fast][collide]") {
  for (const Table& table : widest_tables()) {
    for (const ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
      Scene scene = empty_scene(Space::spatial);
      for (int i = 0; i < 6; ++i) {  // whose numbers would be absurd as those of a hull
        scene.add(body_of(shape_of(Sphere{1}), {1e6, 100.0 + i, 1e6}, Motion::fixed));
      }
      Hull block;
      for (int i = 0; i < 8; ++i) {
        block.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 0.5 : -0.5);
      }
      scene.add(body_of(shape_of(block), Vec3::Zero(), Motion::fixed));
      scene.add(body_of(shape_of(Box{{0.2, 0.2, 0.2}}), {0.3, 0.1, 0.75}));
      scene.add(body_of(shape_of(Cylinder{0.2, 0.2}), {-0.4, 0.1, 0.75}));
      scene.bodies.back().jitter.position.x() = 3;  // in some worlds beside the block
      BatchOptions options = options_of(table, 16);
      options.layout = layout;
      Batch batch(compile(scene), options);
      batch.step(60);
      INFO(name(table));
      for (int w = 0; w < 16; ++w) {
        CHECK(position(batch, w, 0).z() == approx(0.7, 5e-3));
        CHECK(std::isfinite(position(batch, w, 1).z()));
      }
    }
  }
}

TEST_CASE("hulls and cylinders come to rest in a heap", "[fast][stability]") {
  Scene scene = capsule_crowd(Space::spatial, true);
  for (Body& body : scene.bodies) body.shapes[0].material.restitution = 0;
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table, 16));
    batch.step(600);
    for (int w = 0; w < batch.worlds(); ++w) {
      INFO(name(table) << " world " << w);
      CHECK(batch.status(w) == Status::ok);
      CHECK(max_penetration(batch, w) < 0.02);
      for (int i = 0; i < batch.bodies(w); ++i) CHECK(position(batch, w, i).z() > 0.1);
    }
  }
}

TEST_CASE("bits of cylinders and hulls do not depend on instruction set, layout or lane",
          "[fast][bits]") {
  const Plan plan = compile(capsule_crowd(Space::spatial, true));
  for (Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<std::uint64_t> expected;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      for (ContactLayout layout :
           {ContactLayout::automatic, ContactLayout::dense, ContactLayout::rows}) {
        for (int worlds : {21, 5}) {
          BatchOptions options = options_of(table, worlds, 2);
          options.layout = layout;
          Batch batch(plan, options);
          batch.step(100);
          std::vector<std::uint64_t> hashes;
          for (int w = 0; w < 5; ++w) hashes.push_back(batch.hash(w));
          if (expected.empty()) expected = hashes;
          INFO(name(table) << " worlds " << worlds);
          CHECK(hashes == expected);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
