#include "src/api/observer_results.hpp"

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

constexpr std::size_t rows_of(int observer) { return at(kernels::kObserverRows.of_item[observer]); }
// Of one world.
std::size_t numbers_of(const PlanData& plan, const Observers& observers, Observer observer) {
  return items_of(info(observer).item, plan, observers) * rows_of(static_cast<int>(observer));
}

// Observers of the states of bodies, or of what is fixed to them, have the users' frames.
bool wants_frames(const Observers& observers) {
  for (int i = 0; i < kObserverCount; ++i) {
    const ObservedItem item = kObserverInfo[i].item;
    const bool of_bodies = item == ObservedItem::body && kObserverInfo[i].of == ObservedOf::state;
    const bool of_points = item == ObservedItem::point || item == ObservedItem::site;
    if ((of_bodies || of_points) && observes(observers, Observer(i))) return true;
  }
  return false;
}

// Observers that trees have something for where their forces are found.
bool observes_links(const Observers& observers) {
  constexpr Observer kOf[] = {Observer::links,           Observer::link_inertias,
                              Observer::link_velocities, Observer::link_forces,
                              Observer::dof_forces,      Observer::tendons,
                              Observer::sites,           Observer::drives};
  return std::any_of(std::begin(kOf), std::end(kOf),
                     [&](Observer o) { return observes(observers, o); });
}

// Of a fixed shape or a body's.
template <class Shape>
kernels::SeenShape seen_shape(const PlanData& plan, const Shape& s) {
  const Body& body = plan.scene.bodies[at(s.scene_body)];
  return {body.shapes[at(s.shape)].filter.category, s.scene_body, s.shape};
}

}  // namespace

template <class Real>
ObserverResultsOf<Real>::ObserverResultsOf(const AllWorlds& worlds, const Observers& observers,
                                           const kernels::Kernels<Real>& kernels)
    : worlds_(worlds), observers_(observers), kernels_(kernels), kinds_(worlds.size()) {
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    Kind& kind = kinds_[k];
    const auto& w = *worlds_[k];
    const std::size_t n = at(w.count()), rays = observers_.rays.size();
    const PlanData& plan = w.data();
    for (int i = 0; i < kObserverCount; ++i) {
      if (has(Observer(i))) kind.rows[at(i)].resize(n * numbers_of(plan, observers_, Observer(i)));
    }
    if (has(Observer::joint_loads)) {
      for (const PlanPart& part : plan.parts) kind.joint_of_part.push_back(part.joint);
      for (const PlanAnchor& from : plan.trees.anchors) {
        kind.anchors.push_back({from.link, from.joints, {}});
        for (int c = 0; c < 3; ++c) {
          kind.anchors.back().position[c] = static_cast<Real>(from.position[c]);
        }
      }
    }
    if (has(Observer::contacts)) {
      kind.room = observers_.contacts_per_world;
      const int several = w.tables().dimension == kernels::Dimension::planar ? 2 : 4;
      for (int l = 0; l < kernels::kLists && observers_.contacts_per_world == 0; ++l) {
        kind.room +=
            w.tables().capacity[l] * (is_multi(static_cast<kernels::ListId>(l)) ? several : 1);
      }
      // Points of later passes may be others.
      if (observers_.contacts_per_world == 0) kind.room *= std::min(w.tables().passes, 4);
      kind.contacts.resize(n * at(kind.room));
    }
    kind.frames_vary = std::any_of(plan.bodies.begin(), plan.bodies.end(),
                                   [](const PlanBody& b) { return b.reshaped && !b.aligned; });
    if (has(Observer::tendons)) set_tendons(kind, plan);
    if (has(Observer::sites)) set_sites(kind, w.plan());
    for (const Point& p : observers_.points) {
      kind.points.push_back({w.plan().row(p.body), {}});
      for (int c = 0; c < 3; ++c) {
        kind.points.back().position[c] = static_cast<Real>(p.position[c]);
      }
    }
    kind.rays.resize(rays);
    kind.ray_rows.resize(n * rays * kernels::kRayRows);
    for (std::size_t i = 0; rays > 0 && i < plan.fixed.size() + plan.colliders.size(); ++i) {
      kind.seen_shapes.push_back(i < plan.fixed.size()
                                     ? seen_shape(plan, plan.fixed[i])
                                     : seen_shape(plan, plan.colliders[i - plan.fixed.size()]));
    }
  }
  set_rays(observers_.rays);
}

template <class Real>
void ObserverResultsOf<Real>::set_tendons(Kind& kind, const PlanData& plan) const {
  const auto& dofs = plan.trees.dofs;
  for (const Tendon& tendon : plan.scene.tendons) {
    kind.tendons.push_back({static_cast<std::int32_t>(kind.tendon_terms.size()),
                            static_cast<std::int32_t>(tendon.terms.size())});
    for (const TendonTerm& term : tendon.terms) {
      const int coordinate = plan.first_coordinate[at(term.joint.index())];
      const auto dof = std::find_if(dofs.begin(), dofs.end(), [&](const kernels::TreeDof& d) {
        return d.coordinate == coordinate;
      });
      kind.tendon_terms.push_back({coordinate, static_cast<std::int32_t>(dof - dofs.begin()),
                                   static_cast<Real>(term.coefficient)});
    }
  }
}

template <class Real>
void ObserverResultsOf<Real>::set_sites(Kind& kind, const Plan& plan) const {
  const auto& links = plan.data().trees.links;
  for (const Site& site : plan.scene().sites) {
    const int row = site.body && plan.find_row(site.body) ? plan.row(site.body) : -1;
    kernels::PointTable<Real>& to = kind.sites.emplace_back();
    to.body = row;
    if (row >= 0 && plan.data().has_trees()) {
      const auto link =
          std::find_if(links.begin(), links.end(), [&](const auto& l) { return l.body == row; });
      to.body = static_cast<std::int32_t>(link - links.begin());
    }
    // What is on a fixed body stays.
    const Frame at_site{site.position, Quat::Identity()};
    const Vec3 x =
        row < 0 ? frame_in_world(plan.scene(), site.body, at_site).position : site.position;
    for (int c = 0; c < 3; ++c) to.position[c] = static_cast<Real>(x[c]);
  }
}

template <class Real>
void ObserverResultsOf<Real>::add_thread(std::span<kernels::Scratch* const> scratch) {
  auto& blocks = blocks_.emplace_back();
  for (std::size_t k = 0; k < kinds_.size(); ++k) blocks.push_back(make_block(k, scratch[k]));
}

template <class Real>
typename ObserverResultsOf<Real>::Block ObserverResultsOf<Real>::make_block(
    std::size_t k, kernels::Scratch* scratch) const {
  const Kind& kind = kinds_[k];
  const auto& t = worlds_[k]->tables();
  const kernels::ObserverTable<Real>& observer = *kernels_.observer;
  const std::size_t lanes = at(kernels_.lanes), bodies = at(t.bodies), rays = kind.rays.size();
  Block block;
  auto& view = block.view;
  const auto reals = [&](std::size_t count) { return block.reals.emplace_back(count).data(); };
  const PlanData& plan = worlds_[k]->data();
  // Those of trees need no blocks of contacts.
  const bool forces = has(Observer::link_forces) && !plan.has_trees();
  const bool impulses = has(Observer::contacts) || has(Observer::touching) || forces;
  view.of_contacts = impulses || has(Observer::penetration);
  for (int l = 0; t.has_contacts && view.of_contacts && l < kernels::kLists; ++l) {
    view.places[l] = reals(observer.place_reals(t, scratch, l));
    if (impulses && !t.has_restitution) {
      view.totals[l] = reals(observer.total_reals(t, scratch, l));
    }
  }
  if (view.of_contacts) {
    block.asleep = AlignedBuffer<std::uint32_t>(2 * bodies);
    view.none_asleep = block.asleep.data(), view.asleep_before = view.none_asleep + bodies;
  }
  for (int i = 0; i < kObserverCount; ++i) {
    if (!has(Observer(i))) continue;
    const std::size_t items = items_of(info(Observer(i)).item, plan, observers_);
    view.items[i] = static_cast<std::int32_t>(items);
    view.rows[i] = reals(items * rows_of(i) * lanes);
  }
  if (has(Observer::residual)) {
    block.saved =
        AlignedBuffer<unsigned char>(t.has_substeps ? observer.saved_bytes(t, scratch) : 0);
    view.saved = block.saved.data();
  }
  if (has(Observer::contacts)) {
    block.contacts = AlignedBuffer<kernels::ContactImpulse<Real>>(lanes * at(kind.room) + 1);
    view.contacts = block.contacts.data();
    view.room = kind.room;
  }
  view.point = kind.points.data();
  view.tendon = kind.tendons.data(), view.tendon_term = kind.tendon_terms.data();
  view.site = kind.sites.data();
  view.coordinate = plan.coordinates.data();
  view.joint_of_part = kind.joint_of_part.data();
  if (!kind.anchors.empty()) view.anchor = kind.anchors.data();
  view.of_links = plan.has_trees() && observes_links(observers_);
  if (view.anchor || view.of_links) view.before = reals(at(t.state_size) * lanes);
  const auto shifted = [](const PlanBody& b) { return !b.aligned; };
  if (wants_frames(observers_) && std::any_of(plan.bodies.begin(), plan.bodies.end(), shifted)) {
    view.frames = block.frames = reals(bodies * kernels::kFrameRows * lanes);
    for (std::size_t l = 0; l < lanes; ++l) put_frames(k, 0, l, block.frames);
  }
  if (rays == 0) return block;
  view.ray = kind.rays.data();
  view.seen_shape = kind.seen_shapes.data();
  view.ray_rows = block.ray_rows = reals(rays * kernels::kRayRows * lanes);
  view.placed = reals(rays * 6 * lanes);
  block.poses = scratch;
  if (!t.has_contacts) {
    block.tables = std::make_unique<kernels::SceneConstants<Real>>(t);
    block.tables->has_contacts = block.tables->has_substeps = true;
    block.pose_memory = AlignedBuffer<unsigned char>(kernels_.scratch_bytes(*block.tables));
    block.poses = kernels_.make_scratch(*block.tables, block.pose_memory.data());
  }
  return block;
}

template <class Real>
std::size_t ObserverResultsOf<Real>::world_bytes(std::size_t k) const {
  const Kind& kind = kinds_[k];
  std::size_t bytes = bytes_of(kind.ray_rows, kind.contacts);
  for (const auto& rows : kind.rows) bytes += bytes_of(rows);
  return bytes / at(worlds_[k]->count());
}

template <class Real>
std::size_t ObserverResultsOf<Real>::thread_bytes() const {
  std::size_t bytes = 0;
  for (const auto& blocks : blocks_) {
    for (const Block& b : blocks) {
      bytes += bytes_of(b.asleep, b.contacts, b.pose_memory, b.saved);
      for (const auto& reals : b.reals) bytes += bytes_of(reals);
    }
  }
  return blocks_.empty() ? 0 : bytes / blocks_.size();
}

template <class Real>
void ObserverResultsOf<Real>::put_ray(std::size_t k, int world, std::size_t ray, const Ray& from) {
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
void ObserverResultsOf<Real>::set_rays(std::span<const Ray> rays) {
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
void ObserverResultsOf<Real>::set_rays(int kind, int world, std::span<const Ray> rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) put_ray(at(kind), world, i, rays[i]);
}

template <class Real>
kernels::Scratch* ObserverResultsOf<Real>::poses(std::size_t thread, std::size_t kind) const {
  return blocks_[thread][kind].poses;
}

template <class Real>
int ObserverResultsOf<Real>::world_in(std::size_t k, int group, std::size_t lane) const {
  return std::max(0, worlds_[k]->world_in(group * kernels_.lanes + static_cast<int>(lane)));
}

template <class Real>
void ObserverResultsOf<Real>::put_frames(std::size_t k, int world, std::size_t lane,
                                         Real* frames) const {
  const std::size_t lanes = at(kernels_.lanes), bodies = worlds_[k]->data().bodies.size();
  for (std::size_t b = 0; b < bodies; ++b) {
    const PlanBody& body = worlds_[k]->body_of(world, b);
    const Quat q = body.principal.conjugate();
    const double rows[kernels::kFrameRows] = {
        body.center.x(), body.center.y(), body.center.z(), q.w(), q.x(), q.y(), q.z()};
    Real* to = frames + b * kernels::kFrameRows * lanes + lane;
    for (std::size_t i = 0; i < kernels::kFrameRows; ++i)
      to[i * lanes] = static_cast<Real>(rows[i]);
  }
}

// Of the lanes of a group, in the frames that the kernels know.
template <class Real>
void ObserverResultsOf<Real>::put_rays(std::size_t k, int group, Real* ray_rows) const {
  const Kind& kind = kinds_[k];
  const std::size_t lanes = at(kernels_.lanes), rows = kind.rays.size() * kernels::kRayRows;
  for (std::size_t l = 0; l < lanes; ++l) {
    const int world = world_in(k, group, l);
    const Real* from = kind.ray_rows.data() + at(world) * rows;
    for (std::size_t i = 0; i < rows; ++i) ray_rows[i * lanes + l] = from[i];
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
      Real* to = ray_rows + i * kernels::kRayRows * lanes + l;
      for (std::size_t c = 0; c < 3; ++c) {
        to[c * lanes] = static_cast<Real>(origin[static_cast<Eigen::Index>(c)]);
        to[(3 + c) * lanes] = static_cast<Real>(way[static_cast<Eigen::Index>(c)]);
      }
    }
  }
}

template <class Real>
const kernels::ObserverView<Real>& ObserverResultsOf<Real>::ask(std::size_t thread, std::size_t k,
                                                                int group) {
  Block& block = blocks_[thread][k];
  if (block.ray_rows) put_rays(k, group, block.ray_rows);
  for (std::size_t l = 0; block.frames && kinds_[k].frames_vary && l < at(kernels_.lanes); ++l) {
    put_frames(k, world_in(k, group, l), l, block.frames);
  }
  return block.view;
}

template <class Real>
void ObserverResultsOf<Real>::take(std::size_t thread, std::size_t k, int group,
                                   std::uint32_t chosen, bool stepped) {
  const kernels::ObserverView<Real>& view = blocks_[thread][k].view;
  Kind& kind = kinds_[k];
  const std::size_t lanes = at(kernels_.lanes);
  std::array<std::pair<std::size_t, std::size_t>, kMaxLanes> taken;  // lane, world
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
  for (int i = 0; i < kObserverCount; ++i) {
    if (!view.rows[i] || (!stepped && kObserverInfo[i].of == ObservedOf::step)) continue;
    untangle(kind.rows[at(i)], view.rows[i], at(view.items[i]) * rows_of(i));
  }
  if (!stepped) return;
  // No residual of worlds that the step has lost, or that have fallen asleep in it: groups at rest
  // are not looked at again.
  constexpr int kResidual = static_cast<int>(Observer::residual);
  for_each([&](std::size_t, std::size_t w) {
    const int world = static_cast<int>(w);
    if (!view.rows[kResidual]) return;
    if (worlds_[k]->resting(world) || frozen(worlds_[k]->status(world)))
      std::fill_n(&kind.rows[kResidual][w * rows_of(kResidual)], rows_of(kResidual), Real(0));
  });
  for_each([&](std::size_t l, std::size_t w) {
    if (!view.contacts) return;
    std::copy_n(view.contacts + l * at(kind.room), contacts_kept(kind, w),
                kind.contacts.data() + w * at(kind.room));
  });
}

template <class Real>
const kernels::ObserverView<Real>& ObserverResultsOf<Real>::recall(int group) {
  const kernels::ObserverView<Real>& view = blocks_[0][0].view;
  const std::size_t lanes = at(kernels_.lanes);
  for (int i = 0; i < kObserverCount; ++i) {
    if (!view.rows[i]) continue;
    const std::size_t rows = at(view.items[i]) * rows_of(i);
    for (std::size_t l = 0; l < lanes; ++l) {
      const Real* from = kinds_[0].rows[at(i)].data() + at(world_in(0, group, l)) * rows;
      for (std::size_t r = 0; r < rows; ++r) view.rows[i][r * lanes + l] = from[r];
    }
  }
  return view;
}

template class ObserverResultsOf<float>;
template class ObserverResultsOf<double>;

}  // namespace manyworlds
