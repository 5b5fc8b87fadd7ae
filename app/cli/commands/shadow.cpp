// SPDX-License-Identifier: MIT
// `scarp shadow`: maps where the sun shines on an elevation model.
#include "scarp/analysis/shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
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
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/sun_disc.h"
#ifdef SCARP_ERFA
#include "scarp/analysis/local_sun.h"
#include "scarp/source/raster/node_places.h"
#endif
#include "scarp/base/error.h"
#include "scarp/base/progress_part.h"

namespace scarp::cli {
namespace {

constexpr int kShadowNodata = 255;
constexpr const char* kShadowFooter = R"(Pixels:
  0  lit
  1  self-shaded: the ground itself faces away from the sun
  2  cast shadow: ground farther away hides the sun
With --fraction: share of the sun's disc above the terrain, 0 to 1.)";

struct ShadowOptions : MapCommand {
  std::vector<std::string> suns, times;
  bool fraction = false, refraction = false, per_cell = false;
};

// A sun over the field.
struct Sun {
  SunDirection direction;  // that of the whole raster; the azimuth is relative to grid north
  std::string name;        // name of the band
  std::string place;       // azimuth and altitude in degrees
#ifdef SCARP_ERFA
  std::optional<LocalSun> local{};  // replaces the direction
#endif
  // The direction at the middle of a block of nodes, which replaces that of the whole raster in rasters of several.
  std::function<SunDirection(const HorizonFrame&)> at_block{};
};

std::string place_text(double azimuth, double altitude) {
  return fmt::format("azimuth {:.4f}, altitude {:.4f} degrees", azimuth * kDegreesPerRadian,
                     altitude * kDegreesPerRadian);
}

// Azimuth of grid north on the plane of the whole raster.
double grid_north_of(MapInput& input) { return input.whole_grid_north(); }

#ifdef SCARP_ERFA
// The variation of the sun over a raster at one time.
struct SunSpread {
  SunPosition centre;
  double error = 0;                // largest deviation at the corners, radians
  double lowest = 0, highest = 0;  // altitudes at centre and corners
};

SunPosition sun_over(const MapInput& input, const SunAtTime& sky, const dvec2& node, double height, bool refraction) {
  const auto at = input.lonlat_of(node.x, node.y);
  if (!at) throw Error(fmt::format("{}: --time needs a raster with a CRS (give --crs, or --sun)", input.path()));
  return sky.at({at->x / kDegreesPerRadian, at->y / kDegreesPerRadian, height}, refraction);
}

SunSpread sun_spread(const MapInput& input, const std::string& text, double height, bool refraction) {
  const SunAtTime sky(parse_time(text));
  const double last_col = input.cols() - 1, last_row = input.rows() - 1;
  const auto position = [&](double col, double row) { return sun_over(input, sky, {col, row}, height, refraction); };
  SunSpread spread{position(last_col / 2, last_row / 2)};
  const SunPosition& sun = spread.centre;
  const double centre_north = input.north_at(last_col / 2, last_row / 2);  // true north turns over the raster
  spread.lowest = spread.highest = sun.altitude;
  for (const double col : {0.0, last_col})
    for (const double row : {0.0, last_row}) {
      const SunPosition corner = position(col, row);
      const double cosine = std::sin(sun.altitude) * std::sin(corner.altitude) +
                            std::cos(sun.altitude) * std::cos(corner.altitude) *
                                std::cos(sun.azimuth - centre_north - corner.azimuth + input.north_at(col, row));
      spread.error = std::max(spread.error, std::acos(std::min(cosine, 1.0)));
      spread.lowest = std::min(spread.lowest, corner.altitude);
      spread.highest = std::max(spread.highest, corner.altitude);
    }
  return spread;
}

decltype(LocalSun::places) node_places(const MapInput& input) {
  if (input.georeference().crs_wkt.empty())
    throw Error(fmt::format("{}: --sun-per-cell needs a raster with a CRS (give --crs)", input.path()));
  const auto places = std::make_shared<const NodePlaces>(input.georeference(), input.cols(), input.rows());
  return [places](int row, int first_col, std::span<dvec3> nodes) { places->row(row, first_col, nodes); };
}

// A direction whose azimuth counts from true north at every pixel.
Sun fixed_sun(const MapInput& input, const SunDirection& direction, const std::string& name) {
  return {
      {}, name, place_text(direction.azimuth, direction.altitude), LocalSun{{}, false, node_places(input), direction}};
}

void add_suns_of_times(MapInput& input, const ShadowOptions& options, bool by_blocks, std::vector<Sun>& suns,
                       double& lowest) {
  double error = 0;
  // Not from the samples of a part: all parts have the same sun. A --dry-run reads no samples; kilometres of height
  // move the sun by less than a microradian.
  const double height = options.raster_output.dry_run ? 0 : input.height_at_centre().value_or(0);
  const auto places = options.per_cell ? node_places(input) : nullptr;
  for (const std::string& text : options.times) {
    SunSpread spread;
    try {
      spread = sun_spread(input, text, height, options.refraction);
    } catch (const Error& error_of_time) {
      throw Error(fmt::format("--time: {}", error_of_time.what()));
    }
    const auto& [azimuth, altitude] = spread.centre;
    if (const double highest = options.per_cell || by_blocks ? spread.highest : altitude; highest <= 0)
      throw Error(
          fmt::format("--time '{}': the sun is {:.2f} degrees below the horizon", text, -highest * kDegreesPerRadian));
    lowest = std::min(lowest, spread.lowest);
    error = std::max(error, spread.error);
    if (by_blocks) {
      suns.push_back({{}, text, place_text(azimuth, altitude) + " at the centre"});
      suns.back().at_block = [&input, sky = SunAtTime(parse_time(text)), height,
                              refraction = options.refraction](const HorizonFrame& block) {
        const SunPosition sun = sun_over(input, sky, block.middle, height, refraction);
        return SunDirection{sun.azimuth - input.north_at(block.middle.x, block.middle.y), sun.altitude};
      };
      continue;
    }
    if (!options.per_cell) {
      suns.push_back({{azimuth - grid_north_of(input), altitude}, text, place_text(azimuth, altitude)});
      continue;
    }
    suns.push_back({{},
                    text,
                    place_text(azimuth, altitude) + " at the centre",
                    LocalSun{parse_time(text), options.refraction, places}});
  }
  if (!options.per_cell && !by_blocks)
    input.notes.push_back(
        fmt::format("one sun for the whole raster, that at its centre; it is up to {:.3g} degrees off in the corners "
                    "(--sun-per-cell)",
                    error * kDegreesPerRadian));
}
#endif

void note_turn_of_north(MapInput& input) {
  constexpr double kNoticed = 0.5 / kDegreesPerRadian;  // the radius of the sun, rounded up
  const double turn = input.turn_of_north();
  if (turn > kNoticed)
    input.notes.push_back(
        fmt::format("north is that of the centre for the whole raster; it is up to {:.3g} degrees off in the corners "
                    "(--sun-per-cell)",
                    turn * kDegreesPerRadian));
}

// `lowest`: the lowest altitude of the suns, radians.
std::vector<Sun> suns_of(MapInput& input, const ShadowOptions& options, bool by_blocks, double& lowest) {
  std::vector<Sun> suns;
  for (const std::string& text : options.suns) {
    constexpr std::string_view kForm =
        "AZIMUTH,ALTITUDE in degrees, altitude above 0 and at most 90, for example 135,20";
    const auto n = numbers_from(text, ',', 2, 2, "--sun", kForm);
    if (!(n[1] > 0 && n[1] <= 90) || std::abs(n[0]) > 360)
      throw Error(fmt::format("--sun '{}': expected {}", text, kForm));
    const double azimuth = n[0] / kDegreesPerRadian, altitude = n[1] / kDegreesPerRadian;
    const std::string name = fmt::format("sun {}", text);
    if (options.per_cell) {
#ifdef SCARP_ERFA
      suns.push_back(fixed_sun(input, {azimuth, altitude}, name));
      lowest = std::min(lowest, altitude);
      continue;
#else
      throw Error("--sun-per-cell: this build has one sun for the whole raster (SCARP_ERFA=OFF)");
#endif
    }
    if (by_blocks) {
      suns.push_back({{}, name, place_text(azimuth, altitude)});
      suns.back().at_block = [&input, azimuth, altitude](const HorizonFrame& block) {
        return SunDirection{azimuth - input.north_at(block.middle.x, block.middle.y), altitude};
      };
      continue;
    }
    suns.push_back({{azimuth - grid_north_of(input), altitude}, name, place_text(azimuth, altitude)});
  }
  if (!options.suns.empty() && !options.per_cell && !by_blocks) note_turn_of_north(input);
  if (!options.times.empty()) {
#ifdef SCARP_ERFA
    add_suns_of_times(input, options, by_blocks, suns, lowest);
#else
    static_cast<void>(lowest);
    throw Error("--time: this build does not compute the sun's position (SCARP_ERFA=OFF)");
#endif
  }
  if (suns.empty()) throw Error("no sun: give --sun AZIMUTH,ALTITUDE or --time TIME");
  return suns;
}

std::vector<Shade> shades_of(const SunGround& ground, const Sun& sun, const RowBand& rows, const Progress& progress) {
#ifdef SCARP_ERFA
  if (sun.local) return local_shadow(ground, *sun.local, rows, progress);
#endif
  return ground.rows(sun.direction, rows, progress);
}

std::vector<float> shares_of(const SunGround& ground, const Sun& sun, const RowBand& rows, const Progress& progress) {
#ifdef SCARP_ERFA
  if (sun.local) return local_lit_share(ground, *sun.local, rows, progress);
#endif
  return lit_share(ground, sun.direction, rows, progress);
}

// The values of a map in a block: those of `of`(ground, band of its rows) over the ground that can shade the block.
template <class Of>
auto block_of(const MapInput& input, const HeightField& field, const SunDirection& sun, const NodeRect& nodes,
              double below, const Of& of) {
  RowBand cols{0, field.cols()}, rows{0, field.rows()};
  const double relief = field.max_height() - field.min_height();
  if (const SunDirection lowest{sun.azimuth, sun.altitude - below}; lowest.altitude > 0) {
    cols = cols_towards(node_steps(field), field.cols(), lowest, {nodes.col_begin, nodes.col_end}, relief);
    rows = rows_towards(node_steps(field), field.rows(), lowest, {nodes.row_begin, nodes.row_end}, relief);
  }
  const HeightField near = field.visit([&](const auto& grid) {
    return HeightField::view(grid.row(rows.first) + cols.first, cols.rows(), rows.rows(), field.settings(),
                             grid.row_stride);
  });
  const std::optional<BilinearGround> bilinear = input.bilinear_ground(near);
  const SunGround ground = bilinear ? SunGround(*bilinear) : SunGround(near);
  const auto wide = of(ground, RowBand{nodes.row_begin - rows.first, nodes.row_end - rows.first});
  auto values = wide;
  values.clear();
  for (int row = 0; row < nodes.row_end - nodes.row_begin; ++row) {
    const auto line = wide.begin() + static_cast<std::ptrdiff_t>(row) * cols.rows() - cols.first;
    values.insert(values.end(), line + nodes.col_begin, line + nodes.col_end);
  }
  return values;
}

// Rows of a map by blocks, each under the sun at its middle. Blocks where it is below the horizon have the value
// `dark`, their holes `hole`.
template <class T, class Of>
std::vector<T> blocks_of(MapInput& input, const HeightField& field, const Sun& sun, const HorizonFrames& frames,
                         const RowBand& rows, double below, T dark, T hole, const Progress& progress, const Of& of) {
  std::vector<T> all(static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(field.cols()));
  const SightGround heights(field);
  const std::vector<HorizonFrame> blocks = frames.of(input, rows);
  std::vector<SunDirection> directions;  // not on all threads: transformations of coordinates have one user at a time
  for (const HorizonFrame& block : blocks) directions.push_back(sun.at_block(block));
  const auto add = [&](const HorizonFrame& block, const Progress& of_block) {
    const SunDirection& direction = directions[static_cast<std::size_t>(&block - blocks.data())];
    if (direction.altitude + below > 0) {
      const auto values =
          block_of(input, field, direction, block.nodes, below,
                   [&](const SunGround& ground, const RowBand& band) { return of(ground, direction, band, of_block); });
      return paste(values, block, rows, field.cols(), all);
    }
    std::vector<T> values;
    for (int row = block.nodes.row_begin; row < block.nodes.row_end; ++row)
      for (int col = block.nodes.col_begin; col < block.nodes.col_end; ++col)
        values.push_back(heights.height({col, row}) ? dark : hole);
    paste(values, block, rows, field.cols(), all);
  };
  for_each_frame(blocks, add, progress);
  return all;
}

std::string method_of(const ShadowOptions& options) {
  return fmt::format("exact rays to the sun{}; ground {}; flat Earth; grazing is lit (scarp shadow)",
                     options.per_cell ? " of every pixel" : "", surface_text(options.surface));
}

// Estimated time of one sun of one node, on one thread.
double node_seconds(const ShadowOptions& options) {
  const double codes = options.per_cell ? 4e-6 : options.surface == "bilinear" ? 1e-6 : 1e-7;
  return codes * (!options.fraction ? 1 : options.per_cell ? 2 : 16);
}

// Samples over which a block's sun sweeps, divided by those of the block: the more, the lower the sun. An estimate for
// ground of usual relief, as no samples have been read.
double swept_share(const MapInput& input, const HorizonFrames& frames, const Sun& sun) {
  constexpr double kUsualRelief = 1000;              // metres
  constexpr double kLowest = 1 / kDegreesPerRadian;  // of a sun over the middle, radians
  const SunDirection there = sun.at_block({{}, {}, 0, input.centre()});
  const double reach = kUsualRelief / std::tan(std::max(there.altitude, kLowest));
  const auto share = [&](int side, int all, double cell, double towards) {
    return std::min(side + reach * std::abs(towards) / cell, static_cast<double>(all)) / side;
  };
  const Georeference& geo = input.georeference();
  return share(frames.cols(), input.cols(), geo.cell_x_m, std::sin(there.azimuth)) *
         share(frames.rows(), input.rows(), geo.cell_y_m, std::cos(there.azimuth));
}

// Pixels of all bands.
struct LitPixels {
  double lit = 0, with_sample = 0;
  double percent() const { return with_sample > 0 ? 100 * lit / with_sample : 0; }
};

ComputedBand band_of(const Sun& sun, const std::vector<float>& shares, LitPixels& pixels) {
  for (const float share : shares) pixels.lit += std::max(share, 0.0f);
  pixels.with_sample +=
      static_cast<double>(shares.size()) - static_cast<double>(std::count(shares.begin(), shares.end(), kNoShare));
  return {fmt::format("lit share, {}", sun.name), "", shares, kNoShare};
}

ComputedBand band_of(const Sun& sun, const std::vector<Shade>& shades, LitPixels& pixels) {
  std::vector<std::uint8_t> codes;
  codes.reserve(shades.size());
  for (const Shade shade : shades) {
    codes.push_back(shade == Shade::hole ? kShadowNodata : static_cast<std::uint8_t>(shade));
    pixels.lit += shade == Shade::lit;
    pixels.with_sample += shade != Shade::hole;
  }
  return {sun.name,
          "",
          std::move(codes),
          kShadowNodata,
          {{0, "lit", {255, 246, 214, 255}},
           {1, "self-shaded", {136, 134, 158, 255}},
           {2, "cast shadow", {52, 56, 92, 255}},
           {kShadowNodata, "no sample", {255, 255, 255, 0}}}};
}

// The rows that the shadows of a band depend on. The band is read for its lowest ground; the highest ground is bounded
// by the type of the samples, so that floats need all rows, as suns of their own for each pixel do.
RowBand rows_towards_suns(MapInput& input, const std::vector<Sun>& suns, const ShadowOptions& options,
                          const std::optional<HorizonFrames>& frames, const RowBand& band) {
  const std::optional<double> highest = input.highest_possible();
  if (!highest || options.per_cell || options.raster_output.dry_run) return {0, input.rows()};
  input.read({0, band.first, input.cols(), band.rows()}, terminal_progress("read lowest ground"));
  if (input.field().all_nodata()) return band;
  const double relief = *highest - input.field().min_height();
  const HeightField field = input.field_at(input.centre().x, input.centre().y, HUGE_VAL);
  RowBand rows = band;
  // The disc's lowest strip of --fraction is the first to be hidden.
  const double below = options.fraction ? kSunDiameter / 2 : 0;
  std::vector<SunDirection> directions;
  for (const Sun& sun : suns) {
    if (!sun.at_block) directions.push_back(sun.direction);
    if (sun.at_block)
      for (const HorizonFrame& block : frames->of(input, {0, band.rows()})) directions.push_back(sun.at_block(block));
  }
  for (const SunDirection& direction : directions) {
    const SunDirection lowest{direction.azimuth, direction.altitude - below};
    if (!(lowest.altitude > 0)) return {0, input.rows()};
    const RowBand needed = rows_towards(node_steps(field), input.rows(), lowest, band, relief);
    rows = {std::min(rows.first, needed.first), std::max(rows.last, needed.last)};
  }
  return rows;
}

void run(ShadowOptions options, const Command& command) {
  MapRun run(options, command, options.fraction ? "Float32" : "Byte");
  MapInput& input = run.input();
  double lowest = std::numbers::pi / 2;
  std::optional<HorizonFrames> frames;
  if (!options.per_cell && !is_geographic(input.georeference())) {
    // Lengths are those at the centre.
    frames.emplace(input, HorizonInput{.max_distance = 0}, options.plane_error,
                   options.times.empty() ? FrameUse::north : FrameUse::suns);
    if (frames->single()) frames.reset();
  }
  const std::vector<Sun> suns = suns_of(input, options, frames.has_value(), lowest);
  run.set_rows([&](const RowBand& band) { return rows_towards_suns(input, suns, options, frames, band); });
  const auto bands = static_cast<double>(suns.size());
  double sweeps = 0;
  for (const Sun& sun : suns) sweeps += frames ? swept_share(input, *frames, sun) : 1;
  if (!run.begin(bands * (options.fraction ? 4 : 1) + 1, sweeps * node_seconds(options))) return;
  std::string places;
  for (const Sun& sun : suns) places += fmt::format("{}{}: {}", places.empty() ? "" : "; ", sun.name, sun.place);
  LitPixels pixels;
  const auto compute = [&](const RowBand& rows, const Progress& progress) {
    // A single sun needs a plane for the whole raster; rays per cell need one only as far as a shadow reaches.
    const double relief = input.field().max_height() - input.field().min_height();
    const bool whole = !options.per_cell || lowest <= 0;
    const HeightField field = input.whole_field(whole ? HUGE_VAL : relief / std::tan(lowest));
    const std::optional<BilinearGround> bilinear = input.bilinear_ground(field);
    const SunGround ground = bilinear ? SunGround(*bilinear) : SunGround(field);
    std::vector<ComputedBand> computed;
    for (std::size_t i = 0; i < suns.size(); ++i) {
      const Sun& sun = suns[i];
      const Progress of_sun = progress_part(progress, static_cast<double>(i), bands);
      const auto shares = [&] {
        if (!frames) return shares_of(ground, sun, rows, of_sun);
        return blocks_of(input, field, sun, *frames, rows, kSunDiameter / 2, 0.0f, kNoShare, of_sun, lit_share);
      };
      const auto shades = [&] {
        if (!frames) return shades_of(ground, sun, rows, of_sun);
        const auto codes = [](const SunGround& near, const SunDirection& direction, const RowBand& band,
                              const Progress& of_block) { return near.rows(direction, band, of_block); };
        return blocks_of(input, field, sun, *frames, rows, 0, Shade::self_shaded, Shade::hole, of_sun, codes);
      };
      computed.push_back(options.fraction ? band_of(sun, shares(), pixels) : band_of(sun, shades(), pixels));
    }
    return computed;
  };
  const auto summary = [&] { return fmt::format("{}; {:.3g} % lit", places, pixels.percent()); };
  Metadata metadata{{"SUN", places}};
  if (frames)
    for (auto& pair : frames->metadata()) metadata.push_back(std::move(pair));
  run.write({method_of(options), metadata, "grey", compute, summary, {&pixels.lit, &pixels.with_sample}, true});
}

}  // namespace

void add_shadow(Program& program) {
  Command& command = program.add("shadow", "Map where the sun shines on an elevation model");
  const auto options = std::make_shared<ShadowOptions>();
  ShadowOptions& o = *options;
  command.add(&o.suns, {.names = "--sun",
                        .value = "AZ,ALT",
                        .help = "direction to the sun in degrees: clockwise from true north, above the horizon",
                        .note = "repeatable: one band each",
                        .repeats = true,
                        .common = true});
  command.add(&o.times, {.names = "--time",
                         .value = "TIME",
                         .help = "time with UTC offset, 2026-06-21T09:00+02:00",
                         .note = "repeatable: one band each",
                         .repeats = true,
                         .common = true});
  command.add(&o.refraction, {.names = "--refraction",
                              .help = "raise the sun of --time by the refraction of a standard atmosphere",
                              .common = true,
                              .rules = {needs("--time", [&o] { return !o.times.empty(); })}});
  command.add(&o.per_cell, {.names = "--sun-per-cell",
                            .help = "the sun's position, north and scale at every pixel instead of its block's",
                            .common = true});
  command.add(&o.fraction, {.names = "--fraction",
                            .help = "lit fraction of the sun's disc (0.533 degrees) instead of codes",
                            .common = true});
  add_output_option(command, o.output, "raster to write, or polygons of its codes (.gpkg, .geojson, .shp)",
                    "tif tiff img asc gpkg geojson shp");
  add_surface_option(command, o.surface);
  add_map_command(command, o, [options, &command] { run(*options, command); });
  command.footer(kShadowFooter);
  command.example("scarp shadow dem.tif --sun 135,20 -o shadow.tif");
  command.example("scarp shadow dem.tif --time 2026-06-21T09:00+02:00 --time 2026-06-21T18:00+02:00 -o shadow.tif");
}

}  // namespace scarp::cli
