// SPDX-License-Identifier: MIT
// Voxels in scenes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/march/find_entry.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {
namespace {

// Visits one voxel after the other, in integers.
constexpr std::string_view kJudge = "voxel-planes";

class VoxelField final : public SceneField {
 public:
  VoxelField(VoxelObjects objects, const VoxelShading& shading) : objects_(std::move(objects)), shading_(shading) {
    validate(shading);
    std::set<std::string_view> marches;
    for (const auto& model : objects_.models()) marches.insert(model->march().name);
    march_ = fmt::format("{}", fmt::join(marches, ", "));
  }

  std::string_view kind() const override { return "voxels"; }
  std::string_view march() const override { return march_; }
  std::optional<WorldBox> box() const override { return objects_.reach(); }
  std::optional<WorldBox> extent() const override { return objects_.box(); }
  double farthest_voxel() const override { return objects_.farthest(); }

  // A ray does not itself identify the voxel that it starts on: without `from` all rays are free.
  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const override {
    return objects_.closest_hit(ray, from, stats);
  }
  Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const override {
    return objects_.closest_hit(ray, from, rules.accept, stats);
  }
  std::string no_trace() const override {
    if (objects_.rounding()) return "rounded voxels record no steps (leave out --rounded)";
    return objects_.records() ? "" : records_nothing(voxel_marches(), march_);
  }
  Hit traced_hit(const Ray& ray, MarchStats* stats, MarchTrace& trace) const override {
    if (const std::string why = no_trace(); !why.empty()) throw Error(why);
    return objects_.traced_hit(ray, stats, trace);
  }
  bool occluded(const Ray& ray, const Hit* from) const override {
    if (!from) return objects_.occluded(ray);
    return shading_.normals == VoxelNormals::smooth ? objects_.occluded(above_steps(ray, *from))
                                                    : objects_.occluded_from(*from, ray);
  }
  bool likes_batches() const override { return true; }
  bool mirrors() const override { return objects_.mirrors(); }
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) const override {
    objects_.closest_hits(rays, hits, from);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from) const override {
    if (shading_.normals == VoxelNormals::smooth && !from.empty()) return SceneField::occluded(rays, blocked, from);
    objects_.occluded(rays, blocked, from);
  }
  FieldSurface surface(const Ray& ray, const Hit& hit) const override {
    const dvec3 p = ray.at(hit.t);
    FieldSurface surface;
    surface.normal = objects_.normal(p, hit);
    surface.shading_normal = shading_normal(hit, p, surface.normal);
    surface.colour = objects_.colour(hit);
    surface.light = objects_.material(hit);
    if (shading_.corner_ao)
      surface.openness = corner_openness(objects_.grid(hit), hit.voxel, hit.face, objects_.place_in_grid(hit, p));
    return surface;
  }
  std::string no_contacts() const override { return {}; }
  std::optional<FieldContact> sweep(const Capsule& capsule, const dvec3& motion) const override {
    return objects_.sweep(capsule, motion);
  }
  bool overlaps(const TurnedBox& box) const override { return objects_.overlaps(box); }
  std::optional<FieldPoint> closest_point(const dvec3& p, double max_distance) const override {
    return objects_.closest_point(p, max_distance);
  }
  SceneFieldParts parts() const override {
    SceneFieldParts::Voxels voxels{&objects_, {}};
    if (shading_.normals == VoxelNormals::smooth)
      voxels.shadow_ray = [this](const Ray& ray, const Hit& from) { return above_steps(ray, from); };
    return {voxels};
  }
  std::size_t bytes() const override {
    std::size_t bytes = objects_.bytes();
    for (const auto& model : objects_.models()) bytes += model->bytes();
    return bytes;
  }

  std::optional<FieldSurface> within(const dvec3& p) const override {
    const auto colour = objects_.colour_at(p);
    if (!colour) return {};
    return FieldSurface{{0, 0, 1}, {0, 0, 1}, colour};
  }
  double cell_side() const override { return objects_.voxel_side(); }
  std::int64_t elements() const override {
    std::int64_t solid = 0;
    for (const auto& model : objects_.models()) solid += model->grid().solid_count();
    return solid;
  }
  std::optional<std::uint64_t> edits() const override { return objects_.edits(); }
  bool outdated() const override { return objects_.edits() != edits_; }
  SceneFieldPtr rebuilt() const override { return std::make_shared<VoxelField>(objects_.rebuilt(), shading_); }
  SceneFieldPtr judge() const override { return std::make_shared<VoxelField>(objects_.marched_by(kJudge), shading_); }
  SceneFieldPtr coarser(int level) const override {
    return std::make_shared<VoxelField>(objects_.coarser(level), shading_);
  }

 private:
  // A surface with smooth normals must not be shadowed by its own steps. Voxels whose centres are below a plane have
  // corners up to sqrt(3) / 2 voxels above it, and faces as far below it: the ray starts free above all of them.
  Ray above_steps(const Ray& ray, const Hit& from) const {
    const dvec3 p = ray.at(ray.t_min), normal = objects_.normal(p, from);
    Ray above = ray;
    above.origin += std::sqrt(3.0) * objects_.voxel_side(from) * shading_normal(from, p, normal);
    return above;
  }

  dvec3 shading_normal(const Hit& hit, const dvec3& p, const dvec3& normal) const {
    if (shading_.normals == VoxelNormals::flat || hit.face == VoxelFace::inside) return normal;
    const dvec3 point = shading_.normals == VoxelNormals::smooth
                            ? objects_.place_in_grid(hit, p)
                            : dvec3(hit.voxel) + 0.5 + 0.5 * dvec3(normal_of(hit.face));
    const dvec3 smooth = smooth_normal(objects_.grid(hit), point, shading_.normal_radius, dvec3(normal_of(hit.face)));
    if (smooth == dvec3(0.0)) return normal;
    const dvec3 in_world = objects_.world_from_grid(hit, smooth);
    const double towards = dot(in_world, normal);
    if (towards > 0) return in_world;
    // A face of a step that faces up the slope is lit like the slope; on leaves and threads, where the other side may
    // dominate, the face normal is blended in.
    const dvec3 along = in_world - towards * normal;
    return normalize(along + std::max(0.0, 1 - 2 * length(along)) * normal);
  }

  VoxelObjects objects_;
  std::string march_;
  VoxelShading shading_;
  std::uint64_t edits_ = objects_.edits();  // when its boxes were computed
};

}  // namespace

SceneFieldPtr scene_voxels(PlacedVoxels voxels, const VoxelShading& shading) {
  return std::make_shared<VoxelField>(VoxelObjects(std::move(voxels)), shading);
}

}  // namespace scarp
