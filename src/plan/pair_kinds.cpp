#include "src/plan/pair_kinds.hpp"

#include <array>

namespace manyworlds {

namespace {

using kernels::ListId;
using kernels::PairKind;
using kernels::ShapeKind;

// The order in which classes of pairs are solved, as it grew. What is not named comes after, so a
// new shape changes no world without it.
constexpr ShapeKind kOrder[][2] = {
    {ShapeKind::sphere, ShapeKind::sphere},     {ShapeKind::box, ShapeKind::sphere},
    {ShapeKind::box, ShapeKind::box},           {ShapeKind::plane, ShapeKind::sphere},
    {ShapeKind::plane, ShapeKind::box},         {ShapeKind::circle, ShapeKind::circle},
    {ShapeKind::rectangle, ShapeKind::circle},  {ShapeKind::rectangle, ShapeKind::rectangle},
    {ShapeKind::polygon, ShapeKind::circle},    {ShapeKind::polygon, ShapeKind::polygon},
    {ShapeKind::plane, ShapeKind::circle},      {ShapeKind::plane, ShapeKind::rectangle},
    {ShapeKind::plane, ShapeKind::polygon},     {ShapeKind::sphere, ShapeKind::box},
    {ShapeKind::circle, ShapeKind::rectangle},  {ShapeKind::circle, ShapeKind::polygon},
    {ShapeKind::capsule, ShapeKind::sphere},    {ShapeKind::capsule, ShapeKind::circle},
    {ShapeKind::capsule, ShapeKind::capsule},   {ShapeKind::box, ShapeKind::capsule},
    {ShapeKind::rectangle, ShapeKind::capsule}, {ShapeKind::polygon, ShapeKind::capsule},
    {ShapeKind::plane, ShapeKind::capsule},     {ShapeKind::sphere, ShapeKind::capsule},
    {ShapeKind::circle, ShapeKind::capsule},    {ShapeKind::capsule, ShapeKind::box},
    {ShapeKind::capsule, ShapeKind::rectangle}, {ShapeKind::capsule, ShapeKind::polygon},
    {ShapeKind::link, ShapeKind::circle},       {ShapeKind::link, ShapeKind::rectangle},
    {ShapeKind::link, ShapeKind::polygon},      {ShapeKind::link, ShapeKind::capsule},
    {ShapeKind::plane, ShapeKind::cylinder},    {ShapeKind::plane, ShapeKind::hull},
    {ShapeKind::cylinder, ShapeKind::sphere},   {ShapeKind::cylinder, ShapeKind::capsule},
    {ShapeKind::box, ShapeKind::cylinder},      {ShapeKind::cylinder, ShapeKind::cylinder},
    {ShapeKind::hull, ShapeKind::sphere},       {ShapeKind::hull, ShapeKind::capsule},
    {ShapeKind::hull, ShapeKind::box},          {ShapeKind::hull, ShapeKind::cylinder},
    {ShapeKind::hull, ShapeKind::hull},         {ShapeKind::sphere, ShapeKind::cylinder},
    {ShapeKind::capsule, ShapeKind::cylinder},  {ShapeKind::cylinder, ShapeKind::box},
    {ShapeKind::sphere, ShapeKind::hull},       {ShapeKind::capsule, ShapeKind::hull},
    {ShapeKind::box, ShapeKind::hull},          {ShapeKind::cylinder, ShapeKind::hull},
    {ShapeKind::tile, ShapeKind::sphere},       {ShapeKind::tile, ShapeKind::capsule},
    {ShapeKind::tile, ShapeKind::box},          {ShapeKind::tile, ShapeKind::cylinder},
    {ShapeKind::tile, ShapeKind::hull},         {ShapeKind::plane, ShapeKind::rounded},
    {ShapeKind::rounded, ShapeKind::circle},    {ShapeKind::rounded, ShapeKind::rounded},
    {ShapeKind::rounded, ShapeKind::capsule},   {ShapeKind::circle, ShapeKind::rounded},
    {ShapeKind::capsule, ShapeKind::rounded},   {ShapeKind::link, ShapeKind::rounded}};

constexpr int kNamed = static_cast<int>(std::size(kOrder));

constexpr auto kRank = [] {
  std::array<int, kernels::kPairKinds> rank{};
  for (int kind = 0; kind < kernels::kPairKinds; ++kind) {
    rank[static_cast<std::size_t>(kind)] = kNamed + kind;
  }
  for (int i = 0; i < kNamed; ++i) {
    rank[static_cast<std::size_t>(kernels::pair_of(kOrder[i][0], kOrder[i][1]))] = i;
  }
  return rank;
}();

ListId list_of(PairKind kind, bool fixed) {
  const bool single = is_single(kind);
  return fixed ? (single ? ListId::fixed_single : ListId::fixed_multi)
               : (single ? ListId::pair_single : ListId::pair_multi);
}

}  // namespace

KindOfPair::Place KindOfPair::place() const {
  return {static_cast<int>(list), kRank[static_cast<std::size_t>(kind)]};
}

KindOfPair kind_of_pair(ShapeKind a, ShapeKind b, bool fixed) {
  const bool swapped = !fixed && info(a).rank < info(b).rank;
  const PairKind kind = swapped ? kernels::pair_of(b, a) : kernels::pair_of(a, b);
  return {kind, list_of(kind, fixed), swapped};
}

std::string to_string(PairKind kind) {
  const ShapeKind a = shape_a(kind), b = shape_b(kind);
  const bool half = a == ShapeKind::plane && info(b).planar;
  return std::string(half ? "half" : "") + info(a).name + "-" + info(b).name;
}

}  // namespace manyworlds
