// SPDX-License-Identifier: MIT
#include "scarp/render/look/cost_look.h"

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/march_trace.h"

namespace scarp {
namespace {

constexpr std::uint32_t kCorners = 4;  // heights of a cell

// Reads of a cell test beyond the step that it counts as. `steps` of functions and shapes lack some evaluations, which
// count as tests.
std::uint32_t more_per_test(std::string_view kind) {
  if (kind == "heights") return kCorners - 1;
  return kind == "function" || kind == "shape" ? 1 : 0;
}

std::uint32_t recorded_reads(const MarchTrace& trace, bool heights) {
  std::uint32_t reads = 0;
  for (const TraceStep& step : trace.steps)
    reads += heights && (is_sample(step.kind) || is_cell(step.kind)) ? kCorners : 1;
  return reads;
}

// A field whose marches count reads. Scene queries of camera rays need these functions only.
class CountingField final : public SceneField {
 public:
  explicit CountingField(SceneFieldPtr field)
      : field_(std::move(field)),
        heights_(field_->kind() == "heights"),
        records_(field_->no_trace().empty()),
        more_per_test_(more_per_test(field_->kind())) {
    if (field_->kind() == "tiles") throw Error("picture: the look cost does not count the reads of tiles");
  }

  std::string_view kind() const override { return field_->kind(); }
  std::string_view march() const override { return field_->march(); }
  Sampling sampling() const override { return field_->sampling(); }
  std::optional<WorldBox> box() const override { return field_->box(); }
  std::optional<WorldBox> extent() const override { return field_->extent(); }
  double farthest_voxel() const override { return field_->farthest_voxel(); }
  bool is_backdrop() const override { return field_->is_backdrop(); }
  std::optional<double> height(double x, double y) const override { return field_->height(x, y); }
  bool occluded(const Ray& ray, const Hit* from) const override { return field_->occluded(ray, from); }
  FieldSurface surface(const Ray& ray, const Hit& hit) const override { return field_->surface(ray, hit); }
  std::optional<FieldSurface> within(const dvec3& p) const override { return field_->within(p); }
  double cell_side() const override { return field_->cell_side(); }
  SceneFieldParts parts() const override { return field_->parts(); }
  // The scene tests fields that like batches first; what they hide is not marched.
  bool likes_batches() const override { return field_->likes_batches(); }
  Ray started(const Ray& ray, const Hit* from) const override { return field_->started(ray, from); }

  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const override {
    if (!stats) return field_->closest_hit(ray, from, nullptr);
    if (!records_) {
      const Hit hit = field_->closest_hit(ray, from, stats);
      stats->steps += more_per_test_ * stats->cell_tests;
      return hit;
    }
    // One per thread: fixed-step records thousands of steps per ray.
    thread_local MarchTrace trace;
    const Hit hit = field_->traced_hit(ray, stats, trace);
    stats->steps = recorded_reads(trace, heights_);
    return hit;
  }

 private:
  const SceneFieldPtr field_;
  const bool heights_, records_;
  const std::uint32_t more_per_test_;
};

}  // namespace

Scene counting_reads(const Scene& scene) {
  if (scene.on_device())
    throw Error("picture: the look cost counts the reads of the CPU's marches (render on the CPU)");
  std::vector<SceneFieldPtr> fields;
  for (const SceneFieldPtr& field : scene.fields()) fields.push_back(std::make_shared<CountingField>(field));
  return {std::move(fields), scene.objects()};
}

}  // namespace scarp
