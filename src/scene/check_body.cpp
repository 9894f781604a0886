// Checks of one body: state, shapes, mass properties, jitter.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "src/scene/checks.hpp"

namespace manyworlds::detail {
namespace {

// Moments below this share of the largest one are rounding noise around zero: a body that is a
// point or a line, which would spin at any speed for nothing.
constexpr double kZeroMoment = 1e-10;

std::string entry_name(int row, int column) {
  return "mass_properties.inertia(" + std::to_string(row) + "," + std::to_string(column) + ")";
}

// "principal moments 1, 2 and 4 kg m^2"
std::string moments_text(const Vec3& moments) {
  return "principal moments " + number_text(moments[0]) + ", " + number_text(moments[1]) + " and " +
         number_text(moments[2]) + " kg m^2";
}

// Ascending, kg m^2.
Vec3 principal_moments(const Mat3& inertia) {
  const Mat3 symmetric = 0.5 * (inertia + inertia.transpose());
  return Eigen::SelfAdjointEigenSolver<Mat3>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

void check_spatial_inertia(Checker& checker, const Mat3& inertia) {
  bool good = true;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      good &= checker.finite(entry_name(row, column), inertia(row, column), "kg m^2");
    }
  }
  if (!good) return;

  const double largest_entry = inertia.cwiseAbs().maxCoeff();
  for (int row = 0; row < 3; ++row) {
    for (int column = row + 1; column < 3; ++column) {
      const double a = inertia(row, column);
      const double b = inertia(column, row);
      if (std::abs(a - b) <= kInputTolerance * largest_entry) continue;
      checker.add(entry_name(row, column), "is " + number_text(a) + " kg m^2 and its mirror is " +
                                               number_text(b) + ", must be symmetric");
      good = false;
    }
  }
  if (!good) return;

  const char* const field = "mass_properties.inertia";
  const Vec3 moments = principal_moments(inertia);
  if (!(moments[0] > kZeroMoment * moments[2])) {
    checker.add(field, "has " + moments_text(moments) + ", must be positive definite");
  } else if (moments[0] < kMinMass || moments[2] > kLargestMass) {
    checker.add(field, "has " + moments_text(moments) + ", must be between " +
                           number_text(kMinMass) + " and " + number_text(kLargestMass));
  } else if (moments[0] + moments[1] < (1 - kInputTolerance) * moments[2]) {
    // Ixx + Iyy - Izz is twice the integral of z^2 dm, so no mass distribution can do this.
    checker.add(field, "has " + moments_text(moments) +
                           ", the largest must not exceed the sum of the others");
  }
}

void check_axes(Checker& checker, const MassProperties& given) {
  if (!checker.rotation("mass_properties.axes", *given.axes)) return;
  const Mat3 axes = given.axes->normalized().toRotationMatrix();
  const Mat3 in_axes = axes.transpose() * given.inertia * axes;
  const Mat3 off = in_axes - Mat3(in_axes.diagonal().asDiagonal());
  if (off.cwiseAbs().maxCoeff() <= kInputTolerance * in_axes.diagonal().maxCoeff()) return;
  checker.add("mass_properties.axes", "are not principal axes of inertia");
}

void check_mass_properties(Checker& checker, const MassProperties& given) {
  checker.positive("mass_properties.mass", given.mass, "kg", kMinMass, kLargestMass);
  checker.finite("mass_properties.center", given.center, "m");
  if (checker.planar()) {
    checker.positive(entry_name(2, 2), given.inertia(2, 2), "kg m^2", kMinMass, kLargestMass);
  } else {
    check_spatial_inertia(checker, given.inertia);
    if (given.axes) check_axes(checker, given);
  }
}

// Sizes and densities may be fine one by one and still make a body that float32 cannot hold.
void check_derived_mass(Checker& checker, const Scene& scene, const Body& body) {
  const MassProperties derived = mass_properties(scene, body);
  const auto in_range = [](double value) { return value >= kMinMass && value <= kLargestMass; };
  const std::string expected =
      ", must be between " + number_text(kMinMass) + " and " + number_text(kLargestMass);
  if (!in_range(derived.mass)) {
    checker.add("shapes", "make a mass of " + number_text(derived.mass) + " kg" + expected);
    return;
  }
  const Vec3 moments = principal_moments(derived.inertia);
  if (!in_range(moments[0]) || !in_range(moments[2])) {
    checker.add("shapes", "make " + moments_text(moments) + expected);
  }
}

// Where `body` moves with another one, which may move with the next, and so on to one that does
// not.
void check_jitter_chain(Checker& checker, const Scene& scene, const Body& body) {
  const auto leader_of = [&](const Body& of) {
    const auto with = static_cast<std::size_t>(of.jitter.with.index());
    return with < scene.bodies.size() ? &scene.bodies[with] : nullptr;
  };
  const std::string is = "is " + std::to_string(body.jitter.with.index());
  const Body* leader = leader_of(body);
  if (leader == nullptr || leader == &body || leader->motion == Motion::fixed) {
    checker.add("jitter.with", is + ", must be -1 or another body that is not fixed");
    return;
  }
  int length = 0;
  while (leader != nullptr && leader != &body && length <= kMaxJitterChain) {
    leader = leader_of(*leader);
    ++length;
  }
  if (leader == &body) {
    checker.add("jitter.with", is + ", which leads back to this body; the last body of a chain "
                                    "must have a jitter.with of -1");
  } else if (length > kMaxJitterChain) {
    checker.add("jitter.with", is + ", which starts a chain of more than " +
                                   std::to_string(kMaxJitterChain) +
                                   " bodies; the chain must end earlier, at a jitter.with of -1");
  }
}

void check_jitter(Checker& checker, const Scene& scene, const Body& body) {
  const Jitter& jitter = body.jitter;
  checker.not_negative("jitter.position", jitter.position, "m");
  checker.not_negative("jitter.linear_velocity", jitter.linear_velocity, "m/s");
  checker.not_negative_axial("jitter.angular_velocity", jitter.angular_velocity, "rad/s");
  checker.not_negative("jitter.angle", jitter.angle, "rad");
  if (checker.planar() && jitter.any_orientation) {
    checker.add("jitter.any_orientation", "is true, must be false in a planar scene (set angle)");
  }
  if (jitter.with != BodyId()) check_jitter_chain(checker, scene, body);
}

// What would be dropped without a word: a fixed body has no state, and no world has its own.
void check_fixed(Checker& checker, const Body& body) {
  const std::string set = "is set on a fixed body, must be 0 (or the body kinematic)";
  if (!body.linear_velocity.isZero(0)) {
    checker.add("linear_velocity", set);
  }
  if (!body.angular_velocity.isZero(0)) {
    checker.add("angular_velocity", set);
  }
  if (!body.enabled) {
    checker.add("enabled", "is false on a fixed body, must be true (or the body kinematic)");
  }
  if (jitters(body.jitter)) {
    checker.add("jitter", set);
  }
}

}  // namespace

void check_body(Checker checker, const Scene& scene, const Body& body, bool density_valid) {
  const std::size_t before = checker.count();
  checker.named("motion", body.motion);
  checker.finite("position", body.position, "m");
  checker.rotation("rotation", body.rotation);
  checker.finite("linear_velocity", body.linear_velocity, "m/s");
  checker.finite_axial("angular_velocity", body.angular_velocity, "rad/s");

  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    const Shape& shape = body.shapes[i];
    std::string part = "shape " + std::to_string(i);
    if (!shape.name.empty()) part += " '" + shape.name + "'";
    check_shape(checker.at(part), body, shape);
  }

  if (body.mass_properties) {
    check_mass_properties(checker, *body.mass_properties);
  } else if (body.motion == Motion::dynamic && body.shapes.empty()) {
    checker.add("mass_properties", "are missing, must be given for a dynamic body without shapes");
  } else if (body.motion == Motion::dynamic && density_valid && checker.count() == before) {
    check_derived_mass(checker, scene, body);
  }

  checker.finite("gravity_scale", body.gravity_scale, "");
  checker.not_negative("linear_drag", body.linear_drag, "1/s");
  checker.not_negative("angular_drag", body.angular_drag, "1/s");
  check_jitter(checker, scene, body);
  if (body.motion == Motion::fixed && checker.count() == before) check_fixed(checker, body);
}

}  // namespace manyworlds::detail
