// SPDX-License-Identifier: MIT
#include "scarp/vk/first_drawing.h"

#include <algorithm>

#include "scarp/vk/commands.h"
#include "scarp/vk/raii.h"
#include "scarp/vk/raster.h"

namespace scarp {
namespace {

constexpr std::uint32_t kVertexWords[] = {
#include "scarp/vk/first_drawing.vert.inc"
};

constexpr double kSeconds = 10;
constexpr std::uint32_t kSide = 8;

// Shortens a device's time limit during its lifetime.
class ShorterLimit {
 public:
  explicit ShorterLimit(Device::Impl& device) : device_(device), usual_(device.timeout_s) {
    device.timeout_s = std::min(usual_, kSeconds);
  }
  ShorterLimit(const ShorterLimit&) = delete;
  ShorterLimit& operator=(const ShorterLimit&) = delete;
  ~ShorterLimit() { device_.timeout_s = usual_; }

 private:
  Device::Impl& device_;
  double usual_;
};

}  // namespace

void try_first_drawing(const Device& device) {
  Device::Impl& open = *device.impl();
  if (open.has_drawn) return;
  open.has_drawn = true;  // prevents recursion
  const ShorterLimit limit(open);
  // Depth only, which needs no fragment shader.
  const RasterTarget target(device, kSide, kSide, 0);
  const RasterPipeline triangle(device, kVertexWords, {}, "a first drawing", {.colours = 0});
  Commands commands(device);
  commands.draw(target, {{&triangle, nullptr, 0, 3}});
  commands.run();
}

}  // namespace scarp
