// The path of a body that something brakes on a plane, by a force of constant size against its
// motion.
#pragma once

#include <algorithm>
#include <cmath>

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

// A point that slides on a plane: v' = g_t - mu g_n (v - belt) / |v - belt|.
class Path {
 public:
  Path(const Vec3& start, const Vec3& velocity, const Vec3& belt, const Vec3& gravity,
       const Vec3& normal, double friction)
      : x_(start), v_(velocity), belt_(belt) {
    pull_ = gravity - normal.dot(gravity) * normal;
    brake_ = -friction * normal.dot(gravity);
    start_ = slip().norm();
    course_ = (start_ > 0 ? slip() : pull_).normalized();
  }
  void advance(double dt) {
    constexpr int kParts = 32;
    const double h = dt / kParts;
    for (int i = 0; i < kParts; ++i) {
      // The midpoint rule, and a stop within the part where friction can hold the body.
      const Vec3 slip = v_ - belt_;
      if (slip.norm() < brake_ * dt) reversed_ = true;
      if (reversed_) free_ += h;
      if (slip.norm() <= brake_ * h && pull_.norm() <= brake_) {
        v_ = belt_, x_ += h * v_, reversed_ = false, free_ = 0;
        continue;
      }
      const Vec3 half = slip + 0.5 * h * acceleration(slip);
      const Vec3 before = v_;
      v_ += h * acceleration(half), x_ += 0.5 * h * (before + v_);
      length_ += h * half.norm(), turned_ += (v_ - before).norm();
    }
    if (slip().norm() > 0.1 * start_) course_ = slip().normalized();
  }
  // How far a body is from it on the plane of the normal, as a share of what is allowed after steps
  // of dt: 1 % of its length along it, and 0.5 degrees aside.
  double deviation(const Vec3& position, const Vec3& normal, double dt) const {
    constexpr double kHalfDegree = 0.5 * scenes::kPi / 180;
    const Vec3 off = position - x_, flat = off - off.dot(normal) * normal;
    const double step = substep_error(dt);
    return std::max(std::abs(flat.dot(course_)) / (0.01 * length_ + step),
                    std::abs(flat.dot(normal.cross(course_))) / (kHalfDegree * length_ + step));
  }
  Vec3 slip() const { return v_ - belt_; }

 private:
  // m, that a step may be off which is exact to first order in its substeps, of dt / 4 at most:
  // half a substep late in every change, and a substep's braking more or less where it turns back.
  double substep_error(double dt) const { return dt / 8 * turned_ + dt / 4 * brake_ * free_; }
  Vec3 acceleration(const Vec3& slip) const {
    const double speed = slip.norm();
    return speed > 0 ? Vec3(pull_ - brake_ / speed * slip) : pull_;
  }
  Vec3 x_, v_, belt_, pull_ = Vec3::Zero(), course_ = Vec3::Zero();
  double brake_ = 0, start_ = 0, length_ = 0, turned_ = 0, free_ = 0;
  bool reversed_ = false;
};

}  // namespace manyworlds::invariants
