// The list of observers and of what each sees: the one place that names them. Sizes, storage,
// reading, terms of tasks and Python's arrays are made from it. Kernels share it: it includes
// nothing, and defines nothing that objects could share.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// X(observer, what has numbers of its own, when they are taken, what it sees)
//   state: at the end of a call, and by Batch::look(), which needs no step
//   step: of the last step of a call, 0 before it
#define MW_OBSERVERS(X)                                                                     \
  X(contacts, world, step, "every contact point with the impulses of the last step")        \
  X(touching, body, step, "which bodies a contact acted on in the last step")               \
  X(penetration, world, step, "the deepest overlap that the last step began with")          \
  X(motion, world, state, "energies, momenta, mass centre")                                 \
  X(joints, coordinate, state, "coordinates of joints and their speeds")                    \
  X(joint_loads, joint, state, "forces and torques in joints")                              \
  X(residual, world, step, "how far the solver was from done")                              \
  X(rays, ray, state, "where the rays end: chosen by giving Observers::rays")               \
  X(acceleration, body, state, "accelerations over the last step, and accelerometers")      \
  X(points, point, state, "where points of bodies are: chosen by giving Observers::points") \
  X(links, body, state, "where links of trees were as their last forces were found")        \
  X(link_inertias, body, state, "inertias of links about the mass centre of their tree")    \
  X(link_velocities, body, state, "velocities of links at the mass centre of their tree")   \
  X(link_forces, body, step, "forces and torques of contacts and inputs on bodies")         \
  X(dof_forces, dof, step, "generalised forces of actuators and constraints")               \
  X(tendons, tendon, state, "lengths of tendons as the last forces were found")             \
  X(sites, site, state, "where sites are, of trees as their last forces were found")        \
  X(drives, coordinate, step, "forces and torques of drives and actuators of joints")

// X(what, its observer, components, unit, meaning)
//   vector: [2 or 3], the plane's x and y or x, y and z
//   spin: [1 or 3], the plane's z or x, y and z
#define MW_OBSERVED(X)                                                                             \
  X(kinetic_energy, motion, one, "J", "")                                                          \
  X(potential_energy, motion, one, "J", "0 at the world's origin")                                 \
  X(total_mass, motion, one, "kg", "of dynamic bodies")                                            \
  X(momentum, motion, vector, "N s", "")                                                           \
  X(angular_momentum, motion, spin, "N m s", "about the world's origin")                           \
  X(mass_center, motion, vector, "m", "")                                                          \
  X(penetration, penetration, one, "m",                                                            \
    "deepest overlap that the last step began with, 0 if none")                                    \
  X(contact_count, contacts, one, "1", "contact points of the last step, all of them")             \
  X(touching, touching, one, "1", "1 where a contact acted on the body in the last step, else 0")  \
  X(joint_position, joints, one, "m or rad", "coordinates of the joints (Plan.first_observed)")    \
  X(joint_speed, joints, one, "m/s or rad/s", "")                                                  \
  X(joint_force, joint_loads, vector, "N", "on body B, world axes, last substep")                  \
  X(joint_torque, joint_loads, spin, "N m", "on body B about its anchor, last substep")            \
  X(residual, residual, two, "m/s, rad/s",                                                         \
    "largest change that one more sweep of the solver would make")                                 \
  X(ray_distance, rays, one, "m", "the ray's length where it hits nothing")                        \
  X(ray_normal, rays, vector, "1", "out of what is hit, world; 0: no hit")                         \
  X(ray_body, rays, one, "1", "scene body, -1: no hit")                                            \
  X(ray_shape, rays, one, "1", "index in Body.shapes, -1: no hit")                                 \
  X(linear_acceleration, acceleration, vector, "m/s^2",                                            \
    "of the centre of mass over the last step, impacts included, world")                           \
  X(angular_acceleration, acceleration, spin, "rad/s^2", "over the last step, world")              \
  X(proper_acceleration, acceleration, vector, "m/s^2",                                            \
    "what an accelerometer at the centre of mass reads, body axes: g upwards at rest, 0 in free "  \
    "fall")                                                                                        \
  X(point_position, points, vector, "m", "world")                                                  \
  X(point_velocity, points, vector, "m/s", "of the point of the body, world")                      \
  X(link_position, links, vector, "m", "of the body's frame, world (MuJoCo's xpos)")               \
  X(link_center, links, vector, "m", "of its centre of mass, world (xipos)")                       \
  X(link_inertia, link_inertias, vector, "kg m^2", "xx, yy, zz, world axes (cinert)")              \
  X(link_product, link_inertias, vector, "kg m^2", "xy, xz, yz, world axes (cinert)")              \
  X(link_moment, link_inertias, vector, "kg m", "mass times the way from there to its own centre") \
  X(link_mass, link_inertias, one, "kg", "")                                                       \
  X(link_angular_velocity, link_velocities, spin, "rad/s", "world axes (cvel)")                    \
  X(link_velocity, link_velocities, vector, "m/s", "of the link there, world axes (cvel)")         \
  X(external_torque, link_forces, spin, "N m",                                                     \
    "of contacts and inputs, about the mass centre of the tree, world axes (cfrc_ext)")            \
  X(external_force, link_forces, vector, "N", "of contacts and inputs, world axes (cfrc_ext)")     \
  X(actuator_force, dof_forces, one, "N or N m", "MuJoCo's qfrc_actuator")                         \
  X(constraint_force, dof_forces, one, "N or N m", "of limits and contacts (qfrc_constraint)")     \
  X(tendon_length, tendons, one, "m or rad", "sum of coordinates (ten_length)")                    \
  X(tendon_velocity, tendons, one, "m/s or rad/s", "(ten_velocity)")                               \
  X(site_position, sites, vector, "m", "world (site_xpos)")                                        \
  X(drive_force, drives, one, "N or N m", "of drive, spring or actuators along the coordinate")

// What is read is [world][item of its observer][component]. A plan without orientation (every
// moving body a centred ball) rotates neither rays nor points.
//
// The coordinates of a joint follow one another, the joints are in their order
// (Plan::first_observed):
//   ball      cone and twist, rad        hinge  angle, rad      slider  travel, m
//   distance  length, m                  wheel  travel, m, and angle, rad
//   pulley    |rope at A| + ratio |rope at B|, m                fixed, target  none
// with angles in (-pi, pi], and their speeds in m/s and rad/s. Force and torque are what B gets
// from the joint, the torque about B's anchor, world axes; those of the last substep.
//
// With Solver::newton the angle of a hinge and the travel of a slider are their generalised
// positions: with JointDynamics::reference, and without end. What B gets is all that passes
// through the joint: what holds it, and its spring, damper, limits, actuators and tendons, less
// what its rotor (armature) takes; and what all that hangs on B asks for. It is that of the
// accelerations and contacts of the last substep, where links were as it began (Runge-Kutta: in
// its last stage), so that with what acts from outside it gives each link the acceleration that
// it had there. Joints of a series all carry the same, each about its own anchor on what it moves.
// A state that is looked at without a step tells 0.
//
// The residual is the largest change of a component of any body's velocity, and of its spin, that
// one more sweep of the solver over all rows would make after those of the last substep (of
// tgs_soft: one more relaxing sweep); restitution comes after it. It is 0 where the velocities
// solve the rows' complementarity problem, and where nothing is awake.
//
// Accelerations are the change of velocity in the last step of a call / dt: 0 of a body that is
// asleep, disabled, kinematic or frozen, and when a state is looked at without a step. Proper
// acceleration is that minus what gravity gives the body (times its gravity scale, attractors
// included, nothing for kinematic bodies), as MuJoCo's accelerometer in the body's frame; 0 of a
// body that is disabled or frozen.
//
// With Solver::newton links, their inertias, velocities and forces, forces on dofs, drives and
// tendons are those of the last substep, where its forces were found, which is where it began
// (Runge-Kutta: its last stage). So they are one substep behind the state, as MuJoCo's are after
// mj_step. A state that is looked at without a step gives the places of links and their velocities
// in it.
//
// Other solvers have no trees. There links and sites are where the state has them, and external
// forces are the mean over the last step, with torques about the centre of mass of the body itself.
// link_inertias, link_velocities, dof_forces and tendons need Solver::newton: Batch and Environment
// refuse them in other scenes, and name what to use instead (observable()).
//
// External forces are those of contacts and of inputs (Batch::add_force), not of gravity, drag,
// joints or controls. Kinematic bodies have contact forces only. Drive forces are what the drive or
// the spring of a joint does along a coordinate in the last substep, 0 where it has none; with
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

// What has numbers of its own: a body is a row of state arrays (Plan::row).
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
