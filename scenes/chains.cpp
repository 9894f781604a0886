// Chains of ten hanging links. Their numbers define the benchmark and must not change.
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr int kLinks = 10;
constexpr double kReach = kLinks + 1;  // m, farther from the origin a link has come off
constexpr double kHalf = 0.5;          // m, from a link's centre to its joints

// Links lie along x, joined at their ends, the first to the world at the origin.
void add_links(Scene& scene, const Quat& along_x, const Vec3& stir, const JointType& joint) {
  scene.options.bounds = Eigen::AlignedBox3d(Vec3::Constant(-kReach), Vec3::Constant(kReach));
  for (int i = 0; i < kLinks; ++i) {
    Body link = named_body("link" + std::to_string(i), {i + kHalf, 0, 0}, Capsule{0.1, 0.4});
    link.shapes.back().rotation = along_x;
    link.shapes.back().filter.mask = 0;
    link.jitter.linear_velocity = stir;
    const BodyId body = scene.add(link);
    Frame end;
    end.position.x() = i;
    scene.add(joint_at(scene, BodyId(body.index() - 1), body, end, joint));
  }
}

}  // namespace

Scene chain2d() {
  Scene scene = planar_scene("chain2d");
  const double half_turn = 0.70710678118654752440;
  add_links(scene, Quat(half_turn, 0, 0, half_turn), {0, 0.1, 0}, HingeJoint{});
  return scene;
}

Scene chain3d() {
  Scene scene = spatial_scene("chain3d");
  const double half_turn = 0.70710678118654752440;
  add_links(scene, Quat(half_turn, 0, half_turn, 0), {0.1, 0.1, 0.1}, BallJoint{});
  return scene;
}

}  // namespace manyworlds::scenes
