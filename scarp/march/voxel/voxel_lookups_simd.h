// SPDX-License-Identifier: MIT
// How far the marches of voxel_packet_simd.cpp advance at once: a structure per technique, all lanes at a time.
// Compiled once per instruction set.
#if defined(SCARP_MARCH_VOXEL_LOOKUPS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SCARP_MARCH_VOXEL_LOOKUPS_SIMD_H
#undef SCARP_MARCH_VOXEL_LOOKUPS_SIMD_H
#else
#define SCARP_MARCH_VOXEL_LOOKUPS_SIMD_H
#endif

#include <cstddef>
#include <cstdint>
#include <span>

#include "hwy/highway.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/march/voxel/voxel_ahead.h"
#include "scarp/march/voxel/voxel_target.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, 8> dd;
constexpr hn::RebindToSigned<decltype(dd)> di;
constexpr hn::RebindToUnsigned<decltype(dd)> du;
constexpr hn::Rebind<std::int32_t, decltype(dd)> di_part;
constexpr hn::Rebind<float, decltype(dd)> df_part;
constexpr std::size_t N = hn::MaxLanes(dd);
using VD = hn::Vec<decltype(dd)>;
using VI = hn::Vec<decltype(di)>;
using MD = hn::Mask<decltype(dd)>;
using MI = hn::Mask<decltype(di)>;

// 64-bit integers whose upper halves are 0.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE VI product(VI a, VI b) { return hn::Set(di, (hn::GetLane(a) & 0xffffffff) * (hn::GetLane(b) & 0xffffffff)); }
HWY_INLINE VI lesser(VI a, VI b) { return hn::Min(a, b); }
#else
constexpr hn::Repartition<std::uint32_t, decltype(dd)> du32;
constexpr hn::Repartition<std::int32_t, decltype(dd)> di32;
HWY_INLINE VI product(VI a, VI b) { return hn::BitCast(di, hn::MulEven(hn::BitCast(du32, a), hn::BitCast(du32, b))); }
HWY_INLINE VI lesser(VI a, VI b) { return hn::BitCast(di, hn::Min(hn::BitCast(di32, a), hn::BitCast(di32, b))); }
#endif
// Result of a lookup: whether voxels are solid, and otherwise how many planes may be crossed along each axis. `at` are
// the voxels, mirrored along negative directions.
struct LookupResult {
  MI solid;
  VI planes[3];
};

HWY_INLINE VI index_in(const VI (&v)[3], const ivec3& size) {
  return hn::Add(v[0], product(hn::Set(di, size.x), hn::Add(v[1], product(hn::Set(di, size.y), v[2]))));
}
HWY_INLINE VI bit_in(const VI (&v)[3]) {
  const VI three = hn::Set(di, 3);
  return hn::Or(hn::And(v[0], three),
                hn::Or(hn::ShiftLeft<2>(hn::And(v[1], three)), hn::ShiftLeft<4>(hn::And(v[2], three))));
}
HWY_INLINE VI shifted(VI word, VI by) { return hn::BitCast(di, hn::Shr(hn::BitCast(du, word), hn::BitCast(du, by))); }
HWY_INLINE VI gather_words(const std::uint64_t* words, VI index) {
  return hn::GatherIndex(di, reinterpret_cast<const std::int64_t*>(words), index);
}
HWY_INLINE VI gather_bytes(const std::uint8_t* bytes, VI offset) {
  return hn::And(hn::GatherOffset(di, reinterpret_cast<const std::int64_t*>(bytes), offset), hn::Set(di, 255));
}

HWY_INLINE VI gather_ints(const std::uint32_t* ints, VI index) {
  const VI found = hn::GatherOffset(di, reinterpret_cast<const std::int64_t*>(ints), hn::ShiftLeft<2>(index));
  return hn::And(found, hn::Set(di, 0xffffffff));
}
// The index of an entry among the values of a table.
template <class T>
HWY_INLINE VI place_in(const SparseTable<T>& table, VI index) {
  if (table.flat()) return index;
  constexpr int kBits = SparseTable<T>::kChunkBits;
  const VI chunk = gather_ints(table.chunks().data(), hn::ShiftRight<kBits>(index));
  return hn::Add(chunk, hn::And(index, hn::Set(di, (1 << kBits) - 1)));
}

// Masks of bricks, as VoxelGrid::mask().
HWY_INLINE VI gather_masks(const VoxelGrid& grid, VI brick) {
  static_assert(VoxelGrid::kPageBricks == 64);
  const VI page = place_in(grid.page_table(), hn::ShiftRight<6>(brick));
  const VI first_mask = gather_ints(grid.first_masks().data(), page);
  return gather_words(grid.masks().data(), hn::Add(first_mask, hn::And(brick, hn::Set(di, 63))));
}

// One plane at a time.
template <bool kWideBox>
struct PlanesLookup {
  static constexpr bool kSingle = true, kTravels = false, kWide = kWideBox, kDescends = false;
  const VoxelGrid& grid;

  explicit PlanesLookup(const VoxelTarget& target) : grid(*target.grid) {}
  HWY_INLINE LookupResult operator()(const VI (&v)[3], const VI (&)[3], const VI (&)[3], MI alive) const {
    const VI brick[3] = {hn::ShiftRight<2>(v[0]), hn::ShiftRight<2>(v[1]), hn::ShiftRight<2>(v[2])};
    const VI mask = gather_masks(grid, hn::IfThenElseZero(alive, index_in(brick, grid.bricks())));
    const VI one = hn::Set(di, 1);
    return {hn::Ne(hn::And(shifted(mask, bit_in(v)), one), hn::Zero(di)), {one, one, one}};
  }
};

// Cubes around voxels, or ahead of them: a byte each.
struct CubesLookup {
  static constexpr bool kSingle = false, kTravels = false, kWide = false, kDescends = false;
  const VoxelBytes& bytes;

  explicit CubesLookup(const VoxelTarget& target) : bytes(target.cubes->distances()) {}
  HWY_INLINE LookupResult operator()(const VI (&v)[3], const VI (&)[3], const VI (&)[3], MI alive) const {
    const VI index = hn::IfThenElseZero(alive, index_in(v, bytes.size()));
    const VI distance = gather_bytes(bytes.data(), index);
    return {hn::Eq(distance, hn::Zero(di)), {distance, distance, distance}};
  }
};

// One plane, then all planes within `planes[0]` voxels of travel: a byte each.
struct SpheresLookup {
  static constexpr bool kSingle = true, kTravels = true, kWide = false, kDescends = false;
  const VoxelBytes& bytes;

  explicit SpheresLookup(const VoxelTarget& target) : bytes(target.spheres->distances()) {}
  HWY_INLINE LookupResult operator()(const VI (&v)[3], const VI (&)[3], const VI (&)[3], MI alive) const {
    const VI index = hn::IfThenElseZero(alive, index_in(v, bytes.size()));
    const VI distance = gather_bytes(bytes.data(), index);
    return {hn::Eq(distance, hn::Set(di, EmptySpheres::kSolid)), {distance, distance, distance}};
  }
};

struct CubesJumpLookup {
  static constexpr bool kSingle = true, kTravels = true, kWide = false, kDescends = false;
  CubesLookup cubes;

  explicit CubesJumpLookup(const VoxelTarget& target) : cubes(target) {}
  HWY_INLINE LookupResult operator()(const VI (&v)[3], const VI (&at)[3], const VI (&down)[3], MI alive) const {
    LookupResult seen = cubes(v, at, down, alive);
    seen.planes[0] = hn::Sub(seen.planes[0], hn::Set(di, 1));
    return seen;
  }
};

struct OctantsLookup {
  static constexpr bool kSingle = false, kTravels = false, kWide = false, kDescends = false;
  const VoxelBytes& bytes;
  ivec3 size;

  explicit OctantsLookup(const VoxelTarget& target) : bytes(target.octants->sides()), size(target.grid->size()) {}
  HWY_INLINE LookupResult operator()(const VI (&v)[3], const VI (&)[3], const VI (&down)[3], MI alive) const {
    const VI octant = hn::Or(hn::And(down[0], hn::Set(di, 1)),
                             hn::Or(hn::And(down[1], hn::Set(di, 2)), hn::And(down[2], hn::Set(di, 4))));
    const VI z = hn::Add(v[2], product(octant, hn::Set(di, size.z)));
    const VI index = hn::IfThenElseZero(alive, index_in({v[0], v[1], z}, size));
    const VI side = gather_bytes(bytes.data(), index);
    return {hn::Eq(side, hn::Zero(di)), {side, side, side}};
  }
};

// Blocks of 2^level voxels, as in voxel_bricks.cpp. kCoarse: in grids with levels above sectors.
template <bool kWideBox, bool kCoarse>
struct BricksLookup {
  static constexpr bool kSingle = false, kTravels = false, kWide = kWideBox, kDescends = kCoarse;
  const VoxelGrid& grid;
  const BrickMasks& bricks;

  explicit BricksLookup(const VoxelTarget& target) : grid(*target.grid), bricks(*target.bricks) {}
  static HWY_INLINE MI pair_empty(VI mask, VI bit) {
    const VI pair = shifted(mask, hn::And(bit, hn::Set(di, kEven)));
    return hn::Eq(hn::And(pair, hn::Set(di, static_cast<std::int64_t>(kPair))), hn::Zero(di));
  }
  // moved: the bits of the voxel that the last step has changed, on any axis. The ray was in the cells above them.
  HWY_INLINE LookupResult operator()(const VI (&v)[3], const VI (&at)[3], const VI (&down)[3], MI alive,
                                     [[maybe_unused]] VI moved = hn::Zero(di)) const {
    const VI zero = hn::Zero(di), one = hn::Set(di, 1);
    const VI octant = hn::Or(hn::And(down[0], hn::Set(di, 64)),
                             hn::Or(hn::And(down[1], hn::Set(di, 128)), hn::And(down[2], hn::Set(di, 256))));
    const std::span<const BrickMasks::Level> levels = bricks.levels();
    VI last = zero;  // side of the block - 1
    MI open = alive;
    const auto cells_of = [&](const BrickMasks::Level& level, const VI(&cell)[3], MI lanes) {
      const VI parent[3] = {hn::ShiftRight<2>(cell[0]), hn::ShiftRight<2>(cell[1]), hn::ShiftRight<2>(cell[2])};
      const VI index = hn::IfThenElseZero(lanes, index_in(parent, level.size));
      return gather_words(level.masks.values().data(), place_in(level.masks, index));
    };
    if constexpr (kCoarse) {
      for (std::size_t i = levels.size(); i > 0; --i) {
        const int side = static_cast<int>(2 * i);  // of the cell, as a power of 2
        const MI entered = hn::And(open, hn::Gt(moved, hn::Set(di, (std::int64_t{1} << side) - 1)));
        if (hn::AllFalse(di, entered)) continue;
        const VI cell[3] = {hn::ShiftRightSame(v[0], side), hn::ShiftRightSame(v[1], side),
                            hn::ShiftRightSame(v[2], side)};
        const VI cell_bit = bit_in(cell), cells = cells_of(levels[i - 1], cell, entered);
        const MI empty = hn::And(entered, hn::Eq(hn::And(shifted(cells, cell_bit), one), zero));
        if (hn::AllFalse(di, empty)) continue;
        const VI there = hn::And(cells, gather_words(kAhead[0].data(), hn::Or(octant, cell_bit)));
        const auto side_of = [&](int power) { return hn::Set(di, (std::int64_t{1} << power) - 1); };
        const VI some = hn::IfThenElse(pair_empty(there, cell_bit), side_of(side + 1), side_of(side));
        last = hn::IfThenElse(empty, hn::IfThenElse(hn::Eq(there, zero), side_of(side + 2), some), last);
        open = hn::AndNot(empty, open);
      }
    }
    const VI brick[3] = {hn::ShiftRight<2>(v[0]), hn::ShiftRight<2>(v[1]), hn::ShiftRight<2>(v[2])};
    const VI bit = bit_in(v);
    const VI mask = hn::And(gather_masks(grid, hn::IfThenElseZero(open, index_in(brick, grid.bricks()))),
                            gather_words(kAhead[0].data(), hn::Or(octant, bit)));
    const MI solid = hn::And(open, hn::Ne(hn::And(shifted(mask, bit), one), zero));
    last = hn::IfThenElse(open, hn::IfThenElseZero(pair_empty(mask, bit), one), last);
    const MI clear = hn::And(open, hn::Eq(mask, zero));
    if (!hn::AllFalse(di, clear)) {
      const VI brick_bit = bit_in(brick),
               own = hn::BitCast(di, hn::Shl(hn::BitCast(du, one), hn::BitCast(du, brick_bit)));
      const VI bricks_of =
          hn::And(cells_of(levels[0], brick, clear), gather_words(kAhead[0].data(), hn::Or(octant, brick_bit)));
      const VI small = hn::IfThenElse(pair_empty(bricks_of, brick_bit), hn::Set(di, 7), hn::Set(di, 3));
      const MI all = hn::Eq(hn::AndNot(own, bricks_of), zero);
      last = hn::IfThenElse(clear, hn::IfThenElse(all, hn::Set(di, 15), small), last);
    }
    // From a voxel, counted along the ray, to the end of its block.
    const VI side = hn::Add(last, one);
    return {solid,
            {hn::Sub(side, hn::And(at[0], last)), hn::Sub(side, hn::And(at[1], last)),
             hn::Sub(side, hn::And(at[2], last))}};
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#endif
