// SPDX-License-Identifier: MIT
// The options of pictures with water, fog and few large pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "scarp/base/georeference.h"
#include "scarp/march/march_settings.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// What was typed.
struct LookOptions {
  std::optional<double> water, visibility, fog_base, fog_falloff, reach;
  std::string water_colour, fog, lowres;
  WaterSettings water_settings;
  FogSettings fog_settings;
  ComancheSettings comanche;
  GroundPaintSettings ground;
  std::string ground_colours, ramp, ramp_range, overlay, detail_texture;
  std::optional<double> snow_line;
  bool no_refraction = false, no_reflection = false;
};

void add_look_options(Command& command, LookOptions& options);

/// The settings that do not depend on the field. Throws Error.
void settle_look(const LookOptions& options, const MarchSettings& march_settings, PictureSettings& picture);

/// Sets water and fog. Called again after a scene file has added its own.
void settle_environment(const LookOptions& options, PictureSettings& picture);

/// Reads the image of --overlay for a raster of `cols` x `rows` samples, or for any scene if there is no georeference.
/// With more than `most_pixels` over the raster it is averaged. Returns all files that were opened.
std::vector<std::string> read_overlay_files(const LookOptions& options, const Georeference& georeference, int cols,
                                            int rows, bool mirror, std::int64_t most_pixels, PictureSettings& picture);

/// What follows from the scene where nothing was given: visibility, base and falloff of the fog. `across` and `heights`
/// are metres that the picture is about; `heights` are exaggerated.
void finish_look(const LookOptions& options, double across, const ReliefRange& heights, double exaggeration,
                 PictureSettings& picture);
/// A camera that stands back from the scene still has to see it: without --visibility that grows by ten times the way
/// to the box, on which less than a third of a contrast is lost.
void see_from_afar(const LookOptions& options, const WorldBox& box, const Camera& camera, PictureSettings& picture);

/// How far the camera's rays go: infinitely far, except over ground that wraps round. There, without --reach, `across`,
/// and from outside of the box twice the way to it more, so that an eye that sees all of the ground sees its corners.
double reach_of(const LookOptions& options, double across, const Scene& scene, const WorldBox& box,
                const Camera& camera);

}  // namespace scarp::cli
