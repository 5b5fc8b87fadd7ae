// SPDX-License-Identifier: MIT
#include "scarp/c/scene_handle.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <type_traits>

namespace scarp::c {
namespace {

// Batches write hits where the caller keeps them.
static_assert(std::is_trivially_copyable_v<Hit> && sizeof(Hit) == sizeof(scarp_hit) &&
              alignof(Hit) == alignof(scarp_hit));
#define SCARP_SAME(member, c_member) static_assert(offsetof(Hit, member) == offsetof(scarp_hit, c_member))
SCARP_SAME(status, status);
SCARP_SAME(wall, wall);
SCARP_SAME(face, face);
SCARP_SAME(object, object);
SCARP_SAME(t, t);
SCARP_SAME(cell.col, col);
SCARP_SAME(cell.row, row);
SCARP_SAME(u, u);
SCARP_SAME(v, v);
SCARP_SAME(height, height);
SCARP_SAME(voxel, voxel);
SCARP_SAME(part, part);
#undef SCARP_SAME
static_assert(SCARP_MISS == static_cast<int>(HitStatus::miss) && SCARP_HIT == static_cast<int>(HitStatus::hit) &&
              SCARP_BELOW == static_cast<int>(HitStatus::below) &&
              SCARP_EXHAUSTED == static_cast<int>(HitStatus::exhausted) &&
              SCARP_INSIDE == static_cast<int>(VoxelFace::inside));

// Walls may be hit beside a hole, other surfaces only where there is ground.
bool has_cell(const HeightField& field, const Hit& hit) {
  return hit.cell.col >= 0 && hit.cell.row >= 0 && hit.cell.col < field.cell_cols() &&
         hit.cell.row < field.cell_rows() && (hit.wall || field.cell_heights(hit.cell));
}

struct MayHaveReturned {
  const Hit& hit;
  bool operator()(std::monostate) const { return false; }
  bool operator()(const Terrain& terrain) const { return has_cell(terrain.field(), hit); }
  bool operator()(const Voxels& voxels) const {
    const ivec3& size = voxels.grid().size();
    return hit.part == 0 && hit.voxel.x >= 0 && hit.voxel.y >= 0 && hit.voxel.z >= 0 && hit.voxel.x < size.x &&
           hit.voxel.y < size.y && hit.voxel.z < size.z && voxels.grid().solid(hit.voxel);
  }
  bool operator()(const TerrainTiles& tiles) const {
    const TileLayout& layout = tiles.layout();
    if (std::int64_t{hit.part} >= std::int64_t{layout.cols} * layout.rows) return false;
    const HeightField* tile = tiles.tile(tiles.place(hit));
    return tile && has_cell(*tile, hit);
  }
};

}  // namespace

Hit hit_from(const scarp_hit& hit) {
  scarp_hit clean = hit;
  clean.wall = hit.wall != 0;  // a bool has no other values
  return std::bit_cast<Hit>(clean);
}

bool is_hit_of(const scarp_scene& scene, const scarp_hit& hit) {
  return hit.status == SCARP_HIT && hit.face <= SCARP_INSIDE && hit.object < scene.parts.objects.size() &&
         std::visit(MayHaveReturned{hit_from(hit)}, scene.parts.objects[hit.object]);
}

Hit checked_hit(const scarp_scene& scene, const scarp_hit& hit) {
  if (!is_hit_of(scene, hit)) throw Error("hit: this scene did not return it");
  return hit_from(hit);
}

glm::dmat3 turn_from(const double turn[9]) {
  glm::dmat3 own(0.0);
  for (int i = 0; i < 9; ++i) own[i % 3][i / 3] = turn[i];
  return own == glm::dmat3(0.0) ? glm::dmat3(1.0) : own;
}

Placement placement_from(const scarp_part& part) {
  return {turn_from(part.turn), part.scale == 0 ? 1 : part.scale, {part.origin[0], part.origin[1], part.origin[2]}};
}

void require_reach(const Placement& placement) {
  const dvec3 far = glm::abs(placement.origin);
  if (!(std::max({far.x, far.y, far.z, placement.scale, 1 / placement.scale}) <= kReach))
    throw Error(fmt::format("part: its origin or scale is beyond {}, or not a number", kReach));
}

ScenePart part_from(const scarp_part& part) {
  if (part.reserved != 0) throw Error("part: reserved is not 0");
  ScenePart own{required(part.scene, "part: scene").queries[0], placement_from(part)};
  for (const SceneObject& object : own.scene.objects()) require_reach(placed(own.placement, object.placement));
  if (part.mask != 0) own.mask = part.mask;
  return own;
}

}  // namespace scarp::c
