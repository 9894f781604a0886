#include "bench/peers/scenes.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace manyworlds::peers {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Uniform numbers that depend on world, body and how many came before (splitmix64).
class Draws {
 public:
  Draws(int world, int body)
      : state_(0x9e3779b97f4a7c15u * (1000003u * static_cast<std::uint64_t>(world) +
                                      static_cast<std::uint64_t>(body) + 1)) {}

  double unit() {  // [0, 1)
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double u() { return 2 * unit() - 1; }

  // Shoemake, "Uniform random rotations" (1992).
  std::array<double, 4> rotation() {
    const double s = unit(), a = 2 * kPi * unit(), b = 2 * kPi * unit();
    return {std::sqrt(s) * std::cos(b), std::sqrt(1 - s) * std::sin(a),
            std::sqrt(1 - s) * std::cos(a), std::sqrt(s) * std::sin(b)};
  }

 private:
  std::uint64_t state_;
};

void add_bin2d(World& world, int index) {
  world.inner = 5;
  for (int i = 0; i < 40; ++i) {
    Draws draw(index, i);
    const int column = i % 8, row = i / 8;
    Body body;
    body.form = (column + row) % 2 == 1 ? Form::box : Form::ball;
    body.radius = 0.5, body.half = 0.4;
    body.position = {(column - 3.5) * 1.2 + 0.05 * draw.u(), 1 + 1.45 * row + 0.05 * draw.u(), 0};
    body.angle = 1.5 * draw.u();
    world.bodies.push_back(body);
  }
}

void add_pyramid2d(World& world, int index) {
  world.stands = 4.4;
  for (int row = 0; row < 5; ++row) {
    for (int k = 0; k < 5 - row; ++k) {
      Draws draw(index, static_cast<int>(world.bodies.size()));
      Body body;
      body.form = Form::box, body.half = 0.5;
      body.position = {(k - (4 - row) / 2.0) * 1.1 + 0.01 * draw.u(), 0.5 + row, 0};
      world.bodies.push_back(body);
    }
  }
}

void add_bin3d(World& world, int index, Form form) {
  world.inner = 2;
  for (int i = 0; i < 20; ++i) {
    Draws draw(index, i);
    const int k = i % 9, layer = i / 9;
    Body body;
    body.form = form, body.radius = 0.5, body.half = 0.4;
    body.position = {(k % 3 - 1) * 1.3 + 0.05 * draw.u(), (k / 3 - 1) * 1.3 + 0.05 * draw.u(),
                     1 + 1.4 * layer + 0.05 * draw.u()};
    if (form == Form::box) body.rotation = draw.rotation();
    world.bodies.push_back(body);
  }
}

void add_stack(World& world, int index) {
  world.stands = 9.3;
  for (int i = 0; i < 10; ++i) {
    Draws draw(index, i);
    Body body;
    body.form = Form::box, body.half = 0.5;
    body.position = {0.005 * draw.u(), 0.005 * draw.u(), 0.5 + i};
    world.bodies.push_back(body);
  }
}

void add_chain(World& world, int index) {
  world.floor = 0, world.chain = true;
  for (int i = 0; i < 10; ++i) {
    Draws draw(index, i);
    Body body;
    body.form = Form::capsule, body.radius = 0.1, body.half = 0.4;
    body.position = {i + 0.5, 0, 0};
    if (world.planar) {
      body.velocity = {0, 0.1 * draw.u(), 0};
    } else {
      body.velocity = {0.1 * draw.u(), 0.1 * draw.u(), 0.1 * draw.u()};
    }
    world.bodies.push_back(body);
  }
}

void add_ball(World& world, int index) {
  world.restitution = 0.9;
  Body body;
  body.radius = 0.5;
  body.position[world.planar ? 1 : 2] = 5 + Draws(index, 0).u();
  world.bodies.push_back(body);
}

}  // namespace

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all = {
      {"bin2d", true},    {"pyramid2d", true},    {"chain2d", true},
      {"ball2d", true},   {"bin-spheres", false}, {"bin-boxes", false},
      {"stack10", false}, {"chain3d", false},     {"ball3d", false}};
  return all;
}

World draw(const std::string& name, int index) {
  World world;
  world.planar = name.ends_with("2d");
  world.floor = 20;
  if (name == "bin2d") {
    add_bin2d(world, index);
  } else if (name == "pyramid2d") {
    add_pyramid2d(world, index);
  } else if (name == "bin-spheres") {
    add_bin3d(world, index, Form::ball);
  } else if (name == "bin-boxes") {
    add_bin3d(world, index, Form::box);
  } else if (name == "stack10") {
    add_stack(world, index);
  } else if (name == "chain2d" || name == "chain3d") {
    add_chain(world, index);
  } else if (name == "ball2d" || name == "ball3d") {
    add_ball(world, index);
  } else {
    throw std::invalid_argument("no scene '" + name + "'");
  }
  return world;
}

PlanarMass planar_mass(const Body& body) {
  const double r = body.radius, h = body.half;
  if (body.form == Form::ball) {
    const double mass = kPlanarDensity * kPi * r * r;
    return {mass, mass * r * r / 2};
  }
  if (body.form == Form::box) {
    const double mass = kPlanarDensity * 4 * h * h;
    return {mass, mass * 2 * h * h / 3};
  }
  // A capsule is a rectangle and two half circles, whose centroids are 4r/3pi beyond its ends.
  const double rectangle = kPlanarDensity * 4 * r * h, ends = kPlanarDensity * kPi * r * r;
  const double centroid = 4 * r / (3 * kPi);
  const double about_centroid = r * r / 2 - centroid * centroid;  // per mass of an end
  const double arm = h + centroid;
  return {rectangle + ends, rectangle * (r * r + h * h) / 3 + ends * (about_centroid + arm * arm)};
}

std::vector<Slab> slabs(const World& world) {
  std::vector<Slab> out;
  if (world.floor == 0) return out;
  constexpr double kThin = kWallThickness / 2, kHigh = kWallHeight / 2;
  const double floor = world.inner > 0 ? world.inner + kWallThickness : world.floor;
  const double wall = world.inner + kThin;
  if (world.planar) {
    out.push_back({{0, -kThin, 0}, {floor, kThin, 0}});
    if (world.inner == 0) return out;
    for (const double side : {-wall, wall}) out.push_back({{side, kHigh, 0}, {kThin, kHigh, 0}});
    return out;
  }
  out.push_back({{0, 0, -kThin}, {floor, floor, kThin}});
  if (world.inner == 0) return out;
  for (const double side : {-wall, wall}) {
    out.push_back({{side, 0, kHigh}, {kThin, floor, kHigh}});
    out.push_back({{0, side, kHigh}, {floor, kThin, kHigh}});
  }
  return out;
}

}  // namespace manyworlds::peers
