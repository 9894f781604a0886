// A model as MuJoCo and as we step it, both to be held against each other.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"
#include "src/base/random.hpp"
#include "src/mjcf/mujoco_library.hpp"

namespace manyworlds::compare {

struct Settings {
  // Of both solvers. Float32 stops at 1e-7 at the latest, below which it has no digits.
  double tolerance = 1e-16;
  std::uint64_t seed = 0;
  // Compare states in which shapes touch whose contact points are not MuJoCo's, too.
  bool every_shape = false;
  // Called every few milliseconds of work. An exception of it ends the comparison.
  std::function<void()> pause = {};
};

// How far both solvers go.
struct Effort {
  double tolerance = 0;
  int iterations = 200, line_search_iterations = 100;
  // Under Euler, as the model has it. What is not solved to the end has accelerations that no
  // forces of rows belong to, and the implicit step goes by the forces: paths burst, on both sides.
  bool implicit_damping = true;
};

// One uniform draw after the other; the same on every platform.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : draws_(seed, stream) {}
  double uniform(double low, double high) { return low + (high - low) * draws_.uniform(next_++); }
  int integer(int low, int high) {  // both ends included
    return low + static_cast<int>(uniform(0, 1) * (high - low + 1));
  }

 private:
  Draws draws_;
  std::uint64_t next_ = 0;
};

// Both solve with Newton's method, whatever the model asks for.
class Pair {
 public:
  // Throws MjcfError; std::invalid_argument where the model is not for Solver::newton.
  Pair(const MjcfFiles& files, const Settings& settings);

  const Settings& settings() const { return settings_; }
  void pause() const {
    if (settings_.pause) settings_.pause();
  }
  const mjModel& mujoco() const { return *mujoco_; }
  Scene scene(Precision precision) const;
  const std::vector<std::string>& warnings() const { return warnings_; }
  // Throws mjcf::MujocoFailure.
  mjcf::DataPtr make_data() const;

  // MuJoCo's bodies that have a state of their own here, in its order, and those of the scene.
  struct Link {
    int mujoco;
    BodyId body;
  };
  const std::vector<Link>& links() const { return links_; }

  // Neither side finds a contact any more.
  void disable_contacts();
  const Effort& effort() const { return effort_; }
  void set_effort(const Effort& effort);

  // Whether MuJoCo's contacts of these two geoms are ours point for point (docs/mujoco.md).
  bool same_points(int geom_a, int geom_b) const;

 private:
  Settings settings_;
  Effort effort_;
  int disabled_ = 0;  // flags of the model
  mjcf::ModelPtr mujoco_;
  Scene scene_;
  std::vector<std::string> warnings_;
  std::vector<Link> links_;
};

// Controls within their ranges and somewhat beyond, where what is set counts as the end.
void draw_controls(const mjModel& m, Random& random, mjtNum* controls);

// The precisions that this build has kernels for, and the widest instruction set of each.
struct Kernels {
  Precision precision;
  Isa isa;
};
std::vector<Kernels> kernels();
BatchOptions options_of(const Kernels& kernels, int worlds);

// The largest difference relative to the largest number of b, or to 1. 1e9 where one is not finite.
double difference(const std::vector<double>& a, const std::vector<double>& b);

std::vector<double> read(const Batch& batch, Field field, int world);

}  // namespace manyworlds::compare
