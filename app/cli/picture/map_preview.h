// SPDX-License-Identifier: MIT
// Pictures of computed maps: the first band over the shaded elevation model, as `render --top --overlay` draws it, with
// a legend, scale bar and north arrow beside it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/cli/options/picture_format.h"
#include "app/cli/picture/drawn_shapes.h"
#include "scarp/analysis/map_part.h"
#include "scarp/base/georeference.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/figure.h"
#include "scarp/output/raster_map.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// Throws Error for a format that has no margins for a legend, and in builds without Cairo.
const PictureFormat& preview_format_of(const std::string& path);

class MapPreview {
 public:
  /// Reserves the file, and reads the files of --draw. The samples have been read. Throws Error for a model without
  /// ground, if the file is one of the inputs, and as drawn_shapes().
  MapPreview(std::string path, const DrawOptions& draw, const MapInput& input);

  /// Draws the map of these rows, with marks in columns and rows of the raster. Bands without classes are coloured by
  /// one of ramp_names(); counts of 0 are clear. Throws Error naming the file.
  void write(const RasterMap& map, const RowBand& rows, const std::string& ramp, std::vector<DrawnMark> marks);

 private:
  std::string path_;
  const DrawOptions& draw_;
  const MapInput& input_;
  ReplaceFile file_;
  Scene scene_;
  PictureSettings picture_;
#ifdef SCARP_CAIRO
  Camera camera_;
  Georeference place_;  // of the samples
  std::optional<Figure> figure_;
#endif
};

}  // namespace scarp::cli
