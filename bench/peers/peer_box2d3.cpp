// The planar scenes in Box2D 3.
#include <box2d/box2d.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {
namespace {

constexpr int kSubsteps = 4;  // what its documentation recommends

float real(double x) { return static_cast<float>(x); }

class Box2dWorld final : public Simulation {
 public:
  explicit Box2dWorld(const World& from) {
    b2WorldDef def = b2DefaultWorldDef();
    def.gravity = {0, real(-kGravity)};
    def.enableSleep = false;
    def.workerCount = 1;
    world_ = b2CreateWorld(&def);
    if (!b2World_IsValid(world_)) throw std::runtime_error("Box2D: no room for another world");
    shape_ = b2DefaultShapeDef();
    shape_.density = real(kPlanarDensity);
    shape_.material.friction = real(kFriction);            // the pair's is the geometric mean
    shape_.material.restitution = real(from.restitution);  // and the larger one
    if (from.chain) shape_.filter.maskBits = 0;

    b2BodyDef fixed = b2DefaultBodyDef();
    b2BodyId last = b2CreateBody(world_, &fixed);
    for (const Slab& slab : slabs(from)) {
      const b2Polygon box =
          b2MakeOffsetBox(real(slab.half[0]), real(slab.half[1]),
                          {real(slab.centre[0]), real(slab.centre[1])}, b2Rot_identity);
      b2CreatePolygonShape(last, &shape_, &box);
    }
    for (const Body& body : from.bodies) {
      const b2BodyId added = add_body(body);
      if (from.chain) join(last, bodies_.empty() ? 0 : 0.5, added);
      bodies_.push_back(added);
      last = added;
    }
  }
  ~Box2dWorld() override { b2DestroyWorld(world_); }

  void step() override { b2World_Step(world_, real(kStep), kSubsteps); }

  std::vector<Pose> poses() override {
    std::vector<Pose> out;
    for (const b2BodyId body : bodies_) {
      const b2Vec2 x = b2Body_GetPosition(body);
      out.push_back({{x.x, x.y, 0}, b2Rot_GetAngle(b2Body_GetRotation(body))});
    }
    return out;
  }

 private:
  b2BodyId add_body(const Body& from) {
    b2BodyDef def = b2DefaultBodyDef();
    def.type = b2_dynamicBody;
    def.position = {real(from.position[0]), real(from.position[1])};
    def.linearVelocity = {real(from.velocity[0]), real(from.velocity[1])};
    def.rotation = b2MakeRot(real(from.angle));
    const b2BodyId body = b2CreateBody(world_, &def);
    const float r = real(from.radius), h = real(from.half);
    if (from.form == Form::ball) {
      const b2Circle circle = {{0, 0}, r};
      b2CreateCircleShape(body, &shape_, &circle);
    } else if (from.form == Form::box) {
      const b2Polygon box = b2MakeBox(h, h);
      b2CreatePolygonShape(body, &shape_, &box);
    } else {
      const b2Capsule capsule = {{-h, 0}, {h, 0}, r};
      b2CreateCapsuleShape(body, &shape_, &capsule);
    }
    return body;
  }

  void join(b2BodyId a, double end_of_a, b2BodyId b) {
    b2RevoluteJointDef def = b2DefaultRevoluteJointDef();
    def.base.bodyIdA = a, def.base.bodyIdB = b;
    def.base.localFrameA.p = {real(end_of_a), 0};
    def.base.localFrameB.p = {-0.5f, 0};
    b2CreateRevoluteJoint(world_, &def);
  }

  b2WorldId world_;
  b2ShapeDef shape_;
  std::vector<b2BodyId> bodies_;
};

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  const b2Version version = b2GetVersion();
  Engine engine;
  engine.name = "Box2D";
  engine.version = std::to_string(version.major) + "." + std::to_string(version.minor) + "." +
                   std::to_string(version.revision);
  engine.planar = true;
  engine.settings = [](const World&) {
    return "float32, 4 substeps, all else as by default with continuous collision";
  };
  engine.make = [](const World& world) { return std::make_unique<Box2dWorld>(world); };
  return run_peer(argc, argv, engine);
}
