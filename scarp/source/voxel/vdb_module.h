// SPDX-License-Identifier: MIT
// Private to the station: the interface to the module that contains OpenVDB. Both sides are built together.
#pragma once

#include <string>

#include "scarp/source/voxel/vdb_file.h"

namespace scarp {

/// Functions return false and set `error` instead of throwing.
struct VdbModule {
  bool (*read)(const std::string& path, VdbVoxels& voxels, std::string& error);
  bool (*write)(const std::string& path, const VdbVoxels& voxels, std::string& error);
};

/// The name of the one exported symbol, a VdbModule.
inline constexpr char kVdbModule[] = "scarp_vdb_module";

}  // namespace scarp
