// SPDX-License-Identifier: MIT
// `scarp skyview`: maps how much sky each pixel of an elevation model sees.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/horizon_frames.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/picture/map_run.h"
#include "app/cli/progress.h"
#include "scarp/analysis/sky_view.h"

namespace scarp::cli {
namespace {

constexpr const char* kSkyMethod =
    "; ground linear at crossings of grid lines; directions equally spaced (scarp skyview)";

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
An infinite plane with a slope of 45 degrees gives 0.75, 0.854, 90 and 90.)";

struct SkyviewOptions : MapCommand {
  std::vector<std::string> measures;
  int azimuths = 64;
  HorizonInput horizon;
};

// The mean of the pixels that are not holes.
struct Mean {
  double sum = 0, count = 0;

  void add(std::span<const float> pixels) {
    for (const float pixel : pixels)
      if (!std::isnan(pixel)) sum += static_cast<double>(pixel), ++count;
  }
  double value() const { return count > 0 ? sum / count : 0; }
};

const MeasureText& measure_of(const std::string& name) {
  return *std::find_if(std::begin(kMeasures), std::end(kMeasures),
                       [&](const MeasureText& m) { return m.name == name; });
}

void run(SkyviewOptions options, const Command& command) {
  if (options.measures.empty()) options.measures.emplace_back(kMeasures[0].name);
  MapRun run(options, command, "Float32");
  // All azimuths count alike, from whatever north.
  const HorizonFrames frames(run.input(), options.horizon, options.plane_error, FrameUse::lengths);
  run.set_reach(options.horizon.reach());
  if (!run.begin(13 + 8 * static_cast<double>(options.measures.size()),
                 options.azimuths * options.horizon.node_azimuth_s()))
    return;
  options.horizon.memory = run.working_memory();
  MapInput& input = run.input();
  std::vector<SkyMeasure> measures;
  Metadata metadata = horizon_metadata(options.horizon, input);
  for (auto& pair : frames.metadata()) metadata.push_back(std::move(pair));
  metadata.emplace_back("AZIMUTHS", fmt::format("{}", options.azimuths));
  for (const std::string& name : options.measures) {
    measures.push_back(measure_of(name).measure);
    metadata.emplace_back("FORMULA " + name, measure_of(name).formula);
  }
  std::vector<Mean> means(measures.size());
  std::optional<SkyView> sky;
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    if (!sky)
      sky.emplace(input.field(), horizon_settings(options.horizon, input), options.azimuths, measures,
                  terminal_progress("heights"));
    std::vector<std::vector<float>> values(measures.size());
    const int cols = input.part().cols;
    for (auto& pixels : values) pixels.resize(static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(cols));
    const auto add = [&](const HorizonFrame& block, const Progress& of_block) {
      const auto found = sky->with_cells(block.cells.x, block.cells.y).block(block.nodes, of_block);
      for (std::size_t m = 0; m < values.size(); ++m) paste(found[m], block, rows, cols, values[m]);
    };
    for_each_frame(frames.of(input, rows), add, progress);
    std::vector<ComputedBand> bands;
    for (std::size_t m = 0; m < values.size(); ++m) {
      const MeasureText& text = measure_of(options.measures[m]);
      if (*text.unit != 0)
        for (float& value : values[m]) value *= static_cast<float>(kDegreesPerRadian);
      means[m].add(values[m]);
      bands.push_back(number_band(text.name, text.unit, std::move(values[m])));
    }
    return bands;
  };
  const auto summary = [&] {
    std::string text;
    for (std::size_t m = 0; m < means.size(); ++m)
      text += fmt::format("{}mean {} {:.4g}", m == 0 ? "" : ", ", options.measures[m], means[m].value());
    std::vector<double> azimuths;
    for (int i = 0; i < options.azimuths; ++i) azimuths.push_back(2 * std::numbers::pi * i / options.azimuths);
    const std::string errors = horizon_errors_text(options.horizon, input, azimuths, run.rows());
    return fmt::format("{}; {}{}", text, input.curvature_text(), errors);
  };
  std::vector<double*> totals;
  for (Mean& mean : means) totals.insert(totals.end(), {&mean.sum, &mean.count});
  run.write({horizon_method(options.horizon) + kSkyMethod, metadata, "grey", compute, summary, totals,
             !options.horizon.swept(), rows_of_strip(options.horizon, input)});
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
                            .help = "quantity to map",
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
  add_map_command(command, o, [options, &command] { run(*options, command); });
  command.footer(kSkyFooter);
  command.example("scarp skyview dem.tif -o sky.tif");
  command.example("scarp skyview dem.tif --measure sky-view-factor --measure positive-openness -o sky.tif");
}

}  // namespace scarp::cli
