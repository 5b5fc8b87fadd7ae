// SPDX-License-Identifier: MIT
// Converts the option texts of `scarp render` and `scarp view` to settings.
#pragma once

#include "app/cli/render_options.h"

namespace scarp::cli {

/// Sets the picture's settings from the typed options, and returns the view. Checks everything that needs no file,
/// except options that depend on the output. Throws Error.
ViewSettings settle_picture(RenderOptions& options);

/// Checks --eye, --eye-above and --target. Throws Error.
void require_places(const RenderOptions& options);

}  // namespace scarp::cli
