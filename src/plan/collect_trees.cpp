// Trees of a scene with Solver::newton: which body is whose child, the links in their order, and
// the coordinates that they begin with.
#include <algorithm>
#include <cmath>

#include "src/plan/plan_data.hpp"
#include "src/scene/joint_numbers.hpp"
#include "src/scene/tree_order.hpp"

namespace manyworlds {

namespace {

using kernels::TreeJointKind;

struct TreePose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
  TreePose operator*(const TreePose& other) const {
    return {position + rotation * other.position, rotation * other.rotation};
  }
  TreePose inverse() const {
    const Quat back = rotation.conjugate();
    return {back * -position, back};
  }
};
TreePose tree_pose(const Frame& frame) { return {frame.position, frame.rotation.normalized()}; }

std::optional<TreeJointKind> tree_kind(const JointType& type) {
  if (std::holds_alternative<BallJoint>(type)) return TreeJointKind::ball;
  if (std::holds_alternative<HingeJoint>(type)) return TreeJointKind::hinge;
  if (std::holds_alternative<SliderJoint>(type)) return TreeJointKind::slide;
  return std::nullopt;  // fixed
}

class TreeCollector {
 public:
  explicit TreeCollector(PlanData& plan)
      : plan_(plan),
        scene_(plan.scene),
        h_(scene_.options.dt / *scene_.options.substeps),
        order_(tree_order(scene_)),
        link_(scene_.bodies.size(), -1),
        anchors_(scene_.joints.size()) {}

  void run() {
    for (const int body : order_.links) add(body);
    for (const Tendon& tendon : scene_.tendons) add_tendon(tendon);
    add_actuators();
    const Medium& medium = scene_.options.medium;
    if (medium != Medium{}) builder_.add_drag(medium);
    const SolverOptions& o = scene_.options.solver;
    plan_.trees = builder_.finish(
        h_, {iterations_of(o), o.line_search_iterations, o.tolerance, o.line_search_tolerance, 0});
    plan_.trees.actuators = std::move(actuators_);
    plan_.trees.actuator_numbers = std::move(actuator_numbers_);
    plan_.trees.scene_joints = std::move(scene_joints_);
    plan_.trees.start = std::move(start_);
    plan_.trees.joint_coordinate = std::move(joint_coordinate_);
    plan_.trees.anchors = std::move(anchors_);
    plan_.first_coordinate.assign(scene_.joints.size() + 1, plan_.trees.coordinates);
    for (const auto& [joint, coordinate] : plan_.trees.joint_coordinate) {
      plan_.first_coordinate[static_cast<std::size_t>(joint)] = coordinate;
    }
  }

 private:
  void add(int body) {
    const auto& series = order_.series[static_cast<std::size_t>(body)];
    const int parent = order_.parent[static_cast<std::size_t>(body)];
    const PlanBody& b = plan_.bodies[static_cast<std::size_t>(row_of(body))];
    const Body& described = scene_.bodies[static_cast<std::size_t>(body)];
    const TreePose begin{described.position, described.rotation.normalized()};
    NewLink link;
    link.body = row_of(body);
    link.parent = parent < 0 ? -1 : link_[static_cast<std::size_t>(parent)];
    link.center = b.center, link.principal = b.principal;
    link.mass = b.mass, link.moments = b.inertia;
    TreePose at;  // of the body where all frames of its joints coincide, in its parent
    for (const int j : series) at = at * frame_a(j) * frame_b(j).inverse();
    if (series.empty()) at = begin;
    link.position = at.position, link.rotation = at.rotation;
    link_[static_cast<std::size_t>(body)] = builder_.add(link);
    if (series.empty()) add_free(begin);
    TreePose between;  // of the frame that a joint moves
    const int own = link_[static_cast<std::size_t>(body)];
    const int first = moving_joints_;
    for (const int j : series) {
      between = between * frame_a(j) * frame_b(j).inverse();
      const TreePose frame = at.inverse() * between * frame_b(j);
      add_joint(j, frame, series.size() == 1);
      anchors_[static_cast<std::size_t>(j)] = {own, moving_joints_ - first, frame.position};
    }
  }

  void add_free(const TreePose& begin) {
    NewTreeJoint joint;
    joint.kind = TreeJointKind::free;
    builder_.add(joint);
    ++moving_joints_;
    scene_joints_.push_back(-1);
    start_.insert(start_.end(), begin.position.data(), begin.position.data() + 3);
    put_start(begin.rotation);
  }
  void put_start(const Quat& q) { start_.insert(start_.end(), {q.w(), q.x(), q.y(), q.z()}); }

  // `frame`: of the joint, in the link where its frames coincide.
  void add_joint(int index, const TreePose& frame, bool alone) {
    const Joint& from = scene_.joints[static_cast<std::size_t>(index)];
    const auto kind = tree_kind(from.type);
    if (!kind) return;
    NewTreeJoint joint;
    joint.kind = *kind;
    joint.anchor = frame.position;
    joint.axis = frame.rotation * (*kind == TreeJointKind::slide ? Vec3::UnitX() : Vec3::UnitZ());
    const JointDynamics& d = from.dynamics;
    joint.armature = d.armature, joint.damping = d.damping, joint.stiffness = d.stiffness;
    const bool single = kernels::dofs_of(*kind) == 1;
    if (single) joint.reference = d.reference, joint.rest = d.rest;
    joint.sprung = may_have(Parameter::stiffness, index);
    joint.damped = may_have(Parameter::damping, index);
    if (const Limit* limit = limit_of(from.type)) {
      joint.range = {limit->low, limit->high};
      joint.margin = limit->margin;
      joint.compliance = limit->compliance;
      joint.limited = may_have(Parameter::limit_high, index);
    }
    joint_coordinate_.emplace_back(index, static_cast<int>(start_.size()));
    builder_.add(joint);
    observe(index, moving_joints_++);
    scene_joints_.push_back(index);
    const TreePose moved = alone ? displacement(from) : TreePose{};
    if (*kind == TreeJointKind::ball) {
      // Of the link's axes, not of the joint's frames.
      put_start(frame.rotation * moved.rotation * frame.rotation.conjugate());
    } else if (*kind == TreeJointKind::slide) {
      start_.push_back(d.reference + moved.position.x());
    } else {
      const Quat& q = moved.rotation;  // as is -q: the one within half a turn
      const double half = std::atan2(std::copysign(1.0, q.w()) * q.z(), std::abs(q.w()));
      start_.push_back(d.reference + 2 * half);
    }
  }
  // Whether a number of the joint is above 0 in some world.
  bool may_have(Parameter parameter, int joint) const {
    return std::any_of(plan_.varied.begin(), plan_.varied.end(), [&](const VariedNumber& n) {
      return n.parameter == parameter && n.of.joint == joint && n.high > 0;
    });
  }
  // The observed coordinates of a joint of the scene are those of this joint of a tree.
  void observe(int joint, int moving) {
    const auto j = static_cast<std::size_t>(joint);
    for (int c = plan_.first_observed[j]; c < plan_.first_observed[j + 1]; ++c) {
      plan_.coordinates[static_cast<std::size_t>(c)].part = moving;
    }
  }
  // Of B's frame against A's as the bodies begin.
  TreePose displacement(const Joint& j) const {
    return tree_pose(frame_in_world(scene_, j.body_a, j.frame_a)).inverse() *
           tree_pose(frame_in_world(scene_, j.body_b, j.frame_b));
  }

  // A fixed body's frames are the world's.
  TreePose frame_a(int joint) const {
    const Joint& j = scene_.joints[static_cast<std::size_t>(joint)];
    const bool fixed = j.body_a && plan_.state_body[static_cast<std::size_t>(j.body_a.index())] < 0;
    if (!j.after && fixed) return tree_pose(frame_in_world(scene_, j.body_a, j.frame_a));
    return tree_pose(j.frame_a);
  }
  TreePose frame_b(int joint) const {
    return tree_pose(scene_.joints[static_cast<std::size_t>(joint)].frame_b);
  }
  int row_of(int body) const { return plan_.state_body[static_cast<std::size_t>(body)]; }

  int coordinate_of(JointId joint) const {
    const auto at = std::find_if(joint_coordinate_.begin(), joint_coordinate_.end(),
                                 [&](const auto& j) { return j.first == joint.index(); });
    return at->second;
  }
  void add_tendon(const Tendon& tendon) {
    if (!tendon.limit) return;
    NewLength length;
    for (const TendonTerm& term : tendon.terms) {
      const int coordinate = coordinate_of(term.joint);
      length.terms.push_back({coordinate, builder_.dof_of(coordinate), term.coefficient});
    }
    length.range = {tendon.limit->low, tendon.limit->high};
    length.margin = tendon.limit->margin, length.compliance = tendon.limit->compliance;
    builder_.add(length);
  }

  void add_actuators() {
    for (std::size_t i = 0; i < scene_.controls.size(); ++i) {
      const Control& control = scene_.controls[i];
      if (control.kind != ControlKind::joint_force) continue;
      const Actuator& a = control.actuator;
      kernels::TreeActuator out{};
      out.control = static_cast<int>(i);
      out.coordinate = coordinate_of(control.joint);
      out.dof = builder_.dof_of(out.coordinate);
      actuators_.push_back(out);
      actuator_numbers_.push_back(actuator_numbers(a));
    }
  }

  PlanData& plan_;
  const Scene& scene_;
  double h_;
  const TreeOrder order_;
  std::vector<int> link_;  // [scene body]
  std::vector<PlanAnchor> anchors_;
  int moving_joints_ = 0;  // of all links so far
  std::vector<double> start_;
  std::vector<std::pair<int, int>> joint_coordinate_;
  std::vector<int> scene_joints_;
  std::vector<kernels::TreeActuator> actuators_;
  std::vector<kernels::ActuatorConstants<double>> actuator_numbers_;
  TreeBuilder builder_;
};

}  // namespace

void collect_trees(PlanData& plan) {
  if (plan.scene.options.solver.method == Solver::newton) TreeCollector(plan).run();
}

}  // namespace manyworlds
