// The planar scenes in Chipmunk.
#include <chipmunk/chipmunk.h>

#include <cmath>
#include <string>
#include <vector>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {
namespace {

// m. The default, 0.1, is meant for pixels; this is what engines that think in metres have.
constexpr double kSlop = 0.005;

cpFloat real(double x) { return static_cast<cpFloat>(x); }
cpVect at(double x, double y) { return cpv(real(x), real(y)); }

class ChipmunkWorld final : public Simulation {
 public:
  explicit ChipmunkWorld(const World& from) : space_(cpSpaceNew()) {
    cpSpaceSetGravity(space_, at(0, -kGravity));
    cpSpaceSetCollisionSlop(space_, real(kSlop));
    cpBody* last = cpSpaceGetStaticBody(space_);
    for (const Slab& slab : slabs(from)) {
      const cpVect middle = at(slab.centre[0], slab.centre[1]);
      const cpBB box = cpBBNewForExtents(middle, real(slab.half[0]), real(slab.half[1]));
      add(cpBoxShapeNew2(last, box, 0), 1, from);
    }
    for (const Body& body : from.bodies) {
      cpBody* added = add_body(body, from);
      bodies_.push_back(added);
      if (from.chain) {
        const cpVect end = at(body.position[0] - 0.5, body.position[1]);
        joints_.push_back(cpSpaceAddConstraint(space_, cpPivotJointNew(last, added, end)));
      }
      last = added;
    }
  }
  ~ChipmunkWorld() override {
    for (cpConstraint* joint : joints_) {
      cpSpaceRemoveConstraint(space_, joint);
      cpConstraintFree(joint);
    }
    for (cpShape* shape : shapes_) {
      cpSpaceRemoveShape(space_, shape);
      cpShapeFree(shape);
    }
    for (cpBody* body : bodies_) {
      cpSpaceRemoveBody(space_, body);
      cpBodyFree(body);
    }
    cpSpaceFree(space_);
  }

  void step() override { cpSpaceStep(space_, real(kStep)); }

  std::vector<Pose> poses() override {
    std::vector<Pose> out;
    for (const cpBody* body : bodies_) {
      const cpVect x = cpBodyGetPosition(body);
      out.push_back({{x.x, x.y, 0}, cpBodyGetAngle(body)});
    }
    return out;
  }

 private:
  // Frictions and elasticities of a pair are multiplied.
  void add(cpShape* shape, double elasticity, const World& world) {
    cpShapeSetFriction(shape, real(std::sqrt(kFriction)));
    cpShapeSetElasticity(shape, real(world.restitution > 0 ? elasticity : 0));
    if (world.chain) cpShapeSetFilter(shape, CP_SHAPE_FILTER_NONE);
    shapes_.push_back(cpSpaceAddShape(space_, shape));
  }

  cpBody* add_body(const Body& from, const World& world) {
    const PlanarMass mass = planar_mass(from);
    cpBody* body = cpSpaceAddBody(space_, cpBodyNew(real(mass.mass), real(mass.moment)));
    cpBodySetPosition(body, at(from.position[0], from.position[1]));
    cpBodySetVelocity(body, at(from.velocity[0], from.velocity[1]));
    cpBodySetAngle(body, real(from.angle));
    cpShape* shape = nullptr;
    if (from.form == Form::ball) {
      shape = cpCircleShapeNew(body, real(from.radius), cpvzero);
    } else if (from.form == Form::box) {
      shape = cpBoxShapeNew(body, real(2 * from.half), real(2 * from.half), 0);
    } else {
      shape = cpSegmentShapeNew(body, at(-from.half, 0), at(from.half, 0), real(from.radius));
    }
    add(shape, world.restitution, world);
    return body;
  }

  cpSpace* space_;
  std::vector<cpBody*> bodies_;  // that move
  std::vector<cpShape*> shapes_;
  std::vector<cpConstraint*> joints_;
};

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  Engine engine;
  engine.name = "Chipmunk";
  engine.version = cpVersionString;
  engine.planar = true;
  engine.settings = [](const World&) {
    return std::string(sizeof(cpFloat) == 4 ? "float32" : "float64") +
           ", collision slop of 5 mm, all else as by default: 10 iterations";
  };
  engine.make = [](const World& world) { return std::make_unique<ChipmunkWorld>(world); };
  return run_peer(argc, argv, engine);
}
