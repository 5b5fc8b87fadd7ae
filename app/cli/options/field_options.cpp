// SPDX-License-Identifier: MIT
#include "app/cli/options/field_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "app/options/numbers.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {
namespace {

constexpr NumberRange kExaggerations{.least = 0, .most = kMostOfGround, .above_least = true};

void set_exaggeration(const std::string& text, FieldOptions& options, Exaggeration* exaggeration) {
  if (text == "auto") {
    if (!exaggeration) throw WrongUsage("--exaggeration 'auto': applies to pictures only (give a number)");
    *exaggeration = {.given = true, .chosen = true};
    return;
  }
  const std::string wrong = number_in(kExaggerations)(text);
  if (!wrong.empty()) throw WrongUsage("--exaggeration " + wrong);
  options.exaggeration = std::strtod(text.c_str(), nullptr);
  if (exaggeration) *exaggeration = {.given = true};
}

}  // namespace

double chosen_exaggeration(double relief, double side) {
  // As steep as the Alps across a whole range: clearly visible, and still natural.
  constexpr double kShare = 0.1;
  if (!(relief > 0)) return 1;
  const double most = std::min(kShare * side / relief, kMostOfGround);
  if (!(most > 1)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  return most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
}

std::string flatness_note(double relief, double side) {
  // Height of the relief in pixels if the longer side of the ground fills a picture of the default width, as in the
  // default view: a smaller relief looks flat.
  constexpr double kLeastPixels = 4;
  const double width = PictureSettings{}.width;
  if (relief * width >= kLeastPixels * side) return {};
  if (!(relief > 0)) return "the ground is level: it has no relief to show";
  return fmt::format(
      "the relief of {} m over {} m hardly shows (--exaggeration auto, or a factor such as {:g}, raises it)",
      metres_text(relief), metres_text(side), chosen_exaggeration(relief, side));
}

std::string no_ground_note(const HeightField& field) {
  if (field.has_ground()) return {};
  if (!field.has_cells()) return "a single row or column has no cells: every ray misses";
  const double cells = static_cast<double>(field.cell_cols()) * field.cell_rows();
  return fmt::format(
      "none of the {:.0f} cells has four valid samples: every ray misses (is the nodata value right? --nodata)", cells);
}

void add_field_options(Command& command, FieldOptions& options, BeyondBorders borders, Exaggeration* exaggeration) {
  constexpr Inputs kSurfaces{kTerrain, "it shapes the surface between the samples of rasters"};
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::surface;
    option.inputs = kSurfaces;
    command.add(std::move(to), std::move(option));
  };
  add([&options, exaggeration](const std::string& text) { set_exaggeration(text, options, exaggeration); },
      {.names = "--exaggeration",
       .value = "F",
       .help = "factor of all heights",
       .range = kExaggerations,
       .note = exaggeration ? "auto: by the relief" : "",
       .fallback = "1",
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
