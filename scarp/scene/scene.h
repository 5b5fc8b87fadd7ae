// SPDX-License-Identifier: MIT
// Many fields in one world: terrain, functions, shapes and voxels, each in as many places as one likes, and one call
// that tells the nearest that a ray meets.
//
//   ray ──▶ ground without an end, and the largest of what takes rays by the hundred  each by its own march;
//       ──▶ hierarchy of boxes over all other objects (box_tree.h)                   the nearest hit wins
//
// Rays are answered in the space of each object; t counts in the length of the world's direction throughout. Of hits at
// the same t that of the object that comes first counts. A ray that begins on the surface of a hit begins there by the
// rule of its object, and free for all others: no ray is pushed off, but the shadow rays of voxels with smooth normals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "scarp/scene/field_queries.h"
#include "scarp/scene/placement.h"
#include "scarp/scene/scene_field.h"

namespace scarp {

struct SceneObject {
  std::uint32_t field = 0;     ///< index of the scene's fields
  std::uint32_t material = 0;  ///< whatever the caller counts by it
  Placement placement{};
};

struct SceneHit {
  FieldHit field;            ///< t is that of the ray
  std::uint32_t object = 0;  ///< index of the objects

  double t() const { return field.t; }
  explicit operator bool() const { return static_cast<bool>(field); }
};

/// A ray in world space; its own `start` does not count, but `from` does.
struct SceneRay {
  Ray ray;
  const SceneHit* from = nullptr;  ///< a hit on whose surface it begins, or null: it begins free
};

/// What is at a hit, in world space.
struct SceneSurface {
  dvec3 position{0.0};
  dvec3 normal{0.0};          ///< unit, outward; zero for a ray that began inside of a voxel
  dvec3 shading_normal{0.0};  ///< unit, likewise
  std::uint32_t object = 0;
  std::uint32_t material = 0;         ///< the object's, or that of a shape's part less 1
  dvec3 place{0.0};                   ///< the position in the object's own space
  std::optional<VoxelColour> colour;  ///< where the field has colours of its own
  double openness = 1;                ///< share of the sky that is there, as far as the object tells by itself
};

/// How fine things have to be to be seen, for Scene::coarser().
struct SceneDetail {
  dvec3 eye{0.0}, forward{0, 0, -1};
  std::function<double(double)> sample;  ///< metres from one of a picture's samples to the next, at a depth along
                                         ///< `forward` in metres
};

/// What a ray cost.
struct SceneStats {
  std::uint32_t steps = 0;  ///< of all marches
  std::uint32_t boxes = 0;  ///< objects of the hierarchy that were asked
};

/// Immutable. Questions may be asked from many threads at once, unless others than the CPU answer.
class Scene {
 public:
  /// Throws Error naming the object: a field that is not there, a placement that is no turn with a scale above 0; or a
  /// field that is null.
  Scene(std::vector<SceneFieldPtr> fields, std::vector<SceneObject> objects);

  /// The same scene, whose batches are answered field by field: by a device, see scene_vk.h. Used by one thread at a
  /// time.
  Scene answered_by(std::shared_ptr<FieldQueries> queries) const;
  bool on_device() const { return queries_ != nullptr; }

  /// The nearest hit. Without one: exhausted when a march gave up, else below when an object that was asked says so:
  /// the ray began below its ground and met nothing. Objects whose boxes the ray does not meet need not be asked, so
  /// below a ground that ends it may also be told as a miss; within() tells where a point is. A march that gives up
  /// hides nothing that is hit behind. `stats`, when given, is overwritten.
  SceneHit closest_hit(const SceneRay& ray, SceneStats* stats = nullptr) const;
  /// Whether closest_hit() would tell a hit: of the surfaces that throw shadows. These are those that are seen, but for
  /// two kinds, of which the two answers may differ: terrain functions of which octaves for shadows are others than for
  /// the march (Octaves of field/function_node.h), and voxels with smooth normals (VoxelNormals::smooth) where `from`
  /// is one of theirs: the ray begins above their steps then (scene_voxels()).
  bool occluded(const SceneRay& ray) const;

  /// hits[i] is closest_hit(rays[i]), bit for bit (on a device as it finds it); steps[i], when asked for, is what that
  /// cost. On all threads. Throws Error when spans differ in length.
  void closest_hits(std::span<const SceneRay> rays, std::span<SceneHit> hits,
                    std::span<std::uint32_t> steps = {}) const;
  /// blocked[i] is 1 where occluded(rays[i]) is true, else 0.
  void occluded(std::span<const SceneRay> rays, std::span<std::uint8_t> blocked) const;

  SceneSurface surface(const Ray& ray, const SceneHit& hit) const;

  /// What is at a point inside of an object, of the first one that has it inside; see SceneField::within().
  std::optional<SceneSurface> within(const dvec3& p) const;

  /// The same objects; voxels that are closer than the picture's samples, wherever their object is seen, are made one
  /// of 2 x 2 x 2, as often as they stay no larger than that.
  Scene coarser(const SceneDetail& detail) const;

  const std::vector<SceneFieldPtr>& fields() const { return fields_; }
  const std::vector<SceneObject>& objects() const { return objects_; }
  /// Around all objects that have an end; empty when none has.
  const WorldBox& box() const { return box_; }
  /// Whether an object has no end.
  bool endless() const { return endless_; }
  /// Of the objects and the hierarchy over them, without the fields.
  std::size_t bytes() const;

 private:
  const SceneField& field_of(std::uint32_t object) const { return *fields_[objects_[object].field]; }
  static const FieldHit* start_on(std::uint32_t object, const SceneRay& ray) {
    return ray.from && ray.from->object == object ? &ray.from->field : nullptr;
  }
  void ask_tree(const SceneRay& ray, SceneHit& best, SceneStats* stats) const;
  bool tree_blocks(const SceneRay& ray) const;
  SceneSurface placed_surface(std::uint32_t object, const FieldSurface& own, const dvec3& p,
                              const dvec3& in_field) const;
  void closest_of_piece(std::span<const SceneRay> rays, std::span<SceneHit> hits) const;
  void occluded_of_piece(std::span<const SceneRay> rays, std::span<std::uint8_t> blocked) const;

  // Who asks for one ray against one object.
  struct Asked {
    std::uint32_t object;
    std::uint32_t ray;
  };
  void ask_closest(std::span<const SceneRay> rays, std::span<const Asked> asked, std::span<SceneHit> hits,
                   std::span<std::uint32_t> steps) const;
  void ask_occluded(std::span<const SceneRay> rays, std::span<const Asked> asked,
                    std::span<std::uint8_t> blocked) const;
  std::vector<Asked> asked_in_tree(std::span<const SceneRay> rays, std::span<const SceneHit> hits) const;
  template <class Ask>
  void by_field(std::vector<Asked>& asked, const Ask& ask) const;
  void closest_elsewhere(std::span<const SceneRay> rays, std::span<SceneHit> hits,
                         std::span<std::uint32_t> steps) const;
  void occluded_elsewhere(std::span<const SceneRay> rays, std::span<std::uint8_t> blocked) const;

  std::vector<SceneFieldPtr> fields_;
  std::shared_ptr<FieldQueries> queries_;  // null: the fields' own marches
  std::vector<SceneObject> objects_;
  std::vector<std::uint32_t> beside_tree_;  // objects that every ray is asked against, before the tree
  std::vector<std::uint32_t> in_tree_;      // the others that can be met, in the order of the tree's numbers
  BoxTree tree_;
  WorldBox box_;
  bool endless_ = false;
};

}  // namespace scarp
