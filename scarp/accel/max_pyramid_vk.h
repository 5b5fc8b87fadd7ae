// SPDX-License-Identifier: MIT
// Builds the maximum and minimum pyramid on a Vulkan device, and the quads: one pass of max_pyramid.comp and one of
// max_quads.comp per level. Entries equal those of MaxPyramid bit for bit, at any size and after any edit. Used by
// DeviceGround.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/pyramid_levels.h"
#include "scarp/field/height_field.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"
#include "scarp/vk/pipeline.h"
#include "scarp/vk/shader_program.h"

namespace scarp {

/// The shader that builds pyramids.
std::vector<ShaderProgram> pyramid_shaders();

/// The compute passes that build a pyramid.
class PyramidPasses {
 public:
  explicit PyramidPasses(const Device& device);

  /// Records the passes that recompute all entries over `changed`, finer levels first, with barriers before and
  /// between. `ground` is the address of the field's GroundBuffers, `codes` the address of the tables for float
  /// samples. Raises cell_relief on the device.
  void record(Commands& commands, std::uint64_t ground, std::uint64_t codes, const HeightField& field,
              const CellBox& changed) const;

 private:
  ComputePipeline entries_, quads_;
};

}  // namespace scarp
