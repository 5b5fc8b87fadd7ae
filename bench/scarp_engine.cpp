// SPDX-License-Identifier: MIT
#include "bench/scarp_engine.h"

#include "bench/protocol.h"
#include "bench/rays.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/max_mip_fan.h"

namespace scarp::bench {
namespace {

double sample_bytes(const HeightField& field) {
  const double bytes = field.sample_type() == SampleType::float32 ? 4 : 2;
  return bytes * field.cols() * field.rows();
}

// Compiled for the two given functions, which avoids a call through std::function per ray.
template <class Closest, class Blocked>
void set_functions(Engine& engine, const Closest& closest, const Blocked& blocked) {
  engine.trace = [=](const RaySet& set, std::int64_t begin, std::int64_t end, float* answers) {
    const Ray* rays = set.library_rays.data();
    if (set.any_hit) {
      for (std::int64_t i = begin; i < end; ++i) *answers++ = blocked(rays[i]) ? kBlocked : kMiss;
    } else {
      for (std::int64_t i = begin; i < end; ++i) {
        const Hit hit = closest(rays[i], nullptr);
        *answers++ = hit ? static_cast<float>(hit.t) : kMiss;
      }
    }
  };
  engine.closest = [=](const Ray& ray, MarchStats& stats) { return closest(ray, &stats); };
  engine.blocked = blocked;
}

}  // namespace

ScarpGround::ScarpGround(const HeightField& field)
    : field_(field),
      pyramid_([&] {
        const Stopwatch watch;
        MaxPyramid pyramid(field);
        build_s_ = watch.wall_s();
        return pyramid;
      }()),
      slope_bound_(slope_bound(field)) {}

Engine ScarpGround::engine(const HeightMarchEntry& march, const MarchSettings& settings) const {
  Engine engine;
  engine.name = "scarp";
  engine.mode = march.name;
  engine.bytes = sample_bytes(field_) + (march.needs_pyramid ? static_cast<double>(pyramid_.bytes()) : 0);
  engine.peak_bytes = engine.bytes;
  engine.build_s = march.needs_pyramid ? build_s_ : 0;
  set_functions(
      engine,
      [=, to = target(), cpu = march.cpu](const Ray& ray, MarchStats* stats) { return cpu(to, ray, settings, stats); },
      [=, to = target(), occluded = march.occluded](const Ray& ray) { return occluded(to, ray, settings); });
  return engine;
}

Engine ScarpGround::closest_only(const HeightMarchEntry& march, const MarchSettings& settings) const {
  Engine engine = this->engine(march, settings);
  engine.mode = std::string(march.name) + "-closest";
  const auto closest = [=, to = target(), cpu = march.cpu](const Ray& ray, MarchStats* stats) {
    return cpu(to, ray, settings, stats);
  };
  set_functions(engine, closest, [=](const Ray& ray) { return closest(ray, nullptr).status == HitStatus::hit; });
  return engine;
}

Engine ScarpGround::vectors(const std::string& mode, const VectorOptions& options) const {
  Engine engine = this->engine(find_height_march("max-mip"));
  engine.mode = mode;
  const HeightTarget to = target();
  engine.trace = [=](const RaySet& set, std::int64_t begin, std::int64_t end, float* answers) {
    const auto count = static_cast<std::size_t>(end - begin);
    const std::span<const Ray> rays(set.library_rays.data() + begin, count);
    if (set.any_hit) {
      thread_local std::vector<std::uint8_t> blocked;
      blocked.resize(count);
      occluded_max_mip_simd(to, rays, blocked, options);
      for (std::size_t i = 0; i < count; ++i) answers[i] = blocked[i] ? kBlocked : kMiss;
    } else {
      thread_local std::vector<Hit> hits;
      hits.resize(count);
      closest_hits_max_mip_simd(to, rays, hits, options);
      for (std::size_t i = 0; i < count; ++i) answers[i] = hits[i] ? static_cast<float>(hits[i].t) : kMiss;
    }
  };
  return engine;
}

Engine ScarpGround::fans() const {
  Engine engine = this->engine(find_height_march("max-mip"));
  engine.mode = "fan";
  engine.in_fans = true;
  engine.closest = nullptr, engine.blocked = nullptr;
  const HeightTarget to = target();
  engine.trace = [=](const RaySet& set, std::int64_t begin, std::int64_t end, float* answers) {
    const std::int64_t rows = set.fan.rows;
    Fan fan;
    fan.origin = set.fan.origin;
    fan.dx = set.fan.dx.data() + begin, fan.dy = set.fan.dy.data() + begin, fan.dz = set.fan.dz.data() + begin;
    fan.columns = static_cast<int>((end - begin) / rows), fan.rows = set.fan.rows;
    fan.row_stride = 16, fan.strip_stride = 16 * rows;
    thread_local std::vector<float> u, v;
    thread_local std::vector<std::int32_t> col, row;
    const auto count = static_cast<std::size_t>(end - begin);
    u.resize(count), v.resize(count), col.resize(count), row.resize(count);
    closest_hits_max_mip_fan(to, fan, {answers, col.data(), row.data(), u.data(), v.data()});
  };
  return engine;
}

std::vector<Engine> ScarpGround::engines() const {
  std::vector<Engine> engines;
  for (const HeightMarchEntry& march : height_marches()) {
    if (march.name == "exhaustive" || !takes(march.fields, field_)) continue;
    engines.push_back(engine(march));
    if (march.simd) engines.push_back(vectors(std::string(march.name) + "-simd"));
    if (march.simd) engines.push_back(fans());
    // Measures the gain of a separate any-hit query.
    if (march.own_any_hit) engines.push_back(closest_only(march));
  }
  return engines;
}

}  // namespace scarp::bench
