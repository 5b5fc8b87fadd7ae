// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_field.h"

namespace scarp {

std::optional<double> SceneField::height(double, double) const { return {}; }

Ray SceneField::started(const Ray& ray, const FieldHit* from, bool) const {
  Ray r = ray;
  r.start = from ? RayStart::on_surface : RayStart::free;
  return r;
}

void SceneField::closest_hits(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                              std::span<FieldHit> hits) const {
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = closest_hit(rays[i], from[i], nullptr);
}

void SceneField::occluded(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                          std::span<std::uint8_t> blocked) const {
  for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = occluded(rays[i], from[i]);
}

}  // namespace scarp
