#include "src/page/sizes.hpp"

#include <algorithm>
#include <utility>

namespace manyworlds::page {

std::vector<VariedSize> sizes_of(const Batch& batch, int first, int worlds, Meshes& meshes) {
  if (worlds == 0) return {};
  const Scene& scene = batch.plan(batch.kind_of(first)).scene();
  const bool vary = std::any_of(scene.variations.begin(), scene.variations.end(),
                                [](const Variation& v) { return v.parameter == Parameter::size; });
  if (!vary) return {};
  std::vector<const Shape*> shapes;
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) shapes.push_back(&shape);
  }
  std::vector<std::vector<float>> found(shapes.size());
  std::vector<bool> differs(shapes.size());
  std::vector<double> sizes(3 * shapes.size());
  for (int w = 0; w < worlds; ++w) {
    batch.read(Parameter::size, first + w, sizes);
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      const Vec3 size(sizes[3 * s], sizes[3 * s + 1], sizes[3 * s + 2]);
      if (!(size.x() > 0)) continue;
      const Meshes::Use use = meshes.use(shapes[s]->geometry, size);
      const Meshes::Use plain = meshes.use(shapes[s]->geometry);
      // Sizes are kept in the number type of the batch.
      const double near = 1e-5 * plain.size.norm();
      if (!use.size.isApprox(plain.size, 1e-5) || (use.stretch - plain.stretch).norm() > near) {
        differs[s] = true;
      }
      for (const Vec3& v : {use.size, use.stretch}) {
        for (const double x : v) found[s].push_back(static_cast<float>(x));
      }
    }
  }
  std::vector<VariedSize> out;
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    if (differs[s]) out.push_back({s, std::move(found[s])});
  }
  return out;
}

}  // namespace manyworlds::page
