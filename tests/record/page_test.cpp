// What is read back from a page is what was recorded, within what page.hpp promises.
#include "manyworlds/page.hpp"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "manyworlds/scenes.hpp"
#include "manyworlds/surface.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kEmpty =
    "<html><meta name=\"manyworlds-page\" content=\"1\"><body><!-- manyworlds: recordings "
    "--></body></html>";

std::string element(const std::string& page, const std::string& id) {
  const std::size_t at = page.find("id=\"" + id + "\">");
  REQUIRE(at != std::string::npos);
  const std::size_t begin = page.find('>', at) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> out;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((bits += 6) >= 8) out.push_back(static_cast<std::uint8_t>(word >> (bits -= 8)));
  }
  return out;
}

// Channels of one chunk, [channel][item][frame]; items of each are as they come.
class Chunk {
 public:
  Chunk(const Json& head, const std::string& text)
      : frames_(head.at("frames")), widths_(head.at("widths")) {
    const auto packed = from_base64(text);
    bytes_.resize(1 << 24);
    uLongf size = bytes_.size();
    REQUIRE(uncompress(bytes_.data(), &size, packed.data(), packed.size()) == Z_OK);
    bytes_.resize(size);
  }
  // By its definition, unlike the page's own reading: each value from those before it.
  std::vector<double> next(std::size_t items) {
    const auto width = static_cast<std::size_t>(widths_.at(channel_++));
    const std::size_t count = items * frames_;
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t folded = 0;
      for (std::size_t b = 0; b < width; ++b) {
        folded += std::int64_t{bytes_.at(at_ + b * count + i)} << (8 * b);
      }
      const std::size_t f = i % frames_;
      const double left = static_cast<double>(folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2);
      out[i] = left + (f == 0 ? 0 : f == 1 ? out[i - 1] : 2 * out[i - 1] - out[i - 2]);
    }
    at_ += width * count;
    return out;
  }
  // The numbers of a list, which are as they were put.
  std::vector<std::int64_t> list(std::size_t count) {
    const auto width = static_cast<std::size_t>(widths_.at(channel_++));
    std::vector<std::int64_t> out(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t folded = 0;
      for (std::size_t b = 0; b < width; ++b) {
        folded += std::int64_t{bytes_.at(at_ + b * count + i)} << (8 * b);
      }
      out[i] = folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2;
    }
    at_ += width * count;
    return out;
  }
  std::size_t frames() const { return frames_; }
  bool done() const { return at_ == bytes_.size() && channel_ == widths_.size(); }

 private:
  std::size_t frames_;
  std::vector<int> widths_;
  std::vector<std::uint8_t> bytes_;
  std::size_t channel_ = 0, at_ = 0;
};

Quat rotation_of(const double* q, std::size_t n) {
  if (n == 0) return Quat::Identity();
  if (n == 4) return Quat(q[0], q[1], q[2], q[3]).normalized();
  return Quat(Eigen::AngleAxisd(std::atan2(q[1], q[0]), Vec3::UnitZ()));
}

// The farthest that a point of a body is drawn from where it was, in radii of the body.
double worst_error(const std::string& page, const Recording& recording) {
  const Json run = Json::parse(element(page, "mw-head")).at("runs").at(0);
  const Json kind = run.at("kinds").at(0);
  const bool planar = run.at("space") == "planar";
  const std::size_t space = planar ? 2 : 3, rows = kind.at("rows"), worlds = kind.at("worlds");
  const std::size_t turns = kind.at("orientation");
  CHECK(kind.at("turns") == recording.plan().has(Feature::orientation));
  std::vector<double> radius(rows);
  std::vector<std::vector<Vec3>> points(rows);
  const Scene& scene = recording.plan().scene();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Json& body = kind.at("bodies").at(b);
    if (body.at("row").is_null()) continue;
    const std::size_t row = body.at("row");
    radius[row] = body.at("radius");
    for (const Shape& shape : scene.bodies[b].shapes) {
      for (const Vec3& p : surface(shape.geometry, {.space = scene.space}).points) {
        points[row].push_back(shape.position + shape.rotation.normalized() * p);
        CHECK(points[row].back().norm() <= radius[row] * 1.003);
      }
    }
  }
  double worst = 0;
  std::int64_t sample = 0;
  for (std::size_t c = 0; c < run.at("chunks").size(); ++c) {
    Chunk chunk(run.at("chunks").at(c), element(page, "mw-0-" + std::to_string(c)));
    std::vector<std::vector<double>> x, q;
    for (std::size_t k = 0; k < space; ++k) x.push_back(chunk.next(rows * worlds));
    for (std::size_t k = 0; k < (turns == 2 ? 1 : turns); ++k)
      q.push_back(chunk.next(rows * worlds));
    chunk.next(rows * worlds), chunk.next(rows * worlds);  // speeds
    const std::vector<double> status = chunk.next(worlds);
    if (run.at("enabled")) chunk.next(rows * worlds);
    CHECK(chunk.done());
    for (std::size_t f = 0; f < chunk.frames(); ++f, ++sample) {
      for (std::size_t w = 0; w < worlds; ++w) {
        const int world = static_cast<int>(w);
        CHECK(status[w * chunk.frames() + f] ==
              static_cast<double>(recording.status(sample, world)));
        const auto position = recording.read(Field::position, sample, world);
        const auto orientation = recording.read(Field::orientation, sample, world);
        for (std::size_t row = 0; row < rows; ++row) {
          const std::size_t i = (w * rows + row) * chunk.frames() + f;
          Vec3 there = Vec3::Zero(), drawn = Vec3::Zero();
          for (std::size_t k = 0; k < space; ++k) {
            there[static_cast<Eigen::Index>(k)] = position[space * row + k];
            drawn[static_cast<Eigen::Index>(k)] = x[k][i] * radius[row] / 512;
          }
          const Quat turn = rotation_of(orientation.data() + turns * row, turns);
          Quat seen = Quat::Identity();
          if (turns == 2) {
            seen = Eigen::AngleAxisd(q[0][i] * 2 * std::numbers::pi / 4096, Vec3::UnitZ());
          } else if (turns == 4) {
            seen = Quat(q[0][i], q[1][i], q[2][i], q[3][i]).normalized();
          }
          for (const Vec3& p : points[row]) {
            worst = std::max(worst, (there + turn * p - drawn - seen * p).norm() / radius[row]);
          }
        }
      }
    }
  }
  CHECK(sample == recording.samples());
  return worst;
}

std::filesystem::path empty_page(const Folder& folder) {
  std::ofstream(folder / "empty.html") << kEmpty;
  return folder / "empty.html";
}

}  // namespace

TEST_CASE("bodies are drawn where they were, in every scene", "[fast][record][page]") {
  const Folder folder;
  const auto empty = empty_page(folder);
  for (const scenes::Entry& entry : scenes::all()) {
    INFO(entry.name);
    Batch batch(compile(entry.make()), batch_options(widest_tables().front(), 3));
    Recorder recorder(batch, folder / "run.h5", {.every = 2});
    batch.step(30);
    for (int i = 0; i < 40; ++i) batch.step(2);
    recorder.close();
    const Recording recording = Recording::open(folder / "run.h5");
    const Recording* const all[] = {&recording};
    const double worst = worst_error(page_of(all, empty), recording);
    CHECK(worst < kPageError);
    if (recording.plan().bodies() > 0) CHECK(worst > 0);
  }
}

TEST_CASE("a page has what was asked for", "[fast][record][page]") {
  const Folder folder;
  const auto empty = empty_page(folder);
  Scene scene;
  scene.name = "a </script> <b>";
  scene.add({.motion = Motion::fixed, .shapes = {{.geometry = Plane{}}}});
  const BodyId ball = scene.add({.position = {0, 0, 1}, .shapes = {{.geometry = Sphere{}}}});
  const BodyId late = scene.add({.enabled = false, .shapes = {{.geometry = Box{}}}});
  scene.variations.push_back(vary(Parameter::size, 0.2, 0.4));
  scene.variations.back().shape = ShapeId(ball, 0);
  Batch batch(compile(scene), {.worlds = 3, .seed = 5});
  Recorder recorder(batch, folder / "run.h5");
  batch.step(1);
  batch.spawn(1, late, {.position = {0, 0, 4}});
  for (int i = 0; i < 39; ++i) batch.step(1);
  recorder.close();
  const Recording recording = Recording::open(folder / "run.h5");
  const Recording* const twice[] = {&recording, &recording};
  PageOptions options{.max_worlds = 2, .every = 3, .numbers = {{"reward", "1", {}}}};
  for (int i = 0; i < 41 * 3; ++i) options.numbers[0].values.push_back(static_cast<float>(i));
  const PageReport report = write_page(twice, empty, folder / "page.html", options);
  CHECK(report.written);
  CHECK(report.worlds == 4);
  CHECK(report.bodies == 8);
  CHECK(report.frames == 14);
  CHECK(report.bytes == std::filesystem::file_size(folder / "page.html"));

  const std::string page = page_of(twice, empty, options);
  CHECK(page.find("a </script>") == std::string::npos);
  const Json head = Json::parse(element(page, "mw-head"));
  CHECK(head.at("title") == scene.name);
  REQUIRE(head.at("runs").size() == 2);
  const Json& run = head.at("runs").at(0);
  CHECK(run.at("times").size() == 14);
  CHECK(run.at("times").at(1).get<double>() == Approx(3 * scene.options.dt));
  CHECK(run.at("numbers").size() == 1);
  CHECK(head.at("runs").at(1).at("numbers").empty());
  CHECK(run.at("enabled") == true);
  CHECK(run.at("kinds").at(0).at("worlds") == 2);
  CHECK(run.at("kinds").at(0).at("sizes").size() == 1);
  // The box is there from frame 1 on, in world 1 alone.
  Chunk chunk(run.at("chunks").at(0), element(page, "mw-0-0"));
  for (int skipped = 0; skipped < 3 + 4 + 2; ++skipped) chunk.next(4);
  chunk.next(2);
  const std::vector<double> there = chunk.next(4);
  for (std::size_t f = 0; f < chunk.frames(); ++f) {
    CHECK(there[0 * chunk.frames() + f] == 1);
    CHECK(there[1 * chunk.frames() + f] == 0);
    CHECK(there[3 * chunk.frames() + f] == (f > 0 ? 1 : 0));
  }
}

TEST_CASE("a page knows which joints broke or are disabled", "[fast][record][page]") {
  const Folder folder;
  Scene scene;
  for (const double x : {0.0, 3.0}) {
    const BodyId ball = scene.add({.position = {x, 0, 0}, .shapes = {{.geometry = Sphere{}}}});
    scene.joints.push_back({.type = DistanceJoint{}, .body_b = ball});
    scene.joints.back().frame_a.position = {x, 0, 2};
  }
  scene.joints[0].break_force = 1;  // N, less than it weighs
  Batch batch(compile(scene), {.worlds = 2});
  Recorder recorder(batch, folder / "run.h5", {.every = 4});
  for (int i = 0; i < 8; ++i) batch.step(1);
  batch.set_joint_enabled(1, JointId(1), false);
  for (int i = 0; i < 8; ++i) batch.step(1);
  recorder.close();
  const Recording recording = Recording::open(folder / "run.h5");
  const Recording* const all[] = {&recording};
  const std::string page = page_of(all, empty_page(folder));
  const Json run = Json::parse(element(page, "mw-head")).at("runs").at(0);
  CHECK(run.at("enabled") == false);
  CHECK(run.at("joints_enabled") == true);
  Chunk chunk(run.at("chunks").at(0), element(page, "mw-0-0"));
  REQUIRE(chunk.frames() == 5);
  for (int skipped = 0; skipped < 3 + 4 + 2; ++skipped) chunk.next(4);
  chunk.next(2);
  const std::vector<double> there = chunk.next(4);  // [world][joint][frame]
  CHECK(chunk.done());
  CHECK(there == std::vector<double>{1, 0, 0, 0, 0, 1, 1, 1, 1, 1,  //
                                     1, 0, 0, 0, 0, 1, 1, 1, 0, 0});
}

// Each list by its definition (src/page/contacts.hpp), from those before it.
TEST_CASE("contacts on a page are those that were recorded", "[fast][record][page]") {
  const Folder folder;
  const auto empty = empty_page(folder);
  for (const char* name : {"bin-boxes", "bin2d"}) {
    BatchOptions options = batch_options(widest_tables().front(), 3);
    options.observe.what = {Observer::contacts};
    Batch batch(compile(scenes::find(name)->make()), options);
    batch.step(60);
    Recorder recorder(batch, folder / "run.h5", {.every = 2, .contacts = 100});
    for (int i = 0; i < 45; ++i) batch.step(2);
    recorder.close();
    const Recording recording = Recording::open(folder / "run.h5");
    const Recording* const all[] = {&recording};
    const std::string page = page_of(all, empty);
    const Json run = Json::parse(element(page, "mw-head")).at("runs").at(0);
    CHECK(run.at("contacts") == true);
    const Json kind = run.at("kinds").at(0);
    const std::size_t rows = kind.at("rows"), worlds = 3;
    const std::size_t space = run.at("space") == "planar" ? 2 : 3, turns = kind.at("orientation");
    const double step = kind.at("contact_step");
    std::int64_t first = 0, points = 0;
    for (std::size_t c = 0; c < run.at("chunks").size(); ++c) {
      Chunk chunk(run.at("chunks").at(c), element(page, "mw-0-" + std::to_string(c)));
      for (std::size_t k = 0; k < space + (turns == 2 ? 1 : turns) + 2; ++k) {
        chunk.next(rows * worlds);
      }
      chunk.next(worlds);  // status
      const std::vector<double> counts = chunk.next(worlds);
      std::size_t count = 0;
      for (const double n : counts) count += static_cast<std::size_t>(n);
      std::vector<std::vector<std::int64_t>> lists;
      for (std::size_t k = 0; k < 2 + 2 * space + 1; ++k) lists.push_back(chunk.list(count));
      CHECK(chunk.done());
      std::size_t at = 0;
      for (std::size_t w = 0; w < worlds; ++w) {
        std::vector<std::vector<std::int64_t>> before;
        for (std::size_t f = 0; f < chunk.frames(); ++f) {
          auto wanted =
              recording.contacts(first + static_cast<std::int64_t>(f), static_cast<int>(w));
          std::stable_sort(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) {
            return std::pair(a.body_a, a.body_b) < std::pair(b.body_a, b.body_b);
          });
          REQUIRE(wanted.size() == static_cast<std::size_t>(counts[w * chunk.frames() + f]));
          std::vector<std::vector<std::int64_t>> now;
          std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> of_pair;
          for (std::size_t i = 0; i < wanted.size(); ++i, ++at) {
            std::vector<std::int64_t> numbers;
            for (const auto& list : lists) numbers.push_back(list[at]);
            for (std::size_t k = 0; k < 2 && i < before.size(); ++k) numbers[k] += before[i][k];
            // The n-th of a pair follows the n-th of that pair.
            const std::size_t nth = of_pair[{numbers[0], numbers[1]}]++;
            std::size_t met = 0;
            for (const auto& old : before) {
              if (old[0] != numbers[0] || old[1] != numbers[1] || met++ != nth) continue;
              for (std::size_t k = 2; k < numbers.size(); ++k) numbers[k] += old[k];
            }
            CHECK(numbers[0] == wanted[i].body_a.index());
            CHECK(numbers[1] == wanted[i].body_b.index());
            for (std::size_t k = 0; k < space; ++k) {
              const auto axis = static_cast<Eigen::Index>(k);
              CHECK(std::abs(static_cast<double>(numbers[2 + k]) * step - wanted[i].point[axis]) <
                    0.51 * step);
              CHECK(std::abs(static_cast<double>(numbers[2 + space + k]) / 127 -
                             wanted[i].normal[axis]) < 0.51 / 127);
            }
            if (wanted[i].force > 1e-6) {
              const double force = 1e-6 * std::exp2(static_cast<double>(numbers.back() - 1) / 64);
              CHECK(force == Approx(wanted[i].force).epsilon(0.006));
            } else {
              CHECK(numbers.back() == 0);
            }
            now.push_back(numbers);
            ++points;
          }
          before = std::move(now);
        }
      }
      first += static_cast<std::int64_t>(chunk.frames());
    }
    CHECK(first == recording.samples());
    CHECK(points > 1000);
  }
}

TEST_CASE("pages refuse what they cannot show", "[fast][record][page]") {
  const Folder folder;
  Batch batch(compile(scenes::find("ball3d")->make()), {.worlds = 2});
  Recorder recorder(batch, folder / "run.h5");
  batch.step(2);
  recorder.close();
  const Recording recording = Recording::open(folder / "run.h5");
  const Recording* const all[] = {&recording};
  const auto empty = empty_page(folder);
  CHECK_THROWS_WITH(page_of({}, empty), "page: no recording is given");
  CHECK_THROWS_WITH(page_of(all, folder / "none.html"), Catch::EndsWith("cannot be read"));
  std::ofstream(folder / "other.html") << "<html></html>";
  CHECK_THROWS_WITH(page_of(all, folder / "other.html"),
                    Catch::Contains("is not a page of this version"));
  CHECK_THROWS_WITH(page_of(all, empty, {.every = 0}),
                    "page: max_worlds is 0 and every is 0, must be at least 0 and 1");
  CHECK_THROWS_WITH(page_of(all, empty, {.numbers = {{"reward", "", {1, 2}}}}),
                    "page: number 'reward' has 2 values, must have 4, one per sample and world");
  CHECK_THROWS_AS(write_page(all, empty, folder / "no" / "page.html"), RecordError);
  CHECK_FALSE(
      write_page(all, empty, folder / "page.html", {.go_on = [] { return false; }}).written);
  CHECK_FALSE(std::filesystem::exists(folder / "page.html"));
}

}  // namespace manyworlds::test
