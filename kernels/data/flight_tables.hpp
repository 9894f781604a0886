// What the kernels know of the integrator of a plan (include/manyworlds/integrator.hpp).
#pragma once

#include <cstdint>

namespace manyworlds::kernels {

enum class Scheme : std::int32_t {
  symplectic_euler,
  explicit_euler,
  implicit_euler,
  verlet,
  velocity_verlet,
  runge_kutta4,
};

enum class Rotation : std::int32_t { splitting, quaternion, exponential };

struct FlightOptions {
  // Bodies in free flight go by `scheme`; if not, by the substeps of the solver
  // (kernels/motion/finish.hpp).
  bool on;
  Scheme scheme;
  Rotation rotation;
  bool momentum;         // spins are angular momenta
  bool damped;           // some force depends on velocities
  std::int32_t springs;  // parts of joints that are forces (JointPart::force)
};

}  // namespace manyworlds::kernels
