#include "src/api/observations.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace manyworlds {

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <class... Arrays>
std::size_t bytes_of(const Arrays&... arrays) {
  return (std::size_t{0} + ... + (arrays.size() * sizeof(*arrays.data())));
}

}  // namespace

template <class Real>
bool ObservationsOf<Real>::has(Observer observer) const {
  return std::count(observers_.what.begin(), observers_.what.end(), observer) > 0;
}

template <class Real>
ObservationsOf<Real>::ObservationsOf(const AllWorlds& worlds, const Observers& observers,
                                     const kernels::KernelTable<Real>& kernels)
    : worlds_(worlds), observers_(observers), kernels_(kernels), kinds_(worlds.size()) {
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    Kind& kind = kinds_[k];
    const auto& w = *worlds_[k];
    const std::size_t n = at(w.count()), rays = observers_.rays.size();
    if (has(Observer::motion)) kind.motion.resize(n * kernels::kMotionRows);
    if (has(Observer::penetration)) kind.penetration.resize(n);
    if (has(Observer::residual)) kind.residual.resize(n * kernels::kResidualRows);
    const PlanData& plan = w.data();
    if (has(Observer::joints)) {
      kind.coordinate_rows.resize(n * plan.coordinates.size() * kernels::kCoordinateRows);
    }
    if (has(Observer::joint_loads)) {
      kind.joint_rows.resize(n * plan.scene.joints.size() * kernels::kJointRows);
      for (const PlanPart& part : plan.parts) kind.joint_of_part.push_back(part.joint);
    }
    if (has(Observer::touching)) kind.touching.resize(n * at(w.tables().bodies));
    if (has(Observer::contacts)) {
      kind.room = observers_.contacts_per_world;
      const int several = w.tables().dimension == kernels::Dimension::planar ? 2 : 4;
      for (int l = 0; l < kernels::kLists && observers_.contacts_per_world == 0; ++l) {
        kind.room +=
            w.tables().capacity[l] * (is_multi(static_cast<kernels::ListId>(l)) ? several : 1);
      }
      kind.count.resize(n);
      kind.contacts.resize(n * at(kind.room));
    }
    kind.rays.resize(rays);
    kind.ray_rows.resize(n * rays * kernels::kRayRows);
    kind.hit_rows.resize(n * rays * kernels::kHitRows);
    kind.hit_shape.assign(n * rays, -1);
    for (const PlanFixed& f : plan.fixed) {
      const Body& body = w.plan().scene().bodies[at(f.scene_body)];
      kind.fixed_category.push_back(body.shapes[at(f.shape)].filter.category);
    }
  }
  set_rays(observers_.rays);
}

template <class Real>
void ObservationsOf<Real>::add_thread(std::span<kernels::Scratch* const> scratch) {
  auto& blocks = blocks_.emplace_back();
  for (std::size_t k = 0; k < kinds_.size(); ++k) blocks.push_back(make_block(k, scratch[k]));
}

template <class Real>
typename ObservationsOf<Real>::Block ObservationsOf<Real>::make_block(
    std::size_t k, kernels::Scratch* scratch) const {
  const Kind& kind = kinds_[k];
  const auto& t = worlds_[k]->tables();
  const kernels::ObserverTable<Real>& observer = *kernels_.observer;
  const std::size_t lanes = at(kernels_.lanes), bodies = at(t.bodies), rays = kind.rays.size();
  Block block;
  auto& view = block.view;
  const auto reals = [&](std::size_t count) { return block.reals.emplace_back(count).data(); };
  const bool impulses = has(Observer::contacts) || has(Observer::touching);
  view.slots = impulses || has(Observer::penetration);
  for (int l = 0; t.has_contacts && view.slots && l < kernels::kLists; ++l) {
    view.places[l] = reals(observer.place_reals(t, scratch, l));
    if (impulses && !t.has_restitution) {
      view.totals[l] = reals(observer.total_reals(t, scratch, l));
    }
  }
  if (view.slots) {
    block.nobody = AlignedBuffer<std::uint32_t>(bodies);
    view.nobody = block.nobody.data();
  }
  if (has(Observer::penetration)) view.penetration = reals(lanes);
  if (has(Observer::residual)) {
    view.residual = reals(kernels::kResidualRows * lanes);
    block.aside =
        AlignedBuffer<unsigned char>(t.has_substeps ? observer.aside_bytes(t, scratch) : 0);
    view.aside = block.aside.data();
  }
  if (has(Observer::touching)) {
    block.touching = AlignedBuffer<std::uint32_t>(bodies);
    view.touching = block.touching.data();
  }
  if (has(Observer::contacts)) {
    block.count = AlignedBuffer<std::int32_t>(lanes);
    block.contacts = AlignedBuffer<kernels::ContactImpulse<Real>>(lanes * at(kind.room) + 1);
    view.count = block.count.data();
    view.contacts = block.contacts.data();
    view.room = kind.room;
  }
  if (has(Observer::motion)) view.motion = reals(kernels::kMotionRows * lanes);
  const PlanData& plan = worlds_[k]->data();
  if (has(Observer::joints)) {
    view.coordinates = static_cast<std::int32_t>(plan.coordinates.size());
    view.coordinate = plan.coordinates.data();
    view.coordinate_rows = reals(plan.coordinates.size() * kernels::kCoordinateRows * lanes);
  }
  if (has(Observer::joint_loads)) {
    view.joints = static_cast<std::int32_t>(plan.scene.joints.size());
    view.joint_of_part = kind.joint_of_part.data();
    view.joint_rows = reals(plan.scene.joints.size() * kernels::kJointRows * lanes);
  }
  if (rays == 0) return block;
  view.rays = static_cast<std::int32_t>(rays);
  view.ray = kind.rays.data();
  view.fixed_category = kind.fixed_category.data();
  view.ray_rows = block.ray_rows = reals(rays * kernels::kRayRows * lanes);
  view.placed = reals(rays * 6 * lanes);
  view.hit_rows = reals(rays * kernels::kHitRows * lanes);
  block.hit_shape = AlignedBuffer<std::int32_t>(rays * lanes);
  view.hit_shape = block.hit_shape.data();
  block.poses = scratch;
  if (!t.has_contacts) {
    block.tables = std::make_unique<kernels::WorldTables<Real>>(t);
    block.tables->has_contacts = block.tables->has_substeps = true;
    block.pose_memory = AlignedBuffer<unsigned char>(kernels_.scratch_bytes(*block.tables));
    block.poses = kernels_.make_scratch(*block.tables, block.pose_memory.data());
  }
  return block;
}

template <class Real>
std::size_t ObservationsOf<Real>::world_bytes(std::size_t k) const {
  const Kind& kind = kinds_[k];
  return bytes_of(kind.motion, kind.penetration, kind.residual, kind.ray_rows, kind.hit_rows,
                  kind.coordinate_rows, kind.joint_rows, kind.touching, kind.count, kind.hit_shape,
                  kind.contacts) /
         at(worlds_[k]->count());
}

template <class Real>
std::size_t ObservationsOf<Real>::thread_bytes() const {
  std::size_t bytes = 0;
  for (const auto& blocks : blocks_) {
    for (const Block& b : blocks) {
      bytes +=
          bytes_of(b.count, b.hit_shape, b.touching, b.nobody, b.contacts, b.pose_memory, b.aside);
      for (const auto& reals : b.reals) bytes += bytes_of(reals);
    }
  }
  return blocks_.empty() ? 0 : bytes / blocks_.size();
}

template <class Real>
void ObservationsOf<Real>::put_ray(std::size_t k, int world, std::size_t ray, const Ray& from) {
  Kind& kind = kinds_[k];
  const PlanData& plan = worlds_[k]->data();
  Vec3 origin = from.origin, way = from.direction;
  if (plan.scene.space == Space::planar) origin.z() = way.z() = 0;
  way.normalize();
  Real* rows = kind.ray_rows.data() + (at(world) * kind.rays.size() + ray) * kernels::kRayRows;
  for (int c = 0; c < 3; ++c) {
    rows[c] = static_cast<Real>(origin[c]);
    rows[3 + c] = static_cast<Real>(way[c]);
  }
  rows[6] = static_cast<Real>(from.length);
}

template <class Real>
void ObservationsOf<Real>::set_rays(std::span<const Ray> rays) {
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    const Plan& plan = worlds_[k]->plan();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const BodyId body = rays[i].body;
      kinds_[k].rays[i] = {body ? plan.row(body) : -1, rays[i].mask};
    }
    for (int w = 0; w < worlds_[k]->count(); ++w) set_rays(static_cast<int>(k), w, rays);
  }
  observers_.rays.assign(rays.begin(), rays.end());
}

template <class Real>
void ObservationsOf<Real>::set_rays(int kind, int world, std::span<const Ray> rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) put_ray(at(kind), world, i, rays[i]);
}

template <class Real>
kernels::Scratch* ObservationsOf<Real>::poses(std::size_t thread, std::size_t kind) const {
  return blocks_[thread][kind].poses;
}

template <class Real>
const kernels::Observation<Real>& ObservationsOf<Real>::ask(std::size_t thread, std::size_t k,
                                                            int group) {
  Block& block = blocks_[thread][k];
  const Kind& kind = kinds_[k];
  const std::size_t lanes = at(kernels_.lanes);
  const std::size_t rows = kind.rays.size() * kernels::kRayRows;
  if (rows == 0) return block.view;
  for (std::size_t l = 0; l < lanes; ++l) {
    const int world =
        std::max(0, worlds_[k]->world_in(group * kernels_.lanes + static_cast<int>(l)));
    const Real* from = kind.ray_rows.data() + at(world) * rows;
    for (std::size_t i = 0; i < rows; ++i) block.ray_rows[i * lanes + l] = from[i];
    // From the user's frame to the centre of mass and principal axes that the body now has.
    for (std::size_t i = 0; i < kind.rays.size(); ++i) {
      if (kind.rays[i].body < 0) continue;
      const PlanBody& body = worlds_[k]->body_of(world, at(kind.rays[i].body));
      if (body.aligned) continue;
      const Real* ray = from + i * kernels::kRayRows;
      const auto vector = [ray](int c) {
        return Vec3(static_cast<double>(ray[c]), static_cast<double>(ray[c + 1]),
                    static_cast<double>(ray[c + 2]));
      };
      const Vec3 origin = body.principal.conjugate() * (vector(0) - body.center);
      const Vec3 way = body.principal.conjugate() * vector(3);
      Real* to = block.ray_rows + i * kernels::kRayRows * lanes + l;
      for (std::size_t c = 0; c < 3; ++c) {
        to[c * lanes] = static_cast<Real>(origin[static_cast<Eigen::Index>(c)]);
        to[(3 + c) * lanes] = static_cast<Real>(way[static_cast<Eigen::Index>(c)]);
      }
    }
  }
  return block.view;
}

template <class Real>
void ObservationsOf<Real>::take(std::size_t thread, std::size_t k, int group, std::uint32_t chosen,
                                bool stepped) {
  const kernels::Observation<Real>& view = blocks_[thread][k].view;
  Kind& kind = kinds_[k];
  const std::size_t lanes = at(kernels_.lanes), rays = kind.rays.size();
  std::array<std::pair<std::size_t, std::size_t>, kMostLanes> taken;  // lane, world
  std::size_t count = 0;
  for (std::size_t l = 0; l < lanes; ++l) {
    const int in = worlds_[k]->world_in(group * kernels_.lanes + static_cast<int>(l));
    if (in >= 0 && get_bit(chosen, l)) taken[count++] = {l, at(in)};
  }
  const auto for_each = [&](auto&& call) {
    for (std::size_t i = 0; i < count; ++i) call(taken[i].first, taken[i].second);
  };
  // [row][lane] to [world][row]
  const auto untangle = [&](auto& to, const auto* from, std::size_t rows) {
    if (rows == 0) return;
    for_each([&](std::size_t l, std::size_t w) {
      auto* own = to.data() + w * rows;
      for (std::size_t i = 0; i < rows; ++i) own[i] = from[i * lanes + l];
    });
  };
  if (view.motion) untangle(kind.motion, view.motion, kernels::kMotionRows);
  if (stepped && view.penetration) untangle(kind.penetration, view.penetration, 1);
  if (stepped && view.residual) {
    untangle(kind.residual, view.residual, kernels::kResidualRows);
    // Nor of worlds that the step has lost, or that have fallen asleep in it: groups at rest are
    // not looked at again.
    for_each([&](std::size_t, std::size_t w) {
      const int world = static_cast<int>(w);
      if (worlds_[k]->resting(world) || frozen(worlds_[k]->status(world)))
        std::fill_n(&kind.residual[w * kernels::kResidualRows], kernels::kResidualRows, Real(0));
    });
  }
  untangle(kind.coordinate_rows, view.coordinate_rows,
           at(view.coordinates) * kernels::kCoordinateRows);
  untangle(kind.joint_rows, view.joint_rows, at(view.joints) * kernels::kJointRows);
  if (stepped && view.touching) {
    const std::size_t bodies = at(worlds_[k]->tables().bodies);
    for_each([&](std::size_t l, std::size_t w) {
      for (std::size_t b = 0; b < bodies; ++b) {
        kind.touching[w * bodies + b] = static_cast<std::uint8_t>((view.touching[b] >> l) & 1u);
      }
    });
  }
  if (stepped && view.contacts) {
    for_each([&](std::size_t l, std::size_t w) {
      kind.count[w] = view.count[l];
      std::copy_n(view.contacts + l * at(kind.room), std::min(view.count[l], kind.room),
                  kind.contacts.data() + w * at(kind.room));
    });
  }
  untangle(kind.hit_rows, view.hit_rows, rays * kernels::kHitRows);
  untangle(kind.hit_shape, view.hit_shape, rays);
}

template class ObservationsOf<float>;
template class ObservationsOf<double>;

}  // namespace manyworlds
