// SPDX-License-Identifier: MIT
// Any bytes as the formats of Voxlap: voxels inside their parts, or an Error of one line.
#include "scarp/source/voxel/voxlap.h"

#include <string_view>

#include "fuzz/voxel_parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  scarp::fuzz::expect_parts(scarp::parse_kv6, bytes);
  scarp::fuzz::expect_parts(scarp::parse_voxlap_vox, bytes);
  scarp::fuzz::expect_parts(scarp::parse_vxl, bytes);
  return 0;
}
