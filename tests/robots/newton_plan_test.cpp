// What a plan of Solver::newton makes of a scene: where joints begin, which pairs it looks at.
#include <numbers>

#include <catch2/catch.hpp>

#include "manyworlds/batch.hpp"
#include "src/plan/compliance.hpp"
#include "src/plan/plan_data.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Body box(const Vec3& position) {
  Body body;
  body.position = position;
  body.shapes = {{.geometry = Box{Vec3(0.1, 0.1, 0.1)}}};
  return body;
}
Scene empty_scene() {
  Scene scene;
  scene.options.solver.method = Solver::newton;
  return scene;
}
double about_z(double degrees) { return degrees * std::numbers::pi / 180; }
Quat turned_about_z(double degrees) {
  return Quat(Eigen::AngleAxisd(about_z(degrees), Vec3::UnitZ()));
}

int candidates(const Plan& plan) {
  int out = 0;
  for (const auto& pair : plan.report().pairs) out += pair.candidates;
  return out;
}

}  // namespace

TEST_CASE("hinges begin within half a turn of where their frames coincide", "[robots][fast]") {
  Scene scene = empty_scene();
  Body a = box(Vec3::Zero()), b = box(Vec3::Zero());
  a.rotation = turned_about_z(170), b.rotation = turned_about_z(-170);
  scene.add(a), scene.add(b);
  Joint hinge;
  hinge.body_a = BodyId(0), hinge.body_b = BodyId(1);
  hinge.dynamics.reference = 0.5;
  scene.add(hinge);
  Batch batch(compile(scene), {.worlds = 1, .threads = 1});
  std::vector<double> q(batch.size(Field::generalized_position));
  batch.read(Field::generalized_position, 0, q);
  REQUIRE(q.size() == 8);
  CHECK(q[7] == Approx(0.5 + about_z(20)).epsilon(1e-6));
}

TEST_CASE("shapes that cannot move against each other are no pair", "[robots][fast]") {
  Scene scene = empty_scene();
  for (int i = 0; i < 4; ++i) scene.add(box(Vec3(0, 0, 0.15 * i)));
  Body ground;
  ground.motion = Motion::fixed;
  ground.shapes = {{.geometry = Plane{Vec3::UnitZ(), -5}}};
  scene.add(ground);
  const auto fix = [&](BodyId body_a, BodyId body_b) {
    const Frame here{scene.at(body_b).position, Quat::Identity()};
    scene.add(joint_at(scene, body_a, body_b, here, FixedJoint{}));
  };
  fix(BodyId(0), BodyId(1)), fix(BodyId(0), BodyId(2)), fix(BodyId(), BodyId(3));
  // Each of the first three with the one that the world holds, and with the ground.
  CHECK(candidates(compile(scene)) == 3 + 3);
}

// A base of boxes that the world holds, with an arm on it, and boxes that fall onto both: contacts
// with the base are no couplings, and the arm moves as on a base that is fixed.
TEST_CASE("what is welded to the world counts as the world", "[robots][fast]") {
  const auto build = [](Motion motion) {
    Scene scene = empty_scene();
    scene.options.dt = 0.004, scene.options.substeps = 1;
    Body base = box(Vec3::Zero());
    base.motion = motion;
    base.shapes.push_back({.geometry = Box{Vec3(0.1, 0.3, 0.05)}, .position = Vec3(0.2, 0, 0.1)});
    scene.add(base);
    const bool welded = motion == Motion::dynamic;
    scene.add(box(Vec3(0, 0, 0.4)));
    scene.at(BodyId(1)).shapes[0].geometry = Capsule{0.05, 0.2};
    const Frame hip{Vec3(0, 0, 0.15), Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()))};
    Joint hinge = joint_at(scene, BodyId(0), BodyId(1), hip, HingeJoint{});
    hinge.dynamics.damping = 0.1;
    scene.add(hinge);
    for (int i = 0; i < 2; ++i) scene.add(box(Vec3(0.2, 0.4 * i - 0.2, 0.26)));
    if (welded) scene.add(joint_at(scene, BodyId(), BodyId(0), {}, FixedJoint{}));
    return scene;
  };
  const Plan fixed = compile(build(Motion::fixed)), welded = compile(build(Motion::dynamic));
  const auto pairs_of_links = [](const Plan& plan) {
    int out = 0;
    for (const auto& pair : plan.data().trees.pairs) out += pair.only_link < 0 ? 1 : 0;
    return out;
  };
  CHECK(pairs_of_links(fixed) == 3);  // of the arm and two boxes
  CHECK(pairs_of_links(welded) == 3);
  CHECK(welded.data().trees.couplings == fixed.data().trees.couplings);
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch a(fixed, options_of(table, 1)), b(welded, options_of(table, 1));
    const auto read = [](const Batch& batch) {
      std::vector<double> out(batch.size(Field::generalized_position));
      batch.read(Field::generalized_position, out);
      return out;
    };
    for (Batch* batch : {&a, &b}) {
      std::vector<double> v(batch->size(Field::generalized_velocity));
      v.front() = 4;  // the arm falls onto the base
      batch->write(Field::generalized_velocity, 0, v);
      batch->step(100);
    }
    CHECK(a.contacts(0).size() >= 4);
    const auto one = read(a), other = read(b);
    REQUIRE(one.size() == other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      CHECK(other[i] == approx(one[i], pick(table, 1e-3, 1e-9)));
    }
  }
}

TEST_CASE("the power of an impedance is whole, whatever mixing left of it", "[robots][fast]") {
  Compliance compliance;
  compliance.power = 2.9999999999999996;
  CHECK(power_of(compliance) == 3);
}

}  // namespace manyworlds::test
