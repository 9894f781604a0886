// The spatial scenes in Box3D.
#include <box3d/box3d.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {
namespace {

constexpr int kSubsteps = 4;  // what its documentation recommends

float real(double x) { return static_cast<float>(x); }
b3Vec3 vector(const std::array<double, 3>& v) { return {real(v[0]), real(v[1]), real(v[2])}; }

class Box3dWorld final : public Simulation {
 public:
  explicit Box3dWorld(const World& from) {
    b3WorldDef def = b3DefaultWorldDef();
    def.gravity = {0, 0, real(-kGravity)};
    def.enableSleep = false;
    def.workerCount = 1;
    world_ = b3CreateWorld(&def);
    if (!b3World_IsValid(world_)) throw std::runtime_error("Box3D: no room for another world");
    shape_ = b3DefaultShapeDef();
    shape_.density = real(kDensity);
    shape_.baseMaterial.friction = real(kFriction);            // the pair's is the geometric mean
    shape_.baseMaterial.restitution = real(from.restitution);  // and the larger one
    if (from.chain) shape_.filter.maskBits = 0;

    b3BodyDef fixed = b3DefaultBodyDef();
    b3BodyId last = b3CreateBody(world_, &fixed);
    for (const Slab& slab : slabs(from)) {
      const b3Vec3 half = vector(slab.half);
      const b3BoxHull box = b3MakeOffsetBoxHull(half.x, half.y, half.z, vector(slab.centre));
      b3CreateHullShape(last, &shape_, &box.base);
    }
    for (const Body& body : from.bodies) {
      const b3BodyId added = add_body(body);
      if (from.chain) join(last, bodies_.empty() ? 0 : 0.5, added);
      bodies_.push_back(added);
      last = added;
    }
  }
  ~Box3dWorld() override { b3DestroyWorld(world_); }

  void step() override { b3World_Step(world_, real(kStep), kSubsteps); }

  std::vector<Pose> poses() override {
    std::vector<Pose> out;
    for (const b3BodyId body : bodies_) {
      const b3Pos x = b3Body_GetPosition(body);
      const b3Quat q = b3Body_GetRotation(body);
      out.push_back({{x.x, x.y, x.z}, 0, {q.s, q.v.x, q.v.y, q.v.z}});
    }
    return out;
  }

 private:
  b3BodyId add_body(const Body& from) {
    b3BodyDef def = b3DefaultBodyDef();
    def.type = b3_dynamicBody;
    def.position = vector(from.position);
    def.linearVelocity = vector(from.velocity);
    const std::array<double, 4>& q = from.rotation;
    def.rotation = {{real(q[1]), real(q[2]), real(q[3])}, real(q[0])};
    const b3BodyId body = b3CreateBody(world_, &def);
    const float r = real(from.radius), h = real(from.half);
    if (from.form == Form::ball) {
      const b3Sphere sphere = {{0, 0, 0}, r};
      b3CreateSphereShape(body, &shape_, &sphere);
    } else if (from.form == Form::box) {
      const b3BoxHull box = b3MakeCubeHull(h);
      b3CreateHullShape(body, &shape_, &box.base);
    } else {
      const b3Capsule capsule = {{-h, 0, 0}, {h, 0, 0}, r};
      b3CreateCapsuleShape(body, &shape_, &capsule);
    }
    return body;
  }

  void join(b3BodyId a, double end_of_a, b3BodyId b) {
    b3SphericalJointDef def = b3DefaultSphericalJointDef();
    def.base.bodyIdA = a, def.base.bodyIdB = b;
    def.base.localFrameA.p = {real(end_of_a), 0, 0};
    def.base.localFrameB.p = {-0.5f, 0, 0};
    b3CreateSphericalJoint(world_, &def);
  }

  b3WorldId world_;
  b3ShapeDef shape_;
  std::vector<b3BodyId> bodies_;
};

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  const b3Version version = b3GetVersion();
  Engine engine;
  engine.name = "Box3D";
  engine.version = std::to_string(version.major) + "." + std::to_string(version.minor) + "." +
                   std::to_string(version.revision);
  engine.planar = false;
  engine.settings = [](const World&) {
    return "float32, 4 substeps, all else as by default with continuous collision";
  };
  engine.make = [](const World& world) { return std::make_unique<Box3dWorld>(world); };
  return run_peer(argc, argv, engine);
}
