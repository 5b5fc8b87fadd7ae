// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_ground.h"

#include "scarp/analysis/sight_rays.h"
#include "scarp/base/parallel.h"

namespace scarp {

Shade SunGround::shade(const SunRay& sun, Node node) const {
  return bilinear_ ? bilinear_->shade(sun, node) : scarp::shade(ground_, sun, node);
}

std::vector<Shade> SunGround::rows(const SunDirection& sun, const RowBand& band, const Progress& progress) const {
  if (!bilinear_) return shadow_rows(field(), sun, band, progress);
  require_band(field(), band);
  const SunRay ray = sun_ray(field(), sun);
  const int cols = field().cols();
  std::vector<Shade> codes(static_cast<std::size_t>(cols) * static_cast<std::size_t>(band.rows()));
  constexpr std::int64_t kGrain = 16;  // rows
  parallel_for(
      band.rows(), kGrain,
      [&](std::int64_t begin, std::int64_t end) {
        auto code = codes.begin() + static_cast<std::ptrdiff_t>(begin) * cols;
        for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
          for (int col = 0; col < cols; ++col) *code++ = shade(ray, {col, band.first + row});
      },
      progress);
  return codes;
}

}  // namespace scarp
