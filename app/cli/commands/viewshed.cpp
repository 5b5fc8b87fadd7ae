// SPDX-License-Identifier: MIT
// `scarp viewshed`: maps what one or many observers see of an elevation model.
#include "scarp/analysis/viewshed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/viewshed_bands.h"
#include "app/cli/commands/viewshed_stations.h"
#include "app/cli/commands/viewshed_summary.h"
#include "app/cli/options/bare_ground.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/observer_columns.h"
#include "app/cli/options/path_file.h"
#include "app/cli/options/place_file.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/picture/map_identity.h"
#include "app/cli/picture/map_run.h"
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/observer_count.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"
#include "scarp/base/replace_file.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

constexpr int kNodata = 255;
constexpr const char* kMethod =
    "exact lines of sight; ground linear at crossings of grid lines; grazing is visible (scarp viewshed)";

constexpr const char* kFooter = R"(Modes:
  visible  1 where an observer sees the target, 0 where none does (--visible-value, --hidden-value)
  count    number of observers that see the target
  dem      least height above sea at which a target is visible, metres
  ground   the same above ground: 0 where the ground itself is visible
  angle    degrees above the horizontal at which an observer sees the target, the largest of all
           observers that see it (r.viewshed of GRASS: add 90)
  height   metres of a target of --target-height that are visible, summed over all observers
  fresnel  share of the first Fresnel zone that is clear, at most 1, negative where the target is
           hidden; the largest of all observers. One line per pixel: slow
Pixels without a sample, or outside every observer's limits, are nodata; those of `angle` also where
the target is hidden. Visible pixels must differ from all others; others may be equal.

Flags of gdal_viewshed are taken too: -ox -oy -oz -tz -md -cc -vv -iv -ov -om -a_nodata -b -co -of
-f -q, with the output as last word.)";

struct ViewshedOptions : MapCommand {
  std::vector<std::string> observers;
  PlaceFile observers_file;
  std::optional<double> spacing;  // metres; the file holds lines or polygons
  std::string mode = "visible", azimuth, pitch, summary, each;
  SightHeights heights;
  std::string bare_ground;
  std::optional<double> frequency;  // megahertz
  double min_distance = 0;
  std::optional<double> max_distance, nodata;
  int visible = 1, hidden = 0, out_of_range = -1;  // -1: nodata
  bool crop = false;
};

// The place of an observer, in columns and rows of the raster.
struct Stand {
  Node node;
  ViewshedSettings settings;
  double reach;  // metres
  dvec2 at;
  std::string what;  // for messages
  std::string name;  // empty: none
  std::size_t row;   // of the table of observers

  // For bands and marks.
  std::string title(std::size_t observers) const {
    return !name.empty() ? name : observers == 1 ? "observer" : fmt::format("observer {}", row + 1);
  }
};

PlaceTable observer_table(const ViewshedOptions& options) {
  if (options.spacing) return read_paths(options.observers_file, PlaceKind::paths);
  if (!options.observers_file.path.empty()) return options.observers_file.read(PlaceKind::points);
  if (options.observers.empty()) throw Error("no observer: give --observer X,Y or --observers FILE");
  PlaceTable table;
  for (const std::string& text : options.observers)
    table.rows.push_back({typed_height_place(text, "--observer"), {}, 0});
  return table;
}

// Metres; infinity: unlimited.
double reach_of(const ViewshedOptions& options, const ObserverColumns& columns, std::size_t row) {
  const auto typed = options.max_distance.value_or(std::numeric_limits<double>::infinity());
  return columns.number(row, ObserverColumn::max_distance).value_or(typed);
}

// Compass degrees from true north to radians from grid north.
double grid_azimuth(double degrees, double grid_north) {
  const double turn = 2 * std::numbers::pi, angle = std::remainder(degrees / kDegreesPerRadian - grid_north, turn);
  return angle < 0 ? angle + turn : angle;
}

// Two numbers of an option, low to high with `ordered`.
dvec2 typed_range(const std::string& text, std::string_view option, std::string_view form, double most, bool ordered) {
  const auto n = numbers_from(text, ',', 2, 2, option, form);
  if (!(std::abs(n[0]) <= most && std::abs(n[1]) <= most) || (ordered && n[0] > n[1]))
    throw Error(fmt::format("{} '{}': expected {}", option, text, form));
  return {n[0], n[1]};
}

// The limits of one observer: those of its row, else of the options. `grid_north` is called if azimuths matter.
void set_limits(ViewshedSettings& settings, const ViewshedOptions& options, const ObserverColumns& columns,
                std::size_t row, const std::function<double()>& grid_north) {
  const auto number = [&](ObserverColumn column) { return columns.number(row, column); };
  settings.min_distance = number(ObserverColumn::min_distance).value_or(options.min_distance);
  settings.max_distance = reach_of(options, columns, row);
  if (settings.max_distance < settings.min_distance)
    throw Error(
        fmt::format("--max-distance {}: is below --min-distance {}", settings.max_distance, settings.min_distance));
  dvec2 azimuths(0, 360);
  if (!options.azimuth.empty())
    azimuths =
        typed_range(options.azimuth, "--azimuth", "FROM,TO in degrees clockwise from north, -360 to 360", 360, false);
  azimuths = {number(ObserverColumn::first_azimuth).value_or(azimuths.x),
              number(ObserverColumn::last_azimuth).value_or(azimuths.y)};
  if (azimuths.y - azimuths.x < 360) {
    const double north = grid_north();
    settings.first_azimuth = grid_azimuth(azimuths.x, north);
    settings.last_azimuth = grid_azimuth(azimuths.y, north);
  }
  dvec2 pitches(-90, 90);
  if (!options.pitch.empty())
    pitches = typed_range(options.pitch, "--pitch", "LOW,HIGH in degrees above horizontal, -90 to 90", 90, true);
  pitches = {number(ObserverColumn::low_pitch).value_or(pitches.x),
             number(ObserverColumn::high_pitch).value_or(pitches.y)};
  if (!(pitches.x >= -90 && pitches.x <= pitches.y && pitches.y <= 90))
    throw Error(fmt::format("pitch from {} to {}: expected -90 to 90 degrees, the lower first", pitches.x, pitches.y));
  settings.low_pitch = pitches.x / kDegreesPerRadian;
  settings.high_pitch = pitches.y / kDegreesPerRadian;
}

// The stand of a row at a node.
Stand stand_of(MapInput& input, const ViewshedOptions& options, const PlaceTable& table, const ObserverColumns& columns,
               std::size_t i, const Node& node, std::string what) {
  ViewshedSettings settings;
  settings.curvature = input.curvature();
  settings.target_height = columns.number(i, ObserverColumn::target_height).value_or(options.heights.target);
  const auto [metres, datum] =
      height_of(table.rows[i].from, meaning_of_z(options.heights, table), columns.number(i, ObserverColumn::height),
                options.heights.observer, columns.number(i, ObserverColumn::spot));
  if (datum == HeightDatum::sea) {
    settings.observer_z = metres;
  } else {
    settings.observer_height = metres;
  }
  const double reach = reach_of(options, columns, i);
  try {
    set_limits(settings, options, columns, i, [&] { return input.grid_north_at(node.col, node.row, reach); });
  } catch (const Error& error) {
    if (table.rows[i].line == 0) throw;
    throw Error(fmt::format("{}: {}", what, error.what()));
  }
  return {node, settings, reach, input.place_of(node.col, node.row), std::move(what), columns.name(i), i};
}

std::vector<Stand> stands_of(MapInput& input, const ViewshedOptions& options, const PlaceTable& table,
                             RowStatus& status) {
  input.notes.insert(input.notes.end(), table.notes.begin(), table.notes.end());
  const PlaceTable none;
  ViewshedSettings unused;
  set_limits(unused, options, ObserverColumns(none), 0, [] { return 0.0; });  // reports wrong options
  const ObserverColumns columns(table);
  for (const std::string& note : {columns.note(), note_of_z(options.heights, table)})
    if (!note.empty()) input.notes.push_back(note);
  std::vector<Stand> stands;
  double farthest = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const PlaceRow& row = table.rows[i];
    const std::string what = row.line > 0 ? table.where(i) : "--observer";
    Node node;
    if (!status.attempt(i, RowStatus::kOutside, [&] { node = input.node_of(row.from, table.lonlat, what); })) continue;
    if (!status.attempt(i, RowStatus::kInvalid,
                        [&] { stands.push_back(stand_of(input, options, table, columns, i, node, what)); }))
      continue;
    // Measured in samples, which suits degrees and metres.
    const dvec2 typed = input.position_of(row.from, table.lonlat, what);
    farthest = std::max(farthest, std::hypot(typed.x - node.col, typed.y - node.row));
  }
  status.require_good();
  constexpr double kNoticed = 0.01;  // of a sample
  if (farthest > kNoticed)
    input.notes.push_back(fmt::format("observers stand on the nearest sample, up to {:.2g} samples away", farthest));
  return stands;
}

// `bare`: nullptr if the raster itself is the ground.
std::vector<Observer> observers_of(MapInput& input, BareGround* bare, const std::vector<Stand>& stands) {
  std::vector<Observer> observers;
  const auto field = [](MapInput& from, const Stand& one) {
    return from.field_at(one.node.col, one.node.row, one.reach);
  };
  if (bare) bare->follow(input);
  for (const Stand& one : stands)
    observers.push_back({in_part(input, one.node), one.settings, field(input, one),
                         bare ? std::optional(field(bare->input(), one)) : std::nullopt});
  return observers;
}

// Removes stands without ground, or below it. `input`: the model on which they stand; its samples have been read.
void keep_usable(std::vector<Stand>& stands, MapInput& input, RowStatus& status) {
  const auto attempt = [&](const Stand& one, std::string_view bad, const auto& work) {
    return status.attempt(one.row, bad, [&] {
      try {
        work();
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}{}", one.what, error.what(),
                                one.settings.observer_z ? " (heights above sea: --heights, --observer-z)" : ""));
      }
    });
  };
  std::erase_if(stands, [&](const Stand& one) {
    attempt(one, RowStatus::kNodata, [&] {
      if (!one.settings.observer_z)
        require_ground(input, {.col = static_cast<double>(one.node.col), .row = static_cast<double>(one.node.row)},
                       "observer");
    });
    return !attempt(one, RowStatus::kInvalid,
                    [&] { const Viewpoint checked(input.field(), in_part(input, one.node), one.settings); });
  });
  if (const std::string note = status.note(); !note.empty()) input.notes.push_back(note);
}

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

// If pixels out of range are not nodata, as holes are, all samples are read.
void set_area(MapRun& run, const ViewshedOptions& options, bool marks_range, const std::vector<Stand>& stands) {
  const RasterWindow near = part_in_reach(run.input(), stands), whole = run.input().whole();
  if (options.crop)
    for (const Stand& one : stands)
      if (!std::isfinite(one.reach)) throw Error(fmt::format("--crop: {}: needs --max-distance", one.what));
  const bool all = !options.raster_output.preview.empty() || marks_range;
  run.set_area(options.crop ? near : whole, all && !options.crop ? whole : near);
  // A line of sight stays between the rows of its ends.
  run.set_rows([&](RowBand rows) {
    for (const Stand& one : stands) rows = {std::min(rows.first, one.node.row), std::max(rows.last, one.node.row + 1)};
    return rows;
  });
}

std::string share_text(const TargetCount& targets) {
  const double all = targets.visible + targets.hidden;
  return fmt::format("{:.3g} % visible", all > 0 ? 100 * targets.visible / all : 0);
}

ComputedBand visible_band(const ObserverGroup& group, const PixelValues& values, const RowBand& rows,
                          TargetCount& targets, const Progress& progress) {
  const int value_of[] = {values.hidden, values.visible, values.out_of_range, values.nodata};
  std::vector<std::uint8_t> pixels;
  if (rows.rows() > 0) {
    const auto seen = best_pixels(group, rows, progress);
    pixels.reserve(seen.size());
    for (const Seen code : seen) pixels.push_back(static_cast<std::uint8_t>(value_of[static_cast<std::size_t>(code)]));
    targets.add(seen);
  }
  return {"visible", "", std::move(pixels), static_cast<double>(values.nodata), values.classes()};
}

ComputedBand count_band(const ObserverGroup& group, const RowBand& rows, const Progress& progress) {
  std::vector<std::uint16_t> counts;
  if (rows.rows() > 0) counts = count_pixels(group, rows, progress);
  std::replace(counts.begin(), counts.end(), kCountOutOfRange, kCountHole);
  return {"observers that see the pixel", "", std::move(counts), kCountHole};
}

// Throws Error if nodata is also a value of the map.
ComputedBand checked_band(const std::string& name, const std::string& unit, std::vector<float> pixels, double nodata) {
  if (std::find(pixels.begin(), pixels.end(), static_cast<float>(nodata)) != pixels.end())
    throw Error(fmt::format("--nodata-value {:.10g}: is also a value of the map (choose another)", nodata));
  return number_band(name, unit, std::move(pixels), nodata);
}

std::string mode_of(const std::string& typed) {
  // As in gdal_viewshed.
  if (typed == "NORMAL") return "visible";
  if (typed == "DEM") return "dem";
  if (typed == "GROUND") return "ground";
  if (typed == "ACCUM") return "count";
  return typed;
}

std::string places_text(const std::vector<Stand>& stands) {
  constexpr std::size_t kListed = 20;
  std::string text;
  for (std::size_t i = 0; i < stands.size() && i < kListed; ++i) {
    const Stand& one = stands[i];
    text += fmt::format("{}{}{:.10g},{:.10g} {}", i == 0 ? "" : "; ", one.name.empty() ? "" : one.name + ": ", one.at.x,
                        one.at.y,
                        one.settings.observer_z ? fmt::format("{:.10g} m above sea", *one.settings.observer_z)
                                                : fmt::format("{:.10g} m above ground", one.settings.observer_height));
  }
  return text + (stands.size() > kListed ? "; ..." : "");
}

// The band of a mode, for some observers and rows.
class BandMaker {
 public:
  BandMaker(const ViewshedOptions& options, const std::optional<PixelValues>& values)
      : options_(options), values_(values), nodata_(options.nodata.value_or(kNoNumber)) {}

  ComputedBand make(const ObserverGroup& group, const RowBand& rows, const Progress& progress) {
    if (values_) return visible_band(group, *values_, rows, targets_, progress);
    if (options_.mode == "count") return count_band(group, rows, progress);
    if (options_.mode == "angle")
      return checked_band("angle above horizontal", "degrees", angle_pixels(group, rows, targets_, progress), nodata_);
    if (options_.mode == "height")
      return checked_band("visible height of targets", "m", height_pixels(group, rows, progress), nodata_);
    if (options_.mode == "fresnel")
      return checked_band("clear share of the first Fresnel zone", "",
                          fresnel_pixels(group, wavelength_of(*options_.frequency), rows, progress), nodata_);
    const bool dem = options_.mode == "dem";
    return checked_band(dem ? "least visible height above sea" : "least visible height above ground", "m",
                        least_pixels(group, dem ? HeightDatum::sea : HeightDatum::ground, rows, progress), nodata_);
  }

  std::string text(std::size_t observers) const {
    if (values_ || options_.mode == "angle") return share_text(targets_);
    if (options_.mode == "height") return "visible heights of targets";
    if (options_.mode == "fresnel") return "clear shares of Fresnel zones";
    return options_.mode == "count" ? fmt::format("{} observers", observers) : "least visible heights";
  }
  /// Numbers of text().
  std::vector<double*> totals() { return {&targets_.visible, &targets_.hidden}; }

 private:
  const ViewshedOptions& options_;
  const std::optional<PixelValues>& values_;
  double nodata_;
  TargetCount targets_;
};

// "seen.tif" to "seen_3.tif", for the third row of the observers; none without --per-observer files.
std::vector<std::string> numbered_files(const ViewshedOptions& options, const std::vector<Stand>& stands) {
  std::vector<std::string> files;
  if (options.each != "files") return files;
  const std::string stem = options.output.substr(0, options.output.size() - extension_of(options.output).size());
  for (const Stand& one : stands)
    files.push_back(fmt::format("{}_{}{}", stem, one.row + 1, options.output.substr(stem.size())));
  return files;
}

// Before hours of work, and before the first of them is written.
void check_files(const ViewshedOptions& options, const MapInput& input, const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    keep_inputs(file, options.typed);
    keep_inputs(file, input.files());
    keep_apart("--preview", options.raster_output.preview, file, {});
    keep_apart("--summary", options.summary, file, {});
    if (!options.raster_output.dry_run) const ReplaceFile writable(file);
  }
}

void write_summary(const ViewshedOptions& options, const ViewshedSummary& summary, const PlaceTable& table,
                   const RowStatus& status, const std::vector<Stand>& stands) {
  std::vector<SummaryRow> rows;
  for (const Stand& one : stands) rows.push_back({one.row, one.at});
  write_whole_file(options.summary,
                   summary_csv(summary, table, options.observers_file.skip_bad ? &status : nullptr, rows));
}

void check_summary(const ViewshedOptions& options) {
  if (options.summary.empty()) return;
  if (extension_of(options.summary) != ".csv")
    throw Error(fmt::format("--summary '{}': expected a name that ends in .csv", options.summary));
  keep_apart("--summary", options.summary, options.output, options.typed);
  if (!options.raster_output.dry_run) const ReplaceFile writable(options.summary);
}

std::string targets_text(const std::vector<Stand>& stands) {
  const auto height = [](const Stand& one) { return one.settings.target_height; };
  const double first = height(stands.front());
  const bool same = std::all_of(stands.begin(), stands.end(), [&](const Stand& one) { return height(one) == first; });
  return same ? fmt::format("{:.10g} m above ground", first) : "by observer";
}

void run(ViewshedOptions options, const Command& command) {
  options.mode = mode_of(options.mode);
  const bool codes = options.mode == "visible", counts = options.mode == "count";
  const std::optional<PixelValues> values = codes ? std::optional(pixel_values(options)) : std::nullopt;
  check_summary(options);
  MapRun run(options, command, codes ? "Byte" : counts ? "UInt16" : "Float32");
  MapInput& input = run.input();
  if (!options.summary.empty()) keep_inputs(options.summary, input.files());
  std::optional<BareGround> bare;
  if (!options.bare_ground.empty()) bare.emplace(options.bare_ground, options, input);
  const PlaceTable places = observer_table(options);
  const bool skips = options.observers_file.skip_bad;
  const PlaceTable table = options.spacing ? stations_on(input, places, *options.spacing, skips) : places;
  RowStatus status(table, skips);
  std::vector<Stand> stands = stands_of(input, options, table, status);
  if (stands.size() > kMostObservers && (codes || counts))
    throw Error(fmt::format("{} observers: at most {} are possible", stands.size(), kMostObservers));
  set_area(run, options, values && values->out_of_range != values->nodata, stands);
  check_files(options, input, numbered_files(options, stands));
  constexpr double kNode_s = 6e-8;  // of one sweep, on one thread
  const double bands = options.each.empty() ? 1 : static_cast<double>(stands.size());
  constexpr double kCrossing_s = 6e-9;
  const double node_s = options.mode == "fresnel" ? kCrossing_s * (input.cols() + input.rows()) : kNode_s;
  if (!run.begin(bands * (codes || counts ? 3 : 12), static_cast<double>(stands.size()) * node_s,
                 bare ? bytes_of(bare->input().sample_type()) : 0))
    return;
  if (bare) bare->follow(input), bare->close();
  keep_usable(stands, bare ? bare->input() : input, status);
  if (bare) bare->move_notes(input);
  Metadata metadata{
      {"MODE", options.mode}, {"OBSERVERS", places_text(stands)}, {"TARGET_HEIGHT", targets_text(stands)}};
  if (bare) metadata.emplace_back("GROUND", bare->path());
  if (options.frequency) metadata.emplace_back("FREQUENCY", fmt::format("{:.10g} MHz", *options.frequency));
  for (auto& pair : input.curvature_metadata()) metadata.push_back(std::move(pair));
  BandMaker maker(options, values);
  ViewshedSummary summary(stands.size());
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    const std::vector<Observer> observers = observers_of(input, bare ? &*bare : nullptr, stands);
    const ObserverGroup all{observers, options.summary.empty() ? nullptr : &summary, 0};
    std::vector<ComputedBand> computed;
    if (options.each.empty()) return std::vector{maker.make(all, rows, progress)};
    for (std::size_t k = 0; k < stands.size(); ++k) {
      computed.push_back(maker.make(
          all.one(k), rows, progress_part(progress, static_cast<double>(k), static_cast<double>(stands.size()))));
      computed.back().name = fmt::format("{}: {}", stands[k].title(stands.size()), computed.back().name);
    }
    return computed;
  };
  const auto text = [&] { return fmt::format("{}; {}", maker.text(stands.size()), input.curvature_text()); };
  MapRecipe recipe{kMethod, metadata, "viridis", compute, text};
  recipe.files = numbered_files(options, stands);
  recipe.totals = maker.totals();
  if (!options.summary.empty())
    for (double* const total : summary.totals()) recipe.totals.push_back(total);
  recipe.inputs.push_back(table_identity(places));
  if (bare)
    for (const std::string& file : bare->input().files()) recipe.inputs.push_back(file_identity(file));
  recipe.write_more = [&] {
    if (!options.summary.empty()) write_summary(options, summary, table, status, stands);
  };
  constexpr std::size_t kMostNames = 100;
  for (const Stand& one : stands)
    recipe.marks.push_back(
        {dvec2(one.node.col, one.node.row), stands.size() > kMostNames ? "" : one.title(stands.size())});
  run.write(recipe);
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
  add_place_file(command, o.observers_file,
                 {.names = "--observers",
                  .value = "FILE",
                  .help = "observers: CSV (x,y[,z]) or a vector file of points",
                  .files = "csv geojson gpkg shp",
                  .note = "-: CSV from standard input",
                  .common = true,
                  .excludes = {"--observer"}});
  command.add(&o.spacing, {.names = "--observer-spacing",
                           .help = "distance of observers along the lines, or over the polygons, of --observers",
                           .unit = "metres",
                           .range = kAboveZero,
                           .fallback = "none: --observers holds points",
                           .common = true,
                           .rules = {needs("--observers FILE", [&o] { return !o.observers_file.path.empty(); })}});
  add_output_option(command, o.output, "raster to write, or polygons of its codes (.gpkg, .geojson, .shp)",
                    "tif tiff img asc gpkg geojson shp");
  command.add(
      &o.mode,
      {.names = "--mode",
       .value = "MODE",
       .help = "content of pixels",
       .choices = {"visible", "count", "dem", "ground", "angle", "height", "fresnel", "NORMAL", "ACCUM", "DEM",
                   "GROUND"},
       .closed = true,
       .common = true,
       .rules = {{"height needs targets with a height (--target-height M)",
                  [&o] { return o.mode != "height" || o.heights.target > 0; }},
                 {"fresnel needs --frequency MHZ", [&o] { return o.mode != "fresnel" || o.frequency.has_value(); }}}});
  command.add(&o.summary, {.names = "--summary",
                           .value = "FILE",
                           .help = "table of the area that each observer sees",
                           .files = "csv",
                           .writes = true,
                           .fallback = "none",
                           .common = true});
  command.add(&o.each, {.names = "--per-observer",
                        .value = "WHAT",
                        .help = "a map for each observer, as bands of the output or as files",
                        .choices = {"bands", "files"},
                        .closed = true,
                        .note = "files: OUT_N.tif for row N of the observers",
                        .fallback = "one map of all",
                        .rules = {{"does not apply to --mode count (each map would count one observer)",
                                   [&o] { return mode_of(o.mode) != "count"; }}}});
  add_sight_heights(command, o.heights);
  add_bare_ground_option(command, o.bare_ground);
  add_frequency_option(command, o.frequency, {needs("--mode fresnel", [&o] { return o.mode == "fresnel"; })});
  add_observer_z(command, o.heights, "--observers", o.observers_file);
  command.add(&o.max_distance, {.names = "--max-distance",
                                .help = "maximum distance of targets",
                                .unit = "metres",
                                .range = {0, kMostOfGround},
                                .fallback = "unlimited",
                                .common = true});
  command.add(&o.min_distance, {.names = "--min-distance",
                                .help = "minimum distance of targets",
                                .unit = "metres",
                                .range = {0, kMostOfGround}});
  command.add(&o.azimuth, {.names = "--azimuth",
                           .value = "FROM,TO",
                           .help = "field of view in degrees clockwise from true north",
                           .fallback = "all around",
                           .common = true});
  command.add(&o.pitch, {.names = "--pitch",
                         .value = "LOW,HIGH",
                         .help = "field of view in degrees above horizontal",
                         .fallback = "-90,90"});
  command.add(&o.crop, {.names = "--crop",
                        .help = "write only the pixels within --max-distance, not the extent of the input",
                        .common = true,
                        .rules = {needs("--max-distance M or --observers FILE",
                                        [&o] { return o.max_distance || !o.observers_file.path.empty(); })}});
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
  const Rule marked = needs("a --mode other than count", [&o] { return mode_of(o.mode) != "count"; });
  command.add(&o.nodata, {.names = "--nodata-value",
                          .help = "pixel value without a sample",
                          .range = {-1e30, 1e30},
                          .fallback = "255, or the largest value left; heights and angles: -9999",
                          .rules = {marked}});
  add_map_coordinates_option(command, o.coordinates);
  add_map_command(command, o, [options, &command] { run(*options, command); });
  command.footer(kFooter);
  command.example("scarp viewshed dem.tif --observer 692000,5143000,2 -o seen.tif");
  command.example("scarp viewshed dem.tif --observers towers.csv --mode count --summary seen.csv -o count.tif");
  command.example("scarp viewshed dem.tif --observers road.gpkg --observer-spacing 50 -o road_sees.tif");
  command.example("scarp viewshed dsm.tif --ground dtm.tif --observers towers.csv --observer-height 30 -o seen.tif");
  command.example("scarp viewshed -ox 692000 -oy 5143000 -md 20000 dem.tif seen.tif");
}

}  // namespace scarp::cli
