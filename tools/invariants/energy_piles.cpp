// Total energy of what falls: contacts and gravity never add any.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tools/invariants/energy_hits.hpp"

namespace manyworlds::invariants {
namespace {

constexpr int kStepsPerSecond = 60;  // of a body of 1 m; times go with the root of its size
constexpr double kShareOfImpact = 0.01, kShareAtRest = 1e-3;

// The rise of the total energy above its running minimum, over 1 % of the kinetic energy in the
// steps before and 0.1 % of m g size. The minimum may rise by 0.1 % of m g size per second.
Judge energy_judge(const Scene& scene, double length) {
  std::vector<Rigid> bodies;
  double weight = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    bodies.push_back(rigid_of(scene, BodyId(static_cast<int>(i))));
    if (bodies[i].inv_mass > 0) weight += scene.options.gravity.norm() / bodies[i].inv_mass;
  }
  const double rest = kShareAtRest * weight * length;
  return [bodies, rest, pull = scene.options.gravity, low = 0.0,
          kinetic = std::array<double, 4>()](const Seen& seen) mutable {
    const double now = energy_of(bodies, seen.now);
    double total = now;
    for (const Rigid& b : bodies) {
      if (b.inv_mass > 0) total -= pull.dot(b.position) / b.inv_mass;
    }
    low = seen.step == 0 ? total : std::min(total, low + rest / kStepsPerSecond);
    const double before = *std::max_element(kinetic.begin(), kinetic.end());
    const double value = (total - low) / (kShareOfImpact * before + rest);
    kinetic[static_cast<std::size_t>(seen.step % 4)] = now;
    return value;
  };
}

Material draw_pile_material(Random& kind) {
  const double friction = kind.chance(0.2) ? 0 : kind.uniform(0, 2);
  const double restitution = kind.chance(0.4) ? 0 : kind.chance(0.3) ? 1 : kind.uniform(0, 1);
  return {friction, restitution};
}

// Bodies that fall on the ground, in some kinds into a pit.
Drawn pile(Random& kind, Random& state, const Scale& scale, Space space) {
  Drawn out;
  Scene& scene = out.scene;
  scene = scene_of(space, scale);
  const Material material = draw_pile_material(kind);
  scene.add(scenes::ground(space, material));
  const int count = kind.integer(2, 8), dim = space == Space::planar ? 2 : 3;
  const bool in_pit = kind.chance(0.5);
  for (int axis = 0; axis < dim - 1 && in_pit; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Geometry wall = HalfPlane{{-side, 0}, -3 * scale.length};
      if (dim == 3) wall = Plane{-side * Vec3::Unit(axis), -3 * scale.length};
      scene.add(scenes::body_of(scenes::shape_of(wall, material), Vec3::Zero(), Motion::fixed));
    }
  }
  const int first = static_cast<int>(scene.bodies.size());
  const double ratio = kind.chance(0.3) ? 1 : kind.log_uniform(1, 100);
  for (int i = 0; i < count; ++i) {
    Geometry geometry = draw_shape(kind, space, scale.length);
    const BodyId id =
        scene.add(scenes::body_of(scenes::shape_of(std::move(geometry), material), Vec3::Zero()));
    set_mass(scene, id, unit_mass(space, scale) * kind.log_uniform(1, ratio));
  }

  const Vec3 up = scenes::up_of(space);
  const double speed = scale.length / scale.dt * state.log_uniform(0.001, 0.5);
  const double spin = state.log_uniform(0.001, 0.3) / scale.dt;
  double height = 0;
  for (int i = 0; i < count; ++i) {  // one above the other, a little aside
    Body& b = scene.bodies[static_cast<std::size_t>(first + i)];
    const double radius = outer_radius(b.shapes[0].geometry);
    const double x = state.uniform(-1, 1), y = state.uniform(-1, 1);
    height += radius * state.uniform(1.01, 1.5);
    b.position = height * up + scale.length * Vec3(x, dim == 3 ? y : 0, 0);
    height += radius;
    b.rotation = draw_rotation(state, space);
    const Vec3 direction = draw_direction(state, space);
    b.linear_velocity = speed * state.uniform(0, 1) * (state.chance(0.5) ? direction : Vec3(-up));
    b.angular_velocity = draw_axis(state, space) * (spin * state.uniform(0, 1));
  }
  out.steps = 120;
  out.judge = energy_judge(scene, scale.length);
  return out;
}

// Light bodies on the ground, and a heavy one that falls on them.
Drawn heavy_on_light(Random& kind, Random& state, const Scale& scale, Space space, double least,
                     double most) {
  Drawn out;
  Scene& scene = out.scene;
  scene = scene_of(space, scale);
  const Material material = draw_pile_material(kind);
  scene.add(scenes::ground(space, material));
  const int count = kind.integer(2, 4);
  const double ratio = kind.log_uniform(least, most);
  for (int i = 0; i < count; ++i) {
    Geometry geometry = draw_shape(kind, space, scale.length);
    const BodyId id =
        scene.add(scenes::body_of(scenes::shape_of(std::move(geometry), material), Vec3::Zero()));
    set_mass(scene, id, unit_mass(space, scale) * (i + 1 == count ? ratio : 1));
  }
  const Vec3 up = scenes::up_of(space);
  const double fall = scale.length * state.log_uniform(0.01, 5);
  double height = 0;
  for (int i = 1; i <= count; ++i) {
    Body& b = scene.bodies[static_cast<std::size_t>(i)];
    const Geometry& geometry = b.shapes[0].geometry;
    const Vec3 side = draw_flat_side(state, geometry, space, mass_of(scene, BodyId(i)).center);
    b.rotation = draw_rotation(state, space);
    if (!side.isZero()) b.rotation = rotation_to(side, -up);
    const Vec3 down = b.rotation.conjugate() * -up;
    height += reach(geometry, space, down) + (i == count ? fall : 1e-3 * scale.length);
    const double x = state.uniform(-0.2, 0.2), y = state.uniform(-0.2, 0.2);
    b.position = height * up + scale.length * Vec3(x, space == Space::planar ? 0 : y, 0);
    height += reach(geometry, space, -down);
  }
  out.steps = 120;
  out.judge = energy_judge(scene, scale.length);
  return out;
}

}  // namespace

std::vector<Family> pile_energy_families() {
  std::vector<Family> out;
  const auto add = [&](const std::string& id, const std::string& title, Draw draw) {
    Family f;
    f.id = id, f.law = Law::energy, f.title = title;
    f.criterion =
        "largest rise of the total energy above its running minimum, over 1 % of the kinetic "
        "energy before and 0.1 % of m g size; the minimum may rise by 0.1 % of m g size per "
        "second";
    f.limit = 1;
    f.draw = std::move(draw);
    out.push_back(std::move(f));
  };
  for (const Space space : {Space::planar, Space::spatial}) {
    const std::string in = space == Space::planar ? " 2D" : " 3D";
    add("pile" + in,
        "2 to 8 bodies that fall on the ground or into a pit, e 0 to 1, friction 0 to 2",
        [=](Random& kind, Random& state, const Scale& scale) {
          return pile(kind, state, scale, space);
        });
    const auto heavy = [&](const std::string& name, double least, double most) {
      add(name + in, "heavy body that falls on 1 to 3 light ones on the ground",
          [=](Random& kind, Random& state, const Scale& scale) {
            return heavy_on_light(kind, state, scale, space, least, most);
          });
    };
    heavy("heavy falls on light", 1, 100);
    heavy("heavy falls on light 1e3 to 1e4", 1e3, 1e4);
    out.back().required = false;
  }
  return out;
}

}  // namespace manyworlds::invariants
