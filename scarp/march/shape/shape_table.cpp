// SPDX-License-Identifier: MIT
#include "scarp/march/shape/shape_table.h"

#include <array>

#include "scarp/march/find_entry.h"
#include "scarp/march/shape/sphere_trace.h"

namespace scarp {
namespace {

constexpr std::array kShapeTable = {
    ShapeMarchEntry{
        {.name = "sphere-trace",
         .guarantee = Guarantee::conservative,
         .gpu = true,
         .parameters = "tolerance 1e-6 of the distance, 1024 steps",
         .description =
             "steps by the distance to the nearest surface, converges by bounds of segments; never passes through"},
        march_sphere_trace,
        occluded_sphere_trace,
        march_sphere_trace_filtered},
};

}  // namespace

std::span<const ShapeMarchEntry> shape_marches() { return kShapeTable; }
const ShapeMarchEntry& find_shape_march(std::string_view name) { return find_entry(shape_marches(), name); }

}  // namespace scarp
