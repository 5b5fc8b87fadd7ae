// SPDX-License-Identifier: MIT
// Any bytes as a Qubicle file: voxels inside their parts, or refused with an Error of one line.
#include "scarp/source/qubicle.h"

#include <cstdlib>
#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"

namespace {

void require(bool good) {
  if (!good) std::abort();
}

template <class Parse>
void expect(const Parse& parse, std::string_view bytes) {
  try {
    for (const scarp::VoxelPart& part : parse(bytes).parts) {
      for (const scarp::ListedVoxel& v : part.voxels) {
        require(v.x >= 0 && v.y >= 0 && v.z >= 0);
        require(v.x < part.size.x && v.y < part.size.y && v.z < part.size.z);
      }
    }
  } catch (const scarp::Error& error) {
    const std::string_view text = error.what();
    require(!text.empty() && text.find_first_of("\r\n") == std::string_view::npos);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  expect(scarp::parse_qubicle, bytes);
  return 0;
}
