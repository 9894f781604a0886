// Fast bodies against fixed walls: none ends beyond.
#include <algorithm>
#include <cmath>
#include <memory>

#include "tools/invariants/penetration.hpp"

namespace manyworlds::invariants {
namespace {

// In its frame the free side is above height 0, along y in the plane and z in space.
struct Front {
  Space space = Space::spatial;
  Quat rotation = Quat::Identity();
  double thickness = 0;  // m; infinite if the wall has no other side
  double extent = 0;     // half width, m
};

// Walls that are one shape, or two shapes that meet where bodies hit.
Body draw_wall(Random& random, Front& front, double size, const Material& material) {
  const bool planar = front.space == Space::planar;
  const Vec3 up = scenes::up_of(front.space);
  const double half = 0.5 * size * random.log_uniform(0.05, 5);
  const double seam = size * random.uniform(-1, 1);
  const double wide = front.extent;
  Body wall;
  wall.motion = Motion::fixed, wall.rotation = front.rotation;
  front.thickness = HUGE_VAL;
  const auto add = [&](Geometry geometry, const Vec3& position) {
    wall.shapes.push_back(scenes::shape_of(std::move(geometry), material));
    wall.shapes.back().position = position;
    wall.shapes.back().filter = {1, 2};
  };
  const auto add_box = [&](double from, double to) {
    const double center = 0.5 * (from + to), along = 0.5 * (to - from);
    const Vec3 half_extents = planar ? Vec3(along, half, 0) : Vec3(along, wide, half);
    add(scenes::box_of(front.space, half_extents), Vec3(center, 0, 0) - half * up);
    front.thickness = 2 * half;
  };
  const auto add_segment = [&](double from, double to) {
    add(Segment{{from, 0}, {to, 0}}, Vec3::Zero());
    front.thickness = 0;
  };
  switch (random.integer(0, planar ? 5 : 3)) {
    case 0: add(scenes::ground_of(front.space), Vec3::Zero()); break;
    case 1: add_box(-wide, wide); break;
    case 2: add_box(-wide, seam), add_box(seam, wide); break;
    case 3:
      if (planar) {
        add(Terrain{{{-wide, 0}, {seam, 0}, {wide, 0}}}, Vec3::Zero());
      } else {
        const int columns = random.integer(3, 31);
        const double cell = 2 * wide / (columns - 1);
        const std::vector<double> flat(static_cast<std::size_t>(columns * columns), 0.0);
        add(HeightField{flat, columns, {cell, cell}}, Vec3::Zero());
      }
      break;
    case 4: add_segment(-wide, wide); break;
    default: add_segment(-wide, seam), add_segment(seam, wide);
  }
  return wall;
}

// Which bodies are beyond.
class Beyond {
 public:
  Beyond(Front front, std::vector<Piece> pieces, std::vector<Vec3> centers)
      : front_(std::move(front)),
        pieces_(std::move(pieces)),
        centers_(std::move(centers)),
        left_(pieces_.size(), 0) {}

  double operator()(const Seen& seen) {
    const Vec3 up = scenes::up_of(front_.space);
    int beyond = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const BodyNow& now = seen.now[pieces_[i].body];
      if (!finite(now)) return HUGE_VAL;
      if (left_[i]) continue;
      const Vec3 p = front_.rotation.conjugate() * (now.position + now.rotation * centers_[i]);
      // What reaches the border may go round the wall.
      const Vec3 aside = p - p.dot(up) * up;
      left_[i] = aside.cwiseAbs().maxCoeff() > front_.extent - 2 * pieces_[i].radius;
      if (left_[i]) continue;
      // A centre within a thick wall may still be pushed out in front.
      const double height = p.dot(up);
      if (height < -front_.thickness || (seen.last && height < 0)) ++beyond;
    }
    return beyond;
  }

 private:
  Front front_;
  std::vector<Piece> pieces_;
  std::vector<Vec3> centers_;  // of mass, in the body frames
  std::vector<char> left_;
};

// Slender, flat and compact bodies alike.
Geometry draw_bullet(Random& random, Space space, double size) {
  const int type = random.integer(0, 9);
  if (type < 5) return draw_shape(random, space, size);
  if (type < 8) return draw_flat(random, space, size);
  const double thin = size * random.log_uniform(0.01, 0.1);
  if (space == Space::planar) {
    if (type == 8) return Capsule{thin, size};
    return Polygon::box(thin, size);
  }
  if (type == 8) return Capsule{thin, size};
  return Box{{size, thin, thin}};
}

Drawn draw_fast(Space space, Random& kind, Random& state, const Scale& scale) {
  constexpr int kBodies = 4, kFlight = 4;
  Drawn out;
  out.scene = scene_of(space, scale);
  const double size = draw_small_size(kind, scale);
  Front front;
  front.space = space, front.rotation = draw_rotation(kind, space), front.extent = 60 * size;
  const Material material = draw_surface(kind);
  out.scene.add(draw_wall(kind, front, size, material));
  out.scene.options.gravity = scale.gravity * draw_direction(kind, space);
  const Vec3 up = scenes::up_of(space);

  std::vector<Piece> pieces;
  std::vector<Vec3> centers;
  for (int i = 0; i < kBodies; ++i) {
    const Geometry geometry = draw_bullet(kind, space, size);
    Body body = dynamic_body(geometry, material);
    body.shapes[0].filter = {2, 1};  // bodies pass through one another
    const Piece piece = piece_of(BodyId(i + 1), geometry);
    // 5 body lengths a step, and 100 m/s for a body of 1 m on Earth.
    const double length = 2 * piece.radius;
    const double fastest = std::min(5 * length / scale.dt, 32 * std::sqrt(scale.gravity * length));
    const double speed = fastest * state.log_uniform(0.05, 1);
    const double slant = state.chance(0.3) ? 0 : state.uniform(0, 1.1);
    const Vec3 aside = space == Space::planar ? Vec3(state.chance(0.5) ? 1 : -1, 0, 0)
                                              : Vec3(state.planar_direction());
    const Vec3 velocity = speed * (std::sin(slant) * aside - std::cos(slant) * up);
    // At the wall within some steps, anywhere within a step, near the middle or its seam.
    const double steps = state.uniform(0, kFlight);
    const double height = piece.radius * 1.01 + steps * scale.dt * speed * std::cos(slant);
    Vec3 at = height * up - velocity.dot(aside) * steps * scale.dt * aside;
    const double wander = size * state.uniform(-2, 2), other = size * state.uniform(-2, 2);
    at += space == Space::planar ? Vec3(wander, 0, 0) : Vec3(wander, other, 0);
    body.position = front.rotation * at;
    body.rotation = state.chance(0.2) ? front.rotation : draw_rotation(state, space);
    body.linear_velocity = front.rotation * velocity;
    const double turn = state.chance(0.3) ? 0 : state.log_uniform(0.01, 6) / scale.dt;
    body.angular_velocity = turn * draw_axis(state, space);
    out.scene.add(body);
    pieces.push_back(piece);
    centers.push_back(mass_of(out.scene, BodyId(i + 1)).center);
  }
  out.steps = 16;
  auto beyond = std::make_shared<Beyond>(front, std::move(pieces), std::move(centers));
  out.judge = [beyond](const Seen& seen) { return (*beyond)(seen); };
  return out;
}

}  // namespace

std::vector<Family> wall_families() {
  Family f;
  f.id = "fast bodies at walls", f.law = Law::penetration;
  f.title = "bodies of up to 5 lengths and 6 rad a step hit walls from 5 % of their size thick";
  f.criterion = "bodies whose centre ends behind the wall";
  f.unit = "bodies";
  f.limit = 0;
  return in_both_spaces(f, draw_fast);
}

}  // namespace manyworlds::invariants
