// The single numbers that a scene's variations are about, and how one is read and set.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// What has a number: indices of the scene, of which those count that its ParameterInfo::owner asks
// for; the others are -1.
struct NumberOwner {
  int body = -1, shape = -1, joint = -1, control = -1, attractor = -1;
  bool operator==(const NumberOwner&) const = default;
};

struct VariedNumber {
  int variation = 0;  // index in Scene::variations
  Parameter parameter{};
  NumberOwner of = {};
  int component = 0;
  double low = 0, high = 0;
};

// The body that it is about: that of its shape, if it has one.
inline BodyId body_of(const Variation& v) { return v.shape.body() ? v.shape.body() : v.body; }

// All that may have a parameter, in the order of Batch::read: bodies with state, shapes, joints,
// controls, attractors, or the world.
std::vector<NumberOwner> owners_of(const Scene& scene, Parameter parameter);

// Of joints and controls of Solver::newton; of joints on bodies and how bodies begin, which all
// other solvers have.
bool is_of_newton(Parameter parameter);
bool is_of_bodies(Parameter parameter);

// In the order in which they have to be set. A variation of all leaves out those that have no such
// number.
std::vector<VariedNumber> varied_numbers(const Scene& scene);

// Has this owner the parameter, and can it vary?
bool can_vary(const Scene& scene, Parameter parameter, const NumberOwner& of);

double get_number(const Scene& scene, Parameter parameter, const NumberOwner& of, int component);
// All of a scene's numbers, in the order of varied_numbers().
void set_numbers(Scene& scene, const std::vector<VariedNumber>& numbers, const double* values);
// Of the actuator of a control.
double get_number(ControlKind kind, const Actuator& actuator, Parameter parameter, int component);
void set_number(Actuator& actuator, Parameter parameter, int component, double value);

}  // namespace manyworlds
