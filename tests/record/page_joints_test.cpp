// Joints on a page: what each is, where its ends are, and which of them are there.
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "manyworlds/page.hpp"
#include "manyworlds/scenes.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {
namespace {

using Json = nlohmann::json;

// What the page of a batch after some steps says of its first run.
Json run_of(Batch& batch, const std::function<void()>& steps) {
  const Folder folder;
  std::ofstream(folder / "empty.html")
      << "<meta name=\"manyworlds-page\" content=\"1\"><!-- manyworlds: recordings -->";
  Recorder recorder(batch, folder / "run.h5");
  steps();
  recorder.close();
  const Recording recording = Recording::open(folder / "run.h5");
  const Recording* const all[] = {&recording};
  const std::string page = page_of(all, folder / "empty.html");
  const std::size_t begin = page.find('>', page.find("id=\"mw-head\"")) + 1;
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin)).at("runs")[0];
}

}  // namespace

TEST_CASE("a page knows what its joints are, and has room for them", "[fast][record][page]") {
  Scene scene;
  scene.space = Space::planar;
  scene.options.gravity = {0, -10, 0};
  const BodyId a = scene.add({.position = {0, 1, 0}, .shapes = {{.geometry = Circle{0.2}}}});
  const BodyId b = scene.add({.position = {3, 1, 0}, .shapes = {{.geometry = Circle{0.2}}}});
  const auto add = [&](const JointType& type, BodyId from) {
    scene.joints.push_back({.type = type, .body_a = from, .body_b = b});
    scene.joints.back().frame_a.position = {0, from ? 0.0 : 5.0, 0};
  };
  add(DistanceJoint{}, a);
  add(DistanceJoint{.limit = Limit{0, 4}}, a);
  add(DistanceJoint{.limit = Limit{1, 4}}, a);
  add(DistanceJoint{.length = 2, .spring = Spring{.frequency = 2}}, a);
  add(DistanceJoint{.limit = Limit{0, 9}}, {});
  add(PulleyJoint{.ground_a = {0, 4, 0}, .ground_b = {3, 6, 0}}, a);
  add(SliderJoint{.limit = Limit{-1, 2}}, a);
  add(HingeJoint{}, a);
  Batch batch(compile(scene), {.worlds = 1});
  const Json kind = run_of(batch, [&] { batch.step(1); }).at("kinds")[0];
  const Json& joints = kind.at("joints");
  REQUIRE(joints.size() == 8);
  const char* forms[] = {"rod", "rope", "telescope", "spring", "rope"};
  for (std::size_t j = 0; j < 5; ++j) {
    CHECK(joints[j].at("type") == "distance");
    CHECK(joints[j].at("form") == forms[j]);
  }
  CHECK(joints[0].at("length").get<double>() == Approx(3));  // as the bodies begin
  CHECK(joints[1].at("length") == 4.0);
  CHECK(joints[3].at("length") == 2.0);
  CHECK(joints[0].at("a").at("body") == 0);
  CHECK(joints[4].at("a").at("body").is_null());
  CHECK(joints[4].at("body_b") == 1);
  CHECK(joints[5].at("grounds") == Json::array({{0.0, 4.0, 0.0}, {3.0, 6.0, 0.0}}));
  CHECK(joints[6].at("range") == Json::array({-1.0, 2.0}));
  CHECK(joints[7].at("type") == "hinge");
  CHECK_FALSE(joints[7].contains("form"));
  CHECK(kind.at("high")[1].get<double>() > 6);  // the pulley's wheel is the highest
}

TEST_CASE("of joints in a series a page has the ends that are on bodies", "[fast][record][page]") {
  Batch robot(compile(scenes::find("humanoid")->make()), {.worlds = 1});
  const auto& found = robot.plan().scene().joints;
  const Json run = run_of(robot, [&] { robot.step(1); });
  const Json& series = run.at("kinds")[0].at("joints");
  int within = 0;
  for (std::size_t j = 0; j < found.size(); ++j) {
    CHECK(series[j].at("a").is_null() == static_cast<bool>(found[j].after));
    if (found[j].after) {
      const auto before = static_cast<std::size_t>(found[j].after.index());
      CHECK(series[before].at("b").is_null());
      ++within;
    }
  }
  CHECK(within > 0);
}

}  // namespace manyworlds::test
