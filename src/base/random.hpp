// Counter-based random numbers: a draw depends on (world seed, episode, draw index) and on nothing
// else, so it is the same whatever the batch, the lane or the order in which worlds are set up.
#pragma once

#include <cstdint>
#include <string_view>

namespace manyworlds {

// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection that spreads every bit.
inline constexpr std::uint64_t mix_bits(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

class Draws {
 public:
  constexpr Draws(std::uint64_t world_seed, std::uint64_t episode)
      : key_(mix_bits(mix_bits(world_seed + kStep) ^ (episode * kStep + 1))) {}

  // Uniform in [0, 1), 53 bits.
  constexpr double uniform(std::uint64_t index) const {
    return static_cast<double>(mix_bits(key_ + (index + 1) * kStep) >> 11) * 0x1p-53;
  }
  // Uniform in [-1, 1).
  constexpr double symmetric(std::uint64_t index) const { return 2 * uniform(index) - 1; }

  constexpr std::uint64_t key() const { return key_; }

  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ull;

 private:
  std::uint64_t key_;
};

// Numbers of a name, of a world and an episode: number `count` of one does not depend on which
// other names or numbers are drawn.
inline constexpr std::uint64_t stream_of(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return mix_bits(hash);
}
// 64 random bits. `key`: of Draws.
inline constexpr std::uint64_t bits_of_stream(std::uint64_t key, std::uint64_t stream,
                                              std::uint64_t count) {
  return mix_bits(mix_bits(key ^ stream) + (count + 1) * Draws::kStep);
}
// Uniform in [0, 1), as many of the highest bits as the number has.
template <class Real>
constexpr Real uniform_of(std::uint64_t bits) {
  if constexpr (sizeof(Real) == 4) return static_cast<float>(bits >> 40) * 0x1p-24f;
  return static_cast<Real>(static_cast<double>(bits >> 11) * 0x1p-53);
}

}  // namespace manyworlds
