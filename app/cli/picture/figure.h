// SPDX-License-Identifier: MIT
// Annotations of a picture, as requested by its options (figure_options.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/figure_options.h"
#include "app/cli/options/picture_format.h"
#include "scarp/base/georeference.h"
#include "scarp/output/figure.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/scene/file/from_volume.h"

namespace scarp::cli {

/// Checks the options that do not depend on the field. Throws Error.
void check_figure(const FigureOptions& options, const PictureSettings& settings, const PictureFormat& format);

/// The contents of a figure.
struct FigureSubject {
  const Scene& scene;
  const Camera& camera;
  bool map = false;                          ///< seen without perspective
  const std::optional<SolidRange>& numbers;  ///< set for a volume that is coloured by its numbers
  const Georeference& georeference;          ///< of a raster
  int cols = 0, rows = 0;                    ///< likewise
  std::vector<FigureStrip> strips{};         ///< of a comparison, with labels as long as those of the picture
};

/// Returns the requested figure without its legend; nullopt: none. Throws Error if the centre of the picture shows
/// nothing, or a graticule has no georeference.
std::optional<Figure> figure_of(const FigureOptions& options, const PictureSettings& settings,
                                const FigureSubject& subject);

/// Adds the legend of a rendered picture, if requested. Throws Error if its colours have no scale.
void add_legend(const FigureOptions& options, const PictureSettings& settings, const FigureSubject& subject,
                const Picture& picture, std::optional<Figure>& figure);

/// Returns the legend of a ramp over numbers from low to high. The ramp expects them multiplied by `per_colour`.
/// Numbers at its ticks are multiples of a power of ten of at least `least_step`. Builds with Cairo only.
FigureLegend legend_of(std::string title, double low, double high, const Ramp& ramp, double per_colour = 1,
                       double least_step = 0);

}  // namespace scarp::cli
