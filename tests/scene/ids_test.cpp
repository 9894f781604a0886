// Handles of bodies, shapes, joints and controls: who is meant, by handle, by name and by row.
#include <catch2/catch.hpp>

#include <functional>
#include <string>
#include <type_traits>
#include <unordered_set>

#include "manyworlds/manyworlds.hpp"
#include "manyworlds/nearest.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Neither an int nor a handle of another kind is taken for one.
static_assert(!std::is_convertible_v<int, BodyId> && std::is_constructible_v<BodyId, int>);
static_assert(!std::is_convertible_v<BodyId, int> && !std::is_constructible_v<BodyId, JointId>);
static_assert(!std::is_convertible_v<JointId, BodyId> && !std::is_convertible_v<BodyId, JointId>);
static_assert(!std::is_convertible_v<BodyId, ShapeId>);
static_assert(std::is_trivially_copyable_v<BodyId> && sizeof(BodyId) == sizeof(int));
static_assert(!BodyId() && BodyId(0) && BodyId() == BodyId(-1) && BodyId(1) < BodyId(2));
static_assert(!ShapeId() && ShapeId(BodyId(2), 0) < ShapeId(BodyId(2), 1));

Shape named_shape(const char* name, const Vec3& place) {
  Shape shape = shape_of(Sphere{0.25});
  shape.name = name;
  shape.position = place;
  return shape;
}

struct Workshop {
  Scene scene;
  BodyId ground, crate, lid, post;
  JointId hinge;
  ControlId push;
};

// A fixed body comes first, and one lies between those that move.
Workshop workshop() {
  Workshop w;
  Scene& s = w.scene = empty_scene(Space::spatial, 0);
  const auto add = [&s](const char* name, const Vec3& place, Motion motion) {
    Body body = body_of(named_shape("ball", Vec3::Zero()), place, motion);
    body.name = name;
    return s.add(body);
  };
  w.ground = s.add(ground(Space::spatial));
  s.at(w.ground).name = "ground";
  w.crate = add("crate", {0, 0, 5}, Motion::dynamic);
  w.post = add("post", {4, 0, 5}, Motion::fixed);
  w.lid = add("lid", {0, 0, 8}, Motion::dynamic);
  s.at(w.lid).shapes.push_back(named_shape("knob", {0, 0, 0.5}));
  w.hinge = s.add(joint_at(s, w.crate, w.lid, at({0, 0, 6.5}), BallJoint{}));
  s.at(w.hinge).name = "hinge";
  w.push = s.add(Control{.name = "push", .kind = ControlKind::thrust, .body = w.lid});
  return w;
}

}  // namespace

TEST_CASE("a force on the handle that add returned moves that body", "[fast][ids]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Scene scene = empty_scene(Space::spatial, 0);
    scene.add(ground(Space::spatial));  // body 0 has no row
    scene.add(body_of(shape_of(Sphere{0.5}), {0, 0, 3}));
    const BodyId accelerated = scene.add(body_of(shape_of(Sphere{0.5}), {3, 0, 3}));
    scene.add(body_of(shape_of(Sphere{0.5}), {6, 0, 3}));
    Batch batch(compile(scene), options_of(table, 3));
    batch.add_force(1, accelerated, {1000, 0, 0});
    batch.step();
    CHECK(velocity(batch, 1, accelerated).x() > 0.01);
    CHECK(velocity(batch, 1, 1).x() > 0.01);  // its row
    CHECK(velocity(batch, 1, 0).norm() == 0);
    CHECK(velocity(batch, 1, 2).norm() == 0);
    CHECK(velocity(batch, 0, accelerated).norm() == 0);
  }
}

TEST_CASE("calls that a fixed body makes no sense of name it and say why", "[fast][ids]") {
  const Workshop w = workshop();
  const Plan plan = compile(w.scene);
  Batch batch(plan, options_of(widest_tables().front(), 2));
  const Vec3 x = Vec3::UnitX();
  const std::string refused = "body 0 'ground' is fixed: ";
  using Catch::Equals;
  CHECK_THROWS_WITH(batch.add_force(0, w.ground, x),
                    Equals(refused + "no force or impulse moves it"));
  CHECK_THROWS_WITH(batch.add_impulse_at(0, w.ground, x, x),
                    Equals(refused + "no force or impulse moves it"));
  CHECK_THROWS_WITH(batch.add_torque(0, w.post, x), Catch::Contains("body 2 'post' is fixed"));
  CHECK_THROWS_WITH(batch.set_enabled(0, w.ground, false),
                    Equals(refused + "it is always enabled"));
  CHECK_THROWS_WITH(batch.spawn(0, w.ground, {}), Equals(refused + "it keeps the scene's pose"));
  CHECK_THROWS_WITH(batch.touching(0, w.ground), Catch::Contains("query the other body"));
  CHECK_THROWS_WITH(plan.row(w.ground), Equals("body 0 'ground' is fixed, it has no row"));
  CHECK_THROWS_AS(plan.row(w.ground), std::invalid_argument);
  // What can be said of it is said.
  CHECK(batch.enabled(0, w.ground));
  CHECK_FALSE(batch.asleep(0, w.ground));
  CHECK_FALSE(plan.find_row(w.ground));
  // And who is not there at all is an error in every call.
  for (const BodyId nobody : {BodyId(), BodyId(4), BodyId(-7)}) {
    const std::string is = "body is " + std::to_string(nobody.index()) + ", must be 0 to 3";
    CHECK_THROWS_WITH(batch.add_force(0, nobody, x), is);
    CHECK_THROWS_WITH(batch.enabled(0, nobody), is);
    CHECK_THROWS_WITH(batch.asleep(0, nobody), is);
    CHECK_THROWS_WITH(batch.touching(0, nobody, w.crate), is);
    CHECK_THROWS_WITH(plan.row(nobody), is);
  }
  CHECK_THROWS_WITH(batch.joint_enabled(0, JointId(1)), "joint is 1, must be 0 to 0");
}

TEST_CASE("handles and rows lead to one another", "[fast][ids]") {
  const Workshop w = workshop();
  const Plan plan = compile(w.scene);
  CHECK(plan.bodies() == 2);
  CHECK(plan.row(w.crate) == 0);
  CHECK(plan.row(w.lid) == 1);
  CHECK(plan.body_in_row(0) == w.crate);
  CHECK(plan.body_in_row(1) == w.lid);
  CHECK_THROWS_WITH(plan.body_in_row(2), "row is 2, must be 0 to 1");
  CHECK_THROWS_AS(plan.body_in_row(-1), std::invalid_argument);
  // Every shape of the scene has a row in arrays of shapes.
  CHECK(plan.row(ShapeId(w.ground, 0)) == 0);
  CHECK(plan.row(ShapeId(w.lid, 1)) == 4);
  CHECK_THROWS_WITH(plan.row(ShapeId(w.lid, 2)), "shape is 2, must be 0 to 1");
  const Batch batch(plan, options_of(widest_tables().front(), 2));
  CHECK(batch.size(Parameter::friction) == 2 * 5);
  CHECK(std::unordered_set<BodyId>{w.crate, w.lid, BodyId(1)}.size() == 2);
  CHECK(std::hash<ShapeId>{}(ShapeId(w.lid, 0)) != std::hash<ShapeId>{}(ShapeId(w.lid, 1)));
}

TEST_CASE("bodies, shapes, joints and controls are found by their names", "[fast][ids]") {
  Workshop w = workshop();
  const Plan plan = compile(w.scene);
  const Batch batch(plan, options_of(widest_tables().front()));
  CHECK(plan.body("lid") == w.lid);
  CHECK(batch.body("lid") == w.lid);
  CHECK(w.scene.body("ground") == w.ground);
  CHECK(plan.joint("hinge") == w.hinge);
  CHECK(batch.joint("hinge") == w.hinge);
  CHECK(plan.control("push") == w.push);
  CHECK(batch.control("push") == w.push);
  CHECK(plan.shape("knob") == ShapeId(w.lid, 1));
  CHECK(plan.shape(w.crate, "ball") == ShapeId(w.crate, 0));
  CHECK(batch.shape("knob") == ShapeId(w.lid, 1));

  CHECK_THROWS_AS(plan.body("crat"), std::invalid_argument);
  CHECK_THROWS_WITH(plan.body("crat"),
                    "no body is named 'crat'; there are 'ground', 'crate', 'post', 'lid' "
                    "(nearest: 'crate')");
  CHECK_THROWS_WITH(plan.body("elephant"), !Catch::Contains("nearest"));
  CHECK_THROWS_WITH(plan.joint("hing"),
                    "no joint is named 'hing'; there is 'hinge' (nearest: 'hinge')");
  CHECK_THROWS_WITH(batch.control("pull"), "no control is named 'pull'; there is 'push'");
  CHECK_THROWS_WITH(plan.body(""), Catch::Contains("the name of a body is empty; there are"));
  CHECK_THROWS_WITH(plan.shape(w.crate, "knob"), Catch::Contains("no shape is named 'knob'"));
  // A name that several have means none of them.
  CHECK_THROWS_WITH(plan.shape("ball"),
                    "3 shapes are named 'ball': 0 of body 1, 0 of body 2, 0 of body 3; give them "
                    "distinct names, or use the handle");
  w.scene.at(w.crate).name = "lid";
  CHECK_THROWS_WITH(w.scene.body("lid"),
                    Catch::StartsWith("2 bodies are named 'lid': 1, 3; give them distinct names"));
  w.scene.joints[0].name.clear();
  CHECK_THROWS_WITH(w.scene.joint("hinge"),
                    "no joint is named 'hinge'; there are no joints with names");
}

TEST_CASE("in a batch of several kinds, names, rows and rays are those of the kind",
          "[fast][ids][observe]") {
  const Workshop w = workshop();
  Scene other = empty_scene(Space::spatial, 0);  // where body 1 lies in row 1
  for (const char* of : {"lid", "crate"}) {
    Body body = body_of(shape_of(Sphere{0.5}), {0, of == std::string("lid") ? 0.0 : 3.0, 0});
    body.name = of;
    other.add(body);
  }
  BatchOptions options = options_of(widest_tables().front());
  // From the middle of body 1 of either, upwards.
  options.observe.rays = {{.direction = {0, 0, 1}, .body = BodyId(1)}};
  Batch batch({{compile(w.scene), 2}, {compile(other), 2}}, options);
  CHECK(batch.body("lid", 0) == w.lid);
  CHECK(batch.body("lid", 1) == BodyId(0));
  CHECK(batch.row(BodyId(1), 0) == 0);
  CHECK(batch.row(BodyId(1), 1) == 1);
  CHECK(batch.body_in_row(1, 0) == w.lid);
  CHECK_THROWS_WITH(batch.add_force(0, w.ground, Vec3::UnitX()), Catch::Contains("'ground'"));
  batch.add_impulse(2, BodyId(0), {100, 0, 0});  // in the other kind it moves
  CHECK(velocity(batch, 2, 0).x() > 0);
  batch.look();
  CHECK(batch.ray_hits(0)[0].body == w.lid);
  CHECK(batch.ray_hits(0)[0].shape == ShapeId(w.lid, 0));
  CHECK_FALSE(batch.ray_hits(2)[0].body);
  CHECK_FALSE(batch.ray_hits(2)[0].shape);
  options.observe.rays[0].body = BodyId(0);
  CHECK_THROWS_WITH(
      Batch(compile(w.scene), options),
      Catch::Contains("rays[0].body is body 0 'ground', must be a body that can move"));
}

TEST_CASE("contacts and variations name shapes of the scene", "[fast][ids]") {
  Scene scene = empty_scene(Space::spatial, 10);
  scene.add(ground(Space::spatial));
  Body body = body_of(named_shape("left", {-1, 0, 0}), {0, 0, 0.25});
  body.shapes.push_back(named_shape("right", {1, 0, 0}));
  const BodyId dumbbell = scene.add(body);
  Variation v = vary(Parameter::friction, 0.1, 0.2);
  v.shape = scene.shape("right");
  scene.variations = {v};
  const Plan plan = compile(scene);
  BatchOptions options = options_of(widest_tables().front(), 4);
  options.observe.what = {Observer::contacts};
  Batch batch(plan, options);
  std::vector<double> friction(batch.size(Parameter::friction) / 4);
  batch.read(Parameter::friction, 2, friction);
  CHECK(friction[static_cast<std::size_t>(plan.row(plan.shape("left")))] == 0.6);
  CHECK(friction[static_cast<std::size_t>(plan.row(plan.shape("right")))] <= 0.2);
  batch.step(30);
  bool left = false, right = false;
  for (const Contact& c : batch.contacts(2)) {
    CHECK(c.body_a == BodyId(0));
    CHECK(c.shape_b.body() == c.body_b);
    left |= c.shape_b == plan.shape("left");
    right |= c.shape_b == ShapeId(dumbbell, 1);
  }
  CHECK((left && right));
  for (const StepContact& c : batch.step_contacts(2)) CHECK(c.body_b == dumbbell);
  CHECK(batch.touching(2, dumbbell, BodyId(0)));
  // Both a body and a shape of another one.
  scene.variations[0].body = BodyId(0);
  const auto issues = validate(scene);
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].message == "is 1, must be a shape of body 0, but belongs to body 1");
}

TEST_CASE("a nearest word is near", "[fast][ids]") {
  const std::vector<std::string> known = {"crate", "lid", "left wheel", "right wheel"};
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("", "lid") == 3);
  CHECK(nearest("crat", known) == "crate");
  CHECK(nearest("wheel left", known) == std::nullopt);
  CHECK(nearest("left weel", known) == "left wheel");
  CHECK(nearest("lip", known) == "lid");
  CHECK_FALSE(nearest("zzz", known));
  CHECK_FALSE(nearest("x", {}));
}

}  // namespace manyworlds::test
