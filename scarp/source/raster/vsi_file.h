// SPDX-License-Identifier: MIT
// Private to the station: files of GDAL's virtual file systems, closed by their owner.
#pragma once

#include <cpl_vsi.h>

#include <memory>

namespace scarp {

struct VsiCloser {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using VsiFile = std::unique_ptr<VSILFILE, VsiCloser>;

}  // namespace scarp
