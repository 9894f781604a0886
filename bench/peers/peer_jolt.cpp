// The spatial scenes in Jolt.
#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/RotatedTranslatedShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Constraints/PointConstraint.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

#include <cstdarg>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {
namespace {

// Of a world: more than the scenes have.
constexpr unsigned kBodies = 64, kPairs = 1024, kContacts = 1024;
constexpr unsigned kScratch = 4 * 1024 * 1024;  // bytes, shared by all worlds

enum Layer : JPH::ObjectLayer { kFixed, kMoving, kGhost };

class BroadPhaseLayers final : public JPH::BroadPhaseLayerInterface {
 public:
  unsigned GetNumBroadPhaseLayers() const override { return 3; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
    return JPH::BroadPhaseLayer(static_cast<JPH::BroadPhaseLayer::Type>(layer));
  }
};
class AgainstBroadPhase final : public JPH::ObjectVsBroadPhaseLayerFilter {
 public:
  bool ShouldCollide(JPH::ObjectLayer a, JPH::BroadPhaseLayer b) const override {
    if (a == kGhost || b == JPH::BroadPhaseLayer(kGhost)) return false;
    return a == kMoving || b == JPH::BroadPhaseLayer(kMoving);
  }
};
class Pairs final : public JPH::ObjectLayerPairFilter {
 public:
  bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
    return a != kGhost && b != kGhost && (a == kMoving || b == kMoving);
  }
};

// What all worlds share, for as long as the program runs.
struct Shared {
  Shared() : scratch(kScratch), jobs(JPH::cMaxPhysicsJobs) {}
  BroadPhaseLayers layers;
  AgainstBroadPhase against_broad_phase;
  Pairs pairs;
  JPH::TempAllocatorImpl scratch;
  JPH::JobSystemSingleThreaded jobs;
};
Shared& shared() {
  static Shared all;
  return all;
}

float real(double x) { return static_cast<float>(x); }
JPH::Vec3 vector(const std::array<double, 3>& v) {
  return JPH::Vec3(real(v[0]), real(v[1]), real(v[2]));
}

class JoltWorld final : public Simulation {
 public:
  explicit JoltWorld(const World& from) {
    system_.Init(kBodies, 1, kPairs, kContacts, shared().layers, shared().against_broad_phase,
                 shared().pairs);
    system_.SetGravity(JPH::Vec3(0, 0, real(-kGravity)));
    JPH::PhysicsSettings settings = system_.GetPhysicsSettings();
    settings.mAllowSleeping = false;
    system_.SetPhysicsSettings(settings);
    for (const Slab& slab : slabs(from)) {
      JPH::BodyCreationSettings def(new JPH::BoxShape(vector(slab.half)), vector(slab.centre),
                                    JPH::Quat::sIdentity(), JPH::EMotionType::Static, kFixed);
      add(def, from.restitution);
    }
    for (const Body& body : from.bodies) {
      JPH::Body* last = bodies_.empty() ? &JPH::Body::sFixedToWorld : bodies_.back();
      bodies_.push_back(add_body(body, from));
      if (from.chain) join(*last, *bodies_.back(), static_cast<double>(bodies_.size() - 1));
    }
    system_.OptimizeBroadPhase();
  }

  void step() override {
    const JPH::EPhysicsUpdateError error =
        system_.Update(real(kStep), 1, &shared().scratch, &shared().jobs);
    if (error != JPH::EPhysicsUpdateError::None) {
      throw std::runtime_error("Jolt: a buffer of contacts is full");
    }
  }

  std::vector<Pose> poses() override {
    std::vector<Pose> out;
    for (const JPH::Body* body : bodies_) {
      const JPH::RVec3 x = body->GetCenterOfMassPosition();
      const JPH::Quat q = body->GetRotation();
      out.push_back({{x.GetX(), x.GetY(), x.GetZ()}, 0, {q.GetW(), q.GetX(), q.GetY(), q.GetZ()}});
    }
    return out;
  }

 private:
  JPH::Body* add(JPH::BodyCreationSettings& def, double restitution) {
    def.mFriction = real(kFriction);       // the pair's is the geometric mean
    def.mRestitution = real(restitution);  // and the larger one
    def.mLinearDamping = def.mAngularDamping = 0;
    JPH::BodyInterface& bodies = system_.GetBodyInterfaceNoLock();
    JPH::Body* body = bodies.CreateBody(def);
    if (body == nullptr) throw std::runtime_error("Jolt: no room for another body");
    bodies.AddBody(body->GetID(), JPH::EActivation::Activate);
    return body;
  }

  JPH::Body* add_body(const Body& from, const World& world) {
    const std::array<double, 4>& q = from.rotation;
    const JPH::Quat rotation(real(q[1]), real(q[2]), real(q[3]), real(q[0]));
    JPH::ConvexShape* shape = nullptr;
    const float r = real(from.radius), h = real(from.half);
    if (from.form == Form::ball) {
      shape = new JPH::SphereShape(r);
    } else if (from.form == Form::box) {
      shape = new JPH::BoxShape(JPH::Vec3::sReplicate(h));
    } else {
      shape = new JPH::CapsuleShape(h, r);  // along y
    }
    shape->SetDensity(real(kDensity));
    JPH::RefConst<JPH::Shape> placed = shape;
    if (from.form == Form::capsule) {
      const JPH::Quat y_to_x = JPH::Quat::sRotation(JPH::Vec3::sAxisZ(), -0.5f * JPH::JPH_PI);
      placed = new JPH::RotatedTranslatedShape(JPH::Vec3::sZero(), y_to_x, shape);
    }
    JPH::BodyCreationSettings def(placed, vector(from.position), rotation,
                                  JPH::EMotionType::Dynamic, world.chain ? kGhost : kMoving);
    def.mLinearVelocity = vector(from.velocity);
    return add(def, world.restitution);
  }

  void join(JPH::Body& a, JPH::Body& b, double x) {
    JPH::PointConstraintSettings ball;  // in the world
    ball.mPoint1 = ball.mPoint2 = JPH::RVec3(real(x), 0, 0);
    system_.AddConstraint(ball.Create(a, b));
  }

  JPH::PhysicsSystem system_;
  std::vector<JPH::Body*> bodies_;  // that move; the system's
};

void trace(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  std::vfprintf(stderr, format, arguments);
  va_end(arguments);
  std::fputc('\n', stderr);
}

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  JPH::RegisterDefaultAllocator();
  JPH::Trace = trace;
  JPH::Factory::sInstance = new JPH::Factory();
  JPH::RegisterTypes();
  Engine engine;
  engine.name = "Jolt";
  engine.version = std::to_string(JPH_VERSION_MAJOR) + "." + std::to_string(JPH_VERSION_MINOR) +
                   "." + std::to_string(JPH_VERSION_PATCH);
  engine.planar = false;
  engine.settings = [](const World&) {
    return "float32, all defaults but damping: 10 velocity and 2 position iterations, penetration "
           "slop 20 mm";
  };
  engine.make = [](const World& world) { return std::make_unique<JoltWorld>(world); };
  return run_peer(argc, argv, engine);
}
