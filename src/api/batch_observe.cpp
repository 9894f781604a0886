// The observers' side of the public Batch.
#include <algorithm>

#include "src/api/batch_data.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace {

ObserverResults& results_of(BatchCore& core) {
  ObserverResults* found = core.observer_results();
  if (!found) reject("nothing is observed: choose observers in BatchOptions::observe");
  return *found;
}

void check_observed_size(Observed what, std::size_t got, std::size_t wanted) {
  if (got != wanted) {
    reject(std::string(to_string(what)) + " has " + std::to_string(wanted) +
           " values, the buffer has " + std::to_string(got));
  }
}

void check_count(std::size_t got, std::size_t wanted) {
  if (got != wanted) {
    reject("set_rays: " + std::to_string(got) + " rays, the batch was made with " +
           std::to_string(wanted));
  }
}

}  // namespace

std::size_t Batch::size(Observed what) const {
  std::size_t sum = 0;
  for (const Kind& kind : impl_->kinds) {
    sum += observed_size(what, kind.plan.data(), impl_->options.observe) *
           static_cast<std::size_t>(kind.worlds);
  }
  return sum;
}

void Batch::read(Observed what, int world, std::span<double> out) const {
  const auto p = impl_->find(world);
  const Plan& plan = impl_->plan(p.kind);
  check_observed_size(what, out.size(), observed_size(what, plan.data(), impl_->options.observe));
  results_of(*impl_->core).read(what, p.kind, p.world, 1, out.data());
}

template <class Number>
void Batch::Impl::read_observed(Observed what, std::size_t wanted, std::span<Number> out) const {
  check_observed_size(what, out.size(), wanted);
  const ObserverResults& results = results_of(*core);
  std::size_t at = 0;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const int count = kinds[k].worlds;
    results.read(what, static_cast<int>(k), 0, count, out.data() + at);
    at += observed_size(what, kinds[k].plan.data(), options.observe) *
          static_cast<std::size_t>(count);
  }
}
void Batch::read(Observed what, Reals out) const {
  std::visit([&](auto to) { impl_->read_observed(what, size(what), to); }, out);
}

std::vector<StepContact> Batch::step_contacts(int world) const {
  const auto p = impl_->find(world);
  return results_of(*impl_->core).contacts(p.kind, p.world);
}

bool Batch::touching(int world, BodyId body) const {
  const auto p =
      impl_->find_body(world, body, "its contacts are not observed; query the other body");
  std::vector<double> all(static_cast<std::size_t>(impl_->plan(p.kind).bodies()));
  read(Observed::touching, world, all);
  return all[static_cast<std::size_t>(p.row)] != 0;
}

bool Batch::touching(int world, BodyId body_a, BodyId body_b) const {
  for (const BodyId body : {body_a, body_b}) impl_->find_any_body(world, body);
  const auto all = step_contacts(world);
  return std::any_of(all.begin(), all.end(), [&](const StepContact& c) {
    return c.normal_impulse > 0 && ((c.body_a == body_a && c.body_b == body_b) ||
                                    (c.body_a == body_b && c.body_b == body_a));
  });
}

std::vector<RayHit> Batch::ray_hits(int world) const {
  const FloatMode mode;
  const std::size_t rays = impl_->options.observe.rays.size();
  const std::size_t dim = plan().scene().space == Space::planar ? 2 : 3;
  std::vector<double> distance(rays), normal(rays * dim), body(rays), shape(rays);
  read(Observed::ray_distance, world, distance);
  read(Observed::ray_normal, world, normal);
  read(Observed::ray_body, world, body);
  read(Observed::ray_shape, world, shape);
  std::vector<RayHit> out(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    out[i].distance = distance[i];
    out[i].body = BodyId(static_cast<int>(body[i]));
    if (out[i].body) out[i].shape = ShapeId(out[i].body, static_cast<int>(shape[i]));
    for (std::size_t c = 0; c < dim; ++c) {
      out[i].normal[static_cast<Eigen::Index>(c)] = normal[i * dim + c];
    }
  }
  return out;
}

void Batch::set_rays(std::span<const Ray> rays) {
  const FloatMode mode;
  check_count(rays.size(), impl_->options.observe.rays.size());
  for (const Kind& kind : impl_->kinds) {
    check_rays(rays, kind.plan);
  }
  results_of(*impl_->core).set_rays(rays);
  impl_->core->look_again();
  impl_->options.observe.rays.assign(rays.begin(), rays.end());
}

void Batch::set_rays(int world, std::span<const Ray> rays) {
  const FloatMode mode;
  const auto p = impl_->find(world);
  const auto& shared = impl_->options.observe.rays;
  check_count(rays.size(), shared.size());
  check_rays(rays, impl_->plan(p.kind));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].body != shared[i].body || rays[i].mask != shared[i].mask) {
      reject("rays[" + std::to_string(i) +
             "]: body and mask are the same in all worlds, set_rays of one world cannot change "
             "them");
    }
  }
  results_of(*impl_->core).set_rays(p.kind, p.world, rays);
  impl_->core->look_again();
}

void Batch::look() {
  results_of(*impl_->core);
  impl_->core->look(*impl_->executor);
}

}  // namespace manyworlds
