// Frames as a page holds them: whole numbers, coded as what a straight line through the two frames
// before does not foretell, in chunks that can be read alone.
//
// A channel is one number of every item (a body of every world) over the frames of a chunk, items
// one after the other. What is left of each value is folded, 0 -1 1 -2 2 to 0 1 2 3 4, and written
// as bytes of equal weight beside one another, as many as the largest of the channel needs: most of
// the high ones are zero, of which deflate leaves nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace manyworlds::page {

inline constexpr double kPositionSteps = 512;     // to the radius of a body
inline constexpr double kQuaternionSteps = 1024;  // to 1
inline constexpr double kAngleSteps = 4096;       // to a full turn
// Speeds are drawn as colours: a byte each, 12 steps to a factor of two above this one, m/s or
// rad/s.
inline constexpr double kSlowest = 1e-3;
inline constexpr double kSpeedSteps = 12;

// To the nearest of those whose differences do not overflow.
std::int32_t rounded(double value);

// 0 below the slowest, else 1 + the steps above it, 255 at most.
std::uint8_t speed_code(double speed);

// Of one chunk: appends channels to `bytes`.
class ChunkWriter {
 public:
  explicit ChunkWriter(std::size_t frames) : frames_(frames) {}
  // [item][frame]
  void add(std::span<const std::int32_t> values);
  // As they are, of any number.
  void add_list(std::span<const std::int32_t> values);
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  const std::vector<int>& widths() const { return widths_; }  // bytes per value, of each channel

 private:
  // All of `folded_`.
  void write_folded();

  std::size_t frames_;
  std::vector<std::uint8_t> bytes_;
  std::vector<int> widths_;
  std::vector<std::uint32_t> folded_;
};

// Positions, orientations and speeds of the bodies of one kind, frame by frame.
class PoseQuantizer {
 public:
  // steps: of each body, in m. components: of positions, 2 or 3; of orientations, 0, 2 or 4.
  PoseQuantizer(std::vector<double> steps, std::size_t worlds, std::size_t space,
                std::size_t orientation, std::size_t frames);
  // [world][body][component], as Batch::read has them. Numbers that are not finite repeat those of
  // the frame before.
  void add(std::span<const double> positions, std::span<const double> orientations,
           std::span<const double> linear, std::span<const double> angular);
  std::size_t frames() const { return frame_; }
  // What was added since the last call, as channels: positions, orientations, speed, rate of
  // rotation.
  void write(ChunkWriter& to);

 private:
  std::size_t channels() const { return space_ + turns_ + 2; }
  std::int32_t& at(std::size_t channel, std::size_t item) {
    return values_[(channel * items_ + item) * most_ + frame_];
  }

  std::vector<double> steps_;
  std::size_t items_, space_, orientation_, turns_, most_;
  std::size_t frame_ = 0;
  std::vector<std::int32_t> values_;  // [channel][item][frame]
  std::vector<std::int32_t> before_;  // [channel][item]
};

}  // namespace manyworlds::page
