// A pile far away does not change one bit of a pile.
#include <algorithm>
#include <cmath>
#include <memory>

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {
namespace {

// Which bodies must be alike, which are far, and how far that must be.
struct Far {
  std::vector<std::size_t> near, far;
  double reach = 0;  // m, of a body at most
  bool met = false;

  double operator()(const Seen& seen);
};

double Far::operator()(const Seen& seen) {
  // Piles that meet may differ. Bodies are compared with the box around the near pile.
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const std::size_t i : near) {
    for (const auto* at : {&seen.now, &seen.twin}) {
      low = low.cwiseMin((*at)[i].position), high = high.cwiseMax((*at)[i].position);
    }
  }
  for (const std::size_t i : far) {
    for (const auto* at : {&seen.now, &seen.twin}) {
      const Vec3& p = (*at)[i].position;
      const double apart = (p - p.cwiseMax(low).cwiseMin(high)).norm();
      met = met || apart < 6 * reach;
    }
  }
  if (met) return 0;
  double most = 0;
  for (const std::size_t i : near) {
    const BodyNow &a = seen.now[i], &b = seen.twin[i];
    const bool same = a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs() &&
                      a.velocity == b.velocity && a.spin == b.spin;
    if (!same) most = std::max(most, std::max((a.position - b.position).norm() / reach, 1e-12));
    if (!a.position.allFinite()) return HUGE_VAL;
  }
  return most;
}

// Where a pile stands, and how its bodies start.
struct Pile {
  Vec3 position = Vec3::Zero();
  int bodies = 0;
  bool joints = false, fixed_floor = false;
  int only = -1;  // type of all shapes, or -1
  double restitution = 0;
};

Pile draw_pile_type(Random& kind, Space space, int most) {
  Pile pile;
  pile.bodies = kind.integer(1, most);
  pile.joints = kind.chance(0.3);
  pile.fixed_floor = kind.chance(0.5);
  pile.only = kind.chance(0.3) ? kind.integer(0, shape_types(space) - 1) : -1;
  pile.restitution = kind.chance(0.5) ? 0 : kind.uniform(0, 1);
  return pile;
}

// A column of pairs, so that bodies fall on one another. Returns its bodies.
std::vector<std::size_t> add_pile(Random& kind, Scene& scene, const Pile& pile, double size) {
  const Space space = scene.space;
  const Vec3 up = scenes::up_of(space);
  std::vector<std::size_t> out;
  double height = 0;
  BodyId previous;
  for (int i = 0; i < pile.bodies; ++i) {
    const Geometry geometry =
        pile.only < 0 ? draw_shape(kind, space, size) : draw_shape(kind, space, size, pile.only);
    Material material;
    material.friction = kind.uniform(0, 1.5), material.restitution = pile.restitution;
    Body body = scenes::body_of(scenes::shape_of(geometry, material), Vec3::Zero());
    body.shapes[0].density = 1000 * kind.log_uniform(1, 10);
    const double extent = outer_radius(geometry);
    const double aside = i % 2 == 0 ? 0 : kind.uniform(-1, 1) * extent;
    body.position = pile.position + (height + extent * 1.02) * up + Vec3(aside, 0, 0);
    height += 2.04 * extent;
    body.rotation = draw_rotation(kind, space);
    const BodyId id = scene.add(body);
    if (pile.joints && i % 3 == 1) {
      const Frame frame = scenes::frame_at(0.5 * (scene.at(previous).position + body.position));
      const bool ball = space == Space::spatial && kind.chance(0.5);
      scene.add(ball ? joint_at(scene, previous, id, frame, BallJoint{})
                     : joint_at(scene, previous, id, frame, HingeJoint{}));
    }
    previous = id;
    out.push_back(static_cast<std::size_t>(id.index()));
  }
  return out;
}

void add_floor(Random& kind, Scene& scene, const Pile& pile, double half, double depth) {
  const Vec3 up = scenes::up_of(scene.space);
  const Material material{kind.uniform(0, 1.5), pile.restitution};
  Vec3 half_extents = Vec3::Constant(half);
  half_extents[scene.space == Space::planar ? 1 : 2] = depth;
  scene.add(scenes::body_of(scenes::shape_of(scenes::box_of(scene.space, half_extents), material),
                            pile.position - depth * up, Motion::fixed));
}

// Bodies start with other velocities, and moved as one by up to a size. What leaves `height` of a
// body above the floor is kept.
void stir(Random& state, Scene& scene, const std::vector<std::size_t>& pile, double speed,
          double spin, double size) {
  const Vec3 up = scenes::up_of(scene.space);
  const bool moves = state.chance(0.7), lifts = state.chance(0.5);
  const double lift = size * state.uniform(0, 2);
  for (const std::size_t i : pile) {
    Body& body = scene.bodies[i];
    if (lifts) body.position += lift * up;
    const Vec3 velocity = speed * state.uniform(0, 1) * draw_direction(state, scene.space);
    const Vec3 turn = spin * state.uniform(0, 1) * draw_axis(state, scene.space);
    if (moves) body.linear_velocity = velocity, body.angular_velocity = turn;
  }
}

Drawn draw_piles(Space space, int most, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = scene_of(space, scale);
  const double size = scale.length, speed = 2 * scale.speed(), spin = 0.3 / scale.dt;
  out.sleep = kind.chance(0.4);
  Pile near = draw_pile_type(kind, space, most), far = draw_pile_type(kind, space, most);
  far.position = Vec3(kind.log_uniform(50, 500) * size, 0, 0);
  const bool shared = kind.chance(0.6);  // a floor for both, else one for each
  if (shared) out.scene.add(scenes::ground(space, kind.uniform(0, 1.5), near.restitution));
  const bool first = kind.chance(0.5);
  std::vector<std::size_t> near_bodies, far_bodies;
  // Order in the scene matters to what the step does first.
  if (first) far_bodies = add_pile(kind, out.scene, far, size);
  near_bodies = add_pile(kind, out.scene, near, size);
  if (!first) far_bodies = add_pile(kind, out.scene, far, size);
  if (!shared) {
    add_floor(kind, out.scene, near, 15 * size, size);
    add_floor(kind, out.scene, far, 15 * size, size);
  }
  const Scene plain = out.scene;
  stir(state, out.scene, near_bodies, speed, spin, size);
  out.twin = out.scene;
  for (const std::size_t i : far_bodies) out.twin->bodies[i] = plain.bodies[i];
  stir(state, out.scene, far_bodies, speed, spin, size);
  stir(state, *out.twin, far_bodies, speed, spin, size);
  out.steps = 120;
  double widest = 0;
  for (const Body& body : out.scene.bodies) {
    if (body.motion != Motion::fixed)
      widest = std::max(widest, outer_radius(body.shapes[0].geometry));
  }
  out.judge = Far{near_bodies, far_bodies, widest};
  return out;
}

}  // namespace

std::vector<Family> independence_families() {
  std::vector<Family> all;
  const auto add = [&](const char* id, const char* title, Space space, int most) {
    Family f;
    f.id = id, f.law = Law::independence, f.title = title;
    f.criterion =
        "distance between two copies whose far pile starts in another way; any bit counts";
    f.unit = "radii";
    f.limit = 0;
    f.draw = [space, most](Random& kind, Random& state, const Scale& scale) {
      return draw_piles(space, most, kind, state, scale);
    };
    all.push_back(std::move(f));
  };
  add("far pile 2D", "two piles of up to 12 bodies, far apart", Space::planar, 12);
  add("far pile 3D", "two piles of up to 12 bodies, far apart", Space::spatial, 12);
  add("far bodies 2D", "one or two bodies, and as many far away", Space::planar, 2);
  add("far bodies 3D", "one or two bodies, and as many far away", Space::spatial, 2);
  return all;
}

}  // namespace manyworlds::invariants
