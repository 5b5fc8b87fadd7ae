// SPDX-License-Identifier: MIT
// A scene combines terrain, functions, shapes, voxels and meshes, each in any number of places, and answers closest-hit
// and any-hit queries over all of them.
//
//   ray ──▶ ground without an end, and the largest batch-friendly fields    each by its own march;
//       ──▶ hierarchy of boxes over all other objects (box_tree.h)          the nearest hit wins
//
// Rays are answered in the space of each object; t counts in the length of the world's direction throughout. Of hits at
// the same t that of the first object counts. A ray from a surface begins there by the rule of its object, and free for
// all others: no ray is pushed off, except the shadow rays of voxels with smooth normals.
//
// A scene of one field at the origin is that field: it takes the rays that the field takes, and batches go straight to
// the field's own.
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

#include "scarp/scene/placement.h"
#include "scarp/scene/scene_back_end.h"
#include "scarp/scene/scene_field.h"

namespace scarp {

struct SceneObject {
  std::uint32_t field = 0;     ///< index of the scene's fields
  std::uint32_t material = 0;  ///< whatever the caller counts by it
  Placement placement{};
};

/// What is at a hit, in world space.
struct SceneSurface {
  dvec3 position{0.0};
  dvec3 normal{0.0};          ///< unit, outward; zero for a ray that began inside a voxel
  dvec3 shading_normal{0.0};  ///< unit, likewise
  std::uint32_t object = 0;
  std::uint32_t material = 0;         ///< the object's, or that of a shape's part less 1
  dvec3 place{0.0};                   ///< the position in the object's own space
  std::optional<VoxelColour> colour;  ///< where the field has colours of its own
  double openness = 1;                ///< share of the sky that is open, as far as the object knows by itself
  bool wall = false;                  ///< whether a wall of solid ground or of a plinth was hit
  std::optional<double> height;       ///< z of the surface, where known to more digits than by `position`
};

/// How fine details must be to be seen, for Scene::coarser().
struct SceneDetail {
  dvec3 eye{0.0}, forward{0, 0, -1};
  std::function<double(double)> sample;  ///< metres from one of a picture's samples to the next, at a depth along
                                         ///< `forward` in metres
};

/// Immutable. May be queried from many threads at once, except with a back end.
///
/// Rays begin by Ray::start, on the surface of Ray::start_object where that says so, unless `from` is given: then they
/// begin on the surface of that hit of this scene, and Ray::start does not count. In batches `from` is empty or as long
/// as `rays`, and rays whose entry is null begin free. Rays from voxels need `from`.
class Scene {
 public:
  /// Throws Error naming the object: a field that does not exist, a placement that is not a rotation with a scale above
  /// 0; or a field that is null.
  Scene(std::vector<SceneFieldPtr> fields, std::vector<SceneObject> objects);
  /// The field alone, at the origin. Implicit: one field is a scene.
  Scene(SceneFieldPtr field);

  /// The same scene, whose rays a back end answers: a device, see scene_vk.h. Used by one thread at a time; single rays
  /// take as long as thousands.
  Scene answered_by(std::shared_ptr<SceneBackEnd> back_end) const;
  bool on_device() const { return back_end_ != nullptr; }
  /// What a device holds of the one height field of this scene; null for all other scenes.
  const DeviceTerrain* device_terrain() const;

  /// The nearest hit. Without one: exhausted when a march gave up, else below when an object that was asked says so:
  /// the ray began below its ground and met nothing. Objects whose boxes the ray does not meet need not be asked, so a
  /// ray below ground that has an end may also be a miss; within() finds where a point is. A march that gives up hides
  /// no hit behind. `stats`, when given, is overwritten; a back end sets its steps alone.
  Hit closest_hit(const Ray& ray, const Hit* from = nullptr, MarchStats* stats = nullptr) const;
  /// Whether closest_hit() would return a hit on the surfaces that throw shadows. These are those that are seen, with
  /// two exceptions, where the two answers may differ: terrain functions whose octaves for shadows differ from those of
  /// the march (Octaves of field/function_node.h), and voxels with smooth normals (VoxelNormals::smooth) where `from`
  /// is one of theirs: the ray begins above their steps then (scene_voxels()).
  bool occluded(const Ray& ray, const Hit* from = nullptr) const;

  /// hits[i] is closest_hit(rays[i], from[i]), bit for bit (on a device as it finds it); steps[i], when asked for, is
  /// what that cost. On all threads. Throws Error when spans differ in length.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps = {},
                    std::span<const Hit* const> from = {}) const;
  /// blocked[i] is 1 where occluded(rays[i], from[i]) is true, else 0.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from = {}) const;

  /// Position and normals of a hit of this ray.
  SceneSurface surface(const Ray& ray, const Hit& hit) const;

  /// The surface at a point inside an object, of the first object that contains it; see SceneField::within().
  std::optional<SceneSurface> within(const dvec3& p) const;
  /// World z of the highest ground at (x, y): of heights and functions that are not tilted.
  std::optional<double> height(double x, double y) const;

  /// The same objects; voxels that are closer together than the picture's samples, wherever their object is seen, are
  /// merged 2 x 2 x 2, as often as they stay no larger than that. On the CPU.
  Scene coarser(const SceneDetail& detail) const;

  const std::vector<SceneFieldPtr>& fields() const { return fields_; }
  const std::vector<SceneObject>& objects() const { return objects_; }
  /// The field of a scene of one field at the origin; null for all other scenes.
  const SceneField* only_field() const { return alone_ ? fields_[objects_[0].field].get() : nullptr; }
  const SceneField& field_of(std::uint32_t object) const { return *fields_[objects_[object].field]; }
  /// The height field of a scene of one at the origin, with or without its plinth; null for all other scenes. For what
  /// only works on a height field alone.
  const HeightField* only_heights() const { return sole_ && terrain_ ? terrain_ : nullptr; }
  /// The one height field at the origin, whatever else is in the scene; null if there is none, or several.
  const HeightField* terrain() const { return terrain_; }
  /// The object that it is, if it is not null.
  std::uint32_t terrain_object() const { return terrain_object_; }
  /// The side of the smallest cell or voxel of all objects, in metres; 0 if none has any.
  double cell_side() const;
  /// The same objects, with the marches that judge others. On the CPU.
  Scene judge() const;
  /// Names of the marches of all objects, each once, with ", " between.
  std::string marches() const;

  /// Around all objects that do not go on forever (SceneField::extent()); empty when there is none.
  const WorldBox& box() const { return box_; }
  /// Whether an object goes on forever.
  bool endless() const { return endless_; }
  /// Whether a height field wraps round: rays need a finite t_max.
  bool wraps() const { return wraps_; }
  /// Of the objects and the hierarchy over them, without the fields.
  std::size_t bytes() const;

 private:
  using From = std::span<const Hit* const>;

  void find_sole();
  void find_terrain();
  SceneSurface placed_surface(std::uint32_t object, const FieldSurface& own, const dvec3& p,
                              const dvec3& in_field) const;

  // Queries of rays that know how they begin; see scene_answers.h.
  struct Asking;
  void make_local(const Asking& asking, std::uint32_t object, const Hit& best, Ray& local) const;
  Ray local(const Asking& asking, std::uint32_t object, const Hit& best) const;
  void ask(const Asking& ray, std::uint32_t object, Hit& best, MarchStats* stats) const;
  void take_hit(const Hit& hit, std::uint32_t object, Hit& best) const;
  void ask_tree(const Asking& ray, Hit& best, MarchStats* stats) const;
  bool blocks(const Asking& ray, std::uint32_t object) const;
  bool tree_blocks(const Asking& ray) const;
  Hit closest(const Asking& ray, MarchStats* stats) const;
  void closest_of_piece(std::span<const Ray> rays, From from, std::span<Hit> hits) const;
  void occluded_of_piece(std::span<const Ray> rays, From from, std::span<std::uint8_t> blocked) const;

  // A query of one ray against one object, for back ends.
  struct Pair {
    std::uint32_t object;
    std::uint32_t ray;
  };
  void ask_closest(std::span<const Ray> rays, From from, std::span<const Pair> pairs, std::span<Hit> hits,
                   std::span<std::uint32_t> steps) const;
  void ask_occluded(std::span<const Ray> rays, From from, std::span<const Pair> pairs,
                    std::span<std::uint8_t> blocked) const;
  std::vector<Pair> pairs_in_tree(std::span<const Ray> rays, std::span<const Hit> hits) const;
  template <class Ask>
  void by_field(std::vector<Pair>& pairs, const Ask& ask) const;
  void closest_by_back_end(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                           From from) const;
  void occluded_by_back_end(std::span<const Ray> rays, std::span<std::uint8_t> blocked, From from) const;

  std::vector<SceneFieldPtr> fields_;
  std::shared_ptr<SceneBackEnd> back_end_;  // null: the fields' own marches
  std::vector<SceneObject> objects_;
  std::vector<std::uint8_t> in_place_;      // by object: 1 where its placement is the identity
  std::vector<std::uint32_t> beside_tree_;  // objects that every ray is asked against, before the tree
  std::vector<std::uint32_t> in_tree_;      // the others that can be met, in the order of the tree's numbers
  BoxTree tree_;
  WorldBox box_;
  bool endless_ = false, wraps_ = false;
  // The height at which walls of solid ground end: the base of the plinth.
  double walls_end_ = -std::numeric_limits<double>::infinity();
  bool alone_ = false;  // one object, where its field stands: nothing is transformed, nothing compared
  bool sole_ = false;   // the same, but for backdrops: they are seen, but rays are not blocked by them
  std::uint32_t sole_object_ = 0, terrain_object_ = 0;
  const HeightField* terrain_ = nullptr;
};

/// Throws Error, in one line, when a ray cannot be followed through the scene, as validate() of march/height/queries.h
/// does for a height field: also for an infinite t_max where a field wraps round, a start on an object that does not
/// exist, or in a cell that does not.
void validate(const Ray& ray, const Scene& scene);

}  // namespace scarp
