// What of models with joints is refused, by name, and what is said of it.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "manyworlds/mjcf.hpp"

namespace manyworlds::test {
namespace {

// A hinge on the world in a file with `before` and `after` beside its worldbody.
std::string around(const std::string& before, const std::string& after = "",
                   const std::string& joint = "", const std::string& geom = "",
                   const std::string& inside = "") {
  return "<mujoco>" + before +
         "<worldbody><site name='t' pos='0 0 2'/><geom name='floor' type='plane' size='1 1 1'/>"
         "<body name='b' pos='0 0 1'><joint name='j' " +
         joint + "/><geom name='g' size='.1' pos='.2 0 0' " + geom + "/><site name='p'/>" + inside +
         "</body><body name='c' pos='3 0 1'><freejoint name='r'/><geom size='.1'/></body>"
         "</worldbody>" +
         after + "</mujoco>";
}
std::string jointed(const std::string& joint) { return around("", "", joint); }
std::string inside(const std::string& text) { return around("", "", "", "", text); }
std::string actuated(const std::string& actuator) {
  return around("", "<actuator>" + actuator + "</actuator>");
}
std::string option(const std::string& text) { return around("<option " + text + "/>"); }
std::string flag(const std::string& text) {
  return around("<option><flag " + text + "/></option>",
                "<actuator><motor name='m' joint='j'/></actuator>", "damping='1'");
}

std::vector<std::string> problems_in(const std::string& xml) {
  try {
    load_mjcf_string(xml);
  } catch (const MjcfError& error) {
    return error.problems();
  }
  return {};
}

struct Refused {
  std::string xml;
  const char* problem;
};

void check_refused(const std::vector<Refused>& table) {
  for (const Refused& refused : table) {
    INFO(refused.xml);
    CHECK(problems_in(refused.xml) ==
          std::vector<std::string>{std::string("MJCF string: ") + refused.problem});
  }
}

}  // namespace

TEST_CASE("what a joint has and is not simulated is refused", "[mjcf][robots][fast]") {
  check_refused({
      {jointed("type='ball' stiffness='1 2 0'"),
       "joint 'j' of body 'b', line 1: polynomial stiffness is not simulated "
       "yet; expected one number"},
      {jointed("stiffness='1 2 0'"),
       "joint 'j' of body 'b', line 1: polynomial stiffness is not simulated "
       "yet; expected one number"},
      {jointed("stiffness='1' springyield='0.1'"),
       "joint 'j' of body 'b', line 1: springyield is not simulated yet; expected 0"},
      {jointed("damping='1 2 0'"),
       "joint 'j' of body 'b', line 1: polynomial damping is not simulated yet; "
       "expected one number"},
      {jointed("frictionloss='0.1'"),
       "joint 'j' of body 'b', line 1: frictionloss is not simulated yet; expected 0"},
      {around("", "<actuator><motor joint='j'/></actuator>", "actuatorfrcrange='-1 1'"),
       "joint 'j' of body 'b', line 1: actuatorfrcrange is not simulated yet; expected none"},
      {inside("<body name='d'><geom size='.1' mass='0'/></body>"),
       "body 'd', line 1: has geoms that collide but no mass, which is not simulated yet; expected "
       "a mass"},
      {inside("<body name='d'><joint axis='1 0 0'/><body><geom size='.1'/></body></body>"),
       "body 'd', line 1: has joints but no mass, which is not simulated yet; expected a mass"},
  });
  // What acts on nothing is no problem.
  CHECK(problems_in(
            around("<option><flag frictionloss='disable'/></option>", "", "frictionloss='0.1'"))
            .empty());
  CHECK(problems_in(jointed("actuatorfrcrange='-1 1'")).empty());
  CHECK(problems_in(inside("<body><geom size='.1' mass='0' contype='0' conaffinity='0'/></body>"))
            .empty());
}

TEST_CASE("an actuator that is more than a force on a hinge or slide is refused",
          "[mjcf][robots][fast]") {
  check_refused({
      {actuated("<motor name='m' joint='r'/>"),
       "actuator 'm', line 1: acts on a free joint, which is not simulated yet; expected a hinge "
       "or a slide joint"},
      {actuated("<motor name='m' site='p'/>"),
       "actuator 'm', line 1: acts on a site, which is not simulated yet; expected a hinge or a "
       "slide joint"},
      {actuated("<adhesion name='m' body='b' ctrlrange='0 1'/>"),
       "actuator 'm', line 1: acts on a body, which is not simulated yet; expected a hinge or a "
       "slide joint"},
      {actuated("<intvelocity name='m' joint='j' actrange='-1 1'/>"),
       "actuator 'm', line 1: has an activation, of dyntype integrator, which is not simulated "
       "yet; expected dyntype none"},
      {actuated("<position name='m' joint='j' timeconst='0.1'/>"),
       "actuator 'm', line 1: has an activation, of dyntype filterexact, which is not simulated "
       "yet; expected dyntype none"},
      {actuated("<cylinder name='m' joint='j'/>"),
       "actuator 'm', line 1: has an activation, of dyntype filter, which is not simulated yet; "
       "expected dyntype none"},
      {actuated("<muscle name='m' joint='j' lengthrange='0 1'/>"),
       "actuator 'm', line 1: has an activation, of dyntype muscle, which is not simulated yet; "
       "expected dyntype none"},
      {actuated("<general name='m' joint='j' gaintype='muscle' lengthrange='0 1' gainprm='0.75 "
                "1.05 1 200 0.5 1.6 "
                "1.5 1.3 1.2'/>"),
       "actuator 'm', line 1: has gaintype muscle, which is not simulated yet; expected fixed or "
       "affine"},
      {actuated("<general name='m' joint='j' biastype='muscle' lengthrange='0 1' biasprm='0.75 "
                "1.05 1 200 0.5 1.6 "
                "1.5 1.3 1.2'/>"),
       "actuator 'm', line 1: has biastype muscle, which is not simulated yet; expected none or "
       "affine"},
      {actuated("<motor name='m' joint='j' damping='1'/>"),
       "actuator 'm', line 1: damping of an actuator is not simulated yet; expected 0"},
      {actuated("<motor name='m' joint='j' armature='1'/>"),
       "actuator 'm', line 1: armature of an actuator is not simulated yet; expected 0"},
      {actuated("<motor name='m' joint='j' delay='0.01' nsample='9'/>"),
       "actuator 'm', line 1: delay is not simulated yet; expected 0"},
      {around("<option actuatorgroupdisable='3'/>",
              "<actuator><motor name='m' joint='j' group='3'/><motor joint='j'/></actuator>"),
       "actuator 'm', line 1: its disabled group (actuatorgroupdisable) is not simulated yet; "
       "expected all groups enabled"},
  });
}

TEST_CASE("options that change how trees move are refused", "[mjcf][robots][fast]") {
  const std::string joints = " is not simulated with joints yet; expected ";
  CHECK(problems_in(option("integrator='implicit'")) ==
        std::vector<std::string>{"MJCF string: option: integrator implicit" + joints +
                                 "Euler, implicitfast or RK4"});
  for (const std::string name : {"override", "sleep", "diagexact"}) {
    CHECK(problems_in(flag(name + "='enable'")) ==
          std::vector<std::string>{"MJCF string: option: flag " + name + "='enable'" + joints +
                                   "disable"});
  }
  check_refused({
      {option("noslip_iterations='3'"),
       "option: noslip_iterations is not simulated with joints yet; expected 0"},
      {flag("actuation='disable'"),
       "option: flag actuation='disable' is not simulated with joints yet; expected enable"},
      {option("density='1.2' integrator='implicitfast'"),
       "option: integrator implicitfast in a medium is not simulated with joints yet; expected "
       "Euler or RK4, or density and viscosity 0"},
      {around("<option viscosity='2'/>", "", "", "fluidshape='ellipsoid'"),
       "geom 'g' of body 'b', line 1: fluidshape ellipsoid is not simulated yet; expected none"},
      {flag("speculative='enable'"),
       "option: flag speculative='enable' is not simulated with joints yet; expected disable"},
  });
  // Without friction, damping and actuators they change nothing.
  CHECK(problems_in(around("<default><geom condim='1'/></default><option cone='elliptic'>"
                           "<flag eulerdamp='disable' actuation='disable'/></option>"))
            .empty());
}

TEST_CASE("contacts and constraints that trees do not have yet are refused",
          "[mjcf][robots][fast]") {
  for (const char* condim : {"4", "6"}) {
    CHECK(problems_in(around("", "", "", "condim='" + std::string(condim) + "'")) ==
          std::vector<std::string>{"MJCF string: geom 'g' of body 'b', line 1: condim " +
                                   std::string(condim) +
                                   " is not simulated with joints yet; expected 1 or 3"});
  }
  CHECK(problems_in(around("", "", "", "condim='6' contype='0' conaffinity='0'")).empty());
  check_refused({
      {around("", "<equality><connect name='e' body1='b' body2='c' anchor='0 0 0'/></equality>"),
       "equality 'e', line 1: is a connect, which is not simulated with joints yet; expected none"},
      {around("", "<equality><weld name='e' body1='b'/></equality>"),
       "equality 'e', line 1: is a weld, which is not simulated with joints yet; expected none"},
      {around("", "<equality><joint name='e' joint1='j'/></equality>"),
       "equality 'e', line 1: is a joint equality, which is not simulated with joints yet; "
       "expected none"},
      {around("",
              "<tendon><fixed name='e' stiffness='1'><joint joint='j' coef='1'/></fixed></tendon>"),
       "tendon 'e': has stiffness, damping, friction loss or armature, which are not simulated yet "
       "for tendons; expected none of them"},
      {around("",
              "<tendon><fixed name='e'><joint joint='j' coef='1'/></fixed></tendon>"
              "<actuator><motor name='m' tendon='e'/></actuator>"),
       "actuator 'm', line 1: acts on a tendon, which is not simulated yet; expected a hinge or a "
       "slide joint"},
      {around("", "<contact><pair name='e' geom1='g' geom2='floor'/></contact>"),
       "pair 'e': contact pairs are not simulated yet; expected none"},
  });
  CHECK(problems_in(around("<option><flag equality='disable'/></option>",
                           "<equality><joint name='e' joint1='j'/></equality>"))
            .empty());
  const MjcfResult inactive =
      load_mjcf_string(around("",
                              "<equality><joint name='e' joint1='j' active='false'/></equality>"
                              "<keyframe><key name='k'/><key name='l' time='1'/></keyframe>"));
  REQUIRE(inactive.warnings.size() == 2);
  CHECK(inactive.warnings[0] ==
        "equality 'e', line 1: is inactive and left out; joints cannot be activated later");
  CHECK(inactive.warnings[1] == "key 'l': time is ignored; worlds have no separate clocks");
}

TEST_CASE("all problems of a model with joints come at once", "[mjcf][robots][fast]") {
  const std::vector<std::string> problems = problems_in(
      around("<option integrator='implicit' noslip_iterations='1'/>",
             "<actuator><motor site='p'/><muscle joint='j' lengthrange='0 1'/></actuator>",
             "frictionloss='1'", "condim='4'"));
  CHECK(problems.size() == 6);
}

}  // namespace manyworlds::test
