// SPDX-License-Identifier: MIT
// Runs `scarp render`: from its options to scene, cameras and files.
#pragma once

#include "app/cli/render_options.h"

namespace scarp::cli {

/// `view` holds the typed values. The options must be consistent. Throws Error.
void render_input(InputKind kind, RenderOptions options, const ViewSettings& view);

}  // namespace scarp::cli
