// Maps of directions: what they list is what can be farthest.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "kernels/data/pose_rows.hpp"
#include "src/plan/hull_map.hpp"
#include "src/plan/plan_data.hpp"
#include "src/scene/shape/traits.hpp"
#include "tests/support/large_hulls.hpp"

namespace manyworlds::test {
namespace {

constexpr int kCells = kernels::kMapCells;

// The numbers of the cells that a direction may be in: more than one on the lines between them.
std::vector<int> cells_of(const Vec3& way) {
  std::vector<int> out;
  const double largest = way.cwiseAbs().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(way[axis]) < largest) continue;
    const auto places = [&](int component) {
      const double at = (way[component] / largest + 1) * kCells / 2;
      const int low = std::clamp(static_cast<int>(std::floor(at - 1e-6)), 0, kCells - 1);
      const int high = std::clamp(static_cast<int>(std::floor(at + 1e-6)), 0, kCells - 1);
      return low == high ? std::vector<int>{low} : std::vector<int>{low, high};
    };
    for (const int j : places((axis + 2) % 3)) {
      for (const int i : places((axis + 1) % 3)) {
        out.push_back(((2 * axis + (way[axis] < 0 ? 1 : 0)) * kCells + j) * kCells + i);
      }
    }
  }
  return out;
}
std::vector<int> listed(const std::vector<double>& map, int cell) {
  const auto at = static_cast<std::size_t>(2 * cell);
  const auto first = map.begin() + 2 * 6 * kCells * kCells + static_cast<int>(map[at]);
  return {first, first + static_cast<int>(map[at + 1])};
}
// At random, along axes, diagonals and the lines between cells.
std::vector<Vec3> directions_to_try(Random& random) {
  std::vector<Vec3> out;
  for (int i = 0; i < 2000; ++i) out.push_back(random.direction());
  for (int i = 0; i < 1000; ++i) {
    Vec3 way;
    for (int c = 0; c < 3; ++c) way[c] = random.integer(-8, 8) / 8.0;
    way[random.integer(0, 2)] = random.chance(0.5) ? 1 : -1;
    out.push_back(way);
  }
  return out;
}

}  // namespace

TEST_CASE("a map of directions lists all that is within a margin of the farthest, in order",
          "[fast][collide]") {
  Random random(7);
  for (const int count : {65, 400}) {
    for (int kind = 0; kind < kLargeHulls; ++kind) {
      const std::vector<Vec3> points = large_hull(kind, count, random).vertices;
      const double margin = random.chance(0.5) ? 4e-6 : 2e-3;
      const std::vector<double> map = direction_map(points, margin);
      INFO("kind " << kind << ", " << points.size() << " points, margin " << margin);
      REQUIRE(map.size() % 4 == 0);
      int missing = 0, unordered = 0;
      for (const Vec3& way : directions_to_try(random)) {
        std::vector<double> along;
        for (const Vec3& p : points) along.push_back(p.dot(way));
        const double farthest = *std::max_element(along.begin(), along.end());
        // The margin holds for directions whose largest component is 1.
        const double least = farthest - margin * way.cwiseAbs().maxCoeff();
        for (const int cell : cells_of(way)) {
          const std::vector<int> list = listed(map, cell);
          unordered += !std::is_sorted(list.begin(), list.end());
          for (std::size_t i = 0; i < points.size(); ++i) {
            if (along[i] <= least) continue;
            missing += !std::binary_search(list.begin(), list.end(), static_cast<int>(i));
          }
        }
      }
      CHECK(missing == 0);
      CHECK(unordered == 0);
    }
  }
}

TEST_CASE("a hull that is stretched has the same table", "[fast][collide]") {
  Random random(11);
  for (const int corners : {12, 70, 150}) {
    for (int kind = 0; kind < kLargeHulls; ++kind) {
      const Hull hull = large_hull(kind, corners, random);
      Geometry stretched = hull;
      for (int c = 0; c < 3; ++c) {
        traits_of(stretched).resize(stretched, c, random.log_uniform(0.02, 2));
      }
      INFO("kind " << kind << ", " << corners << " corners");
      CHECK(hull_corners(hull, true).rows == hull_corners(std::get<Hull>(stretched), true).rows);
    }
  }
}

TEST_CASE("lists of a map are short", "[fast][collide]") {
  Random random(8);
  const std::vector<Vec3> points = large_hull(0, 2000, random).vertices;
  const std::vector<double> map = direction_map(points, 4e-6);
  double sum = 0;
  for (int cell = 0; cell < 6 * kCells * kCells; ++cell) {
    sum += static_cast<double>(listed(map, cell).size());
  }
  CHECK(sum / (6 * kCells * kCells) < 16);
}

}  // namespace manyworlds::test
