// The C++ that makes a scene: a function of a name that returns it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "manyworlds/members.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds::test {

// What is as by default is left out. Numbers have so many digits; what is next to nothing against
// 1, as turns by a sine of pi leave it, is 0.
class SceneSource {
 public:
  explicit SceneSource(int digits) : digits_(digits) {}

  std::string function(Scene scene) {
    std::string out = "Scene " + scene.name + "() {\nScene scene;\n";
    Options options = std::exchange(scene.options, {});
    out += fmt::format("scene.name = \"{}\";\n", scene.name);
    Options as_ever;
    out += assignments("scene.options", options, as_ever);
    for (Body& body : scene.bodies) out += fmt::format("scene.add({});\n", text(body));
    for (Joint& joint : scene.joints) out += fmt::format("scene.add({});\n", text(joint));
    for (Control& control : scene.controls) out += fmt::format("scene.add({});\n", text(control));
    if (!scene.exclusions.empty()) {
      out += fmt::format("scene.exclusions = {};\n", text(scene.exclusions));
    }
    if (!scene.tendons.empty() || !scene.attractors.empty() || !scene.variations.empty() ||
        !scene.keyframes.empty() || !scene.sites.empty()) {
      throw std::logic_error(scene.name + " has what SceneSource does not write");
    }
    return out + "return scene;\n}\n";
  }

 private:
  using Texts = std::vector<std::pair<std::string, std::string>>;  // member, value

  template <HasMembers Struct>
  Texts members(Struct& value) {
    Texts out;
    Members<Struct>::visit(value, [&](const char* name, auto& member, Counted = {}) {
      out.emplace_back(name, text(member));
    });
    // Initialisers come as members are declared, and a body's are not visited so.
    if constexpr (std::same_as<Struct, Body>) {
      const auto is_late = [](const auto& member) {
        return member.first == "shapes" || member.first == "mass_properties" ||
               member.first == "gravity_scale";
      };
      std::stable_partition(out.begin(), out.end(), [&](const auto& m) { return !is_late(m); });
    }
    return out;
  }

  template <HasMembers Struct>
  std::string text(Struct& value) {
    Struct as_ever;
    const Texts mine = members(value), usual = members(as_ever);
    std::string out;
    for (std::size_t i = 0; i < mine.size(); ++i) {
      if (mine[i] == usual[i]) continue;
      out += fmt::format("{}.{} = {}", out.empty() ? "" : ", ", mine[i].first, mine[i].second);
    }
    return fmt::format("{}{{{}}}", Members<Struct>::name, out);
  }
  template <HasMembers Struct>
  std::string assignments(const std::string& place, Struct& value, Struct& as_ever) {
    const Texts mine = members(value), usual = members(as_ever);
    std::size_t i = 0;
    std::string out;
    Members<Struct>::visit(value, [&](const char* name, auto& member, Counted = {}) {
      using Member = std::remove_reference_t<decltype(member)>;
      const std::size_t at = i++;
      if (mine[at] == usual[at]) return;
      if constexpr (HasMembers<Member>) {
        Member usual_member;
        out += assignments(place + '.' + name, member, usual_member);
      } else {
        out += fmt::format("{}.{} = {};\n", place, name, mine[at].second);
      }
    });
    return out;
  }

  std::string text(double x) const {
    if (std::isinf(x)) {
      return fmt::format("{}std::numeric_limits<double>::infinity()", x < 0 ? "-" : "");
    }
    return std::abs(x) < std::pow(10, -digits_) ? "0" : fmt::format("{:.{}g}", x, digits_);
  }
  static std::string text(bool x) { return x ? "true" : "false"; }
  static std::string text(int x) { return std::to_string(x); }
  static std::string text(std::uint32_t x) { return fmt::format("{:#x}", x); }
  static std::string text(const std::string& x) { return '"' + x + '"'; }
  static std::string text(BodyId id) { return fmt::format("BodyId({})", id.index()); }
  static std::string text(JointId id) { return fmt::format("JointId({})", id.index()); }
  template <class E>
  requires std::is_enum_v<E>
  static std::string text(E value) {
    std::string word(name_of(value));
    std::replace(word.begin(), word.end(), '-', '_');
    if constexpr (std::same_as<E, Solver>) return "Solver::" + word;
    if constexpr (std::same_as<E, Motion>) return "Motion::" + word;
    if constexpr (std::same_as<E, ControlKind>) return "ControlKind::" + word;
    return word;  // which nobody declares
  }
  std::string text(const Vec3& v) const {
    return fmt::format("Vec3({}, {}, {})", text(v.x()), text(v.y()), text(v.z()));
  }
  std::string text(const Quat& q) const {
    return fmt::format("Quat({}, {}, {}, {})", text(q.w()), text(q.x()), text(q.y()), text(q.z()));
  }
  std::string text(const Mat3& m) const {
    std::string out;
    for (int i = 0; i < 9; ++i) out += (i > 0 ? ", " : "") + text(m(i / 3, i % 3));
    return fmt::format("(Mat3() << {}).finished()", out);
  }
  template <class T>
  std::string text(std::optional<T>& value) {
    return value ? text(*value) : "std::nullopt";
  }
  template <class T>
  std::string text(std::vector<T>& values) {
    std::string out;
    for (T& value : values) out += (out.empty() ? "" : ", ") + text(value);
    return '{' + out + '}';
  }
  template <class... Ts>
  std::string text(std::variant<Ts...>& value) {
    return std::visit([this](auto& alternative) { return text(alternative); }, value);
  }
  // Members that no robot has.
  template <class T>
  requires(!HasMembers<T> && !std::is_enum_v<T>) static std::string text(const T&) { return "?"; }

  int digits_;
};

}  // namespace manyworlds::test
