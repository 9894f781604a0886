// Bodies that slide without friction over floors made of many fixed shapes. On a level floor
// nothing acts along the motion, so velocity and height stay as they are.
#include <algorithm>
#include <cmath>

#include "tools/invariants/penetration.hpp"

namespace manyworlds::invariants {
namespace {

// Stands on its lowest point, edge or face without tipping.
struct Slider {
  Geometry geometry = Sphere{};
  Quat rotation = Quat::Identity();
};

Slider draw_slider(Random& random, Space space, double size) {
  const auto extent = [&] { return size * random.uniform(0.3, 1); };
  const double a = extent(), b = extent(), c = extent();
  const int type = random.integer(0, space == Space::planar ? 3 : 6);
  const Quat lying(
      Eigen::AngleAxisd(scenes::kPi / 2, space == Space::planar ? Vec3::UnitZ() : Vec3::UnitX()));
  if (space == Space::planar) {
    if (type == 0) return {Circle{a}};
    if (type == 1) return {Polygon::box(a, b)};
    if (type == 2) return {Capsule{0.5 * a, 0.5 * b}, lying};
    // A polygon on one of its sides, wider than tall.
    Polygon polygon;
    const int sides = random.integer(3, 8);
    for (int i = 0; i < sides; ++i) {
      const double angle = scenes::kPi * ((2 * i + 1.0) / sides - 0.5);
      polygon.vertices.push_back({a * std::cos(angle), a * std::sin(angle)});
    }
    return {polygon};
  }
  switch (type) {
    case 0: return {Sphere{a}};
    case 1: return {Box{{a, b, c}}};
    case 2: return {Capsule{0.5 * a, 0.5 * b}, lying};
    case 3: return {Cylinder{a, 0.5 * b}};
    case 4: return {Cylinder{0.5 * a, b}, lying};
    case 5: return {Ellipsoid{{std::max(a, b), std::max(a, c), 0.3 * size}}};
    default: {
      Hull prism;
      const int sides = random.integer(3, 12);
      for (int i = 0; i < 2 * sides; ++i) {
        const double angle = 2 * scenes::kPi * (i / 2) / sides;
        prism.vertices.push_back(
            {a * std::cos(angle), a * std::sin(angle), i % 2 == 0 ? -0.5 * b : 0.5 * b});
      }
      return {prism};
    }
  }
}

constexpr int kTiles = 32;  // along x
constexpr int kLanes = 4;   // across, tiles of boxes

// Adjoining shapes whose surface has height 0, from x = -width on.
void add_tiles(Random& random, Scene& scene, double width, double half) {
  const bool planar = scene.space == Space::planar;
  const Vec3 up = scenes::up_of(scene.space);
  const Material smooth{0, 0};
  Body floor;
  floor.motion = Motion::fixed;
  const auto add = [&](const Geometry& geometry, const Vec3& at) {
    floor.shapes.push_back(scenes::shape_of(geometry, smooth));
    floor.shapes.back().position = at;
  };
  const int type = random.integer(0, 2);
  const bool bodies = random.chance(0.5);  // a body for each, else one body of many shapes
  const auto begin = [&](int i) { return (i - 1) * width; };
  if (type == 2) {
    if (planar) {
      Terrain terrain;
      for (int i = 0; i <= kTiles; ++i) terrain.points.push_back({begin(i), 0});
      add(terrain, Vec3::Zero());
    } else {
      const std::vector<double> flat((kTiles + 1) * (kLanes + 1), 0.0);
      add(HeightField{flat, kTiles + 1, {width, width}}, Vec3(begin(kTiles / 2), 0, 0));
    }
  } else {
    for (int i = 0; i < kTiles; ++i) {
      for (int j = 0; j < (planar ? 1 : kLanes); ++j) {
        if (planar && type == 1) {
          add(Segment{{begin(i), 0}, {begin(i + 1), 0}}, Vec3::Zero());
          continue;
        }
        const Vec3 half_extents =
            planar ? Vec3(width / 2, half, 0) : Vec3(width / 2, width / 2, half);
        const double y = planar ? 0 : (j - 0.5 * (kLanes - 1)) * width;
        add(scenes::box_of(scene.space, half_extents),
            Vec3(begin(i) + width / 2, y, 0) - half * up);
      }
    }
  }
  if (!bodies || type == 2) {
    scene.add(floor);
    return;
  }
  for (const Shape& shape : floor.shapes) {
    Body tile;
    tile.motion = Motion::fixed, tile.position = shape.position;
    tile.shapes.push_back(shape);
    tile.shapes[0].position.setZero();
    scene.add(tile);
  }
}

Drawn draw_seams(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = scene_of(space, scale);
  const bool planar = space == Space::planar;
  const Vec3 up = scenes::up_of(space);
  const double size = draw_small_size(kind, scale);
  const Slider slider = draw_slider(kind, space, size);
  const double width = size * kind.uniform(1, 4), half = size * kind.log_uniform(0.2, 2);
  add_tiles(kind, out.scene, width, half);
  // Up to a body length a step.
  const double slowest = 0.3 * std::sqrt(scale.gravity * size);
  const double fastest = kind.log_uniform(2 * slowest, std::max(2 * size / scale.dt, 3 * slowest));
  const double speed = state.log_uniform(slowest, fastest);
  // The last tile is not left.
  const double road = (kTiles - 2) * width - 3 * size;
  out.steps = std::clamp(static_cast<int>(road / (fastest * scale.dt)), 4, 90);

  Body body = dynamic_body(slider.geometry, {0, 0});
  const double heading = planar ? 0 : state.chance(0.3) ? 0 : state.uniform(-0.01, 0.01);
  const double yaw = planar || state.chance(0.3) ? 0 : state.uniform(-scenes::kPi, scenes::kPi);
  body.rotation = Quat(Eigen::AngleAxisd(yaw, Vec3::UnitZ())) * slider.rotation;
  const double height = reach(slider.geometry, space, body.rotation.conjugate() * -up);
  const double aside = planar ? 0 : 0.2 * width * state.uniform(-1, 1);
  const double along = size * state.uniform(0.5, 1.5);
  body.position = height * up + Vec3(along, aside, 0);
  body.linear_velocity = speed * Vec3(std::cos(heading), std::sin(heading), 0);
  const auto row = static_cast<std::size_t>(out.scene.add(body).index());
  const double slop = slop_of(out.scene);
  out.judge = [row, height, slop, up, v = body.linear_velocity](const Seen& seen) {
    const BodyNow& now = seen.now[row];
    if (!finite(now)) return HUGE_VAL;
    const double hop = std::abs(now.position.dot(up) - height) / slop;
    const Vec3 change = now.velocity - v;
    const Vec3 level = change - change.dot(up) * up;
    return std::max(hop, level.norm() / (0.01 * v.norm()));
  };
  return out;
}

}  // namespace

std::vector<Family> seam_families() {
  Family f;
  // A hop turns speed into height and loses it at the impact.
  f.id = "seams", f.law = Law::energy;
  f.title = "bodies slide without friction over the seams of a level floor";
  f.criterion = "larger of change of height over slop and of level velocity over 1 %";
  f.limit = 1;
  return in_both_spaces(f, draw_seams);
}

}  // namespace manyworlds::invariants
