// The spatial scenes in MuJoCo: one model of each, one mjData per world.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <vector>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {

class MujocoWorld final : public Simulation {
 public:
  MujocoWorld(std::shared_ptr<const mjModel> model, const World& from);

  void step() override;
  std::vector<Pose> poses() override;

  const mjModel& model() const { return *model_; }
  mjData& data() { return *data_; }

 private:
  struct FreeData {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::shared_ptr<const mjModel> model_;
  std::unique_ptr<mjData, FreeData> data_;
};

// Each world by itself, by mj_step. What MuJoCo calls an error or a warning ends the program.
Engine mujoco_engine(const char* name);

}  // namespace manyworlds::peers
