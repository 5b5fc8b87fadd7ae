// SPDX-License-Identifier: MIT
// Words of gdalwarp commands in messages.
//
// gdalwarp fills pixels of the output that no pixel of the input covers with the nodata value; without one, with 0,
// which looks like ground at sea level.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace scarp {

/// Returns the words, each after a blank, that mark these pixels: none if the file declares a nodata value. `file_type`
/// is GDAL's name of its sample type; `given`: a nodata value from the caller.
std::string warp_nodata_words(std::string_view file_type, bool declared, std::optional<double> given = {});

}  // namespace scarp
