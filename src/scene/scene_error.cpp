#include "manyworlds/plan.hpp"

namespace manyworlds {
namespace {

// "the scene has 2 issues:" and one line for each.
std::string report(const std::string& subject, const std::vector<Issue>& issues) {
  std::string text = "the " + subject + " has " + std::to_string(issues.size()) +
                     (issues.size() == 1 ? " issue:" : " issues:");
  for (const Issue& issue : issues) text += "\n  " + to_string(issue);
  return text;
}

}  // namespace

SceneError::SceneError(std::vector<Issue> issues) : SceneError("scene", std::move(issues)) {}

SceneError::SceneError(const char* subject, std::vector<Issue> issues)
    : std::invalid_argument(report(subject, issues)), issues_(std::move(issues)) {}

}  // namespace manyworlds
