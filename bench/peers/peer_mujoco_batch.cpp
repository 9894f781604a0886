// MuJoCo's batches (mjbatch.h): all worlds by one call, on one thread as in every peer.
#include <mujoco/mjbatch.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "bench/peers/mujoco.hpp"

namespace manyworlds::peers {
namespace {

class MujocoBatch final : public Together {
 public:
  explicit MujocoBatch(const Simulations& worlds) : worlds_(worlds) {
    const mjModel& model = world(0).model();
    mjBatchConfig config;
    mjb_defaultConfig(&config);  // one mjData per thread, into which states are copied
    config.nthread = 1;
    char error[500] = "";
    batch_.reset(mjb_makeBatch(&model, count(), &config, error, sizeof error));
    if (!batch_) throw std::runtime_error(std::string("MuJoCo: ") + error);
    mjtNum* row = mjb_state(batch_.get());
    for (int i = 0; i < count(); ++i, row += mjb_nstate(batch_.get())) {
      mj_getState(&model, &world(i).data(), row, mjSTATE_INTEGRATION);
    }
  }

  void step(int steps) override {
    if (mjb_step(batch_.get(), nullptr, 0, steps, mjSTAGE_NONE) == 0) return;
    for (int i = 0; i < count(); ++i) {
      if (mjb_status(batch_.get())[i] == 0) continue;
      throw std::runtime_error(std::string("MuJoCo: ") + mjb_error(batch_.get(), i));
    }
  }

  void finish() override {
    const mjWarningStat* warnings = mjb_warning(batch_.get());
    for (int i = 0; i < count() * mjNWARNING; ++i) {
      if (warnings[i].number == 0) continue;
      throw std::runtime_error(std::string("MuJoCo: ") +
                               mju_warningText(i % mjNWARNING, warnings[i].lastinfo));
    }
    for (int i = 0; i < count(); ++i) mjb_getData(batch_.get(), i, &world(i).data());
  }

 private:
  struct DeleteBatch {
    void operator()(mjBatch* batch) const { mjb_deleteBatch(batch); }
  };

  int count() const { return static_cast<int>(worlds_.size()); }
  MujocoWorld& world(int i) const {
    return static_cast<MujocoWorld&>(*worlds_[static_cast<std::size_t>(i)]);
  }

  const Simulations& worlds_;
  std::unique_ptr<mjBatch, DeleteBatch> batch_;
};

}  // namespace
}  // namespace manyworlds::peers

int main(int argc, char** argv) {
  using namespace manyworlds::peers;
  Engine engine = mujoco_engine("MuJoCo batch");
  engine.settings = [of_a_world = engine.settings](const World& world) {
    return of_a_world(world) + "; mjb_step of all worlds, one thread";
  };
  engine.together = [](const Simulations& worlds) { return std::make_unique<MujocoBatch>(worlds); };
  return run_peer(argc, argv, engine);
}
