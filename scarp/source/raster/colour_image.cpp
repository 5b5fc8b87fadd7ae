// SPDX-License-Identifier: MIT
#include "scarp/source/raster/colour_image.h"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/band_pieces.h"
#include "scarp/source/raster/gdal_dataset.h"
#include "scarp/source/raster/gdal_raster.h"
#include "scarp/source/raster/raster_name.h"

namespace scarp {
namespace {

// Maximum side of a warped overlay.
constexpr int kMostSide = 16384;

struct WarpOptions {
  GDALWarpAppOptions* options;
  explicit WarpOptions(char** arguments) : options(GDALWarpAppOptionsNew(arguments, nullptr)) {}
  ~WarpOptions() { GDALWarpAppOptionsFree(options); }
  WarpOptions(const WarpOptions&) = delete;
  WarpOptions& operator=(const WarpOptions&) = delete;
};

struct TranslateOptions {
  GDALTranslateOptions* options;
  explicit TranslateOptions(char** arguments) : options(GDALTranslateOptionsNew(arguments, nullptr)) {}
  ~TranslateOptions() { GDALTranslateOptionsFree(options); }
  TranslateOptions(const TranslateOptions&) = delete;
  TranslateOptions& operator=(const TranslateOptions&) = delete;
};

// Expands palettes to colours; returns the dataset itself if it already has colour bands.
GDALDatasetUniquePtr in_colours(GDALDatasetUniquePtr dataset, const GdalSession& session) {
  if (dataset->GetRasterBand(1)->GetRasterDataType() != GDT_Byte) {
    throw Error("not an image with 8 bits per channel");
  }
  if (dataset->GetRasterCount() != 1 || !dataset->GetRasterBand(1)->GetColorTable()) return dataset;
  CPLStringList arguments;
  for (const char* argument : {"-of", "MEM", "-expand", "rgba"}) arguments.AddString(argument);
  const TranslateOptions options(arguments.List());
  int wrong = 0;
  GDALDatasetUniquePtr colours(
      GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(dataset.get()), options.options, &wrong)));
  if (!colours) throw Error(session.reason("cannot read its palette"));
  return colours;
}

ColourImage pixels_of(GDALDataset& dataset, int height, const GdalSession& session) {
  ColourImage image{dataset.GetRasterXSize(), height, {}, {}};
  image.rgba.assign(4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(height), 255);
  const int bands = dataset.GetRasterCount();
  for (int channel = 0; channel < 4; ++channel) {
    int band = 0;
    if (channel < 3) {
      band = bands >= 3 ? channel + 1 : 1;
    } else if (bands == 2 || bands >= 4) {
      band = bands == 2 ? 2 : 4;
    }
    if (band == 0) continue;
    const CPLErr result =
        dataset.GetRasterBand(band)->RasterIO(GF_Read, 0, 0, image.width, height, image.rgba.data() + channel,
                                              image.width, height, GDT_Byte, 4, std::int64_t{4} * image.width, nullptr);
    if (result != CE_None) throw Error(session.reason("cannot be read"));
  }
  return image;
}

// Reads at most this many rows, from the top.
ColourImage read_rows(const std::string& path, int most, int most_side = std::numeric_limits<int>::max()) {
  GdalSession session;
  const StrictReading strict;
  try {
    const GDALDatasetUniquePtr dataset = in_colours(open_gdal_raster(path, session), session);
    const int width = dataset->GetRasterXSize(), height = dataset->GetRasterYSize();
    if (std::max(width, height) > most_side)
      throw Error(fmt::format("{} x {} pixels (must be at most {} from side to side)", width, height, most_side));
    return pixels_of(*dataset, std::min(most, dataset->GetRasterYSize()), session);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

// A rectangle on the map, and the size of pixels there.
struct Area {
  double west, south, east, north;
  double pixel_x, pixel_y;
};

// Whether the image is in the raster's CRS, or one of the two does not state its own.
bool in_crs_of(const Georeference& georeference, GDALDataset& dataset) {
  const OGRSpatialReference* const own = dataset.GetSpatialRef();
  if (georeference.crs_wkt.empty() || own == nullptr) return true;
  OGRSpatialReference crs;
  const char* const ignore_axes[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  return crs.importFromWkt(georeference.crs_wkt.c_str()) == OGRERR_NONE && own->IsSame(&crs, ignore_axes);
}

// The image's bounds and resolution, in units of the raster's CRS.
Area area_of(GDALDataset& dataset, const Georeference& georeference, const GdalSession& session) {
  double place[6] = {};
  const bool same = in_crs_of(georeference, dataset);
  // Not by GDAL, which would suggest square pixels.
  if (same && dataset.GetGeoTransform(place) == CE_None && place[2] == 0 && place[4] == 0) {
    const double x = place[0] + place[1] * dataset.GetRasterXSize(), y = place[3] + place[5] * dataset.GetRasterYSize();
    return {std::min(place[0], x), std::min(place[3], y), std::max(place[0], x),
            std::max(place[3], y), std::abs(place[1]),    std::abs(place[5])};
  }
  CPLStringList options;
  if (!same) options.SetNameValue("DST_SRS", georeference.crs_wkt.c_str());
  GDALDatasetH handle = GDALDataset::ToHandle(&dataset);
  void* transform = GDALCreateGenImgProjTransformer2(handle, nullptr, options.List());
  double extent[4] = {};
  int across = 0, down = 0;
  const bool found = transform != nullptr && GDALSuggestedWarpOutput2(handle, GDALGenImgProjTransform, transform, place,
                                                                      &across, &down, extent, 0) == CE_None;
  if (transform != nullptr) GDALDestroyGenImgProjTransformer(transform);
  if (!found) throw Error(session.reason("cannot be warped to the raster"));
  return {extent[0], extent[1], extent[2], extent[3], std::abs(place[1]), std::abs(place[5])};
}

// Outer edges of the pixels that cover [from, to], for an image that starts at `origin`; ignores pixels before its
// first.
std::pair<double, double> pixels_between(double origin, double pixel, double from, double to) {
  constexpr double kRounding = 1e-6;  // of a pixel
  const double first = std::max(0.0, std::floor((from - origin) / pixel + kRounding)),
               last = std::ceil((to - origin) / pixel - kRounding);
  return {origin + first * pixel, origin + last * pixel};
}

}  // namespace

ColourImage read_colour_row(const std::string& path) { return read_rows(path, 1); }

ColourImage read_colour_image(const std::string& path, int most_side) {
  return read_rows(path, std::numeric_limits<int>::max(), most_side);
}

Overlay read_overlay(const std::string& path, const Georeference& georeference, int cols, int rows,
                     std::int64_t most_pixels, bool fit) {
  GdalSession session;
  const StrictReading strict;
  const GdalCacheLimit cache;
  try {
    GDALDatasetUniquePtr stored = open_gdal_raster(path, session);
    const std::vector<std::string> files = files_of(*stored);
    GDALDatasetUniquePtr dataset = in_colours(std::move(stored), session);
    const bool placed = has_place(*dataset);
    if (!fit && placed != georeference.present) {
      throw Error(
          placed ? "overlay is georeferenced, but the input is not (georeference a raster with --crs and --bounds, or "
                   "stretch the image over the input with --overlay-fit)"
                 : "overlay is not georeferenced, but the raster is (stretch it over the raster with --overlay-fit, or "
                   "use gdal_translate -a_srs -a_ullr)");
    }
    if (fit || !placed) {
      Overlay overlay{pixels_of(*dataset, dataset->GetRasterYSize(), session)};
      overlay.image.files = files;
      return overlay;
    }
    const auto& m = georeference.map_from_node;
    const double west = m[0], east = m[0] + (cols - 1) * m[1], north = m[3], south = m[3] + (rows - 1) * m[5];
    const Area area = area_of(*dataset, georeference, session);
    const auto [left, right] = pixels_between(area.west, area.pixel_x, west, std::min(east, area.east));
    const auto [top, bottom] = pixels_between(-area.north, area.pixel_y, -north, std::min(-south, -area.south));
    const double high = -top, low = -bottom;
    const auto refuse_apart = [&] {
      throw Error(
          fmt::format("overlay does not overlap the raster, which spans {:.10g} to {:.10g} by {:.10g} to {:.10g}", west,
                      east, south, north));
    };
    if (!(left < right && low < high)) refuse_apart();
    const double wide = std::round((right - left) / area.pixel_x), tall = std::round((high - low) / area.pixel_y);
    const double shrink = std::min(
        {1.0, kMostSide / wide, kMostSide / tall, std::sqrt(static_cast<double>(most_pixels) / (wide * tall))});
    CPLStringList arguments;
    const auto add = [&](const std::string& text) { arguments.AddString(text.c_str()); };
    // The warper's average weights pixels by the area that they cover.
    for (const char* word : {"-of", "MEM", "-r", shrink < 1 ? "average" : "bilinear", "-te"}) add(word);
    for (const double edge : {left, low, right, high}) add(fmt::format("{}", edge));
    if (!georeference.crs_wkt.empty() && dataset->GetSpatialRef() != nullptr) {
      add("-t_srs");
      add(georeference.crs_wkt);
    }
    add("-ts");
    for (const double side : {wide, tall}) add(fmt::format("{}", std::max(1L, std::lround(std::floor(side * shrink)))));
    const int count = dataset->GetRasterCount();
    if (count != 2 && count != 4) add("-dstalpha");
    const WarpOptions options(arguments.List());
    if (!options.options) throw Error(session.reason("cannot be warped to the raster"));
    GDALDatasetH source = GDALDataset::ToHandle(dataset.get());
    int wrong = 0;
    const GDALDatasetUniquePtr warped(
        GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &source, options.options, &wrong)));
    if (!warped) throw Error(session.reason("cannot be warped to the raster"));
    Overlay overlay{pixels_of(*warped, warped->GetRasterYSize(), session), (left - west) / (east - west),
                    (north - high) / (north - south), (right - west) / (east - west), (north - low) / (north - south)};
    overlay.image.files = files;
    bool seen = false;
    const auto& rgba = overlay.image.rgba;
    for (std::size_t i = 3; i < rgba.size() && !seen; i += 4) seen = rgba[i] != 0;
    if (!seen) refuse_apart();
    return overlay;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
