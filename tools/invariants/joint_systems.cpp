#include "tools/invariants/joint_systems.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "tools/invariants/momenta.hpp"
#include "tools/invariants/states.hpp"

namespace manyworlds::invariants {
namespace {

// ---- scenes -------------------------------------------------------------------------------------

BodyId add_link(Random& kind, Scene& scene, const Scale& scale, double mass_ratio) {
  const Geometry geometry = draw_shape(kind, scene.space, 0.5 * scale.length);
  Body body = scenes::body_of(scenes::shape_of(geometry), Vec3::Zero());
  body.shapes[0].filter.mask = 0;
  body.rotation = draw_rotation(kind, scene.space);
  const BodyId id = scene.add(std::move(body));
  set_mass(scene, id, unit_mass(scene.space, scale) * kind.log_uniform(1, mass_ratio));
  return id;
}

double radius_of(const Scene& scene, BodyId body) {
  return outer_radius(scene.at(body).shapes[0].geometry);
}

// A rod of some length between two points of two bodies.
Joint rod_between(const Scene& scene, BodyId a, BodyId b, const Vec3& point_a,
                  const Vec3& point_b) {
  Joint joint = joint_at(scene, a, b, scenes::frame_at(point_a), DistanceJoint{});
  joint.frame_b = joint_at(scene, a, b, scenes::frame_at(point_b), DistanceJoint{}).frame_b;
  return joint;
}

// Puts `link` beside `parent` and joins them, where they meet or by a rod. A slider moves by at
// most `travel`, m.
void join(Random& kind, Scene& scene, BodyId parent, BodyId link, double travel) {
  const bool planar = scene.space == Space::planar;
  const Vec3 direction = draw_direction(kind, scene.space);
  const Vec3 from = parent ? scene.at(parent).position : Vec3::Zero().eval();
  const Vec3 end = from + (parent ? radius_of(scene, parent) : 0) * direction;
  const double radius = radius_of(scene, link);
  const Frame frame{end, draw_rotation(kind, scene.space)};
  const int type = kind.integer(planar ? 1 : 0, 6);
  const double rod = type == 5 ? radius * kind.uniform(0.5, 2) : 0;
  scene.at(link).position = end + (rod + radius) * direction;
  if (type == 5) {
    scene.add(rod_between(scene, parent, link, end, end + rod * direction));
    return;
  }
  JointType joint = HingeJoint{};
  if (!planar && (type == 0 || type == 6)) joint = BallJoint{};
  if (type == 3) joint = SliderJoint{};
  if (type == 3 && std::isfinite(travel)) joint = SliderJoint{Limit{-travel, travel}, {}};
  if (type == 4) joint = FixedJoint{};
  scene.add(joint_at(scene, parent, link, frame, joint));
}

// On a circle, each on a joint with the next. In space on ball joints, or on hinges whose axes are
// parallel, so that the ring can move.
void add_ring(Random& kind, Scene& scene, const std::vector<BodyId>& links) {
  const auto count = static_cast<int>(links.size());
  double side = 0;
  for (const BodyId link : links) side = std::max(side, 2 * radius_of(scene, link));
  const double radius = side / (2 * std::sin(scenes::kPi / count));
  const Quat plane =
      scene.space == Space::planar ? Quat(Quat::Identity()) : draw_rotation(kind, scene.space);
  const auto place = [&](double at, double distance) -> Vec3 {
    const double angle = 2 * scenes::kPi * at / count;
    return plane * (distance * Vec3(std::cos(angle), std::sin(angle), 0));
  };
  for (int i = 0; i < count; ++i) {
    scene.at(links[static_cast<std::size_t>(i)]).position = place(i, radius);
  }
  const bool hinges = scene.space == Space::planar || kind.chance(0.5);
  for (int i = 0; i < count; ++i) {
    const BodyId a = links[static_cast<std::size_t>(i)];
    const BodyId b = links[static_cast<std::size_t>((i + 1) % count)];
    const Vec3 middle = place(i + 0.5, radius * std::cos(scenes::kPi / count));
    const JointType type = hinges ? JointType(HingeJoint{}) : JointType(BallJoint{});
    scene.add(joint_at(scene, a, b, {middle, plane}, type));
  }
}

// ---- velocities ---------------------------------------------------------------------------------

// Directions in which a joint's frames do not move against each other: along, and about.
struct Held {
  std::vector<Vec3> along, about;
};
Held held_by(const JointType& type, const JointFrames& at) {
  const std::array<Vec3, 3> axis = {at.turn_a * Vec3::UnitX(), at.turn_a * Vec3::UnitY(),
                                    at.turn_a * Vec3::UnitZ()};
  const std::vector<Vec3> all(axis.begin(), axis.end());
  if (std::holds_alternative<BallJoint>(type)) return {all, {}};
  if (std::holds_alternative<HingeJoint>(type)) return {all, {axis[0], axis[1]}};
  if (std::holds_alternative<SliderJoint>(type)) return {{axis[1], axis[2]}, all};
  if (std::holds_alternative<DistanceJoint>(type)) return {{(at.b - at.a).normalized()}, {}};
  return {all, all};
}

// Linear and angular velocities of all bodies, one after another.
Eigen::MatrixXd jacobian_of(const Scene& scene, const std::vector<BodyNow>& bodies,
                            const std::vector<MassProperties>& masses) {
  std::vector<Eigen::RowVectorXd> rows;
  for (const Joint& joint : scene.joints) {
    const JointFrames at = frames_of(joint, bodies);
    const Held held = held_by(joint.type, at);
    const auto add = [&](const Vec3& along, const Vec3& about) {
      Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(6 * static_cast<int>(bodies.size()));
      const auto put = [&](BodyId body, const Vec3& point, double sign) {
        if (!body) return;
        const auto i = static_cast<std::size_t>(body.index());
        const Vec3 arm = point - (bodies[i].position + bodies[i].rotation * masses[i].center);
        row.segment<3>(6 * body.index()) = sign * along.transpose();
        row.segment<3>(6 * body.index() + 3) = sign * (arm.cross(along) + about).transpose();
      };
      put(joint.body_a, at.a, -1), put(joint.body_b, at.b, 1);
      rows.push_back(row);
    };
    for (const Vec3& along : held.along) add(along, Vec3::Zero());
    for (const Vec3& about : held.about) add(Vec3::Zero(), about);
  }
  Eigen::MatrixXd out(static_cast<int>(rows.size()), 6 * static_cast<int>(bodies.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) out.row(static_cast<int>(i)) = rows[i];
  return out;
}

// The inverse masses of all velocities; zero for those that the plane does not have.
Eigen::MatrixXd inverse_masses(const Scene& scene, const std::vector<BodyNow>& bodies,
                               const std::vector<MassProperties>& masses) {
  const int size = 6 * static_cast<int>(bodies.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const int at = 6 * static_cast<int>(i);
    const Mat3 inertia = inertia_of(masses[i], bodies[i].rotation);
    const double m = 1 / masses[i].mass;
    if (scene.space == Space::planar) {
      out(at, at) = out(at + 1, at + 1) = m, out(at + 5, at + 5) = 1 / inertia(2, 2);
    } else {
      out.block<3, 3>(at, at) = m * Mat3::Identity();
      out.block<3, 3>(at + 3, at + 3) = inertia.inverse();
    }
  }
  return out;
}

}  // namespace

Scene draw_joints(Random& kind, const Scale& scale, const JointSystem& system) {
  Scene scene = free_scene(system.space, scale);
  std::vector<BodyId> links;
  for (int i = 0; i < system.bodies; ++i) {
    links.push_back(add_link(kind, scene, scale, system.mass_ratio));
  }
  std::size_t placed = 1;
  if (system.loop) {
    placed = static_cast<std::size_t>(kind.integer(4, std::max(4, system.bodies)));
    add_ring(kind, scene, {links.begin(), links.begin() + static_cast<std::ptrdiff_t>(placed)});
  }
  if (system.hung) {
    const Frame frame{scene.at(links[0]).position +
                          radius_of(scene, links[0]) * draw_direction(kind, system.space),
                      draw_rotation(kind, system.space)};
    const bool ball = system.space == Space::spatial && kind.chance(0.5);
    scene.add(joint_at(scene, {}, links[0], frame,
                       ball ? JointType(BallJoint{}) : JointType(HingeJoint{})));
  }
  const double travel = system.hung ? scale.length : HUGE_VAL;
  // A chain or a bush.
  const bool chain = kind.chance(0.5);
  for (; placed < links.size(); ++placed) {
    const auto parent =
        chain ? placed - 1
              : static_cast<std::size_t>(kind.integer(0, static_cast<int>(placed) - 1));
    join(kind, scene, links[parent], links[placed], travel);
  }
  return scene;
}

// By Gauss' principle: of all velocities that the joints allow, those nearest to random ones.
void set_moving(Random& state, Scene& scene, double spin) {
  const std::vector<BodyNow> bodies = initial_states(scene);
  const std::vector<MassProperties> masses = masses_of(scene);
  const int size = 6 * static_cast<int>(bodies.size());
  Eigen::VectorXd v(size);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const int at = 6 * static_cast<int>(i);
    const double radius = outer_radius(scene.bodies[i].shapes[0].geometry);
    v.segment<3>(at) = radius * state.uniform(0, 1) * draw_direction(state, scene.space);
    v.segment<3>(at + 3) = state.uniform(0, 1) * draw_axis(state, scene.space);
  }
  const Eigen::MatrixXd rows = jacobian_of(scene, bodies, masses);
  const Eigen::MatrixXd inverse = inverse_masses(scene, bodies, masses);
  const Eigen::MatrixXd loads = inverse * rows.transpose();
  v -= loads * (rows * loads).completeOrthogonalDecomposition().solve(rows * v);
  double fastest = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const int at = 6 * static_cast<int>(i);
    const double radius = outer_radius(scene.bodies[i].shapes[0].geometry);
    fastest = std::max({fastest, v.segment<3>(at + 3).norm(), v.segment<3>(at).norm() / radius});
  }
  if (fastest > 0) v *= spin / fastest;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const int at = 6 * static_cast<int>(i);
    scene.bodies[i].linear_velocity = v.segment<3>(at);
    scene.bodies[i].angular_velocity = v.segment<3>(at + 3);
  }
}

JointFrames frames_of(const Joint& joint, const std::vector<BodyNow>& bodies) {
  const auto place = [&](BodyId body, const Frame& frame, Vec3& at, Quat& turn) {
    at = frame.position, turn = Quat(frame.rotation).normalized();
    if (!body) return;
    const BodyNow& b = bodies[static_cast<std::size_t>(body.index())];
    at = b.position + b.rotation * at, turn = b.rotation * turn;
  };
  JointFrames out;
  place(joint.body_a, joint.frame_a, out.a, out.turn_a);
  place(joint.body_b, joint.frame_b, out.b, out.turn_b);
  return out;
}

double coordinate_of(const Joint& joint, const std::vector<BodyNow>& bodies) {
  const JointFrames at = frames_of(joint, bodies);
  if (std::holds_alternative<SliderJoint>(joint.type)) {
    return (at.turn_a * Vec3::UnitX()).dot(at.b - at.a);
  }
  const Quat turn = at.turn_a.conjugate() * at.turn_b;
  return std::remainder(2 * std::atan2(turn.z(), turn.w()), 2 * scenes::kPi);
}

}  // namespace manyworlds::invariants
