// What validate() says about options and about the size of a scene.
#include <catch2/catch.hpp>

#include "tests/support/scene_cases.hpp"

namespace manyworlds {
namespace {

using test::BadInput;
using test::check_each;
using test::circle_scene;

using test::kInf;
using test::kNan;
using test::sphere_scene;

BadInput bad(const std::string& field, double Options::*member, double value,
             const std::string& message) {
  return {field, message, [=](Scene& s) { s.options.*member = value; }};
}
BadInput bad(const std::string& field, std::optional<double> Options::*member, double value,
             const std::string& message) {
  return {field, message, [=](Scene& s) { s.options.*member = value; }};
}
template <class Group, class Member>
BadInput bad(const std::string& field, Group Options::*group, Member Group::*member, double value,
             const std::string& message) {
  return {field, message, [=](Scene& s) { (s.options.*group).*member = value; }};
}

}  // namespace

TEST_CASE("bad options are named with their value", "[fast][scene]") {
  const std::vector<BadInput> cases = {
      bad("dt", &Options::dt, 0, "is 0 s, must be > 0"),
      bad("dt", &Options::dt, -0.01, "is -0.01 s, must be > 0"),
      bad("dt", &Options::dt, kNan, "is nan s, must be > 0"),
      bad("dt", &Options::dt, kInf, "is inf s"),
      bad("dt", &Options::dt, 1e-300, "is 1e-300 s"),
      {"substeps", "is 0, must be between 1 and 64", [](Scene& s) { s.options.substeps = 0; }},
      {"substeps", "is -4", [](Scene& s) { s.options.substeps = -4; }},
      {"substeps", "is 65", [](Scene& s) { s.options.substeps = 65; }},
      {"solver.iterations", "is 0, must be between 1 and 10000",
       [](Scene& s) { s.options.solver.iterations = 0; }},
      {"solver.iterations", "is 10001", [](Scene& s) { s.options.solver.iterations = 10001; }},
      bad("solver.relaxation", &Options::solver, &SolverOptions::relaxation, 0,
          "is 0, must be more than 0 and less than 2"),
      bad("solver.relaxation", &Options::solver, &SolverOptions::relaxation, 2,
          "is 2, must be more than 0 and less than 2"),
      bad("solver.relaxation", &Options::solver, &SolverOptions::relaxation, kNan,
          "is nan, must be more than 0"),
      bad("solver.push_out_share", &Options::solver, &SolverOptions::push_out_share, -0.1,
          "is -0.1, must be"),
      bad("solver.push_out_share", &Options::solver, &SolverOptions::push_out_share, kNan,
          "is nan, must be"),
      {"rotation", "is quaternion, verlet supports splitting only",
       [](Scene& s) {
         s.options.integrator = Integrator::verlet;
         s.options.rotation = Rotation::quaternion;
       }},
      {"rotation", "is splitting, runge-kutta4 supports quaternion or exponential",
       [](Scene& s) {
         s.options.integrator = Integrator::runge_kutta4;
         s.options.rotation = Rotation::splitting;
       }},
      {"angular_momentum", "is set, implicit-euler integrates angular velocities",
       [](Scene& s) {
         s.options.integrator = Integrator::implicit_euler;
         s.options.angular_momentum = true;
       }},
      {"angular_momentum", "is set, rotation by splitting does not use it",
       [](Scene& s) { s.options.angular_momentum = true; }},
      bad("density", &Options::density, 0, "is 0 kg"),
      bad("density", &Options::density, -1, "is -1 kg"),
      bad("density", &Options::density, kNan, "is nan kg"),
      bad("length_unit", &Options::length_unit, 0, "is 0 m, must be > 0"),
      bad("length_unit", &Options::length_unit, kNan, "is nan m"),
      bad("contact.frequency", &Options::contact, &ContactOptions::frequency, -1,
          "is -1 Hz, must be >= 0"),
      bad("contact.frequency", &Options::contact, &ContactOptions::frequency, kInf,
          "is inf Hz, must be finite"),
      {"contact.fixed_frequency", "is -1 Hz, must be >= 0",
       [](Scene& s) { s.options.contact.fixed_frequency = -1; }},
      bad("contact.damping_ratio", &Options::contact, &ContactOptions::damping_ratio, -1,
          "must be >= 0"),
      bad("contact.damping_ratio", &Options::contact, &ContactOptions::damping_ratio, kNan,
          "is nan"),
      bad("contact.push_out_speed", &Options::contact, &ContactOptions::push_out_speed, -1,
          "is -1 m/s, must be >= 0"),
      bad("contact.push_out_speed", &Options::contact, &ContactOptions::push_out_speed, kNan,
          "is nan m/s"),
      bad("contact.slop", &Options::contact, &ContactOptions::slop, 0, "is 0 m, must be > 0"),
      bad("contact.slop", &Options::contact, &ContactOptions::slop, -1, "is -1 m, must be > 0"),
      bad("contact.slop", &Options::contact, &ContactOptions::slop, kNan, "is nan m, must be > 0"),
      {"contact.restitution_threshold", "is -1 m/s, must be >= 0",
       [](Scene& s) { s.options.contact.restitution_threshold = -1; }},
      {"contact.restitution_threshold", "is nan m/s, must be >= 0",
       [](Scene& s) { s.options.contact.restitution_threshold = kNan; }},
      {"contact.restitution_sweeps", "is 0, must be between 1 and 64",
       [](Scene& s) { s.options.contact.restitution_sweeps = 0; }},
      {"contact.restitution_sweeps", "is 65",
       [](Scene& s) { s.options.contact.restitution_sweeps = 65; }},
      {"contact.collision_passes", "is 0, must be between 1 and 64",
       [](Scene& s) { s.options.contact.collision_passes = 0; }},
      {"contact.collision_passes", "is 65",
       [](Scene& s) { s.options.contact.collision_passes = 65; }},
      {"contact.impact_sweeps", "is -1, must be between 0 and 1000",
       [](Scene& s) { s.options.contact.impact_sweeps = -1; }},
      {"contact.impact_sweeps", "is 1001",
       [](Scene& s) { s.options.contact.impact_sweeps = 1001; }},
      {"contact.impact_sweeps", "is 8, must be 0 with penalty",
       [](Scene& s) {
         s.options.solver.method = Solver::penalty, s.options.contact.impact_sweeps = 8;
       }},
      {"contact_capacity", "is 0, must be between 1 and 65536",
       [](Scene& s) { s.options.contact_capacity = 0; }},
      {"contact_capacity", "is 65537", [](Scene& s) { s.options.contact_capacity = 65537; }},
      {"gravity.x", "is nan m/s^2", [](Scene& s) { s.options.gravity.x() = kNan; }},
      {"gravity.y", "is inf m/s^2", [](Scene& s) { s.options.gravity.y() = kInf; }}};
  check_each(sphere_scene(), "options.", cases);
  check_each(circle_scene(), "options.", cases);
  check_each(circle_scene(), "options.",
             {{"gravity.z", "is -10 m/s^2, must be 0 in a planar scene",
               [](Scene& s) { s.options.gravity.z() = -10; }}});
}

TEST_CASE("the ends of the option ranges are valid", "[fast][scene]") {
  Scene scene = sphere_scene();
  Options& options = scene.options;
  options.substeps = options.contact.restitution_sweeps = 1;
  options.contact.frequency = 0, options.contact.damping_ratio = 0;
  options.contact.push_out_speed = 0, options.contact.restitution_threshold = 0;
  CHECK(validate(scene).empty());
  options.substeps = options.contact.restitution_sweeps = 64;
  CHECK(validate(scene).empty());
}

TEST_CASE("bounds must hold something and be finite", "[fast][scene]") {
  const auto set = [](const Vec3& low, const Vec3& high) {
    return [=](Scene& s) { s.options.bounds = Eigen::AlignedBox3d(low, high); };
  };
  check_each(sphere_scene(), "options.",
             {{"bounds", "are empty: min.y is 1 m, must be at most max.y, which is -1 m",
               set({-1, 1, -1}, {1, -1, 1})},
              {"bounds.min.x", "is nan m", set({kNan, -1, -1}, {1, 1, 1})},
              {"bounds.max.z", "is inf m", set({-1, -1, -1}, {1, 1, kInf})}});
  Scene scene = sphere_scene();
  scene.options.bounds.emplace();  // Eigen's empty box
  CHECK(test::places(scene) ==
        std::vector<std::string>{"options.bounds", "options.bounds", "options.bounds"});
}

TEST_CASE("a scene holds at most 32767 bodies and shapes", "[fast][scene]") {
  Scene scene;
  Body fixed;
  fixed.motion = Motion::fixed;
  scene.bodies.assign(32767, fixed);
  CHECK(validate(scene).empty());
  scene.add(fixed);
  CHECK(test::places(scene) == std::vector<std::string>{"bodies"});

  Scene many_shapes = sphere_scene();
  many_shapes.bodies[0].shapes.assign(32766, Shape{});
  CHECK(validate(many_shapes).empty());
  many_shapes.bodies[0].shapes.emplace_back();
  REQUIRE(validate(many_shapes).size() == 1);
  CHECK(to_string(validate(many_shapes)[0]) == "shapes are 32768, must be at most 32767");
}

}  // namespace manyworlds
