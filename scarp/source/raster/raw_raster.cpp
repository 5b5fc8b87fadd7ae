// SPDX-License-Identifier: MIT
#include "scarp/source/raster/raw_raster.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/source/raster/file_check.h"
#include "scarp/source/raster/raw_band.h"

namespace scarp {
namespace {

// Returns the number of bytes after the samples. Throws Error if there are too few bytes, or extra bytes although no
// offset was given.
std::int64_t bytes_left(const RawFormat& format, std::int64_t bytes) {
  // In double: neither the product nor the sum can overflow.
  const double needed = static_cast<double>(format.offset) +
                        static_cast<double>(format.cols) * static_cast<double>(format.rows) * format.bytes;
  const double have = static_cast<double>(bytes);
  if (have == needed || (format.has_offset && have > needed)) return static_cast<std::int64_t>(have - needed);
  throw Error(fmt::format("{} bytes, but --raw {} needs {:.0f} ({})", bytes, text_of(format), needed,
                          have < needed ? "truncated file, or wrong size, type or offset"
                                        : "wrong size or type; otherwise append +0 to ignore bytes after the "
                                          "samples, or +OFFSET to skip a header"));
}

}  // namespace

OpenedDataset open_raw(const std::string& path, const RasterOptions& options, const GdalSession& session) {
  const RawFormat& format = options.raw.value();
  const std::int64_t bytes = file_bytes(path);
  check_file(path);
  const std::int64_t left = bytes_left(format, bytes);
  OpenedDataset opened;
  opened.dataset =
      open_raw_band({full_path(path), format.cols, format.rows, raw_sample_type(format.kind, format.bytes).value(),
                     format.bytes, format.big_endian, format.offset},
                    session);
  if (left > 0) opened.notes.push_back(fmt::format("ignored {} bytes after the samples", left));
  return opened;
}

}  // namespace scarp
