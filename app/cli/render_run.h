// SPDX-License-Identifier: MIT
// From the options of `scarp render` to files: scene, cameras, pictures.
#pragma once

#include "app/cli/render_options.h"

namespace scarp::cli {

/// `view` is what was typed. The options are consistent with each other. Throws Error.
void render_input(InputKind kind, RenderOptions options, const ViewSettings& view);

}  // namespace scarp::cli
