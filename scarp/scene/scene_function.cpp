// SPDX-License-Identifier: MIT
// Terrain functions in scenes. The visible surface, the one that casts shadows and the one used for normals may have
// different octaves (FunctionUse).
#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "scarp/march/find_entry.h"
#include "scarp/march/function/lipschitz_local_rules.h"
#include "scarp/march/sampling/shrink_factor.h"
#include "scarp/scene/function_shadow.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/scene_limits.h"

namespace scarp {
namespace {

dvec3 upward(const dvec2& slope) { return normalize(dvec3(-slope.x, -slope.y, 1)); }

class FunctionField final : public SceneField {
 public:
  FunctionField(HeightFunction function, const FunctionMarchEntry& march, const MarchSettings& settings)
      : function_(std::move(function)), march_(march), settings_(settings) {
    validate(settings_);
  }

  std::string_view kind() const override { return "function"; }
  std::string_view march() const override { return march_.name; }
  Sampling sampling() const override { return march_.sampling; }
  std::string caveat() const override {
    if (march_.sampling != Sampling::lipschitz) return {};
    return lipschitz_caveat(settings_.lipschitz, function_.bound_everywhere(FunctionUse::march).slope);
  }
  std::optional<WorldBox> box() const override { return {}; }
  std::optional<double> height(double x, double y) const override { return function_.value(x, y); }

  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const override {
    return march_.cpu(function_, from ? started(ray, from) : ray, settings_, stats, FunctionUse::march);
  }
  std::string no_trace() const override {
    return march_.traced ? "" : records_nothing(function_marches(), march_.name);
  }
  Hit traced_hit(const Ray& ray, MarchStats* stats, MarchTrace& trace) const override {
    return march_.traced ? march_.traced(function_, ray, settings_, stats, trace)
                         : SceneField::traced_hit(ray, stats, trace);
  }
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    if (!rules.accept || !march_.filtered) return SceneField::accepted_hit(ray, from, rules, stats);
    return march_.filtered(function_, below(), from ? started(ray, from) : ray, *rules.accept, settings_, stats);
  }
  bool occluded(const Ray& ray, const Hit* from) const override {
    const Ray r = on_shadow_surface(function_, from ? started(ray, from) : ray);
    return static_cast<bool>(march_.cpu(function_, r, settings_, nullptr, FunctionUse::shadow));
  }
  bool likes_batches() const override { return march_.simd; }
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) const override {
    if (!march_.simd) return SceneField::closest_hits(rays, hits, from);
    if (from.empty()) return march_.batch(function_, rays, hits, settings_, {}, FunctionUse::march);
    std::vector<Ray> begun(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) begun[i] = started(rays[i], from[i]);
    march_.batch(function_, begun, hits, settings_, {}, FunctionUse::march);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from) const override {
    if (!march_.simd) return SceneField::occluded(rays, blocked, from);
    std::vector<Ray> begun(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
      begun[i] = on_shadow_surface(function_, from.empty() ? rays[i] : started(rays[i], from[i]));
    std::vector<Hit> own(rays.size());
    march_.batch(function_, begun, own, settings_, {}, FunctionUse::shadow);
    std::transform(own.begin(), own.end(), blocked.begin(), [](const Hit& hit) { return hit ? 1 : 0; });
  }
  std::optional<FieldSurface> within(const dvec3& p) const override {
    if (p.z > function_.value(p.x, p.y)) return {};
    const dvec3 normal = upward(function_.gradient(p.x, p.y, FunctionUse::march));
    return FieldSurface{normal, normal};
  }
  FieldSurface surface(const Ray& ray, const Hit& hit) const override {
    const dvec3 p = ray.at(hit.t);
    const dvec3 normal = upward(function_.gradient(p.x, p.y, FunctionUse::normal));
    return {function_.normals_are_of_march() ? normal : upward(function_.gradient(p.x, p.y, FunctionUse::march)),
            normal};
  }
  // The judge misses no crossing.
  SceneFieldPtr judge() const override {
    MarchSettings settings;
    settings.lipschitz_local.max_steps = kStepsOfJudge;
    return scene_function(function_, find_function_march("lipschitz-local"), settings);
  }
  SceneFieldParts parts() const override { return {SceneFieldParts::Function{&function_, &march_, &settings_}}; }

 private:
  // Compiled on the first query with a filter.
  const HeightFunction& below() const {
    std::call_once(below_made_, [&] { below_.emplace(upside_down(function_)); });
    return *below_;
  }

  HeightFunction function_;
  const FunctionMarchEntry& march_;
  MarchSettings settings_;
  mutable std::once_flag below_made_;
  mutable std::optional<HeightFunction> below_;
};

}  // namespace

SceneFieldPtr scene_function(HeightFunction function, const FunctionMarchEntry& march, const MarchSettings& settings) {
  return std::make_shared<FunctionField>(std::move(function), march, settings);
}

}  // namespace scarp
