// Worlds from MJCF in motion: against closed forms, and against MuJoCo stepping the same model.
//
// MuJoCo's default integrator is of first order and moves the body's origin, not its centre of
// mass; with gravity it is off by g t h / 2. So the comparison is without gravity and contacts,
// with MuJoCo's RK4 at a tenth of a millisecond, whose own error is below 1e-9.
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>
#include <catch2/catch.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"

#include "src/mjcf/mujoco_library.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds {
namespace {

struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

// One body of which the centre of mass is off the origin and no axis is principal.
const char* const kTumbler =
    "<option timestep='0.0001' gravity='0 0 0' integrator='RK4'/><worldbody>"
    "<body pos='1 2 3' quat='0.8 0.2 -0.4 0.4'><freejoint/>"
    "<inertial pos='0.02 -0.01 0.03' mass='2' "
    "fullinertia='0.02 0.05 0.04 0.004 -0.003 0.002'/>"
    "<geom type='box' size='0.1 0.07 0.04'/></body></worldbody>";

BatchOptions options(int worlds, Precision precision) {
  BatchOptions result;
  result.worlds = worlds;
  result.threads = 1;
  result.precision = precision;
  return result;
}

struct State {
  Vec3 position, linear_velocity, angular_velocity;
  Quat rotation;
};

State read_state(const Batch& batch, int body) {
  const auto read = [&](Field field, int components) {
    std::vector<double> all(static_cast<std::size_t>(batch.bodies() * components));
    batch.read(field, 0, all);
    const auto first = all.begin() + body * components;
    return std::vector<double>(first, first + components);
  };
  const std::vector<double> x = read(Field::position, 3), q = read(Field::orientation, 4);
  const std::vector<double> v = read(Field::linear_velocity, 3);
  const std::vector<double> w = read(Field::angular_velocity, 3);
  return {Vec3(x[0], x[1], x[2]), Vec3(v[0], v[1], v[2]), Vec3(w[0], w[1], w[2]),
          Quat(q[0], q[1], q[2], q[3])};
}

// MuJoCo's state after `seconds`, started with the given velocities (centre of mass, world axes).
State run_mujoco(const std::string& xml, const Vec3& velocity, const Vec3& spin, double seconds) {
  char error[1000] = "";
  const mjcf::SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
  INFO(error);
  REQUIRE(spec);
  const mjcf::ModelPtr model(mj_compile(spec.get(), nullptr));
  REQUIRE(model);
  const std::unique_ptr<mjData, DataDeleter> data(mj_makeData(model.get()));
  const Vec3 center(model->body_ipos[3], model->body_ipos[4], model->body_ipos[5]);
  const auto rotation = [&] {
    return Quat(data->qpos[3], data->qpos[4], data->qpos[5], data->qpos[6]);
  };
  // A free joint's velocity is that of the origin in world axes, its spin is in body axes.
  const Vec3 at_origin = velocity - spin.cross(rotation() * center);
  const Vec3 in_body = rotation().inverse() * spin;
  for (int i = 0; i < 3; ++i) {
    data->qvel[i] = at_origin[i];
    data->qvel[3 + i] = in_body[i];
  }
  const int steps = static_cast<int>(std::lround(seconds / model->opt.timestep));
  for (int i = 0; i < steps; ++i) mj_step(model.get(), data.get());
  const Vec3 w = rotation() * Vec3(data->qvel[3], data->qvel[4], data->qvel[5]);
  const Vec3 v = Vec3(data->qvel[0], data->qvel[1], data->qvel[2]) + w.cross(rotation() * center);
  return {Vec3(data->qpos[0], data->qpos[1], data->qpos[2]), v, w, rotation()};
}

State run_ours(const std::string& xml, const Vec3& velocity, const Vec3& spin, double seconds,
               double dt, MassProperties* mass) {
  Scene scene = load_mjcf_string(xml).scene;
  scene.options.dt = dt;
  scene.bodies.at(0).linear_velocity = velocity;
  scene.bodies.at(0).angular_velocity = spin;
  *mass = *scene.bodies.at(0).mass_properties;
  Batch batch(compile(scene), options(1, Precision::f64));
  batch.step(static_cast<int>(std::lround(seconds / dt)));
  return read_state(batch, 0);
}

Vec3 angular_momentum(const State& state, const MassProperties& mass) {
  return state.rotation * (mass.inertia * (state.rotation.inverse() * state.angular_velocity));
}

}  // namespace

TEST_CASE("a box from MJCF falls as the closed form says", "[mjcf][fast]") {
  const Scene scene = load_mjcf_string(
                          "<mujoco><option timestep='0.005' gravity='0 0 -9.81'/><worldbody>"
                          "<body pos='0.1 -0.2 3'><freejoint/><geom type='box' size='.1 .07 .04'/>"
                          "</body></worldbody></mujoco>")
                          .scene;
  Batch batch(compile(scene), options(3, Precision::f64));
  batch.step(100);
  const State state = read_state(batch, 0);
  CHECK((state.position - Vec3(0.1, -0.2, 3 - 0.5 * 9.81 * 0.25)).norm() < 1e-12);
  CHECK((state.linear_velocity - Vec3(0, 0, -9.81 * 0.5)).norm() < 1e-12);
}

TEST_CASE("a tumbling body moves as in MuJoCo", "[mjcf]") {
  const std::string xml = std::string("<mujoco>") + kTumbler + "</mujoco>";
  const Vec3 velocity(0.5, -1, 2), spin(1, 2, -1.5);
  const double seconds = 0.2;
  MassProperties mass;
  const State ours = run_ours(xml, velocity, spin, seconds, 1e-4, &mass);
  const State theirs = run_mujoco(xml, velocity, spin, seconds);

  // The centre of mass goes straight, wherever the origin is.
  const Vec3 our_center = ours.position + ours.rotation * mass.center;
  const Vec3 their_center = theirs.position + theirs.rotation * mass.center;
  CHECK((our_center - their_center).norm() < 1e-5);
  CHECK((ours.linear_velocity - theirs.linear_velocity).norm() < 1e-5);

  // A first-order gyroscopic term is off by about h |dw/dt| t = 1e-4 * 4 * 0.2 rad; with the
  // products of inertia lost, negated or swapped the two are 0.006 to 0.03 rad apart.
  CHECK(ours.rotation.angularDistance(theirs.rotation) < 1e-4);
  const Vec3 momentum = angular_momentum(theirs, mass);
  CHECK((angular_momentum(ours, mass) - momentum).norm() < 1e-3 * momentum.norm());
}

TEST_CASE("a spin about a principal axis turns as far as in MuJoCo", "[mjcf][fast]") {
  const std::string xml =
      "<mujoco><option timestep='0.001' gravity='0 0 0'/><worldbody><body><freejoint/>"
      "<geom type='box' size='0.1 0.07 0.04' euler='0 0 30'/></body></worldbody></mujoco>";
  const Vec3 spin = 3 * Vec3(std::cos(std::numbers::pi / 6), std::sin(std::numbers::pi / 6), 0);
  MassProperties mass;
  const State ours = run_ours(xml, Vec3(1, 0, 0), spin, 1, 1e-3, &mass);
  const State theirs = run_mujoco(xml, Vec3(1, 0, 0), spin, 1);
  CHECK((ours.position - theirs.position).norm() < 1e-5);
  CHECK(ours.rotation.angularDistance(theirs.rotation) < 1e-5);
  CHECK((ours.angular_velocity - spin).norm() < 1e-5);
}

TEST_CASE("boxes from MJCF come to rest above the planes of their bin", "[mjcf]") {
  Scene scene =
      load_mjcf(std::filesystem::path(test::kSourceFolder) / "scenes" / "mjcf" / "box_pile.xml")
          .scene;
  const Plan plan = compile(scene);
  const double slop = *plan.resolved().contact.slop;
  Batch batch(plan, options(1, Precision::f32));
  batch.step(500);
  CHECK(batch.lost_worlds() == 0);
  double deepest = 0;
  for (int body = 0; body < batch.bodies(); ++body) {
    const State state = read_state(batch, body);
    const Body& box = scene.at(plan.body_in_row(body));
    INFO(box.name);
    const Vec3 half = std::get<Box>(box.shapes.at(0).geometry).half_extents;
    for (const Shape& wall : scene.bodies.at(0).shapes) {
      const Plane& plane = std::get<Plane>(wall.geometry);
      const Vec3 normal = state.rotation.inverse() * plane.normal;
      const double lowest =
          plane.normal.dot(state.position) - plane.offset - half.dot(normal.cwiseAbs());
      deepest = std::min(deepest, lowest);
    }
    CHECK(state.linear_velocity.norm() < 0.05);
  }
  CHECK(deepest > -slop);
}

TEST_CASE("the joined shapes of an MJCF scene come to rest on their height field", "[mjcf]") {
  const Scene scene =
      load_mjcf(std::filesystem::path(test::kSourceFolder) / "scenes" / "mjcf" / "shapes.xml")
          .scene;
  REQUIRE(scene.joints.size() == 4);
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    const Plan plan = compile(scene);
    Batch batch(plan, options(8, precision));
    batch.step(500);
    CHECK(batch.lost_worlds() == 0);
    std::vector<State> states(scene.bodies.size());
    for (int body = 0; body < batch.bodies(); ++body) {
      const State state = read_state(batch, body);
      states[static_cast<std::size_t>(plan.body_in_row(body).index())] = state;
      INFO(scene.at(plan.body_in_row(body)).name);
      CHECK(state.position.head<2>().cwiseAbs().maxCoeff() < 0.4);
      CHECK(state.position.z() > 0);
      CHECK(state.position.z() < 0.6);
    }
    for (const Joint& joint : scene.joints) {
      const auto anchor = [&](BodyId body, const Frame& frame) -> Vec3 {
        if (!body) return frame.position;
        const State& state = states[static_cast<std::size_t>(body.index())];
        return state.position + state.rotation * frame.position;
      };
      INFO(joint.name);
      CHECK((anchor(joint.body_a, joint.frame_a) - anchor(joint.body_b, joint.frame_b)).norm() <
            1e-3);
    }
  }
}

}  // namespace manyworlds
