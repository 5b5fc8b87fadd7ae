// SPDX-License-Identifier: MIT
// Any bytes as a scanner in JSON: parsed, or rejected with an Error of one line.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/scanner_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using scarp::fuzz::require;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // The path of a scanner may name any file, and a device has no end.
  if (text.find("dev") != std::string_view::npos || text.find('\\') != std::string_view::npos) return 0;
  try {
    const scarp::ScannerFile file = scarp::parse_scanner(text, "no-such-folder");
    const scarp::Lidar& lidar = file.lidar;
    scarp::validate(lidar);
    require(file.places.size() == lidar.path.size() && lidar.channels() > 0);
    for (const scarp::LidarPose& pose : lidar.path)
      require(std::isfinite(pose.position.x) && std::isfinite(pose.position.y) && std::isfinite(pose.position.z));
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_line(error);
  }
  return 0;
}
