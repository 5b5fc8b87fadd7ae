// SPDX-License-Identifier: MIT
// A field with its march, as an object of a scene: the same queries for heights, functions, shapes, voxels and meshes
// (mesh/scene_mesh.h), in the field's own space.
//
// A ray from a surface starts there by the rule for the field's kind (cell, position, voxel, triangle). Origins are not
// offset, except those of shadow rays of voxels with smooth normals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scarp/field/distance_field.h"
#include "scarp/field/height_function.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/max_mip_fan.h"
#include "scarp/march/shape/shape_table.h"
#include "scarp/march/turned_box.h"
#include "scarp/scene/tree/box_tree.h"
#include "scarp/scene/tree/field_contact.h"
#include "scarp/scene/voxel/placed_voxels.h"
#include "scarp/scene/voxel/voxel_shading.h"

namespace scarp {

struct MarchTrace;   // base/march_trace.h
class VoxelObjects;  // voxel_objects.h

/// The surface at a hit, in the field's space.
struct FieldSurface {
  dvec3 normal{0.0};                    ///< unit, outward; zero for a ray that started inside
  dvec3 shading_normal{0.0};            ///< unit
  std::optional<VoxelColour> colour{};  ///< if the field has its own colours
  int material = 0;       ///< material of the cell or of the part of a shape, plus 1; 0: that of the object
  double openness = 1;    ///< fraction of the sky that the field itself leaves open
  VoxelMaterial light{};  ///< what the surface emits and mirrors
  bool wall = false;      ///< whether a wall of solid ground or of a plinth was hit
  /// z of the surface, if known more precisely than z of the point on the ray: a sea at 0 is exactly at 0.
  std::optional<double> height{};
};

/// The contents of a field, for back ends (scene_back_end.h). Fields without back-end support have no parts.
struct SceneFieldParts {
  template <class Field, class Entry>
  struct Marched {
    const Field* field;
    const Entry* march;
    const MarchSettings* settings;
    double seam = 0;  ///< for height fields: as HeightTarget::seam
  };
  using Heights = Marched<HeightField, HeightMarchEntry>;
  using Function = Marched<HeightFunction, FunctionMarchEntry>;
  using Shape = Marched<DistanceField, ShapeMarchEntry>;

  struct Voxels {
    const VoxelObjects* objects;
    /// Start of a shadow ray from a voxel; null: next to that voxel.
    std::function<Ray(const Ray& ray, const Hit& from)> shadow_ray;
  };

  std::variant<std::monostate, Heights, Function, Shape, Voxels> of{};  ///< monostate: none of these
};

/// Immutable and thread-safe. Rays start as Ray::start states unless `from` is given: then they start on the surface of
/// that hit on this field. In batches `from` is empty or as long as `rays`, and rays whose entry is null start free.
class SceneField {
 public:
  virtual ~SceneField() = default;

  virtual std::string_view kind() const = 0;                    ///< "heights", "function", "shape", "voxels", "mesh"
  virtual std::string_view march() const = 0;                   ///< its name
  virtual Sampling sampling() const { return Sampling::none; }  ///< how the march samples
  /// Returns why the march, with its settings, guarantees less than MarchEntry states; empty if it guarantees as much.
  virtual std::string caveat() const { return {}; }
  /// Bounding box of everything that rays can hit; empty if there is nothing, nullopt for an unbounded field.
  virtual std::optional<WorldBox> box() const = 0;
  /// Bounding box of everything that a picture should show; nullopt for an unbounded field. Walls of solid ground are
  /// unbounded, but the ground is not.
  virtual std::optional<WorldBox> extent() const { return box(); }
  /// The largest coordinate in the field where its objects may meet those of other fields, for voxels; 0 for others.
  /// Scenes derive Ray::room from it.
  virtual double farthest_voxel() const { return 0; }
  /// Whether the field is only visible: it casts no shadow and is not ground.
  virtual bool is_backdrop() const { return false; }
  /// Whether any of its surfaces may mirror.
  virtual bool mirrors() const { return false; }
  /// Returns the height of the ground at (x, y); nullopt outside the ground, over its holes, and for fields that are
  /// not ground.
  virtual std::optional<double> height(double x, double y) const;

  /// Returns the closest hit. Overwrites `stats` unless null.
  virtual Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const = 0;
  /// Whether closest_hit() would return a hit. Exceptions: functions with other octaves for shadows use that surface,
  /// and rays from voxels with smooth normals start above their steps.
  virtual bool occluded(const Ray& ray, const Hit* from) const = 0;
  /// The closest hit that counts. The filter is called for hits as closest_hit() returns them. Fields other than height
  /// fields and tiles have one side. By default throws Error if the filter rejects a hit: not every march can continue.
  virtual Hit accepted_hit(const Ray& ray, const Hit* from, const HitRules& rules, MarchStats* stats) const;
  virtual FieldSurface surface(const Ray& ray, const Hit& hit) const = 0;
  /// Prefetches the memory that surface() reads.
  virtual void prefetch_surface(const Hit&) const {}
  /// FieldSurface::material.
  virtual int material(const Ray& ray, const Hit& hit) const { return surface(ray, hit).material; }

  /// Returns why the march records nothing; empty if it records its steps.
  virtual std::string no_trace() const;
  /// Returns closest_hit(ray, nullptr, stats); `trace` receives the steps of the march, none for rays that MarchTrace
  /// names. Throws Error if no_trace() returns a reason.
  virtual Hit traced_hit(const Ray& ray, MarchStats* stats, MarchTrace& trace) const;

  /// Returns why the field has no contacts, overlaps and closest points; empty if it has.
  virtual std::string no_contacts() const;
  /// The first contact of a moving capsule with the surface, in the field's space; the overlap of a box with it; and
  /// its closest point. Throw Error if no_contacts() returns a reason.
  virtual std::optional<FieldContact> sweep(const Capsule& capsule, const dvec3& motion) const;
  virtual bool overlaps(const TurnedBox& box) const;
  virtual std::optional<FieldPoint> closest_point(const dvec3& p, double max_distance) const;

  /// Returns the surface for a point below the ground, in the shape or in a solid voxel, surface included, with the
  /// normal of the surface above or nearest. Returns nullopt outside, beyond the edge of the ground, and in its holes.
  virtual std::optional<FieldSurface> within(const dvec3& p) const = 0;

  /// Returns the side of the smallest cell or voxel, in metres; 0 for fields without cells or voxels.
  virtual double cell_side() const { return 0; }
  /// Number of samples, solid voxels or triangles that the field stores; 0 for formulas.
  virtual std::int64_t elements() const { return 0; }
  /// Returns a version of the field with voxels 2^level times as large; null: the field itself.
  virtual std::shared_ptr<const SceneField> coarser(int) const { return nullptr; }
  /// Returns the same field with the march that judges others: it loses no hit. Null if it already uses it.
  virtual std::shared_ptr<const SceneField> judge() const { return nullptr; }

  /// Number of edits of the samples or voxels of the field so far; nullopt for fields that cannot be edited.
  virtual std::optional<std::uint64_t> edits() const { return {}; }
  /// Whether the field was edited after it was built, so that results may be wrong.
  virtual bool outdated() const { return false; }
  /// Returns the field rebuilt over its current samples or voxels. Null for fields that cannot be edited.
  virtual std::shared_ptr<const SceneField> rebuilt() const { return nullptr; }
  /// Owner of caller-owned samples; null if the field has none or it is unknown.
  virtual const std::weak_ptr<const void>* memory() const { return nullptr; }

  virtual SceneFieldParts parts() const { return {}; }
  /// Returns the ray for the march: on the surface of `from`, or free if that is null.
  virtual Ray started(const Ray& ray, const Hit* from) const;

  /// Memory use of voxel models and their accelerators. 0: not counted.
  virtual std::size_t bytes() const { return 0; }

  /// Returns the target of fans (march/height/max_mip_fan.h); nullopt unless the march on the CPU is `max-mip`.
  virtual std::optional<HeightTarget> fan_target() const { return {}; }

  /// Whether batches are faster than single rays.
  virtual bool likes_batches() const { return false; }
  /// The same results for many rays, on the calling thread.
  virtual void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from) const;
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                        std::span<const Hit* const> from) const;
  /// The same on all threads. Sets `steps`, unless empty, to the cost of each ray.
  virtual void closest_hits_on_all_threads(std::span<const Ray> rays, std::span<Hit> hits,
                                           std::span<std::uint32_t> steps, std::span<const Hit* const> from) const;
  virtual void occluded_on_all_threads(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                                       std::span<const Hit* const> from) const;
};

using SceneFieldPtr = std::shared_ptr<const SceneField>;

/// Materials of the cells of a height field, cell_cols() * cell_rows(), rows from north to south.
using CellMaterials = std::shared_ptr<const std::vector<std::uint8_t>>;

/// The field's height field; null for all other kinds.
const HeightField* height_field_of(const SceneField& field);

/// Selects what traces the rays of a field.
enum class AnsweredBy : std::uint8_t {
  cpu,
  back_end,  ///< nothing is built for the CPU, and queries of the field itself throw Error
};

/// `march` is a row of height_marches(). Builds what the march needs. Rays over a wrapped field need a finite t_max.
/// Throws Error for a setting out of range.
SceneFieldPtr scene_heights(HeightField field, const HeightMarchEntry& march = find_height_march("max-mip"),
                            const MarchSettings& settings = {}, AnsweredBy answered_by = AnsweredBy::cpu);
/// The same with the march `max-mip` and an existing pyramid of the field; both are shared. `materials` as in
/// require_materials(); null: the object's material.
SceneFieldPtr scene_heights(HeightField field, MaxPyramid pyramid, CellMaterials materials = nullptr);

/// Throws Error unless there is one material for each cell or the pointer is null.
void require_materials(const HeightField& field, const CellMaterials& materials);

/// `march` is a row of function_marches(). Throws Error for a setting out of its range.
SceneFieldPtr scene_function(HeightFunction function,
                             const FunctionMarchEntry& march = find_function_march("lipschitz-local"),
                             const MarchSettings& settings = {});

/// `march` is a row of shape_marches(). Throws Error for a setting out of its range.
SceneFieldPtr scene_shape(DistanceField shape, const ShapeMarchEntry& march = find_shape_march("sphere-trace"),
                          const MarchSettings& settings = {});

/// Placed models as one field; each model has its own march. With VoxelNormals::smooth, occluded() moves a ray that
/// starts on a voxel along the smooth normal, by sqrt(3) voxels, so that a smooth-looking surface is not shadowed by
/// its own steps. Throws Error naming the place if its model does not exist or its matrix is not a rotation with a
/// scale. Also throws for a model that is null, and a rounding or shading out of range.
SceneFieldPtr scene_voxels(PlacedVoxels voxels, const VoxelShading& shading = {});

}  // namespace scarp
