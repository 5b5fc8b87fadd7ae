// SPDX-License-Identifier: MIT
// A scene combines terrain, functions, shapes, voxels and meshes under placements, and answers closest-hit and any-hit
// queries over all of them.
//
//   ray ──▶ unbounded ground, and the largest batch-friendly fields    each by its own march;
//       ──▶ hierarchy of boxes over all other objects (box_tree.h)     the nearest hit wins
//
// Each object is traced in its own space; t is always in units of the length of the world-space direction. If several
// objects are hit at the same t, the one with the lowest index counts. A ray that starts on the surface of an object is
// RayStart::on_surface for that object and RayStart::free for all others. Origins are not offset, except those of
// shadow rays of voxels with smooth normals.
//
// In a scene of one field at the origin, queries go directly to that field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scarp/base/edit_count.h"
#include "scarp/scene/placement.h"
#include "scarp/scene/scene_field.h"

namespace scarp {

class SceneBackEnd;    // scene_back_end.h
struct DeviceTerrain;  // scene_vk.h

/// A field with its placement and material.
struct SceneObject {
  std::uint32_t field = 0;     ///< index into Scene::fields()
  std::uint32_t material = 0;  ///< returned in SceneSurface; index into PictureSettings::materials
  Placement placement{};
  std::uint32_t mask = 1;  ///< not 0; queries with a mask (Scene::query()) see the object if both share a bit
};

/// Selects the objects and hits that count in a query.
struct SceneRules {
  std::uint32_t mask = ~std::uint32_t{0};  ///< objects count whose mask shares a bit with it
  Sides sides = Sides::above;  ///< sides hit of height fields and tiles; all other objects are hit from outside
  /// Returns whether a hit counts; the ray continues behind hits that do not. Called with the ray of the query for some
  /// or all hits along it, not always in order of t; in batches from many threads at once. Null: all hits count.
  std::function<bool(const Ray&, const Hit&)> accept{};
};

class SceneQuery;

/// The surface at a hit, in world space.
struct SceneSurface {
  dvec3 position{0.0};
  dvec3 normal{0.0};          ///< unit, outward; zero for a ray that started inside a voxel
  dvec3 shading_normal{0.0};  ///< unit, outward, smooth; zero if `normal` is
  std::uint32_t object = 0;
  std::uint32_t material = 0;         ///< SceneObject::material, or the material of the cell or part that was hit
  dvec3 place{0.0};                   ///< position in the object's own space
  std::optional<VoxelColour> colour;  ///< nullopt if the field has no colours
  double openness = 1;                ///< fraction of the sky that the object itself leaves open, 0..1
  VoxelMaterial light{};              ///< what it emits and mirrors
  bool wall = false;                  ///< whether a wall of solid ground or of a plinth was hit
  std::optional<double> height;       ///< z of the surface, if known more precisely than by `position`
};

/// Resolution of a picture, for Scene::coarser().
struct SceneDetail {
  dvec3 eye{0.0}, forward{0, 0, -1};
  std::function<double(double)> sample;  ///< metres between two samples of the picture, at a depth along `forward` in
                                         ///< metres
};

/// Objects with closest-hit and any-hit queries over all of them. Immutable. Thread-safe, except with a back end.
///
/// After an edit of a field (HeightField::set_samples(), VoxelModel::edit(), ...), all ray queries throw Error until
/// the scene is built again: its bounding boxes are out of date. They also throw after the memory of a field was freed,
/// if the field knows its owner (HeightField::view()). LiveScene (live_scene.h) supports edits, also during queries.
///
/// Ray::start states how a ray starts: `free`, or `on_surface` of the object Ray::start_object. `from` overrides it:
/// the ray starts on the surface of that hit of this scene. In batches `from` is empty or as long as `rays`; rays whose
/// entry is null start free. Rays that start on voxels require `from`.
class Scene {
 public:
  /// Throws Error if a field is null, or was edited after it was built (SceneField::outdated()). Throws Error naming
  /// the object if its field does not exist or its placement is not a rotation with a finite origin and a scale above
  /// 0.
  Scene(std::vector<SceneFieldPtr> fields, std::vector<SceneObject> objects);
  /// A scene of one field at the origin. Implicit conversion.
  Scene(SceneFieldPtr field);

  /// Returns the same scene with queries answered by a back end, such as a device (scene_vk.h). Not thread-safe. A
  /// query of a single ray takes as long as one of thousands.
  Scene answered_by(std::shared_ptr<SceneBackEnd> back_end) const;
  bool on_device() const { return back_end_ != nullptr; }
  /// Returns the height field on its device if the scene is a single height field, at the origin, on a device; null for
  /// all other scenes. A plinth does not count.
  const DeviceTerrain* device_terrain() const;

  /// Returns the closest hit; `miss` for a ray that cast() would reject. Without a hit, the status is `exhausted` if a
  /// march reached its limit, else `below` if the ray starts below the ground of an object and never emerges, else
  /// `miss`. Objects whose bounding boxes the ray misses are not queried, so a ray that starts below bounded ground may
  /// also return `miss`; within() tests whether a point is below ground. If a march reaches its limit, hits on other
  /// objects are still found. Overwrites `stats` if not null; back ends set only its steps.
  Hit closest_hit(const Ray& ray, const Hit* from = nullptr, MarchStats* stats = nullptr) const;
  /// Returns whether anything blocks the ray: true if closest_hit() returns a hit, with three exceptions. Plinths block
  /// nothing. Terrain functions may have a different number of octaves for shadows (Octaves in field/function_node.h).
  /// Rays from a hit on voxels with smooth normals (VoxelNormals::smooth) start above the steps of these voxels
  /// (scene_voxels()).
  bool occluded(const Ray& ray, const Hit* from = nullptr) const;

  /// Sets hits[i] to closest_hit(rays[i], from[i]), bit for bit except on devices. Sets steps[i] to its number of steps
  /// unless `steps` is empty. Uses all threads. Throws Error if spans differ in length.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps = {},
                    std::span<const Hit* const> from = {}) const;
  /// Returns the target of fans of camera rays, if only_heights() is not null; nullopt if fans do not apply.
  std::optional<HeightTarget> fan_target() const;
  /// Returns the same hits for free rays with t_min = 0 that a fan over fan_target() has searched for.
  void closest_hits(std::span<const Ray> rays, std::span<const FanSight> sights, std::span<Hit> hits) const;
  /// Sets blocked[i] to 1 if occluded(rays[i], from[i]), else to 0. Threads and errors as for closest_hits().
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from = {}) const;

  /// Returns queries restricted by rules: mask, sides, filter. See scene_query.h.
  SceneQuery query(SceneRules rules) const&;
  SceneQuery query(SceneRules rules) && = delete;  ///< the query refers to the scene

  /// Returns the surface at a hit of this ray: position, normals, material, colour.
  SceneSurface surface(const Ray& ray, const Hit& hit) const;
  /// Prefetches the memory that surface() reads for this hit.
  void prefetch_surface(const Hit& hit) const { field_of(hit.object).prefetch_surface(hit); }

  /// Returns only SceneSurface::material of a hit.
  std::uint32_t material(const Ray& ray, const Hit& hit) const;

  /// Returns the surface of the first object that contains a point; see SceneField::within().
  std::optional<SceneSurface> within(const dvec3& p) const;
  /// Returns z of the highest ground at (x, y), in metres, over all height fields and functions that are not tilted;
  /// nullopt if there is none.
  std::optional<double> height(double x, double y) const;

  /// Returns the same objects with voxels merged 2 x 2 x 2, repeatedly, as long as they are no larger than the distance
  /// between two samples of the picture at the smallest depth of their object. The result has no back end.
  Scene coarser(const SceneDetail& detail) const;

  const std::vector<SceneFieldPtr>& fields() const { return fields_; }
  const std::vector<SceneObject>& objects() const { return objects_; }
  /// Returns the field of a scene of one field at the origin; null for all other scenes.
  const SceneField* only_field() const { return alone_ ? fields_[objects_[0].field].get() : nullptr; }
  const SceneField& field_of(std::uint32_t object) const { return *fields_[objects_[object].field]; }
  /// Returns the height field if it is the only object, at the origin, with or without its plinth; null for all other
  /// scenes.
  const HeightField* only_heights() const { return sole_ && terrain_ ? terrain_ : nullptr; }
  /// Returns the height field at the origin if the scene has exactly one, else null. The scene may have other objects.
  const HeightField* terrain() const { return terrain_; }
  /// Returns the index of the object of terrain(). Undefined if that is null.
  std::uint32_t terrain_object() const { return terrain_object_; }
  /// Returns the side of the smallest cell or voxel of all objects, in metres; 0 if none has cells or voxels.
  double cell_side() const;
  /// Returns the same objects with marches that judge others (SceneField::judge()). The result has no back end.
  Scene judge() const;
  /// Returns the names of all marches, each once, separated by ", ".
  std::string marches() const;
  /// Returns how the marches sample; `none` if one of them does not sample or samples differently.
  Sampling sampling() const;
  /// Returns the distinct SceneField::caveat() messages of its fields.
  std::vector<std::string> caveats() const;

  /// Box around all bounded objects (SceneField::extent()); empty if there is none.
  const WorldBox& box() const { return box_; }
  /// Whether an object is unbounded.
  bool endless() const { return endless_; }
  /// Whether a height field wraps: rays then need a finite t_max.
  bool wraps() const { return wraps_; }
  /// Memory use in bytes of the objects and the hierarchy over them, without the fields.
  std::size_t bytes() const;

 private:
  using From = std::span<const Hit* const>;

  friend class LiveScene;
  friend class SceneQuery;

  void watch_field(std::uint32_t index);
  void unwatch_field(std::uint32_t index);
  void require_current() const;
  void compare_edits(std::uint64_t edits) const;
  void require_memory() const;
  void find_special();
  void find_room(std::uint32_t object);
  void find_sole();
  void find_terrain();
  SceneSurface placed_surface(std::uint32_t object, const FieldSurface& own, const dvec3& p,
                              const dvec3& in_field) const;

  // A ray with its start; see scene_answers.h.
  struct StartedRay;
  void make_local(const StartedRay& started, std::uint32_t object, const Hit& best, Ray& local) const;
  Ray local(const StartedRay& started, std::uint32_t object, const Hit& best) const;
  // trace() and trace_tree() replace `best` if they find a better hit.
  void trace(const StartedRay& ray, std::uint32_t object, Hit& best, MarchStats* stats) const;
  void take_hit(const Hit& hit, std::uint32_t object, Hit& best) const;
  void trace_tree(const StartedRay& ray, Hit& best, MarchStats* stats) const;
  bool blocks(const StartedRay& ray, std::uint32_t object) const;
  bool tree_blocks(const StartedRay& ray) const;
  Hit closest(const StartedRay& ray, MarchStats* stats) const;
  Hit accepted_hit(const StartedRay& ray, std::uint32_t object, const Ray& own, MarchStats* stats) const;
  bool any(const StartedRay& ray) const;
  void closest_of_piece(std::span<const Ray> rays, From from, std::span<Hit> hits, const SceneRules* rules = nullptr,
                        std::span<const FanSight> sights = {}) const;
  void occluded_of_piece(std::span<const Ray> rays, From from, std::span<std::uint8_t> blocked,
                         const SceneRules* rules = nullptr) const;

  // One ray to trace against one object, for back ends.
  struct Pair {
    std::uint32_t object;
    std::uint32_t ray;
  };
  void trace_closest(std::span<const Ray> rays, From from, std::span<const Pair> pairs, std::span<Hit> hits,
                     std::span<std::uint32_t> steps) const;
  void trace_occluded(std::span<const Ray> rays, From from, std::span<const Pair> pairs,
                      std::span<std::uint8_t> blocked) const;
  std::vector<Pair> pairs_in_tree(std::span<const Ray> rays, std::span<const Hit> hits) const;
  template <class Query>
  void by_field(std::vector<Pair>& pairs, const Query& query) const;
  void closest_by_back_end(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                           From from) const;
  void occluded_by_back_end(std::span<const Ray> rays, std::span<std::uint8_t> blocked, From from) const;

  std::vector<SceneFieldPtr> fields_;
  std::shared_ptr<SceneBackEnd> back_end_;  // null: the fields' own marches
  std::vector<SceneObject> objects_;
  std::vector<std::uint8_t> in_place_;      // per object: 1 if its placement is the identity
  std::vector<std::uint8_t> frames_;        // per object: Ray::frame of rays in its space
  std::vector<std::uint16_t> rooms_;        // per object: Ray::room of rays in its space
  double room_ = 0;                         // room_of_voxels(); 0 if fewer than two meet and none is placed
  std::vector<std::uint32_t> beside_tree_;  // objects that every ray is traced against, before the tree
  BoxTree tree_;                            // the other objects that are not empty
  WorldBox box_;
  bool endless_ = false, wraps_ = false;
  // z at which walls of solid ground end: the base of the plinth.
  double walls_end_ = -std::numeric_limits<double>::infinity();
  bool alone_ = false;  // a single object with the identity as placement: nothing to transform or compare
  bool sole_ = false;   // the same, not counting backdrops, which are visible but block no rays
  std::uint32_t sole_object_ = 0, terrain_object_ = 0;
  const HeightField* terrain_ = nullptr;

  // Editable fields with their number of edits when the scene was built; fields whose memory has an owner; fields
  // without contacts.
  struct Editable {
    std::uint32_t field;
    std::uint64_t edits;
  };
  std::vector<Editable> editable_;
  std::vector<std::uint32_t> with_owner_;
  std::vector<std::uint32_t> without_contacts_;
  mutable EditsSeen seen_;
};

/// Throws Error if a ray is not valid (validate() in march/height/queries.h), if its t_max is infinite and a field
/// wraps, or if it starts on an object or cell that does not exist.
void validate(const Ray& ray, const Scene& scene);

}  // namespace scarp
