// How bodies begin, where their centres of mass are, inertia and wind that differ from world to
// world.
#include <catch2/catch.hpp>

#include <numbers>
#include <string>
#include <vector>

#include "src/scene/rotation_vector.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

Vec3 of_body(const Batch& batch, Parameter parameter, int world, std::size_t row = 0) {
  const auto all = numbers(batch, parameter, world);
  return Vec3(all[3 * row], all[3 * row + 1], all[3 * row + 2]);
}

// Only what the space has.
Vec3 within(Space space, const Vec3& v, bool rotates = false) {
  if (space == Space::spatial) return v;
  return rotates ? Vec3(0, 0, v.z()) : Vec3(v.x(), v.y(), 0);
}

// One free body of a box that is not round.
Scene free_box(Space space) {
  Scene scene = empty_scene(space, 0);
  scene.add(body_of(shape_of(box_of(space, {0.3, 0.2, 0.1})), Vec3::Zero()));
  return scene;
}

void vary_starts(Scene& scene) {
  vary_around(scene, Parameter::initial_position, 0.02);
  vary_around(scene, Parameter::initial_rotation, 0.3);
  vary_around(scene, Parameter::initial_linear_velocity, 0.5);
  vary_around(scene, Parameter::initial_angular_velocity, 0.5);
  vary_around(scene, Parameter::center_of_mass, 0.03);
  scene.variations.push_back(vary(Parameter::inertia_scale, 0.8, 1.2));
  scene.variations.push_back(vary_three(Parameter::wind, within(scene.space, {-3, -1, -1}),
                                        within(scene.space, {3, 1, 1})));
}

// Of bodies of every kind, or of such alone as are their shapes.
Scene varied_starts(Space space, bool round) {
  Scene scene = capsule_crowd(space, true);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    Body& body = scene.bodies[b];
    if (b % 2 == 0) body.linear_drag = 0.1;
    if (round && body.motion == Motion::dynamic) body.shapes[0].geometry = round_of(space, 0.3);
  }
  vary_starts(scene);
  return scene;
}

}  // namespace

TEST_CASE("rotation vectors are rotations", "[fast][parameters]") {
  for (const Vec3& v : {Vec3(0, 0, 0), Vec3(0.1, -0.2, 0.3), Vec3(3, 0.5, 0.2), Vec3(0, 0, -3.1)}) {
    CHECK((rotation_vector(rotation_of(v)) - v).norm() < 1e-12);
  }
  // The same one by the shorter way.
  CHECK(
      (rotation_vector(rotation_of(Vec3(0, 0, 4))) - Vec3(0, 0, 4 - 2 * std::numbers::pi)).norm() <
      1e-12);
}

TEST_CASE("bodies of worlds begin where their numbers say", "[fast][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = free_box(space);
    const auto add = [&](Parameter parameter, double width, bool rotates = false) {
      const Vec3 w = within(space, Vec3(width, 2 * width, width), rotates);
      scene.variations.push_back(vary_three(parameter, -w, w));
    };
    add(Parameter::initial_position, 5);
    add(Parameter::initial_rotation, 1, true);
    add(Parameter::initial_linear_velocity, 2);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 33));
      const double close = pick(table, 1e-5, 1e-12);
      Vec3 before = Vec3::Zero();
      for (int episode = 0; episode < 2; ++episode) {
        for (int w = 0; w < batch.worlds(); ++w) {
          const Quat rotation = rotation_of(of_body(batch, Parameter::initial_rotation, w));
          CHECK((position(batch, w, 0) - of_body(batch, Parameter::initial_position, w)).norm() <
                close);
          CHECK(test::rotation(batch, w, 0).angularDistance(rotation) < pick(table, 1e-3, 1e-7));
        }
        batch.step(60);
        for (int w = 0; w < batch.worlds(); ++w) {
          const Vec3 x = of_body(batch, Parameter::initial_position, w),
                     v = of_body(batch, Parameter::initial_linear_velocity, w);
          CHECK((position(batch, w, 0) - x - 60 * scene.options.dt * v).norm() < 10 * close);
        }
        CHECK(of_body(batch, Parameter::initial_position, 7) != before);
        before = of_body(batch, Parameter::initial_position, 7);
        batch.reset();
        std::vector<std::uint8_t> mask(33, 1);
        batch.reset(mask);
      }
    }
  }
}

TEST_CASE("a written beginning holds from the next reset", "[fast][parameters][sleep]") {
  Scene scene = empty_scene(Space::spatial);
  scene.add(ground(Space::spatial));
  scene.add(body_of(shape_of(Box{{0.5, 0.5, 0.5}}), Vec3(0, 0, 0.5)));
  scene.variations = {
      vary_three(Parameter::initial_linear_velocity, Vec3::Zero(), Vec3::Constant(5), Draw::none)};
  Batch batch(compile(scene), {.worlds = 5, .threads = 1, .sleep = true});
  batch.step(60);
  REQUIRE(batch.asleep(3));
  const std::vector<double> own = {0, 0, 2}, beyond = {0, 0, 6};
  const auto resting = state(batch, 3);
  batch.write(Parameter::initial_linear_velocity, 3, own);
  CHECK(batch.asleep(3));
  CHECK(state(batch, 3) == resting);
  CHECK_THROWS_AS(batch.write(Parameter::initial_linear_velocity, 3, beyond),
                  std::invalid_argument);
  const Snapshot saved = batch.save();
  batch.copy_world(3, 1);
  batch.reset();
  CHECK(velocity(batch, 3, 0) == Vec3(0, 0, 2));
  CHECK(velocity(batch, 1, 0) == Vec3(0, 0, 2));
  CHECK(velocity(batch, 2, 0).norm() == 0);
  batch.restore(saved, 3, 4);
  CHECK(numbers(batch, Parameter::initial_linear_velocity, 4) == own);
}

TEST_CASE("an impulse at a world's own centre of mass does not rotate it", "[fast][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = free_box(space);
    scene.bodies[0].rotation = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
    const Vec3 most = within(space, Vec3(0.2, 0.1, 0.1));
    scene.variations = {vary_three(Parameter::center_of_mass, -most, most),
                        vary(Parameter::inertia_scale, 0.5, 2)};
    const Mat3 inertia = mass_properties(scene, scene.bodies[0]).inertia;
    const double mass = mass_properties(scene, scene.bodies[0]).mass;
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table, 9));
      const double close = pick(table, 1e-5, 1e-12);
      for (int w = 0; w < batch.worlds(); ++w) {
        const Vec3 center = of_body(batch, Parameter::center_of_mass, w);
        const double scale = numbers(batch, Parameter::inertia_scale, w)[0];
        CHECK(center.norm() > 0);
        CHECK(position(batch, w, 0).norm() < close);
        CHECK(rotation(batch, w, 0).angularDistance(scene.bodies[0].rotation) <
              pick(table, 1e-3, 1e-7));
        batch.add_impulse(w, batch.body_in_row(0), Vec3(mass, 0, 0));
        CHECK(spin(batch, w, 0).norm() < close);
        CHECK((velocity(batch, w, 0) - Vec3(1, 0, 0)).norm() < close);
        // Its own frame moves by where that is.
        batch.add_angular_impulse(w, batch.body_in_row(0), Vec3(0, 0, inertia(2, 2)));
        CHECK((spin(batch, w, 0) - Vec3(0, 0, 1 / scale)).norm() < 10 * close);
        // Written, the body stays where its frame is.
        const Vec3 moved = -center;
        batch.write(Parameter::center_of_mass, w, {moved.data(), 3});
        CHECK(position(batch, w, 0).norm() < close);
      }
    }
  }
}

TEST_CASE("drag draws bodies along with the wind of their world", "[fast][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = free_box(space);
    scene.bodies[0].linear_drag = 4;
    const Vec3 most = within(space, Vec3(3, 2, 1));
    scene.variations = {vary_three(Parameter::wind, -most, most)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(300);
      for (int w = 0; w < batch.worlds(); ++w) {
        CHECK((velocity(batch, w, 0) - of_body(batch, Parameter::wind, w)).norm() < 1e-4);
      }
    }
  }
}

TEST_CASE("controls are clamped to the ranges of their worlds", "[fast][parameters]") {
  Scene scene = free_box(Space::planar);
  Control thrust;
  thrust.kind = ControlKind::thrust, thrust.body = BodyId(0);
  thrust.direction = Vec3::UnitX();
  thrust.low = -1, thrust.high = 1;
  scene.add(thrust);
  scene.variations = {vary(Parameter::control_low, -3, -0.5),
                      vary(Parameter::control_high, 0.5, 3)};
  const double mass = mass_properties(scene, scene.bodies[0]).mass;
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table, 9));
    const std::vector<double> most(9, 100), low = {-0.5}, beyond = {-4};
    batch.set_controls(most);
    batch.step(60);
    for (int w = 0; w < batch.worlds(); ++w) {
      const double high = numbers(batch, Parameter::control_high, w)[0];
      CHECK(velocity(batch, w, 0).x() == Approx(high * 60 * scene.options.dt / mass).epsilon(1e-4));
    }
    batch.write(Parameter::control_low, 2, low);
    CHECK_THROWS_AS(batch.write(Parameter::control_low, 2, beyond), std::invalid_argument);
    batch.copy_world(2, 3);
    const std::vector<double> least = {-100};
    for (const int w : {2, 3}) {
      batch.set_controls(w, least);
      const double before = velocity(batch, w, 0).x();
      batch.step(60);
      CHECK(velocity(batch, w, 0).x() - before ==
            Approx(-0.5 * 60 * scene.options.dt / mass).epsilon(1e-3));
      batch.set_controls(w, std::vector<double>{0});
    }
  }
  scene.variations = {vary(Parameter::control_low, -1, 2), vary(Parameter::control_high, 0.5, 2)};
  CHECK_FALSE(validate(scene).empty());
}

TEST_CASE("a world with a beginning of its own is one of the scene that has it, bit for bit",
          "[fast][parameters][bits][one_thread]") {
  for (const Space space : kSpaces) {
    for (const bool round : {false, true}) {
      check_worlds_are_those_of_scenes(varied_starts(space, round), round ? "round" : "", 11, 40);
    }
  }
}

TEST_CASE("beginnings of worlds have the same bits whatever the batch and threads",
          "[fast][parameters][bits]") {
  for (const Space space : kSpaces) {
    const Plan plan = compile(varied_starts(space, false));
    for (const Table& table : all_tables()) {
      Batch batch(plan, options_of(table, 21, 3)), fewer(plan, options_of(table, 5));
      batch.step(40);
      fewer.step(40);
      for (int w = 0; w < fewer.worlds(); ++w) CHECK(state(batch, w) == state(fewer, w));
    }
  }
}

TEST_CASE("what is wrong with beginnings that vary is said", "[fast][scene][parameters]") {
  Scene scene = free_box(Space::planar);
  scene.add(ground(Space::planar));
  const auto issue = [&](const Variation& variation) -> std::string {
    scene.variations = {variation};
    const std::vector<Issue> issues = validate(scene);
    return issues.size() == 1 ? to_string(issues[0]) : std::to_string(issues.size()) + " issues";
  };
  const Vec3 one = Vec3::Ones();
  CHECK(issue(vary_three(Parameter::initial_position, -one, one)) ==
        "variation 0: high[2] must be 0 in a planar scene, as low[2]");
  CHECK(issue(vary_three(Parameter::initial_rotation, -one, one)) ==
        "variation 0: high[0] must be 0 in a planar scene, as low[0]");
  CHECK(issue(vary(Parameter::inertia_scale, 0, 1)).find("variation 0: low is 0, must be") == 0);
  Variation of_ground = vary_three(Parameter::initial_position, Vec3::Zero(), Vec3::Zero());
  of_ground.body = BodyId(1);
  CHECK(issue(of_ground) ==
        "variation 0: initial_position cannot vary here, must belong to a body that moves");
  scene.bodies[0].mass_properties = MassProperties{};
  CHECK(issue(vary_three(Parameter::center_of_mass, Vec3(1, 0, 0), Vec3(2, 0, 0), Draw::none)) ==
        "variation 0: draw is none, but the scene's center_of_mass of body 0, 0, is not within "
        "low[0] and high[0]");
}

}  // namespace manyworlds::test
