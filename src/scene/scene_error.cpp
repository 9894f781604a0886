#include "manyworlds/plan.hpp"

namespace manyworlds {
namespace {

// "the scene has 2 issues:" and one line for each.
std::string report(const std::vector<Issue>& issues) {
  std::string text = "the scene has " + std::to_string(issues.size()) +
                     (issues.size() == 1 ? " issue:" : " issues:");
  for (const Issue& issue : issues) text += "\n  " + to_string(issue);
  return text;
}

}  // namespace

SceneError::SceneError(std::vector<Issue> issues)
    : std::invalid_argument(report(issues)), issues_(std::move(issues)) {}

}  // namespace manyworlds
