// SPDX-License-Identifier: MIT
// Renders whole pictures of one terrain on a Vulkan device: stages generate rays, march them and shade their hits
// (terrain_frame.glsl.h), and only the pixels come back.
//
//   camera, settings ──▶ some hundred numbers ──▶ stages: rays, march, take, water, light, paint, resolve ──▶ Image
//
// Formulas are those of the CPU, from one text (sky.glsl.h, air.glsl.h, water.glsl.h, ground_paint.glsl.h,
// detail_texture.glsl.h, colour.glsl.h, sample_pattern.glsl.h, sample_directions.glsl.h), in single precision; rays are
// those of the marches (max-mip, fixed-step). render_picture() calls it for scenes on a device, see
// makes_whole_frames().
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/scene.h"
#include "scarp/vk/shader_program.h"

namespace scarp {

/// Whether a picture is rendered whole on the device: requires max-mip or fixed-step, and an eye less than 2^22 cells
/// away.
bool makes_whole_frames(const Scene& scene, const Camera& camera, const PictureSettings& settings);

/// Hit of the camera ray through a pixel's first point.
struct FrameSighting {
  enum class Kind : std::uint8_t { nothing, ground, wall, water };
  Kind kind = Kind::nothing;
  double t = 0;  ///< metres
  Cell cell{};   ///< of ground and walls
  std::uint32_t steps = 0;
};

/// Further results of a frame.
struct FrameReport {
  bool tells_sightings = false;            ///< input: hits of rays cost memory and a copy
  std::vector<FrameSighting> sightings{};  ///< pixel by pixel, rows from the top
  std::optional<double> device_s{};        ///< time on the device's clock; nullopt without timestamps
};

/// The looks `comanche` (not scaled up) and `shaded`. `settings` are valid and makes_whole_frames(). Throws Error if
/// the device lacks memory or is lost, or the eye is under water. Throws Interrupted if `progress` returns false.
Image render_whole_frame(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                         const Progress& progress = {}, FrameReport* report = nullptr);

/// The shaders of frames, as specialised for usual pictures.
std::vector<ShaderProgram> terrain_frame_shaders();

}  // namespace scarp
