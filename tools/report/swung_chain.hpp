// A chain of ten links under a load, swung from the horizontal: what heavy loads on joints do.
#pragma once

#include <algorithm>
#include <variant>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {

inline constexpr double kLink = 0.5;  // m
inline constexpr int kLinks = 10;

// Links of 1 kg; the load is the last one's mass, kg.
inline Scene swung_chain(double load) {
  Scene scene = empty(Space::planar, 10);
  for (int i = 0; i < kLinks; ++i) {
    Body link = scenes::uniform_rod(Space::planar, i + 1 == kLinks ? load : 1, kLink,
                                    {(i + 0.5) * kLink, 0, 0});
    link.jitter.linear_velocity = {0, 0.01, 0};
    scene.add(link);
    scene.add(joint_at(scene, BodyId(i - 1), BodyId(i), frame_at(i * kLink, 0), HingeJoint{}));
  }
  return scene;
}
// M g L, J.
inline double fall_of_chain(double load) { return (kLinks - 1 + load) * 10 * kLinks * kLink; }

// How far the anchors of a joint are apart, at most, m. Not of joints that slide.
inline double worst_gap(const Seen& s, int w) {
  const Scene& scene = s.batch().plan().scene();
  double most = 0;
  for (const Joint& j : scene.joints) {
    const bool slides =
        std::holds_alternative<SliderJoint>(j.type) || std::holds_alternative<WheelJoint>(j.type);
    if (slides) continue;
    const auto anchor = [&](BodyId body, const Frame& frame) {
      if (!body || scene.at(body).motion == Motion::fixed) {
        return frame_in_world(scene, body, frame).position;
      }
      const int row = s.batch().row(body);
      return Vec3(s.position(w, row) + s.rotation(w, row) * frame.position);
    };
    most = std::max(most, (anchor(j.body_a, j.frame_a) - anchor(j.body_b, j.frame_b)).norm());
  }
  return most;
}

}  // namespace manyworlds::report
