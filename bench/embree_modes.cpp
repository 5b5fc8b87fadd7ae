// SPDX-License-Identifier: MIT
#include "bench/embree_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "bench/denormals_off.h"
#include "bench/engine.h"

namespace scarp::bench {
namespace {

// Embree writes to its rays, so each call gets copies in memory that stays in the L1 cache.
static_assert(sizeof(RayRecord) == sizeof(RTCRay) && offsetof(RayRecord, t_max) == offsetof(RTCRay, tfar));
void fill(RTCRay& to, const RayRecord& from) { std::memcpy(&to, &from, sizeof to); }
void fill(RTCRayHit& to, const RayRecord& from) {
  fill(to.ray, from);
  to.hit.geomID = to.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}
float answer(const RTCRay& ray) { return ray.tfar < 0 ? kBlocked : kMiss; }
float answer(const RTCRayHit& query) { return query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? query.ray.tfar : kMiss; }

RTCIntersectContext context_of(const EmbreeMode& mode) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = mode.flags;
  return context;
}

void trace_single(RTCScene scene, const EmbreeMode& mode, const RaySet& set, std::int64_t begin, std::int64_t end,
                  float* answers) {
  const DenormalsOff denormals_off;
  RTCIntersectContext context = context_of(mode);
  const auto trace = [&](auto query, const auto& call) {
    for (std::int64_t i = begin; i < end; ++i) {
      fill(query, set.records[static_cast<std::size_t>(i)]);
      call(scene, &context, &query);
      *answers++ = answer(query);
    }
  };
  if (set.any_hit) {
    trace(RTCRay(), rtcOccluded1);
  } else {
    trace(RTCRayHit(), rtcIntersect1);
  }
}

void trace_stream(RTCScene scene, const EmbreeMode& mode, const RaySet& set, std::int64_t begin, std::int64_t end,
                  float* answers) {
  const DenormalsOff denormals_off;
  RTCIntersectContext context = context_of(mode);
  const auto trace = [&](auto& queries, const auto& call) {
    queries.resize(static_cast<std::size_t>(mode.stream));
    for (std::int64_t i = begin; i < end; i += mode.stream) {
      const auto count = static_cast<std::size_t>(std::min(mode.stream, end - i));
      for (std::size_t k = 0; k < count; ++k) fill(queries[k], set.records[static_cast<std::size_t>(i) + k]);
      call(scene, &context, queries.data(), static_cast<unsigned>(count), sizeof queries[0]);
      for (std::size_t k = 0; k < count; ++k) *answers++ = answer(queries[k]);
    }
  };
  if (set.any_hit) {
    thread_local std::vector<RTCRay> rays;
    trace(rays, rtcOccluded1M);
  } else {
    thread_local std::vector<RTCRayHit> hits;
    trace(hits, rtcIntersect1M);
  }
}

template <int kLanes>
struct Packet;
template <>
struct Packet<4> {
  using Rays = RTCRay4;
  using Hits = RTCRayHit4;
  static constexpr auto occluded = rtcOccluded4;
  static constexpr auto intersect = rtcIntersect4;
};
template <>
struct Packet<8> {
  using Rays = RTCRay8;
  using Hits = RTCRayHit8;
  static constexpr auto occluded = rtcOccluded8;
  static constexpr auto intersect = rtcIntersect8;
};
template <>
struct Packet<16> {
  using Rays = RTCRay16;
  using Hits = RTCRayHit16;
  static constexpr auto occluded = rtcOccluded16;
  static constexpr auto intersect = rtcIntersect16;
};

template <class Rays>
void fill_packet(Rays& to, const RayPacket& from, std::size_t lane) {
  const auto copy = [lane](auto& lanes, const auto& all) { std::memcpy(lanes, all + lane, sizeof lanes); };
  copy(to.org_x, from.ox), copy(to.org_y, from.oy), copy(to.org_z, from.oz);
  copy(to.dir_x, from.dx), copy(to.dir_y, from.dy), copy(to.dir_z, from.dz);
  copy(to.tfar, from.t_max);
  std::memset(to.tnear, 0, sizeof to.tnear), std::memset(to.time, 0, sizeof to.time);
  std::memset(to.mask, 0xff, sizeof to.mask), std::memset(to.id, 0, sizeof to.id);
  std::memset(to.flags, 0, sizeof to.flags);
}

template <int kLanes>
void trace_packets(RTCScene scene, const EmbreeMode& mode, const RaySet& set, std::int64_t begin, std::int64_t end,
                   float* answers) {
  const DenormalsOff denormals_off;
  RTCIntersectContext context = context_of(mode);
  const auto each = [&](const auto& call) {
    for (std::int64_t i = begin; i < end; i += kLanes) {
      call(set.packets[static_cast<std::size_t>(i / RayPacket::kLanes)],
           static_cast<std::size_t>(i % RayPacket::kLanes), std::min<std::int64_t>(kLanes, end - i));
    }
  };
  if (set.any_hit) {
    typename Packet<kLanes>::Rays rays;
    each([&](const RayPacket& packet, std::size_t lane, std::int64_t count) {
      fill_packet(rays, packet, lane);
      Packet<kLanes>::occluded(packet.valid + lane, scene, &context, &rays);
      for (std::int64_t k = 0; k < count; ++k) *answers++ = rays.tfar[k] < 0 ? kBlocked : kMiss;
    });
  } else {
    typename Packet<kLanes>::Hits query;
    each([&](const RayPacket& packet, std::size_t lane, std::int64_t count) {
      fill_packet(query.ray, packet, lane);
      std::memset(query.hit.geomID, 0xff, sizeof query.hit.geomID);
      std::memset(query.hit.instID, 0xff, sizeof query.hit.instID);
      Packet<kLanes>::intersect(packet.valid + lane, scene, &context, &query);
      for (std::int64_t k = 0; k < count; ++k)
        *answers++ = query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID ? query.ray.tfar[k] : kMiss;
    });
  }
}

std::vector<EmbreeMode> make_modes() {
  std::vector<EmbreeMode> modes{{"x1", trace_single}};
  const auto add = [&](const std::string& name, decltype(EmbreeMode::trace) trace, std::int64_t stream = 0) {
    modes.push_back({name + "-coherent", trace, RTC_INTERSECT_CONTEXT_FLAG_COHERENT, stream});
    modes.push_back({name + "-incoherent", trace, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT, stream});
  };
  add("x4", trace_packets<4>);
  add("x8", trace_packets<8>);
  add("x16", trace_packets<16>);
  for (const std::int64_t stream : {64, 256, 1024, 4096}) add(fmt::format("x1m-{}", stream), trace_stream, stream);
  return modes;
}

}  // namespace

const std::vector<EmbreeMode>& embree_modes() {
  static const std::vector<EmbreeMode> modes = make_modes();
  return modes;
}

}  // namespace scarp::bench
