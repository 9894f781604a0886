// Trees of a plan: bodies in joint coordinates, as the kernels take them
// (kernels/data/tree_tables.hpp).
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/data/tree_tables.hpp"
#include "manyworlds/scene.hpp"
#include "src/plan/compliance.hpp"

namespace manyworlds {

// How easily the trees move at the reference: what MuJoCo scales its constraints by.
struct TreeWeights {
  Eigen::MatrixXd inverse;  // of M
  std::vector<double> dof;  // of the diagonal of M^-1, alike for a joint's rotations
  std::vector<std::array<double, 2>> link;  // of its centre of mass: 1 / kg, 1 / (kg m^2), means
  double mean_inertia = 1;                  // of the diagonal of M
};

// Where a joint of the scene holds its body B (kernels/data/observer.hpp).
struct PlanAnchor {
  int link = -1, joints = 0;
  Vec3 position = Vec3::Zero();  // m
};

// The material of a shape of the scene.
struct PlanMaterial {
  int body = 0, shape = 0;
  auto operator<=>(const PlanMaterial&) const = default;
  const SoftContact& in(const Scene& scene) const;
};

struct PlanTrees {
  std::vector<kernels::TreeLink<double>> links;
  std::vector<kernels::LinkConstants<double>> link_numbers;  // [link]
  std::vector<kernels::TreeJoint<double>> joints;
  std::vector<int> scene_joints;  // [joint] of the scene; -1: a free body's
  std::vector<kernels::TreeDof> dofs;
  std::vector<kernels::DofConstants<double>> dof_numbers;  // [dof]
  std::vector<kernels::TreeLimit<double>> limits;
  std::vector<kernels::TreeTerm<double>> terms;  // of limits
  std::vector<kernels::TreeBallLimit<double>> ball_limits;
  std::vector<kernels::LimitConstants<double>> limit_numbers;  // of those, then of these
  std::vector<int> limited_joints;  // [limit, then limit of a ball] its joint; -1: a tendon's
  std::vector<kernels::TreeBallSpring> ball_springs;
  std::vector<kernels::TreeActuator> actuators;
  std::vector<kernels::ActuatorConstants<double>> actuator_numbers;  // [actuator]
  std::vector<kernels::TreePair<double>> pairs;                      // [key]
  std::vector<kernels::Compliance<double>> compliances;              // of pairs
  // [compliance] of two materials, where those vary
  std::vector<std::pair<PlanMaterial, PlanMaterial>> mixed;
  std::vector<std::int32_t> pair_dofs;
  bool elliptic = false;
  double impedance_ratio = 1;
  std::vector<kernels::DragConstants<double>> drags;  // [link], or none
  std::vector<double> start;                          // [coordinate], as the scene begins
  std::vector<std::pair<int, int>> joint_coordinate;  // of the scene; its first coordinate
  std::vector<PlanAnchor> anchors;                    // [joint of the scene]
  kernels::NewtonOptions<double> newton{};
  TreeWeights weights;
  int coordinates = 0;
  int entries = 0;      // of the joint-space inertia
  bool damped = false;  // some joints are, in some world
  // How the newton solver works (kernels/data/tree_tables.hpp).
  bool by_links = true;
  int couplings = 0;
};

// The dof that moves a link last, on the way from the world; -1: none.
int last_dof(const PlanTrees& trees, const kernels::TreeLink<double>& link);

// A link and where it is in its parent's frame at the reference (kernels/data/tree_tables.hpp).
struct NewLink {
  int body = 0;     // its row among bodies with state
  int parent = -1;  // link; -1: the world
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 center = Vec3::Zero();         // of mass, in the link's frame
  Quat principal = Quat::Identity();  // axes of inertia in the link's frame
  double mass = 1;                    // kg
  Vec3 moments = Vec3::Ones();        // kg m^2, about the principal axes
};
// A joint of a link, in the link's frame at the reference. Its numbers are those of each of its
// dofs.
struct NewTreeJoint {
  kernels::TreeJointKind kind = kernels::TreeJointKind::hinge;
  Vec3 anchor = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  // need not be unit
  double armature = 0, damping = 0;
  double stiffness = 0;                 // of a hinge, slide or ball
  bool sprung = false, damped = false;  // has a spring or damper in some world, if not in this
  bool limited = false;                 // a ball whose range acts in some world, if not in this
  double reference = 0, rest = 0;       // of a hinge or slide, rad or m
  std::optional<std::array<double, 2>> range = {};  // rad or m; of a ball 0 to the largest angle
  double margin = 0;                                // of the range
  Compliance compliance = {};
};

// A length that is limited: coordinates, of hinges and slides, times their coefficients.
struct NewLength {
  std::vector<kernels::TreeTerm<double>> terms;
  std::array<double, 2> range{};
  double margin = 0;
  Compliance compliance = {};
  int joint = -1;  // whose coordinate it is; -1: a tendon
};

// Adds links, each before its children and all links of a tree in a row, and the joints that move
// a link in the order in which they do.
class TreeBuilder {
 public:
  int add(const NewLink& link);
  void add(const NewTreeJoint& joint);  // of the link that was added last
  void add(const NewLength& tendon);
  int dof_of(int coordinate) const;     // of a hinge or slide
  void add_drag(const Medium& medium);  // on all links
  // `newton`: without its scale.
  PlanTrees finish(double dt, const kernels::NewtonOptions<double>& newton);

 private:
  PlanTrees trees_;
  std::vector<NewLink> links_;
  void add_ball(const NewTreeJoint& joint, int own);
  void add_limits(const NewLength& length, double inverse_weight, double dt);

  std::vector<NewLength> limited_joints_, tendons_;
  std::vector<NewLength> limited_balls_;  // of one term each, the first coordinate and dof
};

// tree_numbers.cpp
kernels::LinkConstants<double> link_numbers(const Vec3& center, const Quat& principal);
kernels::LimitConstants<double> limit_numbers(double end, const Compliance& compliance, double dt);
kernels::ActuatorConstants<double> actuator_numbers(const Actuator& actuator);
kernels::DragConstants<double> drag_numbers(const Medium& medium, double mass, const Vec3& moments);

// tree_pairs.cpp: how soft contacts of two materials are.
Compliance mixed_compliance(const SoftContact& a, const SoftContact& b);

// tree_weights.cpp
TreeWeights weights_of(const PlanTrees& trees, const std::vector<NewLink>& links);

}  // namespace manyworlds
