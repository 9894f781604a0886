// A rotation as an axis and an angle from 0 to pi.
#pragma once

#include "kernels/lane/solve.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct AxisAngle {
  Vec3 axis;  // unit; x where there is no rotation
  Float angle;
};
// Precondition: q is unit. q and -q are the same rotation.
MW_INLINE AxisAngle axis_angle(Quat q) {
  const Float zero(Real(0)), one(Real(1));
  const Vec3 v{q.x, q.y, q.z};
  const Float sine = sqrt(dot(v, v)), half = arc_tangent(sine, abs(q.w));
  const Mask turned = zero < sine;
  const Float scale = select(q.w < zero, -one, one) / select(turned, sine, one);
  const Vec3 axis = v * scale;
  return {{select(turned, axis.x, one), axis.y, axis.z}, half + half};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
