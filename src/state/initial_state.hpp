// The initial state of one body in one world: the scene's values plus its jitter, drawn by counter.
#pragma once

#include <cmath>

#include "manyworlds/batch.hpp"
#include "src/base/random.hpp"

namespace manyworlds {

// A rotation uniform over all rotations from three numbers in [0, 1) (Shoemake 1992).
inline Quat uniform_rotation(double u1, double u2, double u3) {
  constexpr double kTurn = 6.283185307179586;
  const double a = std::sqrt(1 - u1), b = std::sqrt(u1);
  return Quat(b * std::cos(kTurn * u3), a * std::sin(kTurn * u2), a * std::cos(kTurn * u2),
              b * std::sin(kTurn * u3));
}

inline BodyState described_state(const Body& body) {
  return {body.position, body.rotation.normalized(), body.linear_velocity, body.angular_velocity};
}

inline void add_jitter(const Jitter& j, int index, const Draws& draws, BodyState& s) {
  constexpr std::uint64_t kDrawsPerBody = 16;
  const std::uint64_t base = static_cast<std::uint64_t>(index) * kDrawsPerBody;
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::uint64_t>(c);
    s.position[c] += j.position[c] * draws.symmetric(base + k);
    s.linear_velocity[c] += j.linear_velocity[c] * draws.symmetric(base + 3 + k);
    s.angular_velocity[c] += j.angular_velocity[c] * draws.symmetric(base + 10 + k);
  }
  if (j.angle != 0) {
    const double angle = j.angle * draws.symmetric(base + 6);
    s.rotation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())) * s.rotation;
  }
  if (j.any_orientation) {
    s.rotation =
        uniform_rotation(draws.uniform(base + 7), draws.uniform(base + 8), draws.uniform(base + 9));
  }
}

// `center_of(b)`: the centre of mass of body b of the scene in its frame, m, in this world.
BodyState draw_initial_state(const Scene& scene, int index, const Draws& draws,
                             const auto& center_of) {
  const Body& body = scene.bodies[static_cast<std::size_t>(index)];
  BodyState s = described_state(body);
  if (body.jitter.with) {
    // A chain is as long as it is checked to be (check_body.cpp).
    const int leader = body.jitter.with.index();
    const BodyState from = described_state(scene.at(body.jitter.with));
    const BodyState to = draw_initial_state(scene, leader, draws, center_of);
    const Quat rotation = to.rotation * from.rotation.conjugate();
    s.position = to.position + rotation * (s.position - from.position);
    s.rotation = rotation * s.rotation;
    s.linear_velocity += to.linear_velocity - from.linear_velocity;
    const Vec3 spin = to.angular_velocity - from.angular_velocity;
    if (!spin.isZero(0)) {
      const Vec3 arm = s.position + s.rotation * center_of(index) - to.position -
                       to.rotation * center_of(leader);
      s.angular_velocity += spin;
      s.linear_velocity += spin.cross(arm);
    }
  }
  add_jitter(body.jitter, index, draws, s);
  return s;
}

}  // namespace manyworlds
