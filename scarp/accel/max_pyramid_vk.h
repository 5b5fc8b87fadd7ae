// SPDX-License-Identifier: MIT
// The maximum and minimum pyramid made on a Vulkan device: max_pyramid.comp, one pass for each level. Its entries are
// bit for bit those of MaxPyramid, at any size and after any edit. DeviceGround uses it.
#pragma once

#include <cstdint>
#include <vector>

#include "scarp/accel/pyramid_levels.h"
#include "scarp/field/height_field.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"
#include "scarp/vk/pipeline.h"

namespace scarp {

class PyramidPasses {
 public:
  explicit PyramidPasses(const Device& device);

  /// Records the passes that make all entries over `changed` anew, finer levels first, with barriers before and
  /// between. `ground` is the address of the field's GroundBuffers, `codes` that of the tables of float samples.
  void record(Commands& commands, std::uint64_t ground, std::uint64_t codes, const HeightField& field,
              const CellBox& changed) const;

 private:
  ComputePipeline pipeline_;
};

}  // namespace scarp
