#include "tools/invariants/penetration_overlaps.hpp"

#include <algorithm>
#include <cmath>

namespace manyworlds::invariants {

// A contact's overlap is what the step found, which could be along a poor normal. No direction
// yields less than the true depth, so the least over some is at most a little too large.
double Overlaps::of_pair(const Piece& a, const Piece& b, const StepContact& contact,
                         const std::vector<BodyNow>& at) const {
  const BodyNow &na = at[a.body], &nb = at[b.body];
  const Vec3 apart = nb.position - na.position;
  double least = -contact.separation;
  const auto offer = [&](const Vec3& d) {
    least = std::min(least, reach(a, space, na, d) + reach(b, space, nb, -d) - apart.dot(d));
  };
  offer(contact.normal);
  constexpr int kDirections = 100;
  for (int i = 0; i < kDirections; ++i) {
    const double z = space == Space::planar ? 0 : 1 - (2 * i + 1.0) / kDirections;
    const double angle = space == Space::planar ? 2 * scenes::kPi * i / kDirections : 2.399963 * i;
    const double across = std::sqrt(1 - z * z);
    offer({across * std::cos(angle), across * std::sin(angle), z});
  }
  for (int i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      offer(na.rotation * (sign * Vec3::Unit(i))), offer(nb.rotation * (sign * Vec3::Unit(i)));
    }
  }
  return least;
}

// Of bodies inside one another, of which the step may know no contact: the balls about their
// origins that shapes with a centre of symmetry hold.
double Overlaps::of_centres(const std::vector<BodyNow>& at) const {
  const auto symmetric = [](const Geometry& g) {
    return !std::holds_alternative<Hull>(g) && !std::holds_alternative<Polygon>(g);
  };
  double most = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!symmetric(pieces[i].geometry)) continue;
    for (std::size_t j = 0; j < i; ++j) {
      const Piece &a = pieces[i], &b = pieces[j];
      const double sum = a.thickness + b.thickness;
      const double square = (at[a.body].position - at[b.body].position).squaredNorm();
      if (square >= sum * sum || !symmetric(b.geometry)) continue;
      most = std::max(most, (sum - std::sqrt(square) - slop) / std::min(a.thickness, b.thickness));
    }
  }
  return most;
}

double Overlaps::worst(const Seen& seen) {
  double most = of_centres(seen.now);
  out.resize(pieces.size(), 0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    const BodyNow& now = seen.now[piece.body];
    if (!finite(now)) return HUGE_VAL;
    if (now.position.dot(scenes::up_of(space)) > top - piece.radius) out[i] = 1;
    if (out[i]) continue;
    for (const BinWall& wall : walls) {
      const double height = now.position.dot(wall.normal) - wall.offset;
      if (height > piece.radius) continue;
      const double depth = reach(piece, space, now, -wall.normal) - height;
      most = std::max(most, (depth - slop) / piece.thickness);
    }
  }
  // Separations are those at the start of the step.
  for (const StepContact& contact : seen.contacts) {
    const int i = piece_of_body[static_cast<std::size_t>(contact.body_a.index())];
    const int j = piece_of_body[static_cast<std::size_t>(contact.body_b.index())];
    if (i < 0 || j < 0) continue;
    const Piece &a = pieces[static_cast<std::size_t>(i)], &b = pieces[static_cast<std::size_t>(j)];
    const double least = std::min(a.thickness, b.thickness);
    if ((-contact.separation - slop) / least <= most) continue;
    most = std::max(most, (of_pair(a, b, contact, seen.before) - slop) / least);
  }
  return most;
}

}  // namespace manyworlds::invariants
