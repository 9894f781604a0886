// What MJCF that we cannot simulate, or cannot read, gets.
#include "manyworlds/mjcf.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include <catch2/catch.hpp>

#include "src/mjcf/mujoco_library.hpp"
#include "tests/support/mjcf_text.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds {
namespace {

const std::string kFree = "<freejoint/><geom size='0.1'/>";

std::string with_after(const std::string& content, const std::string& after) {
  return "<mujoco><worldbody>" + content + "</worldbody>" + after + "</mujoco>";
}
std::string free_body(const std::string& geom_attributes) {
  return test::world("<body name='b'><freejoint/><geom name='g' size='0.1' " + geom_attributes +
                     "/></body>");
}

std::vector<std::string> problems_of(const std::string& xml) {
  try {
    load_mjcf_string(xml);
  } catch (const MjcfError& error) {
    return error.problems();
  }
  return {};
}

// A file of its own in the temporary folder, removed at the end.
struct TemporaryFile {
  std::filesystem::path path;
  TemporaryFile(const std::string& name, const std::string& content)
      : path(std::filesystem::temp_directory_path() / name) {
    std::ofstream(path) << content;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

struct Refused {
  const char* what;
  std::string xml;
  const char* element;  // must be named in the problem
  const char* reason;
};

}  // namespace

TEST_CASE("each element that is not simulated is an error that names it", "[mjcf][fast]") {
  const std::string two =
      "<body name='p'>" + kFree + "</body><body name='q' pos='1 0 0'>" + kFree + "</body>";
  const std::string inertial =
      "<body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
  const std::vector<Refused> table = {
      {"unnamed joint, with its line",
       "<mujoco>\n<worldbody>\n<body name='b'>\n<joint type='free' damping='1'/>"
       "<geom size='.1'/></body></worldbody></mujoco>",
       "joint 0 of body 'b', line 4", "damping"},
      {"damped free joint",
       test::world(
           "<body name='b'><joint name='j' type='free' damping='1'/><geom size='.1'/></body>"),
       "joint 'j' of body 'b'", "damping"},
      {"free joint with armature",
       test::world(
           "<body name='b'><joint name='j' type='free' armature='1'/><geom size='.1'/></body>"),
       "joint 'j' of body 'b'", "armature"},
      {"free joint with frictionloss",
       test::world("<body name='b'><joint name='j' type='free' frictionloss='1'/>"
                   "<geom size='.1'/></body>"),
       "joint 'j' of body 'b'", "frictionloss"},
      {"sprung free joint",
       test::world(
           "<body name='b'><joint name='j' type='free' stiffness='1'/><geom size='.1'/></body>"),
       "joint 'j' of body 'b'", "stiffness"},
      {"mocap", test::world("<body name='b' mocap='true'><geom size='.1'/></body>"), "body 'b'",
       "mocap"},
      {"welded gravcomp",
       test::world("<body name='b'>" + kFree +
                   "<body name='c' gravcomp='1'><geom size='.1'/></body></body>"),
       "body 'c'", "gravcomp"},
      {"surface velocity", free_body("surfacevel='1 0 0 0 0 0'"), "geom 'g'", "surfacevel"},
      {"adhesion", free_body("adhesion='1'"), "geom 'g'", "adhesion"},
      {"pair",
       with_after("<geom name='s' size='1'/><body><freejoint/><geom name='g' size='.1'/>"
                  "</body>",
                  "<contact><pair name='x' geom1='s' geom2='g'/></contact>"),
       "pair 'x'", "not simulated"},
      {"exclude", with_after(two, "<contact><exclude name='x' body1='p' body2='q'/></contact>"),
       "exclude 'x'", "not simulated"},
      {"tendon",
       with_after("<site name='s'/><body>" + kFree + "<site name='t'/></body>",
                  "<tendon><spatial name='x'><site site='s'/><site site='t'/></spatial></tendon>"),
       "tendon 'x'", "not simulated"},
      {"actuator",
       with_after("<body><freejoint name='j'/><geom size='.1'/></body>",
                  "<actuator><motor name='m' joint='j'/></actuator>"),
       "actuator 'm'", "not simulated"},
      {"medium density", test::world("", "<option density='1.2'/>"), "option", "density"},
      {"viscosity", test::world("", "<option viscosity='1'/>"), "option", "viscosity"},
      {"wind", test::world("", "<option wind='1 0 0'/>"), "option", "wind"},
  };
  for (const Refused& refused : table) {
    INFO(refused.what);
    const std::vector<std::string> problems = problems_of(refused.xml);
    REQUIRE(problems.size() == 1);
    INFO(problems[0]);
    CHECK(problems[0].find(refused.element) != std::string::npos);
    CHECK(problems[0].find(refused.reason) != std::string::npos);
    CHECK(problems[0].find('\n') == std::string::npos);
  }
  // What neither collides nor weighs is no problem.
  const std::string seen = "<geom type='ellipsoid' size='.1 .2 .3' contype='0' conaffinity='0'/>";
  CHECK(problems_of(test::world(inertial + seen + "</body>")).empty());
  CHECK(problems_of(test::world(seen)).empty());
}

TEST_CASE("meshes and height fields that cannot be are errors", "[mjcf][fast]") {
  const auto mesh = [](const std::string& height) {
    return problems_of(
        "<mujoco><asset><mesh name='m' inertia='shell' vertex='0 0 0 1 0 0 0 1 0 1 1 " + height +
        "' face='0 1 2 1 3 2'/></asset><worldbody>"
        "<geom name='g' type='mesh' mesh='m'/></worldbody></mujoco>");
  };
  const std::vector<std::string> flat = mesh("0");  // MuJoCo's own error
  REQUIRE(flat.size() == 1);
  CHECK(flat[0].find("mesh 'm' has coplanar vertices") != std::string::npos);
  CHECK(mesh("1e-7") == std::vector<std::string>{
                            "MJCF string: geom 'g' of body 'world', line 1: mesh 'm' has no hull: "
                            "points lie in a plane, must enclose a volume"});

  const std::vector<std::string> moving = problems_of(
      "<mujoco><asset><hfield name='h' nrow='2' ncol='2' size='1 1 1 1'/></asset><worldbody>"
      "<body name='b'>" +
      kFree + "<geom name='g' type='hfield' hfield='h'/></body></worldbody></mujoco>");
  CHECK(moving == std::vector<std::string>{
                      "MJCF string: geom 'g' of body 'b', line 1: is a hfield on a body that "
                      "moves, which is not simulated; expected a static body"});
}

TEST_CASE("all problems of a file are listed, one per line, with its name", "[mjcf][fast]") {
  const TemporaryFile file("manyworlds_two_problems.xml",
                           test::world("<body name='b'><joint name='j' type='free' damping='1'/>"
                                       "<geom name='g' size='.1' adhesion='1'/></body>"));
  std::string text;
  try {
    load_mjcf(file.path);
  } catch (const MjcfError& error) {
    text = error.what();
    CHECK(error.problems().size() == 2);
  }
  CHECK(text.find("manyworlds_two_problems.xml: joint 'j'") != std::string::npos);
  CHECK(text.find("\n" + file.path.string() + ": geom 'g'") != std::string::npos);
}

TEST_CASE("softness and solver settings are warnings, once per attribute", "[mjcf][fast]") {
  struct Warned {
    std::string xml;
    const char* text;
  };
  const std::vector<Warned> table = {
      {free_body("solref='0.01 1'"), "geom 'g' of body 'b', line 1: solref"},
      {free_body("solimp='0.8 0.9 0.01'"), "solimp"},
      {free_body("solmix='2'"), "solmix"},
      {free_body("margin='0.01'"), "margin"},
      {free_body("margin='0.01' gap='0.01'"), "gap"},
      {free_body("condim='4'"), "condim"},
      {free_body("priority='1'"), "priority"},
      {free_body("friction='1 0.1'"), "torsional friction"},
      {free_body("friction='1 0.005 0.1'"), "rolling friction"},
      {test::world("<body>" + kFree + "</body>", "<option integrator='RK4' cone='elliptic'/>"),
       "option: integrator, cone"},
      {with_after("<body name='b'>" + kFree + "</body>",
                  "<sensor><framepos name='s' objtype='body' objname='b'/></sensor>"),
       "sensor 's'"},
      {with_after("<body name='b'>" + kFree + "</body>",
                  "<keyframe><key name='k' qvel='1 0 0 0 0 0'/></keyframe>"),
       "key 'k'"},
      {test::world("<geom size='.1' friction='0.5'/><body>" + kFree + "</body>"),
       "geoms have different sliding friction (0.5 to 1)"},
  };
  for (const Warned& warned : table) {
    INFO(warned.xml);
    const std::vector<std::string> warnings = load_mjcf_string(warned.xml).warnings;
    REQUIRE_FALSE(warnings.empty());
    std::string all;
    for (const std::string& warning : warnings) all += warning + "\n";
    INFO(all);
    CHECK(all.find(warned.text) != std::string::npos);
  }
  std::string many;
  for (int i = 0; i < 5; ++i) many += "<geom size='.1' solref='0.01 1'/>";
  const std::vector<std::string> warnings = load_mjcf_string(test::world(many)).warnings;
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("and 4 more: solref") != std::string::npos);
}

TEST_CASE("a frictionless world needs no warning about friction", "[mjcf][fast]") {
  const Scene scene = load_mjcf_string(free_body("condim='1'")).scene;
  CHECK(scene.bodies.at(0).shapes.at(0).material.friction == 0);
}

TEST_CASE("unreadable files give MuJoCo's message with the name of the file", "[mjcf][fast]") {
  std::ifstream stream(std::filesystem::path(test::kSourceFolder) / "scenes" / "mjcf" /
                       "box_pile.xml");
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  REQUIRE(whole.size() > 2000);
  for (const std::size_t length : {std::size_t{5}, whole.size() / 2, whole.size() - 5}) {
    const TemporaryFile file("manyworlds_cut.xml", whole.substr(0, length));
    INFO(length);
    CHECK_THROWS_WITH(load_mjcf(file.path), Catch::Contains("manyworlds_cut.xml: XML parse error"));
  }
  const TemporaryFile empty("manyworlds_empty.xml", "");
  CHECK_THROWS_WITH(load_mjcf(empty.path),
                    Catch::Contains("manyworlds_empty.xml") && Catch::Contains("empty file"));
  const TemporaryFile keyword("manyworlds_keyword.xml", free_body("type='blob'"));
  CHECK_THROWS_WITH(load_mjcf(keyword.path), Catch::Contains("manyworlds_keyword.xml") &&
                                                 Catch::Contains("blob") &&
                                                 Catch::Contains("line 1"));
  CHECK_THROWS_WITH(load_mjcf("no_such_folder/none.xml"), "no_such_folder/none.xml: no such file");
  CHECK_THROWS_WITH(load_mjcf(test::kSourceFolder),
                    Catch::Contains("is a directory; expected a file"));
  CHECK_THROWS_AS(load_mjcf_string(test::world("<body><freejoint/></body>")),
                  MjcfError);  // no mass
  CHECK_THROWS_AS(load_mjcf_string(free_body("mass='-1'")), MjcfError);
  CHECK_NOTHROW(load_mjcf_string(free_body("")));
}

TEST_CASE("numbers that MuJoCo lets pass are found by validate", "[mjcf][fast]") {
  const std::string option =
      GENERATE("timestep='nan'", "timestep='-1'", "timestep='0'", "gravity='0 0 nan'");
  INFO(option);
  try {
    const MjcfResult result =
        load_mjcf_string(test::world("<body>" + kFree + "</body>", "<option " + option + "/>"));
    CHECK_FALSE(validate(result.scene).empty());
  } catch (const MjcfError& error) {
    CHECK(std::string(error.what()).find("MJCF string: ") == 0);
  }
}

// The typical size of what moves has two digits: none where it overflows.
TEST_CASE("a size without a finite diameter is found by validate", "[mjcf][fast]") {
  const std::string shape = GENERATE("size='1e308'", "type='box' size='1e200 1 1'");
  INFO(shape);
  const Scene scene =
      load_mjcf_string(test::world("<body name='b'><freejoint/><inertial pos='0 0 0' mass='1' "
                                   "diaginertia='1 1 1'/><geom name='g' " +
                                   shape + "/></body>"))
          .scene;
  CHECK(*scene.options.length_unit == 1);
  const std::vector<Issue> issues = validate(scene);
  REQUIRE_FALSE(issues.empty());
  CHECK(issues[0].place.find("body 0 'b', shape 0") == 0);
}

TEST_CASE("MuJoCo's error function throws instead of ending the process", "[mjcf][fast]") {
  {
    const mjcf::LogCapture log;
    CHECK_THROWS_AS(mju_error("boom %d", 7), mjcf::MujocoFailure);
    mju_warning("careful %d", 8);
    REQUIRE(log.warnings().size() == 1);
    CHECK(log.warnings()[0].find("careful 8") != std::string::npos);
  }
  CHECK_NOTHROW(load_mjcf_string(free_body("")));
}

}  // namespace manyworlds
