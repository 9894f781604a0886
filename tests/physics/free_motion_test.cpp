// Free flight of bodies of any shape against the slow twin: compounds with products of inertia
// and a centre of mass far from the body frame.
#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "tests/support/free_body.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Body random_compound(Random& random) {
  Body body;
  body.position = random.in_cube(3);
  body.rotation = random.rotation();
  body.linear_velocity = random.in_cube(4);
  body.angular_velocity = random.in_cube(4);
  const int shapes = random.integer(1, 3);
  for (int i = 0; i < shapes; ++i) {
    Shape shape = shape_of(Box{{random.uniform(0.1, 0.5), random.uniform(0.1, 0.5), 0.2}});
    if (random.chance(0.3)) shape.geometry = Sphere{random.uniform(0.1, 0.4)};
    shape.position = random.in_cube(0.8);
    shape.rotation = random.rotation();
    shape.density = random.uniform(100, 2000);
    shape.filter.mask = 0;  // they may fly through each other
    body.shapes.push_back(shape);
  }
  return body;
}

}  // namespace

TEST_CASE("the free-motion twin agrees with a quad-precision reference", "[fast][twin]") {
  FreeBody body;
  body.mass.inertia = (Vec3(0.13, 0.10, 0.05) / 3).asDiagonal();
  body.angular_momentum = body.mass.inertia * Vec3(1, 2, 3);
  advance(body, Vec3::Zero(), 5, 5000);
  const Quat at_5(-0.3648637429868626, 0.0235633573425886834, 0.0212620010520073973,
                  -0.930519824912734775);
  CHECK(angle_between(body.rotation, at_5) < 1e-9);
}

TEST_CASE("compounds tumble as their twin does", "[fast][free_motion]") {
  Random random(77);
  Scene scene = empty_scene(Space::spatial, 9.81);
  for (int i = 0; i < 24; ++i) scene.add(random_compound(random));
  for (const Table& table : all_tables()) {
    Batch batch(compile(scene), options_of(table, 3));
    std::vector<FreeBody> twins;
    for (const Body& body : scene.bodies) twins.push_back(start_of(scene, body));
    const Momenta before = momenta(batch, 1);
    for (int second = 0; second < 2; ++second) {
      batch.step(60);
      for (int i = 0; i < 24; ++i) {
        FreeBody& twin = twins[static_cast<std::size_t>(i)];
        advance(twin, scene.options.gravity, 1, 500);
        // Second-order rotation over a step: an error per second of about w (w dt)^2 / 8.
        const double w = twin.angular_velocity().norm(), h = 1.0 / 60 / std::sqrt(8.0);
        const double allowed = (1 + second) * (w * w * w * h * h + pick(table, 1e-4, 0));
        INFO(name(table) << " body " << i << " w " << w << " allowed " << allowed);
        CHECK(angle_between(rotation(batch, 1, i).normalized(), twin.rotation) < allowed);
        CHECK((position(batch, 1, i) - twin.origin()).norm() < allowed + pick(table, 2e-4, 1e-11));
        CHECK((velocity(batch, 1, i) - twin.linear_velocity).norm() < pick(table, 1e-4, 1e-11));
      }
    }
    double mass = 0;
    for (const FreeBody& twin : twins) mass += twin.mass.mass;
    CHECK((momenta(batch, 1).linear - before.linear - 2 * mass * scene.options.gravity).norm() <
          pick(table, 1e-5, 1e-12) * mass * 20);
  }
}

}  // namespace manyworlds::test
