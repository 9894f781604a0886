#include "scenes/sized.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include "manyworlds/scenes.hpp"
#include "scenes/parts.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds::scenes {
namespace {

Scene bin_of(const std::string& name, int bodies, const Geometry& geometry, bool any_orientation) {
  int side = 3;
  while (side * side * side < bodies) ++side;
  const double half_width = 2.0 / 3.0 * side;
  Scene scene = spatial_scene(name + ":" + std::to_string(bodies));
  scene.options.bounds = bounds_of(Space::spatial, half_width);
  scene.add(bin(Space::spatial, half_width));
  for (int i = 0; i < bodies; ++i) {
    const int k = i % (side * side), layer = i / (side * side);
    Body body;
    body.name = "body" + std::to_string(i);
    body.position = {(k % side - (side - 1) / 2.0) * 1.3, (k / side - (side - 1) / 2.0) * 1.3,
                     1 + 1.4 * layer};
    body.shapes.push_back(shape_of(geometry));
    body.jitter.position = {0.05, 0.05, 0.05};
    body.jitter.any_orientation = any_orientation;
    scene.add(std::move(body));
  }
  return scene;
}

Scene sized_pyramid(int base) {
  Scene scene = pyramid(base);
  scene.name += ":" + std::to_string(base);
  return scene;
}

struct Sized {
  std::string_view name;
  int least, most;
  Scene (*make)(int);
};
constexpr Sized kSized[] = {{"pyramid2d", 1, 255, sized_pyramid},
                            {"bin-spheres", 1, 32000, bin_of_spheres},
                            {"bin-boxes", 1, 32000, bin_of_boxes}};

}  // namespace

Scene pyramid(int base) {
  const double half_ground = std::max(20, base);
  Scene scene = planar_scene("pyramid2d");
  scene.options.bounds = bounds_of(Space::planar, half_ground);
  scene.options.bounds->max().y() = std::max(scene.options.bounds->max().y(), base + 1.0);
  scene.add(ground(Space::planar));
  for (int row = 0; row < base; ++row) {
    for (int k = 0; k < base - row; ++k) {
      Body box =
          named_body("box" + std::to_string(row) + "." + std::to_string(k),
                     {(k - (base - 1 - row) / 2.0) * 1.1, 0.5 + row, 0}, Polygon::box(0.5, 0.5));
      box.jitter.position = {0.01, 0, 0};
      scene.add(box);
    }
  }
  return scene;
}

Scene bin_of_spheres(int bodies) { return bin_of("bin-spheres", bodies, Sphere{0.5}, false); }
Scene bin_of_boxes(int bodies) { return bin_of("bin-boxes", bodies, Box{{0.4, 0.4, 0.4}}, true); }

std::optional<Scene> sized(std::string_view text) {
  for (const Sized& s : kSized) {
    if (!text.starts_with(s.name) || text.size() <= s.name.size() || text[s.name.size()] != ':') {
      continue;
    }
    int size = 0;
    const char *from = text.data() + s.name.size() + 1, *end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(from, end, size);
    if (error != std::errc() || stop != end || size < s.least || size > s.most) {
      throw std::invalid_argument("'" + std::string(text) + "': the size must be a whole number, " +
                                  std::to_string(s.least) + " to " + std::to_string(s.most));
    }
    const FloatMode mode;
    return s.make(size);
  }
  return std::nullopt;
}

}  // namespace manyworlds::scenes
