#include "src/page/frames.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace manyworlds::page {
namespace {

// Beyond it linear prediction would overflow.
constexpr double kLargest = 1 << 28;

std::uint32_t folded(std::int32_t value) {
  return static_cast<std::uint32_t>(value) << 1 ^ static_cast<std::uint32_t>(value >> 31);
}

double norm(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum);
}

}  // namespace

std::int32_t rounded(double value) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -kLargest, kLargest)));
}

std::uint8_t speed_code(double speed) {
  if (!(speed > kSlowest)) return 0;
  return static_cast<std::uint8_t>(
      std::min(255.0, 1 + std::round(kSpeedSteps * std::log2(speed / kSlowest))));
}

void ChunkWriter::add(std::span<const std::int32_t> values) {
  folded_.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t frame = i % frames_;
    const std::int32_t one = frame > 0 ? values[i - 1] : 0, two = frame > 1 ? values[i - 2] : one;
    const std::int32_t left = values[i] - (2 * one - two);
    folded_[i] = folded(left);
  }
  write_folded();
}

void ChunkWriter::add_list(std::span<const std::int32_t> values) {
  folded_.resize(values.size());
  std::transform(values.begin(), values.end(), folded_.begin(), folded);
  write_folded();
}

void ChunkWriter::write_folded() {
  std::uint32_t largest = 0;
  for (const std::uint32_t value : folded_) largest |= value;
  int width = 0;
  for (; width < 4 && largest >> (8 * width) != 0; ++width) {
    for (const std::uint32_t value : folded_) {
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * width)));
    }
  }
  widths_.push_back(width);
}

PoseQuantizer::PoseQuantizer(std::vector<double> steps, std::size_t worlds, std::size_t space,
                             std::size_t orientation, std::size_t frames)
    : steps_(std::move(steps)),
      items_(worlds * steps_.size()),
      space_(space),
      orientation_(orientation),
      turns_(orientation == 2 ? 1 : orientation),
      most_(frames),
      values_(channels() * items_ * frames),
      before_(channels() * items_) {
  // The identity, for those that begin without a number.
  if (turns_ != 4) return;
  std::fill_n(before_.begin() + static_cast<std::ptrdiff_t>(space_ * items_), items_,
              static_cast<std::int32_t>(kQuaternionSteps));
}

void PoseQuantizer::add(std::span<const double> positions, std::span<const double> orientations,
                        std::span<const double> linear, std::span<const double> angular) {
  const std::size_t spins = space_ == 2 ? 1 : 3;
  const auto finite = [](std::span<const double> v) {
    return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  };
  for (std::size_t i = 0; i < items_; ++i) {
    for (std::size_t c = 0; c < channels(); ++c) at(c, i) = before_[c * items_ + i];
    const auto x = positions.subspan(i * space_, space_);
    if (finite(x)) {
      for (std::size_t c = 0; c < space_; ++c) at(c, i) = rounded(x[c] / steps_[i % steps_.size()]);
    }
    if (orientation_ > 0) {
      const auto q = orientations.subspan(i * orientation_, orientation_);
      const double length = norm(q);
      if (length > 0 && std::isfinite(length)) {
        if (orientation_ == 2) {
          // The angle nearest to that of the frame before, so that it does not jump by a turn.
          std::int32_t& to = at(space_, i);
          const double turn = std::atan2(q[1], q[0]) / (2 * std::numbers::pi);
          const double last = to / kAngleSteps;
          to = rounded((turn + std::round(last - turn)) * kAngleSteps);
        } else {
          // Of q and -q the one nearer to that of the frame before.
          double along = 0;
          for (std::size_t c = 0; c < 4; ++c) along += q[c] * at(space_ + c, i);
          const double scale = (along < 0 ? -1 : 1) * kQuaternionSteps / length;
          for (std::size_t c = 0; c < 4; ++c) at(space_ + c, i) = rounded(q[c] * scale);
        }
      }
    }
    at(space_ + turns_, i) = speed_code(norm(linear.subspan(i * space_, space_)));
    at(space_ + turns_ + 1, i) = speed_code(norm(angular.subspan(i * spins, spins)));
    for (std::size_t c = 0; c < channels(); ++c) before_[c * items_ + i] = at(c, i);
  }
  ++frame_;
}

void PoseQuantizer::write(ChunkWriter& to) {
  std::vector<std::int32_t> channel(items_ * frame_);
  for (std::size_t c = 0; c < channels(); ++c) {
    for (std::size_t i = 0; i < items_; ++i) {
      std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>((c * items_ + i) * most_), frame_,
                  channel.begin() + static_cast<std::ptrdiff_t>(i * frame_));
    }
    to.add(channel);
  }
  frame_ = 0;
}

}  // namespace manyworlds::page
