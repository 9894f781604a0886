#include "set_option.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <type_traits>

#include <fmt/format.h>

#include "manyworlds/nearest.hpp"
#include "manyworlds/option_members.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds::cli {
namespace {

// How an option is read and written: takes(), text(value) and read(text, value), which says whether
// the whole text is one. What its range is, the checks of the scene say.
template <class T>
struct Format;

template <class T>
requires std::is_arithmetic_v<T>
struct Format<T> {
  static std::string takes() { return std::is_integral_v<T> ? "a whole number" : "a number"; }
  static std::string text(T value) { return fmt::format("{}", value); }
  static bool read(const std::string& text, T& value) {
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && stop == end;
  }
};

template <class E>
requires std::is_enum_v<E>
struct Format<E> {
  static std::string takes() { return one_of(EnumTable<E>::names); }
  static std::string text(E value) { return name_of(value); }
  static bool read(const std::string& text, E& value) {
    std::size_t i = 0;
    while (i < EnumTable<E>::names.size() && text != EnumTable<E>::names[i]) ++i;
    value = static_cast<E>(i);
    return is_named(value);
  }
};

template <>
struct Format<bool> {
  static std::string takes() { return "true or false"; }
  static std::string text(bool value) { return value ? "true" : "false"; }
  static bool read(const std::string& text, bool& value) {
    value = text == "true";
    return value || text == "false";
  }
};

template <int n>
struct Format<Eigen::Matrix<double, n, 1>> {
  using Vector = Eigen::Matrix<double, n, 1>;
  static std::string takes() { return fmt::format("{} numbers, as in 0,0,-9.81", n); }
  static std::string text(const Vector& value) {
    std::string out;
    for (int i = 0; i < n; ++i) out += (i == 0 ? "" : ",") + Format<double>::text(value[i]);
    return out;
  }
  static bool read(const std::string& text, Vector& value) {
    std::size_t from = 0;
    for (int i = 0; i < n; ++i) {
      const std::size_t comma = i + 1 < n ? text.find(',', from) : text.size();
      if (comma == std::string::npos) return false;
      if (!Format<double>::read(text.substr(from, comma - from), value[i])) return false;
      from = comma + 1;
    }
    return true;
  }
};

template <>
struct Format<Eigen::AlignedBox3d> {
  static std::string takes() { return "6 numbers, the lowest corner and the highest"; }
  static std::string text(const Eigen::AlignedBox3d& box) {
    return Format<Eigen::Vector3d>::text(box.min()) + "," +
           Format<Eigen::Vector3d>::text(box.max());
  }
  static bool read(const std::string& text, Eigen::AlignedBox3d& box) {
    Eigen::Matrix<double, 6, 1> corners;
    if (!Format<Eigen::Matrix<double, 6, 1>>::read(text, corners)) return false;
    box.min() = corners.head<3>(), box.max() = corners.tail<3>();
    return true;
  }
};

template <class T>
struct Format<std::optional<T>> {
  static std::string takes() { return fmt::format("{}, or default", Format<T>::takes()); }
  static std::string text(const std::optional<T>& value) {
    return value ? Format<T>::text(*value) : "default";
  }
  static bool read(const std::string& text, std::optional<T>& value) {
    value.reset();
    return text == "default" || Format<T>::read(text, value.emplace());
  }
};

// visit(path, option) for every option of these, groups opened.
template <HasMembers Struct>
void for_each_option(Struct& value, const std::string& prefix, auto&& visit) {
  Members<Struct>::visit(value, [&](const char* name, auto& member, Counted = {}) {
    if constexpr (HasMembers<std::remove_reference_t<decltype(member)>>) {
      for_each_option(member, prefix + name + ".", visit);
    } else {
      visit(prefix + name, member);
    }
  });
}

}  // namespace

std::vector<OptionLine> option_lines(const Options& options) {
  std::vector<OptionLine> out;
  Options copy = options;
  for_each_option(copy, "", [&]<class T>(const std::string& path, const T& value) {
    out.push_back({path, Format<T>::takes(), Format<T>::text(value)});
  });
  return out;
}

std::string set_option(Options& options, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    return fmt::format("must be PATH=VALUE, is '{}'", assignment);
  }
  const std::string path = assignment.substr(0, equals), text = assignment.substr(equals + 1);
  bool found = false;
  std::string problem;
  for_each_option(options, "", [&]<class T>(const std::string& name, T& value) {
    if (name != path) return;
    found = true;
    T read = value;
    if (Format<T>::read(text, read)) {
      value = read;
    } else {
      problem = fmt::format("{} must be {}, is '{}'", path, Format<T>::takes(), text);
    }
  });
  if (found) return problem;
  std::vector<std::string> paths;
  for (const OptionLine& line : option_lines(options)) paths.push_back(line.path);
  const std::optional<std::string> near = nearest(path, paths);
  return fmt::format("unknown option of a scene '{}'{} ('manyworlds info --options' lists all)",
                     path, near ? fmt::format("; did you mean '{}'?", *near) : "");
}

}  // namespace manyworlds::cli
