// SPDX-License-Identifier: MIT
// `scarp horizon`: elevation angles of the horizon, for all pixels of an elevation model or at points.
#include "scarp/analysis/horizon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/horizon_options.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_input.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/picture/map_run.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/source/table/place_table.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

constexpr int kMapAzimuths = 16, kPointAzimuths = 360;
constexpr const char* kHorizonMethod = "exact horizons; ground linear at crossings of grid lines (scarp horizon)";
constexpr const char* kHorizonFooter =
    R"(Pixels: degrees above the horizontal up to which ground hides the sky, one band per azimuth. Angles
below zero are kept (--clamp: 0 instead). -90: no ground in that direction, as at the border.
With --at or --points the output is CSV: point, horizon_azimuth, horizon_elevation (degrees) and
distance (metres to the ground that is the horizon; empty: no ground). pvlib takes the middle two.)";

struct HorizonOptions : MapCommand {
  std::optional<int> azimuths;
  double first_azimuth = 0;
  HorizonInput horizon;
  std::vector<std::string> at;
  std::string points;
  bool clamp = false, distance = false;
};

bool asks_points(const HorizonOptions& options) { return !options.at.empty() || !options.points.empty(); }

// Degrees clockwise from true north.
std::vector<double> azimuths_of(const HorizonOptions& options) {
  const int count = options.azimuths.value_or(asks_points(options) ? kPointAzimuths : kMapAzimuths);
  std::vector<double> azimuths;
  for (int i = 0; i < count; ++i) azimuths.push_back(std::fmod(options.first_azimuth + 360.0 * i / count, 360.0));
  return azimuths;
}

PlaceTable points_of(const HorizonOptions& options) {
  if (!options.points.empty()) return read_places(options.points, PlaceKind::points);
  PlaceTable table;
  for (const std::string& text : options.at) table.rows.push_back({typed_height_place(text, "--at"), {}, 0});
  return table;
}

void run_points(const HorizonOptions& options, MapInput& input) {
  const PlaceTable table = points_of(options);
  std::string text = "point,horizon_azimuth,horizon_elevation,distance\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const PlaceRow& row = table.rows[i];
    const std::string what = row.line > 0 ? table.where(i) : "--at";
    const dvec2 at = input.grid_of(row.from, table.lonlat, what);
    HorizonSettings settings = horizon_settings(options.horizon, input);
    settings.eye_height = row.from.z.value_or(settings.eye_height);
    if (settings.eye_height < 0)
      throw Error(
          fmt::format("{}: height {:.10g}: expected at least 0 metres above the ground", what, settings.eye_height));
    // Only ground within the distance matters, and one cell beyond it: the last crossings lie between samples.
    const Node node{static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))};
    const dvec2 cell = input.cells_at(at.x, at.y, settings.max_distance);
    const RasterWindow part = part_around(input, node, settings.max_distance + 2 * std::max(cell.x, cell.y));
    if (part != input.part() || input.field().rows() == 0) input.read(part, terminal_progress("read"));
    const HeightField field = input.field_at(at.x, at.y, settings.max_distance);
    const SightEnd local = in_part(input, SightEnd{at.x, at.y});
    const double grid_north = input.grid_north_at(at.x, at.y, settings.max_distance);
    for (const double azimuth : azimuths_of(options)) {
      const auto view = horizon_from(field, local.col, local.row, azimuth / kDegreesPerRadian - grid_north, settings);
      if (!view) throw Error(fmt::format("{}: there is no sample under the point", what));
      const double angle = options.clamp ? std::max(view->angle, 0.0) : view->angle;
      text += fmt::format("{},{:.10g},{:.6f},{}\n", i + 1, azimuth, angle * kDegreesPerRadian,
                          view->distance ? fmt::format("{:.10g}", *view->distance) : "");
    }
  }
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_whole_file(options.output, text);
    fmt::print("{}: {} points; {}\n", options.output, table.rows.size(), input.curvature_text());
  }
  for (const std::string& note : input.notes) fmt::print(stderr, "note: {}\n", note);
}

void run_map(HorizonOptions& options, const Command& command) {
  if (options.output.empty()) throw WrongUsage("-o FILE is required (see 'scarp horizon --help')");
  MapRun run(options, command, "Float32");
  const std::vector<double> azimuths = azimuths_of(options);
  const auto count = static_cast<double>(azimuths.size());
  if (!run.begin(13 + 4 * count * (options.distance ? 2 : 1), count * kNodeAzimuth_s)) return;
  MapInput& input = run.input();
  double highest = -90;
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    const HorizonPlane plane = horizon_plane(input);
    const Horizons horizons(plane.field, horizon_settings(options.horizon, input), progress);
    std::vector<ComputedBand> bands, distances;
    for (const double azimuth : azimuths) {
      HorizonRows found = horizons.rows(azimuth / kDegreesPerRadian - plane.grid_north, rows.first, rows.last,
                                        options.distance, progress);
      for (float& angle : found.angle) {
        angle = options.clamp && angle < 0 ? 0 : static_cast<float>(static_cast<double>(angle) * kDegreesPerRadian);
        highest = std::fmax(highest, static_cast<double>(angle));
      }
      bands.push_back(number_band(fmt::format("horizon {:.10g}", azimuth), "degrees", std::move(found.angle)));
      if (options.distance)
        distances.push_back(number_band(fmt::format("distance {:.10g}", azimuth), "m", std::move(found.distance)));
    }
    std::move(distances.begin(), distances.end(), std::back_inserter(bands));
    return bands;
  };
  const auto summary = [&] {
    return fmt::format("{} azimuths, highest {:.4g} degrees; {}", azimuths.size(), highest, input.curvature_text());
  };
  run.write({kHorizonMethod, horizon_metadata(options.horizon, input), "viridis", compute, summary});
}

void run(HorizonOptions options, const Command& command) {
  if (!asks_points(options)) return run_map(options, command);
  if (options.output == "-") options.output.clear();
  if (!options.output.empty() && extension_of(options.output) != ".csv")
    throw Error(fmt::format("output '{}': expected .csv with --at or --points", options.output));
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  MapInput input(options);
  keep_inputs(options.output, input.files());
  run_points(options, input);
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
                            .fallback = "16; 360 at points",
                            .common = true});
  command.add(&o.first_azimuth, {.names = "--first-azimuth",
                                 .help = "first direction, clockwise from true north",
                                 .unit = "degrees",
                                 .range = {0, 360},
                                 .common = true});
  command.add(&o.at, {.names = "--at",
                      .value = "X,Y[,H]",
                      .help = "point, with the height of the eye above the ground",
                      .note = "repeatable",
                      .repeats = true,
                      .common = true});
  command.add(&o.points, {.names = "--points",
                          .value = "FILE",
                          .help = "points: CSV (x,y[,z]) or a vector file of points",
                          .files = "csv geojson gpkg shp",
                          .note = "-: CSV from standard input",
                          .common = true,
                          .excludes = {"--at"}});
  add_output_option(command, o.output, "raster to write, or with points .csv (-: standard output)",
                    "tif tiff img asc csv", false);
  command.add(&o.clamp, {.names = "--clamp", .help = "0 instead of angles below the horizontal", .common = true});
  command.add(&o.distance, {.names = "--distance",
                            .help = "bands of the distance to the ground that is the horizon, too",
                            .common = true,
                            .excludes = point_options});
  add_horizon_options(command, o.horizon, o.curvature);
  add_map_coordinates_option(command, o.coordinates, {needs("--at or --points", [&o] { return asks_points(o); })});
  add_map_command(
      command, o, [options, &command] { run(*options, command); }, point_options);
  command.footer(kHorizonFooter);
  command.example("scarp horizon dem.tif --azimuths 36 -o horizon.tif");
  command.example("scarp horizon dem.tif --at 692000,5143000,2 -o skyline.csv");
}

}  // namespace scarp::cli
