// SPDX-License-Identifier: MIT
// Writes a rendered picture with its figure, in the format that its name implies.
#pragma once

#include <optional>
#include <string>

#include "app/cli/options/picture_format.h"
#include "scarp/base/georeference.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/figure.h"
#include "scarp/output/geotiff.h"
#include "scarp/render/camera/camera.h"
#include "scarp/render/film/film.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// The position on the map of a picture of `width` x `height` pixels by a camera of Camera::top(), over a raster with
/// this number of rows. Nullopt without a georeference.
std::optional<MapPlace> place_of_map(const Camera& camera, int width, int height, const Georeference& georeference,
                                     int cols, int rows);

/// Size in pixels of the written picture, including margins except in PDF.
struct WrittenSize {
  int width = 0, height = 0;
};

/// Writes to the temporary file of `file` and commits it. The opacity of `image` is written only to GeoTIFF, and
/// becomes opaque where the figure is drawn. Throws Error naming the file, and if the figure does not fit the picture.
WrittenSize write_picture(ReplaceFile& file, const std::string& path, const PictureFormat& format, const Image& image,
                          const std::optional<Figure>& figure, const std::optional<MapPlace>& place,
                          double dots_per_inch);

/// Writes the numbers of a picture as a raster of one band: greys of 1 to 255 as bytes, with nodata 0; degrees as
/// floats, with nodata -9999. Throws Error naming the file.
void write_numbers(const std::string& path, const Picture& picture, Look look, const std::optional<MapPlace>& place);

}  // namespace scarp::cli
