// SPDX-License-Identifier: MIT
// Any bytes as a table of rays in CSV: parsed, or rejected with an Error of one line.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "fuzz/fuzz.h"
#include "scarp/base/error.h"
#include "scarp/source/table/ray_table.h"

namespace {

using scarp::fuzz::require;

bool finite(const scarp::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const scarp::RayTable table = scarp::parse_ray_csv({reinterpret_cast<const char*>(data), size});
    require(table.carried.cells.size() == table.rows.size() * table.carried.names.size());
    for (const scarp::RayRow& row : table.rows) {
      require(finite(row.origin) && finite(row.aim) && row.line >= 1);
      require(std::isfinite(row.t_min) && row.t_max >= row.t_min);
      require(table.aim == scarp::RayAim::target ? row.aim != row.origin : row.aim != scarp::dvec3(0.0));
    }
  } catch (const scarp::Error& error) {
    scarp::fuzz::expect_line(error);
  }
  return 0;
}
