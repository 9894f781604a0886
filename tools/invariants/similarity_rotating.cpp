// Rotations, whose reference is a fine integration.
#include <algorithm>
#include <cmath>

#include "tools/invariants/similarity_models.hpp"

namespace manyworlds::invariants {
namespace {

constexpr int kSteps = 48;

// A rigid body about a point: free, or hung up with its weight at `arm` from the point.
struct Rotor {
  Mat3 inertia = Mat3::Identity(), inverse = Mat3::Identity();  // about the point, body axes
  Vec3 arm = Vec3::Zero();                                      // m, body axes
  Vec3 weight = Vec3::Zero();                                   // N
};
struct Attitude {
  Quat rotation = Quat::Identity();
  Vec3 momentum = Vec3::Zero();  // world
};

Vec3 spin_of(const Rotor& rotor, const Attitude& at) {
  return at.rotation * (rotor.inverse * (at.rotation.conjugate() * at.momentum));
}

// Runge and Kutta's fourth order.
void advance(const Rotor& rotor, Attitude& at, double h) {
  struct Rate {
    Eigen::Vector4d rotation;
    Vec3 momentum;
  };
  const auto rate = [&](const Attitude& now) {
    const Vec3 w = spin_of(rotor, now);
    const Quat d = Quat(0, w.x() / 2, w.y() / 2, w.z() / 2) * now.rotation;
    return Rate{d.coeffs(), (now.rotation * rotor.arm).cross(rotor.weight)};
  };
  const auto moved = [&](const Rate& r, double t) {
    Attitude out = at;
    out.rotation.coeffs() += t * r.rotation, out.momentum += t * r.momentum;
    out.rotation.normalize();
    return out;
  };
  const Rate a = rate(at), b = rate(moved(a, h / 2)), c = rate(moved(b, h / 2));
  const Rate d = rate(moved(c, h));
  at.rotation.coeffs() += h / 6 * (a.rotation + 2 * b.rotation + 2 * c.rotation + d.rotation);
  at.momentum += h / 6 * (a.momentum + 2 * b.momentum + 2 * c.momentum + d.momentum);
  at.rotation.normalize();
}

// Attitudes after each step of dt; the body frame is at pivot - rotation * point.
std::vector<BodyNow> integrate(const Rotor& rotor, const Body& start, double dt, const Vec3& pivot,
                               const Vec3& point) {
  Attitude at;
  at.rotation = start.rotation;
  at.momentum =
      start.rotation * (rotor.inertia * (start.rotation.conjugate() * start.angular_velocity));
  constexpr int kFine = 12;
  std::vector<BodyNow> out;
  for (int step = 0; step <= kSteps; ++step) {
    if (step > 0) {
      for (int i = 0; i < kFine; ++i) advance(rotor, at, dt / kFine);
    }
    BodyNow b;
    b.rotation = at.rotation, b.position = pivot - at.rotation * point;
    out.push_back(b);
  }
  return out;
}

// Of different moments, with its centre of mass in its origin.
Geometry draw_rotor(Random& random, double size) {
  const double a = size * random.uniform(0.3, 0.5), b = size * random.uniform(0.6, 0.75);
  if (random.chance(0.5)) return Box{{size, b, a}};
  return Ellipsoid{{size, b, a}};
}

// Spins freely, about any axis.
Model free_spin_model(ModelDraw& in) {
  Model model;
  model.scene = free_scene(Space::spatial, in.scale);
  const double size = in.scale.length, dt = in.scale.dt;
  Body body = scenes::body_of(scenes::shape_of(draw_rotor(in.kind, size)), Vec3::Zero());
  model.body = model.scene.add(body);
  model.length = size, model.turns = true;
  Rotor rotor;
  rotor.inertia = mass_of(model.scene, model.body).inertia;
  rotor.inverse = rotor.inertia.inverse();
  const double fastest = in.kind.log_uniform(0.03, 0.5) / dt;
  for (int i = 0; i < kSamples; ++i) {
    body.rotation = in.state.rotation();
    const double spin = fastest * in.state.uniform(0.5, 1);
    body.angular_velocity = spin * in.state.direction();
    body.linear_velocity = size / dt * 0.01 * in.state.direction();
    model.starts.push_back(body);
    model.right.push_back(integrate(rotor, body, dt, Vec3::Zero(), Vec3::Zero()));
    for (int step = 0; step <= kSteps; ++step) {
      model.right.back()[static_cast<std::size_t>(step)].position +=
          step * dt * body.linear_velocity;
    }
  }
  return model;
}

// Hung up by a joint through `point` of the body: a ball joint in space, a hinge in the plane or in
// space about the horizontal y axis.
Model hung_model(ModelDraw& in, bool top) {
  Random& kind = in.kind;
  const Space space = top || kind.chance(0.5) ? Space::spatial : Space::planar;
  Model model;
  model.scene = scene_of(space, in.scale);
  const double size = in.scale.length, dt = in.scale.dt;
  const Vec3 up = scenes::up_of(space);
  const Geometry geometry = space == Space::planar ? Polygon::box(size, size * kind.uniform(0.2, 1))
                                                   : draw_rotor(kind, size);
  Body body = scenes::body_of(scenes::shape_of(geometry), Vec3::Zero());
  body.shapes[0].filter.mask = 0;
  const Vec3 point =
      top ? Vec3(0, 0, -size * kind.uniform(0.3, 1)) : up * size * kind.uniform(0.5, 1.5);
  body.position = -point;
  model.body = model.scene.add(body);
  Joint joint = joint_at(model.scene, BodyId(), model.body,
                         Frame{Vec3::Zero(), scenes::hinge_axes(space)}, HingeJoint{});
  if (top) joint.type = BallJoint{};
  model.scene.add(joint);
  if (kind.chance(0.5)) model.scene.options.joint.method = JointMethod::tree;
  model.length = size, model.turns = true;

  const MassProperties mass = mass_of(model.scene, model.body);
  Rotor rotor;
  rotor.arm = -point;
  rotor.weight = -mass.mass * in.scale.gravity * up;
  const Mat3 square = point.squaredNorm() * Mat3::Identity() - point * point.transpose();
  rotor.inertia = mass.inertia + mass.mass * square;
  rotor.inverse = rotor.inertia.inverse();
  const double fastest = kind.log_uniform(0.03, 0.5) / dt;
  // A swing of at most 2 rad in the time that counts.
  const double slow = std::min(0.5 / dt, in.scale.speed() / size);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 axis = space == Space::planar ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    const double angle = in.state.uniform(-1, 1);
    const Vec3 lean = top ? Vec3(in.state.planar_direction()) : axis;
    body.rotation = Quat(Eigen::AngleAxisd(angle, lean));
    body.angular_velocity = top ? Vec3(fastest * in.state.uniform(0.5, 1) * (body.rotation * up))
                                : Vec3(slow * in.state.uniform(-1, 1) * axis);
    body.position = -(body.rotation * point);
    body.linear_velocity = body.angular_velocity.cross(body.position);
    model.starts.push_back(body);
    model.right.push_back(integrate(rotor, body, dt, Vec3::Zero(), point));
  }
  return model;
}

}  // namespace

std::vector<ModelType> rotating_models() {
  return {
      {"free spin", "a body of three different moments spins freely", free_spin_model},
      {"pendulum", "a body swings on a hinge", [](ModelDraw& in) { return hung_model(in, false); }},
      {"top", "a heavy top spins on a ball joint",
       [](ModelDraw& in) { return hung_model(in, true); }}};
}

}  // namespace manyworlds::invariants
