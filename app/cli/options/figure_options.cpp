// SPDX-License-Identifier: MIT
#include "app/cli/options/figure_options.h"

#include <fmt/format.h>

#include "app/cli/options/vox_input.h"
#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {

namespace {

GraticuleSpacing graticule_from(const std::string& text) {
  if (text == "auto") return {};
  const double spacing = numbers_from(text, ',', 1, 1, "--graticule", "degrees, for example 0.5, or auto")[0];
  if (!(spacing > 0 && spacing <= 90))
    throw Error(fmt::format("--graticule '{}': expected degrees above 0 and at most 90, or auto", text));
  return {spacing};
}

}  // namespace

std::string_view FigureOptions::any() const {
  return legend           ? "--legend"
         : scale_bar      ? "--scale-bar"
         : north_arrow    ? "--north-arrow"
         : contour_labels ? "--contour-labels"
         : !title.empty() ? "--title"
         : graticule      ? "--graticule"
                          : std::string_view(draw.files.empty() ? "" : "--draw");
}

void add_figure_options(Command& command, FigureOptions& options, const bool& top, const std::string& output) {
  command.add(&options.legend,
              {.names = "--legend",
               .help = "legend of the colours in the lower right corner",
               .topic = Topic::figure,
               .common = true,
               .looks = {"shaded height steps cost error comanche level slope aspect", "its greys have no unit"}});
  command.add(&options.scale_bar, {.names = "--scale-bar",
                                   .help = "scale bar in the lower left corner",
                                   .note = "in perspective, valid at the centre",
                                   .topic = Topic::figure,
                                   .common = true});
  const Rule on_map = needs("--top (only maps have one)", [&top] { return top; });
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::figure;
    command.add(std::move(to), std::move(option));
  };
  add(&options.title,
      {.names = "--title", .value = "TEXT", .help = "title at the top, broken into at most three lines"});
  add(&options.north_arrow,
      {.names = "--north-arrow", .help = "arrow to true north", .note = "valid at the centre of the picture"});
  add([&options](const std::string& text) { options.graticule = graticule_from(text); },
      {.names = "--graticule",
       .value = "DEG",
       .help = "labelled meridians and parallels, DEG degrees apart",
       .choices = {"auto"},
       .unlisted = true,
       .note = "or auto",
       .fallback = "none",
       .inputs = {kTerrain, "only rasters are georeferenced", "only rasters are georeferenced"},
       .rules = {on_map}});
  add(&options.contour_labels,
      {.names = "--contour-labels",
       .help = "heights along every fifth contour line",
       .inputs = {kTerrain, "only maps of rasters have them", "only maps of rasters have them"},
       .looks = {"shaded comanche", "the others have no contour lines"},
       .rules = {on_map, needs("--contours M", [&command] { return command.given("--contours"); })}});
  add_draw_options(command, options.draw, Topic::figure, on_map);
  add(&options.layout, {.names = "--layout",
                        .value = "WHERE",
                        .help = "place of title, legend, scale bar, north arrow and labels of the graticule",
                        .choices = {"on", "beside"},
                        .closed = true,
                        .note = "beside: on white margins around the picture",
                        .rules = {needs("--legend, --scale-bar, --title, --north-arrow or --graticule", [&options] {
                          return !options.any().empty() && options.any() != "--contour-labels" &&
                                 options.any() != "--draw";
                        })}});
  add(&options.dots_per_inch,
      {.names = "--dpi",
       .help = "resolution of the picture on a page of PDF",
       .unit = "pixels per inch",
       .range = {10, 4800},
       .rules = {{"applies to .pdf files only", [&output] { return extension_of(output) == ".pdf"; }}}});
}

}  // namespace scarp::cli
