// SPDX-License-Identifier: MIT
// Samples as they come out of a file: plain data, on its way to a field.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scarp/base/georeference.h"

namespace scarp {

/// One band of a raster, rows from north to south, kept in the type that the file has where Scarp knows it.
struct Raster {
  std::variant<std::vector<std::int16_t>, std::vector<std::uint16_t>, std::vector<float>> samples;
  int cols = 0;
  int rows = 0;
  double scale = 1.0;            ///< metres = sample * scale + offset; conversions from feet are in it; > 0
  double offset = 0.0;           ///< metres
  std::optional<double> nodata;  ///< sample value that marks a hole; NaN is one in float samples anyway
  Georeference georeference;
  std::string path;           ///< as opened, for messages
  std::string file_type;      ///< sample type in the file, GDAL's name: "Int16"
  std::string vertical_unit;  ///< as the file says: "metre", "US survey foot", ...; empty: not said, metres assumed
  std::vector<std::string> files;  ///< all that were opened: tiles, and what a virtual raster is made of, too
  std::vector<std::string> notes;  ///< what was converted or assumed, one line each, for people
};

}  // namespace scarp
