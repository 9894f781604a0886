// Loading MJCF: what a supported file becomes, judged by MuJoCo's own compiled model.
#include "manyworlds/mjcf.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>
#include <catch2/catch.hpp>

#include "src/mjcf/mujoco_library.hpp"
#include "tests/support/mjcf_text.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds {
namespace {

const std::filesystem::path kScenes =
    std::filesystem::path(test::kSourceFolder) / "scenes" / "mjcf";

mjcf::ModelPtr load_with_mujoco(const std::filesystem::path& file) {
  char error[1000] = "";
  mjcf::ModelPtr model(mj_loadXML(file.string().c_str(), nullptr, error, sizeof error));
  INFO(error);
  REQUIRE(model);
  return model;
}

const Body& find_body(const Scene& scene, const std::string& name) {
  const auto at = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                               [&](const Body& body) { return body.name == name; });
  REQUIRE(at != scene.bodies.end());
  return *at;
}

Quat to_quat(const mjtNum* q) { return {q[0], q[1], q[2], q[3]}; }
Vec3 to_vec3(const mjtNum* v) { return {v[0], v[1], v[2]}; }

}  // namespace

TEST_CASE("own MJCF scenes load, pass validation and warn of nothing", "[mjcf][fast]") {
  const std::string file = GENERATE("box_pile.xml", "sphere_pile.xml", "mixed.xml", "shapes.xml");
  INFO(file);
  const MjcfResult result = load_mjcf(kScenes / file);
  for (const std::string& warning : result.warnings) {
    const bool of_ground = file == "shapes.xml" && warning.find("geom 'ground'") == 0;
    if (!of_ground) CHECK(warning == "");
  }
  for (const Issue& issue : validate(result.scene)) CHECK(to_string(issue) == "");
  CHECK(result.scene.name == std::filesystem::path(file).stem().string());
  CHECK(result.scene.options.dt == 0.01);
  CHECK(result.scene.options.gravity == Vec3(0, 0, -9.81));
  CHECK_FALSE(result.scene.options.bounds.has_value());
  if (file == "box_pile.xml" || file == "sphere_pile.xml") {
    CHECK(std::count_if(result.scene.bodies.begin(), result.scene.bodies.end(),
                        [](const Body& b) { return b.motion == Motion::dynamic; }) == 20);
    CHECK(result.scene.bodies[0].name == "world");
    CHECK(result.scene.bodies[0].motion == Motion::fixed);
    CHECK(result.scene.bodies[0].shapes.size() == 5);
  }
}

TEST_CASE("mass, centre, inertia and pose of each free body are MuJoCo's", "[mjcf][fast]") {
  const std::string file = GENERATE("box_pile.xml", "sphere_pile.xml", "mixed.xml", "shapes.xml");
  const Scene scene = load_mjcf(kScenes / file).scene;
  const mjcf::ModelPtr model = load_with_mujoco(kScenes / file);
  int compared = 0;
  for (int b = 1; b < model->nbody; ++b) {
    // Bodies with welded children are compared as a whole below.
    const bool whole = model->body_subtreemass[b] == model->body_mass[b];
    if (model->body_jntnum[b] == 0 || !whole) continue;
    const Body& body = find_body(scene, mj_id2name(model.get(), mjOBJ_BODY, b));
    INFO(body.name);
    REQUIRE(body.mass_properties.has_value());
    const MassProperties& mass = *body.mass_properties;
    const Mat3 axes = to_quat(model->body_iquat + 4 * b).toRotationMatrix();
    const Mat3 inertia =
        axes * to_vec3(model->body_inertia + 3 * b).asDiagonal() * axes.transpose();
    CHECK(mass.mass == model->body_mass[b]);
    CHECK((mass.center - to_vec3(model->body_ipos + 3 * b)).norm() < 1e-15);
    CHECK((mass.inertia - inertia).norm() < 1e-14 * inertia.norm());
    CHECK(body.position == to_vec3(model->body_pos + 3 * b));
    CHECK(body.rotation.isApprox(to_quat(model->body_quat + 4 * b), 1e-15));
    ++compared;
  }
  CHECK(compared == (file == "mixed.xml" ? 8 : file == "shapes.xml" ? 11 : 20));
}

TEST_CASE("an explicit inertial element decides, whatever the geoms weigh", "[mjcf][fast]") {
  const Scene scene = load_mjcf(kScenes / "mixed.xml").scene;
  const Body& die = find_body(scene, "die");
  Mat3 written;
  written << 0.0016, 0.0001, 0, 0.0001, 0.0017, -0.0002, 0, -0.0002, 0.0012;
  CHECK(die.mass_properties->mass == 0.9);
  CHECK(die.mass_properties->center == Vec3(0, 0, -0.02));
  CHECK((die.mass_properties->inertia - written).norm() < 1e-12);
  REQUIRE(die.shapes.size() == 2);
  CHECK(std::holds_alternative<Ellipsoid>(die.shapes[1].geometry));  // seen, and nothing more
  CHECK(die.shapes[1].filter.category == 0);
  CHECK(die.shapes[0].name == "cube");
}

TEST_CASE("a jointless body inside a free one becomes part of it", "[mjcf][fast]") {
  const Scene scene = load_mjcf(kScenes / "mixed.xml").scene;
  const Body& dumbbell = find_body(scene, "dumbbell");
  REQUIRE(dumbbell.shapes.size() == 3);
  CHECK((dumbbell.shapes[2].position - Vec3(0.07, 0, 0)).norm() < 1e-15);
  // Closed form: a bar of 800 kg/m^3 between two balls of 0.5 kg, radius 0.04 m.
  const double bar = 800 * 0.12 * 0.02 * 0.02;
  const double ball = 0.4 * 0.5 * 0.04 * 0.04;
  const double along = bar * (0.02 * 0.02 + 0.02 * 0.02) / 12 + 2 * ball;
  const double across = bar * (0.12 * 0.12 + 0.02 * 0.02) / 12 + 2 * (ball + 0.5 * 0.07 * 0.07);
  const MassProperties& mass = *dumbbell.mass_properties;
  CHECK(mass.mass == Approx(1 + bar).epsilon(1e-12));
  CHECK(mass.center.norm() < 1e-15);
  const Mat3 expected = Vec3(along, across, across).asDiagonal();
  CHECK((mass.inertia - expected).norm() < 1e-12 * across);
}

TEST_CASE("welded bodies are static at their composed pose", "[mjcf][fast]") {
  const Scene scene = load_mjcf(kScenes / "mixed.xml").scene;
  const Body& board = find_body(scene, "board");
  CHECK(board.motion == Motion::fixed);
  CHECK((board.position - Vec3(-0.18, 0, 0.1)).norm() < 1e-15);
  const Quat tilt(Eigen::AngleAxisd(25 * std::numbers::pi / 180, Vec3::UnitY()));
  CHECK(board.rotation.isApprox(tilt, 1e-12));
}

TEST_CASE("a plane's normal is the z axis of its geom", "[mjcf][fast]") {
  const Scene scene = load_mjcf_string(test::world("<geom type='plane' size='1 1 1' pos='0.3 2 5' "
                                                   "zaxis='-1 0 0'/>"))
                          .scene;
  REQUIRE(scene.bodies.size() == 1);
  const Plane& plane = std::get<Plane>(scene.bodies[0].shapes[0].geometry);
  CHECK((plane.normal - Vec3(-1, 0, 0)).norm() < 1e-15);
  CHECK(plane.offset == Approx(-0.3).epsilon(1e-12));
}

TEST_CASE("capsules keep MuJoCo's size, axis and mass", "[mjcf][fast]") {
  // Both ways to say it: size with a pose, and end points.
  for (const std::string geom :
       {"size='.1 .25' pos='.25 0 0' zaxis='1 0 0'", "size='.1' fromto='0 0 0 .5 0 0'"}) {
    const Scene scene =
        load_mjcf_string(
            test::world("<body name='b'><freejoint/><geom type='capsule' density='500' " + geom +
                        "/></body>"))
            .scene;
    const Body& body = find_body(scene, "b");
    REQUIRE(body.shapes.size() == 1);
    const Shape& shape = body.shapes[0];
    const auto& capsule = std::get<Capsule>(shape.geometry);
    CHECK(capsule.radius == Approx(0.1));
    CHECK(capsule.half_length == Approx(0.25));
    CHECK((shape.position - Vec3(0.25, 0, 0)).norm() < 1e-12);
    CHECK(std::abs((shape.rotation * Vec3::UnitZ()).x()) == Approx(1));
    // MuJoCo's compiler and ours agree on mass and moments.
    Body own = body;
    own.mass_properties.reset();
    own.shapes[0].density = 500;
    const MassProperties given = mass_properties(scene, body),
                         derived = mass_properties(scene, own);
    CHECK(derived.mass == Approx(given.mass).epsilon(1e-12));
    CHECK((derived.center - given.center).norm() < 1e-12);
    CHECK((derived.inertia - given.inertia).norm() < 1e-9 * given.inertia.norm());
    CHECK(*scene.options.length_unit == Approx(0.7));
  }
}

TEST_CASE("option gives time step and gravity, and flags can switch things off", "[mjcf][fast]") {
  const std::string ball =
      "<worldbody><body><freejoint/><geom size='0.0317' friction='0.3'/></body></worldbody>";
  const Scene plain =
      load_mjcf_string("<mujoco><option timestep='0.004' gravity='1 2 -3'/>" + ball + "</mujoco>")
          .scene;
  CHECK(plain.options.dt == 0.004);
  CHECK(plain.options.gravity == Vec3(1, 2, -3));
  CHECK(*plain.options.length_unit == Approx(0.063).epsilon(1e-12));  // two digits of 0.0634
  CHECK(plain.bodies.at(0).shapes.at(0).material.friction == 0.3);
  CHECK(plain.bodies.at(0).shapes.at(0).material.restitution == 0);
  const Scene off =
      load_mjcf_string("<mujoco><option><flag gravity='disable' contact='disable'/></option>" +
                       ball + "</mujoco>")
          .scene;
  CHECK(off.options.gravity == Vec3::Zero());
  CHECK(off.bodies.at(0).shapes.at(0).filter.mask == 0);
}

TEST_CASE("gravcomp scales gravity", "[mjcf][fast]") {
  const Scene scene =
      load_mjcf_string(test::world("<body gravcomp='0.75'><freejoint/><geom size='0.1'/></body>"))
          .scene;
  CHECK(scene.bodies.at(0).gravity_scale == 0.25);
}

TEST_CASE("filters collide exactly the geoms that MuJoCo's bits let collide", "[mjcf][fast]") {
  std::mt19937 random(5);
  std::vector<int> contype, conaffinity;
  std::string content;
  for (int i = 0; i < 24; ++i) {
    contype.push_back(static_cast<int>(random() % 8));
    conaffinity.push_back(static_cast<int>(random() % 8));
    content += "<body><freejoint/><geom size='0.1' contype='" + std::to_string(contype.back()) +
               "' conaffinity='" + std::to_string(conaffinity.back()) + "'/></body>";
  }
  const Scene scene = load_mjcf_string(test::world(content)).scene;
  REQUIRE(scene.bodies.size() == 24);
  int colliding = 0;
  for (std::size_t i = 0; i < 24; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Filter& a = scene.bodies[i].shapes.at(0).filter;
      const Filter& b = scene.bodies[j].shapes.at(0).filter;
      const bool ours = (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
      const bool mujocos = (contype[i] & conaffinity[j]) != 0 || (contype[j] & conaffinity[i]) != 0;
      CHECK(ours == mujocos);
      colliding += mujocos;
    }
  }
  CHECK(colliding > 50);
  CHECK(colliding < 270);
}

}  // namespace manyworlds
