// SPDX-License-Identifier: MIT
// Any bytes as a table of poses in CSV: parsed, or rejected with an Error of one line.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"
#include "scarp/source/table/pose_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using scarp::fuzz::require;
  try {
    const scarp::PoseTable table = scarp::parse_pose_csv({reinterpret_cast<const char*>(data), size});
    require(!table.rows.empty());
    double last = -std::numeric_limits<double>::infinity();
    for (const scarp::PoseRow& row : table.rows) {
      require(row.time > last && std::isfinite(row.time) && row.line >= 1);
      last = row.time;
      for (const double number : {row.at.x, row.at.y, row.at.z, row.heading, row.pitch, row.roll})
        require(std::isfinite(number));
    }
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_line(error);
  }
  return 0;
}
