// Checks that the joints of a scene with Solver::newton make trees, and that its bodies begin in
// them.
#include <algorithm>
#include <cmath>

#include "src/scene/checks.hpp"
#include "src/scene/length_unit.hpp"

namespace manyworlds::detail {
namespace {

constexpr double kGap =
    1e-6;  // m per checked_unit, and rad: how exactly bodies begin in their joints

class TreeChecker {
 public:
  TreeChecker(Checker checker, const Scene& scene) : all_(std::move(checker)), scene_(scene) {}

  // Joints whose A and B are bodies: the others have an issue already.
  void run() {
    const std::size_t before = all_.count();
    const int bodies = static_cast<int>(scene_.bodies.size());
    std::vector<int> first(scene_.bodies.size(), -1), last(scene_.bodies.size(), -1);
    std::vector<bool> has_ball(scene_.bodies.size(), false);
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
      const Joint& joint = scene_.joints[i];
      if (!is_body(joint.body_b) || joint.body_a.index() >= bodies) return;
      Checker at = all_.at(named_part("joint", i, joint.name));
      const auto b = static_cast<std::size_t>(joint.body_b.index());
      if (scene_.bodies[b].motion != Motion::dynamic) {
        at.add("body_b",
               "is not dynamic, the newton solver needs a dynamic body there: exchange A and B");
        continue;
      }
      const int index = static_cast<int>(i);
      if (joint.after) {
        const bool good = joint.after.index() == last[b] && last[b] >= 0 &&
                          scene_.at(joint.after).body_a == joint.body_a;
        if (!good) {
          at.add("after", "is " + std::to_string(joint.after.index()) +
                              ", must be the last joint before this one that has the same A and B");
        } else if (turns(joint) && has_ball[b]) {
          // Whose velocity is about the link's axes, which must then be the ball's own.
          at.add("after", "is " + std::to_string(joint.after.index()) +
                              ", which follows a ball joint: after a ball joint in a series, the "
                              "newton solver supports sliders only");
        }
      } else if (first[b] >= 0) {
        at.add("body_b", "is " + std::to_string(joint.body_b.index()) + ", which joint " +
                             std::to_string(first[b]) +
                             " holds already: the newton solver supports trees, or a series of "
                             "joints by Joint::after");
      }
      has_ball[b] = has_ball[b] || std::holds_alternative<BallJoint>(joint.type);
      if (first[b] < 0) first[b] = index;
      last[b] = index;
    }
    if (all_.count() > before) return;
    check_circles(first);
    if (all_.count() > before) return;
    check_size(first);
    for (std::size_t b = 0; b < first.size(); ++b) {
      if (first[b] >= 0) check_start(static_cast<std::size_t>(first[b]), first[b] == last[b]);
    }
  }

 private:
  bool is_body(BodyId id) const {
    return 0 <= id.index() && static_cast<std::size_t>(id.index()) < scene_.bodies.size();
  }
  static bool turns(const Joint& joint) {
    return std::holds_alternative<BallJoint>(joint.type) ||
           std::holds_alternative<HingeJoint>(joint.type);
  }
  void check_size(const std::vector<int>& first) {
    int dofs = 0;
    for (std::size_t b = 0; b < first.size(); ++b) {
      if (first[b] < 0 && scene_.bodies[b].motion == Motion::dynamic) dofs += 6;
    }
    for (const Joint& joint : scene_.joints) {
      dofs += std::holds_alternative<BallJoint>(joint.type)    ? 3
              : std::holds_alternative<FixedJoint>(joint.type) ? 0
                                                               : 1;
    }
    const auto links = std::count_if(scene_.bodies.begin(), scene_.bodies.end(),
                                     [](const Body& b) { return b.motion == Motion::dynamic; });
    if (links > kMaxNewtonLinks) {
      all_.add("bodies", "that move are " + std::to_string(links) +
                             ", the newton solver supports at most " +
                             std::to_string(kMaxNewtonLinks) + " yet");
    }
    if (dofs <= kMaxNewtonDofs) return;
    all_.add("bodies", "and joints have " + std::to_string(dofs) +
                           " degrees of freedom, the newton solver supports at most " +
                           std::to_string(kMaxNewtonDofs) + " yet");
  }
  // Of each circle one body is named.
  void check_circles(const std::vector<int>& first) {
    std::vector<std::size_t> seen_from(first.size(), first.size());
    for (std::size_t b = 0; b < first.size(); ++b) {
      std::size_t at = b;
      while (first[at] >= 0 && seen_from[at] == first.size()) {
        seen_from[at] = b;
        const BodyId a = scene_.joints[static_cast<std::size_t>(first[at])].body_a;
        if (!a) break;
        at = static_cast<std::size_t>(a.index());
        if (seen_from[at] != b) continue;
        Checker checker = all_.at(named_part("body", at, scene_.bodies[at].name));
        checker.add("joints", "form a loop through it, the newton solver supports trees only");
      }
    }
  }
  // Bodies begin as their joint allows, and those of a series where its frames coincide.
  void check_start(std::size_t first, bool alone) {
    const Joint& joint = scene_.joints[first];
    struct Pose {
      Vec3 x;
      Quat q;
    };
    const auto pose = [&](BodyId body, const Frame& frame) {
      const Frame at = frame_in_world(scene_, body, frame);
      return Pose{at.position, at.rotation};
    };
    const auto times = [](const Pose& a, const Pose& b) {
      return Pose{a.x + a.q * b.x, a.q * b.q};
    };
    const auto inverse = [](const Pose& a) {
      const Quat back = a.q.conjugate();
      return Pose{back * -a.x, back};
    };
    const auto local = [](const Frame& f) { return Pose{f.position, f.rotation.normalized()}; };
    Pose gap;  // of B against where its joints hold it
    if (alone) {
      gap = times(inverse(pose(joint.body_a, joint.frame_a)), pose(joint.body_b, joint.frame_b));
      if (std::holds_alternative<BallJoint>(joint.type)) gap.q = Quat::Identity();
      if (std::holds_alternative<HingeJoint>(joint.type)) {
        // How far z of B leans from z of A.
        gap.q = Quat(std::hypot(gap.q.w(), gap.q.z()), std::hypot(gap.q.x(), gap.q.y()), 0, 0);
      }
      if (std::holds_alternative<SliderJoint>(joint.type)) gap.x.x() = 0;
    } else {
      Pose at = times(pose(joint.body_a, joint.frame_a), inverse(local(joint.frame_b)));
      for (std::size_t i = first + 1; i < scene_.joints.size(); ++i) {
        const Joint& next = scene_.joints[i];
        if (next.body_b != joint.body_b) continue;
        at = times(times(at, local(next.frame_a)), inverse(local(next.frame_b)));
      }
      gap = times(inverse(at), pose(joint.body_b, Frame{}));
    }
    const double distance = gap.x.norm(), angle = 2 * std::asin(std::min(1.0, gap.q.vec().norm()));
    if (distance <= kGap * checked_unit(scene_.options) && angle <= kGap) return;
    const auto b = static_cast<std::size_t>(joint.body_b.index());
    Checker at = all_.at(named_part("body", b, scene_.bodies[b].name));
    at.add("position", "and rotation are " + number_text(distance) + " m and " +
                           number_text(angle) + " rad from the pose that joint " +
                           std::to_string(first) +
                           (alone ? " gives it" : "'s series gives it with coinciding frames") +
                           ", must match it for the newton solver");
  }

  Checker all_;
  const Scene& scene_;
};

}  // namespace

void check_trees(Checker checker, const Scene& scene) {
  TreeChecker(std::move(checker), scene).run();
}

}  // namespace manyworlds::detail
