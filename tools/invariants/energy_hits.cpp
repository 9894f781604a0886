// Draws hits (energy_hits.hpp).
#include "tools/invariants/energy_hits.hpp"

#include <algorithm>
#include <cmath>

#include "manyworlds/query.hpp"

namespace manyworlds::invariants {

namespace {

struct Shapes {
  Shape a, b;
  Space space;
  bool plane;
};

// Plates, coins, rods and pebbles: some shapes are down to a tenth as thick.
void flatten(Random& random, Geometry& geometry) {
  const double share = random.chance(0.5) ? 1 : random.log_uniform(0.2, 1);
  if (auto* box = std::get_if<Box>(&geometry)) box->half_extents[2] *= share;
  if (auto* ellipsoid = std::get_if<Ellipsoid>(&geometry)) ellipsoid->radii[2] *= share;
  if (auto* cylinder = std::get_if<Cylinder>(&geometry)) cylinder->half_length *= share;
  if (auto* capsule = std::get_if<Capsule>(&geometry)) capsule->radius *= share;
}

// Distance of the bodies as they are.
Separation separation_of(const Shapes& shapes, const Hit& hit) {
  if (!shapes.plane) {
    return distance(shapes.a, {hit.a.origin(), hit.a.rotation}, shapes.b,
                    {hit.b.origin(), hit.b.rotation}, shapes.space);
  }
  const Vec3 down = hit.b.rotation.conjugate() * -hit.normal;
  Separation out;
  out.distance = hit.normal.dot(hit.b.origin()) - reach(shapes.b.geometry, shapes.space, down);
  return out;
}

// Rotates b. Returns whether it is flat.
bool draw_attitude(Random& random, const Shapes& shapes, Attitude attitude, Hit& hit) {
  Rigid& b = hit.b;
  b.rotation = draw_rotation(random, shapes.space);
  if (attitude == Attitude::any || (attitude == Attitude::tilted && random.chance(0.5)))
    return false;
  const Vec3 side = draw_flat_side(random, shapes.b.geometry, shapes.space, b.center);
  if (side.isZero()) return false;
  const double turn = random.uniform(0, 2 * scenes::kPi);
  b.rotation = rotation_to(side, -hit.normal);
  if (shapes.space == Space::spatial) {
    b.rotation = (Quat(Eigen::AngleAxisd(turn, hit.normal)) * b.rotation).normalized();
  }
  if (attitude == Attitude::flat) return true;
  const double tilt = random.log_uniform(1e-3, 0.3);
  Vec3 axis = hit.normal.cross(draw_direction(random, shapes.space)).normalized();
  // About an edge, so that both ends touch.
  const Vec3 edge = b.rotation * Vec3::Unit(random.integer(0, 2));
  const bool on_edge = random.chance(0.3) && shapes.space == Space::spatial;
  if (on_edge && std::abs(edge.dot(hit.normal)) < 1e-9) axis = edge;
  b.rotation = (Quat(Eigen::AngleAxisd(tilt, axis)) * b.rotation).normalized();
  return false;
}

// Brings the bodies into touch.
bool place(Random& random, const Shapes& shapes, double thickness, Hit& hit) {
  hit.points.clear();
  Rigid& b = hit.b;
  if (shapes.plane) {
    const Vec3 down = b.rotation.conjugate() * -hit.normal;
    const std::vector<Vec3> touching = farthest_points(shapes.b.geometry, shapes.space, down);
    b.position = hit.normal * down.dot(touching[0]) + b.rotation * b.center;
    for (const Vec3& p : touching) hit.points.push_back(b.origin() + b.rotation * p);
    return true;
  }
  const Vec3 direction = draw_direction(random, shapes.space);
  Vec3 aside = draw_direction(random, shapes.space);
  aside -= aside.dot(direction) * direction;
  const Vec3 offset = aside * (thickness * random.uniform(0, 1.4)) + b.rotation * b.center;
  // Newton's method from outside: the distance is a convex function of the way.
  double way = 2 * (outer_radius(shapes.a.geometry) + outer_radius(shapes.b.geometry));
  Separation there;
  for (int i = 0; i < 30; ++i) {
    b.position = direction * way + offset;
    there = separation_of(shapes, hit);
    const double slope = there.normal.dot(direction);
    if (there.distance < 2e-6 * thickness || slope < 0.01) break;
    way -= (there.distance - 1e-6 * thickness) / slope;
  }
  hit.normal = there.normal, hit.points = {(there.point_a + there.point_b) / 2};
  return there.distance > 0 && there.distance < 2e-6 * thickness;
}

// No other hit near this one in time.
bool is_single(const Shapes& shapes, const Hit& hit, double dt, double thickness, bool no_slip) {
  Hit before = hit, after = hit;
  const int in_step = shapes.plane ? 8 : 4;  // looks
  const double enough = 1e-5 * thickness;
  const auto parts = static_cast<int>(hit.lead * in_step) + 1;
  for (int i = 0; i < parts; ++i) {
    before.a.advance(-hit.lead * dt / parts), before.b.advance(-hit.lead * dt / parts);
    if (separation_of(shapes, before).distance < enough / 2) return false;
  }
  if (no_slip) {
    after.push(hit.impulse_without_slip());
  } else {
    const std::vector<double> impulses = hit.frictionless_impulses();
    for (std::size_t i = 0; i < impulses.size(); ++i) {
      after.b.push(impulses[i] * hit.normal, hit.points[i]);
      after.a.push(-impulses[i] * hit.normal, hit.points[i]);
    }
  }
  const double rest = kHitSteps + 0.5 - hit.lead;  // to the end of the run
  for (int i = 0; i < rest * in_step; ++i) {
    after.a.advance(dt / in_step), after.b.advance(dt / in_step);
    if (separation_of(shapes, after).distance < -enough) return false;
  }
  return true;
}

// Removes the slip by the velocity of b. False if friction would not keep it away.
bool stop_slip(Hit& hit) {
  const Vec3 approach = hit.approach();
  hit.b.velocity -= approach - approach.dot(hit.normal) * hit.normal;
  if (hit.flat) return true;
  const Vec3 impulse = hit.response().fullPivLu().solve(hit.normal);
  const double normal = impulse.dot(hit.normal);
  return normal > 0 && (impulse - normal * hit.normal).norm() * 1.2 < hit.friction * normal;
}

}  // namespace

DrawnHit draw_hit(Random& kind, Random& state, const Scale& scale, const HitOptions& options) {
  DrawnHit out;
  Scene& scene = out.scene;
  const Space space = options.space;
  scene = free_scene(space, scale);
  double restitution = options.restitution;
  if (restitution < 0) {
    const double drawn = kind.uniform(0.1, 1), which = kind.uniform(0, 1);
    restitution = which < 0.3 ? 1 : which < 0.5 && !options.no_slip ? 0 : drawn;
  }
  const double friction = options.friction < 0 ? kind.uniform(0, 2) : options.friction;
  const int type_a = options.balls ? 0 : kind.integer(0, shape_types(space) - 1);
  const int type_b = options.balls ? 0 : kind.integer(0, shape_types(space) - 1);
  const double size = scale.length * (options.plane ? 1 : kind.log_uniform(0.3, 1));
  const Material material{friction, restitution};
  Shape a = scenes::shape_of(draw_shape(kind, space, size, type_a), material);
  Shape b = scenes::shape_of(draw_shape(kind, space, scale.length, type_b), material);
  flatten(kind, a.geometry), flatten(kind, b.geometry);
  a.density = 1000, b.density = 1000;
  const bool upright = kind.chance(0.5);
  const Vec3 drawn_up = draw_direction(kind, space);
  const Vec3 up = upright ? scenes::up_of(space) : drawn_up;
  if (options.plane) {
    if (space == Space::planar)
      a.geometry = HalfPlane{up.head(2), 0};
    else
      a.geometry = Plane{up, 0};
  }
  scene.add(scenes::body_of(a, Vec3::Zero(), options.plane ? Motion::fixed : Motion::dynamic));
  scene.add(scenes::body_of(b, Vec3::Zero()));
  if (!options.plane) {
    const double ratio = kind.log_uniform(0.01, 100);
    const double as_drawn = mass_of(scene, BodyId(1)).mass / mass_of(scene, BodyId(0)).mass;
    scene.bodies[1].shapes[0].density = 1000 * ratio / as_drawn;
  }

  double thickness = half_thickness(b.geometry);
  if (!options.plane) thickness = std::min(thickness, half_thickness(a.geometry));
  const double fastest =
      std::holds_alternative<Ellipsoid>(b.geometry) ? options.fastest_ellipsoid : options.fastest;
  const double unit = thickness / scale.dt, gravity = scale.gravity * scale.dt / unit;
  const bool heavy = kind.chance(0.5) && options.gravity && gravity < 0.01;
  const Vec3 pull = heavy ? Vec3(-scale.gravity * up) : Vec3::Zero();
  scene.options.gravity = pull;
  const double slowest = heavy ? 40 * gravity : std::min(options.slowest, fastest / 5);

  const Shapes shapes{a, b, space, options.plane};
  const double radius_a = outer_radius(a.geometry), radius_b = outer_radius(b.geometry);
  const Hit still{
      rigid_of(scene, BodyId(0)), rigid_of(scene, BodyId(1)), up, {}, 0, 0, restitution, friction};
  double share = state.log_uniform(slowest, fastest);
  for (int attempt = 0; attempt < 400; ++attempt) {
    Hit hit = still;
    if (!options.plane) hit.a.rotation = draw_rotation(state, space);
    hit.a.position = hit.a.rotation * hit.a.center;
    hit.flat = draw_attitude(state, shapes, options.attitude, hit);
    if (!place(state, shapes, thickness, hit)) continue;
    // Travel is shared by both velocities and spins.
    const bool spins = options.spins && !hit.flat && state.chance(0.7);
    if (attempt % 40 == 39) share = std::max(share * 0.7, slowest);
    for (Rigid* body : {&hit.a, &hit.b}) {
      const double radius = (body == &hit.a ? radius_a : radius_b) + body->center.norm();
      const double part = share * unit * (options.plane ? 1 : 0.5);
      const double spin = spins ? state.uniform(0, 0.7) : 0;
      const Vec3 axis = draw_axis(state, space), direction = draw_direction(state, space);
      if (body->inv_mass == 0) continue;
      body->velocity = part * (1 - spin) * direction;
      body->set_spin(axis * std::min(part * spin / radius, 0.5 / scale.dt));
    }
    if (options.no_slip && !stop_slip(hit)) continue;
    hit.speed = 0;
    for (const Vec3& p : hit.points) hit.speed = std::max(hit.speed, hit.approach_at(p));
    if (hit.speed < 0.2 * share * unit || hit.b.velocity.norm() > unit) continue;
    hit.lead = state.uniform(0.05, 1.4);
    // Friction leads to something between no slip and none.
    const bool slides = hit.flat || !options.no_slip;
    const bool sticks = !hit.flat && friction > 0 && !options.balls;
    if (slides && !is_single(shapes, hit, scale.dt, thickness, false)) continue;
    if (sticks && !is_single(shapes, hit, scale.dt, thickness, true)) continue;
    out.hit = hit;
    break;
  }
  if (out.hit.points.empty()) {
    out.hit = still;
    out.hit.b.position = 10 * scale.length * up;
  }
  Hit start = out.hit;
  const double time = out.hit.lead * scale.dt;
  for (Rigid* body : {&start.a, &start.b}) {
    body->advance(-time);
    if (body->inv_mass == 0) continue;
    body->position += time * time / 2 * pull;
    body->velocity -= time * pull;
  }
  put_state(scene, BodyId(0), start.a), put_state(scene, BodyId(1), start.b);
  return out;
}

}  // namespace manyworlds::invariants
