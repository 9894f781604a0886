// The single numbers that a scene's variations are about, and how one is read and set.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

struct VariedNumber {
  int variation = 0;  // index in Scene::variations
  Parameter parameter{};
  int body = -1, shape = -1, component = 0;  // body: of the scene; -1: of the world
  double low = 0, high = 0;
};

// The body that it is about: that of its shape, if it has one.
inline BodyId body_of(const Variation& v) { return v.shape.body() ? v.shape.body() : v.body; }

// In the order in which they have to be set. A variation of every body or shape leaves out those
// that have no such number.
std::vector<VariedNumber> varied_numbers(const Scene& scene);

// Has this body, or this shape of it, the parameter, and can it vary?
bool can_vary(const Scene& scene, Parameter parameter, int body, int shape);

double get_number(const Scene& scene, Parameter parameter, int body, int shape, int component);
void set_number(Scene& scene, const VariedNumber& number, double value);

}  // namespace manyworlds
