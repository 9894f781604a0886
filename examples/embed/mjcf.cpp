// A ball from an MJCF text: what component mjcf of the package is for.
#include <manyworlds/manyworlds.hpp>
#include <manyworlds/mjcf.hpp>

#include <cstdio>

namespace mw = manyworlds;

int main() {
  const mw::MjcfResult read = mw::load_mjcf_string(
      "<mujoco><worldbody><geom type='plane' size='5 5 1'/>"
      "<body pos='0 0 1'><freejoint/><geom size='0.25'/></body></worldbody></mujoco>");
  mw::Batch batch(mw::compile(read.scene), {.worlds = 16});
  batch.step(60);
  std::printf("%zu bodies, %d worlds lost\n", read.scene.bodies.size(), batch.lost_worlds());
  return batch.lost_worlds() == 0 ? 0 : 1;
}
