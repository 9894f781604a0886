// validate(): every issue of a scene, in the order in which its members are declared.
#include "src/scene/checks.hpp"

namespace manyworlds {

std::string to_string(const Issue& issue) { return issue.place + " " + issue.message; }

std::vector<Issue> validate(const Scene& scene) {
  std::vector<Issue> issues;
  detail::Checker checker(issues, scene.space);

  const auto check_count = [&](const char* what, std::size_t count, int most) {
    if (count <= static_cast<std::size_t>(most)) return;
    checker.add(what, "are " + std::to_string(count) + ", must be at most " + std::to_string(most));
  };
  std::size_t shapes = 0;
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) {
      const auto* terrain = std::get_if<Terrain>(&shape.geometry);
      shapes += terrain != nullptr ? terrain->points.size() : 1;  // a collider for every segment
    }
  }
  check_count("bodies", scene.bodies.size(), detail::kMostBodies);
  check_count("shapes", shapes, detail::kMostShapes);
  check_count("joints", scene.joints.size(), detail::kMostBodies);
  check_count("controls", scene.controls.size(), detail::kMostBodies);
  check_count("attractors", scene.attractors.size(), detail::kMostBodies);

  // Needed before the bodies, whose masses depend on the default density, but listed after them.
  std::vector<Issue> option_issues;
  check_options(detail::Checker(option_issues, scene.space), scene.options);
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
  const bool sound = issues.empty() && option_issues.empty();
  issues.insert(issues.end(), option_issues.begin(), option_issues.end());
  check_variations(checker, scene, sound);
  return issues;
}

}  // namespace manyworlds
