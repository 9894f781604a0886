// Ids of the bodies, shapes, joints, controls, tendons, sites and keyframes of a scene. Each has a
// separate type, so that the compiler rejects an id of another type or an array row. Fixed bodies
// are in the scene but have no row (Plan::row).
#pragma once

#include <compare>
#include <cstddef>
#include <functional>

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

template <class Of>
class Id {
 public:
  constexpr Id() = default;  // none; in a joint or frame: the world
  constexpr explicit Id(int index) : index_(index) {}
  constexpr int index() const { return index_; }  // in its list of the Scene; -1: none
  constexpr explicit operator bool() const { return index_ >= 0; }  // true unless none
  friend constexpr auto operator<=>(const Id&, const Id&) = default;

 private:
  int index_ = -1;
};
using BodyId = Id<struct BodyTag>;          // Scene::bodies
using JointId = Id<struct JointTag>;        // Scene::joints
using ControlId = Id<struct ControlTag>;    // Scene::controls
using TendonId = Id<struct TendonTag>;      // Scene::tendons
using SiteId = Id<struct SiteTag>;          // Scene::sites
using KeyframeId = Id<struct KeyframeTag>;  // Scene::keyframes

class ShapeId {
 public:
  constexpr ShapeId() = default;  // none
  constexpr ShapeId(BodyId body, int index) : body_(body), index_(index) {}
  constexpr BodyId body() const { return body_; }
  constexpr int index() const { return index_; }  // in Body::shapes; -1: none
  constexpr explicit operator bool() const { return index_ >= 0; }
  friend constexpr auto operator<=>(const ShapeId&, const ShapeId&) = default;

 private:
  BodyId body_;
  int index_ = -1;
};

}  // namespace manyworlds

template <class Of>
struct std::hash<manyworlds::Id<Of>> {
  std::size_t operator()(manyworlds::Id<Of> id) const noexcept {
    return std::hash<int>{}(id.index());
  }
};
template <>
struct std::hash<manyworlds::ShapeId> {
  std::size_t operator()(manyworlds::ShapeId id) const noexcept {
    return std::hash<int>{}(id.body().index()) * 8191 + std::hash<int>{}(id.index());
  }
};
