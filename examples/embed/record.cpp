// A recording, written and simulated again: what component record of the package is for.
#include <manyworlds/manyworlds.hpp>
#include <manyworlds/record.hpp>

#include <cstdio>

namespace mw = manyworlds;

int main() {
  mw::Batch batch(mw::compile(mw::scenes::find("ball3d")->make()), {.worlds = 16});
  {
    mw::Recorder recorder(batch, "embed.h5");
    batch.step(30);
    recorder.close();
  }
  const mw::ReplayResult again = mw::replay(mw::Recording::open("embed.h5"));
  std::printf("%lld of %lld differ\n", static_cast<long long>(again.different),
              static_cast<long long>(again.compared));
  return again.different == 0 && again.compared > 0 ? 0 : 1;
}
