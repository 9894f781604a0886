// One body on a face.
#include <algorithm>
#include <cmath>

#include "tools/invariants/rest_assembly.hpp"

namespace manyworlds::invariants {
namespace {

// Points of the base against the floor.
std::vector<Touch> base_touches(const Scene& scene, const Standing& standing, const Floor& floor,
                                int body, double friction, double shrink) {
  const Body& b = scene.bodies[static_cast<std::size_t>(body)];
  const Quat upright = b.rotation.normalized() * standing.rotation.conjugate();
  std::vector<Touch> out;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : standing.base) middle += p / static_cast<double>(standing.base.size());
  const Vec3 normal = floor.rotation * scenes::up_of(scene.space);
  for (const Vec3& p : standing.base) {
    const Vec3 at = b.position + upright * (p + shrink * (middle - p));
    out.push_back({floor.body.index(), body, at, normal, friction});
  }
  return out;
}

Drawn draw_body(Space space, bool prism, Random& kind, Random& state, const Scale& scale) {
  Drawn out{scene_of(space, scale), kRestSteps};
  out.sleep = kind.chance(0.5);
  out.scene.options.sleep.time = kSleepSteps * scale.dt;
  const double friction = kind.log_uniform(0.05, 2), share = kind.log_uniform(0.5, 2);
  const bool level = !prism && kind.chance(0.3);
  const double tilt = level ? 0 : std::atan(friction * kind.uniform(0.3, 0.8));
  const Material material{.friction = friction / share};
  const int sides = kind.integer(5, 7);
  Standing standing = prism ? draw_prism(kind, 0.5 * scale.length, sides, material)
                            : draw_standing(kind, space, 0.5 * scale.length, material);
  const FloorDraw draw{
      .extent = 10 * scale.length, .tilt = tilt, .material = {.friction = friction * share}};
  const Floor floor = add_floor(out.scene, kind, scale, draw);
  out.scene.add(standing.body);
  // The slope has its margin; pyramids within the cones need some of what is left. Yaws at which it
  // stands: few tip at all of them.
  const Margin margin{.friction = 0.9, .weight = 1, .tilt = 0};
  bool holds = false;
  for (int i = 0; i < 20 && !holds; ++i) {
    Vec3 at = scale.length * state.in_cube(1);
    at -= at.dot(scenes::up_of(space)) * scenes::up_of(space);
    if (space == Space::planar) at.z() = 0;
    const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
    out.scene.bodies[1] = stand(space, standing, floor, at, yaw);
    holds = stands(out.scene, base_touches(out.scene, standing, floor, 1, friction, 0.2), margin);
  }
  out.judge = rest_judge(out.scene, out.sleep, floor.rotation * scenes::up_of(space));
  if (!holds) out.judge = [](const Seen&) { return 0.0; };
  return out;
}

}  // namespace

std::vector<Family> rest_body_families() {
  std::vector<Family> out;
  const auto add = [&](Space space, bool prism, std::string id, std::string title) {
    Family f = rest_family(std::move(id), std::move(title), {});
    f.draw = [=](Random& kind, Random& state, const Scale& scale) {
      return draw_body(space, prism, kind, state, scale);
    };
    out.push_back(std::move(f));
  };
  add(Space::spatial, false, "rest on a face 3D",
      "a body of any shape on a face, on level ground or slopes up to 0.8 of the threshold");
  add(Space::planar, false, "rest on a face 2D",
      "a body of any shape on an edge, on level ground or slopes up to 0.8 of the threshold");
  add(Space::spatial, true, "prism on a slope", "hulls of 5, 6 and 7 sides on slopes");
  return out;
}

}  // namespace manyworlds::invariants
