// Our models with joints in Solver::newton against MuJoCo: accelerations, the next state, the
// number of contacts, and paths.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/mjcf/newton_comparison.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds::test {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}
std::string scene_text(const std::string& name) {
  return text_of(std::filesystem::path(kSourceFolder) / "scenes" / "mjcf" / (name + ".xml"));
}

}  // namespace

TEST_CASE("a model of one's own against MuJoCo", "[.compare]") {
  const char* path = std::getenv("MW_MODEL");
  REQUIRE(path);
  for (const Table& table : widest_tables()) {
    const std::string xml = text_of(path);
    const auto samples = samples_of(xml, table.precision, 320);
    const Plan plan = compile(converged(xml, table.precision));
    WARN(path << ", " << name(table) << ": " << to_string(compare(plan, samples, table)));
  }
}

TEST_CASE("models with joints accelerate and step as in MuJoCo", "[mjcf][robots]") {
  const std::string model =
      GENERATE("robot_pendulum", "robot_hopper", "robot_cheetah", "robot_ant", "robot_humanoid");
  const std::string xml = scene_text(model);
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const auto samples = samples_of(xml, precision, 200);
    const Plan plan = compile(converged(xml, precision));
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      const Comparison c = compare(plan, samples, table);
      INFO(model << ", " << name(table) << ": " << to_string(c));
      if (std::getenv("MW_FIGURES")) WARN(model << ", " << name(table) << ": " << to_string(c));
      CHECK(c.contacts > c.states / 20);
      CHECK(c.acceleration.size() > 20);
      CHECK(c.other_contacts <= c.states / 100);
      CHECK(c.uncertain <= c.states / 50);
      CHECK(most(c.acceleration) < pick(table, 1e-3, 1e-11));
      CHECK(most(c.next) < pick(table, 1e-3, 1e-11));
      CHECK(median(c.acceleration) < pick(table, 3e-5, 1e-12));
      CHECK(median(c.next) < pick(table, 3e-5, 1e-12));
    }
  }
}

TEST_CASE("models follow MuJoCo's path for 1,000 steps without contacts", "[mjcf][robots]") {
  const std::string model =
      GENERATE("robot_pendulum", "robot_hopper", "robot_cheetah", "robot_ant", "robot_humanoid");
  INFO(model);
  Reference reference(scene_text(model));
  mjModel& m = *reference.model;
  mjData* d = reference.data.get();
  converge(m);
  m.opt.disableflags |= mjDSBL_CONTACT;
  Scene scene = converged(scene_text(model), Precision::f64);
  for (Body& body : scene.bodies) {
    for (Shape& shape : body.shapes) shape.filter.mask = 0;
  }
  const Plan plan = compile(scene);
  {
    mj_resetData(&m, d);
    Random random(7);
    for (int k = 0; k < m.nv; ++k) d->qvel[k] = random.uniform(-0.5, 0.5);
    for (int s = 0; s < 1000; ++s) {
      if (s % 50 == 0) draw_controls(m, random, *d);
      mj_step(&m, d);
    }
  }
  const std::vector<double> expected(d->qpos, d->qpos + m.nq);
  for (const Table& table : all_tables()) {
    if (table.precision != Precision::f64) continue;
    Batch batch(plan, options_of(table, 2));
    Random random(7);
    mj_resetData(&m, d);
    std::vector<double> v, u;
    for (int k = 0; k < m.nv; ++k) v.push_back(random.uniform(-0.5, 0.5));
    batch.write(Field::generalized_velocity, 1, v);
    for (int s = 0; s < 1000; ++s) {
      if (s % 50 == 0) {
        draw_controls(m, random, *d);
        u.assign(2 * static_cast<std::size_t>(m.nu), 0);
        std::copy_n(d->ctrl, m.nu, u.begin() + static_cast<std::ptrdiff_t>(m.nu));
        batch.set_controls(std::span<const double>(u));
      }
      batch.step();
    }
    const std::vector<double> q = read(batch, Field::generalized_position, 1);
    double error = 0;
    for (std::size_t c = 0; c < q.size(); ++c) {
      error = std::max(error, std::abs(q[c] - expected[c]) / (1 + std::abs(expected[c])));
    }
    INFO(name(table) << ": error " << error);
    if (std::getenv("MW_FIGURES")) WARN(model << ": path " << error);
    CHECK(error < 1e-11);
  }
}

}  // namespace manyworlds::test
