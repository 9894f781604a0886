// Bodies, shapes, joints, controls, tendons, sites and keyframes of a scene by name.
#include <stdexcept>
#include <utility>

#include "manyworlds/nearest.hpp"
#include "manyworlds/scene.hpp"
#include "src/base/index_check.hpp"

namespace manyworlds {

namespace {

// More names than these are not read out.
constexpr std::size_t kMaxNames = 20;

template <class Handle>
using Named = std::vector<std::pair<std::string, Handle>>;

template <class Handle, class List>
Named<Handle> names_of(const List& list) {
  Named<Handle> out;
  for (std::size_t i = 0; i < list.size(); ++i) {
    out.emplace_back(list[i].name, Handle(static_cast<int>(i)));
  }
  return out;
}

void add_shapes(const Scene& scene, BodyId body, Named<ShapeId>& out) {
  const std::vector<Shape>& shapes = scene.at(body).shapes;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    out.emplace_back(shapes[k].name, ShapeId(body, static_cast<int>(k)));
  }
}

template <class Of>
std::string number_of(Id<Of> id) {
  return std::to_string(id.index());
}
std::string number_of(ShapeId id) {
  return std::to_string(id.index()) + " of body " + number_of(id.body());
}

// "; there are 'hull', 'lid' (nearest: 'lid')"
template <class Handle>
std::string known_text(std::string_view name, const Named<Handle>& all, const char* plural) {
  std::vector<std::string> names;
  for (const auto& [one, handle] : all) {
    if (!one.empty()) names.push_back(one);
  }
  if (names.empty()) return std::string("; there are no ") + plural + " with names";
  std::string text = std::string("; there ") + (names.size() == 1 ? "is " : "are ");
  for (std::size_t i = 0; i < names.size() && i < kMaxNames; ++i) {
    text += (i > 0 ? ", '" : "'") + names[i] + "'";
  }
  if (names.size() > kMaxNames) {
    text += " and " + std::to_string(names.size() - kMaxNames) + " more";
  }
  const auto near = nearest(name, names);
  return near ? text + " (nearest: '" + *near + "')" : text;
}

template <class Handle>
Handle find(std::string_view name, const Named<Handle>& all, const char* one, const char* plural) {
  if (name.empty()) {
    throw std::invalid_argument(std::string("the name of a ") + one + " is empty" +
                                known_text(name, all, plural));
  }
  std::vector<Handle> found;
  for (const auto& [its, handle] : all) {
    if (its == name) found.push_back(handle);
  }
  if (found.size() == 1) return found.front();
  const std::string quoted = "'" + std::string(name) + "'";
  if (found.empty()) {
    throw std::invalid_argument(std::string("no ") + one + " is named " + quoted +
                                known_text(name, all, plural));
  }
  std::string text = std::to_string(found.size()) + " " + plural + " are named " + quoted + ": ";
  for (std::size_t i = 0; i < found.size() && i < kMaxNames; ++i) {
    text += (i > 0 ? ", " : "") + number_of(found[i]);
  }
  if (found.size() > kMaxNames) text += ", ...";
  throw std::invalid_argument(text + "; give them distinct names, or use the handle");
}

}  // namespace

void detail::throw_no_item(const char* what, int index, std::size_t count) {
  throw std::out_of_range(wrong_index_text(what, index, count));
}

BodyId Scene::body(std::string_view wanted) const {
  return find(wanted, names_of<BodyId>(bodies), "body", "bodies");
}
JointId Scene::joint(std::string_view wanted) const {
  return find(wanted, names_of<JointId>(joints), "joint", "joints");
}
ControlId Scene::control(std::string_view wanted) const {
  return find(wanted, names_of<ControlId>(controls), "control", "controls");
}
TendonId Scene::tendon(std::string_view wanted) const {
  return find(wanted, names_of<TendonId>(tendons), "tendon", "tendons");
}
SiteId Scene::site(std::string_view wanted) const {
  return find(wanted, names_of<SiteId>(sites), "site", "sites");
}
KeyframeId Scene::keyframe(std::string_view wanted) const {
  return find(wanted, names_of<KeyframeId>(keyframes), "keyframe", "keyframes");
}
ShapeId Scene::shape(std::string_view wanted) const {
  Named<ShapeId> all;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    add_shapes(*this, BodyId(static_cast<int>(b)), all);
  return find(wanted, all, "shape", "shapes");
}
ShapeId Scene::shape(BodyId body, std::string_view wanted) const {
  Named<ShapeId> all;
  add_shapes(*this, body, all);
  return find(wanted, all, "shape", "shapes");
}

}  // namespace manyworlds
