#pragma once

// References
//   [S]  G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014: SplitMix64 and its finaliser.
//   [BM] G. E. P. Box, M. E. Muller, Ann. Math. Statist. 29 (1958).

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>

namespace misfit {

/// Random numbers by their address instead of in a row: the number at (seed, job, stream, …) is the same whoever asks for it, in whatever
/// order. Bits: SplitMix64's finaliser [S], chained over the words of the address.
[[nodiscard]] inline std::uint64_t random_bits(std::initializer_list<std::uint64_t> address) {
  std::uint64_t z = 0;
  for (const std::uint64_t word : address) {
    z = (z ^ word) + 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
  }
  return z;
}

/// Uniform on (0, 1), never an end: 53 bits and a half.
[[nodiscard]] inline double random_uniform(std::uint64_t seed, std::uint64_t job, std::uint64_t stream, std::uint64_t index = 0) {
  return (static_cast<double>(random_bits({seed, job, stream, index}) >> 11) + 0.5) * 0x1.0p-53;
}

/// Standard normal [BM].
[[nodiscard]] inline double random_normal(std::uint64_t seed, std::uint64_t job, std::uint64_t stream, std::uint64_t index = 0) {
  const double radius = std::sqrt(-2.0 * std::log(random_uniform(seed, job, stream, 2 * index)));
  return radius * std::cos(2.0 * std::numbers::pi * random_uniform(seed, job, stream, 2 * index + 1));
}

}  // namespace misfit
