// Options and flags of models with joints.
#include <string>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include "manyworlds/mjcf.hpp"
#include "tests/mjcf/mujoco_reference.hpp"

namespace manyworlds::test {
namespace {

std::string model_with_option(const std::string& option) {
  return "<mujoco>" + option +
         "<worldbody><geom type='plane' size='1 1 1'/><body name='a' pos='0 0 1' gravcomp='0.5'>"
         "<joint name='h' type='hinge' axis='0 1 0' stiffness='2' damping='3' limited='true' "
         "range='10 20'/><geom size='.1' pos='.2 0 0'/><body name='b' pos='.5 0 0'>"
         "<joint name='s' type='slide' axis='1 0 0'/><geom size='.1'/></body></body></worldbody>"
         "<actuator><motor name='m' joint='h'/></actuator></mujoco>";
}
MjcfResult load(const std::string& option) { return load_mjcf_string(model_with_option(option)); }
MjcfResult with_flag(const std::string& flag) {
  return load("<option><flag " + flag + "='disable'/></option>");
}
const Joint& hinge(const Scene& scene) { return scene.at(scene.joint("h")); }

}  // namespace

TEST_CASE("the solver of trees is set as MuJoCo's", "[mjcf][robots][fast]") {
  const MjcfResult result = load(
      "<option timestep='0.003' iterations='7' tolerance='1e-5' ls_iterations='9' "
      "ls_tolerance='0.02' impratio='3' gravity='1 2 3'/>");
  CHECK(result.warnings.empty());
  const Options& options = result.scene.options;
  CHECK(options.dt == 0.003);
  CHECK(options.substeps == 1);
  CHECK(options.gravity == Eigen::Vector3d(1, 2, 3));
  CHECK(*options.length_unit == Approx(0.2));
  const SolverOptions& solver = options.solver;
  CHECK(solver.method == Solver::newton);
  CHECK(solver.iterations == 7);
  CHECK(solver.tolerance == 1e-5);
  CHECK(solver.line_search_iterations == 9);
  CHECK(solver.line_search_tolerance == 0.02);
  CHECK(solver.impedance_ratio == 3);
}

TEST_CASE("another solver than Newton's is a warning, and its iterations are not taken",
          "[mjcf][robots][fast]") {
  for (const std::string name : {"PGS", "CG"}) {
    const MjcfResult result = load("<option solver='" + name + "' iterations='3'/>");
    CHECK(result.warnings ==
          std::vector<std::string>{
              "option: solver " + name +
              " and its iterations are ignored; Newton's method finds the same minimum"});
    CHECK_FALSE(result.scene.options.solver.iterations);
  }
}

TEST_CASE("flags switch off what they do in MuJoCo", "[mjcf][robots][fast]") {
  const Scene plain = load("").scene;
  CHECK(std::get<HingeJoint>(hinge(plain).type).limit);
  CHECK(hinge(plain).dynamics.stiffness == 2);
  CHECK(hinge(plain).dynamics.damping == 3);
  CHECK(plain.bodies.at(1).shapes.at(0).filter.mask != 0);

  for (const std::string flag : {"limit", "constraint"}) {
    CHECK_FALSE(std::get<HingeJoint>(hinge(with_flag(flag).scene).type).limit);
  }
  for (const std::string flag : {"contact", "constraint"}) {
    for (const Body& body : with_flag(flag).scene.bodies) {
      CHECK(body.shapes.at(0).filter.mask == 0);
      CHECK(body.shapes.at(0).filter.category == 0);
    }
  }
  CHECK(hinge(with_flag("spring").scene).dynamics.stiffness == 0);
  CHECK(hinge(with_flag("damper").scene).dynamics.damping == 0);
  CHECK(with_flag("gravity").scene.options.gravity == Eigen::Vector3d::Zero());
  for (const std::string flag : {"warmstart", "midphase", "island", "nativeccd", "multiccd",
                                 "autoreset", "sensor", "equality", "frictionloss"}) {
    INFO(flag);
    CHECK_NOTHROW(with_flag(flag));
  }
}

TEST_CASE("without springs and dampers MuJoCo compensates no gravity", "[mjcf][robots][fast]") {
  for (const bool compensated : {true, false}) {
    const std::string flags = std::string("<option><flag spring='disable' ") +
                              (compensated ? "" : "damper='disable'") + "/></option>";
    const Scene scene = load(flags).scene;
    CHECK(scene.at(scene.body("a")).gravity_scale == (compensated ? 0.5 : 1));
    const Reference reference(model_with_option(flags));
    CHECK((reference.data->qfrc_passive[0] != 0) == compensated);
  }
}

TEST_CASE("quick constraints alone need the flag refsafe", "[mjcf][robots][fast]") {
  const std::string off = "<flag refsafe='disable'/></option>";
  CHECK_NOTHROW(load("<option timestep='0.002'>" + off));
  CHECK_THROWS_WITH(load("<option timestep='0.02'>" + off),
                    "MJCF string: option: flag refsafe='disable' is not simulated with joints yet; "
                    "expected enable");
}

}  // namespace manyworlds::test
