// Scenes as JSON: nothing is lost, and what does not fit is named.
#include <catch2/catch.hpp>

#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "manyworlds/mesh.hpp"
#include "manyworlds/scenes.hpp"
#include "tests/record/faults.hpp"
#include "tests/record/support.hpp"
#include "tests/support/changed_members.hpp"

namespace manyworlds::test {
namespace {

std::vector<std::string> problems_of(const std::string& json) {
  try {
    scene_from_json(json);
  } catch (const RecordError& error) {
    return error.problems();
  }
  return {};
}

// With every member that is optional, and numbers that decimal digits do not hold.
Scene awkward_scene() {
  Scene scene = capsule_crowd(Space::spatial);
  scene.name = "tab \t, quote \" and \xc3\xa4";
  scene.options.solver.method = Solver::sor, scene.options.solver.iterations = 7;
  scene.options.solver.relaxation = 1.1, scene.options.solver.push_out_share = 0.3;
  scene.options.solver.split_impulse = true;
  scene.options.dt = 1.0 / 59.94;
  scene.options.contact_capacity = 77;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-1e3, -0.1, -1), Vec3(1e3, 100.1, 1.0 / 3));
  Body& body = scene.bodies[3];
  body.name = "crate";
  body.enabled = false;
  body.motion = Motion::dynamic;
  body.rotation = Quat(0.1, -0.2, 0.3, -0.4);
  body.angular_velocity = Vec3(-0.0, 1e-310, 3.3e38);
  body.mass_properties = MassProperties{3.3, Vec3(0.1, 0, -0.1), 0.7 * Mat3::Identity()};
  body.shapes[0].density = 1.0 / 7;
  body.shapes[0].filter = {0x80000001u, 0xfffffffeu};
  body.shapes[0].name = "hull";
  scene.options.joint.frequency = 100.0 / 3;
  const Spring spring{1.0 / 7, 0.3, 0, 0};
  const Limit limit{-1.0 / 3, std::numeric_limits<double>::infinity(), spring};
  const Drive drive{0.1, -0.2, spring, 1e3};
  const JointType types[] = {BallJoint{0.7, limit},
                             HingeJoint{limit, drive},
                             SliderJoint{limit, drive},
                             FixedJoint{},
                             DistanceJoint{1.1, limit, spring},
                             WheelJoint{spring, limit, drive},
                             PulleyJoint{Vec3(1, 2, 3), Vec3(4, 5, 6), 1.0 / 3, 7.7},
                             TargetJoint{spring, 12}};
  scene.bodies[4].motion = Motion::dynamic;
  for (const JointType& type : types) {
    Joint joint =
        joint_at(scene, BodyId(3), BodyId(4), {Vec3(0.1, 0.2, 0.3), Quat(1, 0.1, 0.2, 0.3)}, type);
    joint.name = "joint";
    joint.collide = true;
    scene.add(joint);
  }
  scene.controls = {{"knee",
                     ControlKind::target_position,
                     JointId(1),
                     {},
                     Vec3::Zero(),
                     Vec3::UnitX(),
                     -1.0 / 3,
                     2,
                     0.1},
                    {"jet",
                     ControlKind::thrust,
                     {},
                     BodyId(4),
                     Vec3(0.1, 0.2, 0.3),
                     Vec3(1, -0.0, 1e-310),
                     0,
                     1e3,
                     7}};
  scene.keyframes = {{"squat", {}, {}, {1.0 / 3, -0.0}}, {"", {}, {}, {}}};
  return scene;
}

}  // namespace

TEST_CASE("every named scene goes through JSON unchanged", "[fast][record]") {
  for (const scenes::Entry& entry : scenes::all()) {
    INFO(entry.name);
    const Scene scene = entry.make();
    const std::string json = scene_to_json(scene);
    const Scene back = scene_from_json(json);
    CHECK(scene_to_json(back) == json);
    const Plan plan = compile(scene), again = compile(back);
    CHECK(again.fingerprint() == plan.fingerprint());
    // Where bodies begin is no part of the fingerprint.
    BatchOptions options = options_of(widest_tables().front(), 3);
    Batch one(plan, options), two(again, options);
    CHECK(two.hash() == one.hash());
    one.step(20), two.step(20);
    CHECK(two.hash() == one.hash());
  }
}

TEST_CASE("every member and every bit of a scene goes through JSON", "[fast][record]") {
  const Scene scene = awkward_scene();
  const std::string json = scene_to_json(scene);
  const Scene back = scene_from_json(json);
  CHECK(scene_to_json(back) == json);
  CHECK(back.name == scene.name);
  const Body& a = scene.bodies[3];
  const Body& b = back.bodies[3];
  CHECK(b.name == "crate");
  CHECK_FALSE(b.enabled);
  CHECK(b.rotation.coeffs() == a.rotation.coeffs());
  CHECK(b.angular_velocity == a.angular_velocity);
  CHECK(std::signbit(b.angular_velocity.x()));
  REQUIRE(b.mass_properties);
  CHECK(b.mass_properties->inertia == a.mass_properties->inertia);
  CHECK(b.shapes[0].density == a.shapes[0].density);
  CHECK(b.shapes[0].filter.category == 0x80000001u);
  CHECK(b.shapes[0].name == "hull");
  REQUIRE(back.controls.size() == 2);
  CHECK(back.controls[0].name == "knee");
  CHECK(back.controls[0].initial == 0.1);
  CHECK(back.controls[1].direction == scene.controls[1].direction);
  CHECK(back.options.dt == scene.options.dt);
  CHECK(back.options.contact_capacity == 77);
  REQUIRE(back.options.bounds);
  CHECK(back.options.bounds->max() == scene.options.bounds->max());
  CHECK(compile(back).fingerprint() == compile(scene).fingerprint());

  Scene planar = capsule_crowd(Space::planar, true);
  CHECK(compile(scene_from_json(scene_to_json(planar))).fingerprint() ==
        compile(planar).fingerprint());

  Scene varied = planar;
  for (int p = 0; p < kParameterCount; ++p) {
    varied.variations.push_back(vary(static_cast<Parameter>(p), -0.1, 1.0 / 3, Draw::none));
    varied.variations.back().high.z() = 7.7;
    varied.variations.back().attractor = p;
  }
  const Scene varied_back = scene_from_json(scene_to_json(varied));
  REQUIRE(varied_back.variations.size() == varied.variations.size());
  for (std::size_t p = 0; p < varied.variations.size(); ++p) {
    CHECK(varied_back.variations[p].parameter == varied.variations[p].parameter);
    CHECK(varied_back.variations[p].attractor == varied.variations[p].attractor);
    CHECK(varied_back.variations[p].low == varied.variations[p].low);
    CHECK(varied_back.variations[p].high == varied.variations[p].high);
  }

  // A scene that makes no sense is still a scene.
  planar.options.contact.slop = std::numeric_limits<double>::infinity();
  planar.options.density = -std::numeric_limits<double>::infinity();
  planar.options.dt = std::numeric_limits<double>::quiet_NaN();
  const Scene odd = scene_from_json(scene_to_json(planar));
  CHECK(odd.options.contact.slop == planar.options.contact.slop);
  CHECK(odd.options.density == planar.options.density);
  CHECK(std::isnan(odd.options.dt));

  PlanOptions options{BroadPhase::sparse, {Feature::gravity, Feature::joints}};
  const PlanOptions options_back = plan_options_from_json(plan_options_to_json(options));
  CHECK(options_back.broad_phase == options.broad_phase);
  CHECK(options_back.keep == options.keep);
}

TEST_CASE("JSON that is no scene names every problem and its place", "[fast][record]") {
  nlohmann::json json = nlohmann::json::parse(scene_to_json(crowd(Space::planar)));
  CHECK(problems_of(json.dump()).empty());
  json["bodies"][3]["shapes"][0].erase("material");
  json["bodies"][2]["colour"] = "red";
  json["bodies"][1]["position"] = {1, 2};
  json["bodies"][4]["position"][1] = "high";
  json["bodies"][5]["motion"] = "static";
  json["bodies"][6]["shapes"][0]["geometry"] = {{"cone", nullptr}};
  json["options"]["substeps"] = 4.5;
  json["bodies"][7]["shapes"][0]["filter"]["mask"] = -1;
  json["bodies"][8]["name"] = 7;
  json["space"] = nullptr;
  const auto problems = problems_of(json.dump());
  const std::vector<std::string> expected = {
      "/space: is null, must be planar or spatial",
      "/bodies/1/position: is [1,2], must be an array of 3 numbers",
      "/bodies/2: has an unknown member 'colour'",
      "/bodies/3/shapes/0: has no member 'material'",
      "/bodies/4/position/1: is \"high\", must be a number",
      "/bodies/5/motion: is \"static\", must be dynamic, kinematic or fixed",
      "/bodies/6/shapes/0/geometry: is {\"cone\":null}, must be an object with one member, sphere, "
      "box, plane, circle, polygon, half_plane, capsule, segment, terrain, cylinder, hull, "
      "height_field or ellipsoid",
      "/bodies/7/shapes/0/filter/mask: is -1, must be a whole number of 32 bits",
      "/bodies/8/name: is 7, must be a string",
      "/options/substeps: is 4.5, must be a whole number of 32 bits",
  };
  CHECK(problems == expected);

  CHECK_THROWS_WITH(scene_from_json("{\"name\": "), Catch::Contains("is not JSON"));
  CHECK_THROWS_WITH(scene_from_json("[]"), Catch::Contains("/: is [], must be an object"));
  CHECK_THROWS_WITH(scene_from_json(""), Catch::Contains("is not JSON"));
  const std::string deep = std::string(1 << 20, '[') + std::string(1 << 20, ']');
  CHECK_THROWS_WITH(scene_from_json("{\"name\":" + deep + "}"),
                    Catch::Contains("is nested deeper than 64 levels"));
  CHECK_THROWS_WITH(plan_options_from_json("{\"broad_phase\":\"tree\",\"keep\":[\"dark\"]}"),
                    Catch::Contains("/broad_phase: is \"tree\"") &&
                        Catch::Contains("/keep/0: is \"dark\", must be orientation"));
}

// A member's text depends on its value alone. The next solver's scene has other options and more of
// some lists; what it has in common with the one before is not changed again.
TEST_CASE("every member of a scene comes back from JSON", "[fast][record][json]") {
  std::set<std::string> seen;
  std::size_t count = 0;
  for (const Solver solver : kSolversOfEverything) {
    const Scene scene = scene_with_everything(solver);
    const std::string text = scene_to_json(scene);
    CHECK(scene_to_json(scene_from_json(text)) == text);
    for (const Change& change : changes_of(scene)) {
      if (!seen.insert(change.member).second && !change.member.starts_with("options/")) continue;
      if (count++ % kOneIn != 0) continue;
      INFO(change.member);
      const std::string changed = scene_to_json(change.scene);
      CHECK(changed != text);
      CHECK(scene_to_json(scene_from_json(changed)) == changed);
    }
  }
}

}  // namespace manyworlds::test
