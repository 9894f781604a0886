// Batch: numbers of the scene that differ from world to world, and where worlds begin.
#include "src/api/batch_data.hpp"

namespace manyworlds {

std::size_t Batch::size(Parameter parameter) const {
  std::size_t total = 0;
  for (std::size_t k = 0; k < impl_->kinds.size(); ++k) {
    total += impl_->world_size(parameter, static_cast<int>(k)) *
             static_cast<std::size_t>(impl_->kinds[k].worlds);
  }
  return total;
}

void Batch::read(Parameter parameter, std::span<double> out) const {
  impl_->check_size(parameter, out.size(), size(parameter));
  impl_->for_each_world(parameter, [&](int kind, int world, std::size_t at) {
    impl_->core->read(parameter, kind, world, out.data() + at);
  });
}

void Batch::write(Parameter parameter, std::span<const double> in) {
  impl_->check_size(parameter, in.size(), size(parameter));
  impl_->for_each_world(parameter, [&](int kind, int world, std::size_t at) {
    const std::string problem = impl_->core->check(parameter, kind, world, in.data() + at);
    if (problem.empty()) return;
    const int first = impl_->first_world[static_cast<std::size_t>(kind)];
    reject("world " + std::to_string(first + world) + ": " + problem);
  });
  impl_->for_each_world(parameter, [&](int kind, int world, std::size_t at) {
    impl_->core->write(parameter, kind, world, in.data() + at);
  });
  for (int w = 0; w < worlds(); ++w) impl_->tell(*this, Input::restore, w);
}

void Batch::read(Parameter parameter, int world, std::span<double> out) const {
  const auto p = impl_->find(world);
  impl_->check_size(parameter, out.size(), impl_->world_size(parameter, p.kind));
  impl_->core->read(parameter, p.kind, p.world, out.data());
}

void Batch::write(Parameter parameter, int world, std::span<const double> in) {
  const auto p = impl_->find(world);
  impl_->check_size(parameter, in.size(), impl_->world_size(parameter, p.kind));
  const std::string problem = impl_->core->check(parameter, p.kind, p.world, in.data());
  if (!problem.empty()) reject("world " + std::to_string(world) + ": " + problem);
  impl_->core->write(parameter, p.kind, p.world, in.data());
  impl_->tell(*this, Input::restore, world);
}

void Batch::set_initial(Field field, std::span<const double> in) {
  const bool forget = in.empty() && size(field) > 0;
  if (!forget) impl_->check_size(field, in.size(), size(field));
  impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
    impl_->core->set_initial(field, kind, world, forget ? nullptr : in.data() + at);
  });
}

}  // namespace manyworlds
