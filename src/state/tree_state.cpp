// Worlds whose bodies are in joint coordinates: how they begin, and where that puts the bodies.
#include "src/plan/tree_kinematics.hpp"
#include "src/state/coordinate_draws.hpp"
#include "src/state/worlds.hpp"

namespace manyworlds {

// A tree with a free joint begins where its root was drawn; what hangs on it moves along.
template <class Real>
void Worlds<Real>::begin_trees(int world, const Draws& draws) {
  const PlanTrees& trees = data().trees;
  for (std::size_t c = 0; c < trees.start.size(); ++c) {
    number(Field::generalized_position, world, static_cast<int>(c), 0) =
        static_cast<Real>(trees.start[c]);
  }
  for (const auto& joint : trees.joints) {
    if (joint.kind != kernels::TreeJointKind::free) continue;
    const int link = trees.dofs[static_cast<std::size_t>(joint.dof)].link;
    const int row = trees.links[static_cast<std::size_t>(link)].body;
    const int scene_body = data().bodies[static_cast<std::size_t>(row)].scene_body;
    const BodyState s = drawn_state(world, scene_body, draws);
    const Vec3 center = body_of(world, static_cast<std::size_t>(row)).center;
    const Vec3 linear = s.linear_velocity - s.angular_velocity.cross(s.rotation * center);
    const Vec3 angular = s.rotation.conjugate() * s.angular_velocity;
    const double q[] = {s.rotation.w(), s.rotation.x(), s.rotation.y(), s.rotation.z()};
    const auto put = [&](Field field, int item, double value) {
      number(field, world, item, 0) = static_cast<Real>(value);
    };
    for (int c = 0; c < 3; ++c) {
      put(Field::generalized_position, joint.coordinate + c, s.position[c]);
      put(Field::generalized_velocity, joint.dof + c, linear[c]);
      put(Field::generalized_velocity, joint.dof + 3 + c, angular[c]);
    }
    for (int c = 0; c < 4; ++c) put(Field::generalized_position, joint.coordinate + 3 + c, q[c]);
  }
  draw_coordinates(world, draws);
  place_links(world);
}

// In their order, each upon what is there.
template <class Real>
void Worlds<Real>::draw_coordinates(int world, const Draws& draws) {
  const auto& all = plan_.scene().coordinate_draws;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const CoordinateDraw& draw = all[i];
    const Field field = draw.velocity ? Field::generalized_velocity : Field::generalized_position;
    for_each_drawn(draw, i, draws, [&](std::size_t k, double drawn) {
      Real& number_of = number(field, world, draw.first + static_cast<int>(k), 0);
      const double from = draw.replaces ? 0 : static_cast<double>(number_of);
      number_of = static_cast<Real>(from + drawn);
    });
  }
}

template <class Real>
void Worlds<Real>::place_links(int world) {
  const PlanTrees& trees = data().trees;
  std::vector<double> q, v;
  for (int c = 0; c < trees.coordinates; ++c) {
    q.push_back(static_cast<double>(number(Field::generalized_position, world, c, 0)));
  }
  for (int k = 0; k < static_cast<int>(trees.dofs.size()); ++k) {
    v.push_back(static_cast<double>(number(Field::generalized_velocity, world, k, 0)));
  }
  const TreeKinematics at = kinematics_of(trees, q);
  for (std::size_t i = 0; i < trees.links.size(); ++i) {
    const int row = trees.links[i].body;
    // Its centre of mass in this world.
    const PlanBody& own = body_of(world, static_cast<std::size_t>(row));
    const Vec3 center = at.origin[i] + at.rotation[i] * own.center;
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    for_each_dof_of(trees, i, [&](std::size_t k) {
      linear += v[k] * at.motions[k].velocity(center);
      angular += v[k] * at.motions[k].axis;
    });
    for (int c = 0; c < 3; ++c) {
      number(Field::position, world, row, c) = static_cast<Real>(center[c]);
      number(Field::linear_velocity, world, row, c) = static_cast<Real>(linear[c]);
      number(Field::angular_velocity, world, row, c) = static_cast<Real>(angular[c]);
    }
    set_rotation(world, row, at.rotation[i] * own.principal);
  }
}

template void Worlds<float>::begin_trees(int, const Draws&);
template void Worlds<double>::begin_trees(int, const Draws&);
template void Worlds<float>::draw_coordinates(int, const Draws&);
template void Worlds<double>::draw_coordinates(int, const Draws&);
template void Worlds<float>::place_links(int);
template void Worlds<double>::place_links(int);

}  // namespace manyworlds
