// Hits of one body with a plane and of two bodies, drawn at the moment of touch and then moved back
// in time. So the pose of the touch is known, and with it what an impact law determines.
#pragma once

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

// A rigid body without forces. Bodies that never move have an inverse mass of 0.
struct Rigid {
  double inv_mass = 0;
  Mat3 inertia = Mat3::Zero(), inv_inertia = Mat3::Zero();  // body axes
  Vec3 center = Vec3::Zero();                               // of mass, body frame

  Vec3 position = Vec3::Zero();  // of the centre of mass
  Quat rotation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 momentum = Vec3::Zero();  // angular, about the centre of mass, world

  Mat3 inverse_inertia() const;  // world
  Vec3 spin() const { return inverse_inertia() * momentum; }
  void set_spin(const Vec3& spin);
  Vec3 velocity_at(const Vec3& point) const { return velocity + spin().cross(point - position); }
  Vec3 origin() const { return position - rotation * center; }
  double energy() const;
  void push(const Vec3& impulse, const Vec3& point);
  void advance(double time);  // may be negative
};
Rigid rigid_of(const Scene& scene, BodyId body);  // at its initial state
void put_state(Scene& scene, BodyId body, const Rigid& rigid);
void read_state(const BodyNow& now, Rigid& rigid);
double energy_of(std::vector<Rigid>& bodies, const std::vector<BodyNow>& now);  // kinetic

// Points of a shape that reach farthest along a direction of its frame; rims have eight.
std::vector<Vec3> farthest_points(const Geometry& geometry, Space space, const Vec3& direction);
// A direction, body frame, along which the shape can touch a plane with its centre of mass above
// the inside of the face, edge or point that touches. Zero if a hull has none by a margin.
Vec3 draw_flat_side(Random& random, const Geometry& geometry, Space space, const Vec3& center);

// Takes one direction to another, in the plane about z.
Quat rotation_to(const Vec3& from, const Vec3& to);

enum class Attitude {
  any,     // random
  flat,    // a face, edge or point below the centre of mass touches, without spin
  tilted,  // a little off flat, or random
};

struct HitOptions {
  Space space = Space::spatial;
  bool plane = true;  // body 0 is a fixed plane, else a second body
  Attitude attitude = Attitude::any;
  bool balls = false, spins = true;
  // Restitution and friction of all shapes; negative: drawn.
  double restitution = 1, friction = 0;
  // Bounds of the travel of surfaces within a step, in least half thicknesses.
  double slowest = 0.01, fastest = 1;
  // Ellipsoids keep touching with a flat side: what holds right after an impact only needs slow
  // ones.
  double fastest_ellipsoid = 1;
  bool no_slip = false;  // the contact velocity is along the normal, and friction can keep it so
  bool gravity = false;  // sometimes
};

// Bodies 0 (the plane or body a) and 1 (b) at the moment of touch.
struct Hit {
  Rigid a, b;
  Vec3 normal = Vec3::UnitZ();  // from a to b
  std::vector<Vec3> points;     // where they touch; none if no draw gave a single hit
  double speed = 0;             // of approach, m/s
  double lead = 0;              // steps from the start to the touch
  double restitution = 0, friction = 0;
  bool flat = false;  // the centre of mass is above the inside of a face, edge or point; no spin

  Mat3 response() const;  // change of the relative velocity by an impulse at points[0]
  Vec3 approach() const;  // relative velocity at points[0]
  double reduced_mass() const { return 1 / normal.dot(response() * normal); }
  double approach_at(const Vec3& point) const {  // along the normal, positive
    return normal.dot(a.velocity_at(point) - b.velocity_at(point));
  }
  void push(const Vec3& impulse);  // on b, and its opposite on a
  // Impulses at the points, N s, of Newton's law of restitution without friction, all at once:
  // p >= 0, v' >= -e v, and p = 0 where v' is larger.
  std::vector<double> frictionless_impulses() const;
  Vec3 impulse_without_slip() const;  // at points[0]: v' = -e v in all directions, N s
};

// One hit within the first step or the second, and no other in the run.
inline constexpr int kHitSteps = 4;
struct DrawnHit {
  Scene scene;
  Hit hit;
};
DrawnHit draw_hit(Random& kind, Random& state, const Scale& scale, const HitOptions& options);

std::vector<Family> several_energy_families();  // impacts of several bodies at once
std::vector<Family> pile_energy_families();     // total energy over time

}  // namespace manyworlds::invariants
