// SPDX-License-Identifier: MIT
// Runs `scarp render`: from its options to scene, cameras and files.
#pragma once

#include "app/cli/options/render_options.h"

namespace scarp::cli {

/// The options must be consistent with each other. Throws Error.
void render_input(InputKind kind, RenderOptions options);

}  // namespace scarp::cli
