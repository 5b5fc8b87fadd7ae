// SPDX-License-Identifier: MIT
#include "scarp/scene/terrain_scene_vk.h"

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "scarp/accel/device_ground.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/queries_vk.h"

namespace scarp {
namespace {

class OnDevice final : public BatchQueries {
 public:
  OnDevice(const Device& device, HeightField field, const HeightMarchEntry& march, const MarchSettings& settings)
      : device_(device),
        field_(std::move(field)),
        march_(march),
        settings_(settings),
        queries_(device, march, settings),
        ground_(device, field_),
        slope_(march.needs_slope ? slope_bound(field_) : std::numeric_limits<double>::quiet_NaN()),
        terrain_{device_, ground_, settings_} {}

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps) override {
    if (steps.empty()) return queries_.closest_hits(target(), rays, hits);
    if (!counting_) counting_.emplace(device_, march_, settings_, DeviceQuerySettings{.statistics = true});
    std::vector<DeviceRayCost> costs(steps.size());
    counting_->closest_hits(target(), rays, hits, costs);
    for (std::size_t i = 0; i < costs.size(); ++i) steps[i] = costs[i].steps;
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) override {
    queries_.occluded(target(), rays, blocked);
  }
  const DeviceTerrain* terrain() const override { return &terrain_; }

 private:
  DeviceTarget target() const { return {&field_, &ground_, slope_}; }

  Device device_;
  HeightField field_;
  const HeightMarchEntry& march_;
  MarchSettings settings_;
  DeviceQueries queries_;
  std::optional<DeviceQueries> counting_;  // made when steps are asked for: counting takes time
  DeviceGround ground_;
  double slope_;
  DeviceTerrain terrain_;
};

}  // namespace

TerrainScene terrain_scene_on(const Device& device, HeightField field, const HeightMarchEntry& march,
                              const MarchSettings& settings) {
  auto queries = std::make_shared<OnDevice>(device, field, march, settings);
  return {std::move(field), march, std::move(queries)};
}

}  // namespace scarp
