// SPDX-License-Identifier: MIT
// Private to the station: runs the stages of a picture of a height field on its device (terrain_frame.glsl.h).
//
//   a part of the picture ──▶ rays, march, take, water, ..., resolve, point by point ──▶ its pixels ──▶ the next part
//
// Between stages only counts come back. A part is as large as fits in kMemory: a pixel takes 428 bytes, or 1,032 with
// water, where it may have two rays at once.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/march/height/device_march_vk.h"
#include "scarp/render/frame/kept_buffer_vk.h"
#include "scarp/render/frame/terrain_frame.glsl.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/device.h"
#include "scarp/vk/pipeline.h"
#include "scarp/vk/shader_program.h"

namespace scarp {

/// A picture in the form that the stages need.
struct FrameWork {
  const glsl::FrameSettings* numbers = nullptr;
  std::uint64_t settings = 0;  ///< address of the numbers
  std::uint64_t ground = 0;    ///< address
  std::uint64_t sights = 0;    ///< address of a FrameSight per pixel; 0: not requested
  std::uint32_t parts = 0;     ///< kFrameHas...
  std::uint32_t field_flags = 0;
  std::uint32_t sample_type = 0;  ///< GroundBuffers::sample_type
  bool exact_only = false;        ///< leaves_first_pass() of the field
};

/// For pictures of one march. Keeps shaders and memory from picture to picture. Not thread-safe.
class FrameStages {
 public:
  /// `stepped`: fixed-step instead of max-mip.
  FrameStages(const Device& device, bool stepped);
  FrameStages(const FrameStages&) = delete;
  FrameStages& operator=(const FrameStages&) = delete;

  /// Calls take(first, words) with the words of all pixels, part by part. Returns the seconds by the device's clock, if
  /// it has one. Throws Error if the device lacks memory or is lost. Throws Interrupted if `progress` returns false.
  std::optional<double> run(const FrameWork& work, const Progress& progress,
                            const std::function<void(std::int64_t first, std::span<const std::uint32_t> words)>& take);

  /// Returns the shaders of the stages, as specialised for a picture with shadows, and for one with water and fog.
  static std::vector<ShaderProgram> shaders();

 private:
  static constexpr std::uint64_t kMemory = 128 << 20;

  struct Stage;
  enum class Take : std::uint8_t { sights, sights_and_grounds, light };
  void reserve(std::uint32_t pixels);
  void make_point(int point);
  void see_through_water();
  void light_grounds();
  static ShaderProgram program_of(const Stage& stage, Take take, bool stepped, std::uint32_t parts,
                                  std::uint32_t field_flags);
  const ComputePipeline& pipeline(const Stage& stage, Take take);
  void record(const Stage& stage, std::uint32_t threads, Take take = Take::sights);
  void clear(std::uint64_t offset, std::uint64_t bytes);
  void submit();
  void march(const DeviceRayQuery& query);

  using PipelineKey = std::pair<std::uint32_t, std::vector<std::uint32_t>>;  // stage, constants
  Device device_;
  bool stepped_;
  DeviceHeightMarch march_;
  Commands commands_;
  std::map<PipelineKey, ComputePipeline> pipelines_;
  KeptBuffer seens_{"what rays see"}, waters_{"where pixels see water"}, rays_{"rays"}, hits_{"hits"},
      owners_{"owners of rays"}, grounds_{"grounds in sight"}, counters_{"counts of rays"}, sums_{"sums of pixels"},
      pixels_{"pixels"};
  std::vector<std::uint32_t> words_;
  // State of the current picture.
  const FrameWork* work_ = nullptr;
  const Progress* progress_ = nullptr;
  double done_ = 0;  // fraction of the picture
  std::optional<double> device_s_;
  glsl::FramePush push_{};
  glsl::FrameCounters counts_{};  // as of the last submit()
  DeviceRayQuery sight_, light_;
};

}  // namespace scarp
