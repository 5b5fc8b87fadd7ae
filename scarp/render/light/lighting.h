// SPDX-License-Identifier: MIT
// The light on a surface point: the rays that it requires, and the light that results from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scarp/render/light/light.h"
#include "scarp/render/light/light_settings.h"
#include "scarp/render/light/sample_pattern.h"
#include "scarp/render/light/visibility.h"

namespace scarp {

/// Range of the light rays of one point in a list.
struct LightRays {
  std::size_t sun = 0;  ///< the first to the sun; ends at the first to the sky
  std::size_t sky = 0;  ///< the first to the sky
  std::size_t end = 0;
};

class Lighting {
 public:
  /// Rays to the sky end after `ao_distance` metres. `highest`, for wrapped ground: height above which there is
  /// nothing, where rays to the sun end.
  Lighting(const LightSettings& settings, double ao_distance, std::optional<double> highest = {});

  /// Maximum number of rays appended by ask().
  std::size_t most_rays() const;
  /// Appends the rays for the light on a point.
  LightRays ask(const LightPoint& at, const PicturePoint& point, std::vector<Ray>& rays) const;
  /// Returns linear light; `rays` and their results are those that `asked` refers to.
  vec3 on(const LightPoint& at, const LightRays& asked, std::span<const Ray> rays,
          std::span<const std::uint8_t> blocked) const;
  /// Rays per point: to the sun at most, and to the sky.
  int sun_rays() const;
  int sky_rays() const;
  /// Whether surfaces block the sun, and the number of rays per point and purpose; none in unlit pictures.
  bool shadows() const { return settings_.shadows && !settings_.unlit; }
  int samples() const { return settings_.unlit ? 0 : settings_.samples; }
  /// Length of rays to the sky, metres.
  double ao_distance() const { return ao_distance_; }
  const SamplePattern& pattern() const { return pattern_; }
  const Light& light() const { return light_; }
  /// Unit vector to the middle of the sun's disc.
  const dvec3& to_sun() const { return light_.to_sun(); }
  /// Radius of the disc with `samples`; otherwise the sun is a point.
  double sun_radius() const { return samples() > 0 ? light_.sun_radius() : 0; }

 private:
  LightSettings settings_;
  Light light_;
  SamplePattern pattern_;
  double ao_distance_;
  std::optional<double> highest_;
};

}  // namespace scarp
