// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "scarp/march/usual_ray.h"
#include "scarp/march/voxel/voxel_packet.h"

// Compiled once per instruction set. Vectors whose length is unknown at compile time cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/march/voxel/voxel_packet_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/march/ray_numbers_simd.h"
#include "scarp/march/voxel/voxel_lookups_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t kVectors = VoxelPacket::kRays / N;
constexpr std::size_t kSaved = 4;  // vectors: below that, compaction costs more than it saves
// 2^52 as a double: its last bits count units.
constexpr double kOnes = 0x1p52;

// A distance times a speed, in boxes with a side above 2,048: 34 by 29 bits.
HWY_INLINE VI wide_product(VI distance, VI speed) {
  const VI upper = hn::BitCast(di, hn::ShiftRight<32>(hn::BitCast(du, distance)));
  return hn::Add(product(distance, speed), hn::ShiftLeft<32>(product(upper, speed)));
}
template <class Lookup>
HWY_INLINE VI times(VI distance, VI speed) {
  if constexpr (Lookup::kWide) return wide_product(distance, speed);
  return product(distance, speed);
}
// 0 <= a < 2^52.
HWY_INLINE VD as_double(VI a) {
  const VI ones = hn::BitCast(di, hn::Set(dd, kOnes));
  return hn::Sub(hn::BitCast(dd, hn::Or(a, ones)), hn::Set(dd, kOnes));
}
// The nearest integer, 0 <= a < 2^51.
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

// grid_from_world * v, in GLM's order of operations.
HWY_INLINE void transform(const glm::dmat3& m, const VD (&v)[3], VD (&to)[3]) {
  for (int i = 0; i < 3; ++i) {
    to[i] = hn::Add(hn::Add(hn::Mul(hn::Set(dd, m[0][i]), v[0]), hn::Mul(hn::Set(dd, m[1][i]), v[1])),
                    hn::Mul(hn::Set(dd, m[2][i]), v[2]));
  }
}

// Rays in one box, in lanes; each compaction removes finished ones.
struct LaneWalk {
  using Numbers = VoxelPacket::Lanes<std::int64_t>;
  // at: the voxel, mirrored along negative directions; end: the first one beyond the box.
  alignas(64) Numbers next[3], at[3], end[3], speed[3], down[3];
  // crossed: the axis of the last plane crossed; before the first step, kEntered and the axis of entry.
  alignas(64) Numbers crossed, ray;
  // For lookups that descend: bits of the voxel that the last step changed, on any axis; at first all.
  alignas(64) Numbers moved;
  // 1 / speed or, for lookups that travel, the travel per voxel in [0], see voxel_travel.h.
  alignas(64) VoxelPacket::Lanes<double> slowness[3];
  VoxelTies ties;                      // of the grid
  std::size_t lanes = 0;               // in use
  std::uint64_t alive[kVectors] = {};  // lanes of each vector
  std::uint64_t solid[kVectors] = {};  // at a solid voxel, waiting to be reported: many cost as much as one

  static constexpr std::int64_t kEntered = 8, kInside = 7, kAllMoved = 0x7fff'ffff;
};

// Set lanes of a vector, in order; hn::Compress() of Highway 1.0.3 copies its table to the stack each time.
constexpr auto make_orders() {
  std::array<std::array<std::int64_t, N>, std::size_t{1} << N> orders{};
  for (std::size_t bits = 0; bits < orders.size(); ++bits) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < N; ++i) {
      if (bits >> i & 1) orders[bits][count++] = static_cast<std::int64_t>(i);
    }
  }
  return orders;
}
alignas(64) constexpr auto kOrders = make_orders();

// Writes selected lanes of one vector after another.
class Chosen {
 public:
  explicit HWY_INLINE Chosen(std::uint64_t bits) : order_(hn::SetTableIndices(di, kOrders[bits].data())) {}
  HWY_INLINE void append(VI lanes, std::int64_t* to) const { hn::StoreU(hn::TableLookupLanes(lanes, order_), di, to); }
  HWY_INLINE void append(VD lanes, double* to) const {
    append(hn::BitCast(di, lanes), reinterpret_cast<std::int64_t*>(to));
  }

 private:
  decltype(hn::SetTableIndices(di, kOrders[0].data())) order_;
};

// 1 / speed, to a relative 2^-23: enough to separate quotients of up to 16,384 by less than a half, and faster than in
// double.
HWY_INLINE VD slowness_of(VI speed) {
  const auto single = hn::DemoteTo(df_part, as_double(speed));
  return hn::PromoteTo(dd, hn::Div(hn::Set(df_part, 1.0f), single));
}

// Uses the same operations as voxel_travel.h.
HWY_INLINE VD travel_per_voxel(const VI (&speed)[3]) {
  VD square = hn::Zero(dd);
  for (int i = 0; i < 3; ++i) square = hn::Add(square, hn::Mul(as_double(speed[i]), as_double(speed[i])));
  const VD length = hn::Add(hn::Trunc(hn::Sqrt(square)), hn::Set(dd, 2.0));
  // No quotient is close enough to an integer to be rounded to it.
  return hn::Trunc(hn::Div(hn::Set(dd, 0x1p48), length));
}

// Lanes whose entered axis other than `axis` is crossed before it (`first`) or after it.
HWY_INLINE MI entered_by(VI entered, VoxelTies ties, int axis, bool first) {
  MI any = hn::MaskFromVec(hn::Zero(di));
  for (int i = 0; i < 3; ++i) {
    if (i != axis && ties.before(i, axis) == first)
      any = hn::Or(any, hn::Eq(entered, hn::Set(di, LaneWalk::kEntered + i)));
  }
  return any;
}

// is_exact() of voxel_ray.cpp.
HWY_INLINE MI exact_paths(const VoxelPacket& packet, std::size_t o, const VD (&origin)[3], const VD (&given)[3]) {
  const VD t_min = hn::Load(dd, packet.t_min + o);
  MD exact = hn::RebindMask(dd, hn::Lt(hn::Load(di, packet.exact + o), hn::Zero(di)));
  if (hn::AllFalse(dd, exact)) return hn::RebindMask(di, exact);
  for (int i = 0; i < 3; ++i) {
    const VD parts = hn::Mul(hn::Add(origin[i], hn::Mul(t_min, given[i])), hn::Set(dd, kExactStart));
    const MD whole = hn::And(hn::Eq(hn::Trunc(parts), parts), hn::Lt(hn::Abs(parts), hn::Set(dd, kOnes)));
    exact = hn::And(exact, hn::Or(whole, hn::Eq(given[i], hn::Zero(dd))));
  }
  return hn::RebindMask(di, exact);
}

// As in quantise(): rays step back to the voxels before planes that are not crossed yet.
HWY_INLINE void touch_behind(const VoxelBox& box, VoxelTies ties, const VoxelPacket& packet, std::size_t o, VD t,
                             VI entered, const MD (&down)[3], const VD (&origin)[3], const VD (&given)[3],
                             const VD (&distance)[3], VD (&voxel)[3], VI (&next)[3], VI (&speed)[3]) {
  const VD one = hn::Set(dd, 1.0);
  const MI exact = exact_paths(packet, o, origin, given);
  MI comes_in = hn::RebindMask(di, hn::Gt(t, hn::Load(dd, packet.t_min + o)));
  comes_in = hn::AndNot(hn::Eq(entered, hn::Set(di, LaneWalk::kInside)), comes_in);
  for (int i = 0; i < 3; ++i) {
    const MI on_plane = hn::And(exact, hn::RebindMask(di, hn::Eq(distance[i], one)));
    const MI crossed = hn::AndNot(entered_by(entered, ties, i, true), on_plane);
    const VD first = hn::IfThenElse(down[i], hn::Set(dd, box.high[i] - 1.0), hn::Set(dd, box.low[i]));
    MI back = hn::And(comes_in, hn::Gt(next[i], hn::Set(di, kVoxelPlaces - kTouch - 1)));
    back = hn::AndNot(hn::Or(crossed, hn::Eq(entered, hn::Set(di, LaneWalk::kEntered + i))), back);
    back = hn::AndNot(hn::RebindMask(di, hn::Eq(given[i], hn::Zero(dd))), back);
    back = hn::AndNot(hn::RebindMask(di, hn::Eq(voxel[i], first)), back);
    const VD step = hn::IfThenElse(down[i], one, hn::Neg(one));
    voxel[i] = hn::Add(voxel[i], hn::IfThenElseZero(hn::RebindMask(dd, back), step));
    next[i] = hn::IfThenZeroElse(back, next[i]);
    // The ray crosses this plane at once, and never another one.
    speed[i] = hn::IfThenElse(hn::And(back, hn::Eq(speed[i], hn::Zero(di))), hn::Set(di, 1), speed[i]);
    // A plane by which a ray leaves the box at once is crossed after others at the same position.
    const VD last = hn::IfThenElse(down[i], hn::Set(dd, box.low[i]), hn::Set(dd, box.high[i] - 1.0));
    MI leaves = hn::And(comes_in, hn::And(hn::Eq(next[i], hn::Zero(di)), hn::RebindMask(di, hn::Eq(voxel[i], last))));
    leaves = hn::AndNot(hn::Or(exact, hn::Lt(speed[i], hn::Set(di, kSlow))), leaves);
    next[i] = hn::IfThenElse(leaves, hn::Set(di, 1), next[i]);
  }
}

// quantise() of voxel_ray.cpp, the same operations in the same order. Starts rays that enter the box, and returns them.
template <class Lookup>
HWY_INLINE MI enter(const VoxelBox& box, const VoxelStand& stand, VoxelPacket& packet, std::size_t o, MI rays,
                    LaneWalk& walk) {
  const VD zero = hn::Zero(dd), one = hn::Set(dd, 1.0);
  const VoxelTies ties = stand.ties;
  VD from[3], origin[3];
  for (int i = 0; i < 3; ++i) from[i] = hn::Sub(hn::Load(dd, packet.origin[i] + o), hn::Set(dd, stand.origin[i]));
  transform(stand.grid_from_world, from, origin);
  VD t = hn::Load(dd, packet.t_min + o), t_out = hn::Load(dd, packet.t_max + o);
  MD alive = hn::And(hn::RebindMask(dd, rays), hn::Lt(hn::Load(dd, packet.t_per_s + o), hn::Inf(dd)));
  const VD late = hn::Set(dd, std::max(stand.room, static_cast<double>(kTouch) / static_cast<double>(kVoxelPlaces)));
  VI entered = hn::Set(di, LaneWalk::kInside);
  MD down[3];
  VD given[3];
  for (int i = 0; i < 3; ++i) {
    const VD low = hn::Set(dd, box.low[i]), high = hn::Set(dd, box.high[i]);
    const VD inverse = hn::Load(dd, packet.inverse[i] + o);
    given[i] = hn::Load(dd, packet.given[i] + o);
    down[i] = hn::Lt(given[i], zero);
    const MD level = hn::Eq(given[i], zero);
    VD first;
    if (packet.slow) {
      down[i] = hn::RebindMask(dd, hn::Lt(hn::Load(di, packet.down[i] + o), hn::Zero(di)));
      const VD plane = hn::Floor(hn::Add(origin[i], hn::Set(dd, 0.5))), room = hn::Set(dd, stand.room);
      const VD border = ties.up(i) > 0 ? low : high;
      const VD near_plane = hn::IfThenElse(hn::Eq(plane, border), hn::Add(room, room), room);
      const MD on_plane = hn::And(level, hn::Le(hn::Abs(hn::Sub(origin[i], plane)), near_plane));
      origin[i] = hn::IfThenElse(on_plane, plane, origin[i]);
      // A level ray belongs to the voxel's upper side.
      const MD between = ties.up(i) > 0 ? hn::And(hn::Ge(origin[i], low), hn::Lt(origin[i], high))
                                        : hn::And(hn::Gt(origin[i], low), hn::Le(origin[i], high));
      alive = hn::And(alive, hn::Or(hn::Not(level), between));
      const MD slow = hn::RebindMask(dd, hn::Lt(hn::Load(di, packet.speed[i] + o), hn::Set(di, kSlow)));
      const VD early = hn::IfThenElseZero(slow, room);
      first = hn::IfThenElse(down[i], hn::Add(high, early), hn::Sub(low, early));
    } else {
      first = hn::IfThenElse(down[i], high, low);
    }
    const VD near = hn::Mul(hn::Sub(first, origin[i]), inverse);
    const VD last = hn::IfThenElse(down[i], hn::Sub(low, late), hn::Add(high, late));
    const VD far = hn::Mul(hn::Sub(last, origin[i]), inverse);
    const MD later = hn::AndNot(level, hn::Ge(near, t));
    MI enters = hn::RebindMask(di, later);
    // If planes are crossed at the same t, the last one counts: in the order x, y, z the current one.
    if (ties.bits >> 3 != 0) {
      enters = hn::AndNot(hn::And(hn::RebindMask(di, hn::Not(hn::Gt(near, t))), entered_by(entered, ties, i, false)),
                          enters);
    }
    entered = hn::IfThenElse(enters, hn::Set(di, LaneWalk::kEntered + i), entered);
    t = hn::IfThenElse(hn::And(later, hn::Gt(near, t)), near, t);
    t_out = hn::IfThenElse(hn::AndNot(level, hn::Lt(far, t_out)), far, t_out);
  }
  alive = hn::And(alive, hn::Le(t, t_out));
  if (hn::AllFalse(dd, alive)) return hn::RebindMask(di, alive);
  VD voxel[3], distance[3];
  VI next[3], speed[3];
  MI touched = hn::MaskFromVec(hn::Zero(di));
  for (int i = 0; i < 3; ++i) {
    const VD low = hn::Set(dd, box.low[i]), high = hn::Set(dd, box.high[i]);
    speed[i] = hn::Load(di, packet.speed[i] + o);
    VD place = hn::Add(origin[i], hn::Mul(t, given[i]));
    place = hn::IfThenElse(hn::Gt(place, low), place, low);
    place = hn::IfThenElse(hn::Lt(place, high), place, high);
    const MI in_here = hn::Eq(entered, hn::Set(di, LaneWalk::kEntered + i));
    const MD by_this = hn::RebindMask(dd, in_here);
    const VD whole = hn::Trunc(place);
    voxel[i] = hn::Sub(whole, hn::IfThenElseZero(hn::And(down[i], hn::Eq(whole, place)), one));
    place = hn::IfThenElse(by_this, hn::IfThenElse(down[i], high, low), place);
    voxel[i] = hn::IfThenElse(by_this, hn::IfThenElse(down[i], hn::Sub(high, one), low), voxel[i]);
    distance[i] = hn::IfThenElse(down[i], hn::Sub(place, voxel[i]), hn::Sub(hn::Add(voxel[i], one), place));
    const VD units = hn::Mul(distance[i], hn::Set(dd, static_cast<double>(kVoxelPlaces)));
    VD places = hn::Add(units, hn::Set(dd, 0.5));
    if (packet.slow) {
      const MI slow = hn::Lt(speed[i], hn::Set(di, kSlow));
      places = hn::IfThenElse(hn::RebindMask(dd, slow), hn::Ceil(units), places);
    }
    next[i] = truncated(hn::Min(hn::Max(places, zero), hn::Set(dd, static_cast<double>(kVoxelPlaces))));
    touched = hn::Or(touched, hn::Or(hn::Eq(next[i], hn::Zero(di)),
                                     hn::AndNot(in_here, hn::Gt(next[i], hn::Set(di, kVoxelPlaces - kTouch - 1)))));
  }
  // Rays that miss the box are on its sides here.
  touched = hn::And(touched, hn::RebindMask(di, alive));
  if (!hn::AllFalse(di, touched))
    touch_behind(box, stand.ties, packet, o, t, entered, down, origin, given, distance, voxel, next, speed);
  for (int i = 0; i < 3; ++i) {
    // On the border and leaving.
    alive =
        hn::And(alive, hn::And(hn::Ge(voxel[i], hn::Set(dd, box.low[i])), hn::Lt(voxel[i], hn::Set(dd, box.high[i]))));
  }
  const MI in = hn::RebindMask(di, alive);
  const Chosen chosen(bits_of(in));
  const std::size_t to = walk.lanes;
  for (int i = 0; i < 3; ++i) {
    const VI side = hn::Load(di, packet.down[i] + o);
    // A plane that is never reached: at speed 0 any distance above 0 comes last.
    const MI never = hn::Eq(speed[i], hn::Zero(di));
    const VI end = hn::IfThenElse(hn::RebindMask(di, down[i]), hn::Set(di, -box.low[i]), hn::Set(di, box.high[i]));
    chosen.append(hn::IfThenElse(never, hn::Set(di, 1), next[i]), walk.next[i] + to);
    chosen.append(hn::Xor(truncated(voxel[i]), side), walk.at[i] + to);
    chosen.append(end, walk.end[i] + to);
    chosen.append(speed[i], walk.speed[i] + to);
    chosen.append(side, walk.down[i] + to);
    if constexpr (!Lookup::kSingle) chosen.append(slowness_of(speed[i]), walk.slowness[i] + to);
  }
  if constexpr (Lookup::kTravels) chosen.append(travel_per_voxel(speed), walk.slowness[0] + to);
  chosen.append(entered, walk.crossed + to);
  chosen.append(hn::Iota(di, static_cast<std::int64_t>(o)), walk.ray + to);
  if constexpr (Lookup::kDescends) chosen.append(hn::Set(di, LaneWalk::kAllMoved), walk.moved + to);
  walk.lanes += hn::CountTrue(di, in);
  hn::Store(t, dd, packet.t_in + o);
  return in;
}

// VoxelWalk::hit() of rays in solid voxels.
HWY_INLINE void finish(VoxelPacket& packet, const LaneWalk& walk, std::size_t o, MI solid) {
  const VI crossed = hn::Load(di, walk.crossed + o), ray = hn::Load(di, walk.ray + o);
  VI next = hn::Load(di, walk.next[0] + o), speed = hn::Load(di, walk.speed[0] + o);
  VI down = hn::Load(di, walk.down[0] + o);
  const MI walked = hn::Lt(crossed, hn::Set(di, 3));
  const VI axis = hn::And(crossed, hn::Set(di, 3));
  for (int i = 1; i < 3; ++i) {
    const MI here = hn::Eq(axis, hn::Set(di, i));
    next = hn::IfThenElse(here, hn::Load(di, walk.next[i] + o), next);
    speed = hn::IfThenElse(here, hn::Load(di, walk.speed[i] + o), speed);
    down = hn::IfThenElse(here, hn::Load(di, walk.down[i] + o), down);
  }
  const VI safe = hn::IfThenElseZero(solid, ray);
  const VD t_in = hn::GatherIndex(dd, packet.t_in, safe), t_max = hn::GatherIndex(dd, packet.t_max, safe);
  const VI distance = hn::IfThenElseZero(walked, hn::Sub(next, hn::Set(di, kVoxelPlaces)));
  const VD on_the_way =
      hn::Mul(hn::Div(as_double(distance), as_double(speed)), hn::GatherIndex(dd, packet.t_per_s, safe));
  const VD t = hn::IfThenElse(hn::RebindMask(dd, walked), hn::Add(t_in, on_the_way), t_in);
  const MI hit = hn::And(solid, hn::RebindMask(di, hn::Not(hn::Gt(t, t_max))));
  const VI inside = hn::Set(di, static_cast<std::int64_t>(VoxelFace::inside));
  const VI face =
      hn::IfThenElse(hn::Eq(crossed, hn::Set(di, LaneWalk::kInside)), inside, hn::Sub(hn::Add(axis, axis), down));
  const Chosen chosen(bits_of(hit));
  const std::size_t to = packet.hits;
  chosen.append(t, packet.t + to);
  chosen.append(face, packet.face + to);
  chosen.append(ray, packet.ray + to);
  for (int i = 0; i < 3; ++i)
    chosen.append(hn::Xor(hn::Load(di, walk.at[i] + o), hn::Load(di, walk.down[i] + o)), packet.voxel[i] + to);
  packet.hits += hn::CountTrue(di, hit);
}

HWY_NOINLINE void finish_all(VoxelPacket& packet, LaneWalk& walk) {
  for (std::size_t o = 0; o < walk.lanes; o += N) {
    if (walk.solid[o / N] != 0) finish(packet, walk, o, lanes_of(walk.solid[o / N]));
    walk.solid[o / N] = 0;
  }
}

template <class Lookup>
HWY_INLINE LookupResult look_at(const Lookup& look, const VI (&voxel)[3], const VI (&at)[3], const VI (&down)[3],
                                MI alive, const LaneWalk& walk, std::size_t o) {
  if constexpr (Lookup::kDescends) {
    return look(voxel, at, down, alive, hn::Load(di, walk.moved + o));
  } else {
    return look(voxel, at, down, alive);
  }
}

// VoxelWalk::leave(), or step(), of each ray that is not in a solid voxel; returns those still in the box. The others
// do not change. kOrdered: ties are crossed in the order x, y, z of the grid.
template <class Lookup, bool kOrdered>
HWY_INLINE MI advance(const Lookup& look, VoxelPacket& packet, LaneWalk& walk, std::size_t o, MI alive) {
  const VI one = hn::Set(di, 1), zero = hn::Zero(di);
  VI at[3], next[3], speed[3], down[3], voxel[3], end[3];
  for (int i = 0; i < 3; ++i) {
    at[i] = hn::Load(di, walk.at[i] + o), next[i] = hn::Load(di, walk.next[i] + o);
    end[i] = hn::Load(di, walk.end[i] + o);
    speed[i] = hn::Load(di, walk.speed[i] + o), down[i] = hn::Load(di, walk.down[i] + o);
    voxel[i] = hn::Xor(at[i], down[i]);
  }
  const LookupResult seen = look_at(look, voxel, at, down, alive, walk, o);
  const MI solid = hn::And(alive, seen.solid);
  if (!hn::AllFalse(di, solid)) {
    walk.solid[o / N] |= bits_of(solid);
    alive = hn::AndNot(seen.solid, alive);
    if (hn::AllFalse(di, alive)) return alive;
  }
  packet.steps += hn::CountTrue(di, alive);

  // The first plane that leaves the part; with ties in another order than x, y, z, a plane that comes earlier there
  // wins as if it were nearer by one unit of the products.
  [[maybe_unused]] const VoxelTies ties = walk.ties;
  VI out[3];
  for (int i = 0; i < 3; ++i) {
    out[i] = next[i];
    if constexpr (!Lookup::kSingle) {
      const VI planes = lesser(seen.planes[i], hn::Sub(end[i], at[i]));
      out[i] = hn::Add(next[i], hn::ShiftLeft<kPlaceBits>(hn::Sub(planes, one)));
    }
  }
  VI of_x = times<Lookup>(out[0], speed[1]);
  if constexpr (!kOrdered) of_x = hn::Add(of_x, hn::Set(di, ties.bits >> 3 & 1));
  const MI y_first = hn::Lt(times<Lookup>(out[1], speed[0]), of_x);
  VI distance = hn::IfThenElse(y_first, out[1], out[0]), pace = hn::IfThenElse(y_first, speed[1], speed[0]);
  VI of_xy = times<Lookup>(distance, speed[2]);
  if constexpr (!kOrdered)
    of_xy = hn::Add(of_xy, hn::IfThenElse(y_first, hn::Set(di, ties.bits >> 5 & 1), hn::Set(di, ties.bits >> 4 & 1)));
  const MI z_first = hn::Lt(times<Lookup>(out[2], pace), of_xy);
  const VI axis = hn::IfThenElse(z_first, hn::Set(di, 2), hn::IfThenElseZero(y_first, one));

  VI crossed[3];
  if constexpr (Lookup::kSingle) {
    for (int i = 0; i < 3; ++i) crossed[i] = hn::IfThenElseZero(hn::Eq(axis, hn::Set(di, i)), one);
    if constexpr (Lookup::kTravels) {
      distance = hn::IfThenElse(z_first, out[2], distance), pace = hn::IfThenElse(z_first, speed[2], pace);
      MI travels = hn::And(alive, hn::Gt(seen.planes[0], zero));
      for (int i = 0; i < 3; ++i) travels = hn::And(travels, hn::Lt(hn::Add(at[i], crossed[i]), end[i]));
      // VoxelWalk::step_and_travel(): s in 2^-28, rounded down. The nearest quotient may be one more.
      const VI dividend = hn::ShiftLeft<kDirectionBits>(distance);
      const VI quotient =
          truncated(hn::Div(hn::Mul(as_double(distance), hn::Set(dd, static_cast<double>(1 << kDirectionBits))),
                            as_double(hn::IfThenElse(travels, pace, one))));
      const VI from = hn::Add(quotient, hn::BroadcastSignBit(hn::Sub(dividend, product(quotient, pace))));
      const VI travel = truncated(hn::Load(dd, walk.slowness[0] + o));
      const VI until = hn::Add(from, product(seen.planes[0], travel));
      for (int i = 0; i < 3; ++i) {
        const VI plane = hn::Add(next[i], hn::ShiftLeft<kPlaceBits>(crossed[i]));
        const VI ahead = hn::Sub(hn::Sub(product(until, speed[i]), hn::ShiftLeft<kDirectionBits>(plane)), one);
        const VI planes =
            hn::Add(hn::BitCast(di, hn::ShiftRight<kDirectionBits + kPlaceBits>(hn::BitCast(du, ahead))), one);
        crossed[i] = hn::Add(crossed[i], hn::IfThenElseZero(hn::AndNot(hn::Lt(ahead, zero), travels), planes));
      }
    }
  } else {
    distance = hn::IfThenElse(z_first, out[2], distance), pace = hn::IfThenElse(z_first, speed[2], pace);
    VD slowness = hn::Load(dd, walk.slowness[0] + o);
    slowness = hn::IfThenElse(hn::RebindMask(dd, y_first), hn::Load(dd, walk.slowness[1] + o), slowness);
    slowness = hn::IfThenElse(hn::RebindMask(dd, z_first), hn::Load(dd, walk.slowness[2] + o), slowness);
    for (int i = 0; i < 3; ++i) {
      VI ahead = hn::Sub(times<Lookup>(distance, speed[i]), times<Lookup>(next[i], pace));
      // Planes at the same s that come after the last one.
      if constexpr (kOrdered) {
        if (i > 0) ahead = hn::IfThenElse(hn::Lt(axis, hn::Set(di, i)), hn::Sub(ahead, one), ahead);
      } else {
        for (int k = 0; k < 3; ++k) {
          if (k != i && ties.before(k, i))
            ahead = hn::IfThenElse(hn::Eq(axis, hn::Set(di, k)), hn::Sub(ahead, one), ahead);
        }
      }
      const VI a = hn::BitCast(di, hn::ShiftRight<kPlaceBits>(hn::BitCast(du, ahead)));
      // The nearest quotient is the one rounded down, or one more.
      const VI quotient = nearest(hn::Mul(as_double(a), slowness)), rest = hn::Sub(a, product(quotient, pace));
      const VI planes = hn::Add(hn::Add(quotient, one), hn::BroadcastSignBit(rest));
      crossed[i] = hn::IfThenZeroElse(hn::Lt(ahead, zero), planes);
    }
  }
  MI inside = alive;
  VI moved = zero;
  for (int i = 0; i < 3; ++i) {
    crossed[i] = hn::IfThenElseZero(alive, crossed[i]);
    const VI from = at[i];
    at[i] = hn::Add(at[i], crossed[i]);
    if constexpr (Lookup::kDescends) moved = hn::Or(moved, hn::Xor(at[i], from));
    hn::Store(at[i], di, walk.at[i] + o);
    hn::Store(hn::Add(next[i], hn::ShiftLeft<kPlaceBits>(crossed[i])), di, walk.next[i] + o);
    inside = hn::And(inside, hn::Lt(at[i], end[i]));
  }
  if constexpr (Lookup::kDescends) hn::Store(moved, di, walk.moved + o);
  hn::Store(hn::IfThenElse(alive, axis, hn::Load(di, walk.crossed + o)), di, walk.crossed + o);
  return inside;
}

// Moves the rays that are still in the box together.
HWY_NOINLINE void compact(LaneWalk& walk) {
  std::size_t to = 0;
  for (std::size_t o = 0; o < walk.lanes; o += N) {
    const std::uint64_t bits = walk.alive[o / N];
    if (bits == 0) continue;
    const Chosen chosen(bits);
    for (int i = 0; i < 3; ++i) {
      chosen.append(hn::Load(di, walk.next[i] + o), walk.next[i] + to);
      chosen.append(hn::Load(di, walk.at[i] + o), walk.at[i] + to);
      chosen.append(hn::Load(di, walk.end[i] + o), walk.end[i] + to);
      chosen.append(hn::Load(di, walk.speed[i] + o), walk.speed[i] + to);
      chosen.append(hn::Load(di, walk.down[i] + o), walk.down[i] + to);
      chosen.append(hn::Load(dd, walk.slowness[i] + o), walk.slowness[i] + to);
    }
    chosen.append(hn::Load(di, walk.crossed + o), walk.crossed + to);
    chosen.append(hn::Load(di, walk.ray + o), walk.ray + to);
    chosen.append(hn::Load(di, walk.moved + o), walk.moved + to);
    to += hn::CountTrue(di, lanes_of(bits));
  }
  walk.lanes = to;
}

// Marks the first lanes as in use.
HWY_INLINE void wake(LaneWalk& walk) {
  for (std::size_t o = 0; o < walk.lanes; o += N) {
    const std::size_t here = walk.lanes - o < N ? walk.lanes - o : N;
    walk.alive[o / N] = (std::uint64_t{1} << here) - 1;
  }
}

template <class Lookup, bool kOrdered>
std::uint64_t march_with_ties(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                              std::uint64_t rays) {
  const Lookup look(target);
  std::uint64_t met = 0;
  LaneWalk walk;
  walk.ties = stand.ties;
  packet.hits = 0;
  for (std::size_t o = 0; o < packet.count; o += N) {
    if ((rays >> o & ((std::uint64_t{1} << N) - 1)) == 0) continue;
    met |= bits_of(enter<Lookup>(target.box, stand, packet, o, lanes_of(rays >> o), walk)) << o;
  }
  wake(walk);
  for (std::size_t live = walk.lanes; live > 0;) {
    live = 0;
    for (std::size_t o = 0; o < walk.lanes; o += N) {
      std::uint64_t& alive = walk.alive[o / N];
      if (alive == 0) continue;
      alive = bits_of(advance<Lookup, kOrdered>(look, packet, walk, o, lanes_of(alive)));
      live += static_cast<std::size_t>(hn::CountTrue(di, lanes_of(alive)));
    }
    // Only if that saves vectors.
    if (live > 0 && live + kSaved * N <= walk.lanes) {
      finish_all(packet, walk);
      compact(walk);
      wake(walk);
    }
  }
  finish_all(packet, walk);
  return met;
}

template <class Lookup>
std::uint64_t march(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet, std::uint64_t rays) {
  return stand.ties.bits >> 3 == 0 ? march_with_ties<Lookup, true>(target, stand, packet, rays)
                                   : march_with_ties<Lookup, false>(target, stand, packet, rays);
}

bool load(VoxelPacket& packet, const Ray* rays, std::size_t count) {
  load_ray_numbers([rays](std::size_t i) -> const Ray& { return rays[i]; }, count,
                   {packet.origin[0], packet.origin[1], packet.origin[2], packet.direction[0], packet.direction[1],
                    packet.direction[2], packet.t_min, packet.t_max});
  packet.count = count;
  for (std::size_t o = 0; o < count; o += N) {
    VD longest = hn::Zero(dd);
    for (int axis = 0; axis < 3; ++axis) longest = hn::Max(longest, hn::Abs(hn::Load(dd, packet.direction[axis] + o)));
    const auto usual =
        hn::And(hn::Gt(longest, hn::Set(dd, kShortestUsual)), hn::Lt(longest, hn::Set(dd, kLongestUsual)));
    if (!hn::AllTrue(dd, hn::Or(usual, hn::Not(hn::FirstN(dd, count - o))))) return false;
  }
  return true;
}

// Computes the VoxelDirection of each ray, with the same operations.
void aim(VoxelPacket& packet, const glm::dmat3& grid_from_world, VoxelTies ties) {
  const VD whole = hn::Set(dd, static_cast<double>(1 << kDirectionBits)), half = hn::Set(dd, 0.5);
  packet.slow = false;
  for (std::size_t o = 0; o < packet.count; o += N) {
    VD world[3], given[3], inverse[3];
    for (int i = 0; i < 3; ++i) world[i] = hn::Load(dd, packet.direction[i] + o);
    transform(grid_from_world, world, given);
    for (int i = 0; i < 3; ++i) {
      inverse[i] = hn::Div(hn::Set(dd, 1.0), given[i]);
      hn::Store(given[i], dd, packet.given[i] + o);
      hn::Store(inverse[i], dd, packet.inverse[i] + o);
      // A level ray steps towards the upper side.
      const VD zero = hn::Zero(dd);
      const MD down = ties.up(i) > 0 ? hn::Lt(given[i], zero) : hn::Le(given[i], zero);
      hn::Store(hn::VecFromMask(di, hn::RebindMask(di, down)), di, packet.down[i] + o);
    }
    const VD per_longest = hn::Min(hn::Min(hn::Abs(inverse[0]), hn::Abs(inverse[1])), hn::Abs(inverse[2]));
    MD exact = hn::Eq(half, half), any_slow = hn::Lt(half, half);
    for (int i = 0; i < 3; ++i) {
      const VD units = hn::Mul(hn::Mul(hn::Abs(given[i]), per_longest), whole);
      const MD slow = hn::Lt(units, hn::Set(dd, static_cast<double>(kSlow)));
      const VI speed = truncated(hn::IfThenElse(slow, units, hn::Add(units, half)));
      hn::Store(speed, di, packet.speed[i] + o);
      const MI power = hn::Eq(hn::And(speed, hn::Sub(speed, hn::Set(di, 1))), hn::Zero(di));
      const MD fits = hn::AndNot(slow, hn::And(hn::Eq(units, as_double(speed)), hn::RebindMask(dd, power)));
      exact = hn::And(exact, hn::Or(fits, hn::Eq(given[i], hn::Zero(dd))));
      any_slow = hn::Or(any_slow, slow);
    }
    hn::Store(hn::VecFromMask(di, hn::RebindMask(di, exact)), di, packet.exact + o);
    packet.slow = packet.slow || !hn::AllFalse(dd, any_slow);
    const VD per_s = hn::Set(dd, static_cast<double>(1 << (kDirectionBits - kPlaceBits)));
    hn::Store(hn::Mul(per_s, per_longest), dd, packet.t_per_s + o);
  }
}

// Up to this side of the box, distances have 32 bits.
constexpr int kNarrow = 2048;
bool is_wide(const VoxelBox& box) {
  const ivec3 size = box.high - box.low;
  return std::max({size.x, size.y, size.z}) > kNarrow;
}

std::uint64_t march_planes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                           std::uint64_t rays) {
  return is_wide(target.box) ? march<PlanesLookup<true>>(target, stand, packet, rays)
                             : march<PlanesLookup<false>>(target, stand, packet, rays);
}
std::uint64_t march_cubes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet, std::uint64_t rays) {
  return march<CubesLookup>(target, stand, packet, rays);
}
std::uint64_t march_spheres(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                            std::uint64_t rays) {
  return march<SpheresLookup>(target, stand, packet, rays);
}
std::uint64_t march_cubes_jump(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                               std::uint64_t rays) {
  return march<CubesJumpLookup>(target, stand, packet, rays);
}
std::uint64_t march_octants(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                            std::uint64_t rays) {
  return march<OctantsLookup>(target, stand, packet, rays);
}
std::uint64_t march_bricks(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                           std::uint64_t rays) {
  if (is_wide(target.box)) return march<BricksLookup<true, true>>(target, stand, packet, rays);
  return target.bricks->levels().size() > 1 ? march<BricksLookup<false, true>>(target, stand, packet, rays)
                                            : march<BricksLookup<false, false>>(target, stand, packet, rays);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(load);
HWY_EXPORT(aim);
HWY_EXPORT(march_planes);
HWY_EXPORT(march_cubes);
HWY_EXPORT(march_spheres);
HWY_EXPORT(march_cubes_jump);
HWY_EXPORT(march_octants);
HWY_EXPORT(march_bricks);

}  // namespace

bool load_voxel_packet(VoxelPacket& packet, std::span<const Ray> rays) {
  return HWY_DYNAMIC_DISPATCH(load)(packet, rays.data(), rays.size());
}

void aim_voxel_packet(VoxelPacket& packet, const glm::dmat3& grid_from_world, VoxelTies ties) {
  HWY_DYNAMIC_DISPATCH(aim)(packet, grid_from_world, ties);
}

std::uint64_t march_packet_voxel_planes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                        std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_planes)(target, stand, packet, rays);
}
std::uint64_t march_packet_voxel_cubes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                       std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_cubes)(target, stand, packet, rays);
}
std::uint64_t march_packet_voxel_spheres(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                         std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_spheres)(target, stand, packet, rays);
}

std::uint64_t march_packet_voxel_cubes_jump(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                            std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_cubes_jump)(target, stand, packet, rays);
}

std::uint64_t march_packet_voxel_octants(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                         std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_octants)(target, stand, packet, rays);
}
std::uint64_t march_packet_voxel_bricks(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                        std::uint64_t rays) {
  return HWY_DYNAMIC_DISPATCH(march_bricks)(target, stand, packet, rays);
}

}  // namespace scarp
#endif
