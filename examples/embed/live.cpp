// A batch in a browser while it steps: what component live of the package is for.
//   embed_live share/manyworlds/viewer.html
#include <manyworlds/live.hpp>
#include <manyworlds/manyworlds.hpp>

#include <cstdio>

namespace mw = manyworlds;

int main(int argc, char** argv) {
  mw::Batch batch(mw::compile(mw::scenes::find("ball3d")->make()), {.worlds = 16});
  try {
    mw::Live live(batch, {.page = argc > 1 ? argv[1] : "viewer.html"});
    std::printf("%s\n", live.url().c_str());
    for (int i = 0; i < 600; ++i) {
      live.apply(batch);
      batch.step();
      live.show(batch);
    }
  } catch (const mw::LiveError& error) {
    std::printf("%s\n", error.what());
    return argc > 1 ? 1 : 0;
  }
}
