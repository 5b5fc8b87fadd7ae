// SPDX-License-Identifier: MIT
#include "app/cli/commands/horizon_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "app/cli/commands/horizon_place.h"
#include "app/cli/commands/skyline.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/plot_options.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/replace_file.h"
#include "scarp/source/table/place_table.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

PlaceTable points_of(const HorizonOptions& options) {
  if (!options.points.path.empty()) {
    PlaceTable table = options.points.read(PlaceKind::points);
    ignore_vector_z(table);
    return table;
  }
  PlaceTable table;
  for (const std::string& text : options.at) table.rows.push_back({typed_height_place(text, "--at"), {}, 0});
  return table;
}

std::string table_of(const HorizonOptions& options, MapInput& input, const PlaceTable& table) {
  const bool skips = options.points.skip_bad;
  RowStatus status(table, skips);
  const HorizonSettings settings = horizon_settings(options.horizon, input);
  const std::vector<double> azimuths = options.all_azimuths();
  std::vector<std::string> lines(table.rows.size());
  visit_places(input, table, settings, status, terminal_progress("horizon"),
               [&](std::size_t row, const HorizonPlace& place, const Progress& progress) {
                 const auto views = horizons_at(input, place, azimuths, settings, progress);
                 const std::string carried = carried_texts(table, row);
                 for (std::size_t k = 0; k < views.size(); ++k) {
                   const double angle = options.clamp ? std::max(views[k].angle, 0.0) : views[k].angle;
                   lines[row] += fmt::format(
                       "{}{},{:.10g},{:.6f},{}{}\n", carried, row + 1, azimuths[k], angle * kDegreesPerRadian,
                       views[k].distance ? fmt::format("{:.10g}", *views[k].distance) : "", skips ? ",ok" : "");
                 }
               });
  std::string text = carried_names(table);
  text += fmt::format("point,horizon_azimuth,horizon_elevation,distance{}\n", skips ? ",status" : "");
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    text +=
        status.good(row) ? lines[row] : fmt::format("{}{},,,,{}\n", carried_texts(table, row), row + 1, status.of(row));
  return text;
}

}  // namespace

std::vector<double> HorizonOptions::all_azimuths() const {
  constexpr int kMapAzimuths = 16, kPointAzimuths = 360, kFigureAzimuths = 1440;
  const int count = azimuths.value_or(!at_points()        ? kMapAzimuths
                                      : is_figure(output) ? kFigureAzimuths
                                                          : kPointAzimuths);
  std::vector<double> all;
  for (int i = 0; i < count; ++i) all.push_back(std::fmod(first_azimuth + 360.0 + 360.0 * i / count, 360.0));
  return all;
}

void write_point_horizons(HorizonOptions options) {
  if (options.output == "-") options.output.clear();
  const bool to_file = !options.output.empty();
  require_table_or_figure(options.output, " with --at or --points");
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  const PlaceTable table = points_of(options);
  const SkylineNames names(options.labels);
  if (is_figure(options.output) && table.rows.size() > 1)
    throw Error(fmt::format("output '{}': a figure shows one point, not {}", options.output, table.rows.size()));
  MapInput input(options);
  input.notes.insert(input.notes.end(), table.notes.begin(), table.notes.end());
  keep_inputs(options.output, input.files());
  if (to_file) const ReplaceFile writable(options.output);
  if (is_figure(options.output)) return draw_skyline(options, input, table, names);
  const std::string text = table_of(options, input, table);
  if (to_file) {
    write_whole_file(options.output, text);
    fmt::print("{}: {} points; {}\n", options.output, table.rows.size(), input.curvature_text());
  } else {
    fmt::print("{}", text);
  }
  for (const std::string& note : input.notes) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace scarp::cli
