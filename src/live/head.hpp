// What a page is told before any frame: the worlds' looks, and what it may command.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/live.hpp"
#include "src/live/hub.hpp"
#include "src/page/json.hpp"
#include "src/page/look.hpp"

namespace manyworlds::live {

// Within which range a page's sliders are, of all worlds at once; absent where there is none.
struct Sliders {
  bool gravity = false;
  Vec3 gravity_low = Vec3::Zero(), gravity_high = Vec3::Zero();
  bool friction = false;
  double friction_low = 1, friction_high = 1;  // factors of the scene's coefficients
};
Sliders sliders_of(const Sizes& sizes);

// Made once, by the thread that has the batch; the rest by the one that serves.
class Head {
 public:
  Head(const Batch& batch, const Sizes& sizes, const LiveOptions& options);

  // As JSON of `worlds` worlds.
  std::string of(int worlds, const VariedSizes& varied) const;
  // Sizes alone, where they have changed.
  std::string sizes_of(int worlds, const VariedSizes& varied) const;

  // What shapes measure in each world now; of all kinds that there are.
  VariedSizes measure(const Batch& batch);
  bool any_varies() const { return any_varies_; }
  // There is always somebody who answers pages: run().
  bool steps_itself() const { return steps_itself_; }

 private:
  page::Json kinds_of(int worlds, const VariedSizes& varied) const;

  Sizes sizes_;
  page::Meshes meshes_;  // of the thread that has the batch
  std::vector<page::Json> looks_;
  page::Json rest_;
  int first_worlds_;
  bool any_varies_ = false, steps_itself_;
};

}  // namespace manyworlds::live
