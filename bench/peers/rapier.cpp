#include "bench/peers/rapier.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace manyworlds::peers {
namespace {

PeerBody plain(const Body& from) {
  PeerBody out{};
  out.form = from.form == Form::ball ? 0 : from.form == Form::box ? 1 : 2;
  out.radius = from.radius, out.half = from.half, out.angle = from.angle;
  std::copy(from.position.begin(), from.position.end(), out.position);
  std::copy(from.velocity.begin(), from.velocity.end(), out.velocity);
  std::copy(from.rotation.begin(), from.rotation.end(), out.rotation);
  return out;
}

PeerSlab plain(const Slab& from) {
  PeerSlab out{};
  std::copy(from.centre.begin(), from.centre.end(), out.centre);
  std::copy(from.half.begin(), from.half.end(), out.half);
  return out;
}

class Rapier final : public Simulation {
 public:
  explicit Rapier(const World& from) : poses_(from.bodies.size()) {
    std::vector<PeerBody> bodies;
    std::vector<PeerSlab> walls;
    for (const Body& body : from.bodies) bodies.push_back(plain(body));
    for (const Slab& slab : slabs(from)) walls.push_back(plain(slab));
    const double density = from.planar ? kPlanarDensity : kDensity;
    const PeerScene scene = {
        kStep,      kGravity,      kFriction,     density,      from.restitution,
        from.chain, bodies.data(), bodies.size(), walls.data(), walls.size()};
    world_.reset(peer_rapier_make(&scene));
  }

  void step() override { peer_rapier_step(world_.get()); }

  std::vector<Pose> poses() override {
    peer_rapier_poses(world_.get(), poses_.data());
    std::vector<Pose> out;
    for (const PeerPose& from : poses_) {
      Pose pose;
      std::copy_n(from.position, 3, pose.position.begin());
      pose.angle = from.angle;
      std::copy_n(from.rotation, 4, pose.rotation.begin());
      out.push_back(pose);
    }
    return out;
  }

 private:
  struct Free {
    void operator()(RapierWorld* world) const { peer_rapier_free(world); }
  };
  std::unique_ptr<RapierWorld, Free> world_;
  std::vector<PeerPose> poses_;
};

}  // namespace

Engine rapier_engine(bool planar) {
  Engine engine;
  engine.name = "Rapier";
  engine.version = peer_rapier_version();
  engine.planar = planar;
  engine.settings = [](const World&) {
    return "float32, all defaults: 4 iterations, each a substep; continuous collision, contact "
           "recycling";
  };
  engine.make = [](const World& world) { return std::make_unique<Rapier>(world); };
  return engine;
}

}  // namespace manyworlds::peers
