// Random trees, states of them, and the instruction sets that they are tried on.
#pragma once

#include <vector>

#include "src/dispatch/kernels.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tree_twin.hpp"

namespace manyworlds::test {

inline NewTreeJoint random_joint(Random& random, kernels::TreeJointKind kind, double size) {
  NewTreeJoint joint;
  joint.kind = kind;
  joint.anchor = random.in_cube(size);
  joint.axis = random.direction();
  joint.armature = random.chance(0.5) ? random.uniform(0, 0.1) : 0;
  joint.damping = random.chance(0.5) ? random.uniform(0, 1) : 0;
  if (kernels::dofs_of(kind) == 1 && random.chance(0.3)) {
    joint.reference = random.uniform(-0.5, 0.5);
    joint.stiffness = random.uniform(0, 20), joint.rest = random.uniform(-1, 1);
  }
  return joint;
}

// Up to `most` links of about `size`, one or several trees, on a free root or on the world.
inline std::vector<TwinLink> random_trees(Random& random, int most, double size) {
  std::vector<TwinLink> links;
  const int count = random.integer(1, most);
  int root = 0;
  for (int i = 0; i < count; ++i) {
    TwinLink link;
    link.frame.body = count - 1 - i;  // bodies need not be in the order of links
    const bool starts = i == 0 || random.chance(0.1);
    if (starts) root = i;
    link.frame.parent = starts ? -1 : random.integer(root, i - 1);
    link.frame.position = random.in_cube(size), link.frame.rotation = random.rotation();
    link.frame.center = random.in_cube(0.3 * size), link.frame.principal = random.rotation();
    link.frame.mass = random.uniform(0.2, 5);
    const double third = link.frame.mass * size * size / 3;  // of a box with random half extents
    const double x = random.uniform(0.1, 1), y = random.uniform(0.1, 1), z = random.uniform(0.1, 1);
    link.frame.moments = third * Vec3(y * y + z * z, x * x + z * z, x * x + y * y);
    if (random.chance(0.3)) link.force = random.in_cube(10), link.torque = random.in_cube(size);
    if (starts && random.chance(0.5)) {
      link.joints.push_back(random_joint(random, kernels::TreeJointKind::free, size));
    } else if (random.chance(0.25)) {
      link.joints.push_back(random_joint(random, kernels::TreeJointKind::ball, size));
    } else {
      for (int k = random.integer(starts ? 1 : 0, 3); k > 0; --k) {
        const bool hinge = random.chance(0.7);
        link.joints.push_back(random_joint(
            random, hinge ? kernels::TreeJointKind::hinge : kernels::TreeJointKind::slide, size));
      }
    }
    links.push_back(link);
  }
  return links;
}

struct TreeState {
  TreeTwin::Numbers q, v;
};
inline TreeState random_state(Random& random, const TreeTwin& twin) {
  TreeState s{TreeTwin::Numbers(twin.coordinates()), TreeTwin::Numbers(twin.dofs())};
  for (int i = 0; i < s.q.size(); ++i) s.q[i] = random.uniform(-1.5, 1.5);
  for (int k = 0; k < s.v.size(); ++k) s.v[k] = random.uniform(-2, 2);
  return s;
}

// The coordinates at which the links are where their frames say.
inline TreeTwin::Numbers reference_coordinates(const TreeTwin& twin) {
  TreeTwin::Numbers q = TreeTwin::Numbers::Zero(twin.coordinates());
  int c = 0;
  for (const TwinLink& link : twin.links()) {
    for (const NewTreeJoint& joint : link.joints) {
      if (joint.kind == kernels::TreeJointKind::ball) q[c] = 1;
      if (kernels::dofs_of(joint.kind) == 1) q[c] = joint.reference;
      if (joint.kind == kernels::TreeJointKind::free) {
        const Quat r = link.frame.rotation.normalized();
        q.segment<3>(c) = link.frame.position;
        q.segment<4>(c + 3) << r.w(), r.x(), r.y(), r.z();
      }
      c += kernels::coordinates_of(joint.kind);
    }
  }
  return q;
}

template <class Real, class Check>
void for_each_isa(Check check) {
  for (const Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512}) {
    if (const auto* kernels = find_kernels<Real>(isa)) check(*kernels);
  }
}

}  // namespace manyworlds::test
