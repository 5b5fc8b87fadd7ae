// SPDX-License-Identifier: MIT
// Any bytes as a .vox file: a document that survives a round trip, or an Error of one line.
#include "scarp/source/voxel/vox_file.h"

#include <string>
#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"
#include "scarp/source/voxel/vox_animation.h"
#include "scarp/source/voxel/vox_scene.h"

namespace {

using scarp::fuzz::require;

void parse(std::string_view bytes) {
  try {
    const scarp::VoxFile file = scarp::parse_vox(bytes);
    require(scarp::parse_vox(scarp::vox_bytes(file)) == file);
    for (const scarp::VoxModel& model : file.models) {
      for (const scarp::VoxVoxel& voxel : model.voxels)
        require(voxel.x < model.size.x && voxel.y < model.size.y && voxel.z < model.size.z);
    }
    try {
      for (const int frame : {0, 7, 1 << 30}) {
        for (const scarp::VoxInstance& instance : scarp::vox_instances(file, {.frame = frame}))
          require(instance.model >= 0 && static_cast<std::size_t>(instance.model) < file.models.size());
      }
      require(scarp::vox_animation(file).frames >= 1);
    } catch (const scarp::Error& error) {
      scarp::fuzz::expect_line(error);
    }
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_line(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  parse(bytes);
  // A valid length is hard to guess: the same bytes as the children of a whole MAIN.
  std::string file("VOX \xc8\0\0\0MAIN\0\0\0\0", 16);
  for (int i = 0; i < 4; ++i) file += static_cast<char>(size >> (8 * i) & 255);
  file += bytes;
  parse(file);
  return 0;
}
