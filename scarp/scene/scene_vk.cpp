// SPDX-License-Identifier: MIT
#include "scarp/scene/scene_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "scarp/accel/device_function.h"
#include "scarp/accel/device_ground.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/march/function/function_queries_vk.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/march/shape/shape_queries_vk.h"
#include "scarp/scene/field_on_device.h"
#include "scarp/scene/function_shadow.h"
#include "scarp/scene/scene_back_end.h"
#include "scarp/scene/scene_voxels_vk.h"

namespace scarp {
namespace {

// Marches that are ready to run, shared by all fields that use them: creating a march takes longer than most of its
// calls.
class Marches {
 public:
  explicit Marches(const Device& device) : device_(device) {}

  const Device& device() const { return device_; }
  DeviceQueries& heights(const HeightMarchEntry& march, const MarchSettings& settings, bool count) {
    auto& queries = heights_[{&march, count}];
    if (!queries) queries = std::make_unique<DeviceQueries>(device_, march, settings, DeviceQuerySettings{count});
    queries->set_march_settings(settings);
    return *queries;
  }
  DeviceFunctionQueries& functions(const FunctionMarchEntry& march, const MarchSettings& settings) {
    auto& queries = functions_[&march];
    if (!queries) queries = std::make_unique<DeviceFunctionQueries>(device_, march, settings);
    queries->set_march_settings(settings);
    return *queries;
  }
  DeviceShapeQueries& shapes(const ShapeMarchEntry& march, const MarchSettings& settings) {
    auto& queries = shapes_[&march];
    if (!queries) queries = std::make_unique<DeviceShapeQueries>(device_, march, settings);
    queries->set_march_settings(settings);
    return *queries;
  }
  const std::shared_ptr<DeviceVoxelQueries>& voxels() {
    if (!voxels_) voxels_ = std::make_shared<DeviceVoxelQueries>(device_);
    return voxels_;
  }

 private:
  Device device_;
  std::map<std::pair<const HeightMarchEntry*, bool>, std::unique_ptr<DeviceQueries>>
      heights_;  // bool: whether it counts
  std::map<const FunctionMarchEntry*, std::unique_ptr<DeviceFunctionQueries>> functions_;
  std::map<const ShapeMarchEntry*, std::unique_ptr<DeviceShapeQueries>> shapes_;
  std::shared_ptr<DeviceVoxelQueries> voxels_;
};

class HeightsOnDevice final : public FieldOnDevice {
 public:
  HeightsOnDevice(Marches& marches, const SceneFieldParts::Heights& parts)
      : marches_(marches),
        parts_(parts),
        ground_(marches.device(), *parts.field),
        terrain_{marches.device(), ground_, *parts.settings} {
    if (parts.march->needs_slope) slope_ = slope_bound(*parts.field);
    queries(false);
  }

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const>) override {
    std::vector<DeviceRayCost> costs(steps.size());
    queries(!steps.empty()).closest_hits(target(), rays, hits, costs);
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = costs[i].steps;
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, std::span<const Hit* const>) override {
    queries(false).occluded(target(), rays, blocked);
  }
  const DeviceTerrain* terrain() const override { return &terrain_; }

 private:
  DeviceQueries& queries(bool count) { return marches_.heights(*parts_.march, *parts_.settings, count); }
  DeviceTarget target() const { return {parts_.field, &ground_, slope_, parts_.seam}; }

  Marches& marches_;
  SceneFieldParts::Heights parts_;
  DeviceGround ground_;
  DeviceTerrain terrain_;
  double slope_ = std::numeric_limits<double>::quiet_NaN();
};

class FunctionOnDevice final : public FieldOnDevice {
 public:
  FunctionOnDevice(Marches& marches, const SceneFieldParts::Function& parts)
      : marches_(marches), parts_(parts), device_(marches.device(), *parts.field) {
    queries();
  }

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const>) override {
    queries().closest_hits({parts_.field, &device_, FunctionUse::march}, rays, hits, steps);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, std::span<const Hit* const>) override {
    std::vector<Ray> begun(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) begun[i] = on_shadow_surface(*parts_.field, rays[i]);
    queries().occluded({parts_.field, &device_, FunctionUse::shadow}, begun, blocked);
  }

 private:
  DeviceFunctionQueries& queries() { return marches_.functions(*parts_.march, *parts_.settings); }

  Marches& marches_;
  SceneFieldParts::Function parts_;
  DeviceFunction device_;
};

class ShapeOnDevice final : public FieldOnDevice {
 public:
  ShapeOnDevice(Marches& marches, const SceneFieldParts::Shape& parts)
      : marches_(marches), parts_(parts), device_(marches.device(), *parts.field) {
    queries();
  }

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const>) override {
    queries().closest_hits({parts_.field, &device_}, rays, hits, steps);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, std::span<const Hit* const>) override {
    queries().occluded({parts_.field, &device_}, rays, blocked);
  }

 private:
  DeviceShapeQueries& queries() { return marches_.shapes(*parts_.march, *parts_.settings); }

  Marches& marches_;
  SceneFieldParts::Shape parts_;
  DeviceShape device_;
};

class OnDevice final : public SceneBackEnd {
 public:
  OnDevice(const Device& device, const std::vector<SceneFieldPtr>& fields, std::shared_ptr<VoxelSight> sight)
      : marches_(device), sight_(std::move(sight)), fields_(fields) {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      try {
        on_device_.push_back(made(*fields_[i]));
      } catch (const Error& error) {
        throw Error(fmt::format("scene: field {} ({}): {}", i, fields_[i]->kind(), error.what()));
      }
    }
    if (!fields_.empty() && std::all_of(on_device_.begin(), on_device_.end(), [](const auto& made) { return !made; })) {
      throw Error(
          fmt::format("scene: field 0 ({}): does not run on Vulkan devices; heights, functions, shapes and voxels that "
                      "are not rounded do: use the CPU",
                      fields_[0]->kind()));
    }
  }

  void closest_hits(std::uint32_t field, std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const> from) override {
    if (!on_device_[field]) return fields_[field]->closest_hits_on_all_threads(rays, hits, steps, from);
    if (from.empty()) return on_device_[field]->closest_hits(rays, hits, steps, from);
    on_device_[field]->closest_hits(started(field, rays, from), hits, steps, from);
  }
  void occluded(std::uint32_t field, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from) override {
    if (!on_device_[field]) return fields_[field]->occluded_on_all_threads(rays, blocked, from);
    if (from.empty()) return on_device_[field]->occluded(rays, blocked, from);
    on_device_[field]->occluded(started(field, rays, from), blocked, from);
  }
  const DeviceTerrain* terrain(std::uint32_t field) const override {
    return on_device_[field] ? on_device_[field]->terrain() : nullptr;
  }

 private:
  // Returns null for a field that does not run on the device.
  std::unique_ptr<FieldOnDevice> made(const SceneField& field) {
    const SceneFieldParts parts = field.parts();
    if (const auto* heights = std::get_if<SceneFieldParts::Heights>(&parts.of))
      return std::make_unique<HeightsOnDevice>(marches_, *heights);
    if (const auto* function = std::get_if<SceneFieldParts::Function>(&parts.of))
      return std::make_unique<FunctionOnDevice>(marches_, *function);
    if (const auto* shape = std::get_if<SceneFieldParts::Shape>(&parts.of))
      return std::make_unique<ShapeOnDevice>(marches_, *shape);
    if (const auto* voxels = std::get_if<SceneFieldParts::Voxels>(&parts.of))
      return voxels_on_device(marches_.device(), marches_.voxels(), sight_, field, *voxels);
    return nullptr;
  }
  std::vector<Ray> started(std::uint32_t field, std::span<const Ray> rays, std::span<const Hit* const> from) const {
    std::vector<Ray> started(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) started[i] = fields_[field]->started(rays[i], from[i]);
    return started;
  }

  Marches marches_;
  std::shared_ptr<VoxelSight> sight_;
  std::vector<SceneFieldPtr> fields_;
  std::vector<std::unique_ptr<FieldOnDevice>> on_device_;  // null: traced on the CPU
};

}  // namespace

Scene scene_on(const Device& device, const Scene& scene, std::shared_ptr<VoxelSight> sight) {
  return scene.answered_by(std::make_shared<OnDevice>(device, scene.fields(), std::move(sight)));
}

}  // namespace scarp
