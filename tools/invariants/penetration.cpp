// Flat and slender bodies dropped onto floors. The depth below a floor follows from the pose: what
// the step believes about its contacts does not count.
#include "tools/invariants/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace manyworlds::invariants {
namespace {

// A floor in its frame, whose up is y in the plane and z in space.
struct DropFloor {
  Space space = Space::spatial;
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
  double extent = 0;            // half width, m
  bool uneven = false;          // with heights, else the plane of height 0
  std::vector<double> heights;  // m, [row][column] of a square grid about the origin
  int columns = 0;
  double cell = 0;

  // Height, m, and upward normal.
  std::pair<double, Vec3> surface(const Vec3& p) const;
};

std::pair<double, Vec3> DropFloor::surface(const Vec3& p) const {
  const auto index = [&](double x, double& part) {
    const double i = std::clamp(x / cell + 0.5 * (columns - 1), 0.0, columns - 1.0 - 1e-9);
    part = i - std::floor(i);
    return static_cast<std::size_t>(i);
  };
  double u = 0, v = 0;
  const std::size_t i = index(p.x(), u);
  if (space == Space::planar) {
    const double rise = heights[i + 1] - heights[i];
    return {heights[i] + u * rise, Vec3(-rise / cell, 1, 0).normalized()};
  }
  const std::size_t j = index(p.y(), v);
  const auto h = [&](std::size_t di, std::size_t dj) {
    return heights[(j + dj) * static_cast<std::size_t>(columns) + i + di];
  };
  // The diagonal of a cell starts at its corner of low x and low y.
  const double a = u > v ? h(1, 0) - h(0, 0) : h(1, 1) - h(0, 1);
  const double b = u > v ? h(1, 1) - h(1, 0) : h(0, 1) - h(0, 0);
  return {h(0, 0) + a * u + b * v, Vec3(-a / cell, -b / cell, 1).normalized()};
}

// At most the true depth, m, so that what breaks the law does overlap. -1: off the floor.
double depth(const DropFloor& floor, const Piece& piece, const BodyNow& now) {
  const Quat local = floor.rotation.conjugate() * now.rotation;
  const Vec3 p = floor.rotation.conjugate() * (now.position - floor.position);
  const Vec3 up = scenes::up_of(floor.space);
  if ((p - p.dot(up) * up).cwiseAbs().maxCoeff() > floor.extent - piece.radius) return -1;
  if (!floor.uneven) return reach(piece.geometry, floor.space, local.conjugate() * -up) - p.dot(up);
  double most = -1;
  Vec3 down = -up;
  for (int i = 0; i < 3; ++i) {
    const Vec3 low = p + local * support(piece.geometry, floor.space, local.conjugate() * down);
    const auto [height, normal] = floor.surface(low);
    // Slopes are at most 0.3: the surface is no nearer than this share of the vertical distance.
    most = std::max(most, (height - low.dot(up)) / std::hypot(1, 0.3));
    down = -normal;
  }
  return most;
}

// Points whose surface has slopes up to 0.3 in all.
void draw_heights(Random& random, DropFloor& floor) {
  const int rows = floor.space == Space::planar ? 1 : floor.columns;
  const double bump = floor.cell * (floor.space == Space::planar ? 0.15 : 0.1);
  for (int i = 0; i < rows * floor.columns; ++i) {
    floor.heights.push_back(floor.uneven ? random.uniform(-bump, bump) : 0);
  }
}

Shape floor_shape(Random& random, DropFloor& floor, double size, const Material& material) {
  const bool planar = floor.space == Space::planar;
  const int type = random.integer(0, 4);
  floor.extent = 40 * size;
  floor.columns = 41, floor.cell = size * random.log_uniform(0.5, 3);
  floor.uneven = type == 4;
  draw_heights(random, floor);
  const double width = 0.5 * floor.cell * (floor.columns - 1);
  const double thickness = size * random.log_uniform(0.05, 10);
  Shape shape;
  shape.material = material;
  if (type == 0) {
    shape.geometry = scenes::ground_of(floor.space);
  } else if (type == 1 || (type == 2 && !planar)) {
    shape.geometry =
        scenes::box_of(floor.space, planar ? Vec3(floor.extent, thickness, 0)
                                           : Vec3(floor.extent, floor.extent, thickness));
    shape.position = -thickness * scenes::up_of(floor.space);
  } else if (type == 2) {
    shape.geometry = Segment{{-floor.extent, 0}, {floor.extent, 0}};
  } else if (planar) {
    floor.extent = width;
    Terrain terrain;
    for (int i = 0; i < floor.columns; ++i) {
      terrain.points.push_back(
          {i * floor.cell - width, floor.heights[static_cast<std::size_t>(i)]});
    }
    shape.geometry = terrain;
  } else {
    floor.extent = width;
    shape.geometry = HeightField{floor.heights, floor.columns, {floor.cell, floor.cell}};
  }
  return shape;
}

// The lowest point of the body is `gap` above the highest of the floor.
void place_on(Body& body, const DropFloor& floor, const Geometry& geometry, double gap,
              double along, double across) {
  const Vec3 up = scenes::up_of(floor.space);
  const Quat local = floor.rotation.conjugate() * body.rotation;
  const double bump =
      floor.uneven ? *std::max_element(floor.heights.begin(), floor.heights.end()) : 0;
  const double height = reach(geometry, floor.space, local.conjugate() * -up) + gap + bump;
  const Vec3 side = floor.space == Space::planar ? Vec3(along, 0, 0) : Vec3(along, across, 0);
  body.position = floor.position + floor.rotation * (side + height * up);
}

Drawn draw_drop(Space space, Random& kind, Random& state, const Scale& scale) {
  constexpr int kBodies = 5, kFall = 25;
  Drawn out;
  out.scene = scene_of(space, scale);
  const double size = draw_small_size(kind, scale);
  const bool planar = space == Space::planar;
  DropFloor floor;
  floor.space = space;
  if (kind.chance(0.5)) {
    const double tilt = kind.uniform(-0.25, 0.25);
    floor.rotation = Quat(Eigen::AngleAxisd(tilt, planar ? Vec3::UnitZ() : Vec3::UnitX()));
  }
  Body fixed;
  fixed.motion = Motion::fixed, fixed.rotation = floor.rotation;
  const Material material = draw_surface(kind);
  fixed.shapes.push_back(floor_shape(kind, floor, size, material));
  out.scene.add(fixed);

  std::vector<Piece> pieces;
  for (int i = 0; i < kBodies; ++i) {
    const Geometry geometry = draw_flat(kind, space, size);
    Body body = dynamic_body(geometry, draw_surface(kind));
    body.shapes[0].filter = {2, 1};  // bodies pass through one another
    const double thickness = half_thickness(geometry);
    body.rotation = floor.rotation * draw_rotation(state, space);
    if (state.chance(0.3)) body.rotation = floor.rotation;
    const double fall = state.chance(0.1) ? 0 : thickness * state.uniform(0, 20);
    // What takes long to fall starts with the speed of the rest of the way.
    const double gap = std::min(fall, 0.5 * scale.gravity * std::pow(kFall * scale.dt, 2));
    place_on(body, floor, geometry, gap, 2.5 * size * (i % 3 - 1), 2.5 * size * (i / 3));
    body.linear_velocity = -std::sqrt(2 * scale.gravity * (fall - gap)) * scenes::up_of(space);
    const double aside = state.chance(0.5) ? 0 : state.uniform(0, std::sqrt(scale.gravity * size));
    const Vec3 heading = floor.rotation * Vec3(aside, 0, 0);
    const double turn = state.chance(0.5) ? 0 : state.uniform(0, 0.3) / scale.dt;
    body.linear_velocity += heading;
    body.angular_velocity = turn * draw_axis(state, space);
    pieces.push_back(piece_of(out.scene.add(body), geometry));
  }
  out.steps = 2 * kFall + 60;
  const double slop = slop_of(out.scene);
  out.judge = [floor, pieces, slop](const Seen& seen) {
    double worst = 0;
    for (const Piece& piece : pieces) {
      const BodyNow& now = seen.now[piece.body];
      if (!finite(now)) return HUGE_VAL;
      worst = std::max(worst, (depth(floor, piece, now) - slop) / piece.thickness);
    }
    return worst;
  };
  return out;
}

std::vector<Family> drop_families() {
  Family f;
  f.id = "flat bodies onto floors", f.law = Law::penetration;
  f.title = "flat and slender bodies dropped from 0 to 20 half thicknesses onto floors";
  f.criterion = "depth below the floor beyond slop over the half thickness";
  f.limit = 0.02;
  return in_both_spaces(f, draw_drop);
}

}  // namespace

std::vector<Family> penetration_families() {
  std::vector<Family> all = drop_families();
  for (auto& more : {pile_families(), wall_families(), seam_families()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace manyworlds::invariants
