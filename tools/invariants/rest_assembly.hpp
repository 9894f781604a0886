// Structures in balance, as the families of rest build them.
#pragma once

#include <functional>

#include "tools/invariants/statics.hpp"

namespace manyworlds::invariants {

struct Assembly {
  Scene scene;
  std::vector<Touch> touches = {};  // of round shapes, which are not found
  std::vector<Preload> preloads = {};
  Margin margin = {};
  double shrink = 0.1;  // of areas of contact
  // How worlds of a kind differ. free: shifted over the floor and turned about its normal. Else
  // shifted along `shift` by up to its length.
  bool free = true;
  Vec3 shift = Vec3::Zero();
  Vec3 closing = Vec3::Zero();  // along which contacts close by the slop; zero: upward
  bool is_known = false;        // in balance by construction; not checked
};

// A dynamic block whose mass is given; the friction of the pair is that of both.
BodyId add_block(Scene& scene, Geometry geometry, const Vec3& position, const Quat& rotation,
                 double mass, double friction);
BodyId add_fixed(Scene& scene, Geometry geometry, const Vec3& position, const Quat& rotation,
                 double friction);
// kg, of a body of the size in a scene whose masses differ by up to `ratio`
double draw_mass(Random& random, const Scale& scale, double ratio);
// A box, an upright cylinder or an upright prism; planar: a box. Half extents a and b, half height
// c.
Geometry draw_brick(Random& random, Space space, double a, double b, double c);

// Makes structures until one stands by the margin. `ease` goes from 0 to 1 with the tries.
using Make = std::function<Assembly(Random& random, double ease)>;
Drawn draw_standing_still(Random& kind, Random& state, const Scale& scale, const Make& make);
// The judge: the farthest motion of a body, beyond the slop of the contacts below it, over its
// size; twice the limit if the world is awake at the end.
Judge rest_judge(const Scene& scene, bool sleep, const Vec3& closing);
inline constexpr double kRestLimit = 0.01;
inline constexpr int kRestSteps = 1200;
inline constexpr int kSleepSteps = 30;  // half a second at the scale of 1 m

Family rest_family(std::string id, std::string title,
                   std::function<Assembly(Random&, const Scale&, double ease)> make);

std::vector<Family> rest_body_families();       // rest_bodies.cpp
std::vector<Family> rest_pile_families();       // rest_piles.cpp
std::vector<Family> rest_structure_families();  // rest_structures.cpp
std::vector<Family> rest_round_families();      // rest_round.cpp: cradles, corners, grips
std::vector<Family> must_move_families();       // rest_moving.cpp

}  // namespace manyworlds::invariants
