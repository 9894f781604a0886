// validate(): every issue of a scene, in the order in which its members are declared.
#include "src/base/float_mode.hpp"
#include "src/scene/checks.hpp"
#include "src/scene/height_field.hpp"

namespace manyworlds {

namespace {

// Shapes that lie over many cells of a height field would meet all of their triangles.
void check_tiles(detail::Checker& checker, const Scene& scene) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    for (std::size_t k = 0; k < scene.bodies[b].shapes.size(); ++k) {
      const auto* field = std::get_if<HeightField>(&scene.bodies[b].shapes[k].geometry);
      if (field == nullptr) continue;
      const TileCount tiles = tiles_of(*field, scene);
      if (tiles.count() <= kMaxTiles) continue;
      std::string part = "body " + std::to_string(b);
      if (!scene.bodies[b].name.empty()) part += " '" + scene.bodies[b].name + "'";
      checker.at(part + ", shape " + std::to_string(k))
          .add("cell", "is " + detail::vector_text(field->cell) +
                           " m: the largest moving shape can cover " +
                           std::to_string(tiles.count()) + " triangles, must be at most " +
                           std::to_string(kMaxTiles));
    }
  }
}

}  // namespace

std::string to_string(const Issue& issue) { return issue.place + " " + issue.message; }

std::vector<Issue> validate(const Scene& scene) {
  const FloatMode mode;
  std::vector<Issue> issues;
  detail::Checker checker(issues, scene.space);
  if (!checker.named("space", scene.space)) return issues;  // what holds depends on it

  const auto check_count = [&](const char* what, std::size_t count, int most) {
    if (count <= static_cast<std::size_t>(most)) return;
    checker.add(what, "are " + std::to_string(count) + ", must be at most " + std::to_string(most));
  };
  std::size_t shapes = 0;
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) {
      const auto* terrain = std::get_if<Terrain>(&shape.geometry);
      // A collider for every segment or tile.
      shapes += terrain != nullptr                                    ? terrain->points.size()
                : std::holds_alternative<HeightField>(shape.geometry) ? kMaxTiles
                                                                      : 1;
    }
  }
  check_count("bodies", scene.bodies.size(), detail::kMaxBodies);
  check_count("shapes", shapes, detail::kMaxShapes);
  check_count("joints", scene.joints.size(), detail::kMaxBodies);
  check_count("controls", scene.controls.size(), detail::kMaxBodies);
  check_count("attractors", scene.attractors.size(), detail::kMaxBodies);
  check_count("sites", scene.sites.size(), detail::kMaxShapes);
  check_count("keyframes", scene.keyframes.size(), detail::kMaxBodies);

  // Needed before the bodies, whose masses depend on the default density, but listed after them.
  std::vector<Issue> option_issues;
  check_options(detail::Checker(option_issues, scene.space), scene.options);
  check_impact_sweeps(detail::Checker(option_issues, scene.space), scene);
  bool density_valid = true;
  for (const Issue& issue : option_issues) density_valid &= issue.place != "options.density";

  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    std::string part = "body " + std::to_string(i);
    if (!body.name.empty()) part += " '" + body.name + "'";
    check_body(checker.at(part), scene, body, density_valid);
  }
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const Joint& joint = scene.joints[i];
    std::string part = "joint " + std::to_string(i);
    if (!joint.name.empty()) part += " '" + joint.name + "'";
    check_joint(checker.at(part), scene, joint);
  }
  for (std::size_t i = 0; i < scene.controls.size(); ++i) {
    const Control& control = scene.controls[i];
    std::string part = "control " + std::to_string(i);
    if (!control.name.empty()) part += " '" + control.name + "'";
    check_control(checker.at(part), scene, i);
  }
  for (std::size_t i = 0; i < scene.attractors.size(); ++i) {
    const Attractor& attractor = scene.attractors[i];
    detail::Checker at = checker.at("attractor " + std::to_string(i));
    at.finite("position", attractor.position, "m");
    at.finite("strength", attractor.strength, "m^3/s^2");
    at.not_negative("softening", attractor.softening, "m");
  }
  detail::check_newton(checker, scene, issues.empty() && option_issues.empty());
  const int bodies = static_cast<int>(scene.bodies.size());
  for (std::size_t i = 0; i < scene.exclusions.size(); ++i) {
    const Exclusion& exclusion = scene.exclusions[i];
    detail::Checker at = checker.at("exclusion " + std::to_string(i));
    const auto check = [&](const char* name, BodyId body) {
      if (0 <= body.index() && body.index() < bodies) return;
      at.add(name, "is " + std::to_string(body.index()) + ", must be a body, 0 to " +
                       std::to_string(bodies - 1));
    };
    check("body_a", exclusion.body_a), check("body_b", exclusion.body_b);
  }
  for (std::size_t i = 0; i < scene.sites.size(); ++i) {
    const Site& site = scene.sites[i];
    detail::Checker at = checker.at(detail::named_part("site", i, site.name));
    if (site.body.index() < -1 || site.body.index() >= bodies) {
      at.add("body", "is " + std::to_string(site.body.index()) +
                         ", must be a body, or -1 for the world, up to " +
                         std::to_string(bodies - 1));
    }
    at.finite("position", site.position, "m");
  }
  detail::check_keyframes(checker, scene, issues.empty() && option_issues.empty());
  detail::check_coordinate_draws(checker, scene, issues.empty() && option_issues.empty());
  const bool sound = issues.empty() && option_issues.empty();
  issues.insert(issues.end(), option_issues.begin(), option_issues.end());
  check_variations(checker, scene, sound);
  if (sound && issues.empty()) check_tiles(checker, scene);
  return issues;
}

}  // namespace manyworlds
