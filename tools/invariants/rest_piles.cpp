// Columns, walls, pyramids and planks.
#include <algorithm>
#include <cmath>

#include "tools/invariants/rest_assembly.hpp"

namespace manyworlds::invariants {
namespace {

Vec3 at(Space space, double x, double y, double z) {  // z: upward
  return space == Space::planar ? Vec3(x, z, 0) : Vec3(x, y, z);
}
Geometry brick(Space space, double a, double b, double c) {
  if (space == Space::planar) return Polygon::box(a, c);
  return Box{{a, b, c}};
}
double bodies_volume(Space space, double a, double b, double c) {
  return space == Space::planar ? 4 * a * c : 8 * a * b * c;
}

Assembly column(Space space, Random& r, const Scale& scale, double ease) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.05, 2), size = 0.5 * scale.length;
  out.scene.add(scenes::ground(space, friction));
  const int levels = r.integer(2, 8);
  const double ratio = r.log_uniform(1, 100), off = 0.5 * (1 - ease);
  double height = 0;
  for (int i = 0; i < levels; ++i) {
    const double a = size * r.uniform(0.3, 1), b = size * r.uniform(0.3, 1);
    const double c = size * r.uniform(0.15, 0.6);
    const double x = off * a * r.uniform(-1, 1), y = off * b * r.uniform(-1, 1);
    const double yaw = space == Space::planar ? 0 : r.uniform(-scenes::kPi, scenes::kPi);
    const Geometry geometry = draw_brick(r, space, a, b, c);
    const double mass = draw_mass(r, scale, ratio);
    const Quat turn(Eigen::AngleAxisd(yaw, Vec3::UnitZ()));
    add_block(out.scene, geometry, at(space, x, y, height + c), turn, mass, friction);
    height += 2 * c;
  }
  return out;
}

// Equal blocks, one of which is heavy: in balance whatever the masses.
Assembly heavy_column(Space space, double low, double high, Random& r, const Scale& scale, double) {
  Assembly out{scene_of(space, scale)};
  out.is_known = true;
  const double friction = r.log_uniform(0.05, 2), size = 0.5 * scale.length;
  out.scene.add(scenes::ground(space, friction));
  const int levels = r.integer(2, 4), heavy = r.integer(1, levels - 1);
  const double a = size * r.uniform(0.5, 1), b = size * r.uniform(0.5, 1);
  const double c = size * r.uniform(0.3, 0.6), ratio = r.log_uniform(low, high);
  const double mass = draw_mass(r, scale, 1);
  for (int i = 0; i < levels; ++i) {
    add_block(out.scene, brick(space, a, b, c), at(space, 0, 0, (2 * i + 1) * c), Quat::Identity(),
              i == heavy ? ratio * mass : mass, friction);
  }
  return out;
}

// Rows of bricks; a wall keeps its width, a pyramid loses a brick per row.
Assembly wall(Space space, Random& r, const Scale& scale, double) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.1, 2), size = 0.5 * scale.length;
  out.scene.add(scenes::ground(space, friction));
  const bool pyramid = r.chance(0.5);
  const int wide = r.integer(2, 4), rows = pyramid ? wide : r.integer(2, 4);
  const double a = size * r.uniform(0.4, 1), b = size * r.uniform(0.3, 1);
  const double c = size * r.uniform(0.15, 0.5), gap = r.chance(0.5) ? 0 : a * r.uniform(0.02, 0.5);
  const double density = draw_mass(r, scale, 10) / bodies_volume(space, size, size, size);
  const auto put = [&](double x, int row, double half) {
    add_block(out.scene, brick(space, half, b, c), at(space, x, 0, (2 * row + 1) * c),
              Quat::Identity(), density * bodies_volume(space, half, b, c), friction);
  };
  const double pitch = 2 * a + gap;
  for (int row = 0; row < rows; ++row) {
    const bool shifted = !pyramid && row % 2 == 1;
    const int count = pyramid ? wide - row : shifted ? wide - 1 : wide;
    const double first = -0.5 * (count - 1) * pitch;
    for (int i = 0; i < count; ++i) put(first + i * pitch, row, a);
    if (!shifted) continue;
    // Half bricks flush with the ends.
    const double half = 0.5 * (a - 0.5 * gap), end = 0.5 * (wide - 1) * pitch + a - half;
    put(-end, row, half), put(end, row, half);
  }
  return out;
}

// Posts and lintels, one storey on the other, with a load on top.
Assembly lintels(Space space, Random& r, const Scale& scale, double ease) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.2, 2), size = 0.5 * scale.length;
  out.scene.add(scenes::ground(space, friction));
  const int storeys = r.integer(1, 3);
  const double half = size * r.uniform(0.8, 2), thick = size * r.uniform(0.05, 0.2);
  const double b = size * r.uniform(0.3, 1), post = size * r.uniform(0.1, 0.4);
  const double tall = size * r.uniform(0.15, 0.8), ratio = r.log_uniform(1, 100);
  double height = 0;
  for (int i = 0; i < storeys; ++i) {
    const double span = half * r.uniform(0.5, 0.9),
                 aside = 0.05 * half * r.uniform(-1, 1) * (1 - ease);
    for (const double side : {-1.0, 1.0}) {
      const double mass = draw_mass(r, scale, ratio);
      add_block(out.scene, brick(space, post, b, tall), at(space, side * span, 0, height + tall),
                Quat::Identity(), mass, friction);
    }
    height += 2 * tall;
    const double mass = draw_mass(r, scale, ratio);
    add_block(out.scene, brick(space, half + post, b, thick), at(space, aside, 0, height + thick),
              Quat::Identity(), mass, friction);
    height += 2 * thick;
  }
  const double a = size * r.uniform(0.2, 0.6), c = size * r.uniform(0.2, 0.6);
  const double x = 0.4 * half * r.uniform(-1, 1), mass = draw_mass(r, scale, ratio);
  add_block(out.scene, brick(space, a, std::min(a, b), c), at(space, x, 0, height + c),
            Quat::Identity(), mass, friction);
  return out;
}

// Layers of two or three parallel planks, each across the one below.
Assembly plank_tower(Random& r, const Scale& scale, double) {
  Assembly out{scene_of(Space::spatial, scale)};
  const double friction = r.log_uniform(0.1, 2), size = 0.5 * scale.length;
  out.scene.add(scenes::ground(Space::spatial, friction));
  const int layers = r.integer(3, 5), planks = r.integer(2, 3);
  const double half = size * r.uniform(0.6, 1), c = size * r.uniform(0.05, 0.15);
  const double b = half / planks * r.uniform(0.3, 0.95), mass = draw_mass(r, scale, 1);
  // At least a little more than side by side.
  const double least = 1.02 * (planks - 1) * b;
  const double apart = least + (half - b - least) * r.uniform(0, 1);
  for (int layer = 0; layer < layers; ++layer) {
    const Quat turn(Eigen::AngleAxisd(layer % 2 == 0 ? 0 : scenes::kPi / 2, Vec3::UnitZ()));
    for (int i = 0; i < planks; ++i) {
      const double y = apart * (2.0 * i / (planks - 1) - 1);
      add_block(out.scene, Box{{half, b, c}},
                turn * Vec3(0, y, 0) + Vec3(0, 0, (2 * layer + 1) * c), turn, mass, friction);
    }
  }
  return out;
}

// A plank over two fixed blocks, loaded beyond or between them.
Assembly plank(Space space, Random& r, const Scale& scale, double ease) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.1, 2), size = 0.5 * scale.length;
  const double half = size * r.uniform(1, 3), thick = size * r.uniform(0.05, 0.3);
  const double b = size * r.uniform(0.2, 1), support = size * r.uniform(0.1, 0.5);
  const double left = -half * r.uniform(0.3, 0.9), right = half * r.uniform(0.3, 0.9);
  for (const double x : {left, right}) {
    add_fixed(out.scene, brick(space, support, b, support), at(space, x, 0, -support),
              Quat::Identity(), friction);
  }
  const double ratio = r.log_uniform(1, 100), mass = draw_mass(r, scale, ratio);
  add_block(out.scene, brick(space, half, b, thick), at(space, 0, 0, thick), Quat::Identity(), mass,
            friction);
  const int loads = r.integer(0, 2);
  for (int i = 0; i < loads; ++i) {
    const double a = std::min(0.3 * half, size * r.uniform(0.2, 0.6)),
                 c = size * r.uniform(0.2, 0.6);
    const double x = (half - a) * r.uniform(0, 1) * (i == 0 ? -1 : 1) * (1 - 0.5 * ease);
    const double load = draw_mass(r, scale, ratio);
    const double gap = i == 0 ? std::min(x, -1.05 * a) : std::max(x, 1.05 * a);
    add_block(out.scene, brick(space, a, std::min(a, b), c), at(space, gap, 0, 2 * thick + c),
              Quat::Identity(), load, friction);
  }
  out.free = false, out.shift = at(space, 0.1 * support, 0, 0);
  return out;
}

}  // namespace

std::vector<Family> rest_pile_families() {
  std::vector<Family> out;
  for (const Space space : {Space::spatial, Space::planar}) {
    const std::string end = space == Space::planar ? " 2D" : " 3D";
    const auto in = [space](auto make) {
      return
          [space, make](Random& r, const Scale& s, double ease) { return make(space, r, s, ease); };
    };
    out.push_back(rest_family("column" + end, "2 to 8 blocks, ratios of mass to 100", in(column)));
    for (const auto& [low, high, name] :
         {std::tuple(100.0, 1000.0, "column to 1e3"), {1000.0, 10000.0, "column to 1e4"}}) {
      const auto make = [space, low = low, high = high](Random& r, const Scale& s, double ease) {
        return heavy_column(space, low, high, r, s, ease);
      };
      out.push_back(rest_family(name + end, "2 to 4 equal blocks, one of which is heavy", make));
      out.back().required = false;
    }
    out.push_back(
        rest_family("wall" + end, "walls and pyramids of bricks, with gaps or touching", in(wall)));
    out.push_back(rest_family("lintels" + end, "posts and lintels of 1 to 3 storeys with a load",
                              in(lintels)));
    out.push_back(rest_family("plank" + end, "a plank over two fixed blocks with up to two loads",
                              in(plank)));
  }
  out.push_back(rest_family("plank tower", "3 to 5 layers of planks crosswise", plank_tower));
  return out;
}

}  // namespace manyworlds::invariants
