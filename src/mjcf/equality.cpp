#include "src/mjcf/equality.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {
namespace {

// Of eq_data: a connect has the anchor in body 1 and in body 2; a weld has the anchor in body 2,
// then the pose that it holds this anchor at in body 1, and the weight of the angle.
constexpr int kConnectAnchor1 = 0, kConnectAnchor2 = 3;
constexpr int kWeldAnchor2 = 0, kWeldPosition1 = 3, kWeldRotation1 = 6, kWeldTorqueScale = 10;

// s, for joints that begin apart: about what MuJoCo's default solref takes. As stiff as joints are
// they would shoot.
constexpr double kClosingTime = 0.1;

// One of the two that an equality holds together, and the frame on it.
struct End {
  int body = 0;
  Pose frame;  // in the body
};

bool is_weld(const mjModel& m, int e) { return m.eq_type[e] == mjEQ_WELD; }

std::pair<End, End> ends_of(const mjModel& m, int e) {
  const int id1 = m.eq_obj1id[e], id2 = m.eq_obj2id[e];
  if (m.eq_objtype[e] == mjOBJ_SITE) {
    const auto at_site = [&](int site) {
      return End{m.site_bodyid[site], {vec3(m.site_pos + 3 * site), quat(m.site_quat + 4 * site)}};
    };
    return {at_site(id1), at_site(id2)};
  }
  const mjtNum* data = m.eq_data + mjNEQDATA * e;
  if (is_weld(m, e)) {
    return {{id1, {vec3(data + kWeldPosition1), quat(data + kWeldRotation1)}},
            {id2, {vec3(data + kWeldAnchor2), Quat::Identity()}}};
  }
  return {{id1, {vec3(data + kConnectAnchor1), Quat::Identity()}},
          {id2, {vec3(data + kConnectAnchor2), Quat::Identity()}}};
}

// The same on the body that this one is part of.
End on_root(const mjModel& m, const End& end) {
  return {m.body_weldid[end.body], pose_in_root(m, end.body) * end.frame};
}

// A weld without angular weight holds a point only.
bool holds_rotation(const mjModel& m, int e) {
  return is_weld(m, e) && m.eq_data[mjNEQDATA * e + kWeldTorqueScale] != 0;
}

bool equalities_enabled(const mjModel& m) {
  return (m.opt.disableflags & (mjDSBL_EQUALITY | mjDSBL_CONSTRAINT)) == 0;
}

bool has_effect(const mjModel& m, int e) {
  const auto [end1, end2] = ends_of(m, e);
  return m.body_weldid[end1.body] != m.body_weldid[end2.body];
}

bool is_joint(const mjModel& m, int e) { return m.eq_active0[e] != 0 && has_effect(m, e); }

// How far apart, m, and at which angle to each other, rad, the ends of a joint begin.
struct Gap {
  double length = 0, angle = 0;
};

Gap gap_of(const mjModel& m, int e) {
  const auto in_world = [&](const End& end) {
    const auto [root, frame] = on_root(m, end);
    if (root == 0) return frame;
    return Pose{vec3(m.body_pos + 3 * root), quat(m.body_quat + 4 * root)} * frame;
  };
  const auto [end1, end2] = ends_of(m, e);
  const Pose a = in_world(end1), b = in_world(end2);
  Gap gap;
  gap.length = (a.position - b.position).norm();
  if (holds_rotation(m, e)) {
    gap.angle = a.rotation.normalized().angularDistance(b.rotation.normalized());
  }
  return gap;
}

// The largest of the joints; zero where that is less than a hundredth of the mean size of bodies.
Gap largest_gap(const mjModel& m) {
  Gap most;
  for (int e = 0; e < m.neq; ++e) {
    if (!is_joint(m, e)) continue;
    const Gap gap = gap_of(m, e);
    most = {std::max(most.length, gap.length), std::max(most.angle, gap.angle)};
  }
  if (most.length < 0.01 * m.stat.meansize) most.length = 0;
  if (most.angle < 0.01) most.angle = 0;
  return most;
}

// In the order of their numbers.
using Bodies = std::pair<int, int>;

Bodies joined(const mjModel& m, int e) {
  const auto [end1, end2] = ends_of(m, e);
  return std::minmax({m.body_weldid[end1.body], m.body_weldid[end2.body]});
}

// Whether nothing else that is welded to the body, or that it is welded to, can collide.
bool collides_alone(const Model& model, int body) {
  const mjModel& m = *model.compiled;
  for (int g = 0; g < m.ngeom; ++g) {
    const int owner = m.geom_bodyid[g];
    if (owner != body && m.body_weldid[owner] == m.body_weldid[body] && model.collides(g)) {
      return false;
    }
  }
  return true;
}

// The free bodies that do not collide with each other; {0, 0} if there is no saying so of whole
// ones.
Bodies excluded(const Model& model, int exclude) {
  const mjModel& m = *model.compiled;
  const int body1 = m.exclude_signature[exclude] >> 16;
  const int body2 = m.exclude_signature[exclude] & 0xffff;
  const Bodies roots = std::minmax({m.body_weldid[body1], m.body_weldid[body2]});
  const bool whole =
      roots.first != 0 && collides_alone(model, body1) && collides_alone(model, body2);
  return whole ? roots : Bodies{0, 0};
}

bool any_exclude(const Model& model, const Bodies& bodies) {
  for (int x = 0; x < model.compiled->nexclude; ++x) {
    if (excluded(model, x) == bodies) return true;
  }
  return false;
}

const char* type_name(int type) {
  switch (type) {
    case mjEQ_CONNECT: return "a connect";
    case mjEQ_WELD: return "a weld";
    case mjEQ_JOINT: return "a joint equality";
    case mjEQ_TENDON: return "a tendon equality";
    case mjEQ_FLEX:
    case mjEQ_FLEXVERT:
    case mjEQ_FLEXSTRAIN: return "a flex equality";
    default: return "an equality of unknown type";
  }
}

}  // namespace

void check_equalities(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  for (int e = 0; e < m.neq; ++e) {
    const bool joins = m.eq_type[e] == mjEQ_CONNECT || m.eq_type[e] == mjEQ_WELD;
    if (model.articulated) {
      if (!equalities_enabled(m) || m.eq_active0[e] == 0 || (joins && !has_effect(m, e))) continue;
      problems.push_back(model.equality_place(e) + ": is " + type_name(m.eq_type[e]) +
                         ", which is not simulated with joints yet; expected none");
      continue;
    }
    if (joins) continue;
    problems.push_back(model.equality_place(e) + ": is " + type_name(m.eq_type[e]) +
                       ", which is not simulated yet; expected connect or weld");
  }
}

void compare_equalities(const Model& model, std::vector<std::string>& warnings) {
  const mjModel& m = *model.compiled;
  if (!equalities_enabled(m)) return;
  mjsEquality defaults;
  mjs_defaultEquality(&defaults);

  const auto warn_where = [&](const std::string& what, auto differs) {
    int first = -1, count = 0;
    for (int e = 0; e < m.neq; ++e) {
      if (differs(e) && count++ == 0) first = e;
    }
    if (count == 0) return;
    std::string text = model.equality_place(first);
    if (count > 1) text += " and " + std::to_string(count - 1) + " more";
    warnings.push_back(text + ": " + what);
  };
  if (const Gap gap = largest_gap(m); gap.length > 0 || gap.angle > 0) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "equalities: start up to %.3g m and %.3g rad apart; joints close this gap in about %g s "
        "(JointOptions::pull_speed), MuJoCo at the rate of solref",
        gap.length, gap.angle, kClosingTime);
    warnings.emplace_back(text);
  }
  const std::string stiffness = " is ignored; joint stiffness follows JointOptions::frequency";

  warn_where("is inactive and left out; joints cannot be activated later",
             [&](int e) { return m.eq_active0[e] == 0; });
  warn_where("connects one body to itself or only static bodies, so it is left out",
             [&](int e) { return m.eq_active0[e] != 0 && !has_effect(m, e); });
  warn_where("solref" + stiffness, [&](int e) {
    return is_joint(m, e) &&
           !std::equal(m.eq_solref + mjNREF * e, m.eq_solref + mjNREF * (e + 1), defaults.solref);
  });
  warn_where("solimp" + stiffness, [&](int e) {
    return is_joint(m, e) &&
           !std::equal(m.eq_solimp + mjNIMP * e, m.eq_solimp + mjNIMP * (e + 1), defaults.solimp);
  });
  warn_where("torquescale" + stiffness, [&](int e) {
    return is_joint(m, e) && holds_rotation(m, e) &&
           m.eq_data[mjNEQDATA * e + kWeldTorqueScale] != 1;
  });
}

bool excludes_joined(const Model& model, int exclude) {
  const mjModel& m = *model.compiled;
  const Bodies bodies = excluded(model, exclude);
  if (bodies.first == 0 || !equalities_enabled(m)) return false;
  for (int e = 0; e < m.neq; ++e) {
    const bool known = m.eq_type[e] == mjEQ_CONNECT || m.eq_type[e] == mjEQ_WELD;
    if (known && is_joint(m, e) && joined(m, e) == bodies) return true;
  }
  return false;
}

void add_joints(const Model& model, const std::vector<BodyId>& scene_body, Scene& scene) {
  const mjModel& m = *model.compiled;
  if (!equalities_enabled(m)) return;
  for (int e = 0; e < m.neq; ++e) {
    if (!is_joint(m, e)) continue;
    const auto [end1, end2] = ends_of(m, e);
    End a = on_root(m, end1), b = on_root(m, end2);
    if (b.body == 0) std::swap(a, b);  // B has to move
    Joint joint;
    joint.name = model.name(mjOBJ_EQUALITY, e);
    if (holds_rotation(m, e)) {
      joint.type = FixedJoint{};
    } else {
      joint.type = BallJoint{};
    }
    joint.body_a = a.body == 0 ? BodyId() : scene_body[static_cast<std::size_t>(a.body)];
    joint.body_b = scene_body[static_cast<std::size_t>(b.body)];
    joint.frame_a = {a.frame.position, a.frame.rotation};
    joint.frame_b = {b.frame.position, b.frame.rotation};
    joint.collide = !any_exclude(model, joined(m, e));
    scene.add(std::move(joint));
  }
  if (const Gap gap = largest_gap(m); gap.length > 0 || gap.angle > 0) {
    scene.options.joint.pull_speed =
        std::max(gap.length / *scene.options.length_unit, gap.angle) / kClosingTime;
  }
}

}  // namespace manyworlds::mjcf
