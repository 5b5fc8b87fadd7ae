// SPDX-License-Identifier: MIT
// A height field, what its march needs, and the march itself, behind the two questions that renderers ask: what does a
// ray hit first, and does it hit anything at all?
#pragma once

#include <limits>
#include <optional>

#include "scarp/march/marches.h"

namespace scarp {

/// Immutable; copies share samples and pyramid. Both questions may be asked from many threads at once.
class TerrainScene {
 public:
  /// Builds what the march needs. Throws Error when a setting is out of its range. `march` is a row of marches().
  TerrainScene(HeightField field, const MarchEntry& march, const MarchSettings& settings = {});

  /// The first hit as the march finds it. `stats`, when given, is overwritten.
  Hit closest_hit(const Ray& ray, MarchStats* stats = nullptr) const;
  /// Whether closest_hit(ray) is a hit, without computing where when the march can do that.
  bool occluded(const Ray& ray) const;

  const HeightField& field() const { return field_; }
  const MarchEntry& march() const { return *march_; }

 private:
  HeightTarget target() const { return {&field_, pyramid_ ? &*pyramid_ : nullptr, slope_}; }

  HeightField field_;
  const MarchEntry* march_;
  MarchSettings settings_;
  std::optional<MaxPyramid> pyramid_;
  double slope_ = std::numeric_limits<double>::quiet_NaN();  // only where the march asks for it
};

}  // namespace scarp
