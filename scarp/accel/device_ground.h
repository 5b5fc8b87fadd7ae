// SPDX-License-Identifier: MIT
// A height field in device memory: its samples, and its pyramid, which the device builds. Shaders read it through
// ground_buffers.glsl.h, from one address:
//
//   const DeviceGround ground(device, field);
//   push.ground = ground.address();               // Address in the push constants of the shader
//   Ground(push.ground) ... ground_cell(...)      // in GLSL
//
// Memory: the samples (odd rows of 16-bit samples are padded), 4/3 bytes per cell for the pyramid and 3 for the maxima
// in the order in which shaders traverse them (quads). The samples must fit in one device allocation and in 2^31 - 1
// words.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/accel/height_code.h"
#include "scarp/accel/pyramid_levels.h"
#include "scarp/field/height_field.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

class PyramidPasses;  // max_pyramid_vk.h

/// A height field and its pyramid in device memory.
class DeviceGround {
 public:
  /// Copies the samples and builds the pyramid. `reserve` as in MaxPyramid. Throws Error if the device lacks memory
  /// (stating the size) or is lost.
  DeviceGround(const Device& device, const HeightField& field,
               const std::optional<SampleRange>& reserve = std::nullopt);
  DeviceGround(DeviceGround&&) noexcept;
  DeviceGround& operator=(DeviceGround&&) noexcept;
  ~DeviceGround();

  /// Updates the device after an edit of the same field: copies the samples around `changed` and recomputes the pyramid
  /// entries over it, as MaxPyramid::update() does. Rebuilds all entries if float samples leave the range of the codes.
  void update(const HeightField& field, const CellBox& changed);

  /// Address of the GroundBuffers.
  std::uint64_t address() const { return header_.address(); }
  /// Layout of the buffers on the device.
  const glsl::GroundBuffers& layout() const { return layout_; }
  const HeightCode& code() const { return code_; }
  const std::vector<PyramidLevel>& levels() const { return levels_; }
  /// Size on the device, in bytes.
  std::uint64_t bytes() const;
  /// Returns all entries, level 1 first: maximum code | minimum code << 16.
  std::vector<std::uint32_t> read_pyramid() const;
  /// Passes of the last build or update, in order.
  const std::vector<PassTime>& passes() const { return commands_.passes(); }

 private:
  void set_range(const SampleRange& range, SampleType type);
  void copy_samples(const HeightField& field, const SampleRect& rect);
  void build(const HeightField& field, const CellBox& changed);

  std::vector<PyramidLevel> levels_;
  SampleRange range_;
  HeightCode code_;
  glsl::GroundBuffers layout_{};
  DeviceBuffer samples_, pyramid_, quads_, header_;
  std::optional<DeviceBuffer> codes_;  // float samples only
  std::unique_ptr<PyramidPasses> passes_;
  Commands commands_;
};

}  // namespace scarp
