// What a user may do to a batch between steps, out of a fuzzer's bytes.
#pragma once

#include <vector>

#include "fuzz/scene_bytes.hpp"

namespace manyworlds::fuzz {

struct Input {
  int kind = 0, world = 0, body = 0;
  Vec3 value = Vec3::Zero(), point = Vec3::Zero();
  double number = 0;
};
Input input(SceneBytes& bytes);
// The same for every batch of the same worlds and bodies.
void apply(const Input& input, Batch& batch);

// Steps, then looks at everything that can be asked of a batch: worlds that step must be
// finite.
void step_and_look(Batch& batch, int steps);

}  // namespace manyworlds::fuzz
