#include "tests/support/joint_twin.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>

namespace manyworlds::test {

namespace {

constexpr int kSize = 6;  // velocities of a body: linear, angular

Vec3 across(const Vec3& n) { return n.unitOrthogonal(); }

std::optional<Drive> drive_of(const Joint& joint) {
  if (const auto* hinge = std::get_if<HingeJoint>(&joint.type)) return hinge->drive;
  if (const auto* slider = std::get_if<SliderJoint>(&joint.type)) return slider->drive;
  if (const auto* wheel = std::get_if<WheelJoint>(&joint.type)) {
    return Drive{0, 0, wheel->suspension};
  }
  if (const auto* distance = std::get_if<DistanceJoint>(&joint.type)) {
    return Drive{*distance->length, 0, distance->spring};
  }
  return std::nullopt;
}
bool is_distance(const Joint& joint) { return std::holds_alternative<DistanceJoint>(joint.type); }
bool is_wheel(const Joint& joint) { return std::holds_alternative<WheelJoint>(joint.type); }
bool is_slider(const Joint& joint) { return std::holds_alternative<SliderJoint>(joint.type); }
double twist_between(const Quat& a, const Quat& b) {
  const Quat turn = a.conjugate() * b;
  return 2 * std::atan2(turn.w() < 0 ? -turn.z() : turn.z(), std::abs(turn.w()));
}

// The axis of the middle moment, of equal ones of the earlier.
int middle_of(const Vec3& moments) {
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return moments(a) < moments(b); });
  return axes[1];
}

// By splitting: as if all moments were the middle one, then by what the others have beside it.
void rotate_free(double dt, TwinBody& b) {
  const Vec3 momentum = b.inertia * b.angular, before = b.angular;
  const Vec3& i = b.moments;
  const auto about = [](double angle, const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(angle, axis));
  };
  const int middle = middle_of(i), first = (middle + 2) % 3, third = (middle + 1) % 3;
  if (momentum.norm() > 0) {
    b.rotation = about(dt * momentum.norm() / i(middle), momentum.normalized()) * b.rotation;
  }
  const auto beside = [&](int axis, double time) {
    const double along = (b.rotation.conjugate() * momentum)(axis);
    const double rate = 1 / i(axis) - 1 / i(middle);
    b.rotation = b.rotation * about(time * along * rate, Vec3::Unit(axis));
  };
  beside(first, dt / 2), beside(third, dt), beside(first, dt / 2);
  const Mat3 r = b.rotation.normalized().toRotationMatrix();
  b.inertia = r * i.asDiagonal() * r.transpose();
  b.angular = r * (r.transpose() * momentum).cwiseQuotient(i);
  b.swept = dt / 2 * (before + b.angular);
}

bool slides(const Joint& joint) { return is_slider(joint) || is_wheel(joint); }

}  // namespace

JointTwin::JointTwin(const Scene& scene) : scene_(scene) {
  for (const Body& body : scene.bodies) {
    TwinBody out;
    const MassProperties m = mass_properties(scene, body);
    out.rotation = body.rotation.normalized();
    const Mat3 r = out.rotation.toRotationMatrix();
    out.mass = m.mass, out.inertia = r * m.inertia * r.transpose();
    out.moments = m.inertia.diagonal();
    out.position = body.position;
    out.linear = body.linear_velocity, out.angular = body.angular_velocity;
    bodies_.push_back(out);
  }
}

Vec3 JointTwin::anchor(BodyId body, const Frame& frame) const {
  if (!body) return frame.position;
  const TwinBody& b = bodies_[static_cast<std::size_t>(body.index())];
  return b.position + b.rotation * frame.position;
}
Quat JointTwin::axes(BodyId body, const Frame& frame) const {
  const Quat own = frame.rotation.normalized();
  return body ? Quat(bodies_[static_cast<std::size_t>(body.index())].rotation * own) : own;
}

void JointTwin::add_point(Eigen::VectorXd& j, BodyId body, const Vec3& place, const Vec3& d,
                          double sign) const {
  if (!body) return;
  const TwinBody& b = bodies_[static_cast<std::size_t>(body.index())];
  j.segment<3>(kSize * body.index()) += sign * d;
  j.segment<3>(kSize * body.index() + 3) += sign * (place - b.position).cross(d);
}
void JointTwin::add_spin(Eigen::VectorXd& j, BodyId body, const Vec3& d, double sign) const {
  if (body) j.segment<3>(kSize * body.index() + 3) += sign * d;
}
Eigen::VectorXd JointTwin::about(const Joint& joint, const Vec3& d) const {
  Eigen::VectorXd j = Eigen::VectorXd::Zero(kSize * static_cast<int>(bodies_.size()));
  add_spin(j, joint.body_b, d, 1), add_spin(j, joint.body_a, d, -1);
  return j;
}
// Along the line from one anchor to the other.
Eigen::VectorXd JointTwin::between(const Joint& joint) const {
  Eigen::VectorXd j = Eigen::VectorXd::Zero(kSize * static_cast<int>(bodies_.size()));
  const Vec3 a = anchor(joint.body_a, joint.frame_a), b = anchor(joint.body_b, joint.frame_b);
  const Vec3 d = (b - a).normalized();
  add_point(j, joint.body_b, b, d, 1), add_point(j, joint.body_a, a, d, -1);
  return j;
}
// Along a direction that A carries, at the anchor of B.
Eigen::VectorXd JointTwin::along(const Joint& joint, const Vec3& d) const {
  Eigen::VectorXd j = Eigen::VectorXd::Zero(kSize * static_cast<int>(bodies_.size()));
  const Vec3 place = anchor(joint.body_b, joint.frame_b);
  add_point(j, joint.body_b, place, d, 1), add_point(j, joint.body_a, place, d, -1);
  return j;
}

std::vector<JointTwin::Row> JointTwin::rows() const {
  std::vector<Row> out;
  for (const Joint& joint : scene_.joints) {
    const Vec3 a = anchor(joint.body_a, joint.frame_a), b = anchor(joint.body_b, joint.frame_b);
    const Quat qa = axes(joint.body_a, joint.frame_a), qb = axes(joint.body_b, joint.frame_b);
    if (is_distance(joint)) continue;  // a spring
    const bool wheel = is_wheel(joint);
    const bool fixed = std::holds_alternative<FixedJoint>(joint.type);
    if (wheel || is_slider(joint)) {
      const Vec3 x = qa * Vec3::UnitX(), d = across(x);
      for (const Vec3& way : {d, Vec3(x.cross(d))}) {
        out.push_back({along(joint, way), way.dot(b - a)});
      }
    } else {
      for (int k = 0; k < 3; ++k) {
        const Vec3 way = Vec3::Unit(k);
        Eigen::VectorXd j = Eigen::VectorXd::Zero(kSize * static_cast<int>(bodies_.size()));
        add_point(j, joint.body_b, b, way, 1), add_point(j, joint.body_a, a, way, -1);
        out.push_back({j, (b - a)(k)});
      }
    }
    if (fixed || is_slider(joint)) {
      const Quat turn = qb * qa.conjugate();
      const Vec3 error = (turn.w() < 0 ? -2.0 : 2.0) * turn.vec();
      for (int k = 0; k < 3; ++k) out.push_back({about(joint, Vec3::Unit(k)), error(k)});
    } else if (wheel || std::holds_alternative<HingeJoint>(joint.type)) {
      const Vec3 z = qa * Vec3::UnitZ(), d = across(z), lean = z.cross(qb * Vec3::UnitZ());
      for (const Vec3& way : {d, Vec3(z.cross(d))}) {
        out.push_back({about(joint, way), way.dot(lean)});
      }
    }
  }
  if (scene_.space == Space::planar) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      for (const int k : {2, 3, 4}) {
        Eigen::VectorXd j = Eigen::VectorXd::Zero(kSize * static_cast<int>(bodies_.size()));
        j(kSize * static_cast<int>(i) + k) = 1;
        out.push_back({j, 0});
      }
    }
  }
  return out;
}

std::vector<Eigen::VectorXd> JointTwin::drive_axes() const {
  std::vector<Eigen::VectorXd> out;
  for (const Joint& joint : scene_.joints) {
    if (!drive_of(joint)) continue;
    const Quat qa = axes(joint.body_a, joint.frame_a);
    out.push_back(is_distance(joint) ? between(joint)
                  : slides(joint)    ? along(joint, qa * Vec3::UnitX())
                                     : about(joint, qa * Vec3::UnitZ()));
  }
  return out;
}
// p = h (k (target - x) + c (target speed - v)) with x a step ahead.
void JointTwin::find_drives(double dt) {
  drives_.clear();
  const std::vector<Eigen::VectorXd> j = drive_axes();
  for (const Joint& joint : scene_.joints) {
    const std::optional<Drive> drive = drive_of(joint);
    if (!drive) continue;
    const Quat qa = axes(joint.body_a, joint.frame_a), qb = axes(joint.body_b, joint.frame_b);
    const Vec3 apart = anchor(joint.body_b, joint.frame_b) - anchor(joint.body_a, joint.frame_a);
    double x;
    if (is_distance(joint)) {
      x = apart.norm();
    } else if (slides(joint)) {
      x = (qa * Vec3::UnitX()).dot(apart);
    } else {
      x = twist_between(qa, qb);
    }
    const Spring& spring = *drive->spring;
    DriveRow out;
    out.j = j[drives_.size()];
    out.stiffness = dt * (spring.damping + dt * spring.stiffness);
    out.push = dt * (spring.stiffness * (drive->target_position - x) +
                     spring.damping * drive->target_speed);
    drives_.push_back(out);
  }
}

// Beyond a bound nothing comes nearer than it is, and before it by no more than it is away. The
// twist is followed about the mean of both axes, as rates are.
std::vector<JointTwin::LimitRow> JointTwin::limits(double dt, bool first) const {
  std::vector<LimitRow> out;
  const auto add = [&](const Eigen::VectorXd& j, double gap) {
    out.push_back({j, first ? -gap / dt : std::min(-gap / dt, 0.0)});
  };
  for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
    const Joint& joint = scene_.joints[i];
    const auto* ball = std::get_if<BallJoint>(&joint.type);
    if (!ball || (!ball->cone && !ball->twist)) continue;
    const Quat qa = axes(joint.body_a, joint.frame_a), qb = axes(joint.body_b, joint.frame_b);
    const Vec3 za = qa * Vec3::UnitZ(), zb = qb * Vec3::UnitZ(), lean = za.cross(zb);
    if (ball->cone) {
      add(-about(joint, lean.normalized()), *ball->cone - std::atan2(lean.norm(), za.dot(zb)));
    }
    if (!ball->twist) continue;
    const Vec3 n = (za + zb) / (1 + za.dot(zb));
    double value = twist_[i];
    if (!first) {
      const auto turned = [&](BodyId body) -> Vec3 {
        if (!body) return Vec3::Zero();
        return bodies_[static_cast<std::size_t>(body.index())].swept;
      };
      value += n.dot(turned(joint.body_b) - turned(joint.body_a));
    }
    add(about(joint, n), value - ball->twist->low);
    add(-about(joint, n), ball->twist->high - value);
  }
  return out;
}

Eigen::VectorXd JointTwin::solve_with(const std::vector<LimitRow>& limits, double rate, bool first,
                                      Eigen::VectorXd& impulse) {
  const int n = kSize * static_cast<int>(bodies_.size());
  std::vector<Row> all = rows();
  const auto joints = static_cast<int>(all.size());
  for (const LimitRow& limit : limits) {
    if (limit.acts) all.push_back({limit.j, 0});
  }
  const auto m = static_cast<int>(all.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + m, n + m);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(n), load = Eigen::VectorXd::Zero(n + m);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const int at = kSize * static_cast<int>(i);
    system.block<3, 3>(at, at) = bodies_[i].mass * Mat3::Identity();
    system.block<3, 3>(at + 3, at + 3) = bodies_[i].inertia;
    v.segment<3>(at) = bodies_[i].linear, v.segment<3>(at + 3) = bodies_[i].angular;
  }
  load.head(n) = system.topLeftCorner(n, n) * v;
  for (const DriveRow& drive : drives_) {
    system.topLeftCorner(n, n) += drive.stiffness * drive.j * drive.j.transpose();
    load.head(n) += (drive.push - (first ? 0 : drive.impulse)) * drive.j;
  }
  for (int k = 0; k < m; ++k) {
    const auto& row = all[static_cast<std::size_t>(k)];
    system.row(n + k).head(n) = row.j.transpose();
    system.col(n + k).head(n) = row.j;
    load(n + k) = -rate * row.error;
  }
  int k = n + joints;
  for (const LimitRow& limit : limits) {
    if (limit.acts) {
      load(k++) = limit.least;
    } else {
      load.head(n) -= limit.before * limit.j;
    }
  }
  const Eigen::VectorXd x = system.fullPivLu().solve(load);
  impulse = -x.tail(m - joints);
  return x.head(n);
}

// The first of the limits that is wrong is put right, until none is (Murty 1974).
void JointTwin::solve(double dt, bool first) {
  const std::vector<Eigen::VectorXd> j = drive_axes();
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i].j = j[i];
  std::vector<LimitRow> all = limits(dt, first);
  for (std::size_t i = 0; !first && i < all.size(); ++i) all[i].before = limit_impulses_[i];
  Eigen::VectorXd v, impulse;
  for (bool wrong = true; wrong;) {
    v = solve_with(all, first ? 1 / dt : 0, first, impulse);
    wrong = false;
    int k = 0;
    for (LimitRow& limit : all) {
      wrong =
          limit.acts ? limit.before + impulse(k++) < -1e-12 : limit.j.dot(v) < limit.least - 1e-10;
      if (!wrong) continue;
      limit.acts = !limit.acts;
      break;
    }
  }
  limit_impulses_.clear();
  int k = 0;
  for (const LimitRow& limit : all) {
    limit_impulses_.push_back(limit.acts ? limit.before + impulse(k++) : 0);
  }
  if (first) {
    acting_ = static_cast<int>(
        std::count_if(all.begin(), all.end(), [](const LimitRow& limit) { return limit.acts; }));
  }
  for (DriveRow& drive : drives_) drive.impulse = drive.push - drive.stiffness * drive.j.dot(v);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const int at = kSize * static_cast<int>(i);
    bodies_[i].linear = v.segment<3>(at), bodies_[i].angular = v.segment<3>(at + 3);
  }
}

void JointTwin::step(double dt) {
  for (TwinBody& b : bodies_) b.linear += dt * scene_.options.gravity;
  find_drives(dt);
  twist_.clear();
  for (const Joint& joint : scene_.joints) {
    twist_.push_back(
        twist_between(axes(joint.body_a, joint.frame_a), axes(joint.body_b, joint.frame_b)));
  }
  solve(dt, true);
  closing_ = bodies_;
  for (TwinBody& b : bodies_) {
    b.position += dt * b.linear;
    rotate_free(dt, b);
  }
  solve(dt, false);
}

}  // namespace manyworlds::test
