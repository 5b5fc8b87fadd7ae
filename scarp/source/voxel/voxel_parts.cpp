// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/voxel_parts.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/voxel/qubicle.h"
#include "scarp/source/voxel/voxlap.h"
#include "scarp/source/whole_file.h"

namespace scarp {

bool is_voxel_parts_path(std::string_view path) {
  const std::string extension = extension_of(std::string(path));
  return extension == ".qb" || extension == ".kv6" || extension == ".vxl";
}

bool is_voxel_parts_file(const std::string& path) {
  if (is_voxel_parts_path(path)) return true;
  if (extension_of(path) != ".vox") return false;
  try {
    bool voxlap = false;
    whole_file(path, [&](std::string_view first, std::uint64_t size) {
      voxlap = is_voxlap_vox(first, size);
      return false;
    });
    return voxlap;
  } catch (const Error&) {
    return false;  // the reader of .vox files reports it
  }
}

VoxelParts read_voxel_parts(const std::string& path) {
  const std::string extension = extension_of(path);
  try {
    const std::string bytes = whole_file(path, std::string_view());
    if (bytes.empty()) throw Error("empty file (0 bytes)");
    return extension == ".qb"    ? parse_qubicle(bytes)
           : extension == ".kv6" ? parse_kv6(bytes)
           : extension == ".vxl" ? parse_vxl(bytes)
                                 : parse_voxlap_vox(bytes);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
