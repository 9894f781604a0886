// How stiff contacts have to be for what stands at the start of a scene. Each contact point is a
// spring of m w^2 along its normal, with the effective mass m of its row; friction holds, as
// stiffer springs. With the stiffness matrix K for w = 1 and the weights f, bodies are displaced by
// u / w^2 with K u = f, where only points under pressure count. What stands leans once
//   w^2 K + B  is not positive definite,  B = sum over contacts of (r . F) I - sym(r F^T)
// on the rotations of each body: the force F of a contact at r from the centre of mass does work of
// second order when the body rotates. A body of weight W whose centre of mass is c above its
// contact has B = -W c, an inverted pendulum. What is indefinite however stiff contacts are, as a
// ball on a ball, is no matter of substeps.
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "src/plan/contact_springs.hpp"
#include "src/plan/substeps.hpp"

namespace manyworlds {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kMostSag = 0.01;    // of the height; aside of a body's size
constexpr double kMostSizes = 2;     // of a body, that count as height
constexpr double kMostLoad = 0.3;    // of that at which it leans
constexpr double kFixedStiffer = 4;  // against fixed shapes the square of w is so much more
constexpr double kFriction = 100;    // times the stiffness along the normal
constexpr double kHeld = 1e-11;      // of its mass w^2 holds what nothing else holds
constexpr double kNeutral = 1e-3;    // of its weight by its length holds what no load upsets
constexpr double kMostHeld = 0.01;   // of gravity: more would fall
constexpr double kAlways = 4;        // times the w of the most substeps: as stiff as can be
constexpr double kNoChange = 1e-7;   // of the largest displacement
constexpr double kShare = 0.3;       // of the largest motion: less may go back by itself
constexpr int kRounds = 30;          // of points that come under pressure or lose it

class Estimate {
 public:
  Estimate(const Scene& scene, const ContactSprings& springs)
      : scene_(scene), springs_(springs), dofs_(springs.dofs) {
    for (const ContactRows& c : springs.contacts) {
      pressed_.insert(pressed_.end(), c.points.size(), true);
    }
  }

  // Finds the displacements. Whether it stands: otherwise no stiffness holds it.
  bool settle() {
    const double most = kMostHeld * scene_.options.gravity.norm() / kHeld;
    for (int round = 0; round < kRounds; ++round) {
      assemble_stiffness();
      const Eigen::SimplicialLDLT<Matrix> factors(stiffness_);
      if (factors.info() != Eigen::Success) return false;
      displaced_ = factors.solve(load_);
      const bool stands = displaced_.cwiseAbs().maxCoeff() < most;
      if (round == 0 && !stands) return false;
      if (update_pressed(stands)) continue;
      if (stands) assemble_geometric();
      return stands;
    }
    return false;
  }

  // Calls want(w^2, body, whether it moves aside or rotates): of its height a body may sink by a
  // share, aside it may move by the same share of its size.
  template <class Want>
  void deform(Want want) const {
    const Vec3 down = scene_.options.gravity.normalized();
    double foot = -1e300;
    for (const ContactRows& c : springs_.contacts) {
      if (c.touching->a >= 0) continue;
      for (const ContactSpring& s : c.points) foot = std::max(foot, down.dot(s.place));
    }
    for (std::size_t i = 0; i < springs_.bodies.size(); ++i) {
      const StandingBody& b = *springs_.bodies[i];
      const int across = springs_.planar ? 2 : 3;
      Vec3 moved = Vec3::Zero();
      for (int k = 0; k < across; ++k) moved[k] = displaced_(first_of(i) + k);
      const double sunk = down.dot(moved);
      const double height = std::min(foot - down.dot(b.top), kMostSizes * b.size);
      const double turned = displaced_.segment(first_of(i) + across, dofs_ - across).norm();
      if (height > 0) want(sunk / (kMostSag * height), b.body, false);
      want(std::max((moved - sunk * down).norm(), turned) / (kMostSag * b.size), b.body, true);
    }
  }

  // In how many ways it leans at w.
  int unstable(double w) const {
    const Matrix sum = w * w * stiffness_ + geometric_ / kMostLoad + neutral_;
    const Eigen::SimplicialLDLT<Matrix> factors(sum);
    if (factors.info() != Eigen::Success) return 0;
    return static_cast<int>((factors.vectorD().array() < 0).count());
  }

 private:
  // Releases the points that open most, and takes back those that close most; releases none where
  // too many have been. Whether any changed.
  bool update_pressed(bool stands) {
    std::vector<double> opening;
    double opens = 0, closes = 0;
    for (const ContactRows& c : springs_.contacts) {
      for (const ContactSpring& s : c.points) {
        const bool pressed = pressed_[opening.size()];
        opening.push_back(change(s));
        if (pressed) opens = std::max(opens, opening.back());
        if (!pressed) closes = std::max(closes, -opening.back());
      }
    }
    const double none = kNoChange * displaced_.cwiseAbs().maxCoeff();
    bool changed = false;
    for (std::size_t i = 0; i < opening.size(); ++i) {
      const bool change = pressed_[i] ? stands && opening[i] >= std::max(-none, kShare * opens)
                                      : -opening[i] > std::max(none, kShare * closes);
      if (change) pressed_[i] = !pressed_[i];
      changed = changed || change;
    }
    return changed;
  }

  Eigen::Index first_of(std::size_t body) const { return static_cast<Eigen::Index>(body) * dofs_; }
  double change(const ContactSpring& s) const { return s.change(displaced_.data(), dofs_); }
  static double stiffness_of(const ContactRows& c, const ContactSpring& s) {
    return s.mass * (c.touching->fixed ? kFixedStiffer : 1);
  }

  // The springs of a contact under pressure, with the coordinates of A before those of B.
  using Block = Eigen::Matrix<double, 12, 12>;
  void add(const ContactSpring& s, double stiffness, Block& block) const {
    Eigen::Matrix<double, 12, 1> row = Eigen::Matrix<double, 12, 1>::Zero();
    for (int k = 0; k < dofs_; ++k) row(k) = s.of_a[k], row(6 + k) = s.of_b[k];
    block.noalias() += stiffness * row * row.transpose();
  }
  void put(const ContactSpring& s, const Block& block, Triplets& entries) const {
    for (const auto& [row, i] : {std::pair(s.a, 0), std::pair(s.b, 6)}) {
      for (const auto& [column, j] : {std::pair(s.a, 0), std::pair(s.b, 6)}) {
        if (row < 0 || column < 0) continue;
        for (int k = 0; k < dofs_ * dofs_; ++k) {
          const int m = k / dofs_, n = k % dofs_;
          entries.emplace_back(row * dofs_ + m, column * dofs_ + n, block(i + m, j + n));
        }
      }
    }
  }

  void assemble_stiffness() {
    const auto n = static_cast<Eigen::Index>(springs_.coordinates());
    Triplets entries;
    std::size_t point = 0;
    for (const ContactRows& c : springs_.contacts) {
      bool holds = false;
      Block block = Block::Zero();
      for (const ContactSpring& s : c.points) {
        if (!pressed_[point++]) continue;
        holds = true;
        add(s, stiffness_of(c, s), block);
      }
      if (!holds) continue;
      for (const ContactSpring& s : c.friction) add(s, kFriction * stiffness_of(c, s), block);
      put(c.points[0], block, entries);
    }
    load_ = Vector::Zero(n);
    for (std::size_t i = 0; i < springs_.bodies.size(); ++i) {
      const StandingBody& b = *springs_.bodies[i];
      const int first = static_cast<int>(first_of(i));
      for (int k = 0; k < dofs_; ++k) entries.emplace_back(first + k, first + k, kHeld * b.mass);
      for (int k = 0; k < (springs_.planar ? 2 : 3); ++k) {
        load_(first + k) = b.mass * b.gravity_scale * scene_.options.gravity[k];
      }
    }
    stiffness_.resize(n, n);
    stiffness_.setFromTriplets(entries.begin(), entries.end());
  }

  // What a force at a place of a body adds to B. The body frame's coordinates are rotations times
  // its length.
  void act(int body, const Vec3& place, const Vec3& force, Triplets& entries) const {
    if (body < 0) return;
    const auto i = static_cast<std::size_t>(body);
    const Vec3 r = place - springs_.bodies[i]->center;
    const double scale = 1 / (springs_.lengths[i] * springs_.lengths[i]);
    const int first = body * dofs_;
    if (springs_.planar) {
      entries.emplace_back(first + 2, first + 2, scale * r.dot(force));
      return;
    }
    const Mat3 b =
        r.dot(force) * Mat3::Identity() - 0.5 * (r * force.transpose() + force * r.transpose());
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(first + 3 + j, first + 3 + k, scale * b(j, k));
      }
    }
  }

  void assemble_geometric() {
    const auto n = static_cast<Eigen::Index>(springs_.coordinates());
    Triplets entries;
    std::size_t point = 0;
    for (const ContactRows& c : springs_.contacts) {
      const Vec3 to_a = -c.touching->round_a * c.touching->normal,
                 to_b = c.touching->round_b * c.touching->normal;
      const auto press = [&](const ContactSpring& s, double stiffness) {
        const Vec3 force = -stiffness * change(s) * s.way;
        act(s.b, s.place + to_b, force, entries);
        act(s.a, s.place + to_a, -force, entries);
      };
      bool holds = false;
      for (const ContactSpring& s : c.points) {
        if (!pressed_[point++]) continue;
        holds = true;
        press(s, stiffness_of(c, s));
      }
      if (!holds) continue;
      for (const ContactSpring& s : c.friction) press(s, kFriction * stiffness_of(c, s));
    }
    geometric_.resize(n, n);
    geometric_.setFromTriplets(entries.begin(), entries.end());
    entries.clear();
    for (std::size_t i = 0; i < springs_.bodies.size(); ++i) {
      const double weight = springs_.bodies[i]->mass * scene_.options.gravity.norm();
      for (int k = 0; k < dofs_; ++k) {
        const Eigen::Index at = first_of(i) + k;
        entries.emplace_back(at, at, kNeutral * weight / springs_.lengths[i]);
      }
    }
    neutral_.resize(n, n);
    neutral_.setFromTriplets(entries.begin(), entries.end());
  }

  const Scene& scene_;
  const ContactSprings& springs_;
  int dofs_;
  std::vector<bool> pressed_;  // points, in the order of the contacts
  Matrix stiffness_, geometric_;
  Matrix neutral_;  // keeps rounding from deciding which way a ball leans
  Vector load_, displaced_;
};

// Larger groups would take long. Rows of bodies take a time that grows with their length, others
// with up to the third power of their number.
bool is_too_large(const ContactSprings& group) {
  constexpr std::size_t kMostCoordinates = 600, kMostOfRows = 6000;
  const std::size_t bodies = group.bodies.size();
  const bool row = group.contacts.size() <= bodies + bodies / 8;
  return group.coordinates() > (row ? kMostOfRows : kMostCoordinates);
}

}  // namespace

StandingNeed need_of_standing_bodies(const Scene& scene) {
  StandingNeed out;
  if (scene.options.gravity.isZero(0)) return out;
  const StandingScene standing = standing_scene(scene);
  for (const ContactSprings& springs : standing.groups) {
    out.depth = std::max(out.depth, depth_of(springs));
  }
  const double share = contact_share(out.depth);
  const double unit = 2 * std::numbers::pi * share / scene.options.dt;  // w of a substep
  for (const ContactSprings& springs : standing.groups) {
    if (is_too_large(springs)) continue;
    Estimate estimate(scene, springs);
    if (!estimate.settle()) continue;
    const int count = static_cast<int>(springs.bodies.size());
    if (count > 1) {
      estimate.deform([&](double w2, int body, bool leans) {
        if (w2 > out.w * out.w) out = {out.depth, std::sqrt(w2), count, BodyId(body), leans};
      });
    }
    double low = std::max(unit * kLeastSubsteps, out.w), high = unit * kMostSubsteps;
    const int always = estimate.unstable(kAlways * high);
    if (low >= high || estimate.unstable(low) <= always) continue;
    while (high / low > 1.02) {
      const double middle = std::sqrt(low * high);
      (estimate.unstable(middle) > always ? low : high) = middle;
    }
    out = {out.depth, high, count, highest_of(scene, springs), true};
  }
  return out;
}

}  // namespace manyworlds
