// SPDX-License-Identifier: MIT
// Any bytes as the form of a volume, as the header of one, and as its samples: parsed, or rejected with an Error of one
// line; nothing is read out of bounds.
#include "scarp/source/voxel/dense_volume.h"

#include <string>
#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"

namespace {

using scarp::fuzz::require;

void read(const scarp::VolumeFormat& format, std::string_view bytes) {
  const scarp::DenseVolume volume(format, std::string(bytes));
  const scarp::ivec3 last = volume.size() - 1;
  (void)volume[scarp::ivec3(0)];
  (void)volume[last];
  (void)volume[scarp::ivec3(last.x, 0, last.z)];
}

template <class Format>
void parse(const Format& format, std::string_view bytes) {
  try {
    const scarp::VolumeFormat found = format();
    for (int axis = 0; axis < 3; ++axis) require(found.size[axis] >= 1 && found.size[axis] <= scarp::kMaxVolumeSide);
    require(found.offset >= 0);
    read(found, bytes);
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_message(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  // The form ends at a zero, the samples begin behind it.
  const std::size_t end = bytes.find('\0');
  const std::string_view rest = end == std::string_view::npos ? std::string_view() : bytes.substr(end + 1);
  parse([&] { return scarp::parse_volume_format(bytes.substr(0, end)); }, rest);
  parse([&] { return scarp::npy_volume_format(bytes); }, bytes);
  return 0;
}
