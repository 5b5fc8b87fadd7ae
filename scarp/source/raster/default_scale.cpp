// SPDX-License-Identifier: MIT
#include "scarp/source/raster/default_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp {
namespace {

// Difference of the largest and the smallest sample, without holes; 0 if there are no samples.
double range_of(const Raster& raster) {
  return std::visit(
      [&]<class T>(const std::vector<T>& samples) {
        T least = std::numeric_limits<T>::max(), most = std::numeric_limits<T>::lowest();
        for (const T sample : samples) {
          if (raster.nodata && sample == *raster.nodata) continue;
          // NaN fails both comparisons.
          if (sample < least) least = sample;
          if (sample > most) most = sample;
        }
        return least < most ? static_cast<double>(most) - static_cast<double>(least) : 0.0;
      },
      raster.samples);
}

}  // namespace

bool depends_on_samples(const HeightsStated& stated) { return stated.picture && stated.greatest && !stated.scaled; }

std::string settle_default_scale(Raster& raster, const HeightsStated& stated) {
  const Georeference& geo = raster.georeference;
  if (geo.present || stated.scaled) return {};
  const double longer = std::max((raster.cols - 1) * geo.cell_x_m, (raster.rows - 1) * geo.cell_y_m),
               relief = range_of(raster) * std::abs(raster.scale);
  if (!(relief > longer)) return {};
  if (depends_on_samples(stated)) {
    const double high = kPictureRelief * stated.longer_side_m;
    raster.scale = high / *stated.greatest;
    return fmt::format(
        "picture without a height scale: samples of 0 to {:g} are taken as heights of 0 to {:.6g} m, an eighth of the "
        "longer side (override with --height-range LOW,HIGH)",
        *stated.greatest, high);
  }
  return fmt::format(
      "heights span {:.6g} m over {:.6g} m of ground (if that is too steep, use {}--scale, --bounds or "
      "--exaggeration)",
      relief, longer,
      stated.greatest || std::holds_alternative<std::vector<float>>(raster.samples) ? "--height-range LOW,HIGH, " : "");
}

}  // namespace scarp
