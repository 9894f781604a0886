// Cases with joints: pendulums, a top, loops of bars (numerics.md A6 to A11).
#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/report/accuracy.hpp"
#include "tools/report/reference.hpp"

namespace manyworlds::report {
namespace {

// Rods of 1 kg and 1 m in a row along x, the first hinged to the world at the origin.
Scene rods(int count) {
  Scene scene = empty(Space::planar);
  for (int i = 0; i < count; ++i) {
    scene.add(lump(Space::planar, 1, Vec3::Constant(1.0 / 12), {i + 0.5, 0, 0}));
    scene.add(joint_at(scene, BodyId(i - 1), BodyId(i), frame_at(i, 0), HingeJoint{}));
  }
  return scene;
}
// Of a rod from hanging down, rad.
double angle_from_down(const Batch& batch, int body) {
  const Vec3 along = rotation(batch, 0, body) * Vec3::UnitX();
  return std::atan2(along.x(), -along.y());
}
double wrapped(double angle) { return std::abs(std::remainder(angle, 2 * kPi)); }

// angle'' = -rate cos(angle), seen every `every` s from 0 to `until`, by Runge-Kutta 4 in steps
// that leave no more than rounding.
std::vector<double> swing(double rate, double angle, double speed, double every, double until) {
  constexpr int kParts = 500;
  const double h = every / kParts;
  const auto f = [rate](double a) { return -rate * std::cos(a); };
  std::vector<double> out = {angle};
  while (every * static_cast<double>(out.size()) <= until + every / 2) {
    for (int i = 0; i < kParts; ++i) {
      const double k1 = f(angle), l1 = speed, k2 = f(angle + h / 2 * l1), l2 = speed + h / 2 * k1,
                   k3 = f(angle + h / 2 * l2), l3 = speed + h / 2 * k2, k4 = f(angle + h * l3),
                   l4 = speed + h * k3;
      angle += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      speed += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    out.push_back(angle);
  }
  return out;
}
// Which of the angles is that at t; -1 between them.
int seen_at(double t, double every) {
  const double k = t / every;
  return std::abs(k - std::round(k)) < 1e-6 ? static_cast<int>(std::lround(k)) : -1;
}

Case of_joints(const std::string& id, const std::string& title, const std::string& metric,
               const std::string& unit, double level, double seconds, double quick_seconds) {
  Case c;
  c.id = id, c.title = title, c.metric = metric, c.unit = unit, c.level = level;
  c.seconds = seconds, c.quick_seconds = quick_seconds;
  c.steps = halvings(1.0 / 30, 8), c.quick_steps = halvings(1.0 / 60, 4);
  c.methods = substeps({1, 4});
  for (Method& m : other_solvers(false)) c.methods.push_back(std::move(m));
  return c;
}

Case long_pendulum() {
  Case c = of_joints("A7", "point on a rod (IFToMM A01)", "largest position error, every 0.5 s",
                     "m", 1e-1, 2000, 50);
  c.steps = halvings(1.0 / 60, 7);
  const std::vector<double> angles = swing(kG, 0, 0, 0.5, 2000);
  c.scene = [] {
    Scene scene = empty(Space::planar);
    scene.add(lump(Space::planar, 1, Vec3::Constant(0.01), {1, 0, 0}));
    Joint rod;
    rod.type = DistanceJoint{}, rod.body_b = BodyId(0);
    scene.add(rod);
    return scene;
  };
  c.over = Over::largest;
  c.error = [=](const Batch& b, double t) {
    const int k = seen_at(t, 0.5);
    if (k < 0) return 0.0;
    const double a = angles[static_cast<std::size_t>(k)];
    return (position(b, 0, 0) - Vec3(std::cos(a), std::sin(a), 0)).norm();
  };
  return c;
}

Case heavy_top() {
  Case c = of_joints("A10", "heavy top with nutation", "angle error of its axis at 2 s", "rad",
                     1e-2, 2, 2);
  c.steps = halvings(1.0 / 60, 8), c.quick_steps = halvings(1.0 / 240, 4);
  c.scene = [] {
    Scene scene = empty(Space::spatial);
    const Quat tilt(Eigen::AngleAxisd(kPi / 6, Vec3::UnitX()));
    scene.add(lump(Space::spatial, 0.5, {5e-4, 5e-4, 8e-4}, tilt * Vec3(0, 0, 0.06)));
    scene.bodies[0].rotation = tilt;
    scene.bodies[0].angular_velocity = tilt * Vec3(0, 0, 150);
    scene.add(joint_at(scene, {}, BodyId(0), Frame{}, BallJoint{}));
    return scene;
  };
  c.error = [](const Batch& b, double) {
    const Vec3 axis = rotation(b, 0, 0) * Vec3::UnitZ(),
               end(-0.488862523574039, -0.179453482747485, 0.853703625724185);
    return std::atan2(axis.cross(end).norm(), axis.dot(end));
  };
  return c;
}

Case four_bars(int n, double seconds) {
  Case c =
      of_joints("A11-" + std::to_string(n), std::to_string(n) + " loops of four bars (IFToMM A02)",
                "largest position error of the first tip, every 0.05 s", "m", 1e-1, seconds,
                n == 2 ? seconds : 2);
  c.steps = halvings(1.0 / 60, n == 2 ? 7 : 5);
  const double rate = kG * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n);
  const std::vector<double> angles = swing(rate, kPi / 2, -1, 0.05, seconds);
  c.scene = [n] { return scenes::loops_of_four_bars(n); };
  c.over = Over::largest;
  c.error = [=](const Batch& b, double t) {
    const int k = seen_at(t, 0.05);
    if (k < 0) return 0.0;
    const double a = angles[static_cast<std::size_t>(k)];
    const Vec3 tip = position(b, 0, 0) + rotation(b, 0, 0) * Vec3(0.5, 0, 0);
    return (tip - Vec3(std::cos(a), std::sin(a), 0)).norm();
  };
  return c;
}

}  // namespace

std::vector<Case> joint_cases() {
  std::vector<Case> out;
  Case rod = of_joints("A6", "rod on a hinge", "angle error at 10 s", "rad", 1e-2, 10, 10);
  rod.scene = [] { return rods(1); };
  rod.error = [](const Batch& b, double) {
    return wrapped(angle_from_down(b, 0) - 0.770957622574773133);
  };
  out.push_back(rod);
  out.push_back(long_pendulum());
  Case two = of_joints("A8", "double pendulum", "larger of the two angle errors at 2 s", "rad",
                       1e-2, 2, 2);
  two.scene = [] { return rods(2); };
  two.error = [](const Batch& b, double) {
    return std::max(wrapped(angle_from_down(b, 0) + 0.0827583068205708),
                    wrapped(angle_from_down(b, 1) - 0.407362074911907));
  };
  out.push_back(two);
  out.push_back(heavy_top());
  out.push_back(four_bars(2, 20));
  out.push_back(four_bars(40, 5));
  return out;
}

}  // namespace manyworlds::report
