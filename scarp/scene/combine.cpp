// SPDX-License-Identifier: MIT
#include "scarp/scene/combine.h"

#include <fmt/format.h>

#include <unordered_map>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {

Scene combine(const std::vector<ScenePart>& parts) {
  std::vector<SceneFieldPtr> fields;
  std::vector<SceneObject> objects;
  std::unordered_map<const SceneField*, std::uint32_t> index_of;
  for (const ScenePart& part : parts) {
    if (part.scene.on_device())
      throw Error(
          fmt::format("scene: part {} is on a device (combine first, then call scene_on())", &part - parts.data()));
    for (SceneObject object : part.scene.objects()) {
      const SceneFieldPtr& field = part.scene.fields()[object.field];
      const auto [place, fresh] = index_of.try_emplace(field.get(), static_cast<std::uint32_t>(fields.size()));
      if (fresh) fields.push_back(field);
      object.field = place->second;
      object.placement = placed(part.placement, object.placement);
      if (part.material) object.material = *part.material;
      if (part.mask) object.mask = *part.mask;
      objects.push_back(object);
    }
  }
  return Scene(std::move(fields), std::move(objects));
}

}  // namespace scarp
