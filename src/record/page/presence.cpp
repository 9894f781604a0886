#include "src/record/page/presence.hpp"

#include <algorithm>
#include <utility>

#include "src/record/recording.hpp"
#include "src/record/run_again.hpp"

namespace manyworlds::record {
namespace {

bool all(const std::vector<bool>& flags) {
  return std::all_of(flags.begin(), flags.end(), [](bool there) { return there; });
}

bool any_broken(const Recording::Impl& recording) {
  const auto broken = static_cast<std::uint32_t>(Status::joint_broken);
  return std::any_of(recording.kinds.begin(), recording.kinds.end(), [&](const auto& kind) {
    return std::any_of(kind.statuses.begin(), kind.statuses.end(),
                       [&](std::uint32_t status) { return (status & broken) != 0; });
  });
}

}  // namespace

std::size_t Presence::rows_of(const Kind& kind) {
  return static_cast<std::size_t>(kind.plan->bodies());
}
std::size_t Presence::joints_of(const Kind& kind) { return kind.plan->scene().joints.size(); }

Presence::Flags Presence::bodies_in(const Batch& batch) const {
  Flags out;
  for (const Kind& kind : kinds_) {
    for (std::size_t w = 0; w < kind.worlds; ++w) {
      for (int row = 0; row < kind.plan->bodies(); ++row) {
        out.push_back(
            batch.enabled(kind.first_world + static_cast<int>(w), kind.plan->body_in_row(row)));
      }
    }
  }
  return out;
}

Presence::Flags Presence::joints_in(const Batch& batch) const {
  Flags out;
  for (const Kind& kind : kinds_) {
    for (std::size_t w = 0; w < kind.worlds; ++w) {
      for (std::size_t j = 0; j < joints_of(kind); ++j) {
        out.push_back(batch.joint_enabled(kind.first_world + static_cast<int>(w),
                                          JointId(static_cast<int>(j))));
      }
    }
  }
  return out;
}

bool Presence::find(const Recording& recording, Batch& batch, std::int64_t every,
                    std::size_t samples, const GoOn& go_on) {
  const Recording::Impl& all_of_it = recording.impl();
  const auto any_input = [&](auto&& is) {
    return std::any_of(all_of_it.inputs.begin(), all_of_it.inputs.end(),
                       [&](const InputRow& row) { return is(row.input); });
  };
  const Flags bodies = bodies_in(batch), joints = joints_in(batch);
  const bool new_states = any_input([](Input i) { return brings_state(i); });
  const bool watch_bodies = new_states || !all(bodies) || any_input([](Input i) {
                              return i == Input::enable || i == Input::disable || i == Input::spawn;
                            });
  const bool watch_joints =
      !joints.empty() &&
      (new_states || !all(joints) || any_broken(all_of_it) ||
       any_input([](Input i) { return i == Input::enable_joint || i == Input::disable_joint; }));
  if (!watch_bodies && !watch_joints) return true;
  const auto add = [](const Flags& now, Flags& to) { to.insert(to.end(), now.begin(), now.end()); };
  run_again(recording, batch, go_on, [&](std::int64_t sample) {
    if (sample % every != 0) return;
    if (watch_bodies) add(bodies_in(batch), bodies_);
    if (watch_joints) add(joints_in(batch), joints_);
  });
  if (watch_bodies && bodies_.size() != bodies.size() * samples) return false;
  if (watch_joints && joints_.size() != joints.size() * samples) return false;
  if (all(bodies_)) bodies_.clear();
  if (all(joints_)) joints_.clear();
  return true;
}

void Presence::write(const Flags& flags, std::size_t (*items)(const Kind&), std::size_t kind,
                     std::size_t first, std::size_t count, page::ChunkWriter& chunk) const {
  std::size_t before = 0, each = 0;
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    if (k == kind) before = each;
    each += kinds_[k].worlds * items(kinds_[k]);
  }
  const std::size_t own = kinds_[kind].worlds * items(kinds_[kind]);
  std::vector<std::int32_t> there(own * count);
  for (std::size_t i = 0; i < own; ++i) {
    for (std::size_t f = 0; f < count; ++f) {
      there[i * count + f] = flags[(first + f) * each + before + i];
    }
  }
  chunk.add(there);
}

void Presence::write_bodies(std::size_t kind, std::size_t first, std::size_t count,
                            page::ChunkWriter& chunk) const {
  if (any_body_gone()) write(bodies_, &rows_of, kind, first, count, chunk);
}
void Presence::write_joints(std::size_t kind, std::size_t first, std::size_t count,
                            page::ChunkWriter& chunk) const {
  if (any_joint_gone()) write(joints_, &joints_of, kind, first, count, chunk);
}

}  // namespace manyworlds::record
