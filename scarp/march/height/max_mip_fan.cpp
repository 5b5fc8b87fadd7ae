// SPDX-License-Identifier: MIT
#include "scarp/march/height/max_mip_fan.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_fan_walk.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/max_mip_simd.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

using max_mip::FanRest;

constexpr std::size_t kBatch = 4096;

// From above all ground, where rays are far from the ground until they hit, the batch is as fast with fewer rows than
// this; and anywhere with fewer columns than this, which leave most lanes empty. Measured (decisions.md).
constexpr int kFewRows = 24, kFewColumns = 5;

bool pays(const HeightField& field, const Fan& fan, int columns) {
  return columns >= kFewColumns && (fan.rows >= kFewRows || fan.origin.z <= field.max_height());
}

thread_local FanStats t_stats;

Ray ray_of(const Fan& fan, std::ptrdiff_t i) {
  Ray ray;
  ray.origin = fan.origin;
  ray.direction = {static_cast<double>(fan.dx[i]), static_cast<double>(fan.dy[i]), static_cast<double>(fan.dz[i])};
  ray.t_min = fan.t_min, ray.t_max = fan.t_max;
  return ray;
}

void put(const FanHits& to, std::ptrdiff_t i, const Hit& hit) {
  using Float = std::numeric_limits<float>;
  to.t[i] = hit ? static_cast<float>(std::min(hit.t, static_cast<double>(Float::max()))) : Float::infinity();
  to.col[i] = hit ? hit.cell.col : -1, to.row[i] = hit ? hit.cell.row : -1;
  to.u[i] = hit ? static_cast<float>(hit.u) : 0, to.v[i] = hit ? static_cast<float>(hit.v) : 0;
  if (to.status) to.status[i] = hit.status;
}

// Answers rays of which nothing is known, many at once.
class Batch {
 public:
  Batch(const HeightTarget& target, const Fan& fan, const FanHits& hits) : target_(target), fan_(fan), to_(hits) {}

  void add(std::ptrdiff_t i) {
    const Ray ray = ray_of(fan_, i);
    if (!is_followable(ray)) return put(to_, i, {});
    rays_.push_back(ray), places_.push_back(i);
    if (rays_.size() == kBatch) answer();
  }
  void answer() {
    hits_.resize(rays_.size());
    closest_hits_max_mip_simd(target_, rays_, hits_);
    for (std::size_t i = 0; i < rays_.size(); ++i) put(to_, places_[i], hits_[i]);
    rays_.clear(), places_.clear();
  }

 private:
  const HeightTarget& target_;
  const Fan& fan_;
  const FanHits& to_;
  std::vector<Ray> rays_;
  std::vector<std::ptrdiff_t> places_;
  std::vector<Hit> hits_;
};

}  // namespace

void closest_hits_max_mip_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int column_begin,
                              int column_end, const FanOptions& options) {
  require(target, HeightPart::pyramid);
  if (column_begin >= column_end || fan.rows <= 0) return;
  Batch batch(target, fan, hits);
  const bool walks = options.always || pays(*target.field, fan, column_end - column_begin);
  if (!walks || !max_mip::walks_fan(target, fan)) {
    for (int row = 0; row < fan.rows; ++row) {
      for (int column = column_begin; column < column_end; ++column)
        batch.add(row * fan.row_stride + column / 16 * fan.strip_stride + column % 16);
    }
    return batch.answer();
  }
  std::vector<FanRest> rest;
  max_mip::walk_fan(target, fan, hits, column_begin, column_end, options, rest, t_stats);
  for (const FanRest& one : rest) {
    if (one.t_clear > 0) {
      ++t_stats.resumed;
      put(hits, one.ray, resume_max_mip(target, ray_of(fan, one.ray), one.t_clear));
    } else {
      ++t_stats.from_start;
      batch.add(one.ray);
    }
  }
  batch.answer();
}

void closest_hits_max_mip_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int column_begin,
                              int column_end) {
  closest_hits_max_mip_fan(target, fan, hits, column_begin, column_end, {});
}

FanStats take_fan_stats() { return std::exchange(t_stats, {}); }

}  // namespace scarp
