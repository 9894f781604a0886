// Random draws of scenes for tests and reports: fixed seeds, the same numbers on every platform
// (the standard distributions differ, so the mapping to doubles is our own).
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "manyworlds/scene.hpp"

namespace manyworlds::tools {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    const double unit = static_cast<double>(engine_() >> 11) * 0x1p-53;
    return low + (high - low) * unit;
  }
  double log_uniform(double low, double high) {
    return low * std::exp(uniform(0, 1) * std::log(high / low));
  }
  int integer(int low, int high) {  // both ends included
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  Vec3 in_cube(double half) {
    return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
  }
  Vec3 direction() {  // uniform on the sphere, by rejection
    for (;;) {
      const Vec3 v = in_cube(1);
      const double squared = v.squaredNorm();
      if (squared > 0.01 && squared < 1) return v / std::sqrt(squared);
    }
  }
  Vec3 planar_direction() {
    const double angle = uniform(-3.14159265358979, 3.14159265358979);
    return {std::cos(angle), std::sin(angle), 0};
  }
  Quat rotation() {  // uniform over all rotations, by rejection in the 4-ball
    for (;;) {
      // One by one: the order of arguments is the compiler's.
      const double z = uniform(-1, 1), y = uniform(-1, 1), x = uniform(-1, 1), w = uniform(-1, 1);
      const Quat q(w, x, y, z);
      if (q.squaredNorm() > 0.01 && q.squaredNorm() < 1) return q.normalized();
    }
  }
  Quat planar_rotation() {
    return Quat(Eigen::AngleAxisd(uniform(-3.14159265358979, 3.14159265358979), Vec3::UnitZ()));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace manyworlds::tools
