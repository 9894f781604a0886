// Ids, indices and rows that an object does not have: negative, just beyond the last, huge, and
// default-constructed. Each public function refuses them with name, value and range, and changes
// nothing.
#include <catch2/catch.hpp>

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "manyworlds/environment.hpp"
#include "manyworlds/tasks.hpp"
#include "tests/support/contraption.hpp"

namespace manyworlds::test {
namespace {

constexpr int kMost = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();

// A call with one id. `what` is what the message calls it, `count` how many there are.
struct Call {
  const char* what;
  int count;
  std::function<void(int)> call;
  bool negative_is_none = false;  // it stands for the world, or for all
};

std::string thrown_by(const Call& call, int index) {
  try {
    call.call(index);
  } catch (const std::invalid_argument& error) {
    return error.what();
  } catch (const std::out_of_range& error) {
    return error.what();
  }
  return "nothing was thrown";
}

void check_calls(const std::vector<Call>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Call& call = all[i];
    const std::string range = call.count == 0 ? ", but there are none"
                                              : ", must be 0 to " + std::to_string(call.count - 1);
    for (const int index : {kLeast, -2, -1, call.count, call.count + 1, kMost}) {
      if (index < 0 && call.negative_is_none) continue;
      INFO("call " << i << " with " << index);
      CHECK(thrown_by(call, index) ==
            call.what + std::string(" is ") + std::to_string(index) + range);
    }
  }
}

// One of everything, and a second body with two shapes.
Scene small_scene() {
  Scene scene;
  scene.add(Body());
  Body with_shapes;
  with_shapes.shapes = {shape_of(Sphere{0.1}), shape_of(Sphere{0.2})};
  scene.add(with_shapes);
  scene.add(Joint());
  scene.add(Control());
  scene.add(Tendon());
  scene.add(Site());
  scene.add(Keyframe());
  return scene;
}

}  // namespace

TEST_CASE("a scene refuses handles of what it does not have", "[fast][misuse]") {
  Scene scene = small_scene();
  const Scene empty;
  const Frame frame;
  check_calls({
      {"body", 2, [&](int i) { scene.at(BodyId(i)); }},
      {"shape", 2, [&](int i) { scene.at(ShapeId(BodyId(1), i)); }},
      {"body", 2, [&](int i) { scene.at(ShapeId(BodyId(i), 0)); }},
      {"joint", 1, [&](int i) { scene.at(JointId(i)); }},
      {"control", 1, [&](int i) { scene.at(ControlId(i)); }},
      {"tendon", 1, [&](int i) { scene.at(TendonId(i)); }},
      {"site", 1, [&](int i) { scene.at(SiteId(i)); }},
      {"keyframe", 1, [&](int i) { scene.at(KeyframeId(i)); }},
      {"body", 0, [&](int i) { empty.at(BodyId(i)); }},
      {"body", 0, [&](int i) { empty.at(ShapeId(BodyId(i), i)); }},
      {"joint", 0, [&](int i) { empty.at(JointId(i)); }},
      {"control", 0, [&](int i) { empty.at(ControlId(i)); }},
      {"tendon", 0, [&](int i) { empty.at(TendonId(i)); }},
      {"site", 0, [&](int i) { empty.at(SiteId(i)); }},
      {"keyframe", 0, [&](int i) { empty.at(KeyframeId(i)); }},
      {"body", 2, [&](int i) { scene.shape(BodyId(i), "x"); }},
      {"body", 2, [&](int i) { frame_in_world(scene, BodyId(i), frame); }, true},
      {"body", 2, [&](int i) { joint_at(scene, BodyId(i), BodyId(0), frame, HingeJoint{}); }, true},
      {"body", 2, [&](int i) { joint_at(scene, BodyId(0), BodyId(i), frame, HingeJoint{}); }, true},
  });
  CHECK_THROWS_AS(scene.at(JointId(3)), std::out_of_range);
  CHECK_THROWS_WITH(scene.at(ShapeId()), "body is -1, must be 0 to 1");
}

TEST_CASE("a plan refuses ids of what its scene does not have", "[fast][misuse]") {
  const Plan plan = compile(contraption(Space::spatial));
  const int bodies = static_cast<int>(plan.scene().bodies.size());
  const int joints = static_cast<int>(plan.scene().joints.size());
  check_calls({
      {"body", bodies, [&](int i) { plan.row(BodyId(i)); }},
      {"body", bodies, [&](int i) { plan.find_row(BodyId(i)); }},
      {"row", plan.bodies(), [&](int i) { plan.body_in_row(i); }},
      {"body", bodies, [&](int i) { plan.row(ShapeId(BodyId(i), 0)); }},
      {"shape", 1, [&](int i) { plan.row(ShapeId(BodyId(1), i)); }},
      {"joint", joints, [&](int i) { plan.first_observed(JointId(i)); }},
      {"joint", joints, [&](int i) { plan.first_coordinate(JointId(i)); }},
      {"body", bodies, [&](int i) { plan.shape(BodyId(i), "x"); }},
  });
  CHECK_THROWS_AS(plan.first_coordinate(JointId()), std::invalid_argument);
  CHECK_THROWS_AS(plan.items(static_cast<ItemKind>(99)), std::invalid_argument);
  const Plan without = compile(empty_scene(Space::planar));
  CHECK_THROWS_WITH(without.first_observed(JointId(0)), "joint is 0, but there are none");
  CHECK_THROWS_WITH(without.row(BodyId(0)), "body is 0, but there are none");
}

TEST_CASE("a batch refuses ids of what its scenes do not have", "[fast][misuse]") {
  constexpr int kWorlds = 3;
  BatchOptions options{.worlds = kWorlds, .threads = 1};
  options.observe.what = {Observer::contacts, Observer::touching};
  options.observe.rays = {Ray()};
  Batch batch(compile(contraption(Space::spatial)), options);
  const Scene& scene = batch.plan().scene();
  const int bodies = static_cast<int>(scene.bodies.size());
  const int joints = static_cast<int>(scene.joints.size());
  const BodyId body(1);
  const Vec3 zero = Vec3::Zero();
  std::vector<double> numbers(1000);
  const std::vector<Ray> rays(1);
  const std::vector<std::uint8_t> mask(kWorlds, 1);
  const Snapshot snapshot = batch.save();
  const std::uint64_t hash = batch.hash();
  const auto in_world = [](std::function<void(int)> f) {
    return Call{"world", kWorlds, std::move(f)};
  };
  const auto with_body = [&](std::function<void(BodyId)> f) {
    return Call{"body", bodies, [f = std::move(f)](int i) { f(BodyId(i)); }};
  };
  check_calls({
      in_world([&](int i) { batch.kind_of(i); }),
      in_world([&](int i) { batch.bodies(i); }),
      in_world([&](int i) { batch.controls(i); }),
      in_world([&](int i) { batch.lane_index(i); }),
      in_world([&](int i) { batch.read(Field::position, i, numbers); }),
      in_world([&](int i) { batch.write(Field::position, i, numbers); }),
      in_world([&](int i) { batch.read(Parameter::friction, i, numbers); }),
      in_world([&](int i) { batch.write(Parameter::friction, i, numbers); }),
      in_world([&](int i) { batch.read(Observed::contact_count, i, numbers); }),
      in_world([&](int i) { batch.set_controls(i, numbers); }),
      in_world([&](int i) { batch.step_contacts(i); }),
      in_world([&](int i) { batch.ray_hits(i); }),
      in_world([&](int i) { batch.set_rays(i, rays); }),
      in_world([&](int i) { batch.touching(i, body); }),
      in_world([&](int i) { batch.set_enabled(i, body, false); }),
      in_world([&](int i) { batch.enabled(i, body); }),
      in_world([&](int i) { batch.spawn(i, body, {}); }),
      in_world([&](int i) { batch.set_joint_enabled(i, JointId(0), false); }),
      in_world([&](int i) { batch.joint_enabled(i, JointId(0)); }),
      in_world([&](int i) { batch.asleep(i); }),
      in_world([&](int i) { batch.asleep(i, body); }),
      in_world([&](int i) { batch.wake(i); }),
      in_world([&](int i) { batch.add_force(i, body, zero); }),
      in_world([&](int i) { batch.add_impulse_at(i, body, zero, zero); }),
      in_world([&](int i) { batch.save(std::vector<int>{i}); }),
      in_world([&](int i) { batch.restore(snapshot, 0, i); }),
      in_world([&](int i) { batch.copy_world(i, 0); }),
      in_world([&](int i) { batch.copy_world(0, i); }),
      in_world([&](int i) { batch.status(i); }),
      in_world([&](int i) { batch.hash(i); }),
      in_world([&](int i) { batch.energy(i); }),
      in_world([&](int i) { batch.contacts(i); }),
      with_body([&](BodyId b) { batch.row(b); }),
      with_body([&](BodyId b) { batch.touching(0, b); }),
      with_body([&](BodyId b) { batch.touching(0, b, body); }),
      with_body([&](BodyId b) { batch.touching(0, body, b); }),
      with_body([&](BodyId b) { batch.set_enabled(0, b, false); }),
      with_body([&](BodyId b) { batch.enabled(0, b); }),
      with_body([&](BodyId b) { batch.spawn(0, b, {}); }),
      with_body([&](BodyId b) { batch.asleep(0, b); }),
      with_body([&](BodyId b) { batch.add_force(0, b, zero); }),
      with_body([&](BodyId b) { batch.add_torque(0, b, zero); }),
      with_body([&](BodyId b) { batch.add_force_at(0, b, zero, zero); }),
      with_body([&](BodyId b) { batch.add_impulse(0, b, zero); }),
      with_body([&](BodyId b) { batch.add_angular_impulse(0, b, zero); }),
      with_body([&](BodyId b) { batch.add_impulse_at(0, b, zero, zero); }),
      {"row", batch.bodies(), [&](int i) { batch.body_in_row(i); }},
      {"joint", joints, [&](int i) { batch.set_joint_enabled(0, JointId(i), false); }},
      {"joint", joints, [&](int i) { batch.joint_enabled(0, JointId(i)); }},
      {"kind", 1, [&](int i) { batch.plan(i); }},
      {"kind", 1, [&](int i) { batch.lane_blocks(Field::position, i); }},
      {"kind", 1, [&](int i) { batch.body("x", i); }},
      {"kind", 1, [&](int i) { batch.row(body, i); }},
  });
  for (const int i : {kLeast, -1, 0, kMost}) {
    const std::string text = "keyframe is " + std::to_string(i) + ", but scene '";
    CHECK_THROWS_WITH(batch.reset(KeyframeId(i)), Catch::StartsWith(text));
    CHECK_THROWS_WITH(batch.reset(mask, KeyframeId(i)), Catch::StartsWith(text));
  }
  for (const int i : {kLeast, -1, kWorlds, kMost}) {
    CHECK_THROWS_WITH(batch.restore(snapshot, i, 0), Catch::Contains(std::to_string(i)));
  }
  CHECK(batch.hash() == hash);

  Environment environment(tasks::find("Pendulum")->make(), {.worlds = kWorlds});
  const EnvironmentSnapshot saved = environment.save();
  check_calls({
      in_world([&](int i) { environment.copy_world(i, 0); }),
      in_world([&](int i) { environment.copy_world(0, i); }),
      in_world([&](int i) { environment.restore(saved, 0, i); }),
  });
  for (const int i : {kLeast, -1, kWorlds, kMost}) {
    CHECK_THROWS_WITH(environment.restore(saved, i, 0), Catch::Contains(std::to_string(i)));
  }
}

}  // namespace manyworlds::test
