// The planar scenes in Box2D 2.4.
#include <box2d/box2d.h>

#include <vector>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {
namespace {

constexpr int kVelocityIterations = 8, kPositionIterations = 3;

float real(double x) { return static_cast<float>(x); }

class Box2dWorld final : public Simulation {
 public:
  explicit Box2dWorld(const World& from) : world_(b2Vec2(0, real(-kGravity))) {
    world_.SetAllowSleeping(false);
    b2BodyDef fixed;
    b2Body* ground = world_.CreateBody(&fixed);
    for (const Slab& slab : slabs(from)) {
      b2PolygonShape box;
      box.SetAsBox(real(slab.half[0]), real(slab.half[1]),
                   b2Vec2(real(slab.centre[0]), real(slab.centre[1])), 0);
      add_fixture(ground, box, from);
    }
    b2Body* last = ground;
    for (const Body& body : from.bodies) {
      b2Body* added = add_body(body, from);
      if (from.chain) {
        b2RevoluteJointDef hinge;
        hinge.Initialize(last, added, b2Vec2(real(body.position[0] - 0.5), 0));
        world_.CreateJoint(&hinge);
      }
      bodies_.push_back(added);
      last = added;
    }
  }

  void step() override { world_.Step(real(kStep), kVelocityIterations, kPositionIterations); }

  std::vector<Pose> poses() override {
    std::vector<Pose> out;
    for (const b2Body* b : bodies_) {
      out.push_back({{b->GetPosition().x, b->GetPosition().y, 0}, b->GetAngle()});
    }
    return out;
  }

 private:
  static void add_fixture(b2Body* body, const b2Shape& shape, const World& from) {
    b2FixtureDef def;
    def.shape = &shape;
    def.density = real(kPlanarDensity);
    def.friction = real(kFriction);            // the pair's is the geometric mean
    def.restitution = real(from.restitution);  // and the larger one
    if (from.chain) def.filter.maskBits = 0;
    body->CreateFixture(&def);
  }

  b2Body* add_body(const Body& from, const World& world) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position.Set(real(from.position[0]), real(from.position[1]));
    def.linearVelocity.Set(real(from.velocity[0]), real(from.velocity[1]));
    def.angle = real(from.angle);
    b2Body* body = world_.CreateBody(&def);
    b2CircleShape circle;
    circle.m_radius = real(from.radius);
    b2PolygonShape box;
    if (from.form == Form::ball) {
      add_fixture(body, circle, world);
    } else if (from.form == Form::box) {
      box.SetAsBox(real(from.half), real(from.half));
      add_fixture(body, box, world);
    } else {
      // There are no capsules. These collide with nothing: one shape will do, given their mass.
      box.SetAsBox(real(from.half + from.radius), real(from.radius));
      add_fixture(body, box, world);
      const PlanarMass of = planar_mass(from);
      const b2MassData mass = {real(of.mass), b2Vec2(0, 0), real(of.moment)};
      body->SetMassData(&mass);
    }
    return body;
  }

  b2World world_;
  std::vector<b2Body*> bodies_;  // that move
};

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  Engine engine;
  engine.name = "Box2D";
  engine.version = PEER_BOX2D_VERSION;  // b2_version of 2.4.1 says 2.4.0
  engine.planar = true;
  engine.settings = [](const World&) {
    return "float32, 8 velocity and 3 position iterations, continuous collision as by default";
  };
  engine.make = [](const World& world) { return std::make_unique<Box2dWorld>(world); };
  return run_peer(argc, argv, engine);
}
