// SPDX-License-Identifier: MIT
// Any bytes as a Qubicle file: voxels inside their parts, or an Error of one line.
#include "scarp/source/voxel/qubicle.h"

#include <string_view>

#include "fuzz/voxel_parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  scarp::fuzz::expect_parts(scarp::parse_qubicle, {reinterpret_cast<const char*>(data), size});
  return 0;
}
