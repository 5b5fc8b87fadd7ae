// SPDX-License-Identifier: MIT
#include "bench/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/source/raster/procedural_dem.h"
#ifdef SCARP_BENCH_GDAL
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/read_raster.h"
#endif

namespace scarp::bench {
namespace {

// Like SRTM, which has steps of 1 m at 30 m spacing.
constexpr double kInt16Step = 0x1p-5;

Surface surface_of(const FieldOptions& options) {
  return options.surface == "triangles" ? Surface::triangles : Surface::bilinear;
}

// Number of cells of every row at which the slope is sampled.
constexpr int kSlopesPerRow = 64;

double mean_slope_deg(const HeightField& field) {
  double sum = 0;
  std::int64_t count = 0;
  const int stride = std::max(1, field.cell_cols() / kSlopesPerRow);
  for (int row = 0; row < field.cell_rows(); ++row) {
    for (int col = row % stride; col < field.cell_cols(); col += stride) {
      sum += std::atan(length(field.gradient(Cell{col, row}, 0.5, 0.5)));
      ++count;
    }
  }
  return sum / static_cast<double>(count) * 180 / std::numbers::pi;
}

BenchField described(HeightField field, std::string name) {
  const double relief = field.max_height() - field.min_height(), slope = mean_slope_deg(field);
  return {std::move(field), std::move(name), relief, slope};
}

BenchField procedural(const FieldOptions& options) {
  ProceduralDem dem;
  dem.cols = dem.rows = options.size;
  dem.seed = options.seed;
  dem.cell_m = 1;
  const auto kind = terrain_kind(options.kind);
  if (!kind) throw Error(fmt::format("procedural DEM '{}': unknown (available: ridged, fbm)", options.kind));
  dem.kind = *kind;
  HeightFieldSettings settings;
  settings.surface = surface_of(options);
  const std::string name = fmt::format("{}, seed {}", options.kind, options.seed);
  std::vector<float> heights = generate_dem(dem);
  if (options.samples == "float32")
    return described(HeightField::own(std::move(heights), options.size, options.size, settings), name);
  settings.scale = kInt16Step;
  std::vector<std::int16_t> steps(heights.size());
  std::transform(heights.begin(), heights.end(), steps.begin(), [](float height) {
    return static_cast<std::int16_t>(std::lround(std::clamp(height / kInt16Step, -32768.0, 32767.0)));
  });
  return described(HeightField::own(std::move(steps), options.size, options.size, settings), name);
}

BenchField from_file(const std::string& path, [[maybe_unused]] Surface surface) {
#ifdef SCARP_BENCH_GDAL
  Raster raster = read_raster(path, {});
  // Converts metres to cells along all three axes.
  const double cell_m = raster.georeference.cell_x_m;
  raster.georeference.cell_y_m /= cell_m;
  raster.georeference.cell_x_m = 1;
  raster.scale /= cell_m;
  raster.offset /= cell_m;
  scarp::FieldOptions options;
  options.surface = surface;
  HeightField field = height_field_from(std::move(raster), options);
  if (!field.has_cells())
    throw Error(fmt::format("DEM '{}': {} x {} samples; at least 2 x 2 are needed", path, field.cols(), field.rows()));
  if (field.nodata_count() > 0) {
    throw Error(fmt::format(
        "DEM '{}': {} samples are nodata, over which engines differ; fill them first, for example with gdal_fillnodata",
        path, field.nodata_count()));
  }
  return described(std::move(field), path);
#else
  throw Error(fmt::format("DEM '{}': this scarp-bench was built without GDAL; build with SCARP_GDAL=ON", path));
#endif
}

}  // namespace

BenchField load_field(const FieldOptions& options) {
  return options.dem.empty() ? procedural(options) : from_file(options.dem, surface_of(options));
}

BenchField exaggerated(const BenchField& ground, double exaggeration) {
  HeightFieldSettings settings = ground.field.settings();
  settings.exaggeration *= exaggeration;
  HeightField field = ground.field.visit(
      [&](const auto& grid) { return HeightField::view(grid.data, grid.cols, grid.rows, settings, grid.row_stride); });
  return described(std::move(field), ground.name);
}

std::optional<double> triangle_height(const HeightField& field, double x, double y) {
  const auto at = field.place(x, y);
  if (!at) return {};
  const auto h = field.cell_heights(at->cell);
  if (!h) return {};
  const double u = at->u, v = at->v;
  const double sample = u + v <= 1 ? h->h00 + u * (h->h10 - h->h00) + v * (h->h01 - h->h00)
                                   : h->h11 + (1 - u) * (h->h01 - h->h11) + (1 - v) * (h->h10 - h->h11);
  return field.height_from_sample(sample);
}

}  // namespace scarp::bench
