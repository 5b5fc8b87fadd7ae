// SPDX-License-Identifier: MIT
#include "scarp/source/raster/warp_words.h"

#include <fmt/format.h>

namespace scarp {

std::string warp_nodata_words(std::string_view file_type, bool declared, std::optional<double> given) {
  if (given) return fmt::format(" -srcnodata {0:.10g} -dstnodata {0:.10g}", *given);
  if (declared) return {};
  const bool holds_mark = file_type == "Int16" || file_type == "Int32" || file_type == "Int64" ||
                          file_type == "Float32" || file_type == "Float64";
  return holds_mark ? " -dstnodata -9999" : " -ot Float32 -dstnodata -9999";
}

}  // namespace scarp
