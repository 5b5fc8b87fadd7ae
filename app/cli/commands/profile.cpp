// SPDX-License-Identifier: MIT
// `scarp profile`: heights along a line, with the line of sight between its ends.
#include "scarp/analysis/profile.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/profile_march.h"
#include "app/cli/commands/profile_path.h"
#include "app/cli/options/bare_ground.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_input.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/plot_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#ifdef SCARP_CAIRO
#include "scarp/output/profile_figure.h"
#endif
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

constexpr const char* kColumns = R"(CSV, a row for each end and each crossing with a grid line:
  distance  from the observer, metres
  x,y       place, in --coords
  ground    height above sea, metres
  drop      metres by which the ground appears lower (curvature and refraction)
  sight     height of the line of sight above sea, metres
  visible   1 if the observer sees the ground there, else 0
  zone      with --frequency: radius of the first Fresnel zone there, metres
  fresnel   height of the line of sight above the ground over this radius; not at the ends
  bare      with --ground: height of the bare ground above sea, metres
With --path, a row for each station: path (from 1), distance, x, y, ground, and with --skip-bad
status.)";

struct ProfileOptions : MapOptions {
  std::string from, to, size;
  SightHeights heights;
  ProfileMarchOptions march;
  ProfilePath path;
  std::optional<double> frequency;  // megahertz
  std::string bare_ground;
};

constexpr int kWidth = 1200, kHeight = 480;  // of figures

// The radius of the first Fresnel zone; 0 without a frequency, and at the ends.
double zone_at(const ProfilePoint& point, double length, std::optional<double> frequency) {
  const bool within = point.distance > 0 && point.distance < length;
  return frequency && within ? fresnel_radius(wavelength_of(*frequency), point.distance, length - point.distance) : 0;
}

std::string csv_of(const MapInput& input, const SightEnds& ends, const std::vector<ProfilePoint>& points,
                   std::optional<double> frequency, BareGround* bare) {
  std::string out = fmt::format("distance,x,y,ground,drop,sight,visible{}{}\n", frequency ? ",zone,fresnel" : "",
                                bare ? ",bare" : "");
  for (const ProfilePoint& p : points) {
    const dvec2 point = point_along(ends, p.along), at = input.place_of(point.x, point.y);
    out += fmt::format("{:.10g},{:.10g},{:.10g},{},{:.10g},{:.10g},{:d}", p.distance, at.x, at.y,
                       std::isfinite(p.ground) ? fmt::format("{:.10g}", p.ground) : "", p.drop, p.sight, p.visible);
    if (const double radius = zone_at(p, points.back().distance, frequency); frequency)
      out += fmt::format(
          ",{:.10g},{}", radius,
          radius > 0 && std::isfinite(p.ground) ? fmt::format("{:.10g}", (p.sight - p.ground) / radius) : "");
    if (bare) {
      const auto height = bare->height_at(point);
      out += height ? fmt::format(",{:.10g}", *height) : ",";
    }
    out += '\n';
  }
  return out;
}

#ifdef SCARP_CAIRO
// The first Fresnel zone, with points so close that it looks round.
std::vector<ProfileFigureZone> zone_of(const std::vector<ProfilePoint>& points, double wavelength) {
  constexpr int kZonePoints = 400;
  const double length = points.back().distance;
  std::vector<ProfileFigureZone> zone;
  std::size_t next = 1;
  for (int i = 0; i <= kZonePoints; ++i) {
    // Close together at the ends, where the radius changes fast.
    const double distance = length * (1 - std::cos(std::numbers::pi * i / kZonePoints)) / 2;
    while (next + 1 < points.size() && points[next].distance < distance) ++next;
    const ProfilePoint &a = points[next - 1], &b = points[next];
    const double apart = b.distance - a.distance;
    const double sight = apart > 0 ? std::lerp(a.sight, b.sight, (distance - a.distance) / apart) : b.sight;
    const double radius = fresnel_radius(wavelength, distance, length - distance);
    zone.push_back({distance, sight - radius, sight + radius});
  }
  return zone;
}

void draw(const MapInput& input, const ProfileOptions& options, const SightEnds& ends,
          const std::vector<ProfilePoint>& points, const LineOfSight& sight) {
  ProfileFigure figure;
  const auto [width, height] = plot_size(options.size, kWidth, kHeight);
  figure.width = width, figure.height = height;
  for (const ProfilePoint& p : points)
    figure.points.push_back({p.distance, p.ground, p.sight, p.visible, p.after_hole});
  if (options.frequency) figure.zone = zone_of(points, wavelength_of(*options.frequency));
  const auto place = [&](double along) {
    const dvec2 point = point_along(ends, along);
    return input.place_of(point.x, point.y);
  };
  const dvec2 from = place(0), to = place(1);
  figure.title = fmt::format("{:.10g}, {:.10g} to {:.10g}, {:.10g}: {}", from.x, from.y, to.x, to.y,
                             sight.visible ? "visible" : "blocked");
  figure.remark =
      fmt::format("eye {:.2f} m, target {:.2f} m above sea; {}", sight.eye, sight.target, input.curvature_text());
  if (sight.obstruction) {
    figure.blocked = true;
    figure.block = {sight.obstruction->along * sight.distance, sight.obstruction->height, 0, true};
  }
  ReplaceFile file(options.output);
  write_profile_figure(file, options.output, figure);
}
#endif

// The typed line, its ends in the part that was read, and the field with the lengths of its cells along the line.
struct ProfileLine {
  SightEnds ends, here;
  HeightField field;
};

// Reads the part of the raster that the line needs, or all of it: steps of marches depend on the whole pyramid.
// `bare`: nullptr if the raster itself is the ground.
ProfileLine line_of(MapInput& input, BareGround* bare, const PlaceTable& table, const SightHeights& heights, bool all) {
  SightEnds ends = sight_ends(input, table, 0, heights, SightColumns(table, false));
  const auto& [from, to] = ends;
  input.read(all ? input.whole() : part_of_line(input, from, to), terminal_progress("read"));
  input.close();
  if (bare) {
    bare->follow(input);
    ends = {bare->stand_on(from, "observer"), bare->stand_on(to, "target")};
  }
  require_ground(input, from, "observer");
  require_ground(input, to, "target");
  return {ends,
          {in_part(input, from), in_part(input, to)},
          with_cells(input.field(), input.cells_along({from.col, from.row}, {to.col, to.row}))};
}

void run_marches(const ProfileOptions& options, const PlaceTable& table) {
  const auto [width, height] = plot_size(options.size, kWidth, 0);
  MapInput input(options);
  keep_inputs(options.output, input.files());
  std::vector<std::string> lines;
  if (options.march.ray.empty()) {
    const ProfileLine ends = line_of(input, nullptr, table, options.heights, true);
    const SightLine line(ends.field, ends.here.from, ends.here.to, {.coefficient = 0});
    const std::string title = fmt::format("ray from {} to {}: {:.6g} m to {:.6g} m above sea", options.from, options.to,
                                          line.eye(), line.target());
    lines = draw_marches(options.march, ray_along(line), title, width, height, options.output);
  } else {
    input.read(input.whole(), terminal_progress("read"));
    input.close();
    lines = draw_marches(options.march, typed_ray(input, options.march.ray), "ray " + options.march.ray, width, height,
                         options.output);
  }
  print_notes(input.notes);
  for (const std::string& line : lines) fmt::print("{}: {}\n", options.output, line);
}

void run(ProfileOptions options, const Command& command) {
  if (options.output == "-") options.output.clear();
  check_marches(command, options.march);
  require_table_or_figure(options.output);
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  if (!options.path.file.path.empty()) return write_path_profiles(options.path, options, options.output);
  PlaceTable table;
  if (options.march.ray.empty()) {
    for (const char* name : {"--from", "--to"})
      if (!command.given(name))
        throw WrongUsage(fmt::format("{} X,Y[,H] is required (see 'scarp profile --help')", name));
    SightPlaces places;
    places.from = {options.from};
    places.to = {options.to};
    table = sight_places(places);
  }
  if (!options.march.names.empty()) return run_marches(options, table);
  MapInput input(options);
  keep_inputs(options.output, input.files());
  std::optional<BareGround> bare;
  if (!options.bare_ground.empty()) bare.emplace(options.bare_ground, options, input);
  const ProfileLine ends = line_of(input, bare ? &*bare : nullptr, table, options.heights, false);
  const HeightField& field = ends.field;
  const auto& [from, to] = ends.here;
  const SightLine line(field, from, to, input.curvature());
  const std::vector<ProfilePoint> points = profile(line);
  const LineOfSight sight = line_of_sight(field, from, to, input.curvature());
  if (is_figure(options.output)) {
#ifdef SCARP_CAIRO
    draw(input, options, ends.ends, points, sight);
#endif
  } else if (options.output.empty()) {
    fmt::print("{}", csv_of(input, ends.ends, points, options.frequency, bare ? &*bare : nullptr));
  } else {
    write_whole_file(options.output, csv_of(input, ends.ends, points, options.frequency, bare ? &*bare : nullptr));
  }
  if (bare) bare->move_notes(input);
  print_notes(input.notes);
  if (!options.output.empty())
    fmt::print("{}: {} points over {:.6g} m, {}; {}\n", options.output, points.size(), line.distance(),
               sight.visible ? "target visible" : "target blocked", input.curvature_text());
}

}  // namespace

void add_profile(Program& program) {
  Command& command = program.add("profile", "Write or draw the heights along a line, with its line of sight");
  const auto options = std::make_shared<ProfileOptions>();
  ProfileOptions& o = *options;
  command.add(&o.from, {.names = "--from", .value = "X,Y[,H]", .help = "observer, start of the ray", .common = true});
  command.add(&o.to, {.names = "--to", .value = "X,Y[,H]", .help = "target", .common = true});
  add_profile_path_options(command, o.path);
  add_output_option(command, o.output, "result: .csv, .svg, .pdf or .png; -: CSV to standard output", "csv svg pdf png",
                    "standard output");
  add_plot_size_option(command, o.size, "1200x480; marches: as high as their panels", needs_figure(o.output));
  add_profile_march_options(command, o.march, o.output);
  add_sight_heights(command, o.heights);
  add_bare_ground_option(command, o.bare_ground, {"--path", "--march", "--ray"});
  add_frequency_option(command, o.frequency, {}, {"--path", "--march", "--ray"});
  add_curvature_option(command, o.curvature);
  add_map_coordinates_option(command, o.coordinates);
  add_map_options(command, o);
  command.footer(kColumns);
  command.example("scarp profile dem.tif --from 692000,5143000,400 --to 692900,5143500 --march max-mip -o ray.svg");
  command.example("scarp profile dem.tif --from 692000,5143000,20 --to 698500,5149000,10 --frequency 900 -o link.svg");
  command.example("scarp profile dem.tif --path road.gpkg --spacing 25 -o road.csv");
  command.example("scarp profile dem.tif --from 692000,5143000 --to 698500,5149000,10 -o profile.svg");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
