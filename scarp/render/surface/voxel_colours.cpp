// SPDX-License-Identifier: MIT
#include "scarp/render/surface/voxel_colours.h"

#include <memory>

#include "scarp/render/surface/surface_colour.h"

namespace scarp {

std::function<std::uint32_t(const SceneSurface&)> voxel_colours(std::span<const Material> materials) {
  return [colours = std::make_shared<const SurfaceColours>(materials)](const SceneSurface& surface) {
    const vec3 c = (*colours)(surface);
    return std::uint32_t{srgb_byte(c.x)} | std::uint32_t{srgb_byte(c.y)} << 8 | std::uint32_t{srgb_byte(c.z)} << 16;
  };
}

}  // namespace scarp
