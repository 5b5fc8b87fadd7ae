// SPDX-License-Identifier: MIT
// A height field, what its march needs, and the march itself, behind the two questions that renderers ask: what does a
// ray hit first, and does it hit anything at all? Rays are asked by the batch; terrain_scene_vk.h makes scenes whose
// batches a Vulkan device answers.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "scarp/march/height/height_table.h"
#include "scarp/scene/batch_queries.h"

namespace scarp {

/// Immutable; copies share samples and pyramid. Questions may be asked from many threads at once, except on a device.
class TerrainScene {
 public:
  /// Builds what the march needs. Throws Error when a setting is out of its range. `march` is a row of marches().
  TerrainScene(HeightField field, const HeightMarchEntry& march, const MarchSettings& settings = {});
  /// A scene on a device, which answers with the same field, march and settings. Used by one thread at a time.
  TerrainScene(HeightField field, const HeightMarchEntry& march, std::shared_ptr<BatchQueries> device);

  /// hits[i] is the first hit of rays[i], which must be valid (march/height/queries.h), as the march finds it. `steps`,
  /// when not empty, is what each ray cost (MarchStats). Uses all threads. Throws Error when spans differ in length.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps = {}) const;
  /// blocked[i] is 1 where closest_hits would tell a hit, else 0, without computing where when the march can do that.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

  /// The same for one ray. `stats`, when given, is overwritten; a device tells steps alone. On a device one ray takes
  /// as long as thousands.
  Hit closest_hit(const Ray& ray, MarchStats* stats = nullptr) const;
  bool occluded(const Ray& ray) const;

  const HeightField& field() const { return field_; }
  const HeightMarchEntry& march() const { return *march_; }
  bool on_device() const { return device_ != nullptr; }
  /// What a device holds of it; null: none does.
  const DeviceTerrain* device_terrain() const { return device_ ? device_->terrain() : nullptr; }

 private:
  HeightTarget target() const { return {&field_, pyramid_ ? &*pyramid_ : nullptr, slope_}; }

  HeightField field_;
  const HeightMarchEntry* march_;
  MarchSettings settings_;
  std::optional<MaxPyramid> pyramid_;
  double slope_ = std::numeric_limits<double>::quiet_NaN();  // only where the march asks for it
  std::shared_ptr<BatchQueries> device_;                     // null: the CPU answers
};

}  // namespace scarp
