// Worlds: the worlds of one kind in one number type. It knows which lane of the storage a world
// lives in, how worlds begin, and what a user reads and writes.
//
// With sleep, worlds that move are packed into as few groups as they fill, so where a world lives
// changes; nothing that it computes does.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "src/plan/state_layout.hpp"
#include "src/state/initial_state.hpp"
#include "src/state/storage.hpp"
#include "src/state/tables.hpp"
#include "src/state/worlds_base.hpp"

namespace manyworlds {

template <class Real>
class Worlds final : public WorldsBase {
 public:
  // `first` is the index of the first of these worlds in the batch: world seeds follow it.
  Worlds(Plan plan, int worlds, int first, const BatchOptions& options, int lanes);

  const Plan& plan() const { return plan_; }
  const PlanData& data() const { return plan_.data(); }
  const kernels::SceneConstants<Real>& tables() const { return tables_->get(); }
  const Storage<Real>& storage() const { return storage_; }
  int count() const { return worlds_; }
  int lane_index_of(int world) const override {
    return lane_index_[static_cast<std::size_t>(world)];
  }
  int world_in(int lane_index) const {
    return world_in_[static_cast<std::size_t>(lane_index)];
  }  // -1: none

  void restart() override;
  void reset(int world) override;
  void reset(int world, std::uint64_t seed) override;
  void set_initial(Field field, int world, const double* in) override;

  void read(Field field, int world, float* out) const override { read_as(field, world, out); }
  void read(Field field, int world, double* out) const override { read_as(field, world, out); }
  void write(Field field, int world, const float* in) override { write_as(field, world, in); }
  void write(Field field, int world, const double* in) override { write_as(field, world, in); }
  LaneBlocks lane_blocks(Field field) const override;
  Vec3 center_of_mass(int world, int body) const override;

  void add_force(int world, int body, const Vec3& force, const Vec3& torque) override;
  void clear_forces() { storage_.clear_forces(); }
  void clear_forces(int world) { storage_.clear_forces(lane_index_of(world)); }
  void find_forces() { storage_.find_forces(); }
  void add_impulse(int world, int body, const Vec3& impulse, const Vec3& angular) override;
  bool forced() const override { return storage_.forced(); }
  void set_controls(int first, int count, const float* in) override {
    set_controls_as(first, count, in);
  }
  void set_controls(int first, int count, const double* in) override {
    set_controls_as(first, count, in);
  }
  void read_controls(int first, int count, float* out) const override {
    read_controls_as(first, count, out);
  }
  void read_controls(int first, int count, double* out) const override {
    read_controls_as(first, count, out);
  }

  bool enabled(int world, int body) const override {
    return !storage_.absent(lane_index_of(world), body);
  }
  void set_enabled(int world, int body, bool enabled) override;
  void spawn(int world, int body, const BodyState& state) override;
  bool joint_enabled(int world, int joint) const override {
    return !storage_.joint_disabled(lane_index_of(world), joint);
  }
  void set_joint_enabled(int world, int joint, bool enabled) override;
  bool asleep(int world, int body) const override;
  bool resting(int world) const override { return storage_.resting(lane_index_of(world)); }
  void wake(int world) override { storage_.wake(lane_index_of(world)); }
  // Moves worlds so that those in which something moves fill as few groups as possible.
  void pack();

  std::size_t parameter_size(Parameter parameter) const override {
    return number_at_[static_cast<std::size_t>(parameter)].size();
  }
  void read(Parameter parameter, int world, double* out) const override;
  double number(Parameter parameter, int world, std::size_t item) const override;
  std::string check(Parameter parameter, int world, const double* in) const override;
  void write(Parameter parameter, int world, const double* in) override;
  void set_next(Parameter parameter, int world, std::size_t item, double value) override;
  // Bodies as this world's sizes, densities and masses make them.
  const PlanBody& body_of(int world, std::size_t body) const {
    return own_bodies_.empty()
               ? data().bodies[body]
               : own_bodies_[static_cast<std::size_t>(world) * data().bodies.size() + body];
  }

  // A world as bytes: the storage's, then its own numbers.
  std::size_t world_bytes() const override;
  void write_world(int world, std::byte* to) const override;
  void read_world(int world, const std::byte* from) override;
  std::string check_world(const std::byte* from) const override;
  void copy_world(int from, int to) override;
  // What a step changes of the world in a lane: saved and restored, without allocating.
  void save_lane(int lane_index, std::byte* to) const { storage_.write_world(lane_index, to); }
  void restore_lane(int lane_index, const std::byte* from) {
    storage_.restore_lane(lane_index, from);
  }
  std::uint32_t episode(int world) const override {
    return episode_[static_cast<std::size_t>(world)];
  }
  void set_episode(int world, std::uint32_t episode) override {
    episode_[static_cast<std::size_t>(world)] = episode;
  }
  std::uint64_t seed(int world) const override { return seed_[static_cast<std::size_t>(world)]; }
  void set_seed(int world, std::uint64_t seed) override {
    seed_[static_cast<std::size_t>(world)] = seed;
  }

  Status status(int world) const override;
  std::uint64_t hash(int world) const override;
  Energy energy(int world) const override;
  std::size_t bytes() const override { return storage_.bytes(); }
  // Bytes of a world outside of the storage.
  std::size_t own_bytes() const {
    return sizeof(std::uint64_t) + sizeof(std::uint32_t) + 2 * sizeof(int) +
           (values_.size() * sizeof(double) + own_bodies_.size() * sizeof(PlanBody) +
            own_ranges_.size() * sizeof own_ranges_[0]) /
               static_cast<std::size_t>(worlds_);
  }

 private:
  template <class Out>
  void read_as(Field field, int world, Out* out) const;
  template <class In>
  void write_as(Field field, int world, const In* in);
  template <class In>
  void set_controls_as(int first, int count, const In* in);
  template <class Out>
  void read_controls_as(int first, int count, Out* out) const;
  // A component of a field that the plan has.
  Real& number(Field field, int world, int item, int component) const {
    return storage_.number(lane_index_of(world), layout_.row_of(field, item) + component);
  }
  double* values_of(int world) {
    return values_.data() + static_cast<std::size_t>(world) * data().varied.size();
  }
  const double* values_of(int world) const {
    return values_.data() + static_cast<std::size_t>(world) * data().varied.size();
  }
  void make_parameters();
  void draw_values(int world, const Draws& draws);
  // Derives everything from the world's numbers; its bodies stay where they are.
  void apply_values(int world);
  Actuator actuator_of(int world, int control) const;  // with this world's numbers
  double gravity(int world, int component) const;
  double gravity_scale(int world, int scene_body) const;
  Attractor attractor_of(int world, std::size_t index) const;

  void initialise(int world);
  // Of trees (tree_state.cpp): their coordinates as drawn; the bodies from the coordinates.
  void begin_trees(int world, const Draws& draws);
  void draw_coordinates(int world, const Draws& draws);
  void place_links(int world);
  void begin(int world);
  void place(int world, int body, const BodyState& state);
  BodyState drawn_state(int world, int scene_body, const Draws& draws) const;
  // Of a body's principal axes, as the kernels have it, and of its own.
  Quat internal_rotation(int world, int body) const;
  Quat rotation(int world, int body) const;
  void set_rotation(int world, int body, const Quat& rotation);  // of the principal axes
  void set_origin(int world, int body, const Vec3& origin, const Quat& rotation);
  void move(int from, int to);

  Plan plan_;
  StateLayout layout_;
  std::unique_ptr<TablesOf<Real>> tables_;
  Storage<Real> storage_;
  int worlds_, first_;
  std::vector<std::uint64_t> seed_;  // [world]
  std::vector<std::uint32_t> episode_;
  std::mutex own_plan_;  // worlds may begin on several threads, with one plan of their own numbers
  std::array<std::vector<double>, kFieldCount> initial_;  // [world][item][component], or empty
  // What varies (Scene::variations).
  std::array<std::vector<NumberOwner>, kParameterCount> owners_;
  std::array<std::vector<int>, kParameterCount> number_at_;  // index in PlanData::varied, or -1
  std::vector<double> values_;                               // [world][PlanData::varied]
  std::vector<PlanBody> own_bodies_;                         // [world][body], where masses vary
  std::vector<std::array<double, 2>> own_ranges_;            // [world][control], where ranges vary
  std::unique_ptr<PlanData> own_;                            // the plan of the world at work
  std::vector<int> lane_index_;                              // [world]
  std::vector<int> world_in_;                                // [lane index], -1: none
  std::vector<int> by_count_;                                // [group] scratch of pack()
};

}  // namespace manyworlds
