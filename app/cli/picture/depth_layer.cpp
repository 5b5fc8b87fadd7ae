// SPDX-License-Identifier: MIT
#include "app/cli/picture/depth_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace scarp::cli {
namespace {

// The last value before that of the background, in the order of depths.
float last_depth(bool reversed) { return reversed ? std::numeric_limits<float>::min() : std::nextafter(1.0f, 0.0f); }

std::string planes_text(const DepthRange& range) { return fmt::format("{:g},{:g}", range.near_m, range.far_m); }

// The planes of two digits that enclose all surfaces; nullopt if there are none.
std::optional<DepthRange> fitting_range(const std::vector<float>& view_depths) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const float z : view_depths) {
    if (!std::isfinite(z)) continue;
    nearest = std::min(nearest, double{z}), farthest = std::max(farthest, double{z});
  }
  if (!(nearest > 0 && nearest <= farthest)) return {};
  const auto digit = [](double z) { return std::pow(10.0, std::floor(std::log10(z)) - 1); };
  return DepthRange{std::floor(nearest / digit(nearest)) * digit(nearest),
                    (std::floor(farthest / digit(farthest)) + 1) * digit(farthest)};
}

std::string note_on(const std::vector<float>& view_depths, const DepthRange& range) {
  std::ptrdiff_t before = 0, beyond = 0;
  for (const float z : view_depths) {
    if (!std::isfinite(z)) continue;
    before += (z < range.near_m);
    beyond += (z > range.far_m);
  }
  const auto fitting = fitting_range(view_depths);
  if (before + beyond == 0 || !fitting) return {};
  std::string text = fmt::format("--depth-range {}:", planes_text(range));
  if (before > 0) text += fmt::format(" {} pixels are in front of the near plane and get its depth;", before);
  if (beyond > 0) text += fmt::format(" {} pixels are beyond the far plane and get its depth;", beyond);
  return text + fmt::format(" --depth-range {} encloses all", planes_text(*fitting));
}

}  // namespace

DepthLayer depth_layer(const std::vector<float>& view_depths, const DepthOptions& options) {
  DepthLayer layer;
  if (!options.buffer()) return layer;
  std::optional<DepthRange> range = options.range;
  if (!range) {
    range = fitting_range(view_depths);
    if (range) layer.note = fmt::format("depth: the planes are those of --depth-range {}", planes_text(*range));
    if (!range) range = DepthRange{};
  } else {
    layer.note = note_on(view_depths, *range);
  }
  range->reversed = options.reversed;
  const float last = last_depth(options.reversed);
  layer.values.reserve(view_depths.size());
  for (const float z : view_depths) {
    const float depth = static_cast<float>(device_depth(z, *range));
    const bool surface = std::isfinite(z);
    layer.values.push_back(!surface           ? depth
                           : options.reversed ? std::clamp(depth, last, 1.0f)
                                              : std::clamp(depth, 0.0f, last));
  }
  return layer;
}

}  // namespace scarp::cli
