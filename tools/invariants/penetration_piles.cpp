// Piles in a bin, and stacks with heavy bodies on light ones: how far bodies overlap each other.
#include <algorithm>
#include <cmath>

#include "tools/invariants/penetration_overlaps.hpp"

namespace manyworlds::invariants {
namespace {

Drawn judged(Drawn out, Overlaps overlaps) {
  overlaps.space = out.scene.space;
  overlaps.slop = slop_of(out.scene);
  out.contacts = true;
  out.judge = [overlaps = std::move(overlaps)](const Seen& seen) mutable {
    return overlaps.worst(seen);
  };
  return out;
}

// A floor and walls of fixed boxes, open at the top.
void add_bin(Scene& scene, Overlaps& overlaps, double half, double height, const Material& m) {
  const bool planar = scene.space == Space::planar;
  const Vec3 up = scenes::up_of(scene.space);
  const double t = half;
  const auto add = [&](const Vec3& normal, double offset, const Vec3& half_extents,
                       const Vec3& at) {
    scene.add(scenes::body_of(scenes::shape_of(scenes::box_of(scene.space, half_extents), m), at,
                              Motion::fixed));
    overlaps.piece_of_body.push_back(-1);
    overlaps.walls.push_back({normal, offset});
  };
  add(up, 0, planar ? Vec3(3 * half, t, 0) : Vec3(3 * half, 3 * half, t), -t * up);
  for (int axis = 0; axis < (planar ? 1 : 2); ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 out = sign * Vec3::Unit(axis);
      Vec3 half_extents = planar ? Vec3(t, height / 2, 0) : Vec3(3 * half, 3 * half, height / 2);
      half_extents[axis] = t;
      add(-out, -half, half_extents, (half + t) * out + height / 2 * up);
    }
  }
}

Drawn draw_pile(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = scene_of(space, scale);
  Overlaps overlaps;
  const double size = draw_small_size(kind, scale);
  const bool planar = space == Space::planar;
  const int count = kind.integer(10, 30), side = planar ? kind.integer(2, 4) : 2;
  const int layer = planar ? side : side * side;
  const double pitch = 3.5 * size, half = side * pitch / 2;
  const double height = pitch * (1 + (count - 1) / layer) + 8 * size;
  overlaps.top = height;
  const Material material = draw_surface(kind, 0.5);
  add_bin(out.scene, overlaps, half, height, material);
  const double slowest = kind.log_uniform(0.1, 1), ratio = kind.log_uniform(1, 100);
  const int only = kind.chance(0.3) ? kind.integer(0, shape_types(space) - 1) : -1;
  const bool flat = kind.chance(0.25);
  for (int i = 0; i < count; ++i) {
    const Geometry geometry = flat        ? draw_flat(kind, space, size)
                              : only >= 0 ? draw_shape(kind, space, size, only)
                                          : draw_shape(kind, space, size);
    Body body = dynamic_body(geometry, material);
    body.shapes[0].density = 1000 * (i == count / 2 ? ratio : 1);
    const int k = i % layer;
    const auto along = [&](int index) { return (index - 0.5 * (side - 1)) * pitch; };
    const double level = pitch * (0.5 + i / layer);
    body.position =
        planar ? Vec3(along(k), level, 0) : Vec3(along(k % side), along(k / side), level);
    body.rotation = draw_rotation(state, space);
    const double speed = slowest * state.uniform(0, std::sqrt(scale.gravity * size));
    body.linear_velocity = speed * draw_direction(state, space);
    const double turn = state.chance(0.5) ? 0 : state.uniform(0, 0.3) / scale.dt;
    body.angular_velocity = turn * draw_axis(state, space);
    overlaps.add(out.scene.add(body), geometry);
  }
  const double fall = std::sqrt(2 * height / scale.gravity);
  out.steps = static_cast<int>(std::clamp(2 * fall / scale.dt, 60.0, 160.0));
  return judged(std::move(out), std::move(overlaps));
}

// Heavy on light: each body is heavier than the one below it, and the highest `ratio` times as
// heavy as the lowest.
Drawn draw_stack(Space space, double ratio, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = scene_of(space, scale);
  Overlaps overlaps;
  const double size = draw_small_size(kind, scale);
  const Vec3 up = scenes::up_of(space);
  const Material material = draw_surface(kind, 0.5);
  out.scene.add(scenes::ground(space, material));
  overlaps.piece_of_body.push_back(-1);
  overlaps.walls.push_back({up, 0});
  const int count = kind.integer(2, 4);
  const bool any = kind.chance(0.4);  // bodies of any shape, else of flat faces
  const double top = ratio > 100 ? ratio : kind.log_uniform(1, ratio);
  const double drop = state.chance(0.4) ? 0 : size * state.uniform(0, 1);
  double height = 0;
  for (int i = 0; i < count; ++i) {
    const int flat = space == Space::planar || kind.chance(0.7) ? 1 : 3;  // boxes, cylinders
    Geometry geometry =
        draw_shape(kind, space, size, any ? kind.integer(0, shape_types(space) - 1) : flat);
    if (!any && space == Space::planar) {
      const double wide = size * kind.uniform(0.3, 1), tall = size * kind.uniform(0.3, 1);
      geometry = Polygon::box(wide, tall);
    }
    Body body = dynamic_body(geometry, material);
    body.rotation = any ? draw_rotation(state, space) : Quat(Quat::Identity());
    const Quat back = body.rotation.conjugate();
    height += reach(geometry, space, back * -up) + (i > 0 ? drop : drop * state.uniform(0, 1));
    body.position = height * up;
    height += reach(geometry, space, back * up);
    const BodyId id = out.scene.add(body);
    // By mass, not by density, whatever the volumes are.
    const double lowest = 1000 * std::pow(size, space == Space::planar ? 2 : 3);
    const double wanted = lowest * std::pow(top, i / (count - 1.0));
    out.scene.at(id).shapes[0].density = 1000 * wanted / mass_of(out.scene, id).mass;
    overlaps.add(id, geometry);
  }
  out.steps = 90;
  return judged(std::move(out), std::move(overlaps));
}

}  // namespace

std::vector<Family> pile_families() {
  std::vector<Family> all;
  const auto add = [&](const char* id, const char* title, auto draw, bool required) {
    Family f;
    f.id = id, f.law = Law::penetration, f.title = title, f.required = required;
    f.criterion = "overlap beyond slop over the least half thickness";
    f.limit = 0.02;
    f.draw = draw;
    all.push_back(std::move(f));
  };
  for (const Space space : {Space::planar, Space::spatial}) {
    const bool planar = space == Space::planar;
    add(
        planar ? "pile in a bin 2D" : "pile in a bin 3D",
        "10 to 30 bodies of any shape fall into a bin",
        [space](Random& kind, Random& state, const Scale& scale) {
          return draw_pile(space, kind, state, scale);
        },
        true);
    const auto stack = [space](double ratio) {
      return [space, ratio](Random& kind, Random& state, const Scale& scale) {
        return draw_stack(space, ratio, kind, state, scale);
      };
    };
    add(planar ? "heavy on light 2D" : "heavy on light 3D",
        "stacks whose highest body is up to 100 times as heavy as the lowest", stack(100), true);
    add(planar ? "heavy on light 1e3 2D" : "heavy on light 1e3 3D",
        "the same, 1,000 times as heavy", stack(1e3), false);
    add(planar ? "heavy on light 1e4 2D" : "heavy on light 1e4 3D",
        "the same, 10,000 times as heavy", stack(1e4), false);
  }
  return all;
}

}  // namespace manyworlds::invariants
