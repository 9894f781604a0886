#include "src/page/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace manyworlds::page {

std::int32_t force_code(double force) {
  if (!(force > kLeastForce)) return 0;
  return static_cast<std::int32_t>(
      std::min(65535.0, 1 + std::round(kForceSteps * std::log2(force / kLeastForce))));
}

void ContactCoder::add(std::size_t world, std::vector<ContactPoint> points) {
  std::stable_sort(points.begin(), points.end(), [](const ContactPoint& a, const ContactPoint& b) {
    return std::pair(a.body_a, a.body_b) < std::pair(b.body_a, b.body_b);
  });
  List list;
  list.reserve(points.size());
  for (const ContactPoint& p : points) {
    Numbers& to = list.emplace_back();
    to[0] = p.body_a, to[1] = p.body_b;
    for (std::size_t c = 0; c < space_; ++c) {
      to[2 + c] = std::isfinite(p.point[c]) ? rounded(p.point[c] / step_) : 0;
      to[2 + space_ + c] = std::isfinite(p.normal[c]) ? rounded(p.normal[c] * kNormalSteps) : 0;
    }
    to[2 + 2 * space_] = force_code(p.force);
  }
  lists_[world].push_back(std::move(list));
}

void ContactCoder::write(ChunkWriter& to) {
  std::vector<std::int32_t> counts;
  std::vector<std::vector<std::int32_t>> channels(width());
  for (std::vector<List>& frames : lists_) {
    const List none;
    const List* before = &none;
    for (const List& list : frames) {
      counts.push_back(static_cast<std::int32_t>(list.size()));
      std::size_t next = 0;
      for (std::size_t i = 0; i < list.size(); ++i) {
        const Numbers& now = list[i];
        for (std::size_t c = 0; c < 2; ++c) {
          channels[c].push_back(now[c] - (i < before->size() ? (*before)[i][c] : 0));
        }
        const auto key = [](const Numbers& n) { return std::pair(n[0], n[1]); };
        while (next < before->size() && key((*before)[next]) < key(now)) ++next;
        const bool known = next < before->size() && key((*before)[next]) == key(now);
        for (std::size_t c = 2; c < width(); ++c) {
          channels[c].push_back(now[c] - (known ? (*before)[next][c] : 0));
        }
        if (known) ++next;
      }
      before = &list;
    }
  }
  to.add(counts);
  for (const auto& channel : channels) to.add_list(channel);
  for (std::vector<List>& frames : lists_) frames.clear();
}

}  // namespace manyworlds::page
