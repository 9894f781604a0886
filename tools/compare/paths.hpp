// Paths of many steps under random controls, ours beside MuJoCo's.
#pragma once

#include <string>
#include <vector>

#include "tools/compare/pair.hpp"

namespace manyworlds::compare {

inline constexpr double kApart = 1e-3;   // m or rad (or of a quaternion): paths have parted
inline constexpr double kMoved = 1e-12;  // m or rad: by how much MuJoCo's own start is moved
inline constexpr double kFollowed = 1e-9;

// Times in s at which two paths are kApart; negative where they are not within the steps.
struct Parting {
  Kernels kernels;
  int steps = 0;
  double dt = 0;             // s
  std::vector<double> ours;  // from MuJoCo's
  std::vector<double> own;   // MuJoCo's from its own, moved

  // The median, paths that do not part counted as the longest; negative where that does not part.
  static double median(std::vector<double> times);
};
// From the reference pose at random velocities; controls change every 5 steps.
Parting compare_paths(const Pair& pair, const Kernels& kernels, int paths, int steps);

// After 1,000 steps in float64 without contacts, each path's largest |q - q'| / (1 + |q'|).
struct FreePaths {
  int steps = 0;
  std::vector<double> ours;  // from MuJoCo's
  std::vector<double> own;   // MuJoCo's from its own, moved by kMoved

  double most() const;
  // Beyond kFollowed, unless MuJoCo's own path, moved by so little, went farther: then no path can
  // follow it.
  std::vector<std::string> failures() const;
};
// Of a pair without contacts.
FreePaths compare_free_paths(const Pair& pair, const Kernels& kernels, int paths, int steps = 1000);

}  // namespace manyworlds::compare
