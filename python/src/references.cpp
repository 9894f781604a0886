// What callers mean by a body, a shape, a joint, a control, a tendon, a site or a keyframe: a
// handle (manyworlds/ids.py), a name or an index.
#include "convert.hpp"

namespace manyworlds::python {

namespace {

constexpr const char* kHandles[] = {"BodyId", "JointId",    "ControlId", "TendonId",
                                    "SiteId", "KeyframeId", "ShapeId"};

// Is it a handle of another kind?
void refuse_others(nb::handle value, const Place& place, const char* kind) {
  if (PyLong_CheckExact(value.ptr())) return;
  for (const char* other : kHandles) {
    if (std::string_view(other) == kind || !is_dataclass(value, other)) continue;
    wrong_type(place, value, std::string("a ") + kind + ", a name or an index");
  }
}

template <class Find>
auto read_name(nb::handle value, const Place& place, Find find) {
  const std::string name = read_text(value, place);
  if (!place.scene) wrong_value(place, "is the name '" + name + "'; expected an index or a handle");
  try {
    return find(*place.scene, name);
  } catch (const std::invalid_argument& error) {
    const std::string at = place.up ? place.text() + ": " : "";
    throw nb::value_error((at + error.what()).c_str());
  }
}

template <class Handle, class Find>
Handle read_reference(nb::handle value, const Place& place, const char* kind, Find find) {
  if (PyUnicode_Check(value.ptr())) return read_name(value, place, find);
  refuse_others(value, place, kind);
  return Handle(Converter<int>::read(value, place));
}

// "" for what has none, which reading it will tell of.
std::string name_in(nb::handle part) {
  const nb::object name = nb::getattr(part, "name", nb::none());
  const char* text =
      PyUnicode_Check(name.ptr()) ? PyUnicode_AsUTF8AndSize(name.ptr(), nullptr) : "";
  if (!text) PyErr_Clear();
  return text ? text : "";
}

// Calls f(name) for each element of a list; of what is none, for nothing.
template <class F>
void for_each_name(nb::handle owner, const char* member, F f) {
  const nb::object list = nb::getattr(owner, member, nb::none());
  if (!PyList_Check(list.ptr()) && !PyTuple_Check(list.ptr())) return;
  for (const nb::handle part : nb::borrow<nb::sequence>(list)) f(name_in(part), part);
}

}  // namespace

BodyId read_body(nb::handle value, const Place& place) {
  return read_reference<BodyId>(value, place, "BodyId",
                                [](const Scene& s, const auto& name) { return s.body(name); });
}
JointId read_joint(nb::handle value, const Place& place) {
  return read_reference<JointId>(value, place, "JointId",
                                 [](const Scene& s, const auto& name) { return s.joint(name); });
}
ControlId read_control(nb::handle value, const Place& place) {
  return read_reference<ControlId>(
      value, place, "ControlId", [](const Scene& s, const auto& name) { return s.control(name); });
}
TendonId read_tendon(nb::handle value, const Place& place) {
  return read_reference<TendonId>(value, place, "TendonId",
                                  [](const Scene& s, const auto& name) { return s.tendon(name); });
}
SiteId read_site(nb::handle value, const Place& place) {
  return read_reference<SiteId>(value, place, "SiteId",
                                [](const Scene& s, const auto& name) { return s.site(name); });
}
KeyframeId read_keyframe(nb::handle value, const Place& place) {
  return read_reference<KeyframeId>(
      value, place, "KeyframeId",
      [](const Scene& s, const auto& name) { return s.keyframe(name); });
}

ShapeId read_shape(nb::handle value, BodyId body, const Place& place) {
  if (is_dataclass(value, "ShapeId")) {
    const auto parts = read_elements(value, place, 2, "numbers");
    return {read_body(parts[0], place.member("body")),
            Converter<int>::read(parts[1], place.member("index"))};
  }
  if (PyUnicode_Check(value.ptr())) {
    return read_name(value, place, [&](const Scene& s, const auto& name) {
      return body ? s.shape(body, name) : s.shape(name);
    });
  }
  refuse_others(value, place, "ShapeId");
  const int index = Converter<int>::read(value, place);
  return index == -1 ? ShapeId() : ShapeId(body, index);
}

int checked(const std::string& name, int index, std::size_t count, int low) {
  const auto most = static_cast<std::ptrdiff_t>(count) - 1;
  if (index >= low && index <= most) return index;
  throw nb::index_error((name + " is " + std::to_string(index) + ", must be " +
                         std::to_string(low) + " to " + std::to_string(most))
                            .c_str());
}

int find_in(const Scene& scene, const std::string& kind, nb::handle name) {
  const Place place{nullptr, kind.c_str(), -1, &scene};
  if (kind == "body") return checked(kind, read_body(name, place).index(), scene.bodies.size());
  if (kind == "joint") return checked(kind, read_joint(name, place).index(), scene.joints.size());
  if (kind == "tendon") {
    return checked(kind, read_tendon(name, place).index(), scene.tendons.size());
  }
  if (kind == "site") return checked(kind, read_site(name, place).index(), scene.sites.size());
  if (kind == "keyframe") {
    return checked(kind, read_keyframe(name, place).index(), scene.keyframes.size());
  }
  return checked(kind, read_control(name, place).index(), scene.controls.size());
}

std::pair<int, int> find_shape_in(const Scene& scene, const std::string& name, nb::handle body) {
  const BodyId of = body.is_none() ? BodyId() : BodyId(find_in(scene, "body", body));
  try {
    const ShapeId found = of ? scene.shape(of, name) : scene.shape(name);
    return {found.body().index(), found.index()};
  } catch (const std::invalid_argument& error) {
    throw nb::value_error(error.what());
  }
}

Scene names_of_scene(nb::handle scene) {
  Scene out;
  for_each_name(scene, "bodies", [&](std::string name, nb::handle part) {
    Body& body = out.bodies.emplace_back();
    body.name = std::move(name);
    for_each_name(part, "shapes", [&](std::string of, nb::handle) {
      body.shapes.emplace_back().name = std::move(of);
    });
  });
  for_each_name(scene, "joints", [&](std::string name, nb::handle) {
    out.joints.emplace_back().name = std::move(name);
  });
  for_each_name(scene, "controls", [&](std::string name, nb::handle) {
    out.controls.emplace_back().name = std::move(name);
  });
  for_each_name(scene, "tendons", [&](std::string name, nb::handle) {
    out.tendons.emplace_back().name = std::move(name);
  });
  for_each_name(scene, "sites", [&](std::string name, nb::handle) {
    out.sites.emplace_back().name = std::move(name);
  });
  for_each_name(scene, "keyframes", [&](std::string name, nb::handle) {
    out.keyframes.emplace_back().name = std::move(name);
  });
  return out;
}

}  // namespace manyworlds::python
