// ObserverResults: what the observers of a Batch saw, by world, and what they want of a group.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "kernels/data/observer.hpp"
#include "manyworlds/batch.hpp"
#include "src/state/worlds.hpp"

namespace manyworlds {

// The scene's names for the two shapes of a candidate pair.
struct PairIds {
  ShapeId a, b;
};
template <class Real>
PairIds ids_of(const PlanData& plan, const kernels::SceneConstants<Real>& tables, std::int32_t key);

bool observes(const Observers& observers, Observer observer);
inline bool observes(const Observers& o) {
  return !o.what.empty() || !o.rays.empty() || !o.points.empty();
}
// How many there are of what has numbers of its own, in one world.
std::size_t items_of(ObservedItem item, const PlanData& plan, const Observers& observers);
// Numbers of one world.
std::size_t observed_size(Observed what, const PlanData& plan, const Observers& observers);
// Throws std::invalid_argument for what makes no sense in a plan.
void check_rays(std::span<const Ray> rays, const Plan& plan);
void check_points(std::span<const Point> points, const Plan& plan);
void check_observers(const Observers& observers);
void check_observers(const Observers& observers, const Plan& plan);

// The number type's side. Indices were checked by the caller.
class ObserverResults {
 public:
  virtual ~ObserverResults() = default;
  // Of `count` worlds, one after the other.
  virtual void read(Observed what, int kind, int first, int count, float* out) const = 0;
  virtual void read(Observed what, int kind, int first, int count, double* out) const = 0;
  virtual std::vector<StepContact> contacts(int kind, int world) const = 0;
  virtual void set_rays(std::span<const Ray> rays) = 0;  // of all worlds
  virtual void set_rays(int kind, int world, std::span<const Ray> rays) = 0;
};

template <class Real>
class ObserverResultsOf final : public ObserverResults {
 public:
  using AllWorlds = std::vector<std::unique_ptr<Worlds<Real>>>;

  ObserverResultsOf(const AllWorlds& worlds, const Observers& observers,
                    const kernels::Kernels<Real>& kernels);
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
  const kernels::ObserverView<Real>& ask(std::size_t thread, std::size_t kind, int group);
  void take(std::size_t thread, std::size_t kind, int group, std::uint32_t lanes, bool stepped);
  // What was last seen of a group of the first kind, as take() took it.
  const kernels::ObserverView<Real>& recall(int group);
  // Where the poses for rays are: the thread's scratch, or memory of their own where a plan without
  // contacts has none.
  kernels::Scratch* poses(std::size_t thread, std::size_t kind) const;

 private:
  struct Kind {
    // By Observer, what it saw: [world][item][row], rows as kernels::ObserverRows has them.
    std::array<std::vector<Real>, kObserverCount> rows;
    std::vector<kernels::ContactImpulse<Real>> contacts;  // [world][room]
    std::vector<Real> ray_rows;  // [world][ray][kernels::kRayRows], in the user's frames
    std::vector<kernels::RayTable> rays;
    std::vector<kernels::PointTable<Real>> points;
    std::vector<std::int32_t> joint_of_part;
    std::vector<kernels::TreeAnchor<Real>> anchors;  // of trees
    std::vector<kernels::TendonTable> tendons;
    std::vector<kernels::TreeTerm<Real>> tendon_terms;
    std::vector<kernels::PointTable<Real>> sites;
    std::vector<kernels::SeenShape> seen_shapes;  // of rays
    int room = 0;
    bool frames_vary = false;  // from world to world
  };
  struct Block {  // of a thread and kind, in lanes
    std::vector<AlignedBuffer<Real>> reals;
    AlignedBuffer<std::uint32_t> asleep;
    AlignedBuffer<kernels::ContactImpulse<Real>> contacts;
    kernels::ObserverView<Real> view{};
    std::unique_ptr<kernels::SceneConstants<Real>>
        tables;  // of a plan without contacts, with poses
    AlignedBuffer<unsigned char> pose_memory, saved;
    kernels::Scratch* poses = nullptr;
    Real* ray_rows = nullptr;  // of view
    Real* frames = nullptr;    // of view
  };

  bool has(Observer observer) const { return observes(observers_, observer); }
  template <class Out>
  void read_worlds(Observed what, int kind, int first, int count, Out* out) const;
  // How many of a world's contacts that there is room for.
  static int contacts_kept(const Kind& kind, std::size_t world) {
    const auto& count = kind.rows[static_cast<std::size_t>(Observer::contacts)];
    return std::min(static_cast<int>(count[world]), kind.room);
  }
  // What does not move of what the kind's scene names.
  void set_tendons(Kind& kind, const PlanData& plan) const;
  void set_sites(Kind& kind, const Plan& plan) const;
  Block make_block(std::size_t kind, kernels::Scratch* scratch) const;
  // Frames of the bodies of a lane's world, from the plan's or its own sizes and densities.
  void put_frames(std::size_t kind, int world, std::size_t lane, Real* frames) const;
  void put_rays(std::size_t kind, int group, Real* rows) const;
  int world_in(std::size_t kind, int group, std::size_t lane) const;
  void put_ray(std::size_t kind, int world, std::size_t ray, const Ray& from);

  const AllWorlds& worlds_;
  Observers observers_;
  const kernels::Kernels<Real>& kernels_;
  std::vector<Kind> kinds_;
  std::vector<std::vector<Block>> blocks_;  // [thread][kind]
};

}  // namespace manyworlds
