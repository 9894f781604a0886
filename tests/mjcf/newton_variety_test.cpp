// What models can ask for, one thing at a time, in Solver::newton against MuJoCo: kinds of
// contacts, of softness and of actuators.
#include <catch2/catch.hpp>

#include "tests/mjcf/newton_comparison.hpp"

namespace manyworlds::test {
namespace {

// Attributes of every geom, of the ground, of the first walker's geoms, of joints, and options.
struct Variant {
  const char* name;
  std::string option = {}, geom = {}, ground = {}, first = {}, joint = {};
  // By how much larger errors may be. The edges of a pyramid differ by 2 mu, and pushing along all
  // of them is 1 / mu^2 times as stiff as along one: what rounding costs grows with 1 / mu^2.
  double weak = 1;
  std::string actuators = R"(<motor joint="knee_a" gear="4"/><motor joint="hip_b" gear="-3"/>)";
};

std::string walker(const std::string& name, double x, const std::string& geom) {
  const auto named = [&](const char* part) { return " name=\"" + (part + ("_" + name)) + "\" "; };
  return "<body pos=\"" + std::to_string(x) +
         R"( 0 0.42" euler="0.1 0.2 0.3" childclass="own"><freejoint/>
    <geom size="0.07 0.12" euler="0 1.57 0.1" )" +
         geom + R"(/>
    <body pos="0.14 0 -0.02"><joint)" +
         named("hip") + R"(axis="0.2 1 0" range="-1.5 1.2"/>
      <geom size="0.04 0.1" pos="0.02 0 -0.12" )" +
         geom + R"(/>
      <body pos="0.03 0 -0.25"><joint)" +
         named("knee") + R"(axis="0 1 0.1" range="-2 2.5"/>
        <geom size="0.035 0.1" pos="0 0 -0.1" )" +
         geom + R"(/>
        <geom type="sphere" size="0.05" pos="0.05 0 -0.2" )" +
         geom + R"(/></body></body>
    <body pos="-0.15 0.05 0"><joint type="ball" damping="0.1" stiffness="0"/>
      <geom size="0.04 0.12" pos="-0.05 0 -0.14" )" +
         geom + R"(/>
      <body pos="-0.08 0 -0.28"><joint type="ball" range="0 0.5"/>
        <geom size="0.03 0.06" pos="0 0 -0.08" )" +
         geom + R"(/></body></body></body>)";
}

// Impedances of two geoms with unlike powers are mixed to powers that are not whole, which are not
// simulated yet: all here have power 2 where they are mixed.
//
// Two walkers that fall onto one another, a pole that swings into them, balls and capsules that
// are free: every kind of contact between trees, within one, and with what is static.
std::string arena(const Variant& v) {
  const std::string own = "<default class=\"own\"><geom " + v.geom + "/><joint " + v.joint + "/>";
  return R"(<mujoco><compiler angle="radian" autolimits="true"/>
    <option timestep="0.004"/><option )" +
         v.option + R"(/>
    <default><geom type="capsule" density="700" friction="0.7"/>
      <joint armature="0.005" damping="0.2"/>)" +
         own + R"(</default></default>
    <worldbody><geom class="own" type="plane" size="5 5 1" )" +
         v.ground + R"(/>
      <geom class="own" type="sphere" size="0.15" pos="0.1 0.25 0.05"/>)" +
         walker("a", 0, v.first) + walker("b", 0.32, "") + R"(
      <body pos="0.5 0 0.9" childclass="own"><joint name="pole" axis="0 1 0"/>
        <geom size="0.04" fromto="0 0 0 -0.35 0 -0.35"/></body>
      <body pos="-0.1 0.05 0.62" childclass="own"><freejoint/>
        <geom type="sphere" size="0.06"/></body>
      <body pos="0.3 0 0.66" euler="1 0.3 0" childclass="own"><freejoint/>
        <geom size="0.05 0.1"/></body>
    </worldbody><actuator>)" +
         v.actuators + "</actuator></mujoco>";
}

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {.name = "as it is"},
      {.name = "frictionless", .geom = R"(condim="1")"},
      {.name = "frictionless but for the ground",
       .geom = R"(condim="1")",
       .ground = R"(condim="3")"},
      {.name = "priority of the first",
       .geom = R"(condim="1")",
       .first = R"(priority="2" condim="3" friction="0.3" solref="0.05 0.7")"},
      {.name = "priority of the ground", .ground = R"(priority="1" friction="1.2" condim="3")"},
      {.name = "margin", .geom = R"(margin="0.02")"},
      {.name = "margin and gap", .geom = R"(margin="0.01" gap="0.02")"},
      {.name = "gap of the ground", .ground = R"(margin="0.02" gap="0.01")"},
      {.name = "solmix",
       .geom = R"(solref="0.03 0.8")",
       .first = R"(solmix="4" solref="0.01 1.2" solimp="0.5 0.99 0.01 0.3 2")"},
      {.name = "solmix of nobody", .geom = R"(solmix="0")", .first = R"(solref="0.05 1")"},
      {.name = "solmix of one",
       .geom = R"(solmix="0")",
       .first = R"(solmix="1" solref="0.05 1" solimp="0.7 0.8 0.02 0.6 2")"},
      {.name = "stiffness and damping given", .geom = R"(solref="-2000 -60")"},
      {.name = "stiffness and damping of one", .first = R"(solref="-1500 -80")"},
      {.name = "hard", .geom = R"(solref="0.001 1" solimp="0.99 0.999 0.001")"},
      {.name = "soft", .geom = R"(solref="0.1 0.3" solimp="0 0.5 0.05 0.5 1")"},
      {.name = "constant impedance", .geom = R"(solimp="0.9 0.9 0")"},
      {.name = "impratio", .option = R"(impratio="8")"},
      {.name = "small impratio", .option = R"(impratio="0.4")"},
      {.name = "slippery", .geom = R"(friction="0.1")"},
      {.name = "very slippery", .geom = R"(friction="0.01")", .weak = 100},
      {.name = "rough", .geom = R"(friction="3")"},
      {.name = "elliptic cones", .option = R"(cone="elliptic")"},
      {.name = "elliptic cones with an impratio",
       .option = R"(cone="elliptic" impratio="10")",
       .geom = R"(friction="1.2")"},
      {.name = "elliptic cones, slippery",
       .option = R"(cone="elliptic" impratio="0.5")",
       .geom = R"(friction="0.05")"},
      {.name = "elliptic cones, some frictionless",
       .option = R"(cone="elliptic")",
       .geom = R"(condim="1")",
       .first = R"(priority="2" condim="3" friction="0.3" solref="-2000 -60")"},
      {.name = "in water", .option = R"(density="1000" viscosity="0.001" wind="0.5 -1 0.2")"},
      {.name = "in honey", .option = R"(viscosity="10")"},
      {.name = "implicitfast", .option = R"(integrator="implicitfast")"},
      {.name = "implicitfast with servos",
       .option = R"(integrator="implicitfast" cone="elliptic")",
       .actuators = R"(<position joint="knee_a" kp="20" kv="3" gear="2"/>
                       <velocity joint="hip_b" kv="0.6"/><damper joint="hip_a" kv="0.3"
                       ctrlrange="0 1"/><position joint="pole" kp="15" kv="8" forcerange="-1 1"/>
                       <general joint="knee_b" gaintype="affine" gainprm="2 0.5 -0.2"
                       biastype="affine" biasprm="0.3 -4 -0.1" gear="1.5"/>)"},
      {.name = "short steps", .option = R"(timestep="0.0007")"},
      {.name = "long steps", .option = R"(timestep="0.012")"},
      {.name = "oblique gravity", .option = R"(gravity="3 -2 -6")"},
      {.name = "no gravity", .option = R"(gravity="0 0 0")"},
      {.name = "soft limits", .joint = R"(solreflimit="0.1 0.4" solimplimit="0.3 0.7 0.2 0.5 2")"},
      {.name = "limits with margin", .joint = R"(margin="0.3" solreflimit="-300 -10")"},
      {.name = "springs", .joint = R"(stiffness="6" springref="0.3" ref="0.1")"},
      {.name = "no dampers", .joint = R"(damping="0" armature="0")"},
      {.name = "control ranges",
       .actuators = R"(<motor joint="knee_a" gear="9" ctrlrange="-0.2 0.3"/>
                       <motor joint="hip_a" gear="5" ctrlrange="0.1 0.4"/>)"},
      {.name = "force ranges",
       .actuators = R"(<motor joint="knee_a" gear="2" forcerange="-0.4 0.5"/>
                       <position joint="hip_b" kp="30" kv="2" forcerange="-1 2"/>)"},
      {.name = "servos",
       .actuators = R"(<position joint="knee_a" kp="20" gear="2"/><velocity joint="hip_b" kv="0.6"/>
                       <position joint="pole" kp="15" kv="0.5"/><damper joint="hip_a" kv="0.3"
                       ctrlrange="0 1"/>)"},
      {.name = "affine gain and bias",
       .actuators = R"(<general joint="knee_a" gaintype="affine" gainprm="2 0.5 -0.2"
                       biastype="affine" biasprm="0.3 -4 -0.1" gear="1.5"/>
                       <general joint="knee_a" gaintype="affine" gainprm="1 0 0.3"/>
                       <general joint="pole" biastype="affine" biasprm="1 0 -0.2" gear="-2"/>)"},
  };
  return all;
}

}  // namespace

TEST_CASE("what models ask for is MuJoCo's, one thing at a time", "[mjcf][robots]") {
  for (const Variant& v : variants()) {
    const std::string xml = arena(v);
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      const compare::Pair pair = pair_of(xml);
      const auto samples = compare::draw_samples(pair, precision, 60, 1, 200);
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        const compare::StateComparison c =
            compare::compare_states(pair, samples, kernels_of(table));
        INFO(v.name << ", " << name(table) << ": " << to_string(c));
        CHECK(2 * c.contacts > c.states);
        CHECK(c.other_contacts <= c.states / 50);
        CHECK(c.uncertain <= c.states / 20);
        CHECK(acceleration(c).most() < v.weak * pick(table, 3e-3, 1e-10));
        CHECK(next(c).most() < v.weak * pick(table, 3e-3, 1e-10));
        CHECK(acceleration(c).median() < v.weak * pick(table, 3e-5, 1e-12));
        CHECK(next(c).median() < v.weak * pick(table, 3e-5, 1e-12));
      }
    }
  }
}

TEST_CASE("powers of impedance that mix to no whole number are an error", "[mjcf][robots]") {
  const std::string xml = arena({.name = "", .first = R"(solimp="0.9 0.95 0.001 0.5 3")"});
  CHECK_THROWS_WITH(compile(load_mjcf_string(xml).scene),
                    Catch::Contains("power") && Catch::Contains("2.5"));
  CHECK_NOTHROW(
      compile(load_mjcf_string(
                  arena({.name = "", .first = R"(solimp="0.9 0.95 0.001 0.5 3" priority="1")"}))
                  .scene));
}

TEST_CASE("flags that switch things off do so as in MuJoCo", "[mjcf][robots]") {
  // Without springs and dampers MuJoCo computes no passive force at all, drag included.
  for (const std::string flag :
       {"constraint", "limit", "contact", "spring", "damper", "gravity", "clampctrl",
        "filterparent", "warmstart", "spring=\"disable\" damper"}) {
    std::string xml = arena({.name = "",
                             .option = R"(density="300" viscosity="0.2")",
                             .joint = R"(stiffness="2")",
                             .actuators = R"(<motor joint="knee_a" ctrlrange="-0.5 0.5"/>)"});
    xml.insert(xml.find("<default>"), "<option><flag " + flag + "=\"disable\"/></option>");
    const compare::Pair pair = pair_of(xml);
    const auto samples = compare::draw_samples(pair, Precision::f64, 40, 1, 150);
    for (const Table& table : all_tables()) {
      if (table.precision != Precision::f64) continue;
      const compare::StateComparison c = compare::compare_states(pair, samples, kernels_of(table));
      INFO(flag << ", " << name(table) << ": " << to_string(c));
      CHECK(c.other_contacts == 0);
      CHECK(acceleration(c).most() < 1e-10);
      CHECK(next(c).most() < 1e-10);
    }
  }
}

}  // namespace manyworlds::test
