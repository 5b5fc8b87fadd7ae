// SPDX-License-Identifier: MIT
// From the texts of the options of `scarp render` and `scarp view` to settings.
#pragma once

#include "app/cli/render_options.h"

namespace scarp::cli {

/// Sets the picture's settings by what was typed, and returns the view. Checks all that needs no file, except what
/// depends on the output. Throws Error.
ViewSettings settle_picture(RenderOptions& options);

/// Checks --eye, --eye-above and --target. Throws Error.
void require_places(const RenderOptions& options);

}  // namespace scarp::cli
