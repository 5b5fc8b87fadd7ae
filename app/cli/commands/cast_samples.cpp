// SPDX-License-Identifier: MIT
#include "app/cli/commands/cast_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/march_trace.h"
#include "scarp/output/trace_table.h"
#include "scarp/scene/voxel_entry.h"

namespace scarp::cli {
namespace {

// Voxels in the coordinates of their file, as those of hits.
void number_as_file(const Scene& scene, TraceStep& step) {
  Hit hit;
  hit.status = HitStatus::hit;
  hit.part = step.object;
  const auto in_file = [&](const ivec3& voxel) {
    hit.voxel = voxel;
    return file_voxel(scene, hit).value_or(voxel);
  };
  // The file may count the other way: its lowest corner is one of two.
  const ivec3 low = in_file(step.low), high = in_file(step.low + (std::max(step.size, 1) - 1));
  step.voxel = in_file(step.voxel);
  step.low = step.kind == TraceKind::cube ? min(low, high) : step.voxel;
}

}  // namespace

void require_samples(const Scene& scene) {
  const SceneField* field = scene.only_field();
  if (!field) throw Error("--samples: the scene has several objects (give one terrain, function or voxel file)");
  if (const std::string why = field->no_trace(); !why.empty()) throw Error("--samples: " + why);
}

void write_samples(TraceTable& samples, const Scene& scene, std::span<const Ray> rays, const RayTable& table,
                   const CoordinateFrame& frame) {
  MarchTrace trace;
  std::vector<dvec3> positions;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    const Hit hit = scene.only_field()->traced_hit(ray, nullptr, trace);
    positions.clear();
    for (TraceStep& step : trace.steps) {
      if (is_voxel(step.kind)) number_as_file(scene, step);
      positions.push_back(ray.at(step.t));
    }
    positions.push_back(hit ? ray.at(hit.t) : ray.origin);
    if (frame.from_local(positions)) {
      throw Error(
          fmt::format("--samples: ray {}: a sample is at a place that has no longitude and latitude (use --coords map)",
                      table.index(i)));
    }
    samples.add(table.index(i), trace.steps, positions, hit);
    stop_if_interrupted();
  }
}

}  // namespace scarp::cli
