// SPDX-License-Identifier: MIT
// `scarp profile --march`: marches along a ray over the profile of the ground, as a figure. Requires Cairo.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options/map_input.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/base/ray.h"
#include "scarp/march/march_settings.h"

namespace scarp::cli {

struct ProfileMarchOptions {
  std::vector<std::string> names;  ///< of marches; empty: a plain profile
  std::string ray;                 ///< X,Y,Z,DX,DY,DZ; empty: from --from to --to
  MarchSettings settings;
};

/// Declares --march, --ray and the settings of marches.
void add_profile_march_options(Command& command, ProfileMarchOptions& options, const std::string& output);

/// Throws Error for a march that does not exist or records no steps, and for settings of marches that are not drawn.
void check_marches(const Command& command, const ProfileMarchOptions& options);

/// A ray over an elevation model.
struct ProfileRay {
  HeightField field;  ///< with the lengths of its cells at the start of the ray
  Ray ray;            ///< in metres over the field; so is its t
};
/// Parses --ray; positions and directions are those of `scarp cast`. Throws Error naming the option.
ProfileRay typed_ray(MapInput& input, const std::string& text);
/// The ray from the eye to the target of a line of sight without curvature, and a little beyond.
ProfileRay ray_along(const SightLine& line);

/// Draws the marches of a ray. Throws Error if it does not pass over the field. Returns lines about
/// the marches.
std::vector<std::string> draw_marches(const ProfileMarchOptions& options, const ProfileRay& ray,
                                      const std::string& title, int width, int height, const std::string& output);

}  // namespace scarp::cli
