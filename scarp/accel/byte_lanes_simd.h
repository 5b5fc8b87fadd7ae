// SPDX-License-Identifier: MIT
// Rows of bytes in vectors, for edits of voxel accelerators: lanes shifted along a row, and distances spread along it.
// Every vector is loaded and stored at the same positions in a row, so that loads never straddle recent stores.
// Included once per instruction set.
#if defined(SCARP_ACCEL_BYTE_LANES_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_ACCEL_BYTE_LANES_SIMD_H
#undef SCARP_ACCEL_BYTE_LANES_SIMD_H
#else
#define SCARP_ACCEL_BYTE_LANES_SIMD_H
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "hwy/highway.h"
#include "scarp/accel/voxel_bytes.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<std::uint8_t, 32> d8;
constexpr std::size_t N = hn::MaxLanes(d8);
using V = hn::Vec<decltype(d8)>;
static_assert(N <= VoxelBytes::kReadBeyond, "the last vector of a row reads beyond it");

// Lane i of from_above is lane i + k, of from_below lane i - k; missing lanes come from the next or previous vector.
#if HWY_TARGET == HWY_SCALAR
template <int k>
HWY_INLINE V from_above(V, V next) {
  return next;
}
template <int k>
HWY_INLINE V from_below(V, V previous) {
  return previous;
}
#elif HWY_CAP_GE256
template <int k>
HWY_INLINE V from_above(V lanes, V next) {
  const V middle = hn::ConcatLowerUpper(d8, next, lanes);
  if constexpr (k == 16) return middle;
  return hn::CombineShiftRightBytes<k % 16>(d8, middle, lanes);
}
template <int k>
HWY_INLINE V from_below(V lanes, V previous) {
  const V middle = hn::ConcatLowerUpper(d8, lanes, previous);
  if constexpr (k == 16) return middle;
  return hn::CombineShiftRightBytes<16 - k % 16>(d8, lanes, middle);
}
#else
template <int k>
HWY_INLINE V from_above(V lanes, V next) {
  return hn::CombineShiftRightBytes<k>(d8, next, lanes);
}
template <int k>
HWY_INLINE V from_below(V lanes, V previous) {
  return hn::CombineShiftRightBytes<16 - k>(d8, lanes, previous);
}
#endif

// The neighbour along x, on the side of lower or higher voxels.
template <bool kLower>
HWY_INLINE V beside(V lanes, V neighbours) {
  if constexpr (kLower) return from_below<1>(lanes, neighbours);
  return from_above<1>(lanes, neighbours);
}

// For each lane, the minimum over that lane and all lanes on one side, each plus its distance.
template <bool kLower, int k = 1>
HWY_INLINE V spread(V lanes) {
  if constexpr (k < static_cast<int>(N)) {
    const V all = hn::Set(d8, 255);
    V shifted;
    if constexpr (kLower) {
      shifted = from_below<k>(lanes, all);
    } else {
      shifted = from_above<k>(lanes, all);
    }
    return spread<kLower, 2 * k>(hn::Min(lanes, hn::SaturatedAdd(shifted, hn::Set(d8, k))));
  } else {
    return lanes;
  }
}

// How rows of a grid are divided into vectors.
class ByteRows {
 public:
  explicit ByteRows(int length)
      : length_(static_cast<std::size_t>(length)), count_((length_ + N - 1) / N), beyond_(count_ * N) {
    for (std::size_t x = length_; x < beyond_.size(); ++x) beyond_[x] = 255;
    for (std::size_t i = 0; i < N; ++i) {
      from_lower_[i] = static_cast<std::uint8_t>(i + 1);
      from_higher_[i] = static_cast<std::uint8_t>(N - i);
    }
  }

  int count() const { return static_cast<int>(count_); }
  int vector_of(int x) const { return x / static_cast<int>(N); }
  std::size_t padded() const { return count_ * N; }
  /// 255 in lanes beyond the row.
  HWY_INLINE V beyond(std::size_t x) const { return hn::LoadU(d8, beyond_.data() + x); }
  /// Distance of each lane from the vector's neighbour on one side.
  template <bool kLower>
  HWY_INLINE V away() const {
    return hn::LoadU(d8, kLower ? from_lower_ : from_higher_);
  }
  HWY_INLINE void store(V lanes, std::uint8_t* row, std::size_t x) const {
    if (x + N <= length_) {
      hn::StoreU(lanes, d8, row + x);
    } else {
      alignas(64) std::uint8_t some[N];
      hn::Store(lanes, d8, some);
      std::memcpy(row + x, some, length_ - x);
    }
  }

 private:
  std::size_t length_, count_;
  std::vector<std::uint8_t> beyond_;
  std::uint8_t from_lower_[N], from_higher_[N];
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
