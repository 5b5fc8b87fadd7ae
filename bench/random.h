// SPDX-License-Identifier: MIT
// Indexed random numbers: the n-th ray of a class is the same on every machine and for every number of threads.
#pragma once

#include <cstdint>

namespace scarp::bench {

/// The random sequence of one index and seed. SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom
/// number generators", OOPSLA 2014), started from a mix of both.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t index) : state_(mix(seed) ^ mix(~index)) {}

  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15u); }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, count).
  int below(int count) { return static_cast<int>(uniform() * count); }

 private:
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }

  std::uint64_t state_;
};

}  // namespace scarp::bench
