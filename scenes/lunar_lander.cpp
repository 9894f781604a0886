// A lander with a main and two side thrusters over a pad between two hills, which every world has
// in places of its own. For controllers: thrusters are controls, legs give way on springs.
#include <cmath>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr double kPlainHalfWidth = 20;  // m, of the plain

void add_ground(Scene& scene) {
  Body plain = ground(Space::planar, {0.8, 0});
  plain.name = "plain";
  scene.add(plain);
  for (const double side : {-1.0, 1.0}) {
    Body hill;
    hill.name = side < 0 ? "left hill" : "right hill";
    hill.motion = Motion::kinematic;
    hill.position = {side * 6, 0.5, 0};
    hill.jitter.position = {1.5, 0.5, 0};
    hill.shapes.push_back(shape_of(Polygon{{{-3, -2}, {3, -2}, {1, 0.5}, {-1, 0.2}}}));
    hill.shapes.back().material.friction = 0.8;
    scene.add(hill);
  }
}

}  // namespace

Scene lunar_lander() {
  Scene scene = planar_scene("lunar-lander");
  scene.options.gravity = {0, -1.62, 0};
  scene.options.density = 5;
  scene.options.bounds =
      Eigen::AlignedBox3d(Vec3(-kPlainHalfWidth, -0.5, -1), Vec3(kPlainHalfWidth, 40, 1));
  add_ground(scene);

  Body cabin;
  cabin.name = "lander";
  cabin.position = {0, 10, 0};
  cabin.jitter.position = {3, 1, 0};
  cabin.jitter.linear_velocity = {1, 0.5, 0};
  cabin.jitter.angle = 0.2;
  cabin.shapes.push_back(shape_of(Polygon{
      {{-0.6, -0.35}, {0.6, -0.35}, {0.6, 0.05}, {0.35, 0.5}, {-0.35, 0.5}, {-0.6, 0.05}}}));
  const BodyId body = scene.add(cabin);
  const double mass = mass_properties(scene, cabin).mass;
  for (const double side : {-1.0, 1.0}) {
    const double lean = side * 0.2;  // sine of half its angle
    Body leg = named_body(side < 0 ? "left leg" : "right leg",
                          cabin.position + Vec3(side * 0.75, -0.5, 0), Capsule{0.08, 0.25});
    leg.rotation = Quat(std::sqrt(1 - lean * lean), 0, 0, lean);
    leg.jitter.with = body;
    leg.shapes.back().material.friction = 0.8;
    const BodyId lower = scene.add(leg);
    const HingeJoint hip{Limit{-0.5, 0.5, std::nullopt}, Drive{0, 0, Spring{0, 0, 5, 0.7}}};
    const Frame frame{cabin.position + Vec3(side * 0.6, -0.25, 0), Quat::Identity()};
    scene.add(joint_at(scene, body, lower, frame, hip));
  }
  scene.controls = {thrust("main", body, {0, -0.35, 0}, {0, 1, 0}, 0, 4 * mass),
                    thrust("left", body, {-0.35, 0.4, 0}, {1, 0, 0}, 0, 0.5 * mass),
                    thrust("right", body, {0.35, 0.4, 0}, {-1, 0, 0}, 0, 0.5 * mass)};
  return scene;
}

}  // namespace manyworlds::scenes
