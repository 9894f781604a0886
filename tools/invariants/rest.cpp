// What is in balance with a margin stays, then sleeps.
#include <algorithm>
#include <cmath>
#include <variant>

#include "tools/invariants/rest_assembly.hpp"

namespace manyworlds::invariants {
namespace {

bool has_faces(const Body& body) {
  const Geometry& g = body.shapes[0].geometry;
  return std::holds_alternative<Box>(g) || std::holds_alternative<Hull>(g) ||
         std::holds_alternative<Cylinder>(g) || std::holds_alternative<Polygon>(g) ||
         std::holds_alternative<Plane>(g) || std::holds_alternative<HalfPlane>(g);
}

bool in_balance(const Assembly& made, const Scale& scale) {
  if (made.is_known) return true;
  std::vector<Solid> solids;
  for (std::size_t i = 0; i < made.scene.bodies.size(); ++i) {
    if (!has_faces(made.scene.bodies[i])) continue;
    solids.push_back(solid_of(made.scene, static_cast<int>(i), 100 * scale.length));
  }
  std::vector<Touch> touches =
      touches_of(made.scene.space, solids, 1e-6 * scale.length, made.shrink);
  touches.insert(touches.end(), made.touches.begin(), made.touches.end());
  return stands(made.scene, touches, made.margin, made.preloads);
}

// The first of some tries that is in balance.
std::optional<Assembly> find(Random& kind, const Scale& scale, const Make& make) {
  constexpr int kTries = 40;
  // Worlds of a kind ask one after the other: the number of the try that stood is kept. It is a
  // function of the seed.
  thread_local std::uint64_t last_seed = 0;
  thread_local int last_try = -1;
  thread_local double last_length = 0;
  const auto seed = static_cast<std::uint64_t>(kind.uniform(0, 9e15));
  const bool known = seed == last_seed && scale.length == last_length && last_try >= 0;
  for (int i = known ? last_try : 0; i < kTries; ++i) {
    Random random(seed + static_cast<std::uint64_t>(i));
    Assembly made = make(random, static_cast<double>(i) / (kTries - 1));
    if (!known && !in_balance(made, scale)) continue;
    last_seed = seed, last_try = i, last_length = scale.length;
    return made;
  }
  return {};
}

}  // namespace

BodyId add_block(Scene& scene, Geometry geometry, const Vec3& position, const Quat& rotation,
                 double mass, double friction) {
  Body body = scenes::body_of(scenes::shape_of(std::move(geometry), friction), position);
  body.rotation = rotation;
  Shape& shape = body.shapes[0];
  shape.density = 1;
  shape.density = mass / mass_properties(scene, body).mass;
  return scene.add(body);
}

BodyId add_fixed(Scene& scene, Geometry geometry, const Vec3& position, const Quat& rotation,
                 double friction) {
  Body body =
      scenes::body_of(scenes::shape_of(std::move(geometry), friction), position, Motion::fixed);
  body.rotation = rotation;
  return scene.add(body);
}

double draw_mass(Random& random, const Scale& scale, double ratio) {
  return 1000 * std::pow(scale.length, 3) * random.log_uniform(1, ratio);
}

Geometry draw_brick(Random& random, Space space, double a, double b, double c) {
  if (space == Space::planar) return Polygon::box(a, c);
  switch (random.integer(0, 3)) {
    case 0: return Cylinder{std::min(a, b), c};
    case 1: {
      Hull hull;
      const int sides = random.integer(3, 8);
      for (int i = 0; i < 2 * sides; ++i) {
        const double angle = 2 * scenes::kPi * (i / 2) / sides;
        hull.vertices.push_back({a * std::cos(angle), b * std::sin(angle), i % 2 == 0 ? -c : c});
      }
      return hull;
    }
    default: return Box{{a, b, c}};
  }
}

Judge rest_judge(const Scene& scene, bool sleep, const Vec3& closing) {
  struct One {
    std::size_t body;
    Vec3 position;
    Quat rotation;
    double size, radius, settles;
  };
  std::vector<One> all;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.motion != Motion::dynamic) continue;
    double volume = 0, radius = 0;
    for (const Shape& shape : body.shapes) {
      Body alone;
      alone.shapes = {shape};
      alone.shapes[0].density = 1;
      volume += mass_properties(scene, alone).mass;
      radius = std::max(radius, outer_radius(shape.geometry));
    }
    const double size = scene.space == Space::planar ? std::sqrt(volume) : std::cbrt(volume);
    all.push_back({i, body.position, body.rotation.normalized(), size, radius, 0});
  }
  // Every contact between a body and the ground may close by the slop, which is 0.005 of the least
  // size. Levels are counted by the heights at which bodies start.
  double least = 1e300;
  for (const One& one : all) least = std::min(least, one.size);
  const Vec3 up = closing;
  std::vector<double> heights;
  for (const One& one : all) heights.push_back(one.position.dot(up));
  std::sort(heights.begin(), heights.end());
  const auto same = [&](double a, double b) { return b - a < 0.01 * least; };
  heights.erase(std::unique(heights.begin(), heights.end(), same), heights.end());
  for (One& one : all) {
    const double top = one.position.dot(up) + 0.001 * least;
    const auto levels = std::upper_bound(heights.begin(), heights.end(), top) - heights.begin();
    one.settles = 0.005 * least * static_cast<double>(levels);
  }
  return [all, up, sleep](const Seen& seen) {
    double worst = 0;
    for (const One& one : all) {
      const BodyNow& now = seen.now[one.body];
      const Vec3 moved = now.position - one.position;
      const double sunk = std::max(0.0, std::abs(moved.dot(up)) - one.settles);
      const double turned = one.radius * now.rotation.angularDistance(one.rotation);
      worst = std::max({worst, std::hypot((moved - moved.dot(up) * up).norm(), sunk) / one.size,
                        (turned - one.settles) / one.size});
    }
    if (sleep && seen.last && !seen.asleep) worst = std::max(worst, 2 * kRestLimit);
    return worst;
  };
}

Drawn draw_standing_still(Random& kind, Random& state, const Scale& scale, const Make& make) {
  std::optional<Assembly> made = find(kind, scale, make);
  Drawn out{{}, kRestSteps};
  out.sleep = kind.chance(0.5);
  if (!made) {  // Nothing to judge: a floor alone.
    out.scene = scene_of(Space::spatial, scale);
    out.scene.add(scenes::solid_box(Space::spatial, 1, Vec3::Constant(scale.length), Vec3::Zero()));
    out.steps = 1, out.judge = [](const Seen&) { return 0.0; };
    return out;
  }
  Scene& scene = made->scene;
  scene.options.sleep.time = kSleepSteps * scale.dt;
  const Vec3 up = scenes::up_of(scene.space);
  const double angle = state.uniform(-scenes::kPi, scenes::kPi);
  Vec3 shift = scale.length * state.in_cube(1);
  Quat turn = Quat::Identity();
  if (made->free && scene.space == Space::spatial) turn = Quat(Eigen::AngleAxisd(angle, up));
  if (scene.space == Space::planar) shift.z() = 0;
  shift -= shift.dot(up) * up;
  if (!made->free) shift = shift.x() / scale.length * made->shift;
  for (Body& body : scene.bodies) {
    if (body.motion == Motion::fixed) continue;
    body.position = turn * body.position + shift;
    body.rotation = turn * body.rotation;
  }
  out.judge = rest_judge(scene, out.sleep, made->closing.isZero() ? up : made->closing);
  out.scene = std::move(scene);
  return out;
}

Family rest_family(std::string id, std::string title,
                   std::function<Assembly(Random&, const Scale&, double)> make) {
  Family f;
  f.id = std::move(id), f.title = std::move(title);
  f.law = Law::rest;
  f.criterion =
      "farthest motion of a body in 1,200 steps over its size; 0.02 if a world that may sleep is "
      "awake at the end";
  f.limit = kRestLimit;
  f.draw = [make = std::move(make)](Random& kind, Random& state, const Scale& scale) {
    return draw_standing_still(
        kind, state, scale, [&](Random& random, double ease) { return make(random, scale, ease); });
  };
  return f;
}

std::vector<Family> rest_families() {
  std::vector<Family> out;
  for (const auto& part : {rest_body_families(), rest_pile_families(), rest_structure_families(),
                           rest_round_families(), must_move_families()}) {
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

}  // namespace manyworlds::invariants
