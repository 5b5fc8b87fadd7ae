// SPDX-License-Identifier: MIT
// Shared by the writers that use GDAL.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>

#include <string>

#include "scarp/output/rgb_view.h"

namespace scarp {

/// During its lifetime, keeps GDAL's messages off stderr and prevents GDAL from writing files beside the picture.
class GdalWriting {
 public:
  GdalWriting();
  ~GdalWriting();
  GdalWriting(const GdalWriting&) = delete;
  GdalWriting& operator=(const GdalWriting&) = delete;

  /// Throws Error "PATH: cannot be written: ..." if GDAL has reported an error since construction. GDAL reports some
  /// errors only when a dataset is closed, by functions that return nothing.
  void require_good(const std::string& path) const;

 private:
  static void CPL_STDCALL note(CPLErr level, CPLErrorNum number, const char* text);
  std::string first_;
};

/// Throws Error unless the picture has 1 to `most_side` pixels per side.
void require_size(const RgbView& picture, int most_side, const std::string& path, const char* format);

}  // namespace scarp
