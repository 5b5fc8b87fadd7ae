// SPDX-License-Identifier: MIT
// The part of a band to read: all of its samples or, for a large raster that is only displayed, fewer of them
// (decimate.h), from an overview of the file if it has a suitable one.
#pragma once

#include <gdal_priv.h>

#include <optional>
#include <string>

#include "scarp/source/raster/decimate.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Positions of the result's samples along one side, in samples of the requested window.
struct SampleSpacing {
  double first = 0;
  double step = 1;
};

struct ReadingPlan {
  GDALRasterBand* band = nullptr;  ///< the band or one of its overviews
  RasterWindow window;             ///< window of `band`
  bool decimates = false;          ///< whether the result has fewer samples than requested
  int cols = 0;                    ///< of the result
  int rows = 0;
  SampleSpacing across, down;
  SampleEnds known;  ///< extremes of the file, because an overview may lack them
  std::string note;  ///< empty if everything is read
};

/// Returns the extremes that the file states for the whole band, in samples; empty if it does not.
SampleEnds stated_ends(GDALRasterBand& band);

/// Plans to read a window of a band. `own_nodata`: whether holes are those that the file states. Throws Error without
/// the file's name if there are too many samples even to reduce them.
ReadingPlan plan_reading(GDALRasterBand& band, const RasterWindow& window, const std::optional<Decimation>& decimation,
                         bool own_nodata);

}  // namespace scarp
