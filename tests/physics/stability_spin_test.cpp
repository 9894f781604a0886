// Fast spin: energy and momentum of a free body, and no energy from spin in contact.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Inertia of MuJoCo's free box, half sizes (.1, .2, .3), 1 kg.
Scene spinning_box(const Vec3& spin, double dt, int substeps) {
  Scene scene = empty_scene(Space::spatial, 0);
  scene.options.dt = dt;
  scene.options.substeps = substeps;
  Body body = body_of(shape_of(Box{{0.1, 0.2, 0.3}}), Vec3::Zero());
  MassProperties m;
  m.inertia = (Vec3(0.13, 0.10, 0.05) / 3).asDiagonal();
  body.mass_properties = m;
  body.angular_velocity = spin;
  scene.add(body);
  return scene;
}

struct Range {
  double lowest = 1e9, highest = 0, worst_momentum = 0;
};

// Energy over the start's and change of angular momentum, over the whole run.
Range observe(const Scene& scene, const Table& table, int steps, int stride) {
  Batch batch(compile(scene), options_of(table));
  const double energy = kinetic_energy(batch, 0);
  const Vec3 momentum = momenta(batch, 0).angular;
  Range range;
  for (int i = 0; i < steps; i += stride) {
    batch.step(stride);
    const double ratio = kinetic_energy(batch, 0) / energy;
    range.lowest = std::min(range.lowest, ratio);
    range.highest = std::max(range.highest, ratio);
    range.worst_momentum = std::max(
        range.worst_momentum, (momenta(batch, 0).angular - momentum).norm() / momentum.norm());
  }
  CHECK(batch.status(0) == Status::ok);
  return range;
}

}  // namespace

TEST_CASE("a box at 100 rad/s keeps its energy and momentum", "[slow][stability]") {
  for (const Table& table : widest_tables()) {
    for (int variant = 0; variant < 3; ++variant) {
      const double dt = variant == 0 ? 1.0 / 60 : 1.0 / 240;
      const int substeps = variant == 2 ? 1 : 4;
      const Range r = observe(spinning_box(Vec3(0.1, 100, 0.1), dt, substeps), table,
                              variant == 0 ? 600 : 2400, 1);
      INFO(name(table) << " dt " << dt << " substeps " << substeps << " E " << r.lowest << ".."
                       << r.highest << " dL " << r.worst_momentum);
      CHECK(r.lowest > 0.95);
      CHECK(r.highest < 1.05);
      CHECK(r.worst_momentum < pick(table, 1e-3, 1e-5));
    }
  }
}

TEST_CASE("a box at 1000 rad/s stays bounded", "[slow][stability]") {
  for (const Table& table : widest_tables()) {
    const Range r = observe(spinning_box(Vec3(1, 1000, 1), 1.0 / 60, 4), table, 600, 1);
    INFO(name(table) << " E " << r.lowest << ".." << r.highest << " dL " << r.worst_momentum);
    CHECK(r.lowest > 0.5);
    CHECK(r.highest < 2.1);
    CHECK(r.worst_momentum < pick(table, 1e-3, 1e-5));
  }
}

TEST_CASE("a spinning box gains no energy over 20,000 steps", "[slow][stability]") {
  for (const Table& table : widest_tables()) {
    for (const Vec3& spin : {Vec3(0.05, 5, 0.05), Vec3(20, 0.05, 0.05)}) {
      const Range r = observe(spinning_box(spin, 0.005, 1), table, 20000, 10);
      INFO(name(table) << " spin " << spin.transpose() << " E " << r.lowest << ".." << r.highest);
      CHECK(r.highest < 1.01);
      CHECK(r.lowest > 0.99);
    }
  }
}

TEST_CASE("a spinning box on a slope gains no energy", "[slow][stability]") {
  const Vec3 half(0.05, 0.1, 0.15);
  for (const Vec3& spin : {Vec3(0.05, 30, 0.05), Vec3(20, 0.05, 0.05), Vec3(5, 10, 40)}) {
    Scene scene = empty_scene(Space::spatial, 9.81);
    scene.options.dt = 0.002;
    scene.options.length_unit = 0.2;
    Body plane = ground(Space::spatial);
    plane.rotation = Quat(Eigen::AngleAxisd(15 * kPi / 180, Vec3::UnitY()));
    scene.add(plane);
    Body box = body_of(shape_of(Box{half}), Vec3(0, 0, 0.2));
    box.shapes[0].density = 1 / (8 * half.prod());
    box.angular_velocity = spin;
    scene.add(box);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      double least = 1e9, max_kinetic = 0, worst_gain = 0;
      for (int i = 0; i < 2500; ++i) {
        batch.step();
        const Energy e = batch.energy(0);
        least = std::min(least, e.kinetic + e.potential);
        max_kinetic = std::max(max_kinetic, e.kinetic);
        worst_gain = std::max(worst_gain, e.kinetic + e.potential - least);
      }
      INFO(name(table) << " spin " << spin.transpose() << " gain " << worst_gain << " most kinetic "
                       << max_kinetic);
      CHECK(worst_gain < 0.01 * max_kinetic);
      CHECK(batch.status(0) == Status::ok);
    }
  }
}

TEST_CASE("a spin about the middle axis flips, about the others it stays", "[slow][stability]") {
  // Half sizes (.1, .2, .3): inertia falls from x to z, so y is the middle axis.
  for (const Table& table : widest_tables()) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 start = Vec3::Constant(0.01);
      start(axis) = 5;
      Batch batch(compile(spinning_box(start, 1.0 / 60, 4)), options_of(table));
      double least = 1;
      for (int i = 0; i < 1200; ++i) {
        batch.step();
        const Vec3 body_axis = rotation(batch, 0, 0).normalized() * Vec3(Vec3::Unit(axis));
        least = std::min(least, body_axis(axis));
      }
      INFO(name(table) << " axis " << axis << " least cosine " << least);
      if (axis == 1) {
        CHECK(least < -0.95);
      } else {
        CHECK(least > 0.99);
      }
    }
  }
}

}  // namespace manyworlds::test
