// The table of state fields, and what follows from it: the layout of the state, and the docs.
#include <catch2/catch.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include "manyworlds/batch.hpp"
#include "src/plan/state_layout.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

using kernels::Dimension;
using kernels::item_layout;

// Rows of the fields of an item, each where the one before it ends.
constexpr bool is_contiguous(Dimension d, bool has_orientation) {
  const kernels::ItemLayout at = item_layout(d, has_orientation);
  for (int kind = 0; kind < kItemKinds; ++kind) {
    for (int row = 0; row < at.stride[kind]; ++row) {
      int holders = 0;
      for (int f = 0; f < kFieldCount; ++f) {
        if (static_cast<int>(kFieldTable[f].item) != kind || at.row[f] < 0) continue;
        int components = 1;
        for (const char* c = d == Dimension::planar ? kFieldTable[f].planar
                                                    : kFieldTable[f].spatial;
             *c != 0; ++c) {
          components += *c == ' ' ? 1 : 0;
        }
        holders += row >= at.row[f] && row < at.row[f] + components ? 1 : 0;
      }
      if (holders != 1) return false;
    }
  }
  return true;
}
static_assert(is_contiguous(Dimension::planar, false) && is_contiguous(Dimension::planar, true));
static_assert(is_contiguous(Dimension::spatial, false) && is_contiguous(Dimension::spatial, true));
static_assert(std::size(kFieldTable) == kFieldCount && std::size(kFields) == kFieldCount);
// Snapshots and hashes of earlier versions have them so.
static_assert(kernels::kSpatialOffsets.position == 0 && kernels::kSpatialOffsets.linear == 3 &&
              kernels::kSpatialOffsets.angular == 6 && kernels::kSpatialOffsets.orientation == 9);
static_assert(kernels::kPlanarOffsets.position == 0 && kernels::kPlanarOffsets.linear == 2 &&
              kernels::kPlanarOffsets.angular == 4 && kernels::kPlanarOffsets.orientation == 5);
static_assert(written_field(write_of(Field::position)) == Field::position);
static_assert(write_of(Field::position) == Input::write_position);
static_assert(!is_write(Input::wake) && !is_write(Input::reset));

}  // namespace

TEST_CASE("the state of a world has the rows of its items, one kind after the other",
          "[fields][fast]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 10);
    for (int i = 0; i < 3; ++i) {
      scene.add(body_of(shape_of(box_of(space, {0.3, 0.2, 0.1})), Vec3(i, 0, 0)));
    }
    const Plan plan = compile(scene);
    const StateLayout layout = state_layout(plan.data());
    CHECK(plan.items(ItemKind::body) == 3);
    CHECK(plan.items(ItemKind::world) == 1);
    CHECK(plan.items(ItemKind::shape) == 3);
    CHECK(plan.items(ItemKind::coordinate) == 0);
    CHECK(plan.items(ItemKind::dof) == 0);
    CHECK(plan.items(ItemKind::particle) == 0);
    CHECK_THROWS_AS(plan.items(static_cast<ItemKind>(9)), std::invalid_argument);
    std::size_t numbers = 0;
    std::vector<int> rows;
    for (const Field field : kFields) {
      CHECK(layout.has(field));
      numbers += plan.numbers(field);
      for (int item = 0; item < plan.items(info(field).item); ++item) {
        for (int c = 0; c < components(field, space); ++c) {
          rows.push_back(layout.row_of(field, item) + c);
        }
      }
    }
    CHECK(numbers == static_cast<std::size_t>(layout.rows));
    std::sort(rows.begin(), rows.end());
    CHECK(std::adjacent_find(rows.begin(), rows.end()) == rows.end());
    CHECK(rows.front() == 0);
    CHECK(rows.back() == layout.rows - 1);
  }
}

TEST_CASE("the state of the newton solver has rows of coordinates and of dofs, one after the other",
          "[fields][fast][newton]") {
  Scene scene = empty_scene(Space::spatial, 10);
  scene.options.solver.method = Solver::newton;
  for (int i = 0; i < 3; ++i) scene.add(body_of(shape_of(Sphere{}), Vec3(i, 0, 0)));
  // A tree of a free root and a ball joint, and a free body.
  scene.add(joint_at(scene, BodyId(0), BodyId(1), {}, BallJoint{}));
  const Plan plan = compile(scene);
  CHECK(plan.items(ItemKind::body) == 3);
  CHECK(plan.items(ItemKind::coordinate) == 7 + 4 + 7);
  CHECK(plan.items(ItemKind::dof) == 6 + 3 + 6);
  CHECK(plan.first_coordinate(JointId(0)) == 7);
  const StateLayout layout = state_layout(plan.data());
  std::vector<int> rows;
  for (const Field field : kFields) {
    CHECK(layout.has(field));
    for (int item = 0; item < plan.items(info(field).item); ++item) {
      for (int c = 0; c < components(field, Space::spatial); ++c) {
        rows.push_back(layout.row_of(field, item) + c);
      }
    }
  }
  std::sort(rows.begin(), rows.end());
  CHECK(std::adjacent_find(rows.begin(), rows.end()) == rows.end());
  CHECK(rows.front() == 0);
  CHECK(rows.back() == layout.rows - 1);
  CHECK(layout.rows == 3 * 13 + 18 + 2 * 15);
}

TEST_CASE("a field that the plan leaves out moves no other of its item", "[fields][fast]") {
  Scene scene = empty_scene(Space::spatial, 10);
  scene.add(body_of(shape_of(Sphere{}), Vec3::Zero()));
  const Plan plan = compile(scene), whole = compile(scene, {.keep = {Feature::orientation}});
  const StateLayout layout = state_layout(plan.data()), all = state_layout(whole.data());
  CHECK_FALSE(layout.has(Field::orientation));
  CHECK(all.rows == layout.rows + 4);
  for (const Field field : kFields) {
    if (!layout.has(field)) continue;
    // Those of other items come after the body's.
    const int after = info(field).item == ItemKind::body ? 0 : 4;
    CHECK(layout.row_of(field, 0) + after == all.row_of(field, 0));
  }
}

TEST_CASE("docs/conventions.md lists the state fields as the table has them", "[fields][fast]") {
  std::ifstream file(std::string(kSourceFolder) + "/docs/conventions.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const Field field : kFields) {
    const FieldInfo& f = info(field);
    std::ostringstream row;
    row << "| `" << f.name << "` | " << to_string(f.item) << " | "
        << components(field, Space::planar) << " | " << components(field, Space::spatial) << " | "
        << f.unit << " | " << f.meaning << " | " << f.writer << " |";
    CAPTURE(row.str());
    CHECK(text.str().find(row.str()) != std::string::npos);
  }
}

}  // namespace manyworlds::test
