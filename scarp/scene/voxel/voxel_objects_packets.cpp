// SPDX-License-Identifier: MIT
// Batches of rays against voxel objects.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/march/voxel/voxel_packet.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {
namespace {

constexpr std::size_t kRays = VoxelPacket::kRays;
static_assert(kRays == BoxTree::Beam::kRays);

// A beam is abandoned after more than kWasted objects that fewer than kFewRays of its rays hit: its rays could have
// been traced individually by then. The following beams are skipped as well, twice as many each time.
constexpr int kFewRays = 8, kWasted = 24;
constexpr std::size_t kLongestPause = 64;
// Up to this number of objects, no hierarchy is used.
constexpr std::size_t kAskedAtOnce = 1;

// Calls body(i) for each bit.
template <class Body>
void for_each_bit(std::uint64_t bits, const Body& body) {
  for (; bits != 0; bits &= bits - 1) body(static_cast<std::size_t>(std::countr_zero(bits)));
}

void require_same_length(std::size_t rays, std::size_t answers) {
  if (rays != answers) throw Error(fmt::format("voxels: {} rays, but {} answers", rays, answers));
}

}  // namespace

// Up to 64 world rays traced through the objects together.
class VoxelObjects::PacketQuery {
 public:
  using From = std::span<const Hit* const>;

  explicit PacketQuery(const VoxelObjects& scene) : scene_(scene) {}

  // Sets hits[i] for rays[i]; without `hits`, tests for any hit. Returns false, without a result, if the rays diverge
  // too much or their directions have unusual lengths.
  bool ask(std::span<const Ray> rays, From from, Hit* hits) {
    rays_ = rays, from_ = from, hits_ = hits;
    if (hits) std::fill(hits, hits + rays.size(), Hit{});
    found_ = 0;
    if (!load()) return false;
    if (scene_.in_tree_.size() <= kAskedAtOnce) {
      const std::uint64_t all = ~std::uint64_t{0} >> (kRays - rays.size());
      for (const std::uint32_t index : scene_.in_tree_) meet(index, all);
    } else if (!ask_tree()) {
      return false;
    }
    return true;
  }

  bool found(std::size_t i) const { return found_ >> i & 1; }

 private:
  std::span<const double> t_max() const { return {packet_.t_max, rays_.size()}; }

  bool load() {
    packet_.steps = 0;
    aimed_ = alone_aimed_ = kNoTurn;
    const auto placed_elsewhere = [&](const Ray& ray) {
      return ray.frame != rays_[0].frame || ray.room != rays_[0].room;
    };
    return load_voxel_packet(packet_, rays_) && std::none_of(rays_.begin(), rays_.end(), placed_elsewhere);
  }

  bool ask_tree() {
    const auto &o = packet_.origin, &d = packet_.direction;
    const auto beam =
        scene_.tree_.beam({rays_.size(), {o[0], o[1], o[2]}, {d[0], d[1], d[2]}, packet_.t_min, packet_.t_max});
    if (!beam) return false;
    // Rays that miss everything.
    for_each_bit(~beam->inside & ~std::uint64_t{0} >> (kRays - rays_.size()),
                 [&](std::size_t i) { packet_.t_max[i] = -std::numeric_limits<double>::infinity(); });
    int wasted = 0;
    scene_.tree_.traverse(*beam, [&](std::uint32_t in_tree) {
      const Meeting meeting = meet(scene_.in_tree_[in_tree], hits_ ? beam->inside : beam->inside & ~found_);
      wasted += std::popcount(meeting.met) < kFewRays ? 1 : 0;
      if (wasted > kWasted) return -1.0f;
      return meeting.hit == 0 ? std::numeric_limits<float>::infinity() : beam->end_of(t_max());
    });
    return wasted <= kWasted;
  }

  struct Meeting {
    std::uint64_t met = 0, hit = 0;  // a bit per ray
  };

  // Traces the rays against an object. Keeps its hits if they are the nearest so far, and lowers t_max accordingly.
  Meeting meet(std::uint32_t index, std::uint64_t open) {
    const Object& object = scene_.objects_[index];
    const Turn& turn = scene_.turns_[object.turn];
    const VoxelTies ties = turn.ties(rays_[0]);
    const double room = turn.room_of(rays_[0]);
    const VoxelTarget& target = scene_.targets_[object.model];
    const VoxelMarchEntry& march = scene_.models_[object.model]->march();
    std::uint64_t alone = march.simd ? 0 : open;
    if (!from_.empty()) {
      for_each_bit(open, [&](std::size_t i) {
        if (from_[i] && from_[i]->part == index) alone |= std::uint64_t{1} << i;
      });
    }
    Meeting meeting;
    if (const std::uint64_t together = open & ~alone; together != 0) {
      if (aimed_ != object.turn) aim_voxel_packet(packet_, turn.grid_from_world, ties);
      aimed_ = object.turn;
      meeting.met = march.packet(target, {turn.grid_from_world, object.origin, ties, room}, packet_, together);
      for (std::size_t k = 0; k < packet_.hits; ++k) {
        const auto i = static_cast<std::size_t>(packet_.ray[k]);
        meeting.hit |= std::uint64_t{1} << i;
        if (Hit* to = keep(i, packet_.t[k], index)) {
          to->face = static_cast<VoxelFace>(packet_.face[k]);
          for (int axis = 0; axis < 3; ++axis) to->voxel[axis] = static_cast<int>(packet_.voxel[axis][k]);
        }
      }
    }
    if (alone != 0) {
      if (alone_aimed_ != object.turn) {
        directions_.clear();
        for (const Ray& ray : rays_) directions_.emplace_back(turn.grid_from_world * ray.direction, ties);
      }
      alone_aimed_ = object.turn;
    }
    for_each_bit(alone, [&](std::size_t i) {
      std::optional<ivec3> start_voxel;
      const Hit* from = from_.empty() ? nullptr : from_[i];
      if (from && from->part == index) start_voxel = from->voxel + normal_of(from->face);
      const VoxelRay ray{turn.grid_from_world * (rays_[i].origin - object.origin),
                         directions_[i].given,
                         rays_[i].t_min,
                         packet_.t_max[i],
                         start_voxel,
                         room};
      QuantisedRay quantised;
      if (!quantise(ray, directions_[i], target.box, quantised)) return;
      MarchStats stats;
      const VoxelHit hit = march.cpu(target, quantised, &stats);
      packet_.steps += stats.steps;
      meeting.met |= std::uint64_t{1} << i;
      if (!hit) return;
      meeting.hit |= std::uint64_t{1} << i;
      if (Hit* to = keep(i, hit.t, index)) to->face = hit.face, to->voxel = hit.voxel;
    });
    return meeting;
  }

  // Where to store the hit, if it is the nearest so far.
  Hit* keep(std::size_t i, double t, std::uint32_t index) {
    const bool again = found(i);
    found_ |= std::uint64_t{1} << i;
    if (!hits_) {
      packet_.t_max[i] = -std::numeric_limits<double>::infinity();
      return nullptr;
    }
    Hit& to = hits_[i];
    if (again && t == to.t && index > to.part) return nullptr;
    to.status = HitStatus::hit;
    to.t = packet_.t_max[i] = t;
    to.part = index;
    return &to;
  }

  static constexpr std::uint32_t kNoTurn = 0xffff'ffff;

  const VoxelObjects& scene_;
  std::span<const Ray> rays_;
  From from_;
  Hit* hits_ = nullptr;
  VoxelPacket packet_;
  std::uint32_t aimed_ = kNoTurn, alone_aimed_ = kNoTurn;  // rotations of the directions in packet_ and directions_
  std::vector<VoxelDirection> directions_;
  std::uint64_t found_ = 0;
};

template <class Together, class Alone>
void VoxelObjects::by_packets(std::span<const Ray> rays, std::span<const Hit* const> from, Hit* hits,
                              const Together& together, const Alone& alone) const {
  if (!from.empty()) require_same_length(rays.size(), from.size());
  // Rounded voxels are traced ray by ray.
  if (rounding_) {
    for (std::size_t i = 0; i < rays.size(); ++i) alone(i, from.empty() ? nullptr : from[i]);
    return;
  }
  PacketQuery query(*this);
  std::size_t pause = 0, next_pause = 1;
  for (std::size_t begin = 0; begin < rays.size(); begin += kRays) {
    const std::size_t count = std::min(kRays, rays.size() - begin);
    const auto from_here = from.empty() ? from : from.subspan(begin, count);
    if (pause > 0) {
      --pause;
    } else if (query.ask(rays.subspan(begin, count), from_here, hits ? hits + begin : nullptr)) {
      together(query, begin, count);
      next_pause = 1;
      continue;
    } else {
      pause = next_pause;
      next_pause = std::min(2 * next_pause, kLongestPause);
    }
    for (std::size_t i = begin; i < begin + count; ++i) alone(i, from.empty() ? nullptr : from[i]);
  }
}

void VoxelObjects::closest_hits(std::span<const Ray> rays, std::span<Hit> hits,
                                std::span<const Hit* const> from) const {
  require_same_length(rays.size(), hits.size());
  by_packets(
      rays, from, hits.data(), [](const PacketQuery&, std::size_t, std::size_t) {},
      [&](std::size_t i, const Hit* start) { hits[i] = closest_hit(rays[i], start, nullptr); });
}

void VoxelObjects::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                            std::span<const Hit* const> from) const {
  require_same_length(rays.size(), blocked.size());
  by_packets(
      rays, from, nullptr,
      [&](const PacketQuery& query, std::size_t begin, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) blocked[begin + i] = query.found(i);
      },
      [&](std::size_t i, const Hit* start) { blocked[i] = occluded(rays[i], start); });
}

}  // namespace scarp
