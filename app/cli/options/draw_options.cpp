// SPDX-License-Identifier: MIT
#include "app/cli/options/draw_options.h"

namespace scarp::cli {

void add_draw_options(Command& command, DrawOptions& options, Topic topic, const Rule& rule,
                      const std::vector<std::string>& excludes) {
  command.add(&options.files, {.names = "--draw",
                               .value = "FILE",
                               .help = "points, lines and polygons to draw: a vector file, or CSV of points (x,y)",
                               .files = "csv geojson gpkg shp",
                               .note = "repeatable",
                               .repeats = true,
                               .fallback = "none",
                               .topic = topic,
                               .inputs = {kTerrain, "only rasters are georeferenced", "only rasters are georeferenced"},
                               .rules = {rule},
                               .excludes = excludes});
  command.add(&options.label, {.names = "--draw-label",
                               .value = "COLUMN",
                               .help = "column of --draw with labels",
                               .fallback = "none",
                               .topic = topic,
                               .rules = {needs("--draw FILE", [&options] { return !options.files.empty(); })},
                               .excludes = excludes});
}

}  // namespace scarp::cli
