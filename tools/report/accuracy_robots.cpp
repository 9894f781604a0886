// Cases in joint coordinates: passive trees of Solver::newton, whose energy and momenta are kept.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "manyworlds/scenes.hpp"
#include "tools/report/accuracy.hpp"
#include "tools/report/reference.hpp"

namespace manyworlds::report {
namespace {

std::vector<Method> newton_integrators() {
  std::vector<Method> out;
  for (const Integrator i :
       {Integrator::symplectic_euler, Integrator::implicit_fast, Integrator::runge_kutta4}) {
    out.push_back({to_string(i), [i](Options& o) { o.integrator = i, o.substeps = 1; }});
  }
  return out;
}

Case of_robots(const std::string& id, const std::string& title, const std::string& metric,
               const std::string& unit, double level, double seconds) {
  Case c;
  c.id = id, c.title = title, c.metric = metric, c.unit = unit, c.level = level;
  c.seconds = seconds, c.quick_seconds = 2;
  c.steps = halvings(1.0 / 60, 8), c.quick_steps = halvings(1.0 / 120, 4);
  c.methods = newton_integrators();
  return c;
}

Scene newton_scene(double gravity) {
  Scene scene = empty(Space::spatial, gravity);
  scene.options.solver.method = Solver::newton;
  return scene;
}

// Rods of 1 kg and 1 m in a row along x, on hinges about -y, the first at the origin: they swing as
// those of A8 in the plane.
Scene swinging_rods() {
  Scene scene = newton_scene(kG);
  const Quat about_y(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  for (int i = 0; i < 2; ++i) {
    scene.add(lump(Space::spatial, 1, Vec3::Constant(1.0 / 12), {i + 0.5, 0, 0}));
    const Frame pin{{static_cast<double>(i), 0, 0}, about_y};
    scene.add(joint_at(scene, BodyId(i - 1), BodyId(i), pin, HingeJoint{}));
  }
  return scene;
}
double tilt_from_down(const Batch& batch, int body) {
  const Vec3 along = rotation(batch, 0, body) * Vec3::UnitX();
  return std::atan2(along.x(), -along.z());
}
double turn(double angle) { return std::abs(std::remainder(angle, 2 * kPi)); }

// Five bodies with three moments each on ball joints, in a zigzag that flies and spins in space.
Scene flying_chain() {
  Scene scene = newton_scene(0);
  const auto corner = [](int i) { return Vec3(0.8 * i, 0.3 * (i % 2), 0.2 * (i % 3)); };
  for (int i = 0; i < 5; ++i) {
    const Vec3 moments = (1 + 0.2 * i) * Vec3(0.02, 0.05, 0.06);
    scene.add(lump(Space::spatial, 1 + 0.2 * i, moments, (corner(i) + corner(i + 1)) / 2));
    if (i == 0) continue;
    scene.add(
        joint_at(scene, BodyId(i - 1), BodyId(i), Frame{corner(i), Quat::Identity()}, BallJoint{}));
  }
  scene.bodies[0].linear_velocity = {1, 0.5, -0.3};
  scene.bodies[0].angular_velocity = {0.5, 1, 2};
  return scene;
}

// The ant without ground, limits, dampers, rotors and motors. It has no series of hinges that lose
// a degree of freedom where their axes meet, as the humanoid's do without limits and rotors.
Scene limp_ant() {
  Scene scene = scenes::find("ant")->make();
  scene.options.gravity = Vec3::Zero();
  scene.controls.clear(), scene.tendons.clear();
  for (Body& body : scene.bodies) {
    for (Shape& shape : body.shapes) shape.filter.mask = 0;
  }
  for (Joint& joint : scene.joints) {
    joint.dynamics = {};
    if (auto* hinge = std::get_if<HingeJoint>(&joint.type)) hinge->limit.reset();
  }
  Body& root = scene.bodies[1];
  root.linear_velocity = {1, 0.5, -0.3};
  root.angular_velocity = {1, 2, 4};
  return scene;
}

struct Kept {
  double energy = 0;                                     // J, kinetic
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();  // N s, N m s about the world's origin
};
Kept kept_of(const Batch& batch) {
  Kept out;
  const auto read = [&](Observed what, double* to, std::size_t count) {
    batch.read(what, 0, std::span<double>(to, count));
  };
  read(Observed::kinetic_energy, &out.energy, 1);
  read(Observed::momentum, out.momentum.data(), 3);
  read(Observed::angular_momentum, out.angular.data(), 3);
  return out;
}
Kept kept_at_start(const Scene& scene) {
  BatchOptions options;
  options.threads = 1, options.precision = Precision::f64;
  options.observe.what = {Observer::motion};
  Batch batch(compile(scene), options);
  batch.look();
  return kept_of(batch);
}

// What nothing outside of the bodies pushes keeps its energy, and its momenta.
void add_kept(const std::string& id, const std::string& title, Scene (*scene)(),
              std::vector<Case>& out) {
  // Found when it is asked for: listing the cases needs no kernels.
  const auto start = [scene, kept = std::make_shared<std::optional<Kept>>()] {
    if (!*kept) *kept = kept_at_start(scene());
    return **kept;
  };
  Case energy = of_robots(id + "e", title, "largest relative energy error", "share", 1e-3, 10);
  energy.scene = scene;
  energy.observe = {Observer::motion};
  energy.over = Over::largest;
  Case momenta = energy;
  energy.error = [start](const Batch& b, double) {
    return std::abs(kept_of(b).energy - start().energy) / start().energy;
  };
  momenta.id = id + "p";
  momenta.metric = "larger relative error of momentum and angular momentum";
  momenta.error = [start](const Batch& b, double) {
    const Kept now = kept_of(b), first = start();
    return std::max((now.momentum - first.momentum).norm() / first.momentum.norm(),
                    (now.angular - first.angular).norm() / first.angular.norm());
  };
  out.push_back(std::move(energy)), out.push_back(std::move(momenta));
}

// x'' + c x' + k x = 0 from x = 1 at rest, over the mass; overdamped.
double damped_place(double damping, double stiffness, double t) {
  const double root = std::sqrt(damping * damping / 4 - stiffness);
  const double slow = -damping / 2 + root, fast = -damping / 2 - root;
  return (fast * std::exp(slow * t) - slow * std::exp(fast * t)) / (fast - slow);
}

// A damper whose time constant is shorter than the longer steps.
Case damped_slider() {
  constexpr double kDamping = 150, kStiffness = 100;
  Case c = of_robots("A27", "slider with a spring and a strong damper", "largest position error",
                     "m", 1e-3, 2);
  c.scene = [] {
    Scene scene = newton_scene(0);
    scene.add(lump(Space::spatial, 1, Vec3::Constant(0.01), Vec3::Zero()));
    Joint slider = joint_at(scene, {}, BodyId(0), Frame{}, SliderJoint{});
    slider.frame_a.position.x() = -1;  // it begins at 1
    slider.dynamics.damping = kDamping, slider.dynamics.stiffness = kStiffness;
    scene.add(slider);
    return scene;
  };
  c.methods.insert(c.methods.begin() + 1, {"symplectic-euler, explicit dampers", [](Options& o) {
                                             o.substeps = 1;
                                             o.solver.implicit_damping = false;
                                           }});
  c.over = Over::largest;
  c.error = [](const Batch& b, double t) {
    const double x = position(b, 0, 0).x() + 1;
    return std::abs(x - damped_place(kDamping, kStiffness, t));
  };
  return c;
}

}  // namespace

std::vector<Case> robot_cases() {
  std::vector<Case> out;
  Case angles = of_robots("A23", "double pendulum in joint coordinates",
                          "larger of the two angle errors at 2 s", "rad", 1e-2, 2);
  angles.scene = swinging_rods;
  angles.error = [](const Batch& b, double) {
    return std::max(turn(tilt_from_down(b, 0) + 0.0827583068205708),
                    turn(tilt_from_down(b, 1) - 0.407362074911907));
  };
  out.push_back(angles);
  Case energy = of_robots("A24", "double pendulum in joint coordinates", "largest energy error",
                          "J", 0.1, 10);
  energy.scene = swinging_rods;
  energy.over = Over::largest;
  energy.error = [](const Batch& b, double) {
    const Energy e = b.energy(0);
    return std::abs(e.kinetic + e.potential);
  };
  out.push_back(energy);
  add_kept("A25", "five bodies on ball joints, free motion", flying_chain, out);
  add_kept("A26", "ant without motors, free motion", limp_ant, out);
  out.push_back(damped_slider());
  return out;
}

}  // namespace manyworlds::report
