// Commands of pages, carried out between steps.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <system_error>
#include <utility>

#include "src/live/impl.hpp"

namespace manyworlds {
namespace {

constexpr int kMaxSnapshots = 100;  // of one Live: what a page could fill the disk with

// Of a scene's name, what can be in that of a file.
std::string file_name_of(const std::string& name) {
  std::string out;
  for (const char c : name.substr(0, 60)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    out += plain ? c : '_';
  }
  return out.empty() ? "scene" : out;
}

}  // namespace

void Live::Impl::obey(Batch& batch) {
  if (!hub.any_command()) return;
  for (const live::Command& command : hub.take()) {
    try {
      carry_out(batch, command);
    } catch (const std::exception& error) {
      hub.say(command.page, error.what());
    }
  }
}

void Live::Impl::pull(Batch& batch, int steps) {
  for (const auto& [page, drag] : drags) {
    live::add_drag(batch, sizes.kind_of(drag.world), drag, steps);
  }
}

void Live::Impl::carry_out(Batch& batch, const live::Command& command) {
  using live::Command;
  const auto refused = [&](bool may, const char* what) {
    if (!may) hub.say(command.page, std::string("this program does not allow pages to ") + what);
    return !may;
  };
  switch (command.kind) {
    case Command::pause:
    case Command::play:
      if (refused(options.clock, "pause it")) return;
      asked.paused = command.kind == Command::pause;
      asked.steps = 0;
      return changed();
    case Command::step:
      if (refused(options.clock, "step it")) return;
      asked.paused = true;
      asked.steps = std::min(asked.steps + static_cast<int>(command.number),
                             static_cast<int>(live::kMaxSteps));
      return;
    case Command::speed:
      if (refused(options.clock, "set its speed")) return;
      asked.speed = command.number;
      return changed();
    case Command::reset:
      if (!refused(options.resets, "reset worlds")) reset(batch, command.world);
      return;
    case Command::drag: {
      const auto held = drags.find(command.page);
      if (held == drags.end() || held->second.world != command.world ||
          held->second.body != command.body || held->second.at != command.at) {
        drags[command.page] =
            live::make_drag(sizes.kind_of(command.world), command.world, command.body, command.at);
      }
      drags[command.page].to = command.to;
      return;
    }
    case Command::drop:
    case Command::gone: drags.erase(command.page); return;
    case Command::push: {
      const live::PointMotion now = live::motion_of(batch, sizes.kind_of(command.world),
                                                    command.world, command.body, command.at);
      batch.add_impulse_at(command.world, command.body, command.to, now.point);
      return changed();
    }
    case Command::controls:
      if (!refused(options.controls, "set controls")) set_controls(batch, command);
      return;
    case Command::gravity:
      if (!refused(options.parameters && sliders.gravity, "change gravity")) {
        set_gravity(batch, command.to);
      }
      return;
    case Command::friction:
      if (!refused(options.parameters && sliders.friction, "change friction")) {
        set_friction(batch, command.number);
      }
      return;
    case Command::save: return save(batch, command.page);
    case Command::open:
    case Command::look:
    case Command::frame: return;  // of the server
  }
}

void Live::Impl::reset(Batch& batch, int world) {
  if (world < 0) {
    batch.reset();
  } else {
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(batch.worlds()));
    mask[static_cast<std::size_t>(world)] = 1;
    batch.reset(mask);
  }
  seen_steps = batch.steps();
  if (head.any_varies()) {
    hub.resize(std::make_shared<live::VariedSizes>(head.measure(batch)), true);
  }
  changed();
}

void Live::Impl::set_controls(Batch& batch, const live::Command& command) {
  if (controls_set) controls_set();
  const int first = std::max(command.world, 0);
  const int end = command.world < 0 ? batch.worlds() : command.world + 1;
  for (int w = first; w < end; ++w) batch.set_controls(w, command.values);
}

void Live::Impl::set_gravity(Batch& batch, const Vec3& value) {
  const Vec3 within = value.cwiseMax(sliders.gravity_low).cwiseMin(sliders.gravity_high);
  std::vector<double> all(batch.size(Parameter::gravity));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = within[static_cast<int>(i % 3)];
  batch.write(Parameter::gravity, all);
}

void Live::Impl::set_friction(Batch& batch, double factor) {
  const double within = std::clamp(factor, sliders.friction_low, sliders.friction_high);
  std::vector<double> all;
  all.reserve(batch.size(Parameter::friction));
  for (int w = 0; w < batch.worlds(); ++w) {
    for (const Body& body : sizes.kind_of(w).plan.scene().bodies) {
      for (const Shape& shape : body.shapes) all.push_back(within * shape.material.friction);
    }
  }
  batch.write(Parameter::friction, all);
}

void Live::Impl::save(const Batch& batch, int page) {
  if (saved >= kMaxSnapshots) {
    return hub.say(page, "no snapshot: " + std::to_string(kMaxSnapshots) + " were saved already");
  }
  const std::string stem =
      file_name_of(sizes.kinds.front().plan.scene().name) + "-step" + std::to_string(batch.steps());
  std::filesystem::path file;
  for (int n = 1;; ++n) {  // what is there stays
    file = options.folder / (stem + (n > 1 ? "-" + std::to_string(n) : "") + ".snapshot");
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) break;
  }
  batch.save().save(file);
  ++saved;
  hub.say(page, "saved " + file.filename().string());
}

}  // namespace manyworlds
