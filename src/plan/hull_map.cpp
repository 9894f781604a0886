#include "src/plan/hull_map.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "kernels/data/pose_rows.hpp"
#include "src/base/remembered.hpp"

namespace manyworlds {

namespace {

constexpr int kCells = kernels::kMapCells;
// By which a cell is wider than its share, in which rounding may put a direction next to it.
constexpr double kWider = 1e-5;

// A square of directions on a face of the cube.
struct Square {
  int face = 0, i = 0, j = 0, parts = 1;  // of how many along each side
};

std::array<Vec3, 4> corners_of(const Square& s) {
  std::array<Vec3, 4> out;
  const int axis = s.face / 2;
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](int cell, bool high) {
      return -1 + 2.0 * (cell + (high ? 1 : 0)) / s.parts + (high ? kWider : -kWider);
    };
    Vec3& d = out[static_cast<std::size_t>(k)];
    d[axis] = s.face % 2 == 0 ? 1 : -1;
    d[(axis + 1) % 3] = at(s.i, (k & 1) != 0);
    d[(axis + 2) % 3] = at(s.j, (k & 2) != 0);
  }
  return out;
}

// The candidates that none beats by the margin at all four corners, and so anywhere between them.
std::vector<int> unbeaten(const std::vector<Vec3>& points, const std::vector<int>& candidates,
                          const Square& square, double margin) {
  const std::array<Vec3, 4> way = corners_of(square);
  std::vector<Eigen::Array4d> along;
  along.reserve(candidates.size());
  for (const int c : candidates) {
    const Vec3& p = points[static_cast<std::size_t>(c)];
    along.emplace_back(p.dot(way[0]), p.dot(way[1]), p.dot(way[2]), p.dot(way[3]));
  }
  const auto keep = [&](const std::vector<std::size_t>& all,
                        const std::vector<std::size_t>& rivals) {
    std::vector<std::size_t> out;
    for (const std::size_t a : all) {
      const bool beaten = std::any_of(rivals.begin(), rivals.end(), [&](std::size_t b) {
        return (along[a] + margin < along[b]).all();
      });
      if (!beaten) out.push_back(a);
    }
    return out;
  };
  std::vector<std::size_t> left(candidates.size()), best;
  for (std::size_t a = 0; a < left.size(); ++a) left[a] = a;
  const auto farthest = [&](auto&& value) {
    best.push_back(*std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
      return value(along[a]) < value(along[b]);
    }));
  };
  for (int k = 0; k < 4; ++k) farthest([k](const Eigen::Array4d& x) { return x[k]; });
  farthest([](const Eigen::Array4d& x) { return x.sum(); });
  left = keep(left, best);
  constexpr std::size_t kFew = 64;  // whose pairs are all looked at
  if (left.size() <= kFew) left = keep(left, left);
  std::vector<int> out;
  for (const std::size_t a : left) out.push_back(candidates[a]);
  return out;
}

// Halves a square until it is a cell, and with it the candidates.
struct Lists {
  std::vector<std::vector<int>> of_cell;
  std::size_t listed = 0;
  bool too_many() const { return listed > kMostListed * of_cell.size(); }
};
void fill(const std::vector<Vec3>& points, const std::vector<int>& candidates, const Square& square,
          double margin, Lists& lists) {
  if (lists.too_many()) return;
  const std::vector<int> left = unbeaten(points, candidates, square, margin);
  if (square.parts == kCells) {
    const int cell = (square.face * kCells + square.j) * kCells + square.i;
    lists.of_cell[static_cast<std::size_t>(cell)] = left;
    lists.listed += left.size();
    return;
  }
  for (int k = 0; k < 4; ++k) {
    fill(points, left,
         {square.face, 2 * square.i + (k & 1), 2 * square.j + (k >> 1), 2 * square.parts}, margin,
         lists);
  }
}

std::vector<double> make_map(const std::vector<Vec3>& points, double margin) {
  std::vector<int> all(points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  Lists lists{std::vector<std::vector<int>>(6 * kCells * kCells)};
  for (int face = 0; face < 6; ++face) fill(points, all, {face, 0, 0, 1}, margin, lists);
  if (lists.too_many()) return {};
  std::vector<double> cells, out;
  for (const std::vector<int>& list : lists.of_cell) {
    cells.insert(cells.end(), {static_cast<double>(out.size()), static_cast<double>(list.size())});
    out.insert(out.end(), list.begin(), list.end());
  }
  out.resize((out.size() + 3) / 4 * 4);
  out.insert(out.begin(), cells.begin(), cells.end());
  return out;
}

}  // namespace

std::vector<double> direction_map(const std::vector<Vec3>& points, double margin) {
  // Worlds whose numbers vary have the same hulls, stretched or not.
  static Remembered<Vec3, std::vector<double>> last(1 << 18);
  std::vector<Vec3> key = points;
  key.emplace_back(margin, 0, 0);
  return *last.get(key, [&] { return make_map(points, margin); });
}

}  // namespace manyworlds
