// SPDX-License-Identifier: MIT
// Pictures of one terrain on a Vulkan device, made there as a whole: stages make rays, march them and paint what they
// meet (terrain_frame.glsl.h), and only the pixels come back.
//
//   camera, settings ──▶ some hundred numbers ──▶ stages: rays, march, take, water, light, paint, resolve ──▶ Image
//
// Formulas are those of the CPU, from one text (sky.glsl.h, air.glsl.h, water.glsl.h, ground_paint.glsl.h,
// detail_texture.glsl.h, colour.glsl.h, sample_pattern.glsl.h, sample_directions.glsl.h), in single precision; rays are
// those of the marches (max-mip, fixed-step). render_picture() comes here for scenes that a device answers, see
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

/// Whether such a picture is made there as a whole: max-mip or fixed-step, and an eye less than 2^22 cells off.
bool makes_whole_frames(const Scene& scene, const Camera& camera, const PictureSettings& settings);

/// What the ray of the camera through a pixel's first point met.
struct FrameSighting {
  enum class Kind : std::uint8_t { nothing, ground, wall, water };
  Kind kind = Kind::nothing;
  double t = 0;  ///< metres
  Cell cell{};   ///< of ground and walls
  std::uint32_t steps = 0;
};

/// What else is known of a frame.
struct FrameReport {
  bool tells_sightings = false;            ///< asked for: rays' findings cost memory and a copy
  std::vector<FrameSighting> sightings{};  ///< pixel by pixel, rows from the top
  std::optional<double> device_s{};        ///< what it took by the device's clock; nothing where it has none
};

/// The looks `comanche` (not scaled up) and `shaded`. `settings` are valid and makes_whole_frames(). Throws Error: no
/// memory on the device, the device is lost, the eye is under the water; Interrupted when progress asks for it.
Image render_whole_frame(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                         const Progress& progress = {}, FrameReport* report = nullptr);

/// The shaders of frames, as specialised for usual pictures.
std::vector<ShaderProgram> terrain_frame_shaders();

}  // namespace scarp
