// Keyframes of scenes: what is wrong with them, and worlds that are reset to them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "tests/support/hashes.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Of newton_robot(): all of a state, and the controls alone.
const Numbers kPose = {0.5, -0.25, 2,   0,   0,   0,   1,     // the torso, turned about z
                       0.5, 0,     1,   0,   0,               // elbow and wrist
                       0,   2,     0.5, 0.5, 0.5, 0.5, 0.5};  // the ball
const Numbers kSpeeds = {1, 0, -1, 0.5, 0, 0, 2, 0, 0, 0.25, 0, 0, 0, 0, 0, 4};
Scene keyed_robot() {
  Scene scene = newton_robot();
  scene.add(Keyframe{"leap", kPose, kSpeeds, {0.5}});
  scene.add(Keyframe{.name = "brake", .controls = {-0.75}});
  return scene;
}
Numbers controls(const Batch& batch) {
  Numbers out(static_cast<std::size_t>(batch.worlds() * batch.controls()));
  batch.read_controls(out);
  return out;
}

}  // namespace

TEST_CASE("keyframes fit their scene and have names of their own", "[fast][validate][keyframe]") {
  REQUIRE(kPose.size() == kCoordinates);
  REQUIRE(kSpeeds.size() == kDofs);
  check_each(
      keyed_robot(), "keyframe 0 'leap': ",
      {{"generalized_position", "has 18 values, must have 19, or none",
        [](Scene& s) { s.keyframes[0].generalized_position.pop_back(); }},
       {"generalized_velocity", "has 17 values, must have 16, or none",
        [](Scene& s) { s.keyframes[0].generalized_velocity.push_back(0); }},
       {"controls", "has 2 values, must have 1, or none",
        [](Scene& s) { s.keyframes[0].controls.push_back(0); }},
       {"generalized_position[4]", "is nan, must be finite",
        [](Scene& s) {
          s.keyframes[0].generalized_position[4] = std::numeric_limits<double>::quiet_NaN();
        }},
       {"generalized_position of body 1", "is a quaternion of length 0, must not be zero",
        [](Scene& s) { std::fill_n(s.keyframes[0].generalized_position.begin() + 3, 4, 0.0); }},
       {"generalized_position of joint 1", "is a quaternion of length 0, must not be zero",
        [](Scene& s) { std::fill_n(s.keyframes[0].generalized_position.begin() + 8, 4, 0.0); }},
       {"generalized_position of body 4", "is a quaternion of length 0, must not be zero",
        [](Scene& s) { std::fill_n(s.keyframes[0].generalized_position.begin() + 15, 4, 0.0); }},
       {"controls[0]", "is inf, must be finite",
        [](Scene& s) { s.keyframes[0].controls[0] = std::numeric_limits<double>::infinity(); }}});
  check_each(keyed_robot(), "keyframe 1 'leap': ",
             {{"name", "is also that of keyframe 0, must be unique or empty",
               [](Scene& s) { s.keyframes[1].name = "leap"; }}});
  Scene nameless = keyed_robot();
  for (Keyframe& keyframe : nameless.keyframes) keyframe.name.clear();
  CHECK(validate(nameless).empty());
  // Other solvers have no joint coordinates, but controls.
  Scene scene = empty_scene(Space::spatial);
  scene.add(body_of(shape_of(Sphere{0.2}), Vec3::Zero()));
  scene.controls = {{"jet", ControlKind::thrust, {}, BodyId(0), {}, Vec3::UnitX(), 0, 5, 0}};
  scene.add(Keyframe{.name = "on", .controls = {2}});
  check_each(scene, "keyframe 0 'on': ",
             {{"generalized_position", "has 7 values, must have 0",
               [](Scene& s) { s.keyframes[0].generalized_position = {0, 0, 0, 1, 0, 0, 0}; }}});
  Batch batch(compile(scene), {.worlds = 2, .threads = 1});
  batch.reset(batch.keyframe("on"));
  CHECK(controls(batch) == Numbers{2, 2});
}

TEST_CASE("keyframes are found by name and change no plan", "[fast][keyframe]") {
  const Scene scene = keyed_robot();
  const Plan plan = compile(scene);
  CHECK(plan.keyframe("brake") == KeyframeId(1));
  CHECK(scene.at(scene.keyframe("leap")).controls == Numbers{0.5});
  CHECK_THROWS_WITH(plan.keyframe("lep"),
                    "no keyframe is named 'lep'; there are 'leap', 'brake' (nearest: 'leap')");
  CHECK(plan.fingerprint() == compile(newton_robot()).fingerprint());
}

TEST_CASE("worlds are reset to a keyframe", "[fast][keyframe]") {
  const Plan plan = compile(keyed_robot());
  const KeyframeId leap(0), brake(1);
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(plan, options_of(table, 3));
    batch.step(5);
    batch.reset(leap);
    CHECK(batch.steps() == 0);
    for (int w = 0; w < 3; ++w) {
      CHECK(of(batch, Field::generalized_position, w) == kPose);
      CHECK(of(batch, Field::generalized_velocity, w) == kSpeeds);
      // Bodies are where the coordinates put them.
      CHECK((position(batch, w, batch.row(BodyId(1))) - Vec3(0.5, -0.25, 2)).norm() < 1e-6);
    }
    CHECK(controls(batch) == Numbers{0.5, 0.5, 0.5});
    batch.step(7);
    const auto after = hashes(batch);
    // The same again, of some, whatever has happened; the others go on.
    const std::uint8_t mask[] = {0, 1, 0};
    batch.add_force(1, BodyId(1), Vec3(0, 0, 1e3));
    batch.reset(mask, leap);
    CHECK(batch.steps() == 7);
    CHECK(batch.hash(0) == after[0]);
    CHECK(of(batch, Field::generalized_position, 1) == kPose);
    batch.step(7);
    CHECK(batch.hash(1) == after[1]);
    CHECK(batch.hash(0) != after[0]);
    // What a keyframe does not give is drawn as ever.
    Batch drawn(plan, options_of(table, 3));
    drawn.reset(brake);
    Batch plain(plan, options_of(table, 3));
    CHECK(hashes(drawn) == hashes(plain));
    CHECK(controls(drawn) == Numbers{-0.75, -0.75, -0.75});
    drawn.reset(mask, brake), plain.reset(mask);
    CHECK(hashes(drawn) == hashes(plain));
    // A lost world is whole again.
    Numbers bad = kPose;
    bad[0] = std::numeric_limits<double>::quiet_NaN();
    put(batch, Field::generalized_position, bad, 1);
    batch.step();
    CHECK(frozen(batch.status(1)));
    batch.reset(mask, leap);
    batch.step(7);
    CHECK(batch.hash(1) == after[1]);
  }
}

TEST_CASE("a reset to a keyframe that is not there resets nothing", "[fast][keyframe]") {
  const Plan keyed = compile(keyed_robot()), none = compile(newton_robot());
  Batch batch({{keyed, 2}, {none, 1}}, {.threads = 1});
  batch.step(3);
  const auto before = hashes(batch);
  for (const int wrong : {-1, 2}) {
    CHECK_THROWS_WITH(batch.reset(std::vector<std::uint8_t>{1, 1, 0}, KeyframeId(wrong)),
                      Catch::Contains("keyframe is " + std::to_string(wrong) + ", must be 0 to 1"));
  }
  CHECK_THROWS_WITH(batch.reset(KeyframeId(0)), Catch::Contains("has none"));
  CHECK_THROWS_AS(batch.reset(std::vector<std::uint8_t>{0, 1, 1}, KeyframeId(0)),
                  std::invalid_argument);
  CHECK_THROWS_AS(batch.reset(std::vector<std::uint8_t>{1}, KeyframeId(0)), std::invalid_argument);
  CHECK(hashes(batch) == before);
  batch.reset(std::vector<std::uint8_t>{0, 1, 0}, KeyframeId(0));
  CHECK(of(batch, Field::generalized_position, 1) == kPose);
  CHECK(batch.hash(0) == before[0]);
}

}  // namespace manyworlds::test
