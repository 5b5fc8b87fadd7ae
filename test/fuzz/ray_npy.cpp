// SPDX-License-Identifier: MIT
// Any bytes as an array of rays: parsed, or rejected with an Error.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/source/table/ray_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const scarp::RayTable table = scarp::parse_ray_npy({reinterpret_cast<const char*>(data), size});
    if (table.rows.size() > size) std::abort();
    for (const scarp::RayRow& row : table.rows) {
      if (!std::isfinite(row.origin.x) || !std::isfinite(row.aim.z) || !(row.t_max >= row.t_min)) std::abort();
    }
  } catch (const scarp::Error& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
  return 0;
}
