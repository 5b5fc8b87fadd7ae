// SPDX-License-Identifier: MIT
// Terrain functions in scenes. Shadows are those of the surface that is seen, so rays from it begin on it; normals for
// shading may have more octaves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/march/function_marches.h"
#include "scarp/scene/scene_field.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 4> kMarches = {"naive", "relaxed", "lipschitz", "lipschitz-local"};

dvec3 upward(const dvec2& slope) { return normalize(dvec3(-slope.x, -slope.y, 1)); }

class FunctionField final : public SceneField {
 public:
  FunctionField(HeightFunction function, std::string_view march, const MarchSettings& settings,
                const LipschitzLocalSettings& local)
      : function_(std::move(function)), settings_(settings), local_(local) {
    const auto found = std::find(kMarches.begin(), kMarches.end(), march);
    if (found == kMarches.end()) {
      throw Error(fmt::format("march '{}': functions have no such march; there are: {}", march,
                              fmt::join(kMarches, ", ")));
    }
    march_ = *found;
    validate(settings_);
    validate(local_);
  }

  std::string_view kind() const override { return "function"; }
  std::string_view march() const override { return march_; }
  std::optional<WorldBox> box() const override { return {}; }
  std::optional<double> height(double x, double y) const override { return function_.value(x, y); }

  FieldHit closest_hit(const Ray& ray, const FieldHit* from, MarchStats* stats) const override {
    Ray r = ray;
    r.start = from ? RayStart::on_surface : RayStart::free;
    const Hit hit = follow(r, stats);
    return {hit.status, hit.t, hit};
  }
  bool occluded(const Ray& ray, const FieldHit* from) const override {
    return static_cast<bool>(closest_hit(ray, from, nullptr));
  }
  FieldSurface surface(const Ray& ray, const FieldHit& hit) const override {
    const dvec3 p = ray.at(hit.t);
    return {upward(function_.gradient(p.x, p.y, FunctionUse::march)),
            upward(function_.gradient(p.x, p.y, FunctionUse::normal)),
            {}};
  }

 private:
  Hit follow(const Ray& ray, MarchStats* stats) const {
    if (march_ == "lipschitz-local") return march_lipschitz_local(function_, ray, local_, stats);
    if (march_ == "lipschitz") return march_lipschitz(function_, ray, settings_, stats);
    return (march_ == "naive" ? march_naive : march_relaxed)(function_, ray, settings_, stats, FunctionUse::march);
  }

  HeightFunction function_;
  std::string_view march_;
  MarchSettings settings_;
  LipschitzLocalSettings local_;
};

}  // namespace

std::span<const std::string_view> scene_function_marches() { return kMarches; }

SceneFieldPtr scene_function(HeightFunction function, std::string_view march, const MarchSettings& settings,
                             const LipschitzLocalSettings& local) {
  return std::make_shared<FunctionField>(std::move(function), march, settings, local);
}

}  // namespace scarp
