// SPDX-License-Identifier: MIT
// Renders whole pictures of one terrain on a Vulkan device: stages generate rays, march them and shade their hits
// (terrain_frame.glsl.h), and only the pixels come back.
//
//   camera, settings ──▶ a few hundred numbers ──▶ stages: rays, march, take, water, light, paint, resolve ──▶ Image
//
// Formulas are shared with the CPU (sky.glsl.h, air.glsl.h, water.glsl.h, ground_paint.glsl.h, detail_texture.glsl.h,
// colour.glsl.h, sample_pattern.glsl.h, sample_directions.glsl.h), but in single precision; the marches max-mip and
// fixed-step trace the rays. render_picture() calls it for scenes on a device; see makes_whole_frames().
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
  bool tells_sightings = false;            ///< input: whether to return hits, which cost memory and a copy
  std::vector<FrameSighting> sightings{};  ///< pixel by pixel, rows from the top
  std::optional<double> device_s{};        ///< time on the device's clock; nullopt without timestamps
};

/// Renders the looks `comanche` (not scaled up) and `shaded`. `settings` must be valid, and makes_whole_frames() true.
/// Throws Error if the device lacks memory or is lost, or the eye is under water. Throws Interrupted if `progress`
/// returns false.
Image render_whole_frame(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                         const Progress& progress = {}, FrameReport* report = nullptr);

/// The shaders of frames, specialised for typical pictures.
std::vector<ShaderProgram> terrain_frame_shaders();

}  // namespace scarp
