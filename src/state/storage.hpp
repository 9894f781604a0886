// Storage: the numbers of all worlds of one kind, in groups of one lane per world. It knows lanes,
// not worlds: lane index i is lane i % lanes of group i / lanes. Which world that is, Worlds
// says.
//   state     [group][row][lane], rows as StateLayout has them
//   cache     [group][lane][manifold][row], keys beside
//   controls  [group][control][lane]
//   joints    [group][part][impulses][lane]
//   activity  [group][body] lane masks of sleeping and disabled bodies, made when first needed
//   disabled_joints     [group][joint] lane masks of broken and disabled joints, made when first
//   needed
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/data/group.hpp"
#include "manyworlds/scene.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/base/bits.hpp"
#include "src/state/constants.hpp"

namespace manyworlds {

template <class Real>
class Storage {
 public:
  Storage(const kernels::SceneConstants<Real>& tables, int groups, int lanes);

  int lanes() const { return lanes_; }
  int groups() const { return groups_; }
  int lane_count() const { return groups_ * lanes_; }
  kernels::GroupView<Real> group(int index) const;
  std::size_t bytes() const;  // of persistent state

  Real& number(int lane_index, int row) const;  // of the state (StateLayout)
  std::uint32_t& status(int lane_index) const {
    return status_[static_cast<std::size_t>(lane_index)];
  }
  void clear_contacts(int lane_index);
  void clear_joints(int lane_index);  // their impulses
  // Impulses of contacts and joints of the body and of all bodies that it touches or is joined to,
  // directly or not: what carried the absent body would be thrown up.
  void drop_impulses(int lane_index, int body);

  Real* controls(int lane_index) const {  // lanes() apart
    return control_.data() + group_of(lane_index) * index(tables_.controls) * index(lanes_) +
           lane_of(lane_index);
  }

  void add_force(int lane_index, int body, const Vec3& force, const Vec3& torque);
  void clear_forces();
  bool forced() const { return forced_; }  // forces were added since they were all cleared
  void clear_forces(int lane_index);
  void find_forces();  // after some were cleared: are there others?

  // Sleeping and disabled bodies. Without masks every body is there and awake.
  bool has_activity() const { return !asleep_.empty(); }
  void make_activity();
  bool asleep(int lane_index, int body) const {
    return is_set(asleep_, body_at(lane_index, body), lane_index);
  }
  bool absent(int lane_index, int body) const {
    return is_set(absent_, body_at(lane_index, body), lane_index);
  }
  bool resting(int lane_index) const { return is_set(resting_, group_of(lane_index), lane_index); }
  void set_absent(int lane_index, int body,
                  bool absent);  // find_idle() when all of a world are set
  void find_idle(int lane_index) { find_idle_in(group_of(lane_index)); }
  void wake(int lane_index);                   // every body
  void wake_island(int lane_index, int body);  // those that fell asleep together with it
  void rest(int lane_index);                   // a lane without a world: nothing in it ever moves
  // Lanes of a group in which something may move.
  std::uint32_t moving_lanes(int group) const {
    const std::uint32_t all = (1u << lanes_) - 1;
    return resting_.empty() ? all : ~resting_[index(group)] & all;
  }

  // Broken and disabled joints. Without masks every joint holds.
  void make_disabled_joints();
  bool joint_disabled(int lane_index, int joint) const {
    return is_set(disabled_joints_, joint_at(lane_index, joint), lane_index);
  }
  void set_joint_disabled(int lane_index, int joint, bool disabled);
  void enable_all_joints(int lane_index);

  // Constants of each world's own, where the plan lets some vary.
  void make_constants(const PlanData& plan);
  void set_constants(const PlanData& plan, int lane_index) { constants_.fill(plan, lane_index); }

  void swap(int a, int b);  // with the forces that wait for the next step
  void copy(int from, int to);

  // A world as bytes, the same whatever its lane, the lanes and the batch's sleep.
  std::size_t world_bytes() const;
  void write_world(int lane_index, std::byte* to) const;
  void read_world(int lane_index, const std::byte* from);
  // The same for bytes of this very lane, of a moment ago: allocates nothing.
  void restore_lane(int lane_index, const std::byte* from);
  // Could these bytes have come from write_world()? Says what is wrong, or nothing.
  std::string check_world(const std::byte* from) const;

 private:
  static constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::size_t group_of(int lane_index) const { return index(lane_index / lanes_); }
  std::size_t lane_of(int lane_index) const { return index(lane_index % lanes_); }
  std::size_t body_at(int lane_index, int body) const {
    return group_of(lane_index) * index(tables_.bodies) + index(body);
  }
  std::size_t joint_at(int lane_index, int joint) const {
    return group_of(lane_index) * index(tables_.joints) + index(joint);
  }
  bool is_set(const AlignedBuffer<std::uint32_t>& masks, std::size_t at, int lane_index) const {
    return !masks.empty() && get_bit(masks[at], lane_of(lane_index));
  }

  // Every number of a world, in a fixed order that does not depend on the lane, beside what lies in
  // another lane in the same place. Parts that this storage does not have are null.
  //   visit.numbers(part, a, b, count, stride)    visit.bit(word of a, lane of a, word of b, lane)
  template <class Visit>
  void for_each_part(int a, int b, Visit&& visit) const;
  void find_idle_in(std::size_t group);
  void clear_part(int lane_index, int part);  // of a joint, its impulses
  // A lane's keys, and the rows of its manifolds; the next one is as many on as there are lanes.
  std::int32_t* keys_of(int lane_index, std::size_t list) const;
  Real* rows_of(int lane_index, std::size_t list) const;
  template <class Keep>
  void keep_contacts(int lane_index, Keep keep);  // keep(body a or -1, body b)

  const kernels::SceneConstants<Real>& tables_;
  int groups_, lanes_;
  // Views hand out pointers that the step writes through.
  mutable AlignedBuffer<Real> state_;
  mutable std::array<AlignedBuffer<Real>, kernels::kLists> cache_rows_;
  mutable std::array<AlignedBuffer<std::int32_t>, kernels::kLists> cache_keys_;
  mutable AlignedBuffer<std::uint32_t> status_;
  mutable AlignedBuffer<Real> joint_impulse_;  // [group][part][3][lane]
  mutable AlignedBuffer<Real> control_;        // [group][control][lane]
  mutable AlignedBuffer<Real> force_;          // [group][body][force 3, torque 3][lane]
  bool forced_ = false;
  Constants<Real> constants_;
  mutable AlignedBuffer<std::uint32_t> asleep_, absent_;  // [group][body]
  mutable AlignedBuffer<std::uint32_t> idle_, resting_;   // [group]
  mutable AlignedBuffer<std::uint32_t> disabled_joints_;  // [group][joint]
  mutable AlignedBuffer<Real> rest_time_;                 // [group][body][lane]
  mutable AlignedBuffer<std::int32_t> island_;            // [group][body][lane]
  std::vector<char> reached_;                             // [body] scratch of drop_impulses
};

}  // namespace manyworlds
