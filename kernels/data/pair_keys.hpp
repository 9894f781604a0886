// Keys of candidate pairs. A plan with tables lists the pairs of a class and numbers them; a sparse
// plan has no lists, and computes the same order:
//   moving shapes   a tournament (circle method): pairs of a round share no shape, so neighbouring
//                   rows of the solver do not wait for each other's velocities
//   fixed shapes    fixed shape by fixed shape: again neighbours are about different bodies
// Keys ascend from class to class.
#pragma once

#include "kernels/data/tables.hpp"

namespace manyworlds::kernels {

// The shapes of a candidate pair: colliders, or a fixed shape and a collider.
struct PairOfKey {
  std::int32_t a, b;
};

// A tournament of n: an even number of seats, of which the last one stays where it is and the
// others, an odd number, move on by one from round to round.
static inline constexpr std::int32_t moving_seats(std::int32_t n) { return n - 1 + n % 2; }
static inline constexpr std::int32_t tables_of_round(std::int32_t n) {
  return (moving_seats(n) + 1) / 2;
}
static inline constexpr std::int64_t places_of_tournament(std::int32_t n) {
  return n < 2 ? 0 : static_cast<std::int64_t>(moving_seats(n)) * tables_of_round(n);
}

// Where the pair i < j comes in the tournament of n.
static inline constexpr std::int32_t tournament_place(std::int32_t n, std::int32_t i,
                                                      std::int32_t j) {
  const std::int32_t seats = moving_seats(n), tables = tables_of_round(n);
  if (j == seats) return i * tables;  // at table 0, in round i
  std::int32_t sum = i + j;           // twice the round, modulo the seats
  if (sum >= seats) sum -= seats;
  const std::int32_t round = sum % 2 == 0 ? sum / 2 : (sum + seats) / 2;
  std::int32_t table = i - round;
  if (table < 0) table += seats;
  return round * tables + (table < tables ? table : seats - table);
}

// The reverse: b is n where a seat is empty.
static inline constexpr PairOfKey tournament_pair(std::int32_t n, std::int32_t place) {
  const std::int32_t seats = moving_seats(n), tables = tables_of_round(n);
  const std::int32_t round = place / tables, table = place % tables;
  if (table == 0) return {round, seats};
  const std::int32_t i = (round + table) % seats, j = (round + seats - table) % seats;
  return i < j ? PairOfKey{i, j} : PairOfKey{j, i};
}

// Of a sparse plan: the class of two moving shapes i < j, or -1, and whether A is the second.
struct ClassOfPair {
  std::int32_t index;
  bool swapped;
};
template <class Real>
static inline ClassOfPair class_of_moving(const SceneConstants<Real>& t, std::int32_t i,
                                          std::int32_t j) {
  const std::int32_t found =
      t.moving_class[static_cast<int>(t.collider[i].kind)][static_cast<int>(t.collider[j].kind)];
  return {found / 2, found % 2 == 1};
}
template <class Real>
static inline std::int32_t class_of_fixed(const SceneConstants<Real>& t, std::int32_t fixed,
                                          std::int32_t j) {
  return t.fixed_class[static_cast<int>(t.fixed[fixed].kind)][static_cast<int>(t.collider[j].kind)];
}

static inline constexpr bool filters_agree(std::uint32_t category_a, std::uint32_t mask_a,
                                           std::uint32_t category_b, std::uint32_t mask_b) {
  return (category_a & mask_b) != 0 && (category_b & mask_a) != 0;
}

// Does a joint keep the shapes of this body and that one from colliding?
template <class Real>
static inline bool joined(const SceneConstants<Real>& t, std::int32_t body, std::int32_t other) {
  if (!t.joined) return false;
  for (std::int32_t i = t.first_joined[body]; i < t.first_joined[body + 1]; ++i) {
    if (t.joined[i] == other) return true;
  }
  return false;
}

// Can these shapes ever touch? What a plan with tables culls when it is made.
template <class Real>
static inline bool may_touch(const SceneConstants<Real>& t, std::int32_t i, std::int32_t j) {
  const auto &a = t.collider[i], &b = t.collider[j];
  return a.body != b.body && filters_agree(a.category, a.mask, b.category, b.mask) &&
         !(t.body[a.body].kinematic && t.body[b.body].kinematic) && !joined(t, a.body, b.body);
}
template <class Real>
static inline bool may_touch_fixed(const SceneConstants<Real>& t, std::int32_t fixed,
                                   std::int32_t j) {
  const auto& a = t.fixed[fixed];
  const auto& b = t.collider[j];
  return filters_agree(a.category, a.mask, b.category, b.mask) && !t.body[b.body].kinematic &&
         !joined(t, b.body, a.body);
}

// Which class a key belongs to; keys outside of all give t.classes.
template <class Real>
static inline std::int32_t class_of_key(const SceneConstants<Real>& t, std::int32_t key) {
  std::int32_t c = 0;
  while (c < t.classes && key - t.pair_class[c].first_key >= t.pair_class[c].count) ++c;
  return c;
}

template <class Real>
static inline PairOfKey pair_of_key(const SceneConstants<Real>& t, std::int32_t key) {
  const auto& c = t.pair_class[class_of_key(t, key)];
  const std::int32_t place = key - c.first_key;
  if (!t.sparse) return {c.a[place], c.b[place]};
  if (is_fixed(c.list)) return {place / t.colliders, place % t.colliders};
  const PairOfKey pair = tournament_pair(t.colliders, place);
  return class_of_moving(t, pair.a, pair.b).swapped ? PairOfKey{pair.b, pair.a} : pair;
}

// Is there such a pair? For keys that come from outside.
template <class Real>
static inline bool is_key(const SceneConstants<Real>& t, ListId list, std::int32_t key) {
  if (key < 0) return false;
  const std::int32_t at = class_of_key(t, key);
  if (at == t.classes || t.pair_class[at].list != list) return false;
  const auto& c = t.pair_class[at];
  if (key < c.first_key) return false;
  if (!t.sparse) return true;
  const std::int32_t place = key - c.first_key;
  if (is_fixed(list)) {
    const std::int32_t fixed = place / t.colliders, j = place % t.colliders;
    return class_of_fixed(t, fixed, j) == at && may_touch_fixed(t, fixed, j);
  }
  const PairOfKey pair = tournament_pair(t.colliders, place);
  return pair.b < t.colliders && class_of_moving(t, pair.a, pair.b).index == at &&
         may_touch(t, pair.a, pair.b);
}

}  // namespace manyworlds::kernels
