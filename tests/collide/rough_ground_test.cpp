// Contacts with rough ground, checked against the geometry itself: what they report as overlap is
// there. Scenes of bodies of every shape, from their fall until they lie.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "manyworlds/scenes.hpp"
#include "tests/support/rough_ground.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr double kSlack = 1e-4;  // m, of float32 and of faces that are clipped a little wider

// How far the contacts of a run are off.
struct Excess {
  double deepest = 0;  // m, overlap that a contact reports
  double phantom = 0;  // m, of that the most that is not there
  int contacts = 0;    // that overlap
  std::string worst = {};
};

Excess excess_of(const std::string& scene_name, const Table& table, int worlds, int steps,
                 int stride) {
  const Scene scene = scenes::find(scene_name)->make();
  const Shape& shape = scene.bodies[0].shapes[0];
  const RoughGround ground(shape.geometry);
  Batch batch(compile(scene), options_of(table, worlds));
  Excess out;
  for (int step = 0; step < steps; step += stride) {
    batch.step(stride);
    for (int w = 0; w < worlds; ++w) {
      for (const Contact& contact : batch.contacts(w)) {
        if (contact.body_a.index() != 0 || contact.shape_a.index() != 0) continue;
        if (contact.separation >= 0) continue;
        const int row = batch.row(contact.body_b, 0);
        const Solid body =
            make_solid(scene.at(contact.body_b).shapes[0],
                       {position(batch, w, row), rotation(batch, w, row)}, scene.space);
        const double depth = -contact.separation;
        const double there = overlap_at(ground, body, contact.point, contact.normal, depth, kSlack);
        out.deepest = std::max(out.deepest, depth);
        if (depth - there > out.phantom) {
          out.phantom = depth - there;
          std::ostringstream text;
          text << "step " << step + stride << " world " << w << " body " << contact.body_b.index()
               << " reports " << depth << " m at " << contact.point.transpose() << " along "
               << contact.normal.transpose() << ", there are " << there;
          out.worst = text.str();
        }
        ++out.contacts;
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("rough ground reports no overlap that is not there", "[slow][field][terrain]") {
  for (const Table& table : widest_tables()) {
    for (const char* scene : {"hills", "pebbles"}) {
      const Excess excess = excess_of(scene, table, 4, 600, 5);
      INFO(name(table) << " " << scene << ", deepest " << excess.deepest << " m; " << excess.worst);
      CHECK(excess.contacts > 1000);
      CHECK(excess.phantom < 2 * kSlack);
    }
  }
}

}  // namespace manyworlds::test
