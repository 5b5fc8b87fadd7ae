// SPDX-License-Identifier: MIT
// From the options of `scarp render` to files: scene, cameras, pictures.
#pragma once

#include "app/cli/render_options.h"

namespace scarp::cli {

/// The options are consistent with each other. Throws Error.
void render_input(InputKind kind, RenderOptions options);

}  // namespace scarp::cli
