// Scenes that are their own image in a mirror or by a turn, and how far they are from it.
#pragma once

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

// Maps that floating point carries out exactly.
struct Image {
  bool mirror =
      true;  // in the plane x = 0; else a turn about z (spatial) by a whole number of quarters
  int quarters = 2;

  Vec3 vector(const Vec3& v) const;  // positions and velocities
  Vec3 axial(const Vec3& w) const;   // spins
  Quat rotation(const Quat& q) const;
  // Of a shape in its own frame, which the map leaves in place.
  Geometry geometry(const Geometry& g) const;
};

// Appends the image of a body. Its rotation is such that image.geometry() of each shape fits it.
BodyId add_image(Scene& scene, BodyId body, const Image& image);
Joint image_of(const Joint& joint, BodyId a, BodyId b, const Image& image);

// Bodies `a` whose images are to stay bodies `b`; a body that is its own image has a == b.
struct ImagePair {
  BodyId a, b;
};

// The largest difference of a velocity, or of a spin times the size of the scale, from the image of
// its partner's, over the largest speed so far. If the world has a twin, only until the twin's
// distance has grown tenfold from `start`, the relative size of its perturbation; in the step in
// which it grows, only what is beyond ten times that distance.
Judge image_judge(std::vector<ImagePair> pairs, const Image& image, const Scale& scale,
                  double start);

// The scene with positions and velocities changed by 1e-7 of the scale, in directions of their own.
// Not attitudes: what lands exactly flat is another scene than what lands tilted.
inline constexpr double kPerturbation = 1e-7;
Scene perturbed(const Scene& scene, const Scale& scale, Random& random);

}  // namespace manyworlds::invariants
