// SPDX-License-Identifier: MIT
// `scarp horizon`: elevation angles of the horizon, for all pixels of an elevation model or at points.
#include "scarp/analysis/horizon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/horizon_points.h"
#include "app/cli/options/horizon_frames.h"
#include "app/cli/options/plot_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/progress.h"
#include "scarp/base/progress_part.h"

namespace scarp::cli {
namespace {

constexpr const char* kHorizonMethod = "; ground linear at crossings of grid lines (scarp horizon)";
constexpr const char* kHorizonFooter =
    R"(Pixels: degrees above the horizontal up to which ground hides the sky, one band per azimuth. Angles
below zero are kept (--clamp: 0 instead). -90: no ground in that direction, as at the border.
With --at or --points the output is CSV: point, horizon_azimuth, horizon_elevation (degrees) and
distance (metres to the ground that is the horizon; empty: no ground). pvlib takes the middle two.
With --skip-bad also status: ok, invalid, outside or nodata.
With --at and a .svg, .pdf or .png output, a picture of the skyline.)";

// Angles in steps of 0.003 degrees from -90 on: 0 is a step, and 180 degrees fit into 16 bits with room for nodata.
ComputedBand packed_band(std::string name, const std::vector<float>& degrees) {
  constexpr double kPackedStep = 0.003, kPackedFirst = -90;
  constexpr std::uint16_t kPackedHole = 65535;
  std::vector<std::uint16_t> pixels(degrees.size());
  std::transform(degrees.begin(), degrees.end(), pixels.begin(), [&](float angle) {
    return std::isnan(angle)
               ? kPackedHole
               : static_cast<std::uint16_t>(std::lround((static_cast<double>(angle) - kPackedFirst) / kPackedStep));
  });
  return {std::move(name), "degrees", std::move(pixels), kPackedHole, {}, kPackedStep, kPackedFirst};
}

// The farthest horizon of each pixel over the azimuths so far.
class FarthestHorizon {
 public:
  void add(const std::vector<float>& distances, double azimuth) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    if (distance_.empty()) distance_.assign(distances.size(), kNone), azimuth_.assign(distances.size(), kNone);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      // The first wins; NaN is none.
      if (!(distances[i] > distance_[i]) && !(std::isnan(distance_[i]) && !std::isnan(distances[i]))) continue;
      distance_[i] = distances[i], azimuth_[i] = static_cast<float>(azimuth);
    }
  }
  void add_bands(std::vector<ComputedBand>& bands) {
    bands.push_back(number_band("farthest distance", "m", std::move(distance_)));
    bands.push_back(number_band("farthest azimuth", "degrees", std::move(azimuth_)));
  }

 private:
  std::vector<float> distance_, azimuth_;
};

// The rows of all blocks. `azimuth`: radians clockwise from true north.
HorizonRows rows_of(const Horizons& horizons, const std::vector<HorizonFrame>& blocks, double azimuth,
                    const RowBand& rows, int cols, bool distances, const Progress& progress) {
  HorizonRows all;
  const auto pixels = static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(cols);
  all.angle.resize(pixels), all.distance.resize(distances ? pixels : 0);
  const auto add = [&](const HorizonFrame& block, const Progress& of_block) {
    const HorizonRows found = horizons.with_cells(block.cells.x, block.cells.y)
                                  .block(azimuth - block.grid_north, block.nodes, distances, of_block);
    paste(found.angle, block, rows, cols, all.angle);
    if (distances) paste(found.distance, block, rows, cols, all.distance);
  };
  for_each_frame(blocks, add, progress);
  return all;
}

void run(HorizonOptions options, const Command& command) {
  if (options.at_points()) return write_point_horizons(options);
  if (options.output.empty()) throw WrongUsage("-o FILE is required (see 'scarp horizon --help')");
  MapRun run(options, command, options.pack ? "UInt16" : "Float32");
  const std::vector<double> azimuths = options.all_azimuths();
  const auto count = static_cast<double>(azimuths.size());
  const HorizonFrames frames(run.input(), options.horizon, options.plane_error, FrameUse::north);
  run.set_reach(options.horizon.reach());
  const double bytes = (options.pack ? 2 : 4) * count * (options.distance ? 2 : 1) + (options.farthest ? 8 : 0);
  if (!run.begin(13 + bytes, count * options.horizon.node_azimuth_s())) return;
  options.horizon.memory = run.working_memory();
  MapInput& input = run.input();
  double highest = -90;
  std::optional<Horizons> horizons;
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    if (!horizons)
      horizons.emplace(input.field(), horizon_settings(options.horizon, input), terminal_progress("heights"));
    const std::vector<HorizonFrame> blocks = frames.of(input, rows);
    std::vector<ComputedBand> bands, distances;
    FarthestHorizon farthest;
    for (std::size_t i = 0; i < azimuths.size(); ++i) {
      const double azimuth = azimuths[i];
      HorizonRows found =
          rows_of(*horizons, blocks, azimuth / kDegreesPerRadian, rows, input.part().cols,
                  options.distance || options.farthest, progress_part(progress, static_cast<double>(i), count));
      for (float& angle : found.angle) {
        angle = options.clamp && angle < 0 ? 0 : static_cast<float>(static_cast<double>(angle) * kDegreesPerRadian);
        highest = std::fmax(highest, static_cast<double>(angle));
      }
      const std::string name = fmt::format("horizon {:.10g}", azimuth);
      bands.push_back(options.pack ? packed_band(name, found.angle)
                                   : number_band(name, "degrees", std::move(found.angle)));
      if (options.farthest) farthest.add(found.distance, azimuth);
      if (options.distance)
        distances.push_back(number_band(fmt::format("distance {:.10g}", azimuth), "m", std::move(found.distance)));
    }
    std::move(distances.begin(), distances.end(), std::back_inserter(bands));
    if (options.farthest) farthest.add_bands(bands);
    return bands;
  };
  const auto summary = [&] {
    std::vector<double> directions;
    for (const double azimuth : azimuths) directions.push_back(azimuth / kDegreesPerRadian);
    const std::string errors = horizon_errors_text(options.horizon, input, directions, run.rows());
    return fmt::format("{} azimuths, highest {:.4g} degrees; {}{}", azimuths.size(), highest, input.curvature_text(),
                       errors);
  };
  Metadata metadata = horizon_metadata(options.horizon, input);
  for (auto& pair : frames.metadata()) metadata.push_back(std::move(pair));
  metadata.emplace_back("CLAMP", options.clamp ? "0 instead of angles below the horizontal" : "none");
  run.write({horizon_method(options.horizon) + kHorizonMethod,
             metadata,
             "viridis",
             compute,
             summary,
             {&highest},
             !options.horizon.swept(),
             rows_of_strip(options.horizon, input)});
}

}  // namespace

void add_horizon(Program& program) {
  Command& command = program.add("horizon", "Find the horizon of each pixel of an elevation model, or of points");
  const auto options = std::make_shared<HorizonOptions>();
  HorizonOptions& o = *options;
  // With these, the output is a table.
  const std::vector<std::string> point_options{"--at", "--points"};
  command.add(&o.azimuths, {.names = "--azimuths",
                            .help = "number of directions, equally spaced",
                            .range = {1, 3600},
                            .fallback = "16; at points 360, in figures 1440",
                            .common = true});
  command.add(&o.first_azimuth, {.names = "--first-azimuth",
                                 .help = "first direction, clockwise from true north",
                                 .unit = "degrees",
                                 .range = {-360, 360},
                                 .common = true});
  command.add(&o.at, {.names = "--at",
                      .value = "X,Y[,H]",
                      .help = "point, with the height of the eye above the ground",
                      .note = "repeatable",
                      .repeats = true,
                      .common = true});
  add_points_option(command, o.points);
  const Rule of_skylines =
      needs("--at X,Y and a .svg, .pdf or .png output", [&o] { return o.at_points() && is_figure(o.output); });
  command.add(&o.labels, {.names = "--labels",
                          .value = "FILE",
                          .help = "points with names for the skyline: CSV (name,x,y[,z]) or a vector file of points",
                          .files = "csv geojson gpkg shp",
                          .note = "names of points that the ground hides are omitted",
                          .fallback = "none",
                          .common = true,
                          .rules = {of_skylines}});
  add_output_option(command, o.output, "map, or with --at or --points a .csv table or a .svg, .pdf or .png skyline",
                    "tif tiff img asc csv svg pdf png", "points: standard output");
  add_plot_size_option(command, o.size, "1200x480", of_skylines);
  command.add(&o.clamp,
              {.names = "--clamp",
               .help = "0 instead of angles below the horizontal",
               .common = true,
               .rules = {needs("a map or a table", [&o] { return !o.at_points() || !is_figure(o.output); })}});
  command.add(&o.distance, {.names = "--distance",
                            .help = "additional bands: distance to the horizon, in metres",
                            .common = true,
                            .excludes = point_options});
  command.add(&o.farthest,
              {.names = "--farthest",
               .help = "2 additional bands: distance of the farthest horizon over all azimuths, its azimuth",
               .common = true,
               .excludes = point_options});
  command.add(&o.pack, {.names = "--pack",
                        .help = "angles in 16 bits instead of 32, in steps of 0.003 degrees",
                        .note = "UInt16 with scale and offset, 65535: nodata",
                        .common = true,
                        .excludes = {"--at", "--points", "--distance", "--farthest"}});
  add_horizon_options(command, o.horizon, o.curvature, point_options);
  add_map_coordinates_option(command, o.coordinates, {needs("--at or --points", [&o] { return o.at_points(); })});
  add_map_command(
      command, o, [options, &command] { run(*options, command); }, point_options);
  command.footer(kHorizonFooter);
  command.example("scarp horizon dem.tif --azimuths 36 -o horizon.tif");
  command.example("scarp horizon dem.tif --at 692000,5143000,2 -o skyline.csv");
  command.example("scarp horizon dem.tif --at 692000,5143000,2 --labels peaks.csv -o skyline.svg");
}

}  // namespace scarp::cli
