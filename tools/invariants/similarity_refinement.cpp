// Halving the step, or doubling substeps, does not make errors larger, where a closed form or a
// fine integration is the reference. A world of these families is a sample of some worlds of one
// plan, since a single error may be small by chance: their mean counts, which depends less on one
// of few than their median.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/invariants/similarity_models.hpp"

namespace manyworlds::invariants {
namespace {

class Refined {
 public:
  Refined(Model model, double length, int steps)
      : model_(std::move(model)), length_(length), steps_(steps) {}

  // All at the end, since the precision is seen by then.
  double operator()(const Seen& seen) const {
    if (!seen.last) return 0;
    const Precision precision = seen.precision;
    // Sums of rounding errors, in lengths and radians, that refinement may increase.
    const double floor = precision == Precision::f32 ? 2e-4 : 1e-8;
    const double coarse = mean(precision, 1, 1), half = mean(precision, 2, 1);
    const double substeps = mean(precision, 1, 2);
    return std::max(half, substeps) / std::max(coarse, floor);
  }

 private:
  double mean(Precision precision, int divide, int times) const {
    Scene scene = model_.scene;
    // What the plan chose for the coarse world stays, but for what is refined.
    scene.options.substeps = *compile(scene).resolved().substeps * times;
    scene.options.dt /= divide;
    const auto samples = static_cast<int>(model_.starts.size());
    SideWorlds worlds(scene, precision, samples);
    for (int i = 0; i < samples; ++i) {
      const Body& start = model_.starts[static_cast<std::size_t>(i)];
      scene.at(model_.body) = start;
      worlds.put(i, scene);
    }
    std::vector<double> errors(model_.starts.size(), 0);
    for (int step = 1; step <= steps_; ++step) {
      worlds.step(divide);
      for (int i = 0; i < samples; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const BodyNow& now = worlds.now(i, model_.body.index());
        const BodyNow& right = model_.right[k][static_cast<std::size_t>(step)];
        double error = (now.position - right.position).norm() / length_;
        if (model_.turns) error += now.rotation.angularDistance(right.rotation);
        errors[k] = std::isfinite(error) ? std::max(errors[k], error) : HUGE_VAL;
      }
    }
    return std::accumulate(errors.begin(), errors.end(), 0.0) / samples;
  }

  Model model_;
  double length_;
  int steps_;
};

}  // namespace

std::vector<Family> refinement_families() {
  std::vector<Family> all;
  for (const ModelType& type : model_types()) {
    Family f;
    f.id = std::string("refinement: ") + type.id, f.law = Law::similarity;
    f.title = type.title;
    f.criterion = "mean error at half the step or twice the substeps over that of the step";
    f.limit = 1.1;
    f.draw = [draw = type.draw](Random& kind, Random& state, const Scale& scale) {
      ModelDraw in{kind, state, scale};
      Model model = draw(in);
      Drawn out;
      out.steps = static_cast<int>(model.right[0].size()) - 1;
      out.scene = model.scene;
      out.scene.at(model.body) = model.starts[0];
      const double length = model.length;
      out.judge = Refined(std::move(model), length, out.steps);
      return out;
    };
    all.push_back(std::move(f));
  }
  return all;
}

}  // namespace manyworlds::invariants
