// What validate() says about bodies: state, mass properties, jitter.
#include <catch2/catch.hpp>

#include "tests/support/scene_cases.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds {
namespace {

using test::BadInput;
using test::check_each;

using test::kInf;
using test::kNan;
const char* const kBody = "body 1 'crate': ";

Scene spatial() { return test::spatial_scene_with(Box{{0.5, 0.4, 0.3}}); }
Scene planar() { return test::planar_scene_with(Circle{0.5}); }
Body& crate(Scene& scene) { return scene.bodies[1]; }

Scene with_mass_properties(Scene scene) {
  crate(scene).mass_properties = MassProperties{};
  return scene;
}
MassProperties& given(Scene& scene) { return *crate(scene).mass_properties; }

Mat3 diagonal_of(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

}  // namespace

TEST_CASE("an empty world is valid", "[fast][scene]") {
  CHECK(validate(Scene{}).empty());
  Scene planar_world;
  planar_world.space = Space::planar;
  planar_world.options.gravity.setZero();
  CHECK(validate(planar_world).empty());
}

TEST_CASE("bad body states are named", "[fast][scene]") {
  const std::vector<BadInput> common = {
      {"position.x", "is nan m, must be finite", [](Scene& s) { crate(s).position.x() = kNan; }},
      {"position.y", "is inf m, must be finite", [](Scene& s) { crate(s).position.y() = kInf; }},
      {"position.y", "in float32", [](Scene& s) { crate(s).position.y() = 1e300; }},
      {"position.z", "is nan m", [](Scene& s) { crate(s).position.z() = kNan; }},
      {"rotation", "must not be zero", [](Scene& s) { crate(s).rotation.coeffs().setZero(); }},
      {"rotation.y", "is nan", [](Scene& s) { crate(s).rotation.y() = kNan; }},
      {"linear_velocity.x", "is nan m/s", [](Scene& s) { crate(s).linear_velocity.x() = kNan; }},
      {"angular_velocity.z", "is inf rad/s",
       [](Scene& s) { crate(s).angular_velocity.z() = kInf; }},
      {"gravity_scale", "is nan", [](Scene& s) { crate(s).gravity_scale = kNan; }},
      {"linear_drag", "is -1 1/s, must be >= 0", [](Scene& s) { crate(s).linear_drag = -1; }},
      {"angular_drag", "is nan 1/s", [](Scene& s) { crate(s).angular_drag = kNan; }},
      {"jitter.position.x", "is -1 m", [](Scene& s) { crate(s).jitter.position.x() = -1; }},
      {"jitter.position.y", "is nan m", [](Scene& s) { crate(s).jitter.position.y() = kNan; }},
      {"jitter.linear_velocity.x", "is inf m/s",
       [](Scene& s) { crate(s).jitter.linear_velocity.x() = kInf; }},
      {"jitter.angular_velocity.z", "is -1 rad/s, must be >= 0",
       [](Scene& s) { crate(s).jitter.angular_velocity.z() = -1; }},
      {"jitter.angular_velocity.z", "is nan rad/s",
       [](Scene& s) { crate(s).jitter.angular_velocity.z() = kNan; }},
      {"jitter.angle", "is -0.1 rad", [](Scene& s) { crate(s).jitter.angle = -0.1; }},
      {"jitter.with", "is 99, must be -1 or another body",
       [](Scene& s) { crate(s).jitter.with = BodyId(99); }},
      {"jitter.with", "is 0, must be -1 or another body that is not fixed",
       [](Scene& s) { crate(s).jitter.with = BodyId(0); }},
      {"jitter.with", "is -2", [](Scene& s) { crate(s).jitter.with = BodyId(-2); }}};
  check_each(spatial(), kBody, common);
  check_each(planar(), kBody, common);
}

TEST_CASE("planar bodies stay in the plane", "[fast][scene]") {
  check_each(
      planar(), kBody,
      {{"position.z", "is 1 m, must be 0 in a planar scene",
        [](Scene& s) { crate(s).position.z() = 1; }},
       {"linear_velocity.z", "is 1 m/s", [](Scene& s) { crate(s).linear_velocity.z() = 1; }},
       {"angular_velocity.x", "is 1 rad/s", [](Scene& s) { crate(s).angular_velocity.x() = 1; }},
       {"angular_velocity.y", "is 1 rad/s", [](Scene& s) { crate(s).angular_velocity.y() = 1; }},
       {"rotation", "must be about z",
        [](Scene& s) {
          crate(s).rotation = {0.8, 0.6, 0, 0};
        }},
       {"jitter.position.z", "must be 0", [](Scene& s) { crate(s).jitter.position.z() = 1; }},
       {"jitter.linear_velocity.z", "must be 0",
        [](Scene& s) { crate(s).jitter.linear_velocity.z() = 1; }},
       {"jitter.angular_velocity.x", "must be 0",
        [](Scene& s) { crate(s).jitter.angular_velocity.x() = 1; }},
       {"jitter.any_orientation", "must be false",
        [](Scene& s) { crate(s).jitter.any_orientation = true; }}});
  Scene rotated = planar();
  crate(rotated).rotation = {-3, 0, 0, 4};  // about z, of length 5
  crate(rotated).angular_velocity.z() = -2;
  crate(rotated).jitter.angle = 1;
  CHECK(validate(rotated).empty());
}

TEST_CASE("chains of bodies that are drawn together end", "[fast][scene]") {
  Scene scene = spatial();
  for (int i = 2; i < 300; ++i) {
    Body link = crate(scene);
    link.name = "link" + std::to_string(i);
    link.jitter.with = BodyId(i - 1);
    scene.add(link);
  }
  // Body 257 moves with 256 others, body 258 with one more.
  std::vector<Issue> issues = validate(scene);
  REQUIRE(issues.size() == 300 - 258);
  CHECK(to_string(issues[0]) ==
        "body 258 'link258': jitter.with is 257, which starts a chain of more than 256 bodies; the "
        "chain must end earlier, at a jitter.with of -1");
  scene.bodies.resize(258);
  CHECK(validate(scene).empty());
  scene.bodies.resize(4);
  CHECK(validate(scene).empty());
  crate(scene).jitter.with = BodyId(2);
  issues = validate(scene);
  REQUIRE(issues.size() == 3);
  CHECK(to_string(issues[0]) ==
        "body 1 'crate': jitter.with is 2, which leads back to this body; the last body of a chain "
        "must have a jitter.with of -1");
  CHECK(issues[1].place == "body 2 'link2': jitter.with");
  CHECK(issues[2].message.find("is 2, which starts a chain of more than 256 bodies") == 0);
}

TEST_CASE("spatial bodies may jitter by angle and by orientation", "[fast][scene]") {
  Scene scene = spatial();
  crate(scene).jitter.angle = 1;
  CHECK(validate(scene).empty());
  crate(scene).jitter.any_orientation = true;
  CHECK(validate(scene).empty());
}

TEST_CASE("a dynamic body needs mass", "[fast][scene]") {
  check_each(spatial(), kBody,
             {{"mass_properties", "are missing", [](Scene& s) { crate(s).shapes.clear(); }}});
  Scene scene = spatial();
  crate(scene).shapes.clear();
  crate(scene).motion = Motion::kinematic;
  CHECK(validate(scene).empty());
  crate(scene).motion = Motion::fixed;
  CHECK(validate(scene).empty());
  crate(scene).motion = Motion::dynamic;
  CHECK(validate(with_mass_properties(scene)).empty());
}

TEST_CASE("bad given masses are named", "[fast][scene]") {
  const std::vector<BadInput> common = {
      {"mass_properties.mass", "is 0 kg, must be > 0", [](Scene& s) { given(s).mass = 0; }},
      {"mass_properties.mass", "is -1 kg, must be > 0", [](Scene& s) { given(s).mass = -1; }},
      {"mass_properties.mass", "is nan kg, must be > 0", [](Scene& s) { given(s).mass = kNan; }},
      {"mass_properties.mass", "is inf kg", [](Scene& s) { given(s).mass = kInf; }},
      {"mass_properties.mass", "is 1e-310 kg", [](Scene& s) { given(s).mass = 1e-310; }},
      {"mass_properties.mass", "is 1e-31 kg, must be between 1e-30 and 1e+30",
       [](Scene& s) { given(s).mass = 1e-31; }},
      {"mass_properties.mass", "is 1e+31 kg", [](Scene& s) { given(s).mass = 1e31; }},
      {"mass_properties.center.x", "is nan m", [](Scene& s) { given(s).center.x() = kNan; }},
      {"mass_properties.center.z", "is inf m", [](Scene& s) { given(s).center.z() = kInf; }}};
  check_each(with_mass_properties(spatial()), kBody, common);
  check_each(with_mass_properties(planar()), kBody, common);
}

TEST_CASE("bad inertia tensors are named", "[fast][scene]") {
  const auto set = [](const Mat3& inertia) {
    return [inertia](Scene& s) { given(s).inertia = inertia; };
  };
  const auto entry = [](int row, int column, double value) {
    return [=](Scene& s) { given(s).inertia(row, column) = value; };
  };
  const char* const inertia = "mass_properties.inertia";
  check_each(with_mass_properties(spatial()), kBody,
             {{"mass_properties.inertia(0,1)", "is nan kg m^2", entry(0, 1, kNan)},
              {"mass_properties.inertia(2,2)", "is inf kg m^2", entry(2, 2, kInf)},
              {"mass_properties.inertia(0,2)", "must be symmetric", entry(0, 2, 1e-5)},
              {"mass_properties.inertia(1,2)", "must be symmetric", entry(2, 1, -1e-5)},
              {inertia, "must be positive definite", set(Mat3::Zero())},
              {inertia, "must be positive definite", set(diagonal_of(0, 1, 1))},
              {inertia, "must be positive definite", set(diagonal_of(1, -1, 1))},
              {inertia, "must be positive definite", set(diagonal_of(-1, -1, -1))},
              {inertia, "must not exceed the sum", set(diagonal_of(1, 1, 2.1))},
              {inertia, "must not exceed the sum", set(diagonal_of(1, 1, 2 + 1e-5))},
              {inertia, "must not exceed the sum", set(diagonal_of(5, 1, 1))},
              {inertia, "must be between", set(diagonal_of(1e-31, 1e-31, 1e-31))},
              {inertia, "must be between", set(diagonal_of(1e31, 1e31, 1e31))}});

  Scene scene = with_mass_properties(spatial());
  given(scene).inertia = diagonal_of(1, 1, 2);  // a flat disc: the limit of the triangle inequality
  CHECK(validate(scene).empty());
  given(scene).inertia = diagonal_of(2e-5, 1, 1);  // a thin rod
  CHECK(validate(scene).empty());
  // Off-diagonal entries that hide a moment above the sum of the others.
  Mat3 rotated;
  rotated << 2, 1.5, 0, 1.5, 2, 0, 0, 0, 1;  // principal moments 0.5, 1, 3.5
  given(scene).inertia = rotated;
  CHECK(test::places(scene) == std::vector<std::string>{std::string(kBody) + inertia});
}

TEST_CASE("planar bodies use one moment of inertia only", "[fast][scene]") {
  const auto moment = [](double value) {
    return [value](Scene& s) { given(s).inertia(2, 2) = value; };
  };
  const char* const field = "mass_properties.inertia(2,2)";
  check_each(
      with_mass_properties(planar()), kBody,
      {{field, "is 0 kg m^2, must be > 0", moment(0)},
       {field, "is -1 kg m^2, must be > 0", moment(-1)},
       {field, "is nan kg m^2, must be > 0", moment(kNan)},
       {field, "is 1e-40 kg m^2", moment(1e-40)},
       {"mass_properties.center.z", "must be 0", [](Scene& s) { given(s).center.z() = 1; }}});
  Scene scene = with_mass_properties(planar());
  given(scene).inertia = diagonal_of(kNan, -1, 1);
  CHECK(validate(scene).empty());
}

TEST_CASE("masses that shapes make must fit in float32", "[fast][scene]") {
  const auto sphere = [](double radius, double density) {
    return [=](Scene& s) {
      crate(s).shapes[0].geometry = Sphere{radius};
      crate(s).shapes[0].density = density;
    };
  };
  check_each(spatial(), kBody,
             {{"shapes", "make a mass of", sphere(1e-8, 1e-10)},
              {"shapes", "make a mass of", sphere(1e8, 1e10)},
              {"shapes", "make principal moments", sphere(1e-6, 1e-5)},
              {"shapes", "make principal moments", sphere(1e7, 1e5)}});
  Scene scene = spatial();
  sphere(1e-8, 1e-10)(scene);
  crate(scene).motion = Motion::kinematic;  // has no use for its mass
  CHECK(validate(scene).empty());
}

TEST_CASE("what a fixed body would ignore is refused", "[fast][scene]") {
  const auto ground = [](Scene& s) -> Body& { return s.bodies[0]; };
  check_each(spatial(), "body 0 'ground': ",
             {{"linear_velocity", "is set", [&](Scene& s) { ground(s).linear_velocity.x() = 1; }},
              {"angular_velocity", "is set", [&](Scene& s) { ground(s).angular_velocity.x() = 1; }},
              {"jitter", "is set", [&](Scene& s) { ground(s).jitter.position.x() = 1; }},
              {"jitter", "is set", [&](Scene& s) { ground(s).jitter.angle = 1; }},
              {"jitter", "is set", [&](Scene& s) { ground(s).jitter.angular_velocity.z() = 1; }},
              {"jitter", "is set", [&](Scene& s) { ground(s).jitter.with = BodyId(1); }},
              {"jitter", "is set", [&](Scene& s) { ground(s).jitter.any_orientation = true; }}});
}

TEST_CASE("bodies and shapes without names are known by their index", "[fast][scene]") {
  Scene scene = spatial();
  crate(scene).name.clear();
  crate(scene).shapes[0].name.clear();
  crate(scene).shapes.push_back(crate(scene).shapes[0]);
  std::get<Box>(crate(scene).shapes[1].geometry).half_extents.y() = -0.2;
  const std::vector<Issue> issues = validate(scene);
  REQUIRE(issues.size() == 1);
  CHECK(to_string(issues[0]) == "body 1, shape 1: half_extents.y is -0.2 m, must be > 0");
}

TEST_CASE("resistance is a length of contacts in space, or of rolling in the plane",
          "[fast][scene][resistance]") {
  Scene space = spatial(), plane = test::one_crate(Space::planar);
  const auto issues = [](Scene& scene, double rolling, double torsional) {
    Material& m = scene.bodies.back().shapes[0].material;
    m.rolling_resistance = rolling, m.torsional_resistance = torsional;
    std::vector<std::string> out;
    for (const Issue& issue : validate(scene)) out.push_back(issue.message);
    return out;
  };
  using Issues = std::vector<std::string>;
  CHECK(issues(space, 0.1, 0.2) == Issues{});
  CHECK(issues(space, -1, kNan).size() == 2);
  CHECK(issues(plane, 0.1, 0) == Issues{});
  CHECK(issues(plane, 0.1, 0.2) ==
        Issues{"is 0.2, must be 0: nothing spins about a normal in the plane"});
  space.options.solver.method = Solver::newton;
  CHECK(issues(space, 0.1, 0.2) == Issues(2, "is not 0, the newton solver supports 0 only"));
}

TEST_CASE("all issues come at once, in the order of the scene", "[fast][scene]") {
  Scene scene = spatial();
  scene.options.substeps = 0;
  scene.options.dt = kNan;
  Body second;
  second.position.x() = kInf;
  second.shapes.emplace_back();
  second.shapes[0].geometry = Sphere{-1};
  second.shapes[0].material.restitution = 3;
  second.jitter.angle = -1;
  scene.add(second);
  crate(scene).rotation.coeffs().setZero();
  CHECK(test::places(scene) ==
        std::vector<std::string>{"body 1 'crate': rotation", "body 2: position.x",
                                 "body 2, shape 0: radius", "body 2, shape 0: material.restitution",
                                 "body 2: jitter.angle", "options.dt", "options.substeps"});
}

}  // namespace manyworlds
