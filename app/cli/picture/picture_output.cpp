// SPDX-License-Identifier: MIT
#include "app/cli/picture/picture_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/output/jpeg.h"
#include "scarp/output/png.h"
#include "scarp/output/raster_map.h"
#include "scarp/source/raster/coordinates.h"

namespace scarp::cli {
namespace {

// Nearly the white of a figure's background, but not grey, so that with_figure() detects everything drawn over it as a
// change.
constexpr std::array<std::uint8_t, 3> kBelowFigure = {250, 255, 250};

Image on_white(Image image) {
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    if (image.alpha[i] == 0)
      std::copy_n(kBelowFigure.begin(), 3, image.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(i));
  }
  return image;
}

// Pixels covered by a figure become opaque.
std::vector<std::uint8_t> with_figure(const Image& image, const std::vector<std::uint8_t>& drawn) {
  std::vector<std::uint8_t> alpha = image.alpha;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    const auto before = image.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(i);
    if (!std::equal(before, before + 3, drawn.begin() + 3 * static_cast<std::ptrdiff_t>(i))) alpha[i] = 255;
  }
  return alpha;
}

}  // namespace

std::optional<MapPlace> place_of_map(const Camera& camera, int width, int height, const Georeference& georeference,
                                     int cols, int rows) {
  if (!georeference.present) return {};
  const CoordinateFrame map(georeference, cols, rows, Coordinates::map);
  // The corners of the picture, in the camera's own pixels.
  const dvec2 size = camera.size();
  std::array<dvec3, 2> corners{camera.ray(0, 0).origin, camera.ray(size.x, size.y).origin};
  if (map.from_local(corners)) throw Error("the map is outside the domain of its CRS");
  const dvec3 step = (corners[1] - corners[0]) / dvec3(width, height, 1);
  return MapPlace{{corners[0].x, step.x, 0, corners[0].y, 0, step.y}, georeference.crs_wkt};
}

WrittenSize write_picture(ReplaceFile& file, const std::string& path, const PictureFormat& format, const Image& image,
                          const std::optional<Figure>& figure, const std::optional<MapPlace>& place,
                          double dots_per_inch) {
  RgbView view{image.rgb.data(), image.width, image.height};
  std::vector<std::uint8_t> alpha = image.alpha;
#ifdef SCARP_CAIRO
  if (format.kind == PictureKind::pdf) {
    write_pdf(file, path, view, figure.value_or(Figure{}), dots_per_inch);
    return {view.width, view.height};
  }
  FigureImage drawn;
  if (figure) {
    const Image below = on_white(image);
    drawn = draw_figure({below.rgb.data(), below.width, below.height}, *figure);
    alpha = with_figure(below, drawn.rgb);
    view = {drawn.rgb.data(), drawn.width, drawn.height};
  }
#else
  static_cast<void>(figure), static_cast<void>(dots_per_inch), static_cast<void>(&with_figure),
      static_cast<void>(&on_white);
#endif
  switch (format.kind) {
    case PictureKind::tiff:
      write_geotiff(file, path, view, alpha, place);
      break;
    case PictureKind::jpeg:
      write_jpeg(file, path, view);
      break;
    case PictureKind::png:
    case PictureKind::pdf:
    case PictureKind::exr:
      write_png(file, path, view);
      break;
  }
  return {view.width, view.height};
}

void write_numbers(const std::string& path, const Picture& picture, Look look, const std::optional<MapPlace>& place) {
  RasterMap map;
  map.cols = picture.image.width, map.rows = picture.image.height;
  map.place = place;
  const std::string name(name_of(look));
  std::vector<float> degrees;
  std::vector<std::uint8_t> greys;
  if (look == Look::multidirectional) {
    for (const float grey : picture.numbers)
      greys.push_back(static_cast<std::uint8_t>(std::isnan(grey) ? 0 : std::lround(grey)));
    map.bands.push_back({name, "", std::span<const std::uint8_t>(greys), 0.0});
  } else {
    constexpr float kNone = -9999;
    for (const float number : picture.numbers) degrees.push_back(std::isnan(number) ? kNone : number);
    map.bands.push_back({name, "degrees", std::span<const float>(degrees), static_cast<double>(kNone)});
  }
  write_raster_map(path, map);
}

}  // namespace scarp::cli
