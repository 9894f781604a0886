// The spatial scenes in Bullet 3.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {
namespace {

// Enough for the scenes here; the defaults, 4096, take 7 MB a world.
constexpr int kPool = 256;

btScalar real(double x) { return static_cast<btScalar>(x); }
btVector3 vector(const std::array<double, 3>& v) { return {real(v[0]), real(v[1]), real(v[2])}; }

btDefaultCollisionConstructionInfo pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = kPool;
  info.m_defaultMaxCollisionAlgorithmPoolSize = kPool;
  return info;
}

class BulletWorld final : public Simulation {
 public:
  explicit BulletWorld(const World& from)
      : configuration_(pools()),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    world_.setGravity(btVector3(0, 0, real(-kGravity)));
    for (const Slab& slab : slabs(from)) {
      shapes_.push_back(std::make_unique<btBoxShape>(vector(slab.half)));
      // Restitutions and frictions of a pair are multiplied.
      add(0, slab.centre, {1, 0, 0, 0}, from.restitution > 0 ? 1 : 0, from.chain);
    }
    for (const Body& body : from.bodies) add_body(body, from);
  }

  ~BulletWorld() override {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  // No substeps: one step of exactly this length.
  void step() override { world_.stepSimulation(real(kStep), 0); }

  std::vector<Pose> poses() override {
    std::vector<Pose> out;
    for (const auto& body : bodies_) {
      if (body->isStaticObject()) continue;
      const btVector3& x = body->getCenterOfMassPosition();
      const btQuaternion q = body->getOrientation();
      out.push_back({{x.x(), x.y(), x.z()}, 0, {q.w(), q.x(), q.y(), q.z()}});
    }
    return out;
  }

 private:
  // A body of the last shape; fixed where it weighs nothing.
  btRigidBody& add(double mass, const std::array<double, 3>& position,
                   const std::array<double, 4>& q, double restitution, bool ghost) {
    btCollisionShape* shape = shapes_.back().get();
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(real(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(real(mass), nullptr, shape, inertia);
    info.m_friction = real(std::sqrt(kFriction));
    info.m_restitution = real(restitution);
    info.m_startWorldTransform =
        btTransform(btQuaternion(real(q[1]), real(q[2]), real(q[3]), real(q[0])), vector(position));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& body = *bodies_.back();
    if (mass > 0) body.setActivationState(DISABLE_DEACTIVATION);
    const int group = mass > 0 ? btBroadphaseProxy::DefaultFilter : btBroadphaseProxy::StaticFilter;
    const int others = mass > 0 ? btBroadphaseProxy::AllFilter
                                : btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter;
    world_.addRigidBody(&body, group, ghost ? 0 : others);
    return body;
  }

  void add_body(const Body& from, const World& world) {
    constexpr double kPi = 3.14159265358979323846;
    const double r = from.radius, h = from.half;
    double volume = 4.0 / 3 * kPi * r * r * r;
    if (from.form == Form::ball) {
      shapes_.push_back(std::make_unique<btSphereShape>(real(r)));
    } else if (from.form == Form::box) {
      shapes_.push_back(std::make_unique<btBoxShape>(btVector3(real(h), real(h), real(h))));
      volume = 8 * h * h * h;
    } else {
      shapes_.push_back(std::make_unique<btCapsuleShapeX>(real(r), real(2 * h)));
      volume += kPi * r * r * 2 * h;
    }
    btRigidBody* last = bodies_.empty() ? nullptr : bodies_.back().get();
    btRigidBody& body =
        add(kDensity * volume, from.position, from.rotation, world.restitution, world.chain);
    body.setLinearVelocity(vector(from.velocity));
    if (!world.chain) return;
    const btVector3 end(real(h + r), 0, 0);
    if (last == nullptr) {
      joints_.push_back(std::make_unique<btPoint2PointConstraint>(body, -end));
    } else {
      joints_.push_back(std::make_unique<btPoint2PointConstraint>(*last, body, end, -end));
    }
    world_.addConstraint(joints_.back().get(), true);
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btPoint2PointConstraint>> joints_;
};

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  Engine engine;
  engine.name = "Bullet";
  engine.version =
      std::to_string(BT_BULLET_VERSION / 100) + "." + std::to_string(BT_BULLET_VERSION % 100);
  engine.planar = false;
  engine.settings = [](const World&) {
    return std::string(sizeof(btScalar) == 4 ? "float32" : "float64") +
           ", all defaults: 10 iterations, split impulses; no substeps, no sleep";
  };
  engine.make = [](const World& world) { return std::make_unique<BulletWorld>(world); };
  return run_peer(argc, argv, engine);
}
