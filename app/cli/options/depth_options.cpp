// SPDX-License-Identifier: MIT
#include "app/cli/options/depth_options.h"

#include <limits>

#include "app/options/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

DepthRange range_from(const std::string& text) {
  const auto planes =
      numbers_from(text, ',', 1, 2, "--depth-range", "NEAR,FAR in metres, for example 1,50000, or auto");
  const DepthRange range{planes[0], planes.size() > 1 ? planes[1] : std::numeric_limits<double>::infinity()};
  validate(range);
  return range;
}

}  // namespace

void add_depth_options(Command& command, DepthOptions& options) {
  command.add(
      [&options](const std::string& text) {
        options.fitted = text == "auto";
        options.range = options.fitted ? std::nullopt : std::optional(range_from(text));
      },
      {.names = "--depth-range",
       .value = "NEAR[,FAR]",
       .help = "near and far plane of the depth buffer in metres, as in OpenGL and Vulkan",
       .note = "without FAR: no far plane; auto, in scarp render: those that fit the picture",
       .topic = Topic::depth,
       .looks = {"shaded comanche", "EXR pictures of the others have no depth"}});
  command.add(&options.reversed,
              {.names = "--depth-reversed",
               .help = "reversed depth: 1 at the near plane, 0 at the far plane",
               .topic = Topic::depth,
               .rules = {needs("--depth-range NEAR,FAR", [&options] { return options.range || options.fitted; })}});
}

std::optional<DepthRange> depth_range_of(const DepthOptions& options) {
  if (options.fitted) throw Error("--depth-range auto: reading depths takes their planes (name NEAR,FAR)");
  std::optional<DepthRange> range = options.range;
  if (range) range->reversed = options.reversed;
  return range;
}

}  // namespace scarp::cli
