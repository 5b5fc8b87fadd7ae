// SPDX-License-Identifier: MIT
// `scarp skyview`: maps how much sky each pixel of an elevation model sees.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/horizon_options.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_input.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/picture/map_preview.h"
#include "app/cli/picture/raster_output.h"
#include "app/cli/progress.h"
#include "scarp/analysis/sky_view.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::cli {
namespace {

constexpr float kNoSky = -9999;
constexpr const char* kSkyMethod =
    "exact horizons; ground linear at crossings of grid lines; directions equally spaced (scarp skyview)";

struct MeasureText {
  const char* name;
  SkyMeasure measure;
  const char* unit;  // "degrees": written in degrees
  const char* formula;
};
constexpr MeasureText kMeasures[] = {
    {"sky-fraction", SkyMeasure::sky_fraction, "", "mean of 1 - sin h, h the horizon, at least 0"},
    {"sky-view-factor", SkyMeasure::sky_view_factor, "",
     "mean of cos b sin^2 H + sin b cos(azimuth - a) (H - sin H cos H), H = 90 degrees - h, slope b, aspect a"},
    {"positive-openness", SkyMeasure::positive_openness, "degrees", "mean of 90 - h, h also below 0"},
    {"negative-openness", SkyMeasure::negative_openness, "degrees", "positive openness of the ground upside down"},
};

constexpr const char* kSkyFooter = R"(Measures, means over all azimuths of the horizon h:
  sky-fraction       visible share of the sky's solid angle (Zaksek 2011), 0 to 1
  sky-view-factor    share of a uniform sky's radiation that reaches the sloping ground
                     (Dozier and Frew 1990), 0 to 1
  positive-openness  zenith angle of the horizon in degrees, below the horizontal too
                     (Yokoyama 2002)
  negative-openness  the same of the ground upside down
The 45 degree slope of an endless plane has 0.75, 0.854, 90 and 90.)";

struct SkyviewOptions : MapOptions {
  std::vector<std::string> measures;
  int azimuths = 64;
  HorizonInput horizon;
  RasterOutput raster_output;
};

const MeasureText& measure_of(const std::string& name) {
  return *std::find_if(std::begin(kMeasures), std::end(kMeasures),
                       [&](const MeasureText& m) { return m.name == name; });
}

void run(SkyviewOptions options, const Command& command) {
  command.require_effect({});
  settle_output(options.raster_output, options, "Float32");
  if (options.measures.empty()) options.measures.emplace_back(kMeasures[0].name);
  const ThreadLimit limit(options.threads);
  const auto begin = std::chrono::steady_clock::now();
  MapInput input(options);
  keep_inputs(options.output, input.files());
  const MapArea area = map_area(input, options.raster_output, input.whole(), input.whole());
  if (options.raster_output.dry_run) {
    const double nodes = static_cast<double>(area.computed.cols) * area.computed.rows;
    constexpr double kNodeAzimuth_s = 4e-8;
    print_dry_run(input, area, options.output, 13 + 8 * static_cast<double>(options.measures.size()),
                  nodes * options.azimuths * kNodeAzimuth_s);
    return;
  }
  input.read(area.read, terminal_progress("read"));
  input.close();
  const HorizonPlane plane = horizon_plane(input);
  const HorizonSettings settings = horizon_settings(options.horizon, input);
  const RowBand rows = area.rows();
  std::optional<MapPreview> preview;
  if (!options.raster_output.preview.empty()) preview.emplace(options.raster_output.preview, input);
  std::vector<SkyMeasure> measures;
  auto metadata = horizon_metadata(settings);
  metadata.emplace_back("AZIMUTHS", fmt::format("{}", options.azimuths));
  for (const std::string& name : options.measures) {
    measures.push_back(measure_of(name).measure);
    metadata.emplace_back("FORMULA " + name, measure_of(name).formula);
  }
  RasterMap map = map_of(input, options.raster_output, area, kSkyMethod, metadata);
  const Progress progress = terminal_progress("skyview");
  const SkyView sky(plane.field, settings, options.azimuths, measures, progress);
  auto values = sky.rows(rows.first, rows.last, progress);
  std::string means;
  for (std::size_t m = 0; m < values.size(); ++m) {
    const MeasureText& text = measure_of(options.measures[m]);
    const bool degrees = *text.unit != 0;
    double sum = 0, count = 0;
    for (float& value : values[m]) {
      if (std::isnan(value)) {
        value = kNoSky;
        continue;
      }
      if (degrees) value *= static_cast<float>(180 / std::numbers::pi);
      sum += static_cast<double>(value), ++count;
    }
    map.bands.push_back({text.name, text.unit, std::span<const float>(values[m]), static_cast<double>(kNoSky)});
    means += fmt::format("{}mean {} {:.4g}", means.empty() ? "" : ", ", text.name, count > 0 ? sum / count : 0);
  }
  write_raster_map(options.output, map, terminal_progress("write"));
  if (preview) preview->write(map, rows, "grey");
  print_map_summary(input, options.raster_output, area, options.output,
                    fmt::format("{}; {}", means, input.curvature_text()), begin);
}

}  // namespace

void add_skyview(Program& program) {
  Command& command = program.add("skyview", "Map how much sky each pixel of an elevation model sees");
  const auto options = std::make_shared<SkyviewOptions>();
  SkyviewOptions& o = *options;
  std::vector<std::string> names;
  for (const MeasureText& measure : kMeasures) names.emplace_back(measure.name);
  command.add(&o.measures, {.names = "--measure",
                            .value = "NAME",
                            .help = "what to map",
                            .choices = names,
                            .closed = true,
                            .note = "repeatable: one band each",
                            .repeats = true,
                            .fallback = kMeasures[0].name,
                            .common = true});
  command.add(
      &o.azimuths,
      {.names = "--azimuths", .help = "number of directions, equally spaced", .range = {1, 3600}, .common = true});
  add_output_option(command, o.output, "raster to write", "tif tiff img asc");
  add_horizon_options(command, o.horizon, o.curvature);
  add_raster_output_options(command, o.raster_output);
  add_map_options(command, o);
  command.footer(kSkyFooter);
  command.example("scarp skyview dem.tif -o sky.tif");
  command.example("scarp skyview dem.tif --measure sky-view-factor --measure positive-openness -o sky.tif");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
