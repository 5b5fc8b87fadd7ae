// SPDX-License-Identifier: MIT
// Triangles on a device: images that they are drawn into, and the shaders that draw.
//
//   RasterTarget target(device, width, height, 1);
//   RasterPipeline pipeline(device, kVertexWords, kFragmentWords, "mesh", {.push_bytes = sizeof(Push)});
//   commands.draw(target, {draw_call(pipeline, push, corners)});       commands.h
//   commands.copy(target, 0, colours);  commands.copy(target, 1, depths);
//
// There is no window and no vertex format: vertex shaders fetch what they need from buffers, by addresses in their push
// constants and gl_VertexIndex. Depths are 32-bit floats, and what has the larger one is in front: 1 at the near plane,
// 0 at the far one ("reversed"), with which floats keep their precision far away. No face is culled.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

/// Images of one size: colours, each of four 32-bit floats, and one of depths.
class RasterTarget {
 public:
  /// Throws Error: the device does not draw, or not so large images (both at least 1 pixel); no memory.
  RasterTarget(const Device& device, std::uint32_t width, std::uint32_t height, std::uint32_t colours);
  RasterTarget(RasterTarget&&) noexcept;
  RasterTarget& operator=(RasterTarget&&) noexcept;
  ~RasterTarget();

  std::uint32_t width() const;
  std::uint32_t height() const;

  struct Impl;  // raii.h
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// The most pixels along a side of a target, and the bits of a pixel that corners' places are rounded to: a corner lies
/// within 2^-(bits + 1) pixel of where its shader put it, along either axis.
struct RasterLimits {
  std::uint32_t most_pixels = 0;
  std::uint32_t subpixel_bits = 0;
};
RasterLimits raster_limits(const Device& device);

struct RasterSettings {
  std::uint32_t push_bytes = 0;  ///< of the block that both shaders see; a multiple of 4, at most kMaxPushBytes
  std::uint32_t colours = 1;     ///< of the target
  bool depth_test = true;        ///< false: every fragment is drawn, and its depth is written
};

class RasterPipeline {
 public:
  /// Vertex and fragment shader, entry point main, without bindings; the fragment's words may be empty where there are
  /// no colours. `constants` as for ComputePipeline, for both. Throws Error: the device does not draw, the driver
  /// refuses the shaders.
  RasterPipeline(const Device& device, std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment,
                 const std::string& name, const RasterSettings& settings,
                 std::span<const std::uint32_t> constants = {});
  RasterPipeline(RasterPipeline&&) noexcept;
  RasterPipeline& operator=(RasterPipeline&&) noexcept;
  ~RasterPipeline();

  const std::string& name() const;

  struct Impl;  // raii.h
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Triangles of one pipeline; `push` and `indices` must live until they are recorded and have run.
struct DrawCall {
  const RasterPipeline* pipeline;
  const void* push;
  std::uint32_t push_bytes;
  std::uint32_t count;                    ///< corners (or indices): three per triangle
  std::uint32_t instances = 1;            ///< how often they are drawn, by gl_InstanceIndex
  const DeviceBuffer* indices = nullptr;  ///< 32 bits each, from its begin: the values of gl_VertexIndex
};

template <class Push>
DrawCall draw_call(const RasterPipeline& pipeline, const Push& push, std::uint32_t count, std::uint32_t instances = 1,
                   const DeviceBuffer* indices = nullptr) {
  static_assert(std::is_trivially_copyable_v<Push>);
  return {&pipeline, &push, sizeof push, count, instances, indices};
}

}  // namespace scarp
