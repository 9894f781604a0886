// Contacts of worlds at their current state: the collision stages once more.
#include "kernels/data/pair_keys.hpp"
#include "src/api/stepper.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace {

// Looking at contacts looks at all of them, asleep or not.
template <class Real>
kernels::GroupView<Real> awake_view(kernels::GroupView<Real> view,
                                    const kernels::SceneConstants<Real>& tables,
                                    std::vector<std::uint32_t>& none_asleep) {
  if (!view.asleep) return view;
  none_asleep.assign(static_cast<std::size_t>(tables.bodies), 0);
  view.asleep = none_asleep.data();
  return view;
}

}  // namespace

template <class Real>
std::vector<Contact> Stepper<Real>::contacts(int kind, int world) const {
  const Worlds<Real>& w = at(kind);
  const auto& t = w.tables();
  if (!t.has_contacts) return {};
  int capacity = 0;
  for (const int c : t.capacity) capacity += c;
  std::vector<kernels::ContactPoint<Real>> points(static_cast<std::size_t>(capacity) * 4);
  kernels::Scratch* scratch = scratch_.front().views[static_cast<std::size_t>(kind)];
  const FloatMode mode(FloatMode::flush);
  const int lane_index = w.lane_index_of(world);
  std::vector<std::uint32_t> none_asleep;
  kernels_.record(scratch, lane_index % kernels_.lanes, points.data(),
                  static_cast<int>(points.size()));
  collide_group<Real>(group_step(static_cast<std::size_t>(kind)),
                      awake_view(w.storage().group(lane_index / kernels_.lanes), t, none_asleep),
                      scratch);
  points.resize(static_cast<std::size_t>(kernels_.record(scratch, 0, nullptr, 0)));

  const PlanData& plan = w.data();
  std::vector<Contact> out;
  for (const auto& p : points) {
    const PairIds ids = ids_of(plan, t, p.key);
    Contact contact;
    contact.body_a = ids.a.body(), contact.shape_a = ids.a;
    contact.body_b = ids.b.body(), contact.shape_b = ids.b;
    for (int k = 0; k < 3; ++k) {
      contact.normal[k] = static_cast<double>(p.normal[k]);
      contact.point[k] = static_cast<double>(p.point[k]);
    }
    contact.separation = static_cast<double>(p.separation);
    contact.normal_impulse = static_cast<double>(p.impulse);
    contact.feature = p.feature;
    out.push_back(contact);
  }
  return out;
}

template <class Real>
double Stepper<Real>::occupancy(int kind, const GoOn& go_on) const {
  const Worlds<Real>& w = at(kind);
  if (!w.tables().has_contacts) return 0;
  const FloatMode mode(FloatMode::flush);
  kernels::Scratch* scratch = scratch_.front().views[static_cast<std::size_t>(kind)];
  double active = 0, lanes = 0;
  std::vector<std::uint32_t> none_asleep;
  for (int g = 0; g < w.storage().groups(); ++g) {
    if (!go_on()) return 0;
    collide_group<Real>(group_step(static_cast<std::size_t>(kind)),
                        awake_view(w.storage().group(g), w.tables(), none_asleep), scratch);
    active += kernels_.counters(scratch).active;
    lanes += kernels_.counters(scratch).dense_blocks * static_cast<double>(kernels_.lanes);
  }
  return lanes > 0 ? active / lanes : 0;
}

template std::vector<Contact> Stepper<float>::contacts(int, int) const;
template std::vector<Contact> Stepper<double>::contacts(int, int) const;
template double Stepper<float>::occupancy(int, const GoOn&) const;
template double Stepper<double>::occupancy(int, const GoOn&) const;

}  // namespace manyworlds
