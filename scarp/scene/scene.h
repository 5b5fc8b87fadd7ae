// SPDX-License-Identifier: MIT
// A scene combines terrain, functions, shapes, voxels and meshes, each in any number of places, and answers closest-hit
// and any-hit queries over all of them.
//
//   ray ──▶ unbounded ground, and the largest batch-friendly fields    each by its own march;
//       ──▶ hierarchy of boxes over all other objects (box_tree.h)     the nearest hit wins
//
// Each object is traced in its own space; t always counts in lengths of the world-space direction. If several objects
// are hit at the same t, the first one counts. A ray that starts on a surface does so by the rule of that object, and
// is free for all others. Origins are not offset, except those of shadow rays of voxels with smooth normals.
//
// A scene of one field at the origin is that field: rays and batches go straight to it.
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

/// A field in one place.
struct SceneObject {
  std::uint32_t field = 0;     ///< index into Scene::fields()
  std::uint32_t material = 0;  ///< returned in SceneSurface; pictures use it as an index into their materials
  Placement placement{};
};

/// The surface at a hit, in world space.
struct SceneSurface {
  dvec3 position{0.0};
  dvec3 normal{0.0};          ///< unit, outward; zero for a ray that started inside a voxel
  dvec3 shading_normal{0.0};  ///< unit, outward, smooth; zero as `normal`
  std::uint32_t object = 0;
  std::uint32_t material = 0;         ///< of the object, or of the part of a shape, less 1
  dvec3 place{0.0};                   ///< position in the object's own space
  std::optional<VoxelColour> colour;  ///< of fields with their own colours
  double openness = 1;                ///< fraction of the sky that the object itself leaves open, 0..1
  bool wall = false;                  ///< whether a wall of solid ground or of a plinth was hit
  std::optional<double> height;       ///< z of the surface, if known more precisely than by `position`
};

/// Resolution of a picture, for Scene::coarser().
struct SceneDetail {
  dvec3 eye{0.0}, forward{0, 0, -1};
  std::function<double(double)> sample;  ///< metres between two samples of the picture, at a depth along `forward` in
                                         ///< metres
};

/// Objects with closest-hit and any-hit queries over all of them. Immutable. May be queried from many threads at once,
/// except with a back end.
///
/// Rays start as Ray::start states, on the surface of Ray::start_object if it is `on_surface`. `from` overrides it: the
/// ray starts on the surface of that hit of this scene. In batches `from` is empty or as long as `rays`; rays whose
/// entry is null start free. Rays that start on voxels need `from`.
class Scene {
 public:
  /// Throws Error for a field that is null, and, naming the object, for a field that does not exist or a placement that
  /// is not a rotation with a scale above 0.
  Scene(std::vector<SceneFieldPtr> fields, std::vector<SceneObject> objects);
  /// The field alone, at the origin. Implicit: one field is a scene.
  Scene(SceneFieldPtr field);

  /// Returns the same scene with a back end that answers the rays, such as a device (scene_vk.h). For one thread at a
  /// time; a single ray takes as long as thousands.
  Scene answered_by(std::shared_ptr<SceneBackEnd> back_end) const;
  bool on_device() const { return back_end_ != nullptr; }
  /// Returns the one height field of this scene on its device; null for all other scenes.
  const DeviceTerrain* device_terrain() const;

  /// Returns the nearest hit. Without one, the status is `exhausted` if a march reached its limit, or `below` if the
  /// ray started below the ground of an object and never emerged, or else `miss`. Objects whose boxes the ray misses
  /// are not queried, so a ray that starts below bounded ground may also return `miss`; within() finds where a point
  /// is. A march that reaches its limit does not hide hits on other objects. Overwrites `stats` if given; back ends set
  /// only its steps.
  Hit closest_hit(const Ray& ray, const Hit* from = nullptr, MarchStats* stats = nullptr) const;
  /// Returns whether anything blocks the ray: true where closest_hit() returns a hit, with three exceptions. Plinths
  /// block nothing, terrain functions may have other octaves for shadows (Octaves of field/function_node.h), and rays
  /// from a hit on voxels with smooth normals (VoxelNormals::smooth) start above the steps of these voxels
  /// (scene_voxels()).
  bool occluded(const Ray& ray, const Hit* from = nullptr) const;

  /// Sets hits[i] to closest_hit(rays[i], from[i]), bit for bit except on devices, and steps[i] to its steps unless
  /// `steps` is empty. On all threads. Throws Error if spans differ in length.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps = {},
                    std::span<const Hit* const> from = {}) const;
  /// Sets blocked[i] to 1 if occluded(rays[i], from[i]), else to 0. As closest_hits().
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from = {}) const;

  /// Returns the surface at a hit of this ray: position, normals, material, colour.
  SceneSurface surface(const Ray& ray, const Hit& hit) const;

  /// Returns the surface of the first object that contains a point; see SceneField::within().
  std::optional<SceneSurface> within(const dvec3& p) const;
  /// Returns z of the highest ground at (x, y), of height fields and functions that are not tilted; nullopt without
  /// any.
  std::optional<double> height(double x, double y) const;

  /// Returns the same objects with voxels merged 2 x 2 x 2, repeatedly, as long as they stay no larger than the
  /// distance between two samples of the picture wherever their object is visible. On the CPU.
  Scene coarser(const SceneDetail& detail) const;

  const std::vector<SceneFieldPtr>& fields() const { return fields_; }
  const std::vector<SceneObject>& objects() const { return objects_; }
  /// Returns the field of a scene of one field at the origin; null for all other scenes.
  const SceneField* only_field() const { return alone_ ? fields_[objects_[0].field].get() : nullptr; }
  const SceneField& field_of(std::uint32_t object) const { return *fields_[objects_[object].field]; }
  /// Returns the height field of a scene of one at the origin, with or without its plinth; null for all other scenes.
  const HeightField* only_heights() const { return sole_ && terrain_ ? terrain_ : nullptr; }
  /// Returns the one height field at the origin, whatever else is in the scene; null if there is none, or several.
  const HeightField* terrain() const { return terrain_; }
  /// Index of the object of terrain(), if that is not null.
  std::uint32_t terrain_object() const { return terrain_object_; }
  /// Side of the smallest cell or voxel of all objects, in metres; 0 if there is none.
  double cell_side() const;
  /// Returns the same objects with reference marches. On the CPU.
  Scene judge() const;
  /// Returns the names of all marches, each once, separated by ", ".
  std::string marches() const;

  /// Box around all bounded objects (SceneField::extent()); empty if there is none.
  const WorldBox& box() const { return box_; }
  /// Whether an object is unbounded.
  bool endless() const { return endless_; }
  /// Whether a height field wraps round: rays need a finite t_max.
  bool wraps() const { return wraps_; }
  /// Memory use in bytes of the objects and the hierarchy over them, without the fields.
  std::size_t bytes() const;

 private:
  using From = std::span<const Hit* const>;

  void find_sole();
  void find_terrain();
  SceneSurface placed_surface(std::uint32_t object, const FieldSurface& own, const dvec3& p,
                              const dvec3& in_field) const;

  // Queries of rays that know how they start; see scene_answers.h.
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
  std::vector<std::uint32_t> beside_tree_;  // objects that every ray is traced against, before the tree
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

/// Throws Error if a ray cannot be traced through the scene: as validate() of march/height/queries.h, and for an
/// infinite t_max if a field wraps round, or a start on an object or cell that does not exist.
void validate(const Ray& ray, const Scene& scene);

}  // namespace scarp
