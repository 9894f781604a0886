// Orders of the integrators: how their errors fall with the step, in float64.
#include <catch2/catch.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/motion_twin.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

struct Method {
  Integrator integrator;
  std::optional<Rotation> rotation;
  bool momentum;
  int order;
};
std::string name(const Method& m) {
  return std::string(to_string(m.integrator)) + (m.rotation ? to_string(*m.rotation) : "") +
         (m.momentum ? ", momentum" : "");
}
const std::vector<Method>& methods() {
  static const std::vector<Method> kMethods = {
      {Integrator::symplectic_euler, Rotation::quaternion, false, 1},
      {Integrator::symplectic_euler, Rotation::exponential, true, 1},
      {Integrator::explicit_euler, {}, false, 1},
      {Integrator::explicit_euler, Rotation::quaternion, true, 1},
      {Integrator::implicit_euler, {}, false, 1},
      {Integrator::implicit_euler, Rotation::quaternion, false, 1},
      {Integrator::verlet, {}, false, 2},
      {Integrator::velocity_verlet, {}, false, 2},
      {Integrator::runge_kutta4, {}, false, 4},
      {Integrator::runge_kutta4, Rotation::quaternion, false, 4},
      {Integrator::runge_kutta4, {}, true, 4},
      {Integrator::runge_kutta4, Rotation::quaternion, true, 4}};
  return kMethods;
}

MovingBody end_of(const Batch& batch, int body) {
  MovingBody b;
  b.x = position(batch, 0, body), b.v = velocity(batch, 0, body), b.w = spin(batch, 0, body);
  b.r = rotation(batch, 0, body).toRotationMatrix();
  return b;
}
MovingBody start_of(const Scene& scene, int body) {
  const Body& from = scene.bodies[static_cast<std::size_t>(body)];
  MovingBody b;
  b.mass = from.mass_properties->mass, b.inertia = from.mass_properties->inertia;
  b.x = from.position, b.v = from.linear_velocity, b.w = from.angular_velocity;
  b.r = from.rotation.toRotationMatrix();
  return b;
}

// How far off the bodies are after `time`, by steps of `h`.
double error_of(Scene scene, const Method& m, const std::vector<MovingBody>& wanted, double time,
                double h) {
  scene.options.integrator = m.integrator;
  scene.options.rotation = m.rotation;
  scene.options.angular_momentum = m.momentum;
  scene.options.substeps = 1;
  scene.options.dt = h;
  Batch batch(compile(scene), options_of(double_table()));
  batch.step(static_cast<int>(time / h + 0.5));
  REQUIRE(batch.status(0) == Status::ok);
  double error = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const MovingBody is = end_of(batch, static_cast<int>(i));
    error = std::max(error, (is.x - wanted[i].x).norm() + (is.v - wanted[i].v).norm() +
                                (is.r - wanted[i].r).norm());
  }
  return error;
}

void check_orders(const Scene& scene, const std::vector<MovingBody>& wanted, double time,
                  double h) {
  for (const Method& m : methods()) {
    // The higher the order, the larger the steps whose error is not rounding.
    const double coarse = m.order == 1 ? h / 32 : m.order == 2 ? h / 4 : h;
    const double first = error_of(scene, m, wanted, time, coarse),
                 second = error_of(scene, m, wanted, time, coarse / 2);
    INFO(name(m) << ": " << first << " at " << coarse << ", " << second << " at half");
    CHECK(second > 1e-13);
    CHECK(std::abs(std::log2(first / second) - m.order) < 0.15);
  }
}

bool has_double() { return has_table(double_table()); }

}  // namespace

TEST_CASE("integrators tumble a free body with their order (A1)", "[fast][integrator]") {
  if (!has_double()) return;
  Scene scene = empty_scene(Space::spatial, 9.8);
  Body box = lump(Space::spatial, 10, {0.8083333, 0.6833333, 0.1416667}, Vec3::Zero());
  box.linear_velocity = {-2, 2, 8}, box.angular_velocity = {0.1, 5, 0.1};
  scene.add(box);
  std::vector<MovingBody> wanted = {start_of(scene, 0)};
  const Vec3 weight = wanted[0].mass * scene.options.gravity;
  advance(
      wanted,
      [&](const auto&) {
        return std::vector<Wrench>{{weight, Vec3::Zero()}};
      },
      1, 4000);
  check_orders(scene, wanted, 1, 1.0 / 50);
}

TEST_CASE("integrators follow an ellipse with their order (A4)", "[fast][integrator]") {
  if (!has_double()) return;
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    Body planet = lump(space, 1, Vec3::Constant(0.1), {0.4, 0, 0});
    planet.linear_velocity = {0, 2, 0};
    scene.add(planet);
    scene.attractors = {{Vec3::Zero(), 1, 0}};
    std::vector<MovingBody> wanted = {start_of(scene, 0)};
    const auto pull = [](const std::vector<MovingBody>& b) {
      return std::vector<Wrench>{{-b[0].x / std::pow(b[0].x.norm(), 3), Vec3::Zero()}};
    };
    advance(wanted, pull, 2, 20000);
    check_orders(scene, wanted, 2, 1.0 / 100);
  }
}

TEST_CASE("integrators swing on a spring with their order (A5)", "[fast][integrator]") {
  if (!has_double()) return;
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    scene.add(lump(space, 1, Vec3::Constant(0.1), {1, 0, 0}));
    Joint spring;
    TargetJoint target;
    target.spring.stiffness = 4 * kPi * kPi;
    spring.type = target;
    spring.body_b = BodyId(0);
    scene.add(spring);
    MovingBody end = start_of(scene, 0);
    const double t = 1.125;
    end.x = {std::cos(2 * kPi * t), 0, 0}, end.v = {-2 * kPi * std::sin(2 * kPi * t), 0, 0};
    check_orders(scene, {end}, t, 1.0 / 64);
  }
}

TEST_CASE("integrators keep their order where everything acts at once", "[fast][integrator]") {
  if (!has_double()) return;
  Scene scene = empty_scene(Space::spatial, 9.81);
  scene.options.wind = {1, 0.5, 0};
  Body one = lump(Space::spatial, 1, {0.1, 0.2, 0.25}, {0, 0, 0});
  one.angular_velocity = {1, 2, -1}, one.linear_velocity = {0.3, 0, 0};
  Body two = lump(Space::spatial, 2, {0.5, 0.3, 0.4}, {1, 0.2, -0.3});
  two.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  two.linear_drag = 0.5, two.angular_drag = 0.3;
  scene.add(one), scene.add(two);
  scene.attractors = {{{2, 1, -1}, 3, 0.2}};
  Joint hung, tied;
  TargetJoint target;
  target.spring.stiffness = 60, target.spring.damping = 1.5;
  hung.type = target, hung.body_b = BodyId(0);
  hung.frame_a.position = {0.1, 0, 0.5}, hung.frame_b.position = {0.2, -0.1, 0.3};
  DistanceJoint line;
  line.length = 0.6, line.spring = Spring{30, 0.8, 0, 0};
  tied.type = line, tied.body_a = BodyId(0), tied.body_b = BodyId(1);
  tied.frame_a.position = {0, 0.3, -0.1}, tied.frame_b.position = {-0.2, 0.1, 0};
  scene.add(hung), scene.add(tied);

  const auto forces = [&](const std::vector<MovingBody>& b) {
    std::vector<Wrench> out(2);
    for (std::size_t i = 0; i < 2; ++i) {
      const Body& body = scene.bodies[i];
      const Vec3 way = Vec3(2, 1, -1) - b[i].x;
      const Vec3 pull = 3 * way / std::pow(way.squaredNorm() + 0.04, 1.5);
      out[i].force = b[i].mass * (scene.options.gravity + pull +
                                  body.linear_drag * (scene.options.wind - b[i].v));
      out[i].torque = -body.angular_drag * (b[i].r * b[i].inertia * b[i].r.transpose() * b[i].w);
    }
    const auto act = [&](std::size_t i, const Vec3& arm, const Vec3& force) {
      out[i].force += force, out[i].torque += arm.cross(force);
    };
    const Vec3 at_hook = b[0].r * hung.frame_b.position;
    act(0, at_hook,
        -60 * (b[0].x + at_hook - hung.frame_a.position) - 1.5 * (b[0].v + b[0].w.cross(at_hook)));
    const Vec3 arm_a = b[0].r * tied.frame_a.position, arm_b = b[1].r * tied.frame_b.position;
    const Vec3 gap = b[1].x + arm_b - b[0].x - arm_a, n = gap.normalized();
    const Vec3 speed = b[1].v + b[1].w.cross(arm_b) - b[0].v - b[0].w.cross(arm_a);
    const Vec3 force = -(30 * (gap.norm() - 0.6) + 0.8 * n.dot(speed)) * n;
    act(1, arm_b, force), act(0, arm_a, -force);
    return out;
  };
  std::vector<MovingBody> wanted = {start_of(scene, 0), start_of(scene, 1)};
  advance(wanted, forces, 1, 8000);
  check_orders(scene, wanted, 1, 1.0 / 100);
}

}  // namespace manyworlds::test
