// SPDX-License-Identifier: MIT
// A raster read from a file, before it becomes a field.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scarp/base/georeference.h"

namespace scarp {

/// One band of a raster, rows from north to south, in the file's sample type if Scarp supports it.
struct Raster {
  std::variant<std::vector<std::int16_t>, std::vector<std::uint16_t>, std::vector<float>> samples;
  int cols = 0;
  int rows = 0;
  double scale = 1.0;            ///< metres = sample * scale + offset, including conversions from feet; > 0
  double offset = 0.0;           ///< metres
  std::optional<double> nodata;  ///< sample value of a hole; NaN is always a hole in float samples
  Georeference georeference;
  std::string path;       ///< as opened, for messages
  std::string file_type;  ///< sample type in the file, as GDAL names it: "Int16"
  std::string
      vertical_unit;  ///< as the file states it: "metre", "US survey foot", ...; empty: not stated, metres assumed
  std::vector<std::string> files;  ///< all files opened, including tiles and the sources of a virtual raster
  std::vector<std::string> notes;  ///< conversions and assumptions, one line each, for display
};

}  // namespace scarp
