// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>

#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/march/voxel_ahead.h"
#include "scarp/march/voxel_packet.h"

// This file is compiled once for each instruction set.
// Vectors of a length that the compiler does not know cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/march/voxel_packet_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, 8> dd;
constexpr hn::RebindToSigned<decltype(dd)> di;
constexpr hn::RebindToUnsigned<decltype(dd)> du;
constexpr hn::Rebind<std::int32_t, decltype(dd)> di_part;
constexpr std::size_t N = hn::MaxLanes(dd);
using VD = hn::Vec<decltype(dd)>;
using VI = hn::Vec<decltype(di)>;
using MD = hn::Mask<decltype(dd)>;
using MI = hn::Mask<decltype(di)>;

constexpr std::size_t kVectors = VoxelPacket::kRays / N;
// 2^52 as a double: its last bits count ones.
constexpr double kOnes = 0x1p52;

// Whole numbers in 64 bits whose upper halves are 0.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE VI product(VI a, VI b) { return hn::Set(di, hn::GetLane(a) * hn::GetLane(b)); }
HWY_INLINE VI lesser(VI a, VI b) { return hn::Min(a, b); }
#else
constexpr hn::Repartition<std::uint32_t, decltype(dd)> du32;
constexpr hn::Repartition<std::int32_t, decltype(dd)> di32;
HWY_INLINE VI product(VI a, VI b) {
  return hn::BitCast(di, hn::MulEven(hn::BitCast(du32, a), hn::BitCast(du32, b)));
}
HWY_INLINE VI lesser(VI a, VI b) {
  return hn::BitCast(di, hn::Min(hn::BitCast(di32, a), hn::BitCast(di32, b)));
}
#endif
// 0 <= a < 2^52.
HWY_INLINE VD as_double(VI a) {
  const VI ones = hn::BitCast(di, hn::Set(dd, kOnes));
  return hn::Sub(hn::BitCast(dd, hn::Or(a, ones)), hn::Set(dd, kOnes));
}
// The nearest whole number, 0 <= a < 2^51.
HWY_INLINE VI nearest(VD a) {
  return hn::Xor(hn::BitCast(di, hn::Add(a, hn::Set(dd, kOnes))), hn::BitCast(di, hn::Set(dd, kOnes)));
}
// Rounded towards 0, |a| < 2^31.
HWY_INLINE VI truncated(VD a) { return hn::PromoteTo(di, hn::DemoteTo(di_part, a)); }

HWY_INLINE MI lanes_of(std::uint64_t bits) {
  const std::uint8_t some = static_cast<std::uint8_t>(bits & ((std::uint64_t{1} << N) - 1));
  return hn::LoadMaskBits(di, &some);
}
HWY_INLINE std::uint64_t bits_of(MI mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(di, mask, bits);
  return bits[0];
}

// grid_from_world * v, as glm has it.
HWY_INLINE void transform(const glm::dmat3& m, const VD (&v)[3], VD (&to)[3]) {
  for (int i = 0; i < 3; ++i) {
    to[i] = hn::Add(hn::Add(hn::Mul(hn::Set(dd, m[0][i]), v[0]), hn::Mul(hn::Set(dd, m[1][i]), v[1])),
                    hn::Mul(hn::Set(dd, m[2][i]), v[2]));
  }
}

// What the marches look at: whether voxels are solid, and else how many planes may be crossed along each axis. `at` are
// the voxels, mirrored where rays go down.
struct Seen {
  MI solid;
  VI planes[3];
};

HWY_INLINE VI index_in(const VI (&v)[3], const ivec3& size) {
  return hn::Add(v[0], product(hn::Set(di, size.x), hn::Add(v[1], product(hn::Set(di, size.y), v[2]))));
}
HWY_INLINE VI bit_in(const VI (&v)[3]) {
  const VI three = hn::Set(di, 3);
  return hn::Or(hn::And(v[0], three), hn::Or(hn::ShiftLeft<2>(hn::And(v[1], three)),
                                             hn::ShiftLeft<4>(hn::And(v[2], three))));
}
HWY_INLINE VI shifted(VI word, VI by) {
  return hn::BitCast(di, hn::Shr(hn::BitCast(du, word), hn::BitCast(du, by)));
}
HWY_INLINE VI gather_words(const std::uint64_t* words, VI index) {
  return hn::GatherIndex(di, reinterpret_cast<const std::int64_t*>(words), index);
}
HWY_INLINE VI gather_bytes(const std::uint8_t* bytes, VI offset) {
  return hn::And(hn::GatherOffset(di, reinterpret_cast<const std::int64_t*>(bytes), offset), hn::Set(di, 255));
}

// One plane after the other.
struct PlanesLook {
  static constexpr bool kSingle = true;
  const VoxelGrid& grid;

  explicit PlanesLook(const VoxelTarget& target) : grid(*target.grid) {}
  HWY_INLINE Seen operator()(const VI (&v)[3], const VI (&)[3], const VI (&)[3], MI alive) const {
    const VI brick[3] = {hn::ShiftRight<2>(v[0]), hn::ShiftRight<2>(v[1]), hn::ShiftRight<2>(v[2])};
    const VI mask = gather_words(grid.masks().data(), hn::IfThenElseZero(alive, index_in(brick, grid.bricks())));
    const VI one = hn::Set(di, 1);
    return {hn::Ne(hn::And(shifted(mask, bit_in(v)), one), hn::Zero(di)), {one, one, one}};
  }
};

// Cubes around voxels, or ahead of them: a byte each.
struct CubesLook {
  static constexpr bool kSingle = false;
  const VoxelBytes& bytes;

  explicit CubesLook(const VoxelTarget& target) : bytes(target.cubes->distances()) {}
  HWY_INLINE Seen operator()(const VI (&v)[3], const VI (&)[3], const VI (&)[3], MI alive) const {
    const VI index = hn::IfThenElseZero(alive, index_in(v, bytes.size()));
    const VI distance = gather_bytes(bytes.data(), index);
    return {hn::Eq(distance, hn::Zero(di)), {distance, distance, distance}};
  }
};

struct OctantsLook {
  static constexpr bool kSingle = false;
  const VoxelBytes& bytes;
  ivec3 size;

  explicit OctantsLook(const VoxelTarget& target) : bytes(target.octants->sides()), size(target.grid->size()) {}
  HWY_INLINE Seen operator()(const VI (&v)[3], const VI (&)[3], const VI (&down)[3], MI alive) const {
    const VI octant = hn::Or(hn::And(down[0], hn::Set(di, 1)),
                             hn::Or(hn::And(down[1], hn::Set(di, 2)), hn::And(down[2], hn::Set(di, 4))));
    const VI z = hn::Add(v[2], product(octant, hn::Set(di, size.z)));
    const VI index = hn::IfThenElseZero(alive, index_in({v[0], v[1], z}, size));
    const VI side = gather_bytes(bytes.data(), index);
    return {hn::Eq(side, hn::Zero(di)), {side, side, side}};
  }
};

// Blocks of 2^level voxels, as in voxel_bricks.cpp.
struct BricksLook {
  static constexpr bool kSingle = false;
  const VoxelGrid& grid;
  const BrickMasks& bricks;

  explicit BricksLook(const VoxelTarget& target) : grid(*target.grid), bricks(*target.bricks) {}
  static HWY_INLINE MI pair_empty(VI mask, VI bit) {
    const VI pair = shifted(mask, hn::And(bit, hn::Set(di, kEven)));
    return hn::Eq(hn::And(pair, hn::Set(di, static_cast<std::int64_t>(kPair))), hn::Zero(di));
  }
  HWY_INLINE Seen operator()(const VI (&v)[3], const VI (&at)[3], const VI (&down)[3], MI alive) const {
    const VI zero = hn::Zero(di), one = hn::Set(di, 1);
    const VI octant = hn::Or(hn::And(down[0], hn::Set(di, 64)),
                             hn::Or(hn::And(down[1], hn::Set(di, 128)), hn::And(down[2], hn::Set(di, 256))));
    const VI brick[3] = {hn::ShiftRight<2>(v[0]), hn::ShiftRight<2>(v[1]), hn::ShiftRight<2>(v[2])};
    const VI bit = bit_in(v);
    const VI mask = hn::And(gather_words(grid.masks().data(), hn::IfThenElseZero(alive, index_in(brick, grid.bricks()))),
                            gather_words(kAhead[0].data(), hn::Or(octant, bit)));
    const MI solid = hn::Ne(hn::And(shifted(mask, bit), one), zero);
    VI last = hn::IfThenElseZero(pair_empty(mask, bit), one);  // side of the block - 1
    const MI clear = hn::And(alive, hn::Eq(mask, zero));
    if (!hn::AllFalse(di, clear)) {
      const VI sector[3] = {hn::ShiftRight<2>(brick[0]), hn::ShiftRight<2>(brick[1]), hn::ShiftRight<2>(brick[2])};
      const VI brick_bit = bit_in(brick), own = hn::BitCast(di, hn::Shl(hn::BitCast(du, one), hn::BitCast(du, brick_bit)));
      const VI bricks_of =
          hn::And(gather_words(bricks.masks().data(), hn::IfThenElseZero(clear, index_in(sector, bricks.sectors()))),
                  gather_words(kAhead[0].data(), hn::Or(octant, brick_bit)));
      const VI small = hn::IfThenElse(pair_empty(bricks_of, brick_bit), hn::Set(di, 7), hn::Set(di, 3));
      const MI all = hn::Eq(hn::AndNot(own, bricks_of), zero);
      last = hn::IfThenElse(clear, hn::IfThenElse(all, hn::Set(di, 15), small), last);
    }
    // From a voxel, counted in the ray's way, to the end of its block.
    const VI side = hn::Add(last, one);
    return {solid,
            {hn::Sub(side, hn::And(at[0], last)), hn::Sub(side, hn::And(at[1], last)),
             hn::Sub(side, hn::And(at[2], last))}};
  }
};

// The rays of a packet on their way through one box.
struct Walk {
  using Numbers = VoxelPacket::Lanes<std::int64_t>;
  alignas(64) Numbers next[3], at[3], end[3];  // at: mirrored voxel; end: the first one beyond the box
  alignas(64) Numbers axis, entered, alive, solid;
  alignas(64) VoxelPacket::Lanes<double> t;
};

// quantise() of voxel_ray.cpp, the same operations in the same order. Which rays come into the box.
HWY_INLINE MI enter(const VoxelBox& box, const VoxelStand& stand, const VoxelPacket& packet, std::size_t o, MI rays,
                    Walk& walk) {
  const VD zero = hn::Zero(dd), one = hn::Set(dd, 1.0);
  VD from[3], origin[3];
  for (int i = 0; i < 3; ++i) from[i] = hn::Sub(hn::Load(dd, packet.origin[i] + o), hn::Set(dd, stand.origin[i]));
  transform(stand.grid_from_world, from, origin);
  VD t = hn::Load(dd, packet.t_min + o), t_out = hn::Load(dd, packet.t_max + o);
  MD alive = hn::RebindMask(dd, rays);
  VI entered = hn::Set(di, -1);
  MD down[3];
  VD given[3];
  for (int i = 0; i < 3; ++i) {
    const VD low = hn::Set(dd, box.low[i]), high = hn::Set(dd, box.high[i]);
    const VD inverse = hn::Load(dd, packet.inverse[i] + o);
    given[i] = hn::Load(dd, packet.given[i] + o);
    down[i] = hn::Lt(given[i], zero);
    const MD level = hn::Eq(given[i], zero);
    alive = hn::And(alive, hn::Or(hn::Not(level), hn::And(hn::Ge(origin[i], low), hn::Lt(origin[i], high))));
    const VD to_low = hn::Mul(hn::Sub(low, origin[i]), inverse), to_high = hn::Mul(hn::Sub(high, origin[i]), inverse);
    const VD near = hn::IfThenElse(down[i], to_high, to_low), far = hn::IfThenElse(down[i], to_low, to_high);
    const MD later = hn::AndNot(level, hn::Ge(near, t));
    entered = hn::IfThenElse(hn::RebindMask(di, later), hn::Set(di, i), entered);
    t = hn::IfThenElse(hn::And(later, hn::Gt(near, t)), near, t);
    t_out = hn::IfThenElse(hn::AndNot(level, hn::Lt(far, t_out)), far, t_out);
  }
  alive = hn::And(alive, hn::Le(t, t_out));
  if (hn::AllFalse(dd, alive)) return hn::RebindMask(di, alive);
  for (int i = 0; i < 3; ++i) {
    const VD low = hn::Set(dd, box.low[i]), high = hn::Set(dd, box.high[i]);
    VD place = hn::Add(origin[i], hn::Mul(t, given[i]));
    place = hn::IfThenElse(hn::Gt(place, low), place, low);
    place = hn::IfThenElse(hn::Lt(place, high), place, high);
    const MD in_here = hn::RebindMask(dd, hn::Eq(entered, hn::Set(di, i)));
    const VD whole = hn::Trunc(place);
    VD voxel = hn::Sub(whole, hn::IfThenElseZero(hn::And(down[i], hn::Eq(whole, place)), one));
    alive = hn::And(alive, hn::Or(in_here, hn::And(hn::Ge(voxel, low), hn::Lt(voxel, high))));
    place = hn::IfThenElse(in_here, hn::IfThenElse(down[i], high, low), place);
    voxel = hn::IfThenElse(in_here, hn::IfThenElse(down[i], hn::Sub(high, one), low), voxel);
    const VD distance =
        hn::IfThenElse(down[i], hn::Sub(place, voxel), hn::Sub(hn::Add(voxel, one), place));
    const VD places = hn::Add(hn::Mul(distance, hn::Set(dd, static_cast<double>(kVoxelPlaces))), hn::Set(dd, 0.5));
    const VI next = truncated(hn::Min(hn::Max(places, zero), hn::Set(dd, static_cast<double>(kVoxelPlaces))));
    const VI side = hn::Load(di, packet.down[i] + o);
    // A plane that is never reached: at speed 0 any distance above 0 comes last.
    const MI never = hn::Eq(hn::Load(di, packet.speed[i] + o), hn::Zero(di));
    hn::Store(hn::IfThenElse(never, hn::Set(di, 1), next), di, walk.next[i] + o);
    hn::Store(hn::Xor(truncated(voxel), side), di, walk.at[i] + o);
    hn::Store(hn::IfThenElse(hn::RebindMask(di, down[i]), hn::Set(di, -box.low[i]), hn::Set(di, box.high[i])), di,
              walk.end[i] + o);
  }
  hn::Store(hn::Set(di, -1), di, walk.axis + o);
  hn::Store(entered, di, walk.entered + o);
  hn::Store(t, dd, walk.t + o);
  return hn::RebindMask(di, alive);
}

// VoxelWalk::leave(), or step(), of each ray that is not in a solid voxel. Whether any ray is still on its way.
template <class Look>
HWY_INLINE bool advance(const Look& look, VoxelPacket& packet, std::size_t o, Walk& walk) {
  const VI one = hn::Set(di, 1), zero = hn::Zero(di);
  MI alive = hn::MaskFromVec(hn::Load(di, walk.alive + o));
  VI at[3], next[3], speed[3], down[3], voxel[3], end[3];
  for (int i = 0; i < 3; ++i) {
    at[i] = hn::Load(di, walk.at[i] + o), next[i] = hn::Load(di, walk.next[i] + o);
    end[i] = hn::Load(di, walk.end[i] + o);
    speed[i] = hn::Load(di, packet.speed[i] + o), down[i] = hn::Load(di, packet.down[i] + o);
    voxel[i] = hn::Xor(at[i], down[i]);
  }
  const Seen seen = look(voxel, at, down, alive);
  const MI solid = hn::And(alive, seen.solid);
  alive = hn::AndNot(seen.solid, alive);
  hn::Store(hn::Or(hn::Load(di, walk.solid + o), hn::VecFromMask(di, solid)), di, walk.solid + o);
  if (hn::AllFalse(di, alive)) return false;
  hn::Store(hn::Add(hn::Load(di, packet.steps + o), hn::IfThenElseZero(alive, one)), di, packet.steps + o);

  // The first plane that leaves the part.
  VI out[3];
  for (int i = 0; i < 3; ++i) {
    out[i] = next[i];
    if constexpr (!Look::kSingle) {
      const VI planes = lesser(seen.planes[i], hn::Sub(end[i], at[i]));
      out[i] = hn::Add(next[i], hn::ShiftLeft<kPlaceBits>(hn::Sub(planes, one)));
    }
  }
  const MI y_first = hn::Lt(product(out[1], speed[0]), product(out[0], speed[1]));
  VI distance = hn::IfThenElse(y_first, out[1], out[0]), pace = hn::IfThenElse(y_first, speed[1], speed[0]);
  const MI z_first = hn::Lt(product(out[2], pace), product(distance, speed[2]));
  VI axis = hn::IfThenElse(z_first, hn::Set(di, 2), hn::IfThenElseZero(y_first, one));

  VI crossed[3];
  if constexpr (Look::kSingle) {
    for (int i = 0; i < 3; ++i) crossed[i] = hn::IfThenElseZero(hn::Eq(axis, hn::Set(di, i)), one);
  } else {
    distance = hn::IfThenElse(z_first, out[2], distance), pace = hn::IfThenElse(z_first, speed[2], pace);
    VD slowness = hn::Load(dd, packet.slowness[0] + o);
    slowness = hn::IfThenElse(hn::RebindMask(dd, y_first), hn::Load(dd, packet.slowness[1] + o), slowness);
    slowness = hn::IfThenElse(hn::RebindMask(dd, z_first), hn::Load(dd, packet.slowness[2] + o), slowness);
    for (int i = 0; i < 3; ++i) {
      VI ahead = hn::Sub(product(distance, speed[i]), product(next[i], pace));
      if (i > 0) ahead = hn::Add(ahead, hn::VecFromMask(di, hn::Lt(axis, hn::Set(di, i))));
      const VI a = hn::BitCast(di, hn::ShiftRight<kPlaceBits>(hn::BitCast(du, ahead)));
      // The nearest quotient is the one rounded down, or one more.
      const VI quotient = nearest(hn::Mul(as_double(a), slowness)), rest = hn::Sub(a, product(quotient, pace));
      const VI planes = hn::Add(hn::Add(quotient, one), hn::BroadcastSignBit(rest));
      crossed[i] = hn::IfThenZeroElse(hn::Lt(ahead, zero), planes);
    }
  }
  MI inside = alive;
  for (int i = 0; i < 3; ++i) {
    const VI planes = hn::IfThenElseZero(alive, crossed[i]);
    at[i] = hn::Add(at[i], planes);
    hn::Store(at[i], di, walk.at[i] + o);
    hn::Store(hn::Add(next[i], hn::ShiftLeft<kPlaceBits>(planes)), di, walk.next[i] + o);
    inside = hn::And(inside, hn::Lt(at[i], end[i]));
  }
  hn::Store(hn::IfThenElse(alive, axis, hn::Load(di, walk.axis + o)), di, walk.axis + o);
  hn::Store(hn::VecFromMask(di, inside), di, walk.alive + o);
  return !hn::AllFalse(di, inside);
}

// VoxelWalk::hit() of the rays in solid voxels; those that hit.
HWY_INLINE MI finish(VoxelPacket& packet, std::size_t o, const Walk& walk) {
  const MI solid = hn::MaskFromVec(hn::Load(di, walk.solid + o));
  if (hn::AllFalse(di, solid)) return solid;
  const VI axis = hn::Load(di, walk.axis + o);
  VI next = hn::Load(di, walk.next[0] + o), speed = hn::Load(di, packet.speed[0] + o),
     down = hn::Load(di, packet.down[0] + o);
  const VI entered = hn::Load(di, walk.entered + o);
  const MI walked = hn::Not(hn::Lt(axis, hn::Zero(di)));
  const VI by = hn::IfThenElse(walked, axis, entered);
  for (int i = 1; i < 3; ++i) {
    const MI here = hn::Eq(by, hn::Set(di, i));
    next = hn::IfThenElse(here, hn::Load(di, walk.next[i] + o), next);
    speed = hn::IfThenElse(here, hn::Load(di, packet.speed[i] + o), speed);
    down = hn::IfThenElse(here, hn::Load(di, packet.down[i] + o), down);
  }
  const VD t_in = hn::Load(dd, walk.t + o);
  const VI distance = hn::IfThenElseZero(walked, hn::Sub(next, hn::Set(di, kVoxelPlaces)));
  const VD on_the_way = hn::Mul(hn::Div(as_double(distance), as_double(speed)), hn::Load(dd, packet.t_per_s + o));
  const VD t = hn::IfThenElse(hn::RebindMask(dd, walked), hn::Add(t_in, on_the_way), t_in);
  const MI hit = hn::And(solid, hn::RebindMask(di, hn::Not(hn::Gt(t, hn::Load(dd, packet.t_max + o)))));
  hn::Store(t, dd, packet.t + o);
  for (int i = 0; i < 3; ++i)
    hn::Store(hn::Xor(hn::Load(di, walk.at[i] + o), hn::Load(di, packet.down[i] + o)), di, packet.voxel[i] + o);
  const VI face = hn::Sub(hn::Add(by, by), down);
  const VI inside = hn::Set(di, static_cast<std::int64_t>(VoxelFace::inside));
  hn::Store(hn::IfThenElse(hn::Lt(by, hn::Zero(di)), inside, face), di, packet.face + o);
  return hit;
}

template <class Look>
VoxelMeeting march(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet, std::uint64_t rays) {
  const Look look(target);
  VoxelMeeting meeting;
  Walk walk;
  std::size_t on_the_way[kVectors], count = 0;
  for (std::size_t o = 0; o < packet.count; o += N) {
    if ((rays >> o & ((std::uint64_t{1} << N) - 1)) == 0) continue;
    const MI in = enter(target.box, stand, packet, o, lanes_of(rays >> o), walk);
    if (hn::AllFalse(di, in)) continue;
    meeting.met |= bits_of(in) << o;
    hn::Store(hn::VecFromMask(di, in), di, walk.alive + o);
    hn::Store(hn::Zero(di), di, walk.solid + o);
    on_the_way[count++] = o;
  }
  while (count > 0) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t o = on_the_way[i];
      if (advance(look, packet, o, walk)) {
        on_the_way[left++] = o;
      } else {
        meeting.hit |= bits_of(finish(packet, o, walk)) << o;
      }
    }
    count = left;
  }
  return meeting;
}

// VoxelDirection of each ray.
void aim(VoxelPacket& packet, const glm::dmat3& grid_from_world) {
  for (std::size_t o = 0; o < packet.count; o += N) {
    VD world[3], given[3], size[3];
    for (int i = 0; i < 3; ++i) world[i] = hn::Load(dd, packet.direction[i] + o);
    transform(grid_from_world, world, given);
    for (int i = 0; i < 3; ++i) size[i] = hn::Abs(given[i]);
    const VD longest = hn::Max(hn::Max(size[0], size[1]), size[2]);
    for (int i = 0; i < 3; ++i) {
      const VD share = hn::Mul(hn::Div(size[i], longest), hn::Set(dd, static_cast<double>(1 << kDirectionBits)));
      const VI speed = truncated(hn::Add(share, hn::Set(dd, 0.5)));
      hn::Store(given[i], dd, packet.given[i] + o);
      hn::Store(hn::Div(hn::Set(dd, 1.0), given[i]), dd, packet.inverse[i] + o);
      hn::Store(speed, di, packet.speed[i] + o);
      hn::Store(hn::Div(hn::Set(dd, 1.0), as_double(speed)), dd, packet.slowness[i] + o);
      hn::Store(hn::VecFromMask(di, hn::RebindMask(di, hn::Lt(given[i], hn::Zero(dd)))), di, packet.down[i] + o);
    }
    const VD per_s = hn::Set(dd, static_cast<double>(1 << (kDirectionBits - kPlaceBits)));
    hn::Store(hn::Div(per_s, longest), dd, packet.t_per_s + o);
  }
}

VoxelMeeting march_planes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet, std::uint64_t rays) {
  return march<PlanesLook>(target, stand, packet, rays);
}
VoxelMeeting march_cubes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet, std::uint64_t rays) {
  return march<CubesLook>(target, stand, packet, rays);
}
VoxelMeeting march_octants(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                           std::uint64_t rays) {
  return march<OctantsLook>(target, stand, packet, rays);
}
VoxelMeeting march_bricks(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet, std::uint64_t rays) {
  return march<BricksLook>(target, stand, packet, rays);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(aim);
HWY_EXPORT(march_planes);
HWY_EXPORT(march_cubes);
HWY_EXPORT(march_octants);
HWY_EXPORT(march_bricks);

}  // namespace

void aim_voxel_packet(VoxelPacket& packet, const glm::dmat3& grid_from_world) {
  HWY_DYNAMIC_DISPATCH(aim)(packet, grid_from_world);
}

VoxelMeeting march_packet_voxel_planes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                       std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_planes)(target, stand, packet, rays);
}
VoxelMeeting march_packet_voxel_cubes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                      std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_cubes)(target, stand, packet, rays);
}
VoxelMeeting march_packet_voxel_octants(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                        std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_octants)(target, stand, packet, rays);
}
VoxelMeeting march_packet_voxel_bricks(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                       std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_bricks)(target, stand, packet, rays);
}

}  // namespace scarp
#endif
