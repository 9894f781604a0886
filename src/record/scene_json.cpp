// Scenes and plan options as JSON: their members (members.hpp), and the words for variants.
#include <array>
#include <string_view>
#include <variant>

#include "manyworlds/record.hpp"
#include "src/base/float_mode.hpp"
#include "src/record/json.hpp"

namespace manyworlds::record {

// The alternatives of a variant by the names of their types: HalfPlane is "half_plane", HingeJoint
// is "hinge".
template <class T>
constexpr std::array<char, 32> word_of() {
  std::array<char, 32> out{};
  std::string_view name = Members<T>::name;
  if (name.ends_with("Joint")) name.remove_suffix(5);
  std::size_t n = 0;
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (upper && n > 0) out[n++] = '_';
    out[n++] = upper ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return out;
}
template <class T>
inline constexpr std::array<char, 32> kWord = word_of<T>();

template <class... Ts>
struct Words<std::variant<Ts...>> {
  static constexpr const char* list[] = {kWord<Ts>.data()...};
};

// A shape is named by its place in its body, which comes with it.
template <>
struct JsonMembers<Variation> {
  static void visit(Variation& value, auto& visit) {
    auto& [parameter, body, shape, joint, control, attractor, low, high, draw, together] = value;
    if (shape.body()) body = shape.body();
    int index = shape.index();
    visit("parameter", parameter), visit("body", body), visit("shape", index);
    shape = index == -1 ? ShapeId() : ShapeId(body, index);
    visit("joint", joint), visit("control", control), visit("attractor", attractor);
    visit("low", low), visit("high", high), visit("draw", draw), visit("together", together);
  }
};
// The corners are all that a box has.
template <>
struct JsonMembers<Eigen::AlignedBox3d> {
  static void visit(Eigen::AlignedBox3d& value, auto& visit) {
    visit("min", value.min()), visit("max", value.max());
  }
};
template <>
struct JsonMembers<PlanOptions> {
  static void visit(PlanOptions& value, auto& visit) {
    auto& [broad_phase, keep] = value;
    visit("broad_phase", broad_phase), visit("keep", keep);
  }
};

}  // namespace manyworlds::record

namespace manyworlds {
namespace {

template <class Struct>
std::string to_json(Struct value) {
  const FloatMode mode;
  std::string text;
  record::JsonWriter::put(text, value);
  return text;
}

// What we write is not half as deep; to print what is wrong takes a call per level.
constexpr int kMaxLevels = 64;

bool shallow(int depth, record::Json::parse_event_t, record::Json&) {
  if (depth <= kMaxLevels) return true;
  throw RecordError("is nested deeper than " + std::to_string(kMaxLevels) + " levels");
}

template <class Struct>
Struct from_json(std::string_view text) {
  const FloatMode mode;
  record::Json json;
  try {
    json = record::Json::parse(text, shallow);
  } catch (const nlohmann::json::exception& error) {
    // After the number of the error: "[json.exception.parse_error.101] parse error at line 1, ...".
    const std::string what = error.what();
    const std::size_t end = what.find("] ");
    throw RecordError("is not JSON: " + (end == std::string::npos ? what : what.substr(end + 2)));
  }
  std::vector<std::string> problems;
  Struct value;
  record::JsonReader(problems, json, "").get(json, value, "");
  if (!problems.empty()) throw RecordError(std::move(problems));
  return value;
}

}  // namespace

std::string scene_to_json(const Scene& scene) { return to_json(scene); }
std::string plan_options_to_json(const PlanOptions& options) { return to_json(options); }
Scene scene_from_json(std::string_view json) { return from_json<Scene>(json); }
PlanOptions plan_options_from_json(std::string_view json) { return from_json<PlanOptions>(json); }

}  // namespace manyworlds
