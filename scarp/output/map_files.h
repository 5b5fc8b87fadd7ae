// SPDX-License-Identifier: MIT
// Private to the station: the files of a raster, which only its driver knows, written completely or not at all.
#pragma once

#include <gdal_priv.h>

#include <string>

#include "scarp/base/replace_file.h"

namespace scarp {

/// A driver writes to path(), with the final names of all its files, in a temporary folder. commit() moves them beside
/// `path`. Without commit() none remains.
class MapFiles {
 public:
  /// Throws Error as ReplaceFile.
  explicit MapFiles(const std::string& path);

  const std::string& path() const { return main_; }
  const std::string& folder() const { return folder_.name(); }
  /// Replaces the raster `path` and its side files. Removes side files of the replaced raster that the new one lacks:
  /// statistics, masks and overviews would be wrong. Throws Error naming the file, also for a side file that exists
  /// although `path` does not.
  void commit();

 private:
  std::string target_;
  ReplaceFile file_;
  TemporaryFolder folder_;
  std::string main_;
};

/// Throws Error "PATH: ..." unless the raster at `written` has the samples and the georeference of `expected`: some
/// formats change them without an error. Nodata may have another value. `driver`: for messages.
void require_same_map(const std::string& written, GDALDataset& expected, const std::string& path,
                      const std::string& driver);

}  // namespace scarp
