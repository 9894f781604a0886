// One step from states that MuJoCo reaches under random controls: what each side makes of them.
#pragma once

#include <string>
#include <vector>

#include "tools/compare/pair.hpp"

namespace manyworlds::compare {

struct Touch {
  Vec3 point, normal;  // m and unit, world
  double distance;     // m
};

// A state, its controls, and what MuJoCo makes of them.
struct Sample {
  std::vector<double> q, v, u;                    // qpos, qvel, ctrl
  std::vector<double> position, rotation, speed;  // of Pair::links(): xyz; wxyz; w, v of
                                                  // the centre of mass, all in world axes
  double kinetic = 0;                             // J, of the links: without what armature holds
  std::vector<double> a;  // what is to be in generalized_acceleration; empty with Runge-Kutta
  std::vector<double> next_q, next_v;
  std::vector<Touch> touches;  // that may act: those in the gap may not
  int rows = 0;                // of constraints
  bool uncertain = false;      // a contact is so near where contacts begin that rounding decides
  bool other_points = false;   // of shapes whose contact points are not MuJoCo's
};

// After up to `steps` steps from the reference pose at a random velocity, `first` at least.
std::vector<Sample> draw_samples(const Pair& pair, Precision precision, int count, int first = 0,
                                 int steps = 300);

// Differences over the states, each relative to the largest number of its vector or to 1.
struct Quantity {
  std::string name;
  double gate = 0;                       // the largest that is allowed
  std::vector<double> differences = {};  // sorted

  double most() const { return differences.empty() ? 0 : differences.back(); }
  double median() const { return differences.empty() ? 0 : differences[differences.size() / 2]; }
  bool holds() const { return most() <= gate; }
};

struct StateComparison {
  Kernels kernels;
  int states = 0, contacts = 0, rows = 0;
  int other_contacts = 0;  // states in which we find another number of them, which end there
  int uncertain = 0;       // states that are left out for that
  int other_points = 0;    // states that are left out: shapes whose points are not MuJoCo's
  std::vector<Quantity> quantities;

  const Quantity& at(const std::string& name) const;  // throws std::out_of_range
  // What does not hold: a quantity beyond its gate, or other contacts in more than one state of a
  // hundred.
  std::vector<std::string> failures() const;
};

// One world for each sample.
StateComparison compare_states(const Pair& pair, const std::vector<Sample>& samples,
                               const Kernels& kernels);

}  // namespace manyworlds::compare
