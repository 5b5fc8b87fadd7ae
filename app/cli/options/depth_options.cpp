// SPDX-License-Identifier: MIT
#include "app/cli/options/depth_options.h"

#include <limits>

#include "app/options/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

constexpr const char* kReversed = "reversed depth: 1 at the near plane, 0 at the far plane";

DepthRange range_from(const std::string& text, const std::string& expected) {
  const auto planes = numbers_from(text, ',', 1, 2, "--depth-range", expected);
  const DepthRange range{planes[0], planes.size() > 1 ? planes[1] : std::numeric_limits<double>::infinity()};
  validate(range);
  return range;
}

}  // namespace

void add_depth_options(Command& command, DepthOptions& options) {
  constexpr Looks kLooks{"shaded comanche", "EXR pictures of the others have no depth"};
  command.add(
      [&options](const std::string& text) {
        options.fitted = text == "auto";
        options.range = options.fitted
                            ? std::nullopt
                            : std::optional(range_from(text, "NEAR,FAR in metres, for example 1,50000, or auto"));
      },
      {.names = "--depth-range",
       .value = "NEAR[,FAR]",
       .help =
           "add the channel 'depth' of a depth buffer with this near and far plane in metres, as in OpenGL and Vulkan",
       .note = "without FAR: no far plane; auto: those that fit the picture",
       .fallback = "none: depth in metres alone, channel Z; auto with --depth-reversed",
       .topic = Topic::depth,
       .looks = kLooks});
  command.add(&options.reversed,
              {.names = "--depth-reversed", .help = kReversed, .topic = Topic::depth, .looks = kLooks});
}

void add_read_depth_options(Command& command, DepthOptions& options) {
  command.add(
      [&options](const std::string& text) {
        if (text == "auto")
          throw WrongUsage(
              "--depth-range auto: depths of a buffer are read with the planes they were written with "
              "(name NEAR,FAR; 'scarp render' prints them)");
        options.range = range_from(text, "NEAR,FAR in metres, for example 1,50000");
      },
      {.names = "--depth-range",
       .value = "NEAR[,FAR]",
       .help = "near and far plane of their depth buffer in metres, as in OpenGL and Vulkan",
       .note = "without FAR: no far plane",
       .fallback = "none: depths in metres",
       .topic = Topic::depth});
  command.add(&options.reversed,
              {.names = "--depth-reversed",
               .help = kReversed,
               .topic = Topic::depth,
               .rules = {needs("--depth-range NEAR,FAR", [&options] { return options.range.has_value(); })}});
}

std::optional<DepthRange> depth_range_of(const DepthOptions& options) {
  std::optional<DepthRange> range = options.range;
  if (range) range->reversed = options.reversed;
  return range;
}

}  // namespace scarp::cli
