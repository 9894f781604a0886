// Worlds: the state of all worlds of one kind (one Plan), in groups of one lane per world.
//   state  [group][body][component][lane]
//   cache  [group][lane][manifold][row], keys beside
// Lanes beyond the last world repeat the last world. World indices here are local to the kind.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/group.hpp"
#include "manyworlds/batch.hpp"
#include "src/state/tables.hpp"

namespace manyworlds {

template <class Real>
class Worlds {
 public:
  // `first` is the index of the first of these worlds in the batch: world seeds follow it.
  Worlds(Plan plan, int worlds, int first, std::uint64_t seed, int lanes);

  const Plan& plan() const { return plan_; }
  const PlanData& data() const { return plan_.data(); }
  const kernels::WorldTables<Real>& tables() const { return tables_->get(); }
  int count() const { return worlds_; }
  int groups() const { return groups_; }
  int lanes() const { return lanes_; }
  kernels::GroupView<Real> group(int index) const;
  std::size_t bytes() const;  // of persistent state

  void restart();         // all worlds, first episode
  void reset(int world);  // next episode

  // One world, canonical [body][component].
  template <class Out>
  void read(Field field, int world, Out* out) const;
  template <class In>
  void write(Field field, int world, const In* in);

  void add_force(int world, int body, const Vec3& force, const Vec3& torque);
  void clear_forces();
  void add_impulse(int world, int body, const Vec3& impulse, const Vec3& angular);
  Vec3 center_of_mass(int world, int body) const;

  Status status(int world) const;
  std::uint64_t hash(int world) const;
  Energy energy(int world) const;

 private:
  Real* component(int world, int body, int component) const;
  void initialise(int world);
  void fill_padding(int world);
  void clear_contacts(int world);
  Quat internal_rotation(int world, int body) const;
  void set_rotation(int world, int body, const Quat& rotation);

  Plan plan_;
  std::unique_ptr<TablesOf<Real>> tables_;
  int worlds_, first_, lanes_, groups_;
  std::uint64_t seed_;
  mutable AlignedBuffer<Real> state_;
  mutable std::array<AlignedBuffer<Real>, kernels::kLists> cache_rows_;
  mutable std::array<AlignedBuffer<std::int32_t>, kernels::kLists> cache_keys_;
  mutable AlignedBuffer<std::uint32_t> status_;
  AlignedBuffer<Real> force_;  // [group][body][force 3, torque 3][lane], made at the first force
  bool forced_ = false;
  std::vector<std::uint32_t> episode_;
};

}  // namespace manyworlds
