// Motions of one body with a reference solution.
#pragma once

#include <functional>
#include <vector>

#include "tools/invariants/similarity.hpp"

namespace manyworlds::invariants {

struct Model {
  Scene scene;
  BodyId body;                              // the one that is compared
  double length = 1;                        // m, of errors
  bool turns = false;                       // rotations are compared, too
  std::vector<Body> starts;                 // the body in each world of the sample
  std::vector<std::vector<BodyNow>> right;  // [world][step], from step 0 on
};

struct ModelDraw {
  Random& kind;
  Random& state;
  const Scale& scale;
};

struct ModelType {
  const char* id;
  const char* title;
  std::function<Model(ModelDraw&)> draw;
};
std::vector<ModelType> model_types();  // all

std::vector<ModelType> sliding_models();   // similarity_models.cpp
std::vector<ModelType> rotating_models();  // similarity_rotating.cpp

inline constexpr int kSamples = 8;  // worlds whose mean error counts

}  // namespace manyworlds::invariants
