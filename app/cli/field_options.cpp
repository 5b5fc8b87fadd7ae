// SPDX-License-Identifier: MIT
#include "app/cli/field_options.h"

#include <string>
#include <utility>
#include <vector>

namespace scarp::cli {

void add_field_options(Command& command, FieldOptions& options, BeyondBorders borders) {
  constexpr Inputs kSurfaces{kTerrain, "it shapes the surface between the samples of rasters"};
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::surface;
    option.inputs = kSurfaces;
    command.add(std::move(to), std::move(option));
  };
  add(&options.exaggeration, {.names = "--exaggeration",
                              .help = "factor of all heights",
                              .range = {.least = 0, .most = kMostOfGround, .above_least = true},
                              .common = true});
  add([&options](
          const std::string& text) { options.surface = text == "triangles" ? Surface::triangles : Surface::bilinear; },
      {.names = "--surface",
       .value = "KIND",
       .help = "surface between samples",
       .choices = {"bilinear", "triangles"},
       .closed = true,
       .note = "triangles: two per cell",
       .fallback = "bilinear"});
  if (borders != BeyondBorders::none) {
    const bool mirrors = borders == BeyondBorders::mirrors;
    std::vector<std::string> choices{"none", "periodic", "shared"};
    if (mirrors) choices.emplace_back("mirror");
    add(
        [&options](const std::string& text) {
          options.mirror = text == "mirror";
          options.wrap = text == "shared"                       ? Wrap::shared_border
                         : text == "periodic" || options.mirror ? Wrap::periodic
                                                                : Wrap::none;
        },
        {.names = "--wrap",
         .value = "KIND",
         .help = "continuation beyond the border",
         .choices = std::move(choices),
         .closed = true,
         .note = std::string("periodic: the first column follows the last; shared: the last column repeats the first") +
                 (mirrors ? "; mirror: mirror images, without a seam" : ""),
         .fallback = "none"});
  }
  add(&options.solid, {.names = "--solid", .help = "rock under the surface: rays hit the walls at borders and holes"});
}

}  // namespace scarp::cli
