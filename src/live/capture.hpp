// Worlds of a batch at one moment, copied for those who look, and frames made of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"
#include "src/live/command.hpp"

namespace manyworlds::live {

struct Clockwork {
  bool paused = false;
  double speed = 1;    // asked for, may be infinite
  double reached = 0;  // simulated per real second, lately
};

struct Capture {
  std::uint64_t version = 0;  // grows with every change of the batch
  std::int64_t steps = 0;
  double time = 0;  // s
  int lost = 0;     // of all worlds
  Clockwork clock = {};

  std::vector<int> worlds = {};  // ascending
  // Of each of them: where its bodies begin in the arrays below.
  std::vector<std::size_t> first = {};
  std::vector<double> positions = {}, orientations = {}, linear = {}, angular = {};
  std::vector<std::uint8_t> there = {};
  std::vector<std::size_t> first_joint = {};  // of each world, as `first`
  std::vector<std::uint8_t> joints = {};      // whether each is there: not disabled, not broken
  std::vector<std::uint32_t> status = {};     // [world]

  bool has(std::span<const int> wanted) const;
};

// Reads these worlds of the batch; the rest of the capture is the caller's.
Capture capture(const Batch& batch, const Sizes& sizes, std::vector<int> worlds);

// A frame of those worlds of `wanted` that the capture has, as the page reads it
// (viewer/src/live.ts), little endian:
//   0 u32 magic, 4 u32 flags (1: paused), 8 f64 time, 16 f64 steps, 24 f64 speed asked for,
//   32 f64 speed reached, 40 u32 lost worlds, 44 u32 worlds n, 48 u32 bodies m, 52 u32 joints j
//   from 64 on: u32 [n] which worlds, u32 [n] status,
//   f32 [m][2 or 3] positions, i16 [m][turns] orientations, u8 [m] speed, u8 [m] rate of rotation,
//   u8 [m] whether it is there, u8 [j] whether the joint is there
// Orientations are quaternions w x y z times 32767; in the plane w and z of one. `turns` is 4, 2,
// or 0 where the plan has none. Speeds are coded as in recordings.
std::string frame_of(const Capture& capture, const Sizes& sizes, std::span<const int> wanted);

inline constexpr std::uint32_t kFrameMagic = 0x316c776d;  // "mwl1"
inline constexpr std::size_t kFrameHead = 64;
inline constexpr double kTurnSteps = 32767;

}  // namespace manyworlds::live
