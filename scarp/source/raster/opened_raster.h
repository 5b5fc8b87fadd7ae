// SPDX-License-Identifier: MIT
// A raster that is open: its properties are known, and its samples are read as they are needed.
//
//   scarp::OpenedRaster file({"dem.tif"}, {});
//   const scarp::Raster near = file.read({.col = 20'000, .row = 31'000, .cols = 600, .rows = 600});
//
// Parts have the scale, the lengths of cells and the azimuth of the whole raster, whereas RasterOptions::window selects
// a raster of its own, with its own centre.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/raster/decimate.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Use on one thread.
class OpenedRaster {
 public:
  /// Opens files and folders as read_tiles() does, and throws Error as it does for all reasons but samples. Reads no
  /// samples, except of pictures whose scale depends on them (default_scale.h): `progress` is theirs.
  OpenedRaster(const std::vector<std::string>& inputs, const RasterOptions& options, const Progress& progress = {});
  ~OpenedRaster();
  OpenedRaster(OpenedRaster&&) noexcept;

  /// The raster without samples; the alternative of `samples` is their type in memory (of rasters with a mask: if it
  /// hides samples). Notes are those about the header.
  const Raster& header() const;
  /// Minimum and maximum sample as the file states them; low > high if it does not.
  const SampleEnds& stated() const;

  /// Reads all samples, as read_tiles() does.
  Raster read(const Progress& progress = {});
  /// Reads the samples of a part, which must be inside the raster; from the north-west corner, whatever the order of
  /// rows and columns in the file. The options must not decimate. Throws as read() does, but accepts a part of holes
  /// alone.
  Raster read(const RasterWindow& part, const Progress& progress = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace scarp
