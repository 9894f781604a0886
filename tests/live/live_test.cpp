// Pages that look on while a batch steps.
#include "manyworlds/live.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "manyworlds/scenes.hpp"
#include "src/live/capture.hpp"
#include "src/live/drag.hpp"
#include "tests/live/client.hpp"

namespace manyworlds::test {
namespace {

using Json = nlohmann::json;

Plan plan_of(const char* scene) { return compile(scenes::find(scene)->make()); }

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T out;
  REQUIRE(at + sizeof out <= bytes.size());
  std::memcpy(&out, bytes.data() + at, sizeof out);
  return out;
}

std::vector<double> positions(const Batch& batch, int world) {
  std::vector<double> out(batch.plan().numbers(Field::position));
  batch.read(Field::position, world, out);
  return out;
}

}  // namespace

TEST_CASE("a page gets a head and frames of what it asks for", "[live][fast]") {
  const LiveFolder folder;
  Batch batch(plan_of("bin-boxes"), {.worlds = 9, .threads = 1});
  Live live(batch, folder.options());
  Page page(live);
  CHECK(live.pages() == 1);
  page.send(R"({"do":"open","worlds":5})");
  const Json head = Json::parse(page.receive().data)["head"];
  CHECK(head["all_worlds"] == 9);
  CHECK(head["kinds"][0]["worlds"] == 5);
  CHECK(head["kinds"][0]["rows"] == 20);
  CHECK_FALSE(head["can"]["clock"].get<bool>());
  page.send(R"({"do":"frame"})");
  CHECK(number_at<double>(page.receive().data, 16) == 0);  // before any step
  page.send(R"({"do":"show","worlds":[1,4],"fps":120})");
  for (int frame = 0; frame < 3; ++frame) {
    page.send(R"({"do":"frame"})");
    std::string got;
    std::atomic<bool> there = false;
    std::thread reader([&] {
      got = page.receive().data;
      there = true;
    });
    while (!there) {
      live.apply(batch);
      batch.step();
      live.show(batch);
    }
    reader.join();
    CHECK(number_at<std::uint32_t>(got, 0) == live::kFrameMagic);
    CHECK(number_at<double>(got, 16) >= frame);  // the first may be of before any step
    REQUIRE(number_at<std::uint32_t>(got, 44) == 2);
    CHECK(number_at<std::uint32_t>(got, 48) == 40);
    CHECK(number_at<std::uint32_t>(got, 64) == 1);
    CHECK(number_at<std::uint32_t>(got, 68) == 4);
    CHECK(got.size() == 64 + 2 * 8 + 40 * (12 + 8 + 3));
  }
}

TEST_CASE("frames are of the worlds as they are", "[live][fast]") {
  for (const char* scene : {"bin-boxes", "bin2d", "free-flight", "ant"}) {
    INFO(scene);
    const Plan plan = plan_of(scene);
    Batch batch(plan, {.worlds = 3, .threads = 1});
    batch.step(40);
    const live::Sizes sizes{{{plan, 0, 3}}, 3};
    const std::string frame =
        live::frame_of(live::capture(batch, sizes, {0, 1, 2}), sizes, std::vector{1});
    const std::vector<double> x = positions(batch, 1);
    std::vector<double> q(plan.numbers(Field::orientation));
    batch.read(Field::orientation, 1, q);
    std::size_t at = 64 + 8;
    for (const double value : x) {
      CHECK(number_at<float>(frame, at) == static_cast<float>(value));
      at += 4;
    }
    const bool planar = plan.scene().space == Space::planar;
    for (std::size_t i = 0; i < q.size(); ++i, at += 2) {
      const double found = number_at<std::int16_t>(frame, at) / live::kTurnSteps;
      if (!planar) CHECK(std::abs(found - q[i]) < 2e-5);
      if (planar && i % 2 == 0) {  // cos of the half angle
        CHECK(std::abs(2 * found * found - 1 - q[i]) < 1e-4);
      }
    }
    const std::size_t joints = plan.scene().joints.size();  // a byte each: whether it is there
    CHECK(number_at<std::uint32_t>(frame, 52) == joints);
    CHECK(frame.size() == at + 3 * static_cast<std::size_t>(plan.bodies()) + joints);
  }
}

TEST_CASE("looking on changes no bit, and a page that reads nothing holds nobody up",
          "[live][fast]") {
  const LiveFolder folder;
  const Plan plan = plan_of("bin-boxes");
  Batch alone(plan, {.worlds = 4, .threads = 1}), watched(plan, {.worlds = 4, .threads = 1});
  Live live(watched, folder.options());
  Page deaf(live);
  deaf.send(R"({"do":"open","worlds":4})");
  deaf.send(R"({"do":"frame"})");
  for (int i = 0; i < 300; ++i) {
    alone.step();
    live.apply(watched);
    watched.step();
    live.show(watched);
  }
  CHECK(watched.hash() == alone.hash());
}

TEST_CASE("run() obeys the clock, resets, sliders and saves of a page", "[live][fast]") {
  const LiveFolder folder;
  Scene scene = scenes::find("ball3d")->make();
  Variation gravity;
  gravity.parameter = Parameter::gravity;
  gravity.low = {0, 0, -20}, gravity.high = {0, 0, 20};
  gravity.draw = Draw::none;
  scene.variations = {gravity, vary(Parameter::friction, 0, 4, Draw::none)};
  Batch batch(compile(scene), {.worlds = 2, .threads = 1});
  LiveOptions options = folder.options();
  options.clock = options.resets = options.parameters = true;
  Live live(batch, options);
  std::atomic<bool> go_on = true;
  std::thread stepping([&] {
    live.run(batch, {.speed = std::numeric_limits<double>::infinity(), .paused = true},
             [&] { return go_on.load(); });
  });
  Page page(live);
  page.send(R"({"do":"open","worlds":2})");
  const Json can = Json::parse(page.receive().data)["head"]["can"];
  CHECK(can["gravity"]["high"][2] == 20);
  CHECK(can["friction"]["low"] == 0);
  // Frames until one has so many steps.
  const auto steps_reach = [&](double steps) {
    double now = -1;
    while (now != steps) {
      page.send(R"({"do":"frame"})");
      const auto got = page.receive();
      REQUIRE(got.opcode == 2);
      now = number_at<double>(got.data, 16);
    }
  };
  page.send(R"({"do":"step","steps":7})");
  steps_reach(7);
  page.send(R"({"do":"gravity","value":[0,0,-1]})");
  page.send(R"({"do":"friction","factor":0})");
  page.send(R"({"do":"save"})");
  CHECK(Json::parse(page.receive().data)["said"] == "saved ball3d-step7.snapshot");
  page.send(R"({"do":"save"})");
  CHECK(Json::parse(page.receive().data)["said"] == "saved ball3d-step7-2.snapshot");
  page.send(R"({"do":"reset"})");
  page.send(R"({"do":"step","steps":2})");
  steps_reach(2);
  page.send(R"({"do":"controls","values":[1]})");  // of a scene that has none
  CHECK(page.farewell() == "'values' must have a number for each control");
  go_on = false;
  stepping.join();
  CHECK(batch.steps() == 2);
  std::vector<double> g(batch.size(Parameter::gravity)), mu(batch.size(Parameter::friction));
  batch.read(Parameter::gravity, g), batch.read(Parameter::friction, mu);
  CHECK(g == std::vector<double>{0, 0, -1, 0, 0, -1});
  for (const double one : mu) CHECK(one == 0);
  CHECK(Snapshot::load(folder.path() / "ball3d-step7-2.snapshot").steps() == 7);
}

TEST_CASE("what a program does not let pages command is told to them", "[live][fast]") {
  const LiveFolder folder;
  Batch batch(plan_of("ant"), {.worlds = 1, .threads = 1});
  Live live(batch, folder.options());
  Page page(live);
  for (const char* command :
       {R"({"do":"pause"})", R"({"do":"step","steps":1})", R"({"do":"speed","factor":2})",
        R"({"do":"reset"})", R"({"do":"gravity","value":[0,0,0]})",
        R"({"do":"friction","factor":0})", R"({"do":"controls","values":[0,0,0,0,0,0,0,0]})"}) {
    INFO(command);
    page.send(command);
    std::string said;
    std::atomic<bool> there = false;
    std::thread reader([&] {
      said = page.receive().data;
      there = true;
    });
    while (!there) live.apply(batch);
    reader.join();
    CHECK(said.find("does not allow pages") != said.npos);
  }
  CHECK(batch.steps() == 0);
}

TEST_CASE("a drag draws a body to its point without overshooting", "[live][fast]") {
  struct Case {
    const char* scene;
    int body, steps;
    bool off_centre;
  };
  for (const Case& one : {Case{"free-flight", 3, 1, false}, Case{"free-flight", 3, 16, false},
                          Case{"free-flight", 5, 1, true}, Case{"ball3d", 0, 1, true},
                          Case{"free-flight", 5, 30, true}}) {
    INFO(one.scene << " " << one.body << " " << one.steps);
    const Plan plan = plan_of(one.scene);
    Batch batch(plan, {.worlds = 1, .threads = 1});
    const live::KindOfWorlds kind{plan, 0, 1};
    const BodyId body = plan.body_in_row(one.body);
    const Vec3 at = one.off_centre ? Vec3(0.2, 0.1, 0.05) : Vec3::Zero();
    live::Drag drag = live::make_drag(kind, 0, body, at);
    drag.to = live::motion_of(batch, kind, 0, body, at).point + Vec3(1, -2, 1.5);
    const double began = (drag.to - live::motion_of(batch, kind, 0, body, at).point).norm();
    double farthest = 0;
    const int calls = static_cast<int>((6 + one.steps) / (one.steps * plan.scene().options.dt));
    for (int i = 0; i < calls; ++i) {
      live::add_drag(batch, kind, drag, one.steps);
      batch.step(one.steps);
      farthest =
          std::max(farthest, (drag.to - live::motion_of(batch, kind, 0, body, at).point).norm());
    }
    const double left = (drag.to - live::motion_of(batch, kind, 0, body, at).point).norm();
    CHECK(left < 0.06 * began);     // it sags by g / rate^2, and a third more in steps so long
    CHECK(farthest < 1.3 * began);  // it may have been on its way elsewhere
  }
}

TEST_CASE("hostile pages are closed, and nothing else is", "[live][fast]") {
  const LiveFolder folder;
  Batch batch(plan_of("ball3d"), {.worlds = 2, .threads = 1});
  Live live(batch, folder.options());
  std::atomic<bool> done = false;
  std::string flooded, too_long;
  int forbidden = 0, endless = 0;
  std::thread attacker([&] {
    std::uint32_t random = 1;
    const auto next = [&] { return random = random * 1664525u + 1013904223u; };
    for (int i = 0; i < 60; ++i) {
      Page page(live, Page::patient);
      std::string noise(next() % 200, '\0');
      for (char& c : noise) c = static_cast<char>(next() >> 24);
      page.send(i % 3 == 0 ? R"({"do":"open","worlds":2})" : noise, i % 5 == 0 ? 2 : 1);
      if (i % 3 == 1) page.farewell();  // the others go without a word
    }
    for (int i = 0; i < 40; ++i) {  // no WebSocket at all
      Connection connection(live.port());
      std::string noise(next() % 3000, '\0');
      for (char& c : noise) c = static_cast<char>(next() >> 24);
      connection.send(noise);
    }
    Page flood(live, Page::patient);
    flood.send(R"({"do":"open","worlds":2})");
    for (int i = 0; i < 5000; ++i) flood.send(R"({"do":"drop"})");
    flood.send("{}");  // where it is so slow that these were not too many
    flooded = flood.farewell();
    Page much(live, Page::patient);
    much.send(std::string(100'000, ' '));
    too_long = much.farewell();
    forbidden = status_of(live.port(), "GET / HTTP/1.1\r\nHost: x\r\n\r\n");
    endless = status_of(live.port(), "GET / HTTP/1.1\r\n" + std::string(20'000, 'x') + "\r\n\r\n");
    done = true;
  });
  Page page(live);
  page.send(R"({"do":"open","worlds":2})");
  CHECK(page.receive().opcode == 1);
  int frames = 0;
  std::thread looker([&] {
    while (!done) {
      page.send(R"({"do":"frame"})");
      if (page.receive().opcode != 2) return;
      ++frames;
    }
  });
  std::atomic<bool> over = false;
  std::thread stepper([&] {
    while (!over) {
      live.apply(batch);
      batch.step();
      live.show(batch);
    }
  });
  attacker.join(), looker.join();
  over = true;
  stepper.join();
  CHECK(frames > 0);
  CHECK((flooded == "too many messages" || flooded == "the message has no 'do'"));
  CHECK(too_long == "the message is too long");
  CHECK(forbidden == 403);
  CHECK(endless != 200);
  CHECK(live.pages() >= 1);
  live.close();
  CHECK(page.farewell() == "the program has ended");
  CHECK(live.url().empty());
}

TEST_CASE("what cannot be served is an error that says why", "[live][fast]") {
  const LiveFolder folder;
  Batch batch(plan_of("ball3d"), {.worlds = 1, .threads = 1});
  Live live(batch, folder.options());
  LiveOptions options = folder.options();
  options.port = live.port();
  CHECK_THROWS_WITH(Live(batch, options), Catch::Contains("port " + std::to_string(live.port())));
  options = folder.options();
  options.page = folder / "none.html";
  CHECK_THROWS_WITH(Live(batch, options), Catch::Contains("none.html' cannot be read"));
  options = folder.options();
  options.worlds = 0;
  CHECK_THROWS_AS(Live(batch, options), std::invalid_argument);
}

}  // namespace manyworlds::test
