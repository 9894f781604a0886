// The planar scenes in Box2D 2.4.
#include <box2d/box2d.h>

#include <algorithm>
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
      last = added;
    }
  }

  void step() override { world_.Step(real(kStep), kVelocityIterations, kPositionIterations); }

  // Of the surfaces that Box2D keeps apart, which for polygons include a skin of 10 mm.
  double overlap() override {
    float most = 0;
    for (b2Contact* c = world_.GetContactList(); c != nullptr; c = c->GetNext()) {
      if (!c->IsTouching()) continue;
      b2WorldManifold manifold;
      c->GetWorldManifold(&manifold);
      for (int i = 0; i < c->GetManifold()->pointCount; ++i) {
        most = std::max(most, -manifold.separations[i]);
      }
    }
    return most;
  }

  double gap() override {
    float most = 0;
    for (b2Joint* j = world_.GetJointList(); j != nullptr; j = j->GetNext()) {
      most = std::max(most, (j->GetAnchorA() - j->GetAnchorB()).Length());
    }
    return most;
  }

  Heights heights() override {
    Heights out;
    for (b2Body* b = world_.GetBodyList(); b != nullptr; b = b->GetNext()) {
      if (b->GetType() == b2_dynamicBody) out.add(b->GetPosition().y);
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
      const b2MassData mass = capsule_mass(from);
      body->SetMassData(&mass);
    }
    return body;
  }

  // A rectangle and two half circles, whose centroids are 4r/3pi beyond its ends.
  static b2MassData capsule_mass(const Body& from) {
    constexpr double kPi = 3.14159265358979323846;
    const double r = from.radius, h = from.half;
    const double rectangle = kPlanarDensity * 4 * r * h, ends = kPlanarDensity * kPi * r * r;
    const double centroid = 4 * r / (3 * kPi);
    const double about_centroid = r * r / 2 - centroid * centroid;  // per mass of an end
    const double arm = h + centroid;
    b2MassData out;
    out.mass = real(rectangle + ends);
    out.center.SetZero();
    out.I = real(rectangle * (r * r + h * h) / 3 + ends * (about_centroid + arm * arm));
    return out;
  }

  b2World world_;
};

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  Engine engine;
  engine.name = "Box2D";
  engine.version = PEER_BOX2D_VERSION;  // b2_version of 2.4.1 says 2.4.0
  engine.planar = true;
  engine.settings = [](const World& world) {
    return std::string(
               "float32, 8 velocity and 3 position iterations, continuous collision as by default, "
               "no sleep") +
           (world.chain ? "" : "; overlap is of polygons with their skin of 10 mm");
  };
  engine.make = [](const World& world) { return std::make_unique<Box2dWorld>(world); };
  return run_peer(argc, argv, engine);
}
