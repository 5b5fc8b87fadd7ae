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

/// Typed options.
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

/// Returns the settings that do not depend on the field. Throws Error.
void settle_look(const LookOptions& options, const MarchSettings& march_settings, PictureSettings& picture);

/// Sets water and fog. Called again after a scene file has added its own.
void settle_environment(const LookOptions& options, PictureSettings& picture);

/// Reads the image of --overlay for a raster of `cols` x `rows` samples, or for any scene without a georeference.
/// Images with more than `most_pixels` over the raster are averaged. Returns all files that were opened.
std::vector<std::string> read_overlay_files(const LookOptions& options, const Georeference& georeference, int cols,
                                            int rows, bool mirror, std::int64_t most_pixels, PictureSettings& picture);

/// Sets defaults that depend on the scene: visibility, base and falloff of the fog. `across` and `heights` are the
/// extent of the picture in metres; `heights` are exaggerated.
void finish_look(const LookOptions& options, double across, const ReliefRange& heights, double exaggeration,
                 PictureSettings& picture);
/// A camera far from the scene must still see it: without --visibility, the visibility grows by ten times the distance
/// to the box, over which less than a third of the contrast is lost.
void see_from_afar(const LookOptions& options, const WorldBox& box, const Camera& camera, PictureSettings& picture);

/// Returns the length of camera rays: infinite, except over wrapped ground. There, without --reach, it is `across`,
/// plus twice the distance to the box from outside, so that an eye that sees all of the ground sees its corners.
double reach_of(const LookOptions& options, double across, const Scene& scene, const WorldBox& box,
                const Camera& camera);

}  // namespace scarp::cli
