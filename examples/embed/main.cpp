// A ball dropped on the ground, in 1024 worlds that differ by where it starts.
#include <manyworlds/manyworlds.hpp>

#include <cstdio>
#include <vector>

namespace mw = manyworlds;

int main() {
  mw::Scene scene;
  mw::Body ground;
  ground.motion = mw::Motion::fixed;
  ground.shapes = {{.geometry = mw::Plane{}}};
  scene.add(ground);

  mw::Body ball;
  ball.position = {0, 0, 2};           // m
  ball.jitter.position = {1, 1, 0.5};  // m, half range of a uniform draw
  ball.shapes = {{.geometry = mw::Sphere{.radius = 0.25}}};
  scene.add(ball);

  mw::Batch batch(mw::compile(scene), {.worlds = 1024, .seed = 7});
  batch.step(120);  // 2 s

  std::vector<double> position(batch.size(mw::Field::position));  // [world][body][3]
  batch.read(mw::Field::position, position);
  double mean_height = 0;
  for (std::size_t i = 2; i < position.size(); i += 3) mean_height += position[i] / batch.worlds();
  std::printf("%d worlds, %s: mean height %.3f m, hash %016llx\n", batch.worlds(),
              batch.kernel_table().c_str(), mean_height,
              static_cast<unsigned long long>(batch.hash()));
  return batch.lost_worlds() == 0 && mean_height > 0.2 && mean_height < 0.3 ? 0 : 1;
}
