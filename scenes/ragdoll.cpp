// A ragdoll of 11 bodies on ball joints with cone and twist limits and on limited hinges, thrown
// down a stair.
#include <cmath>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr int kSteps = 8;
constexpr double kTread = 0.6, kRise = 0.3;  // m

// Its limbs hang along -z, so their capsules lie along z, and the joints' z axes run along them.
class Doll {
 public:
  Doll(Scene& scene, const Vec3& pelvis) : scene_(scene), origin_(pelvis) {}

  BodyId box(const char* name, const Vec3& at, const Vec3& half) {
    return add(name, at, Box{half});
  }
  BodyId ball(const char* name, const Vec3& at, double radius) {
    return add(name, at, Sphere{radius});
  }
  BodyId limb(const char* name, const Vec3& at, double radius, double half_length) {
    return add(name, at, Capsule{radius, half_length});
  }
  // Swings within a cone, half angle in rad, about the direction in which the limb hangs.
  void socket(BodyId parent, BodyId child, const Vec3& at, double cone, double twist) {
    join(parent, child, {at, Quat::Identity()}, BallJoint{cone, Limit{-twist, twist, {}}});
  }
  // Bends about y, which points to the doll's left: from `low` to `high`.
  void hinge(BodyId parent, BodyId child, const Vec3& at, double low, double high) {
    const double half = std::sqrt(0.5);
    join(parent, child, {at, Quat(half, -half, 0, 0)}, HingeJoint{Limit{low, high, {}}, {}});
  }

 private:
  BodyId add(const char* name, const Vec3& at, Geometry geometry) {
    Body body = named_body(name, origin_ + at, std::move(geometry));
    body.linear_velocity = {2, 0, 0};
    const BodyId index = scene_.add(body);
    if (!pelvis_) {
      pelvis_ = index;
      scene_.bodies.back().jitter = {
          .position = {0.2, 0.5, 0.1}, .linear_velocity = {0.5, 0.5, 0}, .angle = 0.5};
    } else {
      scene_.bodies.back().jitter.with = pelvis_;
    }
    return index;
  }
  void join(BodyId parent, BodyId child, Frame frame, JointType type) {
    frame.position += origin_;
    scene_.add(joint_at(scene_, parent, child, frame, std::move(type)));
  }

  Scene& scene_;
  Vec3 origin_;
  BodyId pelvis_;  // the first of its bodies, with which the others begin
};

void add_stair(Scene& scene) {
  scene.add(ground(Space::spatial));
  Body stair;
  stair.name = "stair";
  stair.motion = Motion::fixed;
  for (int i = 0; i < kSteps; ++i) {
    const double height = (kSteps - i) * kRise;
    Shape step = shape_of(Box{{kTread / 2, 2, height / 2}});
    step.position = {(i + 0.5) * kTread, 0, height / 2};
    stair.shapes.push_back(step);
  }
  Shape landing = shape_of(Box{{1, 2, kSteps * kRise / 2}});
  landing.position = {-1, 0, kSteps * kRise / 2};
  stair.shapes.push_back(landing);
  scene.add(stair);
}

}  // namespace

Scene ragdoll() {
  Scene scene = spatial_scene("ragdoll");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-50, -50, -0.5), Vec3(50, 50, 50));
  add_stair(scene);

  Doll doll(scene, {-0.6, 0, kSteps * kRise + 1});
  const BodyId pelvis = doll.box("pelvis", {0, 0, 0}, {0.1, 0.16, 0.09});
  const BodyId chest = doll.box("chest", {0, 0, 0.35}, {0.11, 0.18, 0.2});
  const BodyId head = doll.ball("head", {0, 0, 0.72}, 0.12);
  doll.socket(pelvis, chest, {0, 0, 0.12}, 0.5, 0.4);
  doll.socket(chest, head, {0, 0, 0.58}, 0.6, 0.8);
  for (const double side : {-1.0, 1.0}) {
    const bool left = side > 0;
    const BodyId upper =
        doll.limb(left ? "left upper arm" : "right upper arm", {0, side * 0.25, 0.35}, 0.05, 0.11);
    const BodyId fore =
        doll.limb(left ? "left forearm" : "right forearm", {0, side * 0.25, 0.06}, 0.045, 0.1);
    doll.socket(chest, upper, {0, side * 0.25, 0.5}, 1.4, 0.8);
    doll.hinge(upper, fore, {0, side * 0.25, 0.2}, -2.2, 0.05);
    const BodyId thigh =
        doll.limb(left ? "left thigh" : "right thigh", {0, side * 0.1, -0.3}, 0.075, 0.14);
    const BodyId shin =
        doll.limb(left ? "left shin" : "right shin", {0, side * 0.1, -0.73}, 0.06, 0.15);
    doll.socket(pelvis, thigh, {0, side * 0.1, -0.09}, 1.0, 0.4);
    doll.hinge(thigh, shin, {0, side * 0.1, -0.52}, -0.05, 2.2);
  }
  return scene;
}

}  // namespace manyworlds::scenes
