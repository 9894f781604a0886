// Observations: what the observers of a Batch saw, by world, and what they want of a group.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kernels/data/observation.hpp"
#include "manyworlds/batch.hpp"
#include "src/state/worlds.hpp"

namespace manyworlds {

// The scene's names for the two shapes of a candidate pair.
struct PairNames {
  ShapeId a, b;
};
template <class Real>
PairNames names_of(const PlanData& plan, const kernels::WorldTables<Real>& tables,
                   std::int32_t key);

// Numbers of one world: what Observed says, for a plan and `rays`.
std::size_t observed_size(Observed what, const PlanData& plan, std::size_t rays);
// Throws std::invalid_argument for what makes no sense in a plan.
void check_rays(std::span<const Ray> rays, const Plan& plan);
void check_observers(const Observers& observers);

// The number type's side. Indices were checked by the caller.
class Observations {
 public:
  virtual ~Observations() = default;
  // Of `count` worlds, one after the other.
  virtual void read(Observed what, int kind, int first, int count, float* out) const = 0;
  virtual void read(Observed what, int kind, int first, int count, double* out) const = 0;
  virtual std::vector<StepContact> contacts(int kind, int world) const = 0;
  virtual void set_rays(std::span<const Ray> rays) = 0;  // of all worlds
  virtual void set_rays(int kind, int world, std::span<const Ray> rays) = 0;
};

template <class Real>
class ObservationsOf final : public Observations {
 public:
  using AllWorlds = std::vector<std::unique_ptr<Worlds<Real>>>;

  ObservationsOf(const AllWorlds& worlds, const Observers& observers,
                 const kernels::KernelTable<Real>& kernels);
  // Memory of one more thread; `scratch` is that of its steps, per kind.
  void add_thread(std::span<kernels::Scratch* const> scratch);

  void read(Observed what, int kind, int first, int count, float* out) const override;
  void read(Observed what, int kind, int first, int count, double* out) const override;
  std::vector<StepContact> contacts(int kind, int world) const override;
  void set_rays(std::span<const Ray> rays) override;
  void set_rays(int kind, int world, std::span<const Ray> rays) override;

  // Bytes for each world of a kind, and for each thread.
  std::size_t world_bytes(std::size_t kind) const;
  std::size_t thread_bytes() const;

  // What to look for in a group, and after that what was seen in these lanes of it: `stepped`, or
  // by a look at the state alone, which knows nothing of contacts.
  const kernels::Observation<Real>& ask(std::size_t thread, std::size_t kind, int group);
  void take(std::size_t thread, std::size_t kind, int group, std::uint32_t lanes, bool stepped);
  // Where the poses for rays are: the thread's scratch, or memory of their own where a plan without
  // contacts has none.
  kernels::Scratch* poses(std::size_t thread, std::size_t kind) const;

 private:
  struct Kind {  // [world]...
    std::vector<Real> motion, penetration, residual, ray_rows,
        hit_rows;  // rays in the user's frames
    std::vector<Real> coordinate_rows, joint_rows;
    std::vector<std::uint8_t> touching;
    std::vector<std::int32_t> count, hit_shape;
    std::vector<kernels::ContactImpulse<Real>> contacts;
    std::vector<kernels::RayTable> rays;
    std::vector<std::int32_t> joint_of_part;
    std::vector<std::uint32_t> fixed_category;
    int room = 0;
  };
  struct Block {  // of a thread and kind, in lanes
    std::vector<AlignedBuffer<Real>> reals;
    AlignedBuffer<std::int32_t> count, hit_shape;
    AlignedBuffer<std::uint32_t> touching, nobody;
    AlignedBuffer<kernels::ContactImpulse<Real>> contacts;
    kernels::Observation<Real> view{};
    std::unique_ptr<kernels::WorldTables<Real>> tables;  // of a plan without contacts, with poses
    AlignedBuffer<unsigned char> pose_memory, aside;
    kernels::Scratch* poses = nullptr;
    Real* ray_rows = nullptr;  // of view
  };

  bool has(Observer observer) const;
  template <class Out>
  void read_worlds(Observed what, int kind, int first, int count, Out* out) const;
  template <class Out>
  void read_world(Observed what, int kind, int world, Out* out) const;
  template <class Out>
  static void read_loads(Observed what, const Kind& kind, const PlanData& plan, std::size_t world,
                         Out* out);
  Block make_block(std::size_t kind, kernels::Scratch* scratch) const;
  void put_ray(std::size_t kind, int world, std::size_t ray, const Ray& from);

  const AllWorlds& worlds_;
  Observers observers_;
  const kernels::KernelTable<Real>& kernels_;
  std::vector<Kind> kinds_;
  std::vector<std::vector<Block>> blocks_;  // [thread][kind]
};

}  // namespace manyworlds
