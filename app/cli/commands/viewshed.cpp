// SPDX-License-Identifier: MIT
// `scarp viewshed`: maps what one or many observers see of an elevation model.
#include "scarp/analysis/viewshed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_input.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/picture/map_preview.h"
#include "app/cli/picture/raster_output.h"
#include "app/cli/progress.h"
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/observer_count.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::cli {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kNodata = 255;
constexpr double kNoHeight = -9999;                                  // nodata of heights and angles
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();  // pixels before nodata is written
constexpr const char* kMethod =
    "exact lines of sight; ground linear at crossings of grid lines; grazing is visible (scarp viewshed)";

constexpr const char* kFooter = R"(Modes:
  visible  1 where an observer sees the target, 0 where none does (--visible-value, --hidden-value)
  count    number of observers that see the target
  dem      least height above sea at which a target is visible, metres
  ground   the same above ground: 0 where the ground itself is visible
  angle    degrees above the horizontal at which an observer sees the target, the largest of all
           observers that see it (r.viewshed of GRASS: add 90)
Pixels without a sample, or outside every observer's limits, are nodata; those of `angle` also where
the target is hidden. Visible pixels must differ from all others; others may be equal.

Flags of gdal_viewshed are taken too: -ox -oy -oz -tz -md -cc -vv -iv -ov -om -a_nodata -b -co -of
-f -q, with the output as last word.)";

struct ViewshedOptions : MapOptions {
  std::vector<std::string> observers;
  std::string observers_file, mode = "visible", azimuth, pitch;
  SightHeights heights;
  double min_distance = 0;
  std::optional<double> max_distance, nodata;
  int visible = 1, hidden = 0, out_of_range = -1;  // -1: nodata
  bool crop = false;
  RasterOutput raster_output;
};

// The place of an observer, in columns and rows of the raster.
struct Stand {
  Node node;
  ViewshedSettings settings;
  double reach;  // metres
  dvec2 at;
  std::string what;  // for messages
};

// An observer over the part of the raster that was read, with its own plane if the raster is in degrees.
struct Observer {
  Node node;
  ViewshedSettings settings;
  HeightField field;
  dvec2 at;
};

PlaceTable observer_table(const ViewshedOptions& options) {
  if (!options.observers_file.empty()) return read_places(options.observers_file, PlaceKind::points);
  if (options.observers.empty()) throw Error("no observer: give --observer X,Y or --observers FILE");
  PlaceTable table;
  for (const std::string& text : options.observers)
    table.rows.push_back({typed_height_place(text, "--observer"), {}, 0});
  return table;
}

// Compass degrees from true north to radians from grid north.
double grid_azimuth(double degrees, double grid_north) {
  const double turn = 2 * std::numbers::pi, angle = std::remainder(degrees / kDegrees - grid_north, turn);
  return angle < 0 ? angle + turn : angle;
}

void set_limits(ViewshedSettings& settings, const ViewshedOptions& options, double grid_north) {
  settings.min_distance = options.min_distance;
  settings.max_distance = options.max_distance.value_or(std::numeric_limits<double>::infinity());
  if (settings.max_distance < settings.min_distance)
    throw Error(
        fmt::format("--max-distance {}: is below --min-distance {}", settings.max_distance, settings.min_distance));
  if (!options.azimuth.empty()) {
    const auto n =
        numbers_from(options.azimuth, ',', 2, 2, "--azimuth", "FROM,TO in degrees clockwise from north, 0 to 360");
    for (const double degrees : n)
      if (!(degrees >= 0 && degrees <= 360))
        throw Error(
            fmt::format("--azimuth '{}': expected FROM,TO in degrees clockwise from north, 0 to 360", options.azimuth));
    if (n[1] - n[0] < 360) {
      settings.first_azimuth = grid_azimuth(n[0], grid_north);
      settings.last_azimuth = grid_azimuth(n[1], grid_north);
    }
  }
  if (!options.pitch.empty()) {
    const auto n = numbers_from(options.pitch, ',', 2, 2, "--pitch", "LOW,HIGH in degrees above horizontal, -90 to 90");
    if (!(n[0] >= -90 && n[0] <= n[1] && n[1] <= 90))
      throw Error(fmt::format("--pitch '{}': expected LOW,HIGH in degrees above horizontal, -90 to 90", options.pitch));
    settings.low_pitch = n[0] / kDegrees;
    settings.high_pitch = n[1] / kDegrees;
  }
}

std::vector<Stand> stands_of(MapInput& input, const ViewshedOptions& options) {
  const PlaceTable table = observer_table(options);
  std::vector<Stand> stands;
  double farthest = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const PlaceRow& row = table.rows[i];
    const std::string what = row.line > 0 ? table.where(i) : "--observer";
    const Node node = input.node_of(row.from, table.lonlat, what);
    const dvec2 snapped = input.place_of(node.col, node.row);
    ViewshedSettings settings;
    settings.curvature = input.curvature();
    settings.target_height = options.heights.target;
    if (row.from.z && options.heights.datum == "sea") {
      settings.observer_z = row.from.z;
    } else {
      settings.observer_height = row.from.z.value_or(options.heights.observer);
    }
    const double reach = options.max_distance.value_or(std::numeric_limits<double>::infinity());
    set_limits(settings, options, options.azimuth.empty() ? 0 : input.grid_north_at(node.col, node.row, reach));
    stands.push_back({node, settings, reach, snapped, what});
    // Measured in samples, which suits degrees and metres.
    const dvec2 typed = input.position_of(row.from, table.lonlat, what);
    farthest = std::max(farthest, std::hypot(typed.x - node.col, typed.y - node.row));
  }
  constexpr double kNoticed = 0.01;  // of a sample
  if (farthest > kNoticed)
    input.notes.push_back(fmt::format("observers stand on the nearest sample, up to {:.2g} samples away", farthest));
  return stands;
}

std::vector<Observer> observers_of(MapInput& input, const std::vector<Stand>& stands) {
  std::vector<Observer> observers;
  for (const Stand& one : stands) {
    const Node node = in_part(input, one.node);
    observers.push_back({node, one.settings, input.field_at(one.node.col, one.node.row, one.reach), one.at});
    try {
      if (!one.settings.observer_z)
        require_ground(input, {.col = static_cast<double>(one.node.col), .row = static_cast<double>(one.node.row)},
                       "observer");
      const Viewpoint checked(observers.back().field, node, one.settings);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", one.what, error.what()));
    }
  }
  return observers;
}

using Codes = std::vector<std::uint8_t>;

// Pixel values of `visible`.
struct PixelValues {
  int hidden, visible, out_of_range, nodata;

  std::vector<MapClass> classes() const {
    const bool one_blank = out_of_range == nodata;
    std::vector<MapClass> classes;
    if (hidden != nodata)
      classes.push_back({hidden, out_of_range == hidden ? "hidden or out of range" : "hidden", {205, 205, 205, 255}});
    classes.push_back({visible, "visible", {44, 150, 60, 255}});
    if (!one_blank && out_of_range != hidden) classes.push_back({out_of_range, "out of range", {235, 235, 235, 255}});
    const std::string blank = one_blank ? "no sample or out of range" : "no sample";
    classes.push_back({nodata, hidden == nodata ? "hidden, or " + blank : blank, {255, 255, 255, 0}});
    return classes;
  }
};

// Throws Error if the value of visible pixels would equal another value.
PixelValues pixel_values(const ViewshedOptions& options) {
  PixelValues values{options.hidden, options.visible, 0, kNodata};
  if (options.nodata) {
    if (!(*options.nodata >= 0 && *options.nodata <= 255 && *options.nodata == std::floor(*options.nodata)))
      throw Error(fmt::format("--nodata-value {:.10g}: expected a whole number from 0 to 255 for --mode visible",
                              *options.nodata));
    values.nodata = static_cast<int>(*options.nodata);
  } else {
    while (values.nodata == options.visible || values.nodata == options.hidden || values.nodata == options.out_of_range)
      --values.nodata;
  }
  values.out_of_range = options.out_of_range >= 0 ? options.out_of_range : values.nodata;
  const auto require_other = [&](int value, std::string_view option) {
    if (value == values.visible)
      throw Error(fmt::format(
          "--visible-value {0} and {1} {0}: visible pixels must differ from all others (change one)", value, option));
  };
  require_other(values.hidden, "--hidden-value");
  require_other(values.nodata, "--nodata-value");
  require_other(values.out_of_range, "--out-of-range-value");
  return values;
}

// The nodes that the observers may see: all others are out of range.
RasterWindow part_in_reach(MapInput& input, const std::vector<Stand>& stands) {
  std::vector<RasterWindow> parts;
  for (const Stand& one : stands) parts.push_back(part_around(input, one.node, one.reach));
  return union_of(parts);
}

// The area of the map. If pixels out of range are not nodata, as holes are, all samples are read.
MapArea area_of(MapInput& input, const ViewshedOptions& options, bool marks_range, const std::vector<Stand>& stands) {
  const RasterWindow near = part_in_reach(input, stands);
  if (options.crop) return map_area(input, options.raster_output, near, near);
  const bool all = !options.raster_output.preview.empty() || marks_range;
  return map_area(input, options.raster_output, input.whole(), all ? input.whole() : near);
}

std::vector<Viewpoint> views_of(const std::vector<Observer>& observers) {
  std::vector<Viewpoint> views;
  for (const Observer& one : observers) views.emplace_back(one.field, one.node, one.settings);
  return views;
}

struct VisiblePixels {
  Codes pixels;
  std::size_t visible = 0, hidden = 0;  // number of targets within the limits
};

// Pixels of `visible`: the best visibility of a node over all observers.
VisiblePixels visible_pixels(const std::vector<Observer>& observers, const PixelValues& values, const RowBand& rows,
                             const Progress& progress) {
  VisiblePixels result;
  const auto add = [&](Seen seen) {
    const int value_of[] = {values.hidden, values.visible, values.out_of_range, values.nodata};
    result.pixels.push_back(static_cast<std::uint8_t>(value_of[static_cast<std::size_t>(seen)]));
    result.visible += seen == Seen::visible;
    result.hidden += seen == Seen::hidden;
  };
  if (observers.size() == 1) {
    const Observer& one = observers.front();
    const auto codes = viewshed_rows(one.field, one.node, one.settings, rows, progress);
    result.pixels.reserve(codes.size());
    for (const Seen code : codes) add(code);
    return result;
  }
  const auto counts = observer_count_rows(views_of(observers), rows, progress);
  result.pixels.reserve(counts.size());
  for (const std::uint16_t count : counts)
    add(count == kCountHole         ? Seen::hole
        : count == kCountOutOfRange ? Seen::out_of_range
        : count > 0                 ? Seen::visible
                                    : Seen::hidden);
  return result;
}

std::vector<std::uint16_t> counted_pixels(const std::vector<Observer>& observers, const RowBand& rows,
                                          const Progress& progress) {
  auto counts = observer_count_rows(views_of(observers), rows, progress);
  for (std::uint16_t& count : counts)
    if (count == kCountOutOfRange) count = kCountHole;
  return counts;
}

// Returns NaN for pixels without a value.
std::vector<float> least_pixels(const std::vector<Observer>& observers, HeightDatum datum, const RowBand& rows,
                                const Progress& progress) {
  std::vector<float> pixels;
  for (const Observer& one : observers) {
    const auto least = least_visible_rows(one.field, one.node, one.settings, rows, progress);
    const Viewpoint view(one.field, one.node, one.settings);
    if (pixels.empty()) pixels.assign(least.size(), kNothing);
    const int cols = one.field.cols();
    parallel_for(rows.rows(), 16, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin) * cols; i < static_cast<std::size_t>(end) * cols; ++i) {
        const Node node{static_cast<int>(i % cols), rows.first + static_cast<int>(i / cols)};
        const float height = least_height(view.ground(), node, least[i], datum);
        pixels[i] = std::fmin(pixels[i], height);  // replaces NaN
      }
    });
  }
  return pixels;
}

// The same for angles.
std::vector<float> angle_pixels(const std::vector<Observer>& observers, const RowBand& rows, const Progress& progress) {
  std::vector<float> pixels;
  for (const Observer& one : observers) {
    const auto codes = viewshed_rows(one.field, one.node, one.settings, rows, progress);
    const auto angles = sight_angles(Viewpoint(one.field, one.node, one.settings), codes, rows.first);
    if (pixels.empty()) pixels.assign(angles.size(), kNothing);
    for (std::size_t i = 0; i < angles.size(); ++i) pixels[i] = std::fmax(pixels[i], angles[i]);  // replaces NaN
  }
  return pixels;
}

// Replaces NaN by nodata, and returns the number of replacements. Throws Error if a valid pixel has that value.
std::size_t mark_nothing(std::vector<float>& pixels, double written) {
  const auto nodata = static_cast<float>(written);
  std::size_t count = 0;
  for (float& pixel : pixels) {
    if (pixel == nodata)
      throw Error(fmt::format("--nodata-value {:.10g}: is also a value of the map (choose another)", written));
    if (!std::isnan(pixel)) continue;
    pixel = nodata;
    ++count;
  }
  return count;
}

std::string mode_of(const std::string& typed) {
  // As in gdal_viewshed.
  if (typed == "NORMAL") return "visible";
  if (typed == "DEM") return "dem";
  if (typed == "GROUND") return "ground";
  if (typed == "ACCUM") return "count";
  return typed;
}

double share_of(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

void run(ViewshedOptions options, const Command& command) {
  command.require_effect({});
  options.mode = mode_of(options.mode);
  const std::optional<PixelValues> values =
      options.mode == "visible" ? std::optional(pixel_values(options)) : std::nullopt;
  settle_output(options.raster_output, options, values ? "Byte" : options.mode == "count" ? "UInt16" : "Float32");
  const ThreadLimit limit(options.threads);
  const auto begin = std::chrono::steady_clock::now();
  MapInput input(options);
  keep_inputs(options.output, input.files());
  const double number_nodata = options.nodata.value_or(kNoHeight);
  const std::vector<Stand> stands = stands_of(input, options);
  const MapArea area = area_of(input, options, values && values->out_of_range != values->nodata, stands);
  if (options.raster_output.dry_run) {
    // Time per node of one sweep per observer, on one thread.
    constexpr double kNode_s = 6e-8;
    print_dry_run(input, area, options.output, options.mode == "visible" || options.mode == "count" ? 3 : 12,
                  static_cast<double>(stands.size()) * area.computed.cols * area.computed.rows * kNode_s);
    return;
  }
  input.read(area.read, terminal_progress("read"));
  input.close();
  const std::vector<Observer> observers = observers_of(input, stands);
  const RowBand rows = area.rows();
  std::optional<MapPreview> preview;
  if (!options.raster_output.preview.empty()) preview.emplace(options.raster_output.preview, input);
  std::string places;
  for (const Observer& one : observers) {
    constexpr std::size_t kListed = 20;
    if (&one - observers.data() >= static_cast<std::ptrdiff_t>(kListed)) {
      places += "; ...";
      break;
    }
    places +=
        fmt::format("{}{:.10g},{:.10g} {}", places.empty() ? "" : "; ", one.at.x, one.at.y,
                    one.settings.observer_z ? fmt::format("{:.10g} m above sea", *one.settings.observer_z)
                                            : fmt::format("{:.10g} m above ground", one.settings.observer_height));
  }
  const SightCurvature curvature = input.curvature();
  RasterMap map = map_of(input, options.raster_output, area, kMethod,
                         {{"MODE", options.mode},
                          {"OBSERVERS", places},
                          {"TARGET_HEIGHT", fmt::format("{:.10g} m above ground", options.heights.target)},
                          {"CURVATURE_COEFFICIENT", fmt::format("{:.10g}", curvature.coefficient)},
                          {"DIAMETER", fmt::format("{:.10g} m", curvature.diameter)}});
  const Progress progress = terminal_progress("viewshed");
  VisiblePixels seen;
  std::vector<std::uint16_t> counts;
  std::vector<float> numbers;
  std::string what;
  if (values) {
    if (rows.rows() > 0) seen = visible_pixels(observers, *values, rows, progress);
    map.bands.push_back({"visible", "", std::span<const std::uint8_t>(seen.pixels), values->nodata, values->classes()});
    what = fmt::format("{:.3g} % visible",
                       share_of(static_cast<double>(seen.visible), static_cast<double>(seen.visible + seen.hidden)));
  } else if (options.mode == "count") {
    if (rows.rows() > 0) counts = counted_pixels(observers, rows, progress);
    map.bands.push_back({"observers that see the pixel", "", std::span<const std::uint16_t>(counts), kCountHole});
    what = fmt::format("{} observers", observers.size());
  } else if (options.mode == "angle") {
    if (rows.rows() > 0) numbers = angle_pixels(observers, rows, progress);
    const std::size_t hidden = mark_nothing(numbers, number_nodata);
    map.bands.push_back({"angle above horizontal", "degrees", std::span<const float>(numbers), number_nodata});
    what = fmt::format("{:.3g} % visible", share_of(static_cast<double>(numbers.size() - hidden),
                                                    static_cast<double>(map.cols) * map.rows));
  } else {
    const bool dem = options.mode == "dem";
    if (rows.rows() > 0)
      numbers = least_pixels(observers, dem ? HeightDatum::sea : HeightDatum::ground, rows, progress);
    mark_nothing(numbers, number_nodata);
    map.bands.push_back({dem ? "least visible height above sea" : "least visible height above ground", "m",
                         std::span<const float>(numbers), number_nodata});
    what = "least visible heights";
  }
  write_raster_map(options.output, map, terminal_progress("write"));
  if (preview) preview->write(map, rows, "viridis");
  print_map_summary(input, options.raster_output, area, options.output,
                    fmt::format("{}; {}", what, input.curvature_text()), begin);
}

}  // namespace

void add_viewshed(Program& program) {
  Command& command = program.add("viewshed", "Map what observers see of an elevation model");
  const auto options = std::make_shared<ViewshedOptions>();
  ViewshedOptions& o = *options;
  command.add(&o.observers, {.names = "--observer",
                             .value = "X,Y[,H]",
                             .help = "observer",
                             .note = "repeatable",
                             .repeats = true,
                             .common = true});
  command.add(&o.observers_file, {.names = "--observers",
                                  .value = "FILE",
                                  .help = "observers: CSV (x,y[,z]) or a vector file of points",
                                  .files = "csv geojson gpkg shp",
                                  .note = "-: CSV from standard input",
                                  .common = true,
                                  .excludes = {"--observer"}});
  add_output_option(command, o.output, "raster to write", "tif tiff img asc");
  command.add(&o.mode, {.names = "--mode",
                        .value = "MODE",
                        .help = "content of pixels",
                        .choices = {"visible", "count", "dem", "ground", "angle", "NORMAL", "ACCUM", "DEM", "GROUND"},
                        .closed = true,
                        .common = true});
  add_sight_heights(command, o.heights);
  command.add(&o.max_distance, {.names = "--max-distance",
                                .help = "maximum distance of targets",
                                .unit = "metres",
                                .range = {0, kMostOfGround},
                                .fallback = "unlimited",
                                .common = true});
  command.add(&o.min_distance, {.names = "--min-distance",
                                .help = "minimum distance of targets",
                                .unit = "metres",
                                .range = {0, kMostOfGround},
                                .common = true});
  command.add(&o.azimuth, {.names = "--azimuth",
                           .value = "FROM,TO",
                           .help = "field of view in degrees clockwise from true north",
                           .fallback = "all around",
                           .common = true});
  command.add(&o.pitch, {.names = "--pitch",
                         .value = "LOW,HIGH",
                         .help = "field of view in degrees above horizontal",
                         .fallback = "-90,90",
                         .common = true});
  command.add(&o.crop, {.names = "--crop",
                        .help = "write only the pixels within --max-distance, not the extent of the input",
                        .common = true,
                        .rules = {needs("--max-distance M", [&o] { return o.max_distance.has_value(); })}});
  add_curvature_option(command, o.curvature);
  const Rule codes = needs("--mode visible", [&o] { return mode_of(o.mode) == "visible"; });
  command.add(
      &o.visible,
      {.names = "--visible-value", .help = "pixel value of visible targets", .range = {0, 255}, .rules = {codes}});
  command.add(
      &o.hidden,
      {.names = "--hidden-value", .help = "pixel value of hidden targets", .range = {0, 255}, .rules = {codes}});
  command.add(&o.out_of_range, {.names = "--out-of-range-value",
                                .help = "pixel value outside the limits",
                                .range = {0, 255},
                                .fallback = "nodata",
                                .rules = {codes}});
  const Rule marked = needs("--mode visible, dem, ground or angle", [&o] { return mode_of(o.mode) != "count"; });
  command.add(&o.nodata, {.names = "--nodata-value",
                          .help = "pixel value without a sample",
                          .range = {-1e30, 1e30},
                          .fallback = "255, or the largest value left; heights and angles: -9999",
                          .rules = {marked}});
  add_raster_output_options(command, o.raster_output);
  add_map_options(command, o);
  command.footer(kFooter);
  command.example("scarp viewshed dem.tif --observer 692000,5143000,2 -o seen.tif");
  command.example("scarp viewshed dem.tif --observers towers.csv --mode count -o count.tif");
  command.example("scarp viewshed -ox 692000 -oy 5143000 -md 20000 dem.tif seen.tif");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
