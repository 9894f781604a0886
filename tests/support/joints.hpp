// Jointed scenes, and what their joints do.
#pragma once

#include <cmath>

#include "tests/support/scenes.hpp"

namespace manyworlds::test {

// Empty, with gravity of 10 m/s^2, for joints that are solved at once.
inline Scene tree_scene(Space space) {
  Scene scene = empty_scene(space, 10);
  scene.options.joint.method = JointMethod::tree;
  return scene;
}
// A ball of `mass`, kg, that touches nothing.
inline BodyId add_ball(Scene& scene, const Vec3& position, double mass = 1) {
  return scene.add(lump(scene.space, mass, Vec3::Constant(0.1 * mass), position));
}

inline Frame at(const Vec3& position, const Quat& rotation = Quat::Identity()) {
  return {position, rotation};
}
// Frame of a body (none: the world) in the world, now.
inline Frame frame_now(const Batch& batch, int world, BodyId body, const Frame& frame) {
  const Plan& plan = batch.plan(batch.kind_of(world));
  const auto row = body ? plan.find_row(body) : std::nullopt;
  if (!row) return frame_in_world(plan.scene(), body, frame);
  const Quat q = rotation(batch, world, *row);
  return {position(batch, world, *row) + q * frame.position, q * frame.rotation};
}
// How far the anchors of a joint lie apart, m.
inline double anchor_gap(const Batch& batch, int world, int joint) {
  const Scene& scene = batch.plan(batch.kind_of(world)).scene();
  const Joint& j = scene.joints[static_cast<std::size_t>(joint)];
  return (frame_now(batch, world, j.body_a, j.frame_a).position -
          frame_now(batch, world, j.body_b, j.frame_b).position)
      .norm();
}
inline double worst_gap(const Batch& batch, int world) {
  double worst = 0;
  const auto joints = static_cast<int>(batch.plan(batch.kind_of(world)).scene().joints.size());
  for (int j = 0; j < joints; ++j) worst = std::max(worst, anchor_gap(batch, world, j));
  return worst;
}

// Kinetic and potential energy under the scene's gravity, J.
inline double energy_of(const Batch& batch, int world) {
  const Energy e = batch.energy(world);
  return e.kinetic + e.potential;
}

// An angle that follows angle'' = -rate cos(angle), the swing of a pendulum from the horizontal, by
// Runge-Kutta 4 with small steps.
struct Swing {
  double rate;          // 1/s^2
  double angle, speed;  // rad, rad/s

  void advance(double time, int parts) {
    const double h = time / parts;
    const auto f = [this](double a) { return -rate * std::cos(a); };
    for (int i = 0; i < parts; ++i) {
      const double k1 = f(angle), l1 = speed, k2 = f(angle + h / 2 * l1), l2 = speed + h / 2 * k1,
                   k3 = f(angle + h / 2 * l2), l3 = speed + h / 2 * k2, k4 = f(angle + h * l3),
                   l4 = speed + h * k3;
      angle += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      speed += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
};

}  // namespace manyworlds::test
