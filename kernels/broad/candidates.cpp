// Lists of candidates: dense (a block is one pair in every lane, some lanes idle) or rows (each
// lane has its own pairs, packed). Both keep the order of the keys inside a lane, so both give the
// solver the same rows in the same order.
#include "kernels/lane/ints.hpp"
#include "kernels/lane/rows.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Above this share of active lanes dense blocks are faster than rows (measured,
// docs/kernels.md).
#if defined(MW_ISA_AVX512)
constexpr float kDenseOccupancy = 0.45f;
#else
constexpr float kDenseOccupancy = 0.55f;
#endif
// Of so few blocks, dense ones are faster as well where rows would be more than this share of them:
// what packing saves is less than moving velocities lane by lane costs.
constexpr unsigned kFewBlocks = 16;
constexpr float kPackedShare = 0.8f;

std::int32_t dummy_code(const Constants& t, bool fixed) {
  return (fixed ? 0 : t.colliders) | (t.colliders << 16);
}

class RowPacker {
 public:
  RowPacker(CandidateList& to, std::int32_t dummy) : to_(to), dummy_(dummy) {
    for (int& n : count_) n = 0;
  }
  // Returns where.
  MW_INLINE int add(int lane, std::int32_t code, std::int32_t key) {
    const int at = count_[lane]++ * kLanes + lane;
    to_.code[at] = code;
    to_.key[at] = key;
    return at;
  }
  void close() {
    int most = 0;
    for (int n : count_) most = n > most ? n : most;
    for (int s = 0; s < most; ++s) to_.mask[s] = 0;
    for (int l = 0; l < kLanes; ++l) {
      for (int s = 0; s < count_[l]; ++s) to_.mask[s] |= 1u << l;
      for (int s = count_[l]; s < most; ++s) {
        to_.code[s * kLanes + l] = dummy_;
        to_.key[s * kLanes + l] = 0;
      }
    }
    to_.count = most;
  }

 private:
  CandidateList& to_;
  std::int32_t dummy_;
  int count_[kLanes];
};

#if defined(MW_ISA_AVX512)

// Hits of the class at work as rows. They are packed lane by lane, as many hits at once as a
// register holds, and then transposed: no branch depends on which lanes a hit has.
void list_rows(const Constants& t, Work& w, CandidateList& to) {
  const auto& pairs = t.pair_class[w.class_index];
  const int first = first_hit(t, w, w.class_index), n = w.hit_count[w.class_index];
  const std::int32_t* hits = w.hits + first;
  const auto* masks = reinterpret_cast<const std::int32_t*>(w.hit_masks + first);
  const int room = w.candidate_room;
  std::int32_t *packed_codes = w.found.code, *packed_keys = w.found.key;  // [lane][room]
  alignas(64) std::int32_t count[kLanes] = {};
  for (int i = 0; i < n; i += kLanes) {
    const Ints mask = load_first(masks + i, n - i), hit = load_first(hits + i, n - i);
    const Ints key = hit + Ints(pairs.first_key);
    const Ints code = t.sparse ? load_first(w.sparse.hit_code + first + i, n - i)
                               : gather(pairs.a, hit) + gather(pairs.b, hit) * Ints(1 << 16);
    for (int l = 0; l < kLanes; ++l) {
      const std::uint32_t which = with_any_of(mask, 1 << l);
      const int at = l * room + count[l];
      store_packed(code, which, packed_codes + at);
      store_packed(key, which, packed_keys + at);
      count[l] += __builtin_popcount(which);
    }
  }
  int most = 0;
  for (const int c : count) most = c > most ? c : most;
  const Ints counts = Ints::load(count), dummy(dummy_code(t, is_fixed(pairs.list)));
  alignas(64) std::int32_t lane[kLanes];
  (Ints::lanes() * Ints(room)).store(lane);
  for (int s = 0; s < most; s += 4) {
    Float code[4], key[4];
    load_rows4(reinterpret_cast<const Real*>(packed_codes) + s, lane, code[0], code[1], code[2],
               code[3]);
    load_rows4(reinterpret_cast<const Real*>(packed_keys) + s, lane, key[0], key[1], key[2],
               key[3]);
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t there = Ints(s + k) < counts;
      select(there, as_ints(code[k]), dummy).store(to.code + (s + k) * kLanes);
      select(there, as_ints(key[k]), Ints(0)).store(to.key + (s + k) * kLanes);
      to.mask[s + k] = there;
    }
  }
  to.count = most;
}

#else

void list_rows(const Constants& t, Work& w, CandidateList& to) {
  const auto& pairs = t.pair_class[w.class_index];
  const int first = first_hit(t, w, w.class_index);
  RowPacker packer(to, dummy_code(t, is_fixed(pairs.list)));
  for (int i = 0; i < w.hit_count[w.class_index]; ++i) {
    const std::int32_t code = code_of_hit(t, w, w.class_index, i);
    const std::int32_t key = pairs.first_key + w.hits[first + i];
    for (std::uint32_t m = w.hit_masks[first + i]; m != 0; m &= m - 1) {
      packer.add(__builtin_ctz(m), code, key);
    }
  }
  packer.close();
}

#endif

// Drops the last candidates of lanes that have too many: the same ones in both layouts.
void limit_candidates(const Constants& t, Work& w, int at) {
  const auto& pairs = t.pair_class[at];
  const int limit = candidate_limit(t, pairs), hits = w.hit_count[at];
  if (t.sparse || hits <= limit) return;
  std::uint32_t* masks = w.hit_masks + pairs.first_key;
  int count[kLanes] = {};
  for (int i = 0; i < hits; ++i) {
    for (std::uint32_t m = masks[i]; m != 0; m &= m - 1) {
      const int lane = __builtin_ctz(m);
      if (++count[lane] > limit) {
        masks[i] &= ~(1u << lane);
        w.overflow |= 1u << lane;
      }
    }
  }
}

// As many as the lists take in rows: the candidates of the lane that has most.
unsigned blocks_in_rows(const Constants& t, const Work& w) {
  unsigned out = 0;
  for (int c = 0; c < t.classes; ++c) {
    const std::uint32_t* masks = w.hit_masks + first_hit(t, w, c);
    Ints count(0);
    for (int i = 0; i < w.hit_count[c]; ++i) count = count + select(masks[i], Ints(1), Ints(0));
    alignas(64) std::int32_t of_lane[kLanes];
    count.store(of_lane);
    std::int32_t most = 0;
    for (const std::int32_t n : of_lane) most = n > most ? n : most;
    out += static_cast<unsigned>(most);
  }
  return out;
}

bool dense_is_faster(const Constants& t, const Work& w, unsigned all, unsigned active) {
  // Parts of joints are blocks of which every lane is active.
  const auto parts = static_cast<unsigned>(t.parts), dense = all + parts;
  if (static_cast<float>(active + parts * kLanes) >=
      kDenseOccupancy * static_cast<float>(dense * kLanes)) {
    return true;
  }
  return all <= kFewBlocks && static_cast<float>(blocks_in_rows(t, w) + parts) >=
                                  kPackedShare * static_cast<float>(dense);
}

}  // namespace

kernels::Layout choose_layout(const Constants& t, const Group& g, kernels::Scratch* scratch,
                              kernels::Layout wish) {
  Work& w = work_of(scratch);
  unsigned blocks[kLists] = {}, all = 0, active = 0;
  for (int c = 0; c < t.classes; ++c) {
    limit_candidates(t, w, c);
    const auto& pairs = t.pair_class[c];
    const int hits = w.hit_count[c];
    const std::uint32_t* masks = w.hit_masks + first_hit(t, w, c);
    for (int i = 0; i < hits; ++i) active += static_cast<unsigned>(__builtin_popcount(masks[i]));
    blocks[static_cast<int>(pairs.list)] += static_cast<unsigned>(hits);
    all += static_cast<unsigned>(hits);
  }
  w.counters.dense_blocks = all;
  w.counters.active = active;
  bool fits = true;
  for (int l = 0; l < kLists; ++l) {
    fits = fits && static_cast<int>(blocks[l]) < w.blocks[l].max_blocks;
  }
  // Rows of trees are of one pair of shapes in all lanes, and there is room for all of them.
  if (t.tree.links > 0) wish = kernels::Layout::dense, fits = true;
  w.dense = wish == kernels::Layout::dense;
  if (wish == kernels::Layout::automatic) w.dense = dense_is_faster(t, w, all, active);
  w.dense = w.dense && fits;
  if (w.dense) return kernels::Layout::dense;
  drop_distant(t, g, w);
  for (int i = 0; i < t.bodies * kLanes; ++i) w.met[i] = 0;
  return kernels::Layout::rows;
}

void list_candidates(const Constants& t, Work& w) {
  const auto& pairs = t.pair_class[w.class_index];
  const int first = first_hit(t, w, w.class_index);
  const std::int32_t* hits = w.hits + first;
  const std::uint32_t* masks = w.hit_masks + first;
  const int n = w.hit_count[w.class_index];
  CandidateList& to = w.candidates;
  if (w.dense) {
    for (int i = 0; i < n; ++i) {
      const std::int32_t code = code_of_hit(t, w, w.class_index, i);
      const std::int32_t key = pairs.first_key + hits[i];
      for (int l = 0; l < kLanes; ++l) {
        to.code[i * kLanes + l] = code;
        to.key[i * kLanes + l] = key;
      }
      to.mask[i] = masks[i];
    }
    to.count = n;
    return;
  }
  list_rows(t, w, to);
}

void compact(const Constants& t, Work& w, const CandidateList& from, const std::uint32_t* keep,
             CandidateList& to) {
  const auto& pairs = t.pair_class[w.class_index];
  if (w.dense) {
    int n = 0;
    for (int i = 0; i < from.count; ++i) {
      if (keep[i] == 0) continue;
      for (int l = 0; l < kLanes; ++l) {
        to.code[n * kLanes + l] = from.code[i * kLanes + l];
        to.key[n * kLanes + l] = from.key[i * kLanes + l];
        to.axis[n * kLanes + l] = from.axis[i * kLanes + l];
      }
      to.mask[n++] = keep[i];
    }
    to.count = n;
    return;
  }
  RowPacker packer(to, dummy_code(t, is_fixed(pairs.list)));
  for (int i = 0; i < from.count; ++i) {
    for (std::uint32_t m = keep[i]; m != 0; m &= m - 1) {
      const int l = __builtin_ctz(m);
      const int at = i * kLanes + l;
      to.axis[packer.add(l, from.code[at], from.key[at])] = from.axis[at];
    }
  }
  packer.close();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
