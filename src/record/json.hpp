// Plain structs to JSON and back, by the names of their members (members.hpp).
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "manyworlds/members.hpp"
#include "manyworlds/plan.hpp"
#include "src/base/enum_names.hpp"
#include "src/page/json.hpp"

namespace manyworlds::record {

using page::Json;

// The words for an enumeration, and for the alternatives of a variant, in their order.
template <class E>
struct Words {
  static constexpr const auto& list = EnumTable<E>::names;
};

// What a struct consists of in JSON.
template <class T>
struct JsonMembers {
  static void visit(T& value, auto& visit) requires HasMembers<T> {
    Members<T>::visit(value, visit);
  }
};
// As text at once: a tree of Json allocates to be destroyed, where running out of memory ends the
// program.
struct JsonWriter {
  template <class T>
  void operator()(const char* name, T& value, Counted = {}) {
    to += to.back() == '{' ? "\"" : ",\"";
    to += name;
    to += "\":";
    put(to, value);
  }

  template <class T>
  requires std::same_as<T, bool> || std::same_as<T, std::string> || std::floating_point<T> ||
      std::integral<T>
  static void put(std::string& to, const T& value) {
    if constexpr (std::floating_point<T>) {
      if (!std::isfinite(value)) {
        to += std::isnan(value) ? "\"nan\"" : value > 0 ? "\"inf\"" : "\"-inf\"";
        return;
      }
    }
    to += Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  template <class Of>
  static void put(std::string& to, Id<Of> id) {
    put(to, id.index());
  }
  template <class E>
  requires std::is_enum_v<E>
  static void put(std::string& to, E value) { put(to, std::string(name_of(checked_enum(value)))); }
  template <class T>
  static void put(std::string& to, std::optional<T>& value) {
    if (value) {
      put(to, *value);
    } else {
      to += "null";
    }
  }
  template <class T>
  static void put(std::string& to, std::vector<T>& values) {
    put_all(to, values.size(), [&](std::size_t i) { put(to, values[i]); });
  }
  template <class... Ts>
  static void put(std::string& to, std::variant<Ts...>& value) {
    to += '{';
    const char* word = Words<std::variant<Ts...>>::list[value.index()];
    std::visit([&](auto& alternative) { JsonWriter{to}(word, alternative); }, value);
    to += '}';
  }
  template <class T>
  requires requires(JsonWriter& w, T& t) { JsonMembers<T>::visit(t, w); }
  static void put(std::string& to, T& value) {
    to += '{';
    JsonWriter writer{to};
    JsonMembers<T>::visit(value, writer);
    to += '}';
  }
  // Vectors and matrices as rows of numbers, quaternions as w, x, y, z.
  template <int Rows, int Columns>
  static void put(std::string& to, const Eigen::Matrix<double, Rows, Columns>& m) {
    put_all(to, Rows * Columns, [&](std::size_t i) {
      put(to, m(static_cast<int>(i) / Columns, static_cast<int>(i) % Columns));
    });
  }
  static void put(std::string& to, const Quat& q) {
    const double parts[] = {q.w(), q.x(), q.y(), q.z()};
    put_all(to, 4, [&](std::size_t i) { put(to, parts[i]); });
  }

  template <class Put>
  static void put_all(std::string& to, std::size_t count, Put put_one) {
    to += '[';
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) to += ',';
      put_one(i);
    }
    to += ']';
  }

  std::string& to;  // ends with the '{' of the struct, or with one of its members
};

// Reads what JsonWriter wrote. Whatever does not fit is noted with its place and left as it was.
class JsonReader {
 public:
  JsonReader(std::vector<std::string>& problems, const Json& from, std::string place)
      : problems_(problems), from_(from), place_(std::move(place)) {}

  template <class T>
  void operator()(const char* name, T& value, Counted = {}) {
    known_.insert(name);
    const auto member = from_.find(name);
    if (member == from_.end()) {
      note(place_, "has no member '" + std::string(name) + "'");
    } else {
      get(*member, value, place_ + "/" + name);
    }
  }
  void refuse_others() {
    for (const auto& item : from_.items()) {
      if (known_.count(item.key()) == 0) note(place_, "has an unknown member '" + item.key() + "'");
    }
  }

  template <class T>
  requires requires(JsonReader& r, T& t) { JsonMembers<T>::visit(t, r); }
  void get(const Json& j, T& value, const std::string& place) {
    if (!j.is_object()) return expected(j, place, "an object");
    JsonReader reader(problems_, j, place);
    JsonMembers<T>::visit(value, reader);
    reader.refuse_others();
  }
  void get(const Json& j, double& value, const std::string& place) {
    if (j.is_number()) {
      value = j.get<double>();
    } else if (j == "inf" || j == "-inf") {
      value = (j == "inf" ? 1 : -1) * std::numeric_limits<double>::infinity();
    } else if (j == "nan") {
      value = std::numeric_limits<double>::quiet_NaN();
    } else {
      expected(j, place, "a number");
    }
  }
  template <class T>
  requires std::integral<T>
  void get(const Json& j, T& value, const std::string& place) {
    if constexpr (std::same_as<T, bool>) {
      if (!j.is_boolean()) return expected(j, place, "true or false");
      value = j.template get<bool>();
    } else {
      // Numbers without a sign beyond what int64_t holds are out of range for both types we have.
      static_assert(sizeof(T) == 4);
      const bool whole = j.is_number_integer() && (!j.is_number_unsigned() ||
                                                   j.template get<std::uint64_t>() <= 0xffffffffu);
      const auto number = whole ? j.template get<std::int64_t>() : std::int64_t{-1} << 62;
      if (number < std::numeric_limits<T>::min() || number > std::numeric_limits<T>::max()) {
        return expected(j, place, "a whole number of 32 bits");
      }
      value = static_cast<T>(number);
    }
  }
  template <class Of>
  void get(const Json& j, Id<Of>& id, const std::string& place) {
    int index = id.index();
    get(j, index, place);
    id = Id<Of>(index);
  }
  void get(const Json& j, std::string& value, const std::string& place) {
    if (!j.is_string()) return expected(j, place, "a string");
    value = j.get<std::string>();
  }
  template <class E>
  requires std::is_enum_v<E>
  void get(const Json& j, E& value, const std::string& place) {
    const std::size_t i = word_index(Words<E>::list, j.is_string() ? j.get<std::string>() : "");
    if (i == std::size(Words<E>::list)) return expected(j, place, one_of(Words<E>::list));
    value = static_cast<E>(i);
  }
  template <class T>
  void get(const Json& j, std::optional<T>& value, const std::string& place) {
    value.reset();
    if (!j.is_null()) get(j, value.emplace(), place);
  }
  template <class T>
  void get(const Json& j, std::vector<T>& values, const std::string& place) {
    if (!j.is_array()) return expected(j, place, "an array");
    values.clear();
    for (std::size_t i = 0; i < j.size(); ++i) {
      get(j[i], values.emplace_back(), place + "/" + std::to_string(i));
    }
  }
  template <class... Ts>
  void get(const Json& j, std::variant<Ts...>& value, const std::string& place) {
    const auto& words = Words<std::variant<Ts...>>::list;
    const bool one = j.is_object() && j.size() == 1;
    const std::size_t found = word_index(words, one ? j.begin().key() : "");
    if (found == std::size(words)) {
      return expected(j, place, "an object with one member, " + one_of(words));
    }
    std::size_t i = 0;
    ((i++ == found ? get(*j.begin(), value.template emplace<Ts>(), place + "/" + words[found])
                   : void()),
     ...);
  }
  template <int Rows, int Columns>
  void get(const Json& j, Eigen::Matrix<double, Rows, Columns>& m, const std::string& place) {
    if (!has_size(j, Rows * Columns, place)) return;
    for (int i = 0; i < Rows * Columns; ++i) {
      get(j[static_cast<std::size_t>(i)], m(i / Columns, i % Columns),
          place + "/" + std::to_string(i));
    }
  }
  void get(const Json& j, Quat& q, const std::string& place) {
    if (!has_size(j, 4, place)) return;
    double* const parts[] = {&q.w(), &q.x(), &q.y(), &q.z()};
    for (std::size_t i = 0; i < 4; ++i) get(j[i], *parts[i], place + "/" + std::to_string(i));
  }

 private:
  void note(const std::string& place, const std::string& what) {
    // As many as anybody reads; a file of the wrong sort would give one for each of its members.
    if (problems_.size() < 100) problems_.push_back((place.empty() ? "/" : place) + ": " + what);
  }
  void expected(const Json& j, const std::string& place, const std::string& what) {
    std::string found = j.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (found.size() > 40) found = found.substr(0, 37) + "...";
    note(place, "is " + found + ", must be " + what);
  }
  bool has_size(const Json& j, std::size_t size, const std::string& place) {
    if (j.is_array() && j.size() == size) return true;
    expected(j, place, "an array of " + std::to_string(size) + " numbers");
    return false;
  }
  static std::size_t word_index(std::span<const char* const> words, const std::string& word) {
    std::size_t i = 0;
    while (i < words.size() && word != words[i]) ++i;
    return i;
  }

  std::vector<std::string>& problems_;
  const Json& from_;
  std::string place_;
  std::set<std::string> known_;
};

}  // namespace manyworlds::record
