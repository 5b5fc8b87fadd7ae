// SPDX-License-Identifier: MIT
// A field with the march that follows rays over it, as an object of a scene: the same questions for heights, functions,
// shapes and voxels, in the field's own space.
//
// A ray that begins on the surface of a hit does so by the field's own rule (cell, place, voxel): nothing is pushed
// off, but for the shadow rays of voxels with smooth normals.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "scarp/field/distance_field.h"
#include "scarp/field/height_function.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/shape/shape_table.h"
#include "scarp/scene/box_tree.h"
#include "scarp/scene/voxel_scene.h"
#include "scarp/scene/voxel_shading.h"

namespace scarp {

/// An answer in the field's own terms.
struct FieldHit {
  HitStatus status = HitStatus::miss;
  double t = std::numeric_limits<double>::infinity();
  /// Hit: of heights (with cell), functions and shapes (without); VoxelSceneHit: of voxels. Set for hits.
  std::variant<std::monostate, Hit, VoxelSceneHit> own;

  explicit operator bool() const { return status == HitStatus::hit; }
};

/// What is at a hit, in the field's space.
struct FieldSurface {
  dvec3 normal{0.0};                    ///< unit, outward; zero for a ray that began inside
  dvec3 shading_normal{0.0};            ///< unit
  std::optional<VoxelColour> colour{};  ///< where the field has colours of its own
  int material = 0;                     ///< of the part of a shape, as in distance_node.h; 0: that of the object
  double openness = 1;                  ///< share of the sky that is there, as far as the field tells by itself
};

/// What a field is made of, for those who answer its rays elsewhere (field_queries.h).
struct SceneFieldParts {
  template <class Field, class Entry>
  struct Marched {
    const Field* field;
    const Entry* march;
    const MarchSettings* settings;
  };
  using Heights = Marched<HeightField, HeightMarchEntry>;
  using Function = Marched<HeightFunction, FunctionMarchEntry>;
  using Shape = Marched<DistanceField, ShapeMarchEntry>;

  std::variant<Heights, Function, Shape, const VoxelScene*> of;
};

/// Immutable; asked from many threads at once.
class SceneField {
 public:
  virtual ~SceneField() = default;

  virtual std::string_view kind() const = 0;   ///< "heights", "function", "shape", "voxels"
  virtual std::string_view march() const = 0;  ///< its name
  /// Around everything that rays can meet: empty when that is nothing; no box for a field without an end.
  virtual std::optional<WorldBox> box() const = 0;
  /// Of the ground at (x, y); nothing beside it, and for fields that are no ground.
  virtual std::optional<double> height(double x, double y) const;

  /// `ray` counts as free, but for `from`: a hit of this field on whose surface it begins, or null. `stats`, when
  /// given, is overwritten.
  virtual FieldHit closest_hit(const Ray& ray, const FieldHit* from, MarchStats* stats) const = 0;
  /// Whether closest_hit() would tell a hit; of a function with fewer octaves for shadows, of that surface; `from`
  /// voxels with smooth normals, of the ray from above their steps.
  virtual bool occluded(const Ray& ray, const FieldHit* from) const = 0;
  virtual FieldSurface surface(const Ray& ray, const FieldHit& hit) const = 0;

  /// What the field is like at a point below the ground, in the shape or in a solid voxel, surface included: normals of
  /// the surface above or nearest. Nothing outside, beside the ground and in its holes.
  virtual std::optional<FieldSurface> within(const dvec3& p) const = 0;

  /// The least thing that there is to see, in metres: a voxel. 0: nothing that is made coarser.
  virtual double detail() const { return 0; }
  /// What stands for the field where 2^level times its detail is small; null: the field itself.
  virtual std::shared_ptr<const SceneField> coarser(int) const { return nullptr; }

  virtual SceneFieldParts parts() const = 0;
  /// The ray as the field's march wants it: on the surface that `from` hit, or free when that is null. `shadow`: of
  /// occluded(), for fields whose shadows are thrown by another surface than what is seen.
  virtual Ray started(const Ray& ray, const FieldHit* from, bool shadow) const;

  /// Whether rays are answered faster by the hundred.
  virtual bool likes_batches() const { return false; }
  /// The same answers for many rays, on the calling thread; `from` has the length of `rays`.
  virtual void closest_hits(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                            std::span<FieldHit> hits) const;
  virtual void occluded(std::span<const Ray> rays, std::span<const FieldHit* const> from,
                        std::span<std::uint8_t> blocked) const;
};

using SceneFieldPtr = std::shared_ptr<const SceneField>;

/// `march` is a row of height_marches(); the field must not wrap round. Builds what the march needs. Throws Error for
/// a setting out of its range, a field that wraps round.
SceneFieldPtr scene_heights(HeightField field, const HeightMarchEntry& march = find_height_march("max-mip"),
                            const MarchSettings& settings = {});

/// `march` is a row of function_marches(). Throws Error for a setting out of its range.
SceneFieldPtr scene_function(HeightFunction function,
                             const FunctionMarchEntry& march = find_function_march("lipschitz-local"),
                             const MarchSettings& settings = {});

/// `march` is a row of shape_marches(). Throws Error for a setting out of its range.
SceneFieldPtr scene_shape(DistanceField shape, const ShapeMarchEntry& march = find_shape_march("sphere-trace"),
                          const MarchSettings& settings = {});

/// The objects of a voxel scene as one; each model has its march. With VoxelNormals::smooth, occluded() moves a ray
/// that begins on a voxel up the smooth normal, by sqrt(3) voxels, lest it be shaded by the steps of what looks smooth.
/// Throws Error for a shading out of its range.
SceneFieldPtr scene_voxels(VoxelScene scene, std::string_view march, const VoxelShading& shading = {});

}  // namespace scarp
