// Which scenes are measured, and when. Piles are taken while they still move a little, games while
// balls collide.
#include <cstddef>
#include <utility>

#include "bench/fixture.hpp"

namespace manyworlds::bench {
namespace {

template <std::size_t kLength>
struct SceneName {
  constexpr SceneName(const char (&text)[kLength]) {
    for (std::size_t i = 0; i < kLength; ++i) chars[i] = text[i];
  }
  char chars[kLength]{};
};

template <SceneName kName>
Scene named() {
  return scenes::find(kName.chars)->make();
}

// Fixed obstacles on the floor, for the pairs that no named scene has.
template <SceneName kName>
Scene with_obstacles() {
  Scene scene = named<kName>();
  const auto add = [&scene](Geometry geometry, double x) {
    Body body;
    body.motion = Motion::fixed;
    body.position.x() = x;
    body.shapes.emplace_back().geometry = std::move(geometry);
    scene.add(std::move(body));
  };
  if (scene.space == Space::planar) {
    for (const double x : {-3.0, -1.0, 1.0, 3.0}) add(Circle{0.5}, x);
    for (const double x : {-4.0, -2.0, 0.0, 2.0, 4.0}) add(Polygon::box(0.3, 0.3), x);
  } else {
    add(Sphere{0.5}, -1);
    add(Box{{0.4, 0.4, 0.4}}, 1);
  }
  return scene;
}

// Every third moving body a capsule.
void make_capsules(Scene& scene) {
  int moving = 0;
  for (Body& body : scene.bodies) {
    if (body.motion != Motion::dynamic || moving++ % 3 != 0) continue;
    body.mass_properties.reset();
    body.shapes.resize(1);
    body.shapes[0].geometry = Capsule{0.2, 0.2};
  }
}

// And some fixed ones between the obstacles.
template <SceneName kName>
Scene with_capsules() {
  Scene scene = with_obstacles<kName>();
  make_capsules(scene);
  const auto add = [&scene](Geometry geometry, const Vec3& at) {
    Body body;
    body.motion = Motion::fixed;
    body.position = at;
    body.shapes.emplace_back().geometry = std::move(geometry);
    scene.add(std::move(body));
  };
  if (scene.space == Space::spatial) {
    add(Capsule{0.3, 0.4}, {0, 1, 0});
    add(Box{{1.5, 0.3, 0.3}}, {0, -0.6, 0});
  } else {
    for (const double x : {-2.5, -0.5, 1.5}) add(Capsule{0.2, 0.2}, {x, 0.3, 0});
  }
  return scene;
}

// Every other moving body a cylinder or a hull, and some fixed ones.
Scene with_convex() {
  Scene scene = with_capsules<"mixed-pile">();
  const Hull wedge{{{-0.3, -0.2, -0.2},
                    {0.3, -0.2, -0.2},
                    {0, 0.3, -0.2},
                    {-0.2, -0.1, 0.3},
                    {0.2, -0.2, 0.3},
                    {0, 0.2, 0.2}}};
  int moving = 0;
  for (Body& body : scene.bodies) {
    if (body.motion != Motion::dynamic || moving++ % 2 != 0) continue;
    body.mass_properties.reset();
    body.shapes.resize(1);
    body.shapes[0].geometry = Cylinder{0.2, 0.25};
    if (moving % 4 == 1) body.shapes[0].geometry = wedge;
  }
  for (const Geometry& geometry : {Geometry(Cylinder{0.4, 0.3}), Geometry(wedge)}) {
    Body body;
    body.motion = Motion::fixed;
    body.position = {geometry.index() % 2 == 0 ? -1.5 : 1.5, -1, 0.2};
    body.shapes.emplace_back().geometry = geometry;
    scene.add(std::move(body));
  }
  return scene;
}

// A planar scene on a rough floor.
template <SceneName kName>
Scene with_terrain() {
  Scene scene = named<kName>();
  make_capsules(scene);
  Terrain terrain;
  for (int i = 0; i <= 20; ++i) terrain.points.emplace_back(-5 + 0.5 * i, i % 2 == 0 ? 0.1 : 0.2);
  Body floor;
  floor.motion = Motion::fixed;
  floor.shapes.emplace_back().geometry = std::move(terrain);
  scene.add(std::move(floor));
  return scene;
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> kAll = {
      {"bin-spheres", named<"bin-spheres">, 120},
      {"bin-boxes", named<"bin-boxes">, 120},
      {"stack10", named<"stack10">, 120},
      {"mixed-pile", named<"mixed-pile">, 120},
      {"domino", named<"domino">, 120},
      {"ball3d", named<"ball3d">, 60},
      {"free-flight", named<"free-flight">, 60},
      {"bin2d", named<"bin2d">, 120},
      {"pyramid2d", named<"pyramid2d">, 120},
      {"mixed-pile2d", named<"mixed-pile2d">, 120},
      {"billiards", named<"billiards">, 38},
      {"newton-cradle", named<"newton-cradle">, 60},
      {"ball2d", named<"ball2d">, 60},
  };
  return kAll;
}

const std::vector<Scenario>& scenarios_of_pairs() {
  static const std::vector<Scenario> kAll = [] {
    std::vector<Scenario> all = scenarios();
    all.push_back({"mixed-pile+obstacles", with_obstacles<"mixed-pile">, 120});
    all.push_back({"bin2d+obstacles", with_obstacles<"bin2d">, 120});
    all.push_back({"mixed-pile2d+obstacles", with_obstacles<"mixed-pile2d">, 120});
    all.push_back({"mixed-pile+capsules", with_capsules<"mixed-pile">, 120});
    all.push_back({"mixed-pile+convex", with_convex, 120});
    all.push_back({"bin2d+capsules", with_capsules<"bin2d">, 120});
    all.push_back({"mixed-pile2d+capsules", with_capsules<"mixed-pile2d">, 120});
    all.push_back({"bin2d+terrain", with_terrain<"bin2d">, 120});
    all.push_back({"mixed-pile2d+terrain", with_terrain<"mixed-pile2d">, 120});
    return all;
  }();
  return kAll;
}

}  // namespace manyworlds::bench
