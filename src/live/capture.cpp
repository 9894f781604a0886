#include "src/live/capture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "src/page/frames.hpp"

namespace manyworlds::live {
namespace {

static_assert(std::endian::native == std::endian::little);

std::size_t components_of(const Plan& plan, Field field) {
  return plan.numbers(field) == 0 ? 0
                                  : static_cast<std::size_t>(components(field, plan.scene().space));
}

// Appends one number after the other.
class Writer {
 public:
  explicit Writer(std::size_t size) { out_.reserve(size); }
  template <class T>
  void put(T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out_.append(bytes, sizeof value);
  }
  void fill(std::size_t size) { out_.resize(size); }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

double norm(const double* x, std::size_t n) {
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += x[i] * x[i];
  return std::sqrt(sum);
}

std::int16_t turn_code(double x) {
  const double value = std::isfinite(x) ? std::clamp(x, -1.0, 1.0) : 0;
  return static_cast<std::int16_t>(std::lround(value * kTurnSteps));
}

// Half of the angle of a rotation in the plane.
void put_planar(Writer& out, const double* q) {
  const double half = std::isfinite(q[0] + q[1]) ? std::atan2(q[1], q[0]) / 2 : 0;
  out.put(turn_code(std::cos(half))), out.put(turn_code(std::sin(half)));
}

void put_spatial(Writer& out, const double* q) {
  const double length = norm(q, 4);
  const bool sound = length > 0 && std::isfinite(length);
  for (int c = 0; c < 4; ++c) out.put(turn_code(sound ? q[c] / length : c == 0));
}

float finite(double x) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return std::isfinite(x) ? static_cast<float>(std::clamp(x, -kMost, kMost)) : 0.0f;
}

}  // namespace

bool Capture::has(std::span<const int> wanted) const {
  return std::includes(worlds.begin(), worlds.end(), wanted.begin(), wanted.end());
}

Capture capture(const Batch& batch, const Sizes& sizes, std::vector<int> worlds) {
  Capture out;
  out.worlds = std::move(worlds);
  std::size_t bodies = 0;
  for (const int w : out.worlds) {
    out.first.push_back(bodies);
    bodies += static_cast<std::size_t>(sizes.kind_of(w).plan.bodies());
  }
  const Scene& scene = sizes.kinds.front().plan.scene();
  const auto width = static_cast<std::size_t>(components(Field::position, scene.space));
  const auto turns = static_cast<std::size_t>(components(Field::orientation, scene.space));
  const auto spins = static_cast<std::size_t>(components(Field::angular_velocity, scene.space));
  out.positions.resize(bodies * width), out.orientations.resize(bodies * turns);
  out.linear.resize(bodies * width), out.angular.resize(bodies * spins);
  out.there.reserve(bodies);
  const auto read = [&](Field field, std::vector<double>& to, std::size_t i, std::size_t n,
                        std::size_t rows) {
    batch.read(field, out.worlds[i], std::span(to).subspan(out.first[i] * n, rows * n));
  };
  for (std::size_t i = 0; i < out.worlds.size(); ++i) {
    const int w = out.worlds[i];
    const Plan& plan = sizes.kind_of(w).plan;
    const auto rows = static_cast<std::size_t>(plan.bodies());
    read(Field::position, out.positions, i, width, rows);
    if (components_of(plan, Field::orientation) > 0) {
      read(Field::orientation, out.orientations, i, turns, rows);
    }
    read(Field::linear_velocity, out.linear, i, width, rows);
    read(Field::angular_velocity, out.angular, i, spins, rows);
    for (int row = 0; row < plan.bodies(); ++row) {
      out.there.push_back(batch.enabled(w, plan.body_in_row(row)));
    }
    out.first_joint.push_back(out.joints.size());
    for (std::size_t j = 0; j < plan.scene().joints.size(); ++j) {
      out.joints.push_back(batch.joint_enabled(w, JointId(static_cast<int>(j))));
    }
    out.status.push_back(static_cast<std::uint32_t>(batch.status(w)));
  }
  return out;
}

std::string frame_of(const Capture& from, const Sizes& sizes, std::span<const int> wanted) {
  struct Part {
    std::size_t index, first, rows;
    const Plan* plan;
  };
  std::vector<Part> parts;
  std::size_t bodies = 0, joints = 0;
  for (const int w : wanted) {
    const auto found = std::lower_bound(from.worlds.begin(), from.worlds.end(), w);
    if (found == from.worlds.end() || *found != w) continue;
    const auto i = static_cast<std::size_t>(found - from.worlds.begin());
    const Plan& plan = sizes.kind_of(w).plan;
    parts.push_back({i, from.first[i], static_cast<std::size_t>(plan.bodies()), &plan});
    bodies += parts.back().rows;
    joints += plan.scene().joints.size();
  }
  const Space space = sizes.kinds.front().plan.scene().space;
  const std::size_t width = space == Space::planar ? 2 : 3, spins = space == Space::planar ? 1 : 3;
  const std::size_t turns = space == Space::planar ? 2 : 4;
  Writer out(kFrameHead + parts.size() * 8 + bodies * (width * 4 + 2 * 4 + 3) + joints);
  out.put(kFrameMagic), out.put(std::uint32_t{from.clock.paused});
  out.put(from.time), out.put(static_cast<double>(from.steps));
  out.put(from.clock.speed), out.put(from.clock.reached);
  out.put(static_cast<std::uint32_t>(from.lost)), out.put(static_cast<std::uint32_t>(parts.size()));
  out.put(static_cast<std::uint32_t>(bodies)), out.put(static_cast<std::uint32_t>(joints));
  out.fill(kFrameHead);
  for (const Part& p : parts) out.put(static_cast<std::uint32_t>(from.worlds[p.index]));
  for (const Part& p : parts) out.put(from.status[p.index]);
  const auto each = [&](auto&& f) {
    for (const Part& p : parts) {
      for (std::size_t b = p.first; b < p.first + p.rows; ++b) f(p, b);
    }
  };
  each([&](const Part&, std::size_t b) {
    for (std::size_t c = 0; c < width; ++c) out.put(finite(from.positions[b * width + c]));
  });
  each([&](const Part& p, std::size_t b) {
    if (components_of(*p.plan, Field::orientation) == 0) return;
    const double* q = &from.orientations[b * turns];
    space == Space::planar ? put_planar(out, q) : put_spatial(out, q);
  });
  each([&](const Part&, std::size_t b) {
    out.put(page::speed_code(norm(&from.linear[b * width], width)));
  });
  each([&](const Part&, std::size_t b) {
    out.put(page::speed_code(norm(&from.angular[b * spins], spins)));
  });
  each([&](const Part&, std::size_t b) { out.put(from.there[b]); });
  for (const Part& p : parts) {
    for (std::size_t j = 0; j < p.plan->scene().joints.size(); ++j) {
      out.put(from.joints[from.first_joint[p.index] + j]);
    }
  }
  return out.take();
}

}  // namespace manyworlds::live
