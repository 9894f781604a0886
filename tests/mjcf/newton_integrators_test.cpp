// Integrators and tendons of trees against MuJoCo: Runge-Kutta with contacts and limits, Euler with
// explicit dampers, limits of fixed tendons.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/mjcf/newton_comparison.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds::test {
namespace {

// A model of ours with one more option element, which counts last.
std::string scene_with(const std::string& name, const std::string& option) {
  std::stringstream text;
  const auto folder = std::filesystem::path(kSourceFolder) / "scenes" / "mjcf";
  text << std::ifstream(folder / (name + ".xml")).rdbuf();
  std::string xml = text.str();
  return xml.insert(xml.find("<worldbody"), option);
}

void check_steps(const std::string& xml) {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const compare::Pair pair = pair_of(xml);
    const auto samples = compare::draw_samples(pair, precision, 100, 1);
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      const compare::StateComparison c = compare::compare_states(pair, samples, kernels_of(table));
      INFO(name(table) << ": " << to_string(c));
      CHECK(c.rows + c.contacts > 0);
      CHECK(next(c).most() < pick(table, 3e-3, 1e-10));
      CHECK(next(c).median() < pick(table, 3e-5, 1e-12));
    }
  }
}

// A top on a ball joint and a tumbling body, without contacts and gravity for the latter.
constexpr const char* kTumblers = R"(<mujoco>
  <option integrator="RK4" timestep="TIMESTEP"/>
  <worldbody>
    <body name="top" pos="0 0 1"><joint type="ball" pos="0 0 -0.2"/>
      <geom type="capsule" size="0.05 0.1" contype="0" conaffinity="0"/>
      <geom type="box" size="0.1 0.07 0.02" contype="0" conaffinity="0"/></body>
    <body name="tumbler" pos="2 0 1"><freejoint/>
      <geom type="box" size="0.1 0.2 0.05" contype="0" conaffinity="0"/></body>
    <body name="anchor" pos="4 0 1"><joint axis="0 1 0"/>
      <geom type="capsule" size="0.05 0.1" pos="0 0 -0.2" contype="0" conaffinity="0"/></body>
  </worldbody></mujoco>)";

std::vector<double> path_of_tumblers(double dt, double time) {
  std::string xml = kTumblers;
  const std::string word = "TIMESTEP";
  xml.replace(xml.find(word), word.size(), std::to_string(dt));
  BatchOptions options;
  options.worlds = 1, options.threads = 1, options.precision = Precision::f64;
  Batch batch(compile(load_mjcf_string(xml).scene), options);
  std::vector<double> v(batch.size(Field::generalized_velocity));
  REQUIRE(v.size() == 3 + 6 + 1);
  const double spin[] = {1, 2, 8, 0.3, 0, 0.2, 4, 0.1, 5, 1};
  std::copy(std::begin(spin), std::end(spin), v.begin());
  batch.write(Field::generalized_velocity, std::span<const double>(v));
  batch.step(static_cast<int>(std::lround(time / dt)));
  return compare::read(batch, Field::generalized_position, 0);
}

}  // namespace

TEST_CASE("Runge-Kutta in joint coordinates steps as MuJoCo's", "[mjcf][robots][fast]") {
  check_steps(scene_with("robot_hopper", "<option integrator='RK4'/>"));
  check_steps(scene_with("robot_cheetah", "<option integrator='RK4'/>"));
  check_steps(scene_with("robot_ant", "<option integrator='RK4'/>"));  // has a free joint
}

TEST_CASE("Runge-Kutta in joint coordinates is of fourth order", "[mjcf][robots][fast]") {
  const auto exact = path_of_tumblers(0.0005, 0.4);
  const double coarse = compare::difference(path_of_tumblers(0.01, 0.4), exact);
  const double fine = compare::difference(path_of_tumblers(0.005, 0.4), exact);
  INFO(coarse << ", " << fine);
  CHECK(coarse < 1e-4);
  CHECK(coarse / fine > 13);
  CHECK(coarse / fine < 19);
}

// One that tumbles about no principal axis and off its centre, one with a body welded to it, and
// one with a joint, whose gyroscopic forces stay explicit.
TEST_CASE("implicitfast takes gyroscopic forces of free bodies as in MuJoCo",
          "[mjcf][robots][fast]") {
  check_steps(R"(<mujoco><option timestep="0.01" integrator="implicitfast" gravity="0 0 -1">
      <flag contact="disable"/></option>
    <worldbody>
      <body pos="0 0 1" euler="10 20 30"><freejoint/><geom type="box" size="0.1 0.2 0.05"/>
        <geom type="sphere" size="0.1" pos="0.2 0.1 -0.1"/></body>
      <body pos="1 0 1"><freejoint/><geom type="box" size="0.2 0.1 0.05"/>
        <body pos="0.2 0 0.1"><geom type="capsule" size="0.05 0.2"/></body></body>
      <body pos="3 0 1"><freejoint/><geom type="box" size="0.1 0.2 0.05"/>
        <body pos="0 0 0.2"><joint name="j" axis="0 1 0" limited="true" range="-90 90"/>
          <geom type="capsule" size="0.05 0.1"/></body></body>
    </worldbody><actuator><motor joint="j"/></actuator></mujoco>)");
}

TEST_CASE("dampers are explicit where the flag eulerdamp is off", "[mjcf][robots][fast]") {
  check_steps(scene_with("robot_cheetah", "<option><flag eulerdamp='disable'/></option>"));
}

TEST_CASE("fixed tendons stay within their limits as in MuJoCo", "[mjcf][robots][fast]") {
  check_steps(R"(<mujoco><compiler angle="radian" autolimits="true"/>
    <option timestep="0.004"><flag contact="disable"/></option>
    <default><joint damping="0.1" armature="0.01"/><geom type="capsule" size="0.03 0.1"/></default>
    <worldbody><body pos="0 0 1"><joint name="a" axis="0 1 0" pos="0 0 0.1"/><geom/>
      <body pos="0 0 -0.25"><joint name="b" axis="0 1 0" pos="0 0 0.1"/><geom/>
        <body pos="0 0 -0.25"><joint name="c" type="slide" axis="0 0 1"/><geom/></body></body>
      <body pos="0.2 0 0"><joint name="d" axis="1 0 0"/><geom/></body></body></worldbody>
    <tendon>
      <fixed name="cord" range="-0.2 0.3" solreflimit="0.03 0.9" margin="0.02">
        <joint joint="a" coef="0.7"/><joint joint="b" coef="-1.2"/><joint joint="c" coef="2"/></fixed>
      <fixed name="branches" range="-0.1 0.1"><joint joint="d" coef="1"/><joint joint="b" coef="1"/>
      </fixed><fixed name="free"><joint joint="d" coef="1"/></fixed></tendon>
    <actuator><motor joint="a" gear="5"/><motor joint="d" gear="5"/></actuator></mujoco>)");
}

}  // namespace manyworlds::test
