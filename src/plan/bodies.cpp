// Bodies with state: mass, centre, principal axes.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "src/plan/reshaped.hpp"

namespace manyworlds {

namespace {

// Principal moments and axes. A tensor that is diagonal already keeps its axes.
void principal_axes(const MassProperties& m, PlanBody& body) {
  const Mat3& inertia = m.inertia;
  if (m.axes) {
    body.principal = m.axes->normalized();
    const Mat3 axes = body.principal.toRotationMatrix();
    body.inertia = Mat3(axes.transpose() * inertia * axes).diagonal();
    return;
  }
  const double scale = inertia.diagonal().cwiseAbs().maxCoeff();
  const Mat3 off = inertia - Mat3(inertia.diagonal().asDiagonal());
  if (off.cwiseAbs().maxCoeff() <= 1e-12 * scale) {
    body.inertia = inertia.diagonal();
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) *= -1;
  body.inertia = solver.eigenvalues();
  body.principal = Quat(axes).normalized();
}

bool is_offset(Parameter parameter) {
  return parameter == Parameter::shape_position || parameter == Parameter::shape_rotation;
}
// May its shapes lie elsewhere about its centre of mass?
bool may_shift(const PlanData& plan, int body) {
  return std::any_of(plan.varied.begin(), plan.varied.end(), [&](const VariedNumber& n) {
    return n.of.body == body &&
           (n.parameter == Parameter::center_of_mass || is_offset(n.parameter));
  });
}

}  // namespace

bool may_be_reshaped(const PlanData& plan, int body) {
  const std::size_t shapes = plan.scene.bodies[static_cast<std::size_t>(body)].shapes.size();
  for (const VariedNumber& n : plan.varied) {
    if (n.of.body != body) continue;
    if (n.parameter == Parameter::size || is_offset(n.parameter)) return true;
    if (n.parameter == Parameter::density && shapes > 1) return true;
  }
  return false;
}

void collect_bodies(PlanData& plan) {
  const Scene& scene = plan.scene;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    plan.state_body.push_back(-1);
    if (body.motion == Motion::fixed) continue;
    plan.state_body.back() = static_cast<int>(plan.bodies.size());
    PlanBody out;
    out.scene_body = static_cast<int>(i);
    if (body.motion == Motion::dynamic) {
      const MassProperties m = mass_properties(scene, body);
      out.mass = m.mass;
      out.inv_mass = 1 / m.mass;
      out.center = m.center;
      if (scene.space == Space::planar) {
        out.inertia = Vec3::Constant(m.inertia(2, 2));
      } else {
        principal_axes(m, out);
      }
      out.inv_inertia = out.inertia.cwiseInverse();
    }
    out.shifted = may_shift(plan, static_cast<int>(i));
    out.reshaped = out.shifted || may_be_reshaped(plan, static_cast<int>(i));
    const bool shifts = out.shifted || (out.reshaped && body.shapes.size() > 1);
    out.aligned = !shifts && out.center.isZero(0) && out.principal.vec().isZero(0);
    plan.bodies.push_back(out);
  }
}

}  // namespace manyworlds
