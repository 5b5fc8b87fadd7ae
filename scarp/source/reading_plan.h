// SPDX-License-Identifier: MIT
// What is read of a band: all of its samples, or for a large raster that is only shown, fewer of them (decimate.h),
// from an overview of the file where it has a suitable one.
#pragma once

#include <gdal_priv.h>

#include <optional>
#include <string>

#include "scarp/source/decimate.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Place of the samples of a result along one side, in samples of what was asked for.
struct SampleSpacing {
  double first = 0;
  double step = 1;
};

struct ReadingPlan {
  GDALRasterBand* band = nullptr;  ///< the band or one of its overviews
  RasterWindow window;             ///< of it
  bool decimates = false;          ///< whether the result has fewer samples than were asked for
  int cols = 0;                    ///< of the result
  int rows = 0;
  SampleSpacing across, down;
  SampleEnds known;  ///< of the file, where an overview may lack them
  std::string note;  ///< empty if everything is read
};

/// Plans to read a window of a band. `own_nodata`: holes are those that the file states. Throws Error without the
/// file's name if there are too many samples even to reduce them.
ReadingPlan plan_reading(GDALRasterBand& band, const RasterWindow& window, const std::optional<Decimation>& decimation,
                         bool own_nodata);

}  // namespace scarp
