// SPDX-License-Identifier: MIT
// A dataset that one of the readers has opened, and what the reader knows besides.
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <string>
#include <vector>

namespace scarp {

struct OpenedDataset {
  std::vector<std::uint8_t> memory{};  ///< samples of a dataset in memory, which they outlive
  GDALDatasetUniquePtr dataset{};
  std::string file_type{};           ///< Raster::file_type; empty: GDAL's name of the band's type
  std::vector<std::string> notes{};  ///< follow those of the samples
};

}  // namespace scarp
