// Momentum of isolated systems: no gravity, drag, fixed or kinematic bodies. Forces between bodies
// come in opposite pairs along one line, so that linear momentum, and angular momentum about the
// centre of mass, keep their start values whatever the bodies do to one another.
#include <algorithm>
#include <cmath>
#include <string>

#include "tools/invariants/momenta.hpp"

namespace manyworlds::invariants {
namespace {

constexpr int kClusterSteps = 120, kDrumSteps = 300, kSpinSteps = 600;
constexpr double kStepsOfLaw = 3600;        // 60 s
constexpr double kMostTravelOfStep = 0.99;  // body lengths per step

enum class Momentum { linear, angular };

Judge momentum_judge(const Scene& scene, Momentum which) {
  return [masses = masses_of(scene), which, start = Momenta()](const Seen& seen) mutable {
    const Momenta now = momenta_of(masses, seen.now);
    if (seen.step == 0) start = now;
    return which == Momentum::linear ? (now.linear - start.linear).norm() / start.linear_sum
                                     : (now.angular - start.angular).norm() / start.angular_sum;
  };
}

// Bodies of any shape, at the origin.
void add_bodies(Random& kind, Scene& scene, const Scale& scale, int count) {
  const double ratio = kind.chance(0.3) ? 1 : kind.log_uniform(1, 100);
  const double friction = kind.chance(0.3) ? 0 : kind.uniform(0, 2);
  const double restitution = kind.chance(0.3) ? 0 : kind.chance(0.4) ? 1 : kind.uniform(0, 1);
  const int only = kind.chance(0.5) ? kind.integer(0, shape_types(scene.space) - 1) : -1;
  for (int i = 0; i < count; ++i) {
    const int type = only >= 0 ? only : kind.integer(0, shape_types(scene.space) - 1);
    Geometry geometry = draw_shape(kind, scene.space, scale.length, type);
    const BodyId id = scene.add(scenes::body_of(
        scenes::shape_of(std::move(geometry), friction, restitution), Vec3::Zero()));
    set_mass(scene, id, unit_mass(scene.space, scale) * kind.log_uniform(1, ratio));
  }
}

// Positions near the origin at which no bounding spheres overlap: each body goes outward along a
// random direction until it is free.
void place_cluster(Random& state, Scene& scene) {
  std::vector<double> radii;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    Body& body = scene.bodies[i];
    radii.push_back(outer_radius(body.shapes[0].geometry));
    const Vec3 direction = draw_direction(state, scene.space);
    const double gap = radii[i] * state.uniform(1.01, 1.3);
    const auto is_free = [&](const Vec3& place) {
      for (std::size_t j = 0; j < i; ++j) {
        if ((place - scene.bodies[j].position).norm() < gap + radii[j]) return false;
      }
      return true;
    };
    double distance = 0;
    while (!is_free(distance * direction)) distance += 0.1 * radii[i];
    body.position = distance * direction;
    body.rotation = draw_rotation(state, scene.space);
  }
}

// Bodies that fly at one another, as a cluster that also rotates.
Drawn cluster(Random& kind, Random& state, const Scale& scale, Space space, Momentum which) {
  Drawn out;
  out.scene = free_scene(space, scale);
  add_bodies(kind, out.scene, scale, kind.integer(2, 12));
  place_cluster(state, out.scene);
  double extent = scale.length;
  for (const Body& b : out.scene.bodies) extent = std::max(extent, b.position.norm());
  const double speed = scale.length / scale.dt * state.log_uniform(0.01, kMostTravelOfStep);
  const Vec3 whirl = draw_axis(state, space) * (speed * state.uniform(0, 0.7) / extent);
  const double inward = state.uniform(0.3, 1), noise = state.uniform(0, 0.3);
  const double spin = state.chance(0.3) ? 0 : state.log_uniform(0.01, 0.5) / scale.dt;
  for (Body& b : out.scene.bodies) {
    const Vec3 aside = draw_direction(state, space);
    b.linear_velocity = speed * (noise * aside - inward * b.position / extent);
    b.linear_velocity += whirl.cross(b.position);
    b.angular_velocity = draw_axis(state, space) * (spin * state.uniform(0, 1));
  }
  resist_in_some(kind, out.scene, scale);
  out.steps = kClusterSteps;
  out.judge = momentum_judge(out.scene, which);
  return out;
}

// A closed container that moves freely; the bodies in it keep hitting it and one another.
Drawn drum(Random& kind, Random& state, const Scale& scale, Space space, Momentum which) {
  Drawn out;
  Scene& scene = out.scene;
  scene = free_scene(space, scale);
  const int dim = space == Space::planar ? 2 : 3;
  const Eigen::Array3i cells = dim == 2 ? Eigen::Array3i(4, 3, 1) : Eigen::Array3i(3, 2, 2);
  const int count = kind.integer(2, 9);
  const double cell = 2.1 * scale.length, thickness = 0.5 * scale.length;
  const Vec3 inner = 0.5 * cell * cells.cast<double>().matrix();
  add_bodies(kind, scene, scale, count);
  Body walls;
  const Material material = scene.bodies[0].shapes[0].material;
  for (int axis = 0; axis < dim; ++axis) {
    Vec3 half = inner + Vec3::Constant(2 * thickness);
    half[axis] = thickness;
    for (const double side : {-1.0, 1.0}) {
      Shape wall = scenes::shape_of(scenes::box_of(space, half), material);
      wall.position = side * (inner[axis] + thickness) * Vec3::Unit(axis);
      walls.shapes.push_back(wall);
    }
  }
  const BodyId id = scene.add(std::move(walls));
  set_mass(scene, id, unit_mass(space, scale) * kind.log_uniform(1, 100));

  const double speed = scale.length / scale.dt * state.log_uniform(0.01, 0.3);
  const double spin = state.log_uniform(0.01, 0.5) / scale.dt;
  const int first = state.integer(0, 11);
  for (int i = 0; i < count; ++i) {
    Body& b = scene.bodies[static_cast<std::size_t>(i)];
    const int n = (first + 5 * i) % 12;  // 5 and 12 have no common factor
    const Eigen::Array3i at(n % cells[0], n / cells[0] % cells[1], n / (cells[0] * cells[1]));
    b.position = cell * (at.cast<double>() + 0.5).matrix() - inner;
    if (dim == 2) b.position.z() = 0;
    b.rotation = draw_rotation(state, space);
    b.linear_velocity = speed * draw_direction(state, space);
    b.angular_velocity = draw_axis(state, space) * (spin * state.uniform(0, 1));
  }
  resist_in_some(kind, scene, scale);
  out.steps = kDrumSteps;
  out.judge = momentum_judge(scene, which);
  return out;
}

// One body that nothing touches.
Drawn free_spin(Random& kind, Random& state, const Scale& scale, Momentum which) {
  Drawn out;
  out.scene = free_scene(Space::spatial, scale);
  add_bodies(kind, out.scene, scale, 1);
  Body& b = out.scene.bodies[0];
  b.rotation = draw_rotation(state, Space::spatial);
  b.angular_velocity = state.direction() * (state.log_uniform(0.01, 6) / scale.dt);
  b.linear_velocity = state.direction() * (scale.length / scale.dt * state.log_uniform(0.01, 1));
  out.steps = kSpinSteps;
  out.judge = momentum_judge(out.scene, which);
  return out;
}

void add(std::vector<Family>& out, const std::string& id, const std::string& title, Momentum which,
         int steps, bool grows, Draw draw) {
  Family f;
  const bool linear = which == Momentum::linear;
  f.id = id + (linear ? " linear" : " angular");
  f.law = Law::momentum;
  f.title = title;
  f.criterion = linear ? "largest change of momentum over the sum of m |v| at the start"
                       : "largest change of angular momentum about the centre of mass over the sum "
                         "of |m r x v| + |I w| at the start";
  f.criterion += " in " + std::to_string(steps) + " steps";
  f.limit = linear ? 1e-5 : 1e-2;
  f.limit_f64 = linear ? 1e-12 : 0;
  if (!linear && grows) {
    f.limit *= std::sqrt(steps / kStepsOfLaw);
    f.criterion +=
        "; errors of many hits add up like a random walk, so the limit is 1e-2 times the "
        "root of the share of 3,600 steps";
  }
  f.draw = std::move(draw);
  out.push_back(std::move(f));
}

}  // namespace

std::vector<Family> momentum_families() {
  std::vector<Family> out;
  for (const Momentum which : {Momentum::linear, Momentum::angular}) {
    for (const Space space : {Space::planar, Space::spatial}) {
      const std::string in = space == Space::planar ? " 2D" : " 3D";
      add(out, "cluster" + in, "2 to 12 bodies that fly at one another, no gravity", which,
          kClusterSteps, false, [=](Random& kind, Random& state, const Scale& scale) {
            return cluster(kind, state, scale, space, which);
          });
      add(out, "drum" + in, "2 to 9 bodies in a closed container that moves freely, no gravity",
          which, kDrumSteps, true, [=](Random& kind, Random& state, const Scale& scale) {
            return drum(kind, state, scale, space, which);
          });
    }
    add(out, "free spin 3D", "one body that spins and touches nothing", which, kSpinSteps, true,
        [=](Random& kind, Random& state, const Scale& scale) {
          return free_spin(kind, state, scale, which);
        });
    if (which == Momentum::angular) out.back().limit_f64 = 1e-9;
  }
  return out;
}

}  // namespace manyworlds::invariants
