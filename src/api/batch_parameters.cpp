// Batch: numbers of the scene that differ from world to world.
#include "src/api/batch_data.hpp"

namespace manyworlds {

std::size_t Batch::size(Parameter parameter) const { return impl_->size(parameter); }

void Batch::read(Parameter parameter, std::span<double> out) const {
  impl_->check_size(parameter, out.size(), size(parameter));
  impl_->for_each_world(parameter, [&](int kind, int world, std::size_t at) {
    impl_->worlds(kind).read(parameter, world, out.data() + at);
  });
}

void Batch::write(Parameter parameter, std::span<const double> in) {
  impl_->check_size(parameter, in.size(), size(parameter));
  impl_->for_each_world(parameter, [&](int kind, int world, std::size_t at) {
    const std::string problem = impl_->worlds(kind).check(parameter, world, in.data() + at);
    if (problem.empty()) return;
    const int first = impl_->first_world[static_cast<std::size_t>(kind)];
    reject("world " + std::to_string(first + world) + ": " + problem);
  });
  impl_->for_each_world(parameter, [&](int kind, int world, std::size_t at) {
    impl_->worlds(kind).write(parameter, world, in.data() + at);
  });
  for (int w = 0; w < worlds(); ++w) impl_->tell(*this, Input::restore, w);
}

void Batch::read(Parameter parameter, int world, std::span<double> out) const {
  const auto p = impl_->find(world);
  impl_->check_size(parameter, out.size(), impl_->world_size(parameter, p.kind));
  impl_->worlds(p.kind).read(parameter, p.world, out.data());
}

void Batch::write(Parameter parameter, int world, std::span<const double> in) {
  const auto p = impl_->find(world);
  impl_->check_size(parameter, in.size(), impl_->world_size(parameter, p.kind));
  const std::string problem = impl_->worlds(p.kind).check(parameter, p.world, in.data());
  if (!problem.empty()) reject("world " + std::to_string(world) + ": " + problem);
  impl_->worlds(p.kind).write(parameter, p.world, in.data());
  impl_->tell(*this, Input::restore, world);
}

}  // namespace manyworlds
