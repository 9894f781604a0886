#include "manyworlds/gymnasium_mjcf.hpp"

#include <stdexcept>
#include <vector>

namespace manyworlds::gymnasium {

namespace {

// What make() says of the model is said of its file.
template <class Make>
Task of_file(const Path& file, const MjcfOptions& files, Make make) {
  const Scene model = load_mjcf(file, files).scene;
  try {
    return make(model);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(file.string() + ": " + error.what());
  }
}
template <class Options>
Task of_file(const Path& file, const Options& options, const MjcfOptions& files,
             Task (*make)(const Scene&, const Options&)) {
  return of_file(file, files, [&](const Scene& model) { return make(model, options); });
}

template <class List>
std::string names_of(const List& list) {
  std::string out;
  for (const auto& one : list) out += (out.empty() ? "" : ", ") + std::string(one.name);
  return out;
}

}  // namespace

Task inverted_pendulum(const Path& model, const InvertedPendulumOptions& options,
                       const MjcfOptions& files) {
  return of_file(model, options, files, inverted_pendulum);
}
Task inverted_double_pendulum(const Path& model, const InvertedDoublePendulumOptions& options,
                              const MjcfOptions& files) {
  return of_file(model, options, files, inverted_double_pendulum);
}
Task reacher(const Path& model, const ReacherOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, reacher);
}
Task pusher(const Path& model, const PusherOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, pusher);
}
Task swimmer(const Path& model, const SwimmerOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, swimmer);
}
Task half_cheetah(const Path& model, const HalfCheetahOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, half_cheetah);
}
Task hopper(const Path& model, const HopperOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, hopper);
}
Task walker2d(const Path& model, const Walker2dOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, walker2d);
}
Task ant(const Path& model, const AntOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, ant);
}
Task humanoid(const Path& model, const HumanoidOptions& options, const MjcfOptions& files) {
  return of_file(model, options, files, humanoid);
}
Task humanoid_standup(const Path& model, const HumanoidStandupOptions& options,
                      const MjcfOptions& files) {
  return of_file(model, options, files, humanoid_standup);
}

Task task_of_file(std::string_view name, const Path& model, const Arguments& arguments,
                  const MjcfOptions& files) {
  const Entry* const entry = find(name);
  if (entry == nullptr) {
    throw std::invalid_argument("there is no task '" + std::string(name) + "'; there are " +
                                names_of(all()));
  }
  std::vector<Argument> values = entry->arguments;
  std::string unknown;
  for (const auto& [given, value] : arguments) {
    bool known = false;
    for (Argument& argument : values) {
      if (argument.name != given) continue;
      argument.value = value;
      known = true;
    }
    if (!known) unknown += (unknown.empty() ? "'" : ", '") + given + "'";
  }
  if (!unknown.empty()) {
    throw std::invalid_argument(std::string(name) + " has no argument " + unknown + "; it has " +
                                names_of(entry->arguments));
  }
  return of_file(model, files, [&](const Scene& scene) { return entry->make(scene, values); });
}

}  // namespace manyworlds::gymnasium
