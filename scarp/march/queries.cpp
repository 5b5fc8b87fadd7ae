// SPDX-License-Identifier: MIT
#include "scarp/march/queries.h"

#include <fmt/format.h>

#include <cmath>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr std::int64_t kRaysPerPiece = 256;

void require_same_length(std::size_t rays, std::size_t answers) {
  if (rays != answers) throw Error(fmt::format("batch: {} rays, room for {} answers", rays, answers));
}

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Calls answer(i) for each ray, on all threads.
template <class Answer>
void for_each_ray(std::size_t rays, const Answer& answer) {
  parallel_for(static_cast<std::int64_t>(rays), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) answer(i);
  });
}

}  // namespace

void closest_hits(const HeightTarget& target, std::span<const Ray> rays, std::span<Hit> hits, const MarchEntry& march,
                  const MarchSettings& settings) {
  require_same_length(rays.size(), hits.size());
  for_each_ray(rays.size(), [&](std::size_t i) { hits[i] = march.cpu(target, rays[i], settings, nullptr); });
}

void occluded(const HeightTarget& target, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
              const MarchEntry& march, const MarchSettings& settings) {
  require_same_length(rays.size(), blocked.size());
  for_each_ray(rays.size(), [&](std::size_t i) {
    blocked[i] = march.cpu_occluded ? march.cpu_occluded(target, rays[i])
                                    : march.cpu(target, rays[i], settings, nullptr).status == HitStatus::hit;
  });
}

void validate(const Ray& ray, const HeightField& field) {
  if (!finite(ray.origin)) throw Error("ray: its origin is not finite");
  if (!finite(ray.direction)) throw Error("ray: its direction is not finite");
  if (ray.direction == dvec3(0.0)) throw Error("ray: its direction is zero");
  if (!std::isfinite(ray.t_min) || std::isnan(ray.t_max) || ray.t_max < ray.t_min) {
    throw Error(
        fmt::format("ray: its range is {} to {}; t_min must be finite and t_max no less", ray.t_min, ray.t_max));
  }
  if (field.wraps() && std::isinf(ray.t_max)) {
    throw Error("ray: its range has no end; over a field that wraps round t_max must be finite");
  }
  if (ray.start == RayStart::on_surface) {
    const Cell cell = ray.start_cell;
    const bool exists = cell.col >= 0 && cell.col < field.cell_cols() && cell.row >= 0 && cell.row < field.cell_rows();
    if (!exists || !field.cell_heights(cell)) {
      throw Error(fmt::format("ray: it starts on the surface of cell ({}, {}), which {}", cell.col, cell.row,
                              exists ? "is a hole" : "does not exist"));
    }
  }
}

}  // namespace scarp
