// SPDX-License-Identifier: MIT
// A legend and a scale bar over pictures.
#pragma once

#include <optional>

#include "app/cli/command.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/file/from_volume.h"

namespace scarp::cli {

/// What was typed.
struct FigureOptions {
  bool legend = false, scale_bar = false;

  bool any() const { return legend || scale_bar; }
};

/// Declares --legend and --scale-bar.
void add_figure_options(Command& command, FigureOptions& options);

/// What can be judged without the field. Throws Error.
void settle_figure(const FigureOptions& options, const PictureSettings& settings, bool exr);

/// Draws what was asked for over a picture. `map`: seen without perspective; `numbers`: range of a volume that is
/// coloured by its numbers. Throws Error where there is no room, or colours have no scale.
void draw_figure_of(const FigureOptions& options, const PictureSettings& settings, const Scene& scene,
                    const Camera& camera, bool map, const std::optional<SolidRange>& numbers, Picture& picture);

}  // namespace scarp::cli
