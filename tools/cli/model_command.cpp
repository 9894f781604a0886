// `manyworlds model`: what was read of a model: bodies and joints, actuators, tendons, sites, pairs
// of shapes, keyframes, options, and what of its file does not act as it says.
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/members.hpp"

#include "commands.hpp"
#include "job.hpp"
#include "model_tree.hpp"
#include "pair_table.hpp"
#include "report.hpp"
#include "set_option.hpp"
#include "src/base/enum_names.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted;

using Json = nlohmann::ordered_json;

// "hinge", "capsule"
template <class Variant>
std::string kind_of(const Variant& value) {
  std::string name =
      std::visit([](const auto& one) { return Members<std::decay_t<decltype(one)>>::name; }, value);
  if (name.ends_with("Joint")) name.resize(name.size() - 5);
  std::string words;
  for (const char c : name) {
    const bool capital = 'A' <= c && c <= 'Z';
    if (capital && !words.empty()) words += '-';
    words += capital ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return words;
}

// 'hip', or joint 3 where it has no name.
template <class Part>
std::string label(const char* what, const std::vector<Part>& parts, int index) {
  const std::string& name = parts[static_cast<std::size_t>(index)].name;
  return name.empty() ? fmt::format("{} {}", what, index) : fmt::format("'{}'", name);
}

const std::optional<Limit>* limit_of(const JointType& type) {
  if (const auto* hinge = std::get_if<HingeJoint>(&type)) return &hinge->limit;
  if (const auto* slider = std::get_if<SliderJoint>(&type)) return &slider->limit;
  if (const auto* ball = std::get_if<BallJoint>(&type)) return &ball->limit;
  return nullptr;
}

// "sphere, 2 capsules"
std::string shapes_text(const Body& body) {
  std::vector<std::pair<std::string, int>> kinds;
  for (const Shape& shape : body.shapes) {
    const std::string kind = kind_of(shape.geometry);
    bool known = false;
    for (auto& [name, count] : kinds) {
      known |= name == kind;
      count += name == kind ? 1 : 0;
    }
    if (!known) kinds.emplace_back(kind, 1);
  }
  std::string text;
  for (const auto& [name, count] : kinds) {
    text += (text.empty() ? "" : ", ");
    text +=
        count == 1 ? name : fmt::format("{} {}{}", count, name, name.ends_with("x") ? "es" : "s");
  }
  return text.empty() ? "no shapes" : text;
}

// Options that are not as they are without a file.
std::vector<OptionLine> set_options(const Options& options) {
  const std::vector<OptionLine> defaults = option_lines(Options());
  std::vector<OptionLine> lines = option_lines(options), out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].value != defaults[i].value) out.push_back(lines[i]);
  }
  return out;
}

// As JSON.

// An end of a range: null where it is infinite.
Json end_json(double end) { return std::isfinite(end) ? Json(end) : Json(); }
Json range_json(double low, double high) { return Json::array({end_json(low), end_json(high)}); }
Json numbers_json(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json joint_json(const Scene& scene, const ModelJoint& row) {
  const Joint& joint = scene.at(row.joint);
  Json out = {{"name", joint.name}, {"type", kind_of(joint.type)}};
  if (row.velocities > 0) out.update({{"q", row.q}, {"v", row.v}});
  if (const auto* limit = limit_of(joint.type); limit != nullptr && *limit) {
    out["range"] = range_json((*limit)->low, (*limit)->high);
  }
  const JointDynamics& d = joint.dynamics;
  out.update({{"armature", d.armature}, {"damping", d.damping}, {"stiffness", d.stiffness}});
  return out;
}

Json bodies_json(const Scene& scene, const std::vector<ModelBody>& tree) {
  Json out = Json::array();
  for (const ModelBody& row : tree) {
    const Body& body = scene.at(row.body);
    Json joints = Json::array();
    for (const ModelJoint& joint : row.joints) joints.push_back(joint_json(scene, joint));
    Json& one = out.emplace_back(Json{{"body", row.body.index()}, {"name", body.name}});
    one["parent"] =
        row.parent < 0 ? Json() : Json(tree[static_cast<std::size_t>(row.parent)].body.index());
    one.update({{"mass", mass_properties(scene, body).mass}, {"shapes", shapes_text(body)}});
    if (row.root.velocities > 0) one.update({{"q", row.root.q}, {"v", row.root.v}});
    one["joints"] = std::move(joints);
  }
  return out;
}

Json controls_json(const Scene& scene) {
  Json out = Json::array();
  for (const Control& control : scene.controls) {
    Json& one = out.emplace_back(Json{{"name", control.name}, {"kind", name_of(control.kind)}});
    if (control.joint) one["joint"] = label("joint", scene.joints, control.joint.index());
    if (control.body) one["body"] = label("body", scene.bodies, control.body.index());
    one["control_range"] = range_json(control.low, control.high);
    if (control.kind != ControlKind::joint_force) continue;
    const Actuator& a = control.actuator;
    one.update({{"gear", a.gear},
                {"gain", numbers_json(a.gain)},
                {"bias", numbers_json(a.bias)},
                {"force_range", range_json(a.low, a.high)}});
  }
  return out;
}

Json tendons_json(const Scene& scene) {
  Json out = Json::array();
  for (const Tendon& tendon : scene.tendons) {
    Json terms = Json::array();
    for (const TendonTerm& term : tendon.terms) {
      terms.push_back({{"joint", label("joint", scene.joints, term.joint.index())},
                       {"coefficient", term.coefficient}});
    }
    Json& one = out.emplace_back(Json{{"name", tendon.name}, {"terms", std::move(terms)}});
    if (tendon.limit) one["range"] = range_json(tendon.limit->low, tendon.limit->high);
  }
  return out;
}

Json sites_json(const Scene& scene) {
  Json out = Json::array();
  for (const Site& site : scene.sites) {
    Json& one =
        out.emplace_back(Json{{"name", site.name}, {"position", numbers_json(site.position)}});
    if (site.body) one["body"] = site.body.index();
  }
  return out;
}

Json keyframes_json(const Scene& scene) {
  Json out = Json::array();
  for (const Keyframe& keyframe : scene.keyframes) {
    out.push_back({{"name", keyframe.name},
                   {"generalized_position", keyframe.generalized_position},
                   {"generalized_velocity", keyframe.generalized_velocity},
                   {"controls", keyframe.controls}});
  }
  return out;
}

Json to_json(const Job& job, const std::vector<std::string>& warnings) {
  const Scene& scene = job.plan.scene();
  Json fixed = Json::array();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.motion == Motion::fixed) {
      fixed.push_back({{"body", b}, {"name", body.name}, {"shapes", shapes_text(body)}});
    }
  }
  Json options = Json::object();
  for (const OptionLine& line : set_options(scene.options)) options[line.path] = line.value;
  return {{"scene", job.scene},
          {"solver", to_string(scene.options.solver.method)},
          {"nq", job.plan.items(ItemKind::coordinate)},
          {"nv", job.plan.items(ItemKind::dof)},
          {"bodies", bodies_json(scene, model_tree(job.plan))},
          {"fixed_bodies", std::move(fixed)},
          {"controls", controls_json(scene)},
          {"tendons", tendons_json(scene)},
          {"sites", sites_json(scene)},
          {"keyframes", keyframes_json(scene)},
          {"exclusions", scene.exclusions.size()},
          {"pairs", pairs_json(job.plan.report().pairs)},
          {"options", std::move(options)},
          {"left_out", warnings}};
}

// As text.

std::string range_text(double low, double high) {
  return fmt::format("{:.6g} to {:.6g}", low, high);
}

// "q 7-10  v 6-8  ", of as many numbers as there are
std::string numbers_text(const ModelJoint& row) {
  if (row.velocities == 0) return "";
  const auto span = [](int first, int count) {
    return count == 1 ? fmt::format("{}", first) : fmt::format("{}-{}", first, first + count - 1);
  };
  return fmt::format("  q {}  v {}", span(row.q, row.positions), span(row.v, row.velocities));
}

void print_joint(const Scene& scene, const ModelJoint& row, int indent) {
  const Joint& joint = scene.at(row.joint);
  std::string text = kind_of(joint.type) + " " + label("joint", scene.joints, row.joint.index());
  text += numbers_text(row);
  if (const auto* limit = limit_of(joint.type); limit != nullptr && *limit) {
    const bool angle = !std::holds_alternative<SliderJoint>(joint.type);
    text += fmt::format("  {} {}", range_text((*limit)->low, (*limit)->high), angle ? "rad" : "m");
  }
  const JointDynamics& d = joint.dynamics;
  const auto add = [&](const char* name, double value) {
    if (value != 0) text += fmt::format("  {} {:.6g}", name, value);
  };
  add("armature", d.armature), add("damping", d.damping), add("stiffness", d.stiffness);
  fmt::print("{:{}}{}\n", "", indent, text);
}

void print_tree(const Scene& scene, const std::vector<ModelBody>& tree) {
  fmt::print("\nmoving bodies and their joints\n");
  if (tree.empty()) fmt::print("  none\n");
  for (const ModelBody& row : tree) {
    const Body& body = scene.at(row.body);
    const int indent = 2 + 2 * row.depth;
    fmt::print("{:{}}{}  {:.4g} kg, {}\n", "", indent,
               label("body", scene.bodies, row.body.index()), mass_properties(scene, body).mass,
               shapes_text(body));
    if (row.joints.empty()) fmt::print("{:{}}free{}\n", "", indent + 4, numbers_text(row.root));
    for (const ModelJoint& joint : row.joints) print_joint(scene, joint, indent + 4);
  }
  bool first = true;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].motion != Motion::fixed) continue;
    if (std::exchange(first, false)) fmt::print("\nfixed bodies\n");
    fmt::print("  {}  {}\n", label("body", scene.bodies, static_cast<int>(b)),
               shapes_text(scene.bodies[b]));
  }
}

void print_controls(const Scene& scene) {
  fmt::print("\nactuators\n");
  if (scene.controls.empty()) fmt::print("  none\n");
  for (std::size_t i = 0; i < scene.controls.size(); ++i) {
    const Control& control = scene.controls[i];
    std::string text = label("control", scene.controls, static_cast<int>(i));
    text += fmt::format("  {}", name_of(control.kind));
    if (control.joint) text += " on " + label("joint", scene.joints, control.joint.index());
    if (control.body) text += " on " + label("body", scene.bodies, control.body.index());
    text += "  control " + range_text(control.low, control.high);
    if (control.kind == ControlKind::joint_force) {
      const Actuator& a = control.actuator;
      const auto add = [&](const char* name, const Vec3& v) {
        text += fmt::format("  {} ({:.6g}, {:.6g}, {:.6g})", name, v.x(), v.y(), v.z());
      };
      text += fmt::format("  gear {:.6g}", a.gear);
      add("gain", a.gain);
      if (!a.bias.isZero(0)) add("bias", a.bias);
      if (std::isfinite(a.low) || std::isfinite(a.high))
        text += "  force " + range_text(a.low, a.high);
    }
    fmt::print("  {}\n", text);
  }
}

void print_tendons(const Scene& scene) {
  if (scene.tendons.empty()) return;
  fmt::print("\ntendons\n");
  for (std::size_t i = 0; i < scene.tendons.size(); ++i) {
    const Tendon& tendon = scene.tendons[i];
    std::string sum;
    for (const TendonTerm& term : tendon.terms) {
      sum += fmt::format("{}{:.6g} {}", sum.empty() ? "" : " + ", term.coefficient,
                         label("joint", scene.joints, term.joint.index()));
    }
    fmt::print("  {}  {}{}\n", label("tendon", scene.tendons, static_cast<int>(i)), sum,
               tendon.limit ? "  " + range_text(tendon.limit->low, tendon.limit->high) : "");
  }
}

void print_sites(const Scene& scene) {
  if (scene.sites.empty()) return;
  fmt::print("\nsites\n");
  for (std::size_t i = 0; i < scene.sites.size(); ++i) {
    const Site& site = scene.sites[i];
    const std::string body =
        site.body ? label("body", scene.bodies, site.body.index()) : "the world";
    fmt::print("  {}  on {}  at ({:.6g}, {:.6g}, {:.6g}) m\n",
               label("site", scene.sites, static_cast<int>(i)), body, site.position.x(),
               site.position.y(), site.position.z());
  }
}

void print_keyframes(const Scene& scene) {
  if (scene.keyframes.empty()) return;
  fmt::print("\nkeyframes\n");
  for (std::size_t i = 0; i < scene.keyframes.size(); ++i) {
    fmt::print("  {}\n", label("keyframe", scene.keyframes, static_cast<int>(i)));
  }
}

void print_options(const Scene& scene) {
  fmt::print("\noptions that differ from the defaults ('manyworlds info --options')\n");
  const std::vector<OptionLine> lines = set_options(scene.options);
  if (lines.empty()) fmt::print("  none\n");
  const std::size_t width = widest(
      lines, [](const OptionLine& line) { return line.path; }, 0);
  for (const OptionLine& line : lines) fmt::print("  {:<{}}  {}\n", line.path, width, line.value);
}

}  // namespace

int model_command(const JobOptions& options) {
  std::vector<std::string> warnings;
  const Job job = prepare(options, &warnings);
  if (options.json) {
    fmt::print("{}\n", to_json(job, warnings).dump(2));
    return kOk;
  }
  const Scene& scene = job.plan.scene();
  fmt::print("{}: {} {}, {}, {}", job.scene, job.plan.bodies(),
             job.plan.bodies() == 1 ? "body that moves" : "bodies that move",
             counted(static_cast<long long>(scene.joints.size()), "joint"),
             solver_text(scene.options.solver.method, iterations_of(scene.options.solver)));
  if (scene.options.solver.method == Solver::newton) {
    fmt::print(", {} coordinates (nq), {} degrees of freedom (nv)",
               job.plan.items(ItemKind::coordinate), job.plan.items(ItemKind::dof));
  }
  fmt::print("\n");
  print_tree(scene, model_tree(job.plan));
  print_controls(scene);
  print_tendons(scene);
  print_sites(scene);
  print_keyframes(scene);
  print_pairs(job.plan.report().pairs);
  if (!scene.exclusions.empty()) {
    fmt::print("  {} of bodies that do not collide, in addition to those of joints\n",
               counted(static_cast<long long>(scene.exclusions.size()), "pair"));
  }
  print_options(scene);
  fmt::print("\nignored or changed from the file\n");
  if (warnings.empty()) fmt::print("  nothing\n");
  for (const std::string& warning : warnings) fmt::print("  {}\n", warning);
  return kOk;
}

}  // namespace manyworlds::cli
