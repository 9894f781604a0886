// Values between Python and the library: Converter<T>::read checks and says what is wrong where,
// Converter<T>::write makes the Python value. Structs that have a Described<T> (scene_fields.hpp)
// are dataclasses of the package manyworlds with the same members.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "manyworlds/scene.hpp"
#include "names.hpp"
#include "place.hpp"

namespace manyworlds::python {

namespace nb = nanobind;

[[noreturn]] void wrong_type(const Place& place, nb::handle found, const std::string& expected);
[[noreturn]] void wrong_value(const Place& place, const std::string& what);

double read_number(nb::handle value, const Place& place);
long long read_integer(nb::handle value, const Place& place, long long low, long long high);
bool read_bool(nb::handle value, const Place& place);
std::string read_text(nb::handle value, const Place& place);
// The elements of a list, tuple or array; `count` < 0: any number of them.
std::vector<nb::object> read_elements(nb::handle value, const Place& place, int count,
                                      const char* expected);
// Calls a dataclass of the package with these members.
nb::object make_dataclass(const char* name, const nb::dict& members);
void check_dataclass(nb::handle value, const Place& place, const char* name);
bool is_dataclass(nb::handle value, const char* name);

template <class T>
struct Described;  // name, and fields(visit, value): visit("member", value.member)...

// Index of the "body", "joint", "control", "tendon", "site" or "keyframe" of a scene that a handle,
// a name or an index means, and (body, index) of a shape by its name. Raise IndexError and
// ValueError.
int find_in(const Scene& scene, const std::string& kind, nb::handle name);
std::pair<int, int> find_shape_in(const Scene& scene, const std::string& name, nb::handle body);
// An index from `low` to below a count, or an IndexError.
int checked(const std::string& name, int index, std::size_t count, int low = 0);

// A scene of the names of one in Python, and of nothing else; parts of a wrong type have none.
Scene names_of_scene(nb::handle scene);

template <class T>
struct Converter {  // of a Described struct
  static T read(nb::handle value, const Place& place) {
    check_dataclass(value, place, Described<T>::name);
    if constexpr (std::is_same_v<T, Scene>) {
      const Scene names = names_of_scene(value);
      return read_members(value, {place.up, place.name, place.index, &names});
    } else if constexpr (requires(T t) { t.scene; }) {  // a task
      const Scene names = names_of_scene(nb::getattr(value, "scene"));
      return read_members(value, {place.up, place.name, place.index, &names});
    } else {
      return read_members(value, place);
    }
  }
  static nb::object write(const T& value) {
    if constexpr (std::is_same_v<T, Variation>) {  // its shape is written as one of its body
      if (value.body != value.shape.body() && value.shape.body()) {
        T told = value;
        told.body = value.shape.body();
        return write(told);
      }
    }
    nb::dict members;
    Described<T>::fields(
        [&]<class Member>(const char* name, const Member& member) {
          members[name] = Converter<Member>::write(member);
        },
        value);
    return make_dataclass(Described<T>::name, members);
  }

 private:
  static T read_members(nb::handle value, const Place& place) {
    T out;
    Described<T>::fields(
        [&]<class Member>(const char* name, Member& member) {
          read_member(out, member, nb::getattr(value, name), place.member(name));
        },
        out);
    return out;
  }
  template <class Member>
  static void read_member(T& out, Member& member, const nb::object& found, const Place& place) {
    if constexpr (std::is_same_v<Member, ShapeId>) {  // of a Variation, after its body
      member = read_shape(found, out.body, place);
      if (!out.body) out.body = member.body();
    } else {
      member = Converter<Member>::read(found, place);
    }
  }
};

template <>
struct Converter<double> {
  static double read(nb::handle value, const Place& place) { return read_number(value, place); }
  static nb::object write(double value) { return nb::float_(value); }
};
template <>
struct Converter<bool> {
  static bool read(nb::handle value, const Place& place) { return read_bool(value, place); }
  static nb::object write(bool value) { return nb::bool_(value); }
};
template <class T>
requires std::is_integral_v<T>
struct Converter<T> {
  static T read(nb::handle value, const Place& place) {
    return static_cast<T>(
        read_integer(value, place, std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
  }
  static nb::object write(T value) { return nb::int_(value); }
};
// Handles, names of Place::scene, or indices of it (references.cpp).
BodyId read_body(nb::handle value, const Place& place);
JointId read_joint(nb::handle value, const Place& place);
ControlId read_control(nb::handle value, const Place& place);
TendonId read_tendon(nb::handle value, const Place& place);
SiteId read_site(nb::handle value, const Place& place);
KeyframeId read_keyframe(nb::handle value, const Place& place);
// Indices and names are of the body, if there is one.
ShapeId read_shape(nb::handle value, BodyId body, const Place& place);
template <>
struct Converter<BodyId> {
  static BodyId read(nb::handle value, const Place& place) { return read_body(value, place); }
  static nb::object write(BodyId id) { return nb::int_(id.index()); }
};
template <>
struct Converter<JointId> {
  static JointId read(nb::handle value, const Place& place) { return read_joint(value, place); }
  static nb::object write(JointId id) { return nb::int_(id.index()); }
};
template <>
struct Converter<ControlId> {
  static ControlId read(nb::handle value, const Place& place) { return read_control(value, place); }
  static nb::object write(ControlId id) { return nb::int_(id.index()); }
};
template <>
struct Converter<ShapeId> {
  static nb::object write(ShapeId id) { return nb::int_(id.index()); }
};
template <>
struct Converter<std::string> {
  static std::string read(nb::handle value, const Place& place) { return read_text(value, place); }
  static nb::object write(const std::string& value) { return nb::str(value.c_str(), value.size()); }
};
template <class Enum>
requires std::is_enum_v<Enum>
struct Converter<Enum> {
  static Enum read(nb::handle value, const Place& place) {
    const std::string text = read_text(value, place);
    const Enum* found = find_name<Enum>(text);
    if (!found) wrong_value(place, unknown_name(text, known_names<Enum>()));
    return *found;
  }
  static nb::object write(Enum value) { return nb::str(name_of(value)); }
};

template <int n>
struct Converter<Eigen::Matrix<double, n, 1>> {
  static Eigen::Matrix<double, n, 1> read(nb::handle value, const Place& place) {
    const auto from = read_elements(value, place, n, "numbers");
    Eigen::Matrix<double, n, 1> out;
    for (std::size_t i = 0; i < from.size(); ++i) {
      out[static_cast<Eigen::Index>(i)] = read_number(from[i], place.element(i));
    }
    return out;
  }
  static nb::object write(const Eigen::Matrix<double, n, 1>& value) {
    nb::list out;
    for (int i = 0; i < n; ++i) out.append(value[i]);
    return nb::tuple(out);
  }
};
template <>
struct Converter<Mat3> {
  static Mat3 read(nb::handle value, const Place& place) {
    const auto from = read_elements(value, place, 3, "rows");
    Mat3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      out.row(static_cast<Eigen::Index>(i)) = Converter<Vec3>::read(from[i], place.element(i));
    }
    return out;
  }
  static nb::object write(const Mat3& value) {
    nb::list out;
    for (int i = 0; i < 3; ++i) out.append(Converter<Vec3>::write(value.row(i)));
    return nb::tuple(out);
  }
};
template <>
struct Converter<Quat> {  // (w, x, y, z)
  static Quat read(nb::handle value, const Place& place) {
    const auto q = Converter<Eigen::Vector4d>::read(value, place);
    return {q[0], q[1], q[2], q[3]};
  }
  static nb::object write(const Quat& q) {
    return Converter<Eigen::Vector4d>::write({q.w(), q.x(), q.y(), q.z()});
  }
};
template <>
struct Converter<Eigen::AlignedBox3d> {  // (low corner, high corner)
  static Eigen::AlignedBox3d read(nb::handle value, const Place& place) {
    const auto corners = read_elements(value, place, 2, "corners");
    return {Converter<Vec3>::read(corners[0], place.element(0)),
            Converter<Vec3>::read(corners[1], place.element(1))};
  }
  static nb::object write(const Eigen::AlignedBox3d& box) {
    return nb::make_tuple(Converter<Vec3>::write(box.min()), Converter<Vec3>::write(box.max()));
  }
};

template <class T>
struct Converter<std::optional<T>> {
  static std::optional<T> read(nb::handle value, const Place& place) {
    if (value.is_none()) return std::nullopt;
    return Converter<T>::read(value, place);
  }
  static nb::object write(const std::optional<T>& value) {
    return value ? Converter<T>::write(*value) : nb::none();
  }
};
template <class T>
struct Converter<std::vector<T>> {
  static std::vector<T> read(nb::handle value, const Place& place) {
    const auto from = read_elements(value, place, -1, "a list");
    std::vector<T> out;
    out.reserve(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      out.push_back(Converter<T>::read(from[i], place.element(i)));
    }
    return out;
  }
  static nb::object write(const std::vector<T>& value) {
    nb::list out;
    for (const T& element : value) out.append(Converter<T>::write(element));
    return out;
  }
};
// One of several dataclasses.
template <class... Ts>
struct Converter<std::variant<Ts...>> {
  static std::variant<Ts...> read(nb::handle value, const Place& place) {
    std::optional<std::variant<Ts...>> out;
    const auto attempt = [&]<class T>() {
      if (out || !is_dataclass(value, Described<T>::name)) return;
      out.emplace(Converter<T>::read(value, place));
    };
    (attempt.template operator()<Ts>(), ...);
    if (out) return *std::move(out);
    std::string names;
    ((names += (names.empty() ? "" : ", ") + std::string(Described<Ts>::name)), ...);
    wrong_type(place, value, "one of " + names);
  }
  static nb::object write(const std::variant<Ts...>& value) {
    return std::visit([]<class T>(const T& one) { return Converter<T>::write(one); }, value);
  }
};

template <class T>
T from_python(nb::handle value, const char* name, const Scene* scene = nullptr) {
  return Converter<T>::read(value, Place{nullptr, name, -1, scene});
}
template <class T>
nb::object to_python(const T& value) {
  return Converter<T>::write(value);
}

}  // namespace manyworlds::python
