// The standard scenes as plain numbers, for engines other than ours: the worlds of scenes/, up to
// the draws, which every engine here makes alike. Lengths in m, SI units.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace manyworlds::peers {

inline constexpr double kStep = 1.0 / 60;    // s
inline constexpr double kGravity = 10;       // m/s^2, down y in planar scenes, z in spatial ones
inline constexpr double kFriction = 0.6;     // of every pair
inline constexpr double kPlanarDensity = 1;  // kg/m^2
inline constexpr double kDensity = 1000;     // kg/m^3
inline constexpr double kWallHeight = 10;    // m
inline constexpr double kWallThickness = 1;

enum class Form {
  ball,     // circle or sphere
  box,      // square or cube
  capsule,  // along x
};

struct Body {
  Form form = Form::ball;
  double radius = 0;  // of balls and capsules
  double half = 0;    // half extent of a box along each axis; half length of a capsule's segment
  std::array<double, 3> position{};
  std::array<double, 3> velocity{};
  double angle = 0;                            // planar, rad
  std::array<double, 4> rotation{1, 0, 0, 0};  // spatial: w x y z
};

struct World {
  bool planar = false;
  double floor = 0;        // half width of the floor, whose top is at height 0; 0: none
  double inner = 0;        // half width between the walls that stand on it; 0: none
  double restitution = 0;  // of every pair
  double stands = 0;       // height above which the highest centre stays; 0: it may fall
  // Each body is joined to the one before by a hinge or ball joint at x = its index, the first to
  // the world; then nothing collides.
  bool chain = false;
  std::vector<Body> bodies;
};

// Of a body of a planar scene: kg, and kg m^2 about its centre.
struct PlanarMass {
  double mass = 0, moment = 0;
};
PlanarMass planar_mass(const Body& body);

// A static box of floor or wall.
struct Slab {
  std::array<double, 3> centre{}, half{};
};
std::vector<Slab> slabs(const World& world);

struct Scene {
  const char* name;
  bool planar;
};
const std::vector<Scene>& scenes();  // nine

// What world `index` of the scene starts from; `name` is one of scenes().
World draw(const std::string& name, int index);

}  // namespace manyworlds::peers
