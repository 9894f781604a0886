#include "src/page/joints.hpp"

#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "src/page/numbers.hpp"

namespace manyworlds::page {
namespace {

const char* type_of(const JointType& type) {
  constexpr const char* kNames[] = {"ball",     "hinge", "slider", "fixed",
                                    "distance", "wheel", "pulley", "target"};
  static_assert(std::size(kNames) == std::variant_size_v<JointType>);
  return kNames[type.index()];
}

Json index_of(BodyId body) { return body ? Json(body.index()) : Json(); }

Json end_of(BodyId body, const Frame& frame) {
  return {{"body", index_of(body)},
          {"position", numbers(frame.position)},
          {"rotation", numbers(frame.rotation)}};
}

Vec3 place_of(const Scene& scene, BodyId body, const Frame& frame) {
  if (!body) return frame.position;
  const Body& at = scene.bodies[static_cast<std::size_t>(body.index())];
  return at.position + at.rotation.normalized() * frame.position;
}

void add_form(const Scene& scene, const Joint& joint, const DistanceJoint& type, Json& out) {
  const Vec3 between =
      place_of(scene, joint.body_b, joint.frame_b) - place_of(scene, joint.body_a, joint.frame_a);
  double length = type.length.value_or(between.norm());
  const char* form = "rod";
  if (type.spring) {
    form = "spring";
  } else if (type.limit) {
    const bool rope = type.limit->low <= 0 && std::isfinite(type.limit->high);
    form = rope ? "rope" : "telescope";
    if (rope) length = type.limit->high;
  }
  out["form"] = form, out["length"] = length;
}

Json range_of(const std::optional<Limit>& limit) {
  if (!limit || !std::isfinite(limit->low) || !std::isfinite(limit->high)) return {};
  return {limit->low, limit->high};
}

}  // namespace

Json joints_of(const Scene& scene) {
  std::vector<bool> goes_on(scene.joints.size());  // another one comes after it
  for (const Joint& joint : scene.joints) {
    if (joint.after) goes_on[static_cast<std::size_t>(joint.after.index())] = true;
  }
  Json out = Json::array();
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const Joint& joint = scene.joints[j];
    Json one = {{"name", joint.name},
                {"type", type_of(joint.type)},
                {"body_a", index_of(joint.body_a)},
                {"body_b", index_of(joint.body_b)},
                {"a", joint.after ? Json() : end_of(joint.body_a, joint.frame_a)},
                {"b", goes_on[j] ? Json() : end_of(joint.body_b, joint.frame_b)}};
    if (const auto* distance = std::get_if<DistanceJoint>(&joint.type)) {
      add_form(scene, joint, *distance, one);
    } else if (const auto* slider = std::get_if<SliderJoint>(&joint.type)) {
      one["range"] = range_of(slider->limit);
    } else if (const auto* wheel = std::get_if<WheelJoint>(&joint.type)) {
      one["range"] = range_of(wheel->travel);
    } else if (const auto* pulley = std::get_if<PulleyJoint>(&joint.type)) {
      one["grounds"] = {numbers(pulley->ground_a), numbers(pulley->ground_b)};
    }
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<Vec3> fixed_anchors(const Scene& scene) {
  std::vector<Vec3> out;
  for (const Joint& joint : scene.joints) {
    const auto* pulley = std::get_if<PulleyJoint>(&joint.type);
    if (pulley != nullptr) out.insert(out.end(), {pulley->ground_a, pulley->ground_b});
    if (pulley == nullptr && !std::holds_alternative<DistanceJoint>(joint.type)) continue;
    const auto add = [&](BodyId body, const Frame& frame) {
      const bool moves =
          body && scene.bodies[static_cast<std::size_t>(body.index())].motion != Motion::fixed;
      if (!moves) out.push_back(place_of(scene, body, frame));
    };
    add(joint.body_a, joint.frame_a), add(joint.body_b, joint.frame_b);
  }
  return out;
}

}  // namespace manyworlds::page
