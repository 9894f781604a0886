// Contacts of worlds as a page holds them: whole numbers in lists, one after the other, over the
// frames of a chunk.
//
// Channels, in this order: how many there are, [world][frame], as those of bodies (frames.hpp);
// then lists, worlds one after the other, the frames of each, and its points in the order of their
// bodies: body A, body B, position, normal, force. Bodies are what is left of those at the same
// place of the list of the frame before (0 where there are none). The other numbers are what is
// left of the next point of these two bodies in that list, or of 0: what rests leaves zeros.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/page/frames.hpp"

namespace manyworlds::page {

inline constexpr double kContactSteps = 256;  // to the radius of the smallest body
inline constexpr double kNormalSteps = 127;   // to 1
// 64 steps to a factor of two above the least, N: forces are within 0.6 %.
inline constexpr double kForceSteps = 64;
inline constexpr double kLeastForce = 1e-6;

struct ContactPoint {
  int body_a = 0, body_b = 0;  // of the scene
  std::array<double, 3> point{}, normal{};
  double force = 0;  // N
};

// 0 up to the least, else 1 + the steps above it, 65535 at most.
std::int32_t force_code(double force);

class ContactCoder {
 public:
  // step: m. space: components of positions, 2 or 3.
  ContactCoder(double step, std::size_t worlds, std::size_t space)
      : step_(step), space_(space), lists_(worlds) {}
  // Of one frame; worlds have theirs one after the other.
  void add(std::size_t world, std::vector<ContactPoint> points);
  // What was added since the last call.
  void write(ChunkWriter& to);

 private:
  // a, b, then position, normal and force.
  using Numbers = std::array<std::int32_t, 9>;
  using List = std::vector<Numbers>;

  std::size_t width() const { return 2 + 2 * space_ + 1; }

  double step_;
  std::size_t space_;
  std::vector<std::vector<List>> lists_;  // [world][frame]
};

}  // namespace manyworlds::page
