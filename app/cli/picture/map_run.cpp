// SPDX-License-Identifier: MIT
#include "app/cli/picture/map_run.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/picture/map_preview.h"
#include "app/cli/progress.h"

namespace scarp::cli {
namespace {

// Checks the output before the raster is opened.
MapCommand& settled(MapCommand& options, std::string_view sample_type) {
  settle_output(options.raster_output, options, sample_type);
  return options;
}

MapBand view_of(const ComputedBand& band) {
  return {band.name,
          band.unit,
          std::visit([](const auto& pixels) -> decltype(MapBand::samples) { return std::span(pixels); }, band.pixels),
          band.nodata,
          band.classes,
          band.scale,
          band.offset};
}

}  // namespace

void add_map_command(Command& command, MapCommand& options, std::function<void()> run,
                     const std::vector<std::string>& excludes) {
  add_raster_output_options(command, options.raster_output, excludes);
  add_map_options(command, options);
  command.runs([&options, &command, run = std::move(run)] {
    options.typed = command.typed_values();
    command.require_effect({});
    run();
  });
}

ComputedBand number_band(std::string name, std::string unit, std::vector<float> pixels, double nodata) {
  std::replace_if(
      pixels.begin(), pixels.end(), [](float pixel) { return std::isnan(pixel); }, static_cast<float>(nodata));
  return {std::move(name), std::move(unit), std::move(pixels), nodata};
}

MapRun::MapRun(MapCommand& options, const Command& command, std::string_view sample_type)
    : options_(settled(options, sample_type)),
      command_(command),
      limit_(options.threads),
      start_(std::chrono::steady_clock::now()),
      input_(options) {
  keep_inputs(options.output, input_.files());
  set_area(input_.whole(), input_.whole());
}

void MapRun::set_area(const RasterWindow& whole, const RasterWindow& read) {
  area_ = map_area(input_, options_.raster_output, whole, read);
}

void MapRun::set_reach(double metres) {
  // A preview shows the whole raster.
  if (options_.raster_output.preview.empty()) set_area(input_.whole(), rows_around(input_, area_.output, metres));
}

bool MapRun::begin(double bytes_per_pixel, double seconds_per_pixel) {
  if (options_.raster_output.dry_run) {
    const double pixels = static_cast<double>(area_.computed.cols) * area_.computed.rows;
    print_dry_run(input_, area_, options_.output, bytes_per_pixel, pixels * seconds_per_pixel);
    return false;
  }
  input_.read(area_.read, terminal_progress("read"));
  input_.close();
  return true;
}

void MapRun::write(const MapRecipe& recipe) {
  const RowBand rows = area_.rows();
  std::optional<MapPreview> preview;
  if (!options_.raster_output.preview.empty()) preview.emplace(options_.raster_output.preview, input_);
  RasterMap map = map_of(input_, options_.raster_output, area_, recipe.method, recipe.metadata);
  const std::vector<ComputedBand> bands = recipe.compute(rows, terminal_progress(command_.name()));
  for (const ComputedBand& band : bands) map.bands.push_back(view_of(band));
  write_map(options_.raster_output, options_.output, map);
  if (preview) preview->write(map, rows, recipe.ramp);
  print_map_summary(input_, options_.raster_output, area_, options_.output, recipe.summary(), start_);
}

}  // namespace scarp::cli
