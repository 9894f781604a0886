// How far bodies of a world overlap each other and walls.
#pragma once

#include <cmath>
#include <vector>

#include "tools/invariants/penetration.hpp"

namespace manyworlds::invariants {

struct BinWall {
  Vec3 normal;
  double offset;  // m, solid where normal . p <= offset
};

// What overlaps of one world are measured with.
struct Overlaps {
  Space space = Space::spatial;
  std::vector<Piece> pieces;
  std::vector<int> piece_of_body;  // -1: fixed
  std::vector<BinWall> walls;
  double slop = 0;
  double top = HUGE_VAL;       // m, height of the walls
  std::vector<char> out = {};  // pieces that were above it: they may come down outside

  void add(BodyId body, const Geometry& geometry) {
    piece_of_body.resize(static_cast<std::size_t>(body.index()) + 1, -1);
    piece_of_body.back() = static_cast<int>(pieces.size());
    pieces.push_back(piece_of(body, geometry));
  }
  // The largest overlap beyond slop over the least half thickness.
  double worst(const Seen& seen);

 private:
  double of_pair(const Piece& a, const Piece& b, const StepContact& contact,
                 const std::vector<BodyNow>& at) const;
  double of_centres(const std::vector<BodyNow>& at) const;
};

}  // namespace manyworlds::invariants
