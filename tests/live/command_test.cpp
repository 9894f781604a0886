// Messages of pages: those of ours are read whole, all others refused with a reason.
#include "src/live/command.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "manyworlds/scenes.hpp"

namespace manyworlds::live {
namespace {

Sizes lander_sizes() {
  const Plan plan = compile(scenes::find("lunar-lander")->make());
  return {{{plan, 0, 3}, {plan, 3, 5}}, 6};
}

std::string refusal(std::string_view text, const Sizes& sizes) {
  try {
    static_cast<void>(parse_command(text, sizes));
  } catch (const BadMessage& bad) {
    return bad.what();
  }
  return "";
}

}  // namespace

TEST_CASE("messages of a page are read", "[live][fast]") {
  const Sizes sizes = lander_sizes();
  const Plan& plan = sizes.kinds[0].plan;
  const std::string body = std::to_string(plan.body_in_row(0).index());
  const Command drag = parse_command(
      R"({"do":"drag","world":7,"body":)" + body + R"(,"at":[1,2,3],"to":[4,5.5,-6]})", sizes);
  CHECK(drag.kind == Command::drag);
  CHECK(drag.world == 7);
  CHECK(drag.body == plan.body_in_row(0));
  CHECK(drag.at == Vec3(1, 2, 3));
  CHECK(drag.to == Vec3(4, 5.5, -6));
  const Command show = parse_command(R"({"do":"show","worlds":[0,2,5],"fps":30})", sizes);
  CHECK(show.kind == Command::look);
  CHECK(show.worlds == std::vector{0, 2, 5});
  CHECK(show.number == 30);
  CHECK(std::isinf(parse_command(R"({"do":"speed","factor":null})", sizes).number));
  CHECK(parse_command(R"({"do":"speed","factor":0.5})", sizes).number == 0.5);
  CHECK(parse_command(R"({"do":"reset"})", sizes).world == -1);
  CHECK(parse_command(R"({"do":"reset","world":4})", sizes).world == 4);
  std::string values = "0";
  for (std::size_t i = 1; i < plan.scene().controls.size(); ++i) values += ",0.25";
  const Command controls = parse_command(R"({"do":"controls","values":[)" + values + "]}", sizes);
  CHECK(controls.values.size() == plan.scene().controls.size());
}

TEST_CASE("whatever else is sent is refused with a reason", "[live][fast]") {
  const Sizes sizes = lander_sizes();
  const std::string body = std::to_string(sizes.kinds[0].plan.body_in_row(0).index());
  const std::string drag = R"({"do":"drag","body":)" + body;
  std::string fixed = "none";
  const Scene& scene = sizes.kinds[0].plan.scene();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].motion == Motion::fixed) fixed = std::to_string(b);
  }
  REQUIRE(fixed != "none");
  for (const std::string& text : {
           std::string(),
           std::string("\0\xff\x80", 3),
           std::string("{"),
           std::string("[]"),
           std::string("7"),
           std::string("{}"),
           std::string(R"({"do":7})"),
           std::string(R"({"do":"gone"})"),
           std::string(R"({"do":"frame","more":1})"),
           std::string(R"({"do":"open"})"),
           std::string(R"({"do":"open","worlds":7})"),
           std::string(R"({"do":"open","worlds":0})"),
           std::string(R"({"do":"open","worlds":"1"})"),
           std::string(R"({"do":"open","worlds":1.5})"),
           std::string(R"({"do":"show","worlds":[6],"fps":30})"),
           std::string(R"({"do":"show","worlds":[2,1],"fps":30})"),
           std::string(R"({"do":"show","worlds":[1,1],"fps":30})"),
           std::string(R"({"do":"show","worlds":[0],"fps":1e9})"),
           std::string(R"({"do":"show","worlds":[[0]],"fps":30})"),
           std::string(R"({"do":"step","steps":0})"),
           std::string(R"({"do":"step","steps":1e18})"),
           std::string(R"({"do":"speed","factor":0})"),
           std::string(R"({"do":"speed","factor":1e400})"),
           std::string(R"({"do":"reset","world":8})"),
           std::string(R"({"do":"reset","world":-1})"),
           drag + R"(,"world":8,"at":[0,0,0],"to":[0,0,0]})",
           drag + R"(,"world":0,"at":[0,0],"to":[0,0,0]})",
           drag + R"(,"world":0,"at":[0,0,0],"to":[0,0,1e10]})",
           drag + R"(,"world":0,"at":[0,0,0]})",
           R"({"do":"drag","world":0,"body":)" + fixed + R"(,"at":[0,0,0],"to":[0,0,0]})",
           std::string(R"({"do":"controls","values":[]})"),
           std::string(R"({"do":"controls","values":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]})"),
           std::string(R"({"do":"gravity","value":[0,0,null]})"),
           std::string(R"({"do":"friction","factor":-1})"),
           std::string(R"({"do":"save","file":"/etc/passwd"})"),
           R"({"do":)" + std::string(30000, '['),
       }) {
    INFO(text.substr(0, 80));
    const std::string why = refusal(text, sizes);
    CHECK_FALSE(why.empty());
    CHECK(why.size() <= 120);  // what the frame that closes has room for
  }
}

}  // namespace manyworlds::live
