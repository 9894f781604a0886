// What a Live consists of, and what pages' commands do to the batch.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "manyworlds/live.hpp"
#include "src/live/drag.hpp"
#include "src/live/head.hpp"
#include "src/live/hub.hpp"
#include "src/live/server.hpp"

namespace manyworlds {

struct Live::Impl {
  static constexpr const char* kName = "Live";
  using Clock = std::chrono::steady_clock;

  Impl(Batch& batch, const LiveOptions& options);

  // What pages asked of the clock, for run().
  struct Asked {
    bool paused = false;
    double speed = 1;
    int steps = 0;  // to be taken although it is paused
  };

  void obey(Batch& batch);             // what pages asked for since
  void pull(Batch& batch, int steps);  // the forces of drags, for the next step() call
  void carry_out(Batch& batch, const live::Command& command);
  void set_gravity(Batch& batch, const Vec3& value);
  void set_friction(Batch& batch, double factor);
  void set_controls(Batch& batch, const live::Command& command);
  void reset(Batch& batch, int world);
  void save(const Batch& batch, int page);
  void show(const Batch& batch);
  void publish(const Batch& batch, std::vector<int> worlds, bool of_all);
  void changed() { ++version; }

  LiveOptions options;
  live::Sizes sizes;
  live::Hub hub;
  live::Head head;
  live::Sliders sliders;
  std::map<int, live::Drag> drags;  // by page
  Asked asked;
  live::Clockwork clockwork;
  std::function<void()> controls_set;
  std::uint64_t version = 1;
  std::int64_t seen_steps = 0;           // of the batch, when its version was last counted
  Clock::time_point next_all = {};       // when all that can be shown is captured again
  int saved = 0;                         // snapshots
  std::unique_ptr<live::Server> server;  // last: its thread uses the rest
};

}  // namespace manyworlds
