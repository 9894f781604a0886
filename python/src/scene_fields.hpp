// The members of everything that a scene consists of, by the names that the dataclasses of the
// package have: the one list from which scenes are read and written. A test compares it, and every
// default, with the dataclasses.
#pragma once

#include "convert.hpp"
#include "manyworlds/observe.hpp"

namespace manyworlds::python {

// X(m) visits member m of s.
#define MW_EACH_1(X, a) X(a)
#define MW_EACH_2(X, a, ...) X(a) MW_EACH_1(X, __VA_ARGS__)
#define MW_EACH_3(X, a, ...) X(a) MW_EACH_2(X, __VA_ARGS__)
#define MW_EACH_4(X, a, ...) X(a) MW_EACH_3(X, __VA_ARGS__)
#define MW_EACH_5(X, a, ...) X(a) MW_EACH_4(X, __VA_ARGS__)
#define MW_EACH_6(X, a, ...) X(a) MW_EACH_5(X, __VA_ARGS__)
#define MW_EACH_7(X, a, ...) X(a) MW_EACH_6(X, __VA_ARGS__)
#define MW_EACH_8(X, a, ...) X(a) MW_EACH_7(X, __VA_ARGS__)
#define MW_EACH_9(X, a, ...) X(a) MW_EACH_8(X, __VA_ARGS__)
#define MW_EACH_10(X, a, ...) X(a) MW_EACH_9(X, __VA_ARGS__)
#define MW_PICK(a, b, c, d, e, f, g, h, i, j, pick, ...) pick
#define MW_EACH(X, ...)                                                                   \
  MW_PICK(__VA_ARGS__, MW_EACH_10, MW_EACH_9, MW_EACH_8, MW_EACH_7, MW_EACH_6, MW_EACH_5, \
          MW_EACH_4, MW_EACH_3, MW_EACH_2, MW_EACH_1)                                     \
  (X, __VA_ARGS__)
#define MW_VISIT(member) visit(#member, s.member);
// A struct with up to 10 members; longer ones have several lines of them.
#define MW_DESCRIBE(Struct, ...)                              \
  template <>                                                 \
  struct Described<Struct> {                                  \
    static constexpr const char* name = #Struct;              \
    static void fields(auto&& visit, auto& s) { __VA_ARGS__ } \
  }
#define MW_MEMBERS(...) MW_EACH(MW_VISIT, __VA_ARGS__)

// -- shapes
MW_DESCRIBE(Sphere, MW_MEMBERS(radius));
MW_DESCRIBE(Box, MW_MEMBERS(half_extents));
MW_DESCRIBE(Plane, MW_MEMBERS(normal, offset));
MW_DESCRIBE(Capsule, MW_MEMBERS(radius, half_length));
MW_DESCRIBE(Cylinder, MW_MEMBERS(radius, half_length));
MW_DESCRIBE(Hull, MW_MEMBERS(vertices));
MW_DESCRIBE(Circle, MW_MEMBERS(radius));
MW_DESCRIBE(Polygon, MW_MEMBERS(vertices, radius));
MW_DESCRIBE(HalfPlane, MW_MEMBERS(normal, offset));
MW_DESCRIBE(Segment, MW_MEMBERS(a, b));
MW_DESCRIBE(Terrain, MW_MEMBERS(points, loop));
MW_DESCRIBE(HeightField, MW_MEMBERS(heights, columns, cell));
MW_DESCRIBE(Material, MW_MEMBERS(friction, restitution));
MW_DESCRIBE(Filter, MW_MEMBERS(category, mask));
MW_DESCRIBE(Shape, MW_MEMBERS(geometry, position, rotation, density, material, filter, name));

// -- bodies
MW_DESCRIBE(MassProperties, MW_MEMBERS(mass, center, inertia));
MW_DESCRIBE(Jitter, MW_MEMBERS(position, linear_velocity, angle, any_orientation)
                        visit("with_body", s.with););  // `with` is a keyword of Python
MW_DESCRIBE(Body, MW_MEMBERS(name, motion, enabled, position, rotation, linear_velocity,
                             angular_velocity, shapes, mass_properties, gravity_scale)
                      MW_MEMBERS(linear_drag, angular_drag, jitter));

// -- joints
MW_DESCRIBE(Frame, MW_MEMBERS(position, rotation));
MW_DESCRIBE(Spring, MW_MEMBERS(stiffness, damping, frequency, damping_ratio));
MW_DESCRIBE(Limit, MW_MEMBERS(low, high, spring));
MW_DESCRIBE(Drive, MW_MEMBERS(target_position, target_speed, spring, max_force));
MW_DESCRIBE(BallJoint, MW_MEMBERS(cone, twist));
MW_DESCRIBE(HingeJoint, MW_MEMBERS(limit, drive));
MW_DESCRIBE(SliderJoint, MW_MEMBERS(limit, drive));
MW_DESCRIBE(FixedJoint, (void)visit, (void)s;);
MW_DESCRIBE(DistanceJoint, MW_MEMBERS(length, limit, spring));
MW_DESCRIBE(WheelJoint, MW_MEMBERS(suspension, travel, drive));
MW_DESCRIBE(PulleyJoint, MW_MEMBERS(ground_a, ground_b, ratio, length));
MW_DESCRIBE(TargetJoint, MW_MEMBERS(spring, max_force));
MW_DESCRIBE(Joint, MW_MEMBERS(name, type, body_a, body_b, frame_a, frame_b, collide, break_force,
                              break_torque));

// -- the rest of a scene
MW_DESCRIBE(Control, MW_MEMBERS(name, kind, joint, body, point, direction, low, high, initial));
MW_DESCRIBE(Attractor, MW_MEMBERS(position, strength, softening));
MW_DESCRIBE(Variation, MW_MEMBERS(parameter, body, shape, low, high, draw, together));
MW_DESCRIBE(Options,
            MW_MEMBERS(dt, substeps, gravity, wind, density, integrator, rotation, angular_momentum,
                       solver, iterations)
                MW_MEMBERS(relaxation, push_out_share, split_impulse, length_unit,
                           contact_frequency, contact_damping_ratio, push_out_speed, slop,
                           restitution_threshold, restitution_sweeps)
                    MW_MEMBERS(friction_in_bias_pass, cast_against_fixed, cast_between_moving,
                               joint_frequency, joint_damping_ratio, joint_pull_speed, sleep_speed,
                               time_to_sleep, contact_capacity, bounds));
MW_DESCRIBE(Scene,
            MW_MEMBERS(name, space, bodies, joints, controls, attractors, options, variations));
MW_DESCRIBE(Ray, MW_MEMBERS(origin, direction, length, body, mask));

#undef MW_DESCRIBE
#undef MW_MEMBERS
#undef MW_VISIT
#undef MW_EACH
#undef MW_PICK
#undef MW_EACH_1
#undef MW_EACH_2
#undef MW_EACH_3
#undef MW_EACH_4
#undef MW_EACH_5
#undef MW_EACH_6
#undef MW_EACH_7
#undef MW_EACH_8
#undef MW_EACH_9
#undef MW_EACH_10

}  // namespace manyworlds::python
