// SPDX-License-Identifier: MIT
// The 24 rotations that map a voxel lattice onto itself, exact in integers.
#pragma once

#include <array>
#include <cstddef>

#include "scarp/base/vec.h"

namespace scarp {

/// A signed permutation: component i of the rotated vector is sign[i] * v[axis[i]]. `axis` is a permutation of 0, 1, 2;
/// signs are 1 or -1.
struct LatticeRotation {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  template <class Vec>
  Vec operator()(const Vec& v) const {
    using T = typename Vec::value_type;
    return {T(sign[0]) * v[axis[0]], T(sign[1]) * v[axis[1]], T(sign[2]) * v[axis[2]]};
  }

  LatticeRotation inverse() const {
    LatticeRotation back;
    for (std::size_t i = 0; i < 3; ++i) {
      back.axis[source(i)] = static_cast<int>(i);
      back.sign[source(i)] = sign[i];
    }
    return back;
  }

  /// axis[i] as an index.
  std::size_t source(std::size_t i) const { return static_cast<std::size_t>(axis[i]); }

  /// Returns 1 for rotations, -1 for reflections.
  int determinant() const {
    const bool odd = (axis[0] > axis[1]) ^ (axis[0] > axis[2]) ^ (axis[1] > axis[2]);
    return (odd ? -1 : 1) * sign[0] * sign[1] * sign[2];
  }

  friend bool operator==(const LatticeRotation&, const LatticeRotation&) = default;
};

/// Returns the composition that applies b first, then a.
inline LatticeRotation operator*(const LatticeRotation& a, const LatticeRotation& b) {
  LatticeRotation both;
  for (std::size_t i = 0; i < 3; ++i) {
    both.axis[i] = b.axis[a.source(i)];
    both.sign[i] = a.sign[i] * b.sign[a.source(i)];
  }
  return both;
}

/// Returns all 24 rotations, the identity first.
inline std::array<LatticeRotation, 24> lattice_rotations() {
  constexpr std::array<std::array<int, 3>, 6> kPermutations = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  std::array<LatticeRotation, 24> all;
  std::size_t count = 0;
  for (const auto& axis : kPermutations) {
    for (int signs = 0; signs < 8; ++signs) {
      const LatticeRotation turn{axis, {signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1}};
      if (turn.determinant() == 1) all[count++] = turn;
    }
  }
  return all;
}

}  // namespace scarp
