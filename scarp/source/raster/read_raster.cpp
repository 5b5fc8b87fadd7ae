// SPDX-License-Identifier: MIT
#include "scarp/source/raster/read_raster.h"

#include <fmt/format.h>

#include <algorithm>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/exr_raster.h"
#include "scarp/source/raster/gdal_dataset.h"
#include "scarp/source/raster/gdal_raster.h"
#include "scarp/source/raster/npy.h"
#include "scarp/source/raster/raster_name.h"
#include "scarp/source/raster/raw_raster.h"
#include "scarp/source/raster/tile_set.h"

namespace scarp {
namespace {

constexpr std::size_t kFilesNamed = 3;

// Rejects options that apply only to other file types.
void refuse_foreign_options(const std::string& path, const RasterOptions& options) {
  const bool raw = options.raw.has_value(), exr = !raw && extension_of(path) == ".exr",
             archive = !raw && extension_of(path) == ".npz", array = !raw && is_npy_path(path);
  const auto refuse = [&](std::string_view text) { throw Error(fmt::format("{}: {} (omit it)", path, text)); };
  if (!options.key.empty() && !archive) refuse("--key applies to .npz archives only");
  if (!options.channel.empty() && !exr) refuse("--channel applies to .exr files only");
  if (options.encoding != HeightEncoding::none && (raw || exr || array))
    refuse("--encoding applies to colour images only");
}

Raster read_file(const std::string& path, const RasterOptions& options, const Progress& progress) {
  refuse_foreign_options(path, options);
  if (options.raw) return read_raw(path, options, progress);
  if (is_npy_path(path)) return read_npy(path, options, progress);
  if (extension_of(path) == ".exr") return read_exr(path, options, progress);
  return read_gdal_raster(path, options, progress);
}

std::string names_of(const std::vector<std::string>& inputs) {
  std::string names;
  for (std::size_t i = 0; i < std::min(inputs.size(), kFilesNamed); ++i) names += (i == 0 ? "" : ", ") + inputs[i];
  return inputs.size() > kFilesNamed ? fmt::format("{} and {} more", names, inputs.size() - kFilesNamed) : names;
}

}  // namespace

Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress) {
  return read_tiles({path}, options, progress);
}

Raster read_tiles(const std::vector<std::string>& inputs, const RasterOptions& options, const Progress& progress) {
  if (inputs.empty()) throw Error("no raster given (name a file or a folder)");
  GdalSession session;
  const StrictReading strict;
  std::vector<std::string> files, notes;
  for (const std::string& input : inputs) {
    if (!options.raw && !is_npy_path(input) && is_tile_folder(input)) {
      const std::vector<std::string> found = rasters_in(input, options, notes);
      files.insert(files.end(), found.begin(), found.end());
    } else {
      files.push_back(input);
    }
  }
  Raster raster;
  if (files.size() == 1) {
    raster = read_file(files.front(), options, progress);
  } else {
    for (const std::string& file : files) {
      refuse_foreign_options(file, options);
      if (options.raw || is_npy_path(file) || extension_of(file) == ".exr")
        throw Error(fmt::format(
            "{}: no georeference, which tiles require (read it alone, or convert it to GeoTIFF first)", file));
    }
    const TileSet tiles = open_tile_set(files, options, session, notes);
    raster = read_named(names_of(inputs), [&] {
      RasterOptions of_set = options;
      of_set.band = 0;
      settle_height_range(of_set, tiles.type, false);
      Raster whole = read_dataset(*tiles.dataset, of_set, session, progress);
      if (options.encoding == HeightEncoding::none) whole.file_type = GDALGetDataTypeName(tiles.type);
      return whole;
    });
  }
  raster.files.insert(raster.files.end(), files.begin(), files.end());
  raster.notes.insert(raster.notes.begin(), notes.begin(), notes.end());
  return raster;
}

}  // namespace scarp
