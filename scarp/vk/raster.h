// SPDX-License-Identifier: MIT
// Triangle rasterisation: render targets and graphics pipelines.
//
//   RasterTarget target(device, width, height, 1);
//   RasterPipeline pipeline(device, kVertexWords, kFragmentWords, "mesh", {.push_bytes = sizeof(Push)});
//   commands.draw(target, {draw_call(pipeline, push, corners)});       commands.h
//   commands.copy(target, 0, colours);  commands.copy(target, 1, depths);
//
// There are no windows and no vertex formats: vertex shaders fetch data from buffers through addresses in push
// constants and gl_VertexIndex. Depths are 32-bit floats, reversed: 1 at the near plane, 0 at the far plane, larger is
// nearer. Reversed floats keep their precision at large distances. No faces are culled.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "scarp/vk/device.h"
#include "scarp/vk/memory.h"

namespace scarp {

/// A pixel of a colour image has four 32-bit numbers, of one of these types.
enum class RasterColours : std::uint8_t { floats, words };

/// Images of one size: colour images of one format, and one depth image.
class RasterTarget {
 public:
  /// Throws Error if the device does not support graphics or this size (each side at least 1 pixel), or lacks memory.
  RasterTarget(const Device& device, std::uint32_t width, std::uint32_t height, std::uint32_t colours,
               RasterColours of = RasterColours::floats);
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

/// Maximum pixels per side of a target, and sub-pixel bits of vertex positions: along either axis, a vertex is within
/// 2^-(bits + 1) pixels of the position that its shader computes.
struct RasterLimits {
  std::uint32_t most_pixels = 0;
  std::uint32_t subpixel_bits = 0;
};
RasterLimits raster_limits(const Device& device);

/// Settings of a RasterPipeline.
struct RasterSettings {
  std::uint32_t push_bytes = 0;  ///< size of the block shared by both shaders; a multiple of 4, at most kMaxPushBytes
  std::uint32_t colours = 1;     ///< number of colour images of the target
  bool depth_test = true;        ///< false: draws every fragment and writes its depth
  RasterColours of = RasterColours::floats;  ///< as in the target
};

/// A vertex and a fragment shader with their layout.
class RasterPipeline {
 public:
  /// The shaders have the entry point main and no bindings; `fragment` may be empty without colours. `constants` as for
  /// ComputePipeline, for both shaders. Throws Error if the device does not support graphics or the driver rejects a
  /// shader.
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

/// Triangles drawn with one pipeline. `push` and `indices` must live until the draw has run.
struct DrawCall {
  const RasterPipeline* pipeline;
  const void* push;
  std::uint32_t push_bytes;
  std::uint32_t count;                    ///< vertices (or indices), three per triangle
  std::uint32_t instances = 1;            ///< number of instances, numbered by gl_InstanceIndex
  const DeviceBuffer* indices = nullptr;  ///< 32-bit values of gl_VertexIndex, from the start of the buffer
};

template <class Push>
DrawCall draw_call(const RasterPipeline& pipeline, const Push& push, std::uint32_t count, std::uint32_t instances = 1,
                   const DeviceBuffer* indices = nullptr) {
  static_assert(std::is_trivially_copyable_v<Push>);
  return {&pipeline, &push, sizeof push, count, instances, indices};
}

}  // namespace scarp
