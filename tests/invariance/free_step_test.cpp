// A group in which no pair is near takes a step of its own (kernels/motion/free_step.hpp): no bit
// may tell it from the passes of the solver, which the same world takes beside one that touches.
#include <catch2/catch.hpp>

#include <vector>

#include "tests/support/hashes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Two bodies that are thrown up at random: steps in which all worlds fly, some land, or all lie.
Scene thrown(const Geometry& geometry, Space space, double size, const Vec3& offset) {
  Scene scene = empty_scene(space, 9.81 * size);
  scene.add(ground(space, 0.5, 0.6));
  for (int i = 0; i < 2; ++i) {
    Body body =
        body_of(shape_of(geometry, 0.5, 0.6), size * (3 * i * Vec3::UnitX() + 3 * up_of(space)));
    body.shapes[0].position = size * offset;
    body.linear_velocity = size * up_of(space);
    body.jitter.linear_velocity = size * Vec3(0.5, 1, space == Space::planar ? 0 : 1);
    body.angular_velocity = Vec3(0, 0, 3);
    body.jitter.angle = 3;
    scene.add(body);
  }
  return scene;
}

std::vector<Scene> variants(const Scene& scene, double size) {
  std::vector<Scene> out(6, scene);
  for (Body& body : out[1].bodies) body.linear_drag = 0.3, body.angular_drag = 0.2;
  out[1].options.wind = size * Vec3(0.5, 0, 0);
  out[2] = out[1];
  out[2].variations = {vary(Parameter::linear_drag, 0.1, 0.5)};
  out[3].options.gravity.setZero();
  out[4].attractors = {{Vec3::Zero(), 40 * size * size * size, size}};
  out[5].options.substeps = 1;
  return out;
}

std::vector<std::uint64_t> run_freely(const Plan& plan, BatchOptions options, ContactLayout layout,
                                      double push) {
  options.layout = layout;
  Batch batch(plan, options);
  std::vector<std::uint64_t> out;
  for (int i = 0; i < 12; ++i) {
    if (push > 0) batch.add_force(i, BodyId(1), Vec3(push, 0, 0));
    batch.step(10);
    for (std::uint64_t hash : hashes(batch)) out.push_back(hash);
  }
  for (int w = 0; w < batch.worlds(); ++w) CHECK_FALSE(frozen(batch.status(w)));
  return out;
}

}  // namespace

TEST_CASE("a group in flight has the bits of the solver's passes", "[fast][bits]") {
  for (const Space space : kSpaces) {
    for (const double size : {1e-3, 1.0, 100.0}) {
      for (const auto& [geometry, offset] :
           {std::pair<Geometry, Vec3>{round_of(space, 0.3 * size), Vec3::Zero()},
            {round_of(space, 0.3 * size), Vec3(0.1, 0, 0)},
            {slab_of(space, 0.3 * size, 0.1 * size), Vec3::Zero()}}) {
        int variant = 0;
        for (const Scene& scene : variants(thrown(geometry, space, size, offset), size)) {
          const Plan plan = compile(scene);
          const double weight = 10 * size * mass_properties(scene, scene.bodies[1]).mass;
          for (const bool sleep : {false, true}) {
            for (const double push : {0.0, weight}) {
              for (const Table& table : widest_tables()) {
                INFO("size " << size << " m, variant " << variant << ", sleep " << sleep
                             << ", push " << push << " N, " << name(table));
                BatchOptions options = options_of(table, 37);
                options.sleep = sleep;
                const auto passes = run_freely(plan, options, ContactLayout::dense, push);
                CHECK(run_freely(plan, options, ContactLayout::automatic, push) == passes);
              }
            }
          }
          ++variant;
        }
      }
    }
  }
}

}  // namespace manyworlds::test
