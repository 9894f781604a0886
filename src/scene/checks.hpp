// Checks that validate() is made of: a collector of issues with the place they belong to, and one
// function per part of a scene. Outside of src/scene only limits and the texts of numbers are of
// use.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds::detail {

// The step works in float32 unless asked otherwise, so a scene has to fit in it.
inline constexpr double kLargestFinite = std::numeric_limits<float>::max();
// Masses and moments of inertia, kg and kg m^2: their inverses must not overflow or flush to zero.
inline constexpr double kMinMass = 1e-30;
inline constexpr double kLargestMass = 1e30;
// Sizes, m, and times, s: their squares must neither overflow nor flush to zero.
inline constexpr double kMinSize = 1e-9;
inline constexpr double kLargestSize = 1e8;
inline constexpr double kMinTime = 1e-9;
// Relative error that given inertia tensors and plane normals may carry.
inline constexpr double kInputTolerance = 1e-6;

inline constexpr int kMaxSubsteps = 64;
inline constexpr int kMaxPasses = 64;  // over the collision stages in a step
inline constexpr int kMaxBodies = 32767;
inline constexpr int kMaxShapes = 32767;
inline constexpr int kMaxJitterChain = 256;  // bodies, since each is drawn with all before it
inline constexpr int kMaxNewtonDofs = 64, kMaxNewtonLinks = 256;  // of Solver::newton

// Shortest text that reads back as the same number, in any locale; "nan" without a sign.
std::string number_text(double value);
std::string vector_text(const Vec2& value);                           // "(1, 2)"
std::string vector_text(const Vec3& value);                           // "(1, 2, 3)"
std::string element_name(std::string_view field, std::size_t index);  // "vertices[3]"

// Appends issues of one part of a scene, such as "body 3 'crate', shape 1" (empty: of the scene).
// The check functions add at most one issue per number and tell whether all was well.
// `field` names the member as a C++ user writes it, `unit` may be empty.
class Checker {
 public:
  Checker(std::vector<Issue>& issues, Space space, std::string part = {})
      : issues_(&issues), space_(space), part_(std::move(part)) {}

  Space space() const { return space_; }
  bool planar() const { return space_ == Space::planar; }
  std::size_t count() const { return issues_->size(); }  // issues of the whole scene so far
  // The same collector for a part of this part.
  Checker at(const std::string& part) const;

  void add(std::string_view field, std::string message);

  bool finite(std::string_view field, double value, std::string_view unit);
  bool not_negative(std::string_view field, double value, std::string_view unit);
  // > 0, and between smallest and largest.
  bool positive(std::string_view field, double value, std::string_view unit, double smallest,
                double largest);
  bool size(std::string_view field, double value) {
    return positive(field, value, "m", kMinSize, kLargestSize);
  }
  bool density(std::string_view field, double value) {
    return positive(field, value, planar() ? "kg/m^2" : "kg/m^3", kMinMass, kLargestMass);
  }
  bool between(std::string_view field, double value, double low, double high);
  // One of the values that the enumeration has.
  template <class Enum>
  bool named(std::string_view field, Enum value) {
    if (is_named(value)) return true;
    add(field, unnamed(value));
    return false;
  }

  // Vectors; in a planar scene the z component must be 0.
  bool finite(std::string_view field, const Vec3& value, std::string_view unit);
  bool not_negative(std::string_view field, const Vec3& value, std::string_view unit);
  // As finite(), for rotations: in a planar scene x and y must be 0.
  bool finite_axial(std::string_view field, const Vec3& value, std::string_view unit);
  bool not_negative_axial(std::string_view field, const Vec3& value, std::string_view unit);
  // Finite, not zero, and about z in a planar scene. Need not be unit.
  bool rotation(std::string_view field, const Quat& value);

 private:
  bool zero_in_plane(std::string_view field, double value, std::string_view unit);

  std::vector<Issue>* issues_;
  Space space_;
  std::string part_;
};

// Is anything of it drawn?
inline bool jitters(const Jitter& j) {
  return !j.position.isZero(0) || !j.linear_velocity.isZero(0) || !j.angular_velocity.isZero(0) ||
         j.angle != 0 || j.any_orientation || j.with != BodyId();
}

void check_shape(Checker checker, const Body& body, const Shape& shape);
// Everything of the body, its shapes included. `density_valid`: whether Options::density is.
void check_body(Checker checker, const Scene& scene, const Body& body, bool density_valid);
void check_options(Checker checker, const Options& options);
void check_impact_sweeps(Checker checker, const Scene& scene);
void check_joint(Checker checker, const Scene& scene, const Joint& joint);
void check_control(Checker checker, const Scene& scene, std::size_t index);
// Of Solver::newton (check_newton.cpp).
void check_soft_contact(Checker& checker, const SoftContact& contact);
void check_soft_limit(Checker& checker, const std::string& name, const Limit& limit);
void check_dynamics(Checker& checker, const JointDynamics& dynamics);
void check_actuator(Checker& checker, const Actuator& actuator);
void check_newton(Checker checker, const Scene& scene, bool sound);
// Its trees (check_trees.cpp). Precondition: the scene has no other issue.
void check_trees(Checker checker, const Scene& scene);
// `sound`: whether the scene has no other issue. Only then are sizes looked at.
void check_keyframes(Checker checker, const Scene& scene, bool sound);
void check_coordinate_draws(Checker checker, const Scene& scene, bool sound);
// "body 3 'crate'"
std::string named_part(const char* what, std::size_t index, const std::string& name);
// `sound`: whether the scene has no other issue. Only then are its extremes looked at.
void check_variations(Checker checker, const Scene& scene, bool sound);

}  // namespace manyworlds::detail
