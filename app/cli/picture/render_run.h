// SPDX-License-Identifier: MIT
// Runs `scarp render`: from its options to scene, cameras and files.
#pragma once

#include <functional>

#include "app/cli/options/render_options.h"

namespace scarp::cli {

/// The options must be consistent with each other. Throws Error.
void render_input(InputKind kind, const RenderOptions& options);

/// Renders the frames of an animation: `options` are those of all frames, options_of(i) those of frame i, apart from
/// its name. Throws Error.
void render_animation(InputKind kind, const RenderOptions& options,
                      const std::function<RenderOptions(int)>& options_of);

}  // namespace scarp::cli
