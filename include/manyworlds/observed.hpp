// The table of observers and their outputs. Sizes, storage, reading, terms of tasks and Python's
// arrays follow from it. Kernels share it, so it must not define anything with linkage.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// X(observer, item, when it is taken, meaning)
//   state: at the end of a call, and by Batch::look(), which needs no step
//   step: in the last step of a call, 0 before it
#define MW_OBSERVERS(X)                                                                   \
  X(contacts, world, step, "all contact points, with the impulses of the last step")      \
  X(touching, body, step, "bodies on which a contact acted in the last step")             \
  X(penetration, world, step, "deepest overlap at the start of the last step")            \
  X(motion, world, state, "energies, momenta, mass centre")                               \
  X(joints, coordinate, state, "coordinates and speeds of joints")                        \
  X(joint_loads, joint, state, "forces and torques in joints")                            \
  X(residual, world, step, "velocity change by one more sweep of the solver")             \
  X(rays, ray, state, "hits of rays: chosen by a non-empty Observers::rays")              \
  X(acceleration, body, state, "accelerations over the last step, and accelerometers")    \
  X(points, point, state, "points of bodies: chosen by a non-empty Observers::points")    \
  X(links, body, state, "positions of links at the last force computation")               \
  X(link_inertias, body, state, "inertias of links about the mass centre of their tree")  \
  X(link_velocities, body, state, "velocities of links at the mass centre of their tree") \
  X(link_forces, body, step, "forces and torques of contacts and inputs on bodies")       \
  X(dof_forces, dof, step, "generalised forces of actuators and constraints")             \
  X(tendons, tendon, state, "lengths of tendons at the last force computation")           \
  X(sites, site, state, "positions of sites, in trees at the last force computation")     \
  X(drives, coordinate, step, "forces and torques of drives and actuators of joints")

// X(output, its observer, components, unit, meaning)
//   vector: [2 or 3], x and y in the plane, else x, y and z
//   spin: [1 or 3], z in the plane, else x, y and z
#define MW_OBSERVED(X)                                                                            \
  X(kinetic_energy, motion, one, "J", "")                                                         \
  X(potential_energy, motion, one, "J", "0 at the world's origin")                                \
  X(total_mass, motion, one, "kg", "of dynamic bodies")                                           \
  X(momentum, motion, vector, "N s", "")                                                          \
  X(angular_momentum, motion, spin, "N m s", "about the world's origin")                          \
  X(mass_center, motion, vector, "m", "")                                                         \
  X(penetration, penetration, one, "m",                                                           \
    "deepest overlap at the start of the last step, 0 if none")                                   \
  X(contact_count, contacts, one, "1", "all contact points of the last step")                     \
  X(touching, touching, one, "1", "1 if a contact acted on the body in the last step, else 0")    \
  X(joint_position, joints, one, "m or rad", "coordinates of the joints (Plan.first_observed)")   \
  X(joint_speed, joints, one, "m/s or rad/s", "")                                                 \
  X(joint_force, joint_loads, vector, "N", "on body B, world axes, last substep")                 \
  X(joint_torque, joint_loads, spin, "N m", "on body B about its anchor, last substep")           \
  X(residual, residual, two, "m/s, rad/s",                                                        \
    "largest change of a velocity that one more sweep of the solver would make")                  \
  X(ray_distance, rays, one, "m", "the ray's length if it hits nothing")                          \
  X(ray_normal, rays, vector, "1", "outward from the hit shape, world; 0: no hit")                \
  X(ray_body, rays, one, "1", "scene body, -1: no hit")                                           \
  X(ray_shape, rays, one, "1", "index in Body.shapes, -1: no hit")                                \
  X(linear_acceleration, acceleration, vector, "m/s^2",                                           \
    "of the centre of mass over the last step, impacts included, world")                          \
  X(angular_acceleration, acceleration, spin, "rad/s^2", "over the last step, world")             \
  X(proper_acceleration, acceleration, vector, "m/s^2",                                           \
    "reading of an accelerometer at the centre of mass, body axes: g upwards at rest, 0 in free " \
    "fall")                                                                                       \
  X(point_position, points, vector, "m", "world")                                                 \
  X(point_velocity, points, vector, "m/s", "of the point of the body, world")                     \
  X(link_position, links, vector, "m", "of the body's frame, world (MuJoCo's xpos)")              \
  X(link_center, links, vector, "m", "of its centre of mass, world (xipos)")                      \
  X(link_inertia, link_inertias, vector, "kg m^2", "xx, yy, zz, world axes (cinert)")             \
  X(link_product, link_inertias, vector, "kg m^2", "xy, xz, yz, world axes (cinert)")             \
  X(link_moment, link_inertias, vector, "kg m",                                                   \
    "mass times the vector from the tree's mass centre to the link's (cinert)")                   \
  X(link_mass, link_inertias, one, "kg", "")                                                      \
  X(link_angular_velocity, link_velocities, spin, "rad/s", "world axes (cvel)")                   \
  X(link_velocity, link_velocities, vector, "m/s",                                                \
    "of the link at the tree's mass centre, world axes (cvel)")                                   \
  X(external_torque, link_forces, spin, "N m",                                                    \
    "of contacts and inputs, about the mass centre of the tree, world axes (cfrc_ext)")           \
  X(external_force, link_forces, vector, "N", "of contacts and inputs, world axes (cfrc_ext)")    \
  X(actuator_force, dof_forces, one, "N or N m", "MuJoCo's qfrc_actuator")                        \
  X(constraint_force, dof_forces, one, "N or N m", "of limits and contacts (qfrc_constraint)")    \
  X(tendon_length, tendons, one, "m or rad", "sum of coordinates (ten_length)")                   \
  X(tendon_velocity, tendons, one, "m/s or rad/s", "rate of tendon_length (ten_velocity)")        \
  X(site_position, sites, vector, "m", "world (site_xpos)")                                       \
  X(drive_force, drives, one, "N or N m", "of drive, spring or actuators along the coordinate")

// Arrays are [world][item of the observer][component]. A plan without orientation (every moving
// body is a centred ball) does not rotate rays and points.
//
// Coordinates are in the order of the joints (Plan::first_observed):
//   ball      cone and twist, rad        hinge  angle, rad      slider  travel, m
//   distance  length, m                  wheel  travel, m, and angle, rad
//   pulley    |rope at A| + ratio |rope at B|, m                fixed, target  none
// Angles are in (-pi, pi], speeds in m/s and rad/s. Joint loads are the force and torque on B in
// the last substep, in world axes, the torque about B's anchor.
//
// With Solver::newton, the angle of a hinge and the travel of a slider are generalised positions:
// they include JointDynamics::reference and are unbounded. Joint loads are the total wrench from
// the joint on B: constraint forces, springs, dampers, limits, actuators and tendons, including the
// load of all bodies attached to B. The part that accelerates the rotor (armature) is excluded.
// Loads belong to the accelerations and contacts of the last substep, with links at its start
// (Runge-Kutta: its last stage). Together with external forces they give each link its acceleration
// there. Joints in series have the same load, each about its own anchor on what it moves. look()
// without a step reports loads of 0.
//
// The residual is the largest change of a component of any body's velocity, and of its spin, by one
// more sweep of the solver. The sweep follows those of the last substep (tgs_soft: a relaxing
// sweep) and precedes restitution. The residual is 0 if the velocities solve the complementarity
// problem of the rows, or if no body is awake. It does not include joints
// of trees (JointMethod::tree) and joints attached to them.
//
// Accelerations are the change of velocity in the last step of a call, divided by dt. They are 0
// for bodies that are asleep, disabled, kinematic or frozen, and after look() without a step.
// Proper acceleration subtracts the acceleration of gravity (with gravity scale and attractors) and
// is in body axes, as MuJoCo's accelerometer. It counts no gravity for kinematic bodies. Proper
// acceleration is 0 for bodies that are disabled or frozen.
//
// With Solver::newton, values of links, dofs, drives and tendons are those of the last force
// computation: at the start of the last substep (Runge-Kutta: its last stage). They are one substep
// behind the state, as in MuJoCo after mj_step. look() without a step reports positions and
// velocities of links at the current state.
//
// Other solvers have no trees. There links and sites are at the current state. External forces are
// means over the last step, with torques about the body's own centre of mass. link_inertias,
// link_velocities, dof_forces and tendons need Solver::newton. Batch and Environment reject them in
// other scenes; the error names an alternative (observable()).
//
// External forces are those of contacts and inputs (Batch::add_force), without gravity, drag,
// joints and controls. Kinematic bodies have contact forces only. Drive forces are those of a
// joint's drive or spring along a coordinate in the last substep; 0 without one. With
// Solver::newton they are the forces of its actuators (ControlKind::joint_force), after the gear.
enum class Observer {
#define MW_OBSERVER_ENUM(name, item, taken, meaning) name,
  MW_OBSERVERS(MW_OBSERVER_ENUM)
#undef MW_OBSERVER_ENUM
};
enum class Observed {
#define MW_OBSERVED_ENUM(name, observer, components, unit, meaning) name,
  MW_OBSERVED(MW_OBSERVED_ENUM)
#undef MW_OBSERVED_ENUM
};

// Item of an observer. A body is a row of state arrays (Plan::row).
enum class ObservedItem { world, body, joint, coordinate, dof, tendon, site, ray, point };
enum class ObservedComponents { one, two, vector, spin };
enum class ObservedOf { state, step };

struct ObserverInfo {
  const char* name;
  ObservedItem item;
  ObservedOf of;
  const char* meaning;
};
struct ObservedInfo {
  const char* name;
  Observer observer;
  ObservedComponents components;
  const char* unit;
  const char* meaning;
};

constexpr ObserverInfo kObserverInfo[] = {
#define MW_OBSERVER_INFO(name, item, taken, meaning) \
  {#name, ObservedItem::item, ObservedOf::taken, meaning},
    MW_OBSERVERS(MW_OBSERVER_INFO)
#undef MW_OBSERVER_INFO
};
constexpr ObservedInfo kObservedInfo[] = {
#define MW_OBSERVED_INFO(name, observer, components, unit, meaning) \
  {#name, Observer::observer, ObservedComponents::components, unit, meaning},
    MW_OBSERVED(MW_OBSERVED_INFO)
#undef MW_OBSERVED_INFO
};
inline constexpr int kObserverCount = sizeof(kObserverInfo) / sizeof(ObserverInfo);
inline constexpr int kObservedCount = sizeof(kObservedInfo) / sizeof(ObservedInfo);

}  // namespace manyworlds
