// Where shapes are on their bodies, and attractors, that differ from world to world.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

Vec3 three(const Batch& batch, Parameter parameter, int world, std::size_t item = 0) {
  const auto all = numbers(batch, parameter, world);
  return Vec3(all[3 * item], all[3 * item + 1], all[3 * item + 2]);
}

// Two balls of one body, the second one of which is where its number says.
Scene dumbbell(Space space) {
  Scene scene = empty_scene(space, 0);
  Body body = body_of(shape_of(round_of(space, 0.2)), Vec3(1, 2, 0));
  body.shapes.push_back(body.shapes[0]);
  body.shapes[1].position = {0.5, 0, 0};
  scene.add(body);
  Variation offset = vary_three(Parameter::shape_position, {0.3, -0.4, 0}, {0.9, 0.4, 0});
  offset.shape = ShapeId(BodyId(0), 1);
  scene.variations = {offset};
  return scene;
}

// A crowd of compounds and of single shapes, which fall on the ground.
Scene varied_offsets(Space space, bool masses) {
  Scene scene = empty_scene(space, 10);
  scene.add(ground(space));
  for (int i = 0; i < 4; ++i) {
    const Vec3 place = Vec3(0.3 * i, 0, 0) + (0.5 + 0.6 * i) * up_of(space);
    Body body = body_of(
        shape_of(i % 2 == 0 ? round_of(space, 0.2) : box_of(space, {0.25, 0.15, 0.2})), place);
    if (i > 1) {
      body.shapes.push_back(shape_of(box_of(space, {0.1, 0.2, 0.15})));
      body.shapes[1].position = {0.2, 0.05, 0};
    }
    if (i == 3) body.mass_properties = mass_properties(scene, body);
    scene.add(body);
  }
  vary_around(scene, Parameter::shape_position, 0.1);
  vary_around(scene, Parameter::shape_rotation, 0.5);
  if (!masses) return scene;
  scene.variations.push_back(vary(Parameter::mass, 20, 60));
  scene.variations.push_back(vary(Parameter::inertia_scale, 0.9, 1.2));
  return scene;
}

Scene varied_robot() {
  Scene scene = lone_walker();
  for (Body& body : scene.bodies) {  // how soft rows are does not follow masses
    if (body.motion == Motion::dynamic) body.mass_properties = mass_properties(scene, body);
  }
  vary_around(scene, Parameter::shape_position, 0.01);
  vary_around(scene, Parameter::shape_rotation, 0.05);
  return scene;
}

Scene varied_planets(Space space) {
  Scene scene = empty_scene(space, 0);
  for (int i = 0; i < 3; ++i) add_ball(scene, Vec3(1.0 * i, 0.5 * i * i, 0), 1 + i);
  scene.attractors = {{{-2, 0, 0}, 5, 0.1}, {{4, 1, 0}, 2, 0}};
  vary_around(scene, Parameter::attractor_position, 0.5);
  vary_around(scene, Parameter::attractor_strength, 1);
  return scene;
}

}  // namespace

TEST_CASE("masses and inertias of worlds follow where their shapes are", "[fast][parameters]") {
  for (const Space space : kSpaces) {
    const Scene scene = dumbbell(space);
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table, 9));
      for (int w = 0; w < batch.worlds(); ++w) {
        const Vec3 offset = three(batch, Parameter::shape_position, w, 1);
        CHECK((three(batch, Parameter::center_of_mass, w) - offset / 2).norm() < 1e-12);
        // Spun about z it has the energy of two balls that circle.
        const Body& body = scene.bodies[0];
        const double mass = mass_properties(scene, body).mass / 2;
        const double own = (space == Space::planar ? 0.5 : 0.4) * mass * 0.2 * 0.2;
        std::vector<double> w_z(plan.numbers(Field::angular_velocity));
        w_z.back() = 2;
        batch.write(Field::angular_velocity, w, w_z);
        const double expected = 0.5 * 4 * (2 * own + 2 * mass * offset.squaredNorm() / 4);
        CHECK(batch.energy(w).kinetic == Approx(expected).epsilon(pick(table, 1e-5, 1e-10)));
      }
      // Written, the body's own frame stays where it is.
      const Vec3 before = position(batch, 4, 0);
      std::vector<double> moved = numbers(batch, Parameter::shape_position, 4);
      moved[3] = 0.8, moved[4] = 0.2;
      batch.write(Parameter::shape_position, 4, moved);
      CHECK((position(batch, 4, 0) - before).norm() < pick(table, 1e-6, 1e-12));
      moved[3] = 2;
      CHECK_THROWS_WITH(
          batch.write(Parameter::shape_position, 4, moved),
          Catch::Contains("shape_position of shape 1, number 0 is 2, must be between"));
    }
  }
}

TEST_CASE("bodies of worlds rest on shapes that are where their numbers say",
          "[fast][parameters]") {
  for (const Space space : kSpaces) {
    const Vec3 up = up_of(space);
    Scene scene = empty_scene(space, 10);
    scene.add(ground(space));
    scene.add(body_of(shape_of(round_of(space, 0.2)), 1.2 * up));
    scene.variations = {vary_three(Parameter::shape_position, -0.8 * up, 0.8 * up)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(300);
      for (int w = 0; w < batch.worlds(); ++w) {
        const double offset = three(batch, Parameter::shape_position, w, 1).dot(up);
        CHECK(position(batch, w, 0).dot(up) == approx(0.2 - offset, 2e-3));
      }
    }
  }
}

TEST_CASE("bodies of worlds are pulled by attractors of their own", "[fast][parameters][field]") {
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    add_ball(scene, Vec3::Zero(), 2);
    scene.attractors = {{{1, 0, 0}, 1, 0}, {{0, 3, 0}, 0, 0}};
    Variation strength = vary(Parameter::attractor_strength, 1, 5),
              place = vary_three(Parameter::attractor_position, {1, -1, 0}, {2, 1, 0});
    strength.attractor = place.attractor = 0;
    scene.variations = {strength, place};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      for (int w = 0; w < batch.worlds(); ++w) {
        const Vec3 d = three(batch, Parameter::attractor_position, w);
        const double own = numbers(batch, Parameter::attractor_strength, w)[0];
        CHECK(numbers(batch, Parameter::attractor_strength, w)[1] == 0);
        CHECK(batch.energy(w).potential == Approx(-2 * own / d.norm()).epsilon(1e-9));
      }
      batch.step(1);
      for (int w = 0; w < batch.worlds(); ++w) {
        const Vec3 d = three(batch, Parameter::attractor_position, w);
        const double own = numbers(batch, Parameter::attractor_strength, w)[0];
        const Vec3 v = scene.options.dt * own * d / std::pow(d.norm(), 3);
        CHECK((velocity(batch, w, 0) - v).norm() < 2e-3 * v.norm());
      }
    }
  }
}

TEST_CASE("a world with offsets or attractors of its own is one of the scene that has them",
          "[fast][parameters][bits][one_thread]") {
  for (const Space space : kSpaces) {
    for (const bool masses : {false, true}) {
      check_worlds_are_those_of_scenes(varied_offsets(space, masses), "offsets", 9, 60);
    }
    check_worlds_are_those_of_scenes(varied_planets(space), "attractors", 9, 60);
    Scene free = varied_planets(space);
    free.options.integrator = Integrator::runge_kutta4;
    check_worlds_are_those_of_scenes(free, "attractors in free motion", 9, 30);
  }
  check_worlds_are_those_of_scenes(varied_robot(), "links", 5, 40);
}

TEST_CASE("offsets and attractors of worlds have the same bits whatever the batch and threads",
          "[fast][parameters][bits]") {
  check_bits_of_varied_worlds(varied_offsets(Space::spatial, true), Parameter::shape_rotation);
  check_bits_of_varied_worlds(varied_planets(Space::planar), Parameter::attractor_position);
}

TEST_CASE("what is wrong with offsets and attractors that vary is said",
          "[fast][scene][parameters]") {
  Scene scene = dumbbell(Space::planar);
  const auto issue = [&](std::vector<Variation> variations) {
    scene.variations = std::move(variations);
    return only_issue(scene);
  };
  CHECK(issue(dumbbell(Space::planar).variations) == "0 issues");
  CHECK(issue({vary_three(Parameter::shape_position, {0, 0, -1}, {0, 0, 1})}) ==
        "variation 0: high[2] must be 0 in a planar scene, as low[2]");
  CHECK(issue({vary_three(Parameter::shape_rotation, {-1, 0, 0}, {1, 0, 0})}) ==
        "variation 0: high[0] must be 0 in a planar scene, as low[0]");
  CHECK(issue({vary(Parameter::attractor_strength, 0, 1)}) ==
        "variation 0: attractor_strength matches nothing in this scene");
  Variation of_second = vary(Parameter::attractor_strength, 0, 1);
  of_second.attractor = 1;
  scene.attractors = {{{1, 0, 0}, 1, 0}};
  CHECK(issue({of_second}) == "variation 0: attractor is 1, must be -1 or the index of one of 1");
  Variation friction = vary(Parameter::friction, 0, 1);
  friction.attractor = 0;
  CHECK(issue({friction}) ==
        "variation 0: attractor is 0, must be -1: friction belongs to the shape");
  scene.bodies[0].motion = Motion::fixed;
  scene.bodies[0].shapes.resize(1);
  Variation fixed = vary(Parameter::shape_position, 0, 0);
  fixed.shape = ShapeId(BodyId(0), 0);
  CHECK(issue({fixed}) ==
        "variation 0: shape_position cannot vary here, must belong to a shape of a moving body");
}

}  // namespace manyworlds::test
