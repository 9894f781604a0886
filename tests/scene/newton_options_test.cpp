// What validate() says about options of Solver::newton, and about what only it takes.
#include <catch2/catch.hpp>

#include <limits>

#include "manyworlds/plan.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/scene_cases.hpp"

namespace manyworlds::test {

TEST_CASE("options of the newton solver have ranges", "[fast][validate][newton]") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Scene robot = newton_pendulum();
  const auto solver = [](Scene& s) -> SolverOptions& { return s.options.solver; };
  check_each(
      robot, "options.solver.",
      {{"tolerance", "is -1, must be >= 0", [&](Scene& s) { solver(s).tolerance = -1; }},
       {"line_search_iterations", "is 0, must be between 1 and",
        [&](Scene& s) { solver(s).line_search_iterations = 0; }},
       {"line_search_tolerance", "is nan",
        [&](Scene& s) { solver(s).line_search_tolerance = kNan; }},
       {"impedance_ratio", "is 0, must be > 0", [&](Scene& s) { solver(s).impedance_ratio = 0; }}});
  check_each(
      robot, "options.medium",
      {{".density", "is -1 kg/m^3, must be >= 0", [](Scene& s) { s.options.medium.density = -1; }},
       {".viscosity", "is nan Pa s", [](Scene& s) { s.options.medium.viscosity = kNan; }},
       {"", "is given, the newton solver supports none with implicit-fast yet", [](Scene& s) {
          s.options.medium.density = 1, s.options.integrator = Integrator::implicit_fast;
        }}});
  check_each(robot, "options.contact.",
             {{"collision_passes",
               "is 2, the newton solver supports 1 only: it finds contacts in every substep",
               [](Scene& s) { s.options.contact.collision_passes = 2; }},
              {"impact_sweeps", "is 8, must be 0 with newton",
               [](Scene& s) { s.options.contact.impact_sweeps = 8; }}});
  Scene other = empty_scene(Space::spatial);
  other.add(body_of(shape_of(Sphere{1}), Vec3::Zero()));
  check_each(other, "options.",
             {{"medium", "is given, which requires the newton solver, not tgs-soft",
               [](Scene& s) { s.options.medium.viscosity = 1; }},
              {"integrator", "is implicit-fast, which requires the newton solver, not tgs-soft",
               [](Scene& s) { s.options.integrator = Integrator::implicit_fast; }}});
  const auto box = [](Scene& s) -> MassProperties& {
    s.bodies[0].mass_properties = {1, Vec3::Zero(), Vec3(1, 2, 2.5).asDiagonal()};
    return *s.bodies[0].mass_properties;
  };
  check_each(
      other, "body 0: mass_properties.axes",
      {{"", "are not principal axes of inertia",
        [&](Scene& s) { box(s).axes = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitZ())); }},
       {"", "is a quaternion of length 0", [&](Scene& s) { box(s).axes = Quat(0, 0, 0, 0); }}});
  Scene rotated = other;
  box(rotated).axes = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  CHECK(validate(rotated).empty());
}

}  // namespace manyworlds::test
