// SPDX-License-Identifier: MIT
// Private to the station: the queries of a voxel field (scene_voxels()), whose objects are placed models.
//
// Rays are traced in the space of each model that they may hit, and quantised there (voxel_ray.h). t is in units of the
// direction's length throughout. Among hits at the same t, the lowest index counts.
//
// Batches traverse a separate hierarchy as beams of 64 rays, and each model's grid in vectors (voxel_packet.h);
// diverging rays are traced one by one. This is why the models are not objects of the scene, whose hierarchy contains
// only fields and queries them ray by ray.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scarp/march/hit_rules.h"
#include "scarp/march/ray_room.h"
#include "scarp/march/turned_box.h"
#include "scarp/scene/tree/box_tree.h"
#include "scarp/scene/tree/field_contact.h"
#include "scarp/scene/voxel/lattice_place.h"
#include "scarp/scene/voxel/placed_voxels.h"

namespace scarp {

/// Immutable and thread-safe.
class VoxelObjects {
 public:
  /// Throws Error naming the place if its model does not exist or its matrix is not a rotation with a scale. Also
  /// throws for a model that is null, and a rounding out of range.
  explicit VoxelObjects(PlacedVoxels voxels);

  /// The same with voxels merged 2 x 2 x 2, `level` times; see coarse_voxels.h.
  VoxelObjects coarser(int level) const;
  /// The same over the current models, after edits.
  VoxelObjects rebuilt() const;
  /// Number of edits of all models so far.
  std::uint64_t edits() const;
  /// The same with another march, a row of voxel_marches().
  VoxelObjects marched_by(std::string_view march) const;

  /// Treats the ray as free. Overwrites `stats` unless null. `part` of hits is the index of the place.
  Hit closest_hit(const Ray& ray, MarchStats* stats = nullptr) const { return closest_hit(ray, nullptr, stats); }
  /// The same for a ray that starts on the face of the hit `from`, unless null: a ray into the solid hits that voxel at
  /// t_min, a ray away from it does not hit it again.
  Hit closest_hit(const Ray& ray, const Hit* from, MarchStats* stats) const {
    return closest_hit(ray, from, nullptr, stats);
  }
  /// The same, restricted to voxels that the filter accepts; null: all count.
  Hit closest_hit(const Ray& ray, const Hit* from, const HitFilter* accept, MarchStats* stats) const {
    return follow(ray, from, accept, stats, nullptr);
  }
  /// closest_hit(ray, stats) without rounding; `trace` receives the steps in each grid. Their objects need not be in
  /// the order of t. Requires records().
  Hit traced_hit(const Ray& ray, MarchStats* stats, MarchTrace& trace) const;
  /// Whether the marches of all models record their steps.
  bool records() const;
  /// Whether anything blocks the ray.
  bool occluded(const Ray& ray) const { return occluded(ray, nullptr); }
  /// The same for a ray that starts on the face of the hit `from`, as closest_hit().
  bool occluded_from(const Hit& hit, const Ray& ray) const { return occluded(ray, &hit); }

  /// hits[i] is closest_hit(rays[i], from[i], nullptr), bit for bit, on the calling thread; without `from` all rays are
  /// free. Fast if neighbouring rays have similar directions, as those of 8 x 8 pixels do. Throws Error if spans differ
  /// in length.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<const Hit* const> from = {}) const;
  /// Sets blocked[i] to 1 if closest_hits() would return a hit, else to 0.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from = {}) const;

  /// Returns the outward unit normal in world space of the face or rounded edge that was hit; zero for a ray that
  /// started in the voxel.
  dvec3 normal(const Ray& ray, const Hit& hit) const { return normal(ray.at(hit.t), hit); }
  /// The same, from the point that was hit.
  dvec3 normal(const dvec3& p, const Hit& hit) const;
  VoxelColour colour(const Hit& hit) const;
  VoxelMaterial material(const Hit& hit) const;
  /// Whether any of its voxels may mirror.
  bool mirrors() const;

  /// Contacts, overlaps and closest points of the unrounded voxels; see SceneField.
  std::optional<FieldContact> sweep(const Capsule& capsule, const dvec3& motion) const;
  bool overlaps(const TurnedBox& box) const;
  std::optional<FieldPoint> closest_point(const dvec3& p, double max_distance) const;

  /// Returns the coordinates in the file of the voxel of a hit (VoxelModel::file_place()).
  ivec3 file_voxel(const Hit& hit) const {
    return models_[objects_[hit.part].model]->file_place().lattice_voxel(hit.voxel);
  }
  const VoxelGrid& grid(const Hit& hit) const { return models_[objects_[hit.part].model]->grid(); }
  /// Converts a point from world space to the space of the object's grid.
  dvec3 place_in_grid(const Hit& hit, const dvec3& p) const;
  /// Side of the object's voxels in metres.
  double voxel_side(const Hit& hit) const;
  /// Converts a unit vector from grid space to world space.
  dvec3 world_from_grid(const Hit& hit, const dvec3& direction) const;
  /// Returns the surface of the solid voxel that contains a point; nullopt if there is none.
  std::optional<VoxelColour> colour_at(const dvec3& p) const;
  /// Side of the smallest voxel of all objects, in metres; 0 if there is none.
  double voxel_side() const;

  /// Bounding box of all solid voxels (or grids); empty if there are none.
  const WorldBox& box() const { return box_; }
  /// The largest coordinate of all placements and of box(); 0 if no voxel is solid.
  double farthest() const { return farthest_; }
  /// Bounding box of everything that rays may hit, which is slightly larger (kTouch in march/voxel/voxel_ray.h).
  const WorldBox& reach() const { return tree_.box(); }
  std::size_t objects() const { return objects_.size(); }
  const std::vector<std::shared_ptr<const VoxelModel>>& models() const { return models_; }
  /// Memory use of the objects and the hierarchy over them, without the models.
  std::size_t bytes() const;

  /// An object in the layout of back ends; `part` is the index of its place.
  struct Placed {
    dvec3 origin;
    std::uint32_t model, turn, part;
  };
  /// Returns the objects in the order of the tree's numbers.
  std::vector<Placed> placed() const;
  /// For each Ray::frame, the bits of the ties of a turn.
  using TiesByFrame = std::array<std::uint8_t, 1u << VoxelTies::kBits>;
  struct PlacedTurn {
    dmat3 grid_from_world;
    TiesByFrame ties;
    double room;       ///< VoxelRay::room of rays without a room of their own
    double per_metre;  ///< voxels per metre
  };
  std::vector<PlacedTurn> turns() const;
  const BoxTree& tree() const { return tree_; }
  const VoxelRounding& rounding() const { return rounding_; }

 private:
  // An object; equal rotations are shared.
  struct Object {
    dvec3 origin;
    std::uint32_t model, turn;
  };
  struct Turn {
    dmat3 grid_from_world, world_from_grid;
    TiesByFrame ties_by_frame;
    double per_metre;  // voxels per metre
    double room = 0;   // VoxelRay::room without Ray::room

    explicit Turn(const dmat3& world_from_grid_);
    double room_of(const Ray& ray) const { return std::max(room, room_in_metres(ray.room) * per_metre); }
    VoxelTies ties(const Ray& ray) const {
      VoxelTies ties;
      ties.bits = ties_by_frame[ray.frame % ties_by_frame.size()];
      return ties;
    }
  };
  struct Query;
  class PacketQuery;

  std::vector<VoxelPlace> places() const;
  Hit follow(const Ray& ray, const Hit* from, const HitFilter* accept, MarchStats* stats, MarchTrace* trace) const;
  bool begins_into(const Ray& ray, const Hit* from) const;
  bool occluded(const Ray& ray, const Hit* from) const;
  template <class Together, class Alone>
  void by_packets(std::span<const Ray> rays, std::span<const Hit* const> from, Hit* hits, const Together& together,
                  const Alone& alone) const;

  std::vector<std::shared_ptr<const VoxelModel>> models_;
  std::vector<VoxelTarget> targets_;
  std::vector<Object> objects_;
  std::vector<Turn> turns_;
  std::vector<std::uint32_t> in_tree_;  // objects that are not empty, in the order of the tree's numbers
  BoxTree tree_;
  WorldBox box_;
  double farthest_ = 0;
  VoxelRounding rounding_;
};

}  // namespace scarp
