// Columns: bodies that stand on one another where the scene begins, and how stiff their contacts
// have to be. A column sags by the sum of W / (k w^2) over its contacts, with what each carries, W,
// and the reduced mass k of its two bodies. It leans once the sum over its levels of
//   W c / (w^2 sum of k (x^2 + b^2))
// reaches 1, with the weight W above a level, its centre c over it, and the places x and half the
// widths b of the contacts there: each level alone is the foot of an inverted pendulum, and the sum
// is Southwell's bound. For N equal cubes of the size L that is 2 g / (w^2 L) = 1.5 / N^3;
// measured: 1.96.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/plan/substeps.hpp"
#include "src/scene/convex.hpp"

namespace manyworlds {

namespace {

constexpr double kMostSag = 0.01;    // of the height
constexpr double kMostLoad = 0.3;    // of that at which a column leans
constexpr double kNearby = 0.125;    // of the lower height: what is no farther above stands on it
constexpr double kFixedStiffer = 4;  // against fixed shapes the square of w is so much more

// Extents of a body in the frame of gravity: two axes across (planar: one), and up.
struct Block {
  int body = -1;
  double mass = 0, carried = 0;  // kg; with all that stands on it
  bool flat = true;              // stands on a face, not on a point
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  double height() const { return high.z() - low.z(); }
  double middle(int axis) const { return 0.5 * (low[axis] + high[axis]); }
};

struct Support {
  int below = -1, above = -1;  // blocks; -1: the ground
  double share = 1;            // of what the upper one carries
  double stiffness = 0;        // kg, over w^2
  double z = 0, place[2] = {}, half[2] = {};
};

Mat3 frame_of_gravity(const Scene& scene) {
  Mat3 axes;
  const Vec3 up = -scene.options.gravity.normalized();
  const Vec3 across = scene.space == Space::planar ? up.cross(Vec3::UnitZ()) : up.unitOrthogonal();
  axes.row(0) = across, axes.row(1) = up.cross(across), axes.row(2) = up;
  return axes;
}

std::vector<Block> blocks_of(const Scene& scene, const Mat3& axes) {
  std::vector<Block> out;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.motion != Motion::dynamic || !body.enabled) continue;
    Block block;
    block.body = static_cast<int>(i);
    for (const Shape& shape : body.shapes) {
      if (shape.filter.mask == 0) continue;
      for (const Convex& part : convex_parts(shape, {body.position, body.rotation}, scene.space)) {
        block.flat = block.flat && (part.radius == 0 || part.points.size() > 2);
        for (int k = 0; k < 3; ++k) {
          const Vec3 way = axes.row(k);
          block.high[k] = std::max(block.high[k], way.dot(part.support(way)) + part.radius);
          block.low[k] = std::min(block.low[k], way.dot(part.support(-way)) - part.radius);
        }
      }
    }
    if (block.high.z() < block.low.z()) continue;
    block.carried = block.mass = mass_properties(scene, body).mass;
    out.push_back(block);
  }
  std::sort(out.begin(), out.end(),
            [](const Block& a, const Block& b) { return a.low.z() < b.low.z(); });
  return out;
}

class Columns {
 public:
  explicit Columns(const Scene& scene)
      : axes_(scene.space == Space::planar ? 1 : 2),
        g_(scene.options.gravity.norm()),
        blocks_(blocks_of(scene, frame_of_gravity(scene))) {
    find_supports();
    load_supports();
  }

  ColumnNeed need() {
    ColumnNeed out;
    const auto want = [&](double w2, int top, int bodies, bool leans) {
      if (w2 <= out.w * out.w) return;
      out = {std::sqrt(w2), bodies, BodyId(blocks_[at(top)].body), leans};
    };
    sag([&](double w2, int top, int bodies) { want(w2, top, bodies, false); });
    lean([&](double w2, int top, int bodies) { want(w2, top, bodies, true); });
    return out;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  Support between(int below, int above) const {
    const Block &a = blocks_[at(below)], &b = blocks_[at(above)];
    Support out{below, above};
    out.z = b.low.z();
    out.stiffness = a.mass * b.mass / (a.mass + b.mass);
    for (int k = 0; k < axes_; ++k) {
      const double low = std::max(a.low[k], b.low[k]), high = std::min(a.high[k], b.high[k]);
      out.place[k] = 0.5 * (low + high), out.half[k] = 0.5 * (high - low);
    }
    return out;
  }
  Support on_ground(int block) const {
    const Block& b = blocks_[at(block)];
    Support out{-1, block};
    out.z = b.low.z();
    out.stiffness = kFixedStiffer * b.mass;
    for (int k = 0; k < axes_; ++k) {
      out.place[k] = b.middle(k), out.half[k] = 0.5 * (b.high[k] - b.low[k]);
    }
    return out;
  }

  // Ordered by the upper block.
  void find_supports() {
    const int count = static_cast<int>(blocks_.size());
    column_.resize(blocks_.size());
    std::iota(column_.begin(), column_.end(), 0);
    std::vector<int> by_top(column_);
    const auto top = [this](int i) { return blocks_[at(i)].high.z(); };
    std::sort(by_top.begin(), by_top.end(), [&](int a, int b) { return top(a) < top(b); });
    for (int j = 0; j < count; ++j) {
      const Block& b = blocks_[at(j)];
      const std::size_t first = supports_.size();
      double area = 0;
      const double nearby = kNearby * b.height();
      const auto begin = std::lower_bound(by_top.begin(), by_top.end(), b.low.z() - nearby,
                                          [&](int i, double z) { return top(i) < z; });
      for (auto it = begin; it != by_top.end() && top(*it) <= b.low.z() + nearby; ++it) {
        const int i = *it;
        if (i >= j) continue;
        const Block& a = blocks_[at(i)];
        const double gap = b.low.z() - a.high.z(), lower = std::min(a.height(), b.height());
        if (std::abs(gap) > kNearby * lower || b.middle(2) <= a.middle(2)) continue;
        Support s = between(i, j);
        s.share = 1;
        for (int k = 0; k < axes_; ++k) s.share *= 2 * std::max(s.half[k], 0.0);
        if (s.share <= 0) continue;
        if (!a.flat || !b.flat) s.half[0] = s.half[1] = 0;
        area += s.share;
        supports_.push_back(s);
        unite(i, j);
      }
      for (std::size_t k = first; k < supports_.size(); ++k) supports_[k].share /= area;
      if (supports_.size() == first) supports_.push_back(on_ground(j));
    }
  }
  void load_supports() {
    for (std::size_t i = supports_.size(); i-- > 0;) {
      const Support& s = supports_[i];
      if (s.below >= 0) blocks_[at(s.below)].carried += s.share * blocks_[at(s.above)].carried;
    }
  }

  int column_of(int i) const {
    while (column_[at(i)] != i) i = column_[at(i)];
    return i;
  }
  void unite(int a, int b) {
    a = column_of(a), b = column_of(b);
    column_[at(std::max(a, b))] = std::min(a, b);
  }

  // want(w^2, block, how many stand in its column)
  template <class Want>
  void sag(Want want) const {
    std::vector<double> sunk(blocks_.size(), 0);  // times w^2
    std::vector<int> under(blocks_.size(), 0);
    std::vector<double> foot(blocks_.size(), 0);
    for (const Support& s : supports_) {
      const double load = s.share * blocks_[at(s.above)].carried * g_;
      const double here = (s.below < 0 ? 0 : sunk[at(s.below)]) + load / s.stiffness;
      if (here < sunk[at(s.above)]) continue;
      sunk[at(s.above)] = here;
      under[at(s.above)] = 1 + (s.below < 0 ? 0 : under[at(s.below)]);
      foot[at(s.above)] = s.below < 0 ? s.z : foot[at(s.below)];
    }
    for (int i = 0; i < static_cast<int>(blocks_.size()); ++i) {
      const double height = blocks_[at(i)].high.z() - foot[at(i)];
      if (under[at(i)] > 1) want(sunk[at(i)] / (kMostSag * height), i, under[at(i)]);
    }
  }

  // want(w^2, block on top, how many there are in all)
  template <class Want>
  void lean(Want want) const {
    const int count = static_cast<int>(blocks_.size());
    std::vector<std::vector<int>> members(blocks_.size());
    for (int i = 0; i < count; ++i) members[at(column_of(i))].push_back(i);
    std::vector<std::vector<Support>> stands(blocks_.size());
    for (const Support& s : supports_) stands[at(column_of(s.above))].push_back(s);
    for (int c = 0; c < count; ++c) {
      const auto& all = members[at(c)];
      if (all.size() < 3) continue;
      int top = all.front();
      for (const int i : all) {
        if (blocks_[at(i)].high.z() > blocks_[at(top)].high.z()) top = i;
      }
      for (int k = 0; k < axes_; ++k) {
        const double load = pendulums(all, stands[at(c)], k) * g_;
        want(load / kMostLoad, top, static_cast<int>(all.size()));
      }
    }
  }

  // The sum over the levels, times w^2 / g. `all` from below, `contacts` anyhow.
  double pendulums(const std::vector<int>& all, std::vector<Support> contacts, int axis) const {
    std::sort(contacts.begin(), contacts.end(),
              [](const Support& a, const Support& b) { return a.z > b.z; });
    std::vector<int> from_above(all);
    std::sort(from_above.begin(), from_above.end(),
              [&](int a, int b) { return blocks_[at(a)].middle(2) > blocks_[at(b)].middle(2); });
    double out = 0, mass = 0, moment = 0;  // of what is above
    std::size_t next = 0;
    for (std::size_t i = 0; i < contacts.size();) {
      const double level = contacts[i].z;
      const double within = level - 0.25 * blocks_[at(contacts[i].above)].height();
      double sum = 0, first = 0, second = 0;
      for (; i < contacts.size() && contacts[i].z >= within; ++i) {
        const Support& s = contacts[i];
        const double k = s.stiffness, x = s.place[axis], b = s.half[axis];
        sum += k, first += k * x, second += k * (x * x + b * b);
      }
      for (; next < from_above.size(); ++next) {
        const Block& block = blocks_[at(from_above[next])];
        if (block.middle(2) < level) break;
        mass += block.mass, moment += block.mass * block.middle(2);
      }
      const double stiffness = second - first * first / sum;
      if (stiffness > 1e-9 * second) out += (moment - mass * level) / stiffness;
    }
    return out;
  }

  int axes_;
  double g_;
  std::vector<Block> blocks_;
  std::vector<Support> supports_;
  std::vector<int> column_;  // of each block the first one of its column, or on the way to it
};

}  // namespace

ColumnNeed need_of_columns(const Scene& scene) {
  if (scene.options.gravity.isZero(0)) return {};
  return Columns(scene).need();
}

}  // namespace manyworlds
