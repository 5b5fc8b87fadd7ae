// SPDX-License-Identifier: MIT
// Shared by the writers that use GDAL.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>

#include <optional>
#include <string>
#include <utility>

#include "scarp/output/rgb_view.h"

namespace scarp {

/// Whether GDAL writes what a format cannot store, such as a CRS, to NAME.aux.xml.
enum class AuxiliaryFiles : bool { none, written };

/// During its lifetime, keeps GDAL's messages off stderr.
class GdalWriting {
 public:
  explicit GdalWriting(AuxiliaryFiles auxiliary = AuxiliaryFiles::none);
  ~GdalWriting();
  GdalWriting(const GdalWriting&) = delete;
  GdalWriting& operator=(const GdalWriting&) = delete;

  /// Messages show the names of files without this folder.
  void hide(std::string folder) { hidden_ = std::move(folder) + "/"; }

  /// Throws Error "PATH: cannot be written: ..." if GDAL has reported an error since construction. GDAL reports some
  /// errors only when a dataset is closed, by functions that return nothing. `bytes`: size of the samples; the message
  /// mentions a full disk only if there is no room for them.
  void require_good(const std::string& path, double bytes) const;

 private:
  static void CPL_STDCALL note(CPLErr level, CPLErrorNum number, const char* text);
  std::string first_, hidden_;
  std::optional<CPLConfigOptionSetter> auxiliary_;
};

/// Throws Error unless the picture has 1 to `most_side` pixels per side.
void require_size(const RgbView& picture, int most_side, const std::string& path, const char* format);

}  // namespace scarp
