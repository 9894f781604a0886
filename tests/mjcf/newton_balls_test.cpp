// Limits and springs of ball joints in Solver::newton against MuJoCo.
#include <catch2/catch.hpp>

#include "tests/mjcf/newton_comparison.hpp"

namespace manyworlds::test {
namespace {

// A chain of balls on the world, one behind a slide in a series, and one on a free root. Of each
// model, attributes of balls, options and flags.
std::string balls(const std::string& ball, const std::string& option = "") {
  return R"(<mujoco><compiler angle="radian" autolimits="true"/><option timestep="0.004" )" +
         option + R"(/>
    <default><joint damping="0.05" armature="0.01"/><geom type="capsule" size="0.04 0.12"/>
      <default class="ball"><joint type="ball" )" +
         ball + R"(/></default></default>
    <worldbody><geom type="plane" size="5 5 1"/>
      <body pos="0 0 0.9" euler="0.3 1.4 0.2"><joint class="ball" pos="0 0 0.15"/><geom/>
        <body pos="0 0 -0.3"><joint class="ball" pos="0 0.02 0.15"/>
          <geom type="box" size="0.05 0.08 0.12"/>
          <body pos="0 0 -0.3"><joint class="ball" pos="0.01 0 0.15"/><geom/>
            <body pos="0.05 0 -0.2"><joint name="turn" axis="0 1 0.3" range="-0.5 0.5"/><geom/>
            </body></body></body></body>
      <body pos="1.5 0 0.6"><joint name="rail" type="slide" axis="1 0.2 0" range="-0.4 0.4"/>
        <joint class="ball" pos="0 0 0.2"/><geom pos="0.1 0 -0.1" euler="0 1 0.3"/></body>
      <body pos="3 0 0.7"><freejoint/><geom type="sphere" size="0.1"/>
        <body pos="0.25 0 0"><joint class="ball" pos="-0.1 0 0"/><geom euler="0 1.57 0"/></body>
        <body pos="-0.25 0 0"><joint class="ball" pos="0.1 0 0"/><geom euler="0 1.57 0"/></body>
      </body>
    </worldbody>
    <actuator><motor joint="rail" gear="20"/><motor joint="turn" gear="2"/></actuator></mujoco>)";
}
std::string smooth(std::string xml) {
  return xml.insert(xml.find("<default>"), "<option><flag contact=\"disable\"/></option>");
}

void check_balls(const std::string& xml, bool constrained = true) {
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const compare::Pair pair = pair_of(xml);
    const auto samples = compare::draw_samples(pair, precision, 80, 1, 200);
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      const compare::StateComparison c = compare::compare_states(pair, samples, kernels_of(table));
      INFO(name(table) << ": " << to_string(c));
      CHECK(next(c).most() < pick(table, 3e-3, 1e-10));
      CHECK(next(c).median() < pick(table, 3e-5, 1e-12));
      if (!constrained) continue;
      CHECK(c.rows > c.states);
      CHECK(acceleration(c).differences.size() > static_cast<std::size_t>(c.states) / 2);
      CHECK(acceleration(c).most() < pick(table, 3e-3, 1e-10));
      CHECK(acceleration(c).median() < pick(table, 3e-5, 1e-12));
    }
  }
}

}  // namespace

TEST_CASE("limits of ball joints are MuJoCo's", "[mjcf][robots][fast]") {
  check_balls(smooth(balls(R"(range="0 0.4")")));
  check_balls(smooth(balls(R"(range="0 0.5" margin="0.2" solreflimit="-400 -15"
                              solimplimit="0.3 0.8 0.3 0.4 3")")));
  // A weak one from far on, up to half a turn: the axis is that of the shorter way.
  check_balls(smooth(balls(R"(range="0 2.8" margin="2.2" solreflimit="-30 -1" damping="0")")));
  // One that is always beyond its limit, and begins where there is no axis.
  check_balls(smooth(balls(R"(range="0 0.001" margin="0.01" solreflimit="0.1 1")")));
}

TEST_CASE("limits of ball joints act beside contacts as in MuJoCo", "[mjcf][robots][fast]") {
  check_balls(balls(R"(range="0 0.6")"));
  check_balls(balls(R"(range="0 0.6")", R"(cone="elliptic" impratio="4")"));
}

TEST_CASE("springs of ball joints are MuJoCo's", "[mjcf][robots][fast]") {
  check_balls(smooth(balls(R"(stiffness="3")")), false);
  // Neither reference means anything to a ball.
  check_balls(smooth(balls(R"(stiffness="8" ref="0.4" springref="0.3")")), false);
  check_balls(balls(R"(stiffness="3" range="0 0.5")"));
}

TEST_CASE("a slide that comes after a ball on one body is MuJoCo's", "[mjcf][robots][fast]") {
  const compare::Pair pair = pair_of(R"(<mujoco><option timestep="0.004"/><worldbody>
    <body pos="0 0 1"><joint type="ball" damping="0.1" pos="0.1 0 0"/>
      <joint name="rod" type="slide" axis="1 0.2 0" stiffness="100" damping="1"/>
      <geom type="box" size="0.1 0.2 0.05" pos="0.05 0.02 0"/></body></worldbody>
    <actuator><motor joint="rod" gear="20" ctrlrange="-1 1"/></actuator></mujoco>)");
  const auto samples = compare::draw_samples(pair, Precision::f64, 40, 1, 100);
  for (const Table& table : all_tables()) {
    if (table.precision != Precision::f64) continue;
    const compare::StateComparison c = compare::compare_states(pair, samples, kernels_of(table));
    INFO(name(table) << ": " << to_string(c));
    CHECK(c.at("link velocity").most() < 1e-10);
    CHECK(next(c).most() < 1e-10);
  }
}

TEST_CASE("integrators take limits and springs of ball joints as MuJoCo's",
          "[mjcf][robots][fast]") {
  check_balls(balls(R"(range="0 0.5" stiffness="3")", R"(integrator="implicitfast")"));
  const compare::Pair pair =
      pair_of(smooth(balls(R"(range="0 0.5" stiffness="3")", R"(integrator="RK4")")));
  const auto samples = compare::draw_samples(pair, Precision::f64, 80, 1, 200);
  for (const Table& table : all_tables()) {
    if (table.precision != Precision::f64) continue;
    const compare::StateComparison c = compare::compare_states(pair, samples, kernels_of(table));
    INFO(name(table) << ": " << to_string(c));
    CHECK(c.rows > c.states);
    CHECK(next(c).most() < 1e-10);
  }
}

TEST_CASE("flags switch limits and springs of ball joints off as in MuJoCo",
          "[mjcf][robots][fast]") {
  for (const std::string flag : {"limit", "spring"}) {
    std::string xml = balls(R"(range="0 0.4" stiffness="5")");
    xml.insert(xml.find("<default>"),
               "<option><flag contact=\"disable\" " + flag + "=\"disable\"/></option>");
    check_balls(xml, false);
  }
}

}  // namespace manyworlds::test
