// SPDX-License-Identifier: MIT
#include "app/cli/depth_options.h"

#include <limits>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {

void add_depth_options(CLI::App& command, DepthOptions& options) {
  const std::string group = "Depth";
  command
      .add_option("--depth-range", options.range,
                  "NEAR,FAR in metres: depth as the buffers of OpenGL and Vulkan have it; NEAR alone: "
                  "no far plane")
      ->group(group);
  command.add_flag("--depth-reversed", options.reversed, "1 at the near plane, 0 at the far one")->group(group);
}

std::optional<DepthRange> depth_range_of(const DepthOptions& options) {
  if (options.range.empty()) {
    if (options.reversed) throw Error("--depth-reversed: goes with --depth-range NEAR,FAR");
    return {};
  }
  const auto planes =
      numbers_from(options.range, ',', 1, 2, "--depth-range", "NEAR,FAR in metres, for example 1,50000");
  const DepthRange range{planes[0], planes.size() > 1 ? planes[1] : std::numeric_limits<double>::infinity(),
                         options.reversed};
  validate(range);
  return range;
}

}  // namespace scarp::cli
