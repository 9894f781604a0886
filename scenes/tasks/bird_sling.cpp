// The scene bird-sling as a design problem: one action, how strongly and how steeply the bird is
// slung, and then the world runs. The reward is how many boxes are displaced.
#include "manyworlds/scenes.hpp"
#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {

Task bird_sling() {
  using namespace terms;
  constexpr double kMaxSpeed = 25, kSteepest = 1.3, kMinShift = 0.4;  // m/s, rad, m
  Task task;
  task.name = "BirdSling";
  task.scene = scenes::find("bird-sling")->make();
  Scene& scene = task.scene;
  task.frame_skip = 6;
  BodyId bird;
  std::vector<BodyId> boxes;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    Body& body = scene.at(BodyId(i));
    if (body.name == "bird") {
      bird = BodyId(i);
      body.linear_velocity = Vec3::Zero();
      body.jitter.linear_velocity = Vec3::Zero();
    } else if (body.motion == Motion::dynamic) {
      boxes.emplace_back(i);
    }
  }
  // The sling pulls during the first step of the task.
  const Body& slung = scene.at(bird);
  const double mass = mass_properties(scene, slung).mass;
  const double most = mass * kMaxSpeed / (scene.options.dt * task.frame_skip);
  scene.controls = {thrust("pull x", bird, Vec3::Zero(), {1, 0, 0}, 0, most),
                    thrust("pull y", bird, Vec3::Zero(), {0, 1, 0}, 0, most)};
  task.actions = {{"strength", 0, 1}, {"steepness", 0, 1}};
  const Expression pull = select(equal(previous(age()), 0), most * action(0), 0);
  task.controls = {pull * cos(kSteepest * action(1)), pull * sin(kSteepest * action(1))};

  const auto see = [&](const char* name, const Expression& e) {
    task.observations.push_back({name, e});
  };
  see("bird x", position(bird, 0));
  see("bird y", position(bird, 1));
  see("bird vx", velocity(bird, 0));
  see("bird vy", velocity(bird, 1));
  Expression shifted = 0;
  for (const BodyId box : boxes) {
    const Vec3& home = scene.at(box).position;
    shifted =
        shifted + (abs(position(box, 0) - home.x()) + abs(position(box, 1) - home.y()) > kMinShift);
  }
  see("boxes shifted", shifted);
  task.rewards = {{"boxes", shifted - previous(shifted)},
                  {"effort", select(equal(age(), 1), -0.5 * action(0), 0)}};
  task.max_steps = 60;
  return task;
}

}  // namespace manyworlds::tasks
