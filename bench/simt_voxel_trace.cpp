// SPDX-License-Identifier: MIT
// The shader source reads masks and bytes through its host. Here the host reads memory, and a trace records the
// addresses.

#include "bench/simt_note.h"
// Included after the definition of SCARP_COUNT, like all files that include the shader source.
#include "bench/simt_voxel_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/accel/voxel_buffers.glsl.h"
#include "scarp/march/voxel/voxel_ray_vk.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp::bench {
namespace {

thread_local const VoxelTarget* marched_grid = nullptr;
thread_local std::uint64_t marched_address = 0;

// Addresses of the data of a grid, disjoint from those of other grids.
constexpr int kGridBits = 44;
constexpr std::uint64_t kMasks = std::uint64_t{1} << 41, kMarks = std::uint64_t{1} << 42;

}  // namespace
}  // namespace scarp::bench

// The shader source and its host are local to this file: the library and its tests have their own hosts.
#undef SCARP_GLSL_BEGIN
#undef SCARP_GLSL_END
#define SCARP_GLSL_BEGIN  \
  namespace scarp::glsl { \
  namespace {
#define SCARP_GLSL_END \
  }                    \
  }

#include "scarp/march/voxel/voxel_double.glsl.h"
#include "scarp/march/voxel/voxel_marches.glsl.h"

SCARP_GLSL_BEGIN

uvec2 halves(std::uint64_t mask) { return {static_cast<uint>(mask), static_cast<uint>(mask >> 32)}; }

bool scarp_voxel_words() { return false; }
uvec2 scarp_voxel_mask(const ivec3& brick) {
  const VoxelGrid& grid = *bench::marched_grid->grid;
  const std::uint64_t index = grid.brick_index(brick), page = index / VoxelGrid::kPageBricks;
  bench::note_fetch(bench::marched_address + sizeof(uint) * page, sizeof(uint));
  const std::uint64_t at = grid.page_table()[page] + index % VoxelGrid::kPageBricks;
  bench::note_fetch(bench::marched_address + bench::kMasks + sizeof(uvec2) * at, sizeof(uvec2));
  return halves(grid.mask(brick));
}
uvec2 scarp_voxel_sector(const ivec3& sector) {
  const BrickMasks::Level& level = bench::marched_grid->bricks->levels()[0];
  bench::note_fetch(bench::marched_address + bench::kMarks + sizeof(uvec2) * level.index(sector), sizeof(uvec2));
  return halves(level.mask(sector));
}
uint scarp_voxel_byte(const ivec3& voxel, uint octant) {
  const VoxelTarget& target = *bench::marched_grid;
  const ivec3& size = target.grid->size();
  const auto x = static_cast<std::uint64_t>(size.x), y = static_cast<std::uint64_t>(size.y),
             z = static_cast<std::uint64_t>(size.z);
  const std::uint64_t of_octant = target.octants ? x * y * z * octant : 0;
  const std::uint64_t at = of_octant + static_cast<std::uint64_t>(voxel.x) +
                           x * (static_cast<std::uint64_t>(voxel.y) + y * static_cast<std::uint64_t>(voxel.z));
  bench::note_fetch(bench::marched_address + bench::kMarks + at / sizeof(uint) * sizeof(uint), sizeof(uint));
  if (target.spheres) return static_cast<uint>(target.spheres->distance(voxel));
  if (target.cubes) return static_cast<uint>(target.cubes->distance(voxel));
  return static_cast<uint>(target.octants->side(voxel, static_cast<int>(octant)));
}

SCARP_GLSL_END

namespace scarp::bench {

struct SimtVoxels::Impl {
  PlacedVoxels voxels;
  VoxelObjects objects;
  std::vector<VoxelTarget> targets;
  std::vector<VoxelObjects::Placed> placed;
  std::vector<VoxelObjects::PlacedTurn> turns;
  std::vector<glsl::ScarpBoxNode> nodes;
  BoxTree::Parts tree;
  glsl::uint march;

  explicit Impl(const PlacedVoxels& of)
      : voxels(of), objects(voxels), placed(objects.placed()), turns(objects.turns()), tree(objects.tree().parts()) {
    for (const auto& model : voxels.models) targets.push_back(model->target());
    for (march = 0; voxel_march_name(march) != voxels.models.front()->march().name;) ++march;
    nodes.resize(tree.nodes.size() / sizeof(glsl::ScarpBoxNode));
    if (!nodes.empty()) std::memcpy(nodes.data(), tree.nodes.data(), tree.nodes.size());
  }
};

namespace {

// voxel_boxes.glsl.h: a ray relative to the middle of the hierarchy, in units of its longest component.
constexpr float kSteepest = 0x1p60f, kBoxRounding = 1 + 0x1p-19f;
constexpr std::uint32_t kNoChild = 0xffffffff;

struct BoxRay {
  std::array<float, 3> origin{}, inwards{};
  double t_in = 0, longest = 0;
  float end = 0;
  bool met = false;

  BoxRay(const Ray& ray, const BoxTree::Parts& tree) {
    double t_out = ray.t_max;
    t_in = ray.t_min;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis], from = ray.origin[axis], low = tree.box.low[axis],
                   high = tree.box.high[axis];
      longest = std::max(longest, std::abs(d));
      if (d == 0) {
        if (from < low || from > high) return;
        continue;
      }
      const double a = (low - from) / d, b = (high - from) / d;
      t_in = std::max(t_in, std::min(a, b));
      t_out = std::min(t_out, std::max(a, b));
    }
    if (!(t_in <= t_out)) return;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const double d = ray.direction[axis];
      const auto slope = static_cast<float>(d / longest);
      origin[k] = static_cast<float>(ray.origin[axis] + t_in * d - tree.middle[axis]);
      inwards[k] = std::abs(slope) * kSteepest < 1 ? std::copysign(kSteepest, slope) : 1 / slope;
    }
    end = end_of(t_out);
    met = true;
  }
  float end_of(double t) const { return static_cast<float>((t - t_in) * longest) * kBoxRounding; }

  // The child to visit next; leaves the others in `rest`.
  std::uint32_t nearest_child(const glsl::ScarpBoxNode& node, std::uint32_t& rest) const {
    std::uint32_t found = kNoChild, left = 0, own = 0;
    float nearest = 0;
    for (int k = 0; k < 4; ++k) {
      const std::array<float, 3> low{node.low_x[k], node.low_y[k], node.low_z[k]},
          high{node.high_x[k], node.high_y[k], node.high_z[k]};
      float near = 0, far = end;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool down = inwards[axis] < 0;
        near = std::max(near, ((down ? high : low)[axis] - origin[axis]) * inwards[axis]);
        far = std::min(far, ((down ? low : high)[axis] - origin[axis]) * (inwards[axis] * kBoxRounding));
      }
      if (!(near <= far) || (rest >> k & 1) == 0) continue;
      left |= 1u << k;
      if (found != kNoChild && near > nearest) continue;
      found = node.child[k];
      own = 1u << k;
      nearest = near;
    }
    rest = left & ~own;
    return found;
  }
};

// VoxelDirection of a ray (scarp_turn_ray in voxel_objects.glsl.h).
struct TurnedRay {
  std::uint32_t turn = kNoChild;
  dvec3 given{0.0}, inverse{0.0};
  glsl::uvec3 speed{0};
  glsl::uint back = 0;
  double t_per_s = 0;

  void set(std::uint32_t to, const glm::dmat3& grid_from_world, glsl::uint ties, const dvec3& direction) {
    note_block(SimtBlock::turned);
    turn = to;
    given = grid_from_world * direction;
    back = ties & glsl::kScarpTieBits;
    for (int axis = 0; axis < 3; ++axis) {
      inverse[axis] = glsl::scarp_exact_inverse(given[axis]);
      back |= glsl::scarp_voxel_back(axis, given[axis], ties);
    }
    const double per_longest = std::min({std::abs(inverse.x), std::abs(inverse.y), std::abs(inverse.z)});
    for (int axis = 0; axis < 3; ++axis) {
      speed[axis] = glsl::scarp_voxel_speed(given[axis], per_longest);
      back |= glsl::scarp_voxel_inexact(given[axis], per_longest, speed[axis]);
    }
    t_per_s = glsl::scarp_voxel_t_per_s(per_longest);
  }
};

struct ObjectRay {
  glsl::ScarpVoxelWalk walk{};
  double t = 0;
  glsl::uint entered = 0;
  bool met = true;

  ObjectRay(const TurnedRay& ray, dvec3 origin, double room, double t_min, double t_max, const VoxelBox& box) {
    note_block(SimtBlock::object);
    glsl::ScarpVoxelClip clip{t_min, t_max, -1, false};
    walk.back = ray.back;
    for (int axis = 0; axis < 3; ++axis) {
      if (ray.given[axis] == 0)
        origin[axis] = glsl::scarp_voxel_level(axis, origin[axis], room, ray.back, box.low[axis], box.high[axis]);
      if ((walk.back & glsl::kScarpInexact) == 0)
        walk.back |= glsl::scarp_voxel_rounded(origin[axis], ray.given[axis], t_min);
      met = glsl::scarp_voxel_clip(axis, origin[axis], ray.given[axis], ray.inverse[axis], room, ray.speed[axis],
                                   walk.back, box.low[axis], box.high[axis], false, 0, clip) &&
            met;
    }
    met = met && clip.t <= clip.t_out;
    if (!met) return;
    walk.speed = ray.speed;
    for (int axis = 0; axis < 3; ++axis) {
      glsl::ScarpVoxelPlace at;
      met = glsl::scarp_voxel_place(axis, origin[axis], ray.given[axis], ray.speed[axis], walk.back, box.low[axis],
                                    box.high[axis], false, 0, clip, at) &&
            met;
      walk.voxel[axis] = at.voxel;
      walk.left[axis] = at.left;
      walk.next[axis] = at.next;
      walk.speed[axis] = at.speed;
    }
    walk.axis = -1;
    t = clip.t;
    entered = glsl::scarp_voxel_entered(clip, ray.back);
  }
};

}  // namespace

SimtVoxels::SimtVoxels(const PlacedVoxels& voxels) : impl_(std::make_unique<Impl>(voxels)) {}
SimtVoxels::~SimtVoxels() = default;

Hit SimtVoxels::trace(const Ray& ray, SimtTrace* trace) const {
  const Impl& all = *impl_;
  Hit best;
  noted = trace;
  BoxRay boxes(ray, all.tree);
  if (boxes.met && !all.nodes.empty()) {
    TurnedRay turned;
    double t_max = ray.t_max;
    std::vector<std::uint32_t> waiting;  // a node, and its remaining children
    std::uint32_t node = 0, rest = 15;
    for (bool over = false; !over;) {
      note_block(SimtBlock::frame);
      const std::uint32_t child = boxes.nearest_child(all.nodes[node], rest);
      if (rest != 0) waiting.push_back(node << 4 | rest);
      node = child;
      rest = 15;
      if ((child & glsl::kScarpBoxLeaf) == 0) continue;
      over = waiting.empty();
      if (!over) {
        node = waiting.back() >> 4;
        rest = waiting.back() & 15;
        waiting.pop_back();
      }
      if (child == kNoChild) continue;
      const VoxelObjects::Placed& object = all.placed[child & ~glsl::kScarpBoxLeaf];
      const auto& [turn, ties, own_room, per_metre] = all.turns[object.turn];
      const double room = glsl::scarp_voxel_room(own_room, per_metre, ray.room);
      if (turned.turn != object.turn) turned.set(object.turn, turn, ties[0], ray.direction);
      const VoxelTarget& target = all.targets[object.model];
      ObjectRay begun(turned, turn * (ray.origin - object.origin), room, ray.t_min, t_max, target.box);
      if (!begun.met) continue;
      marched_grid = &target;
      marched_address = std::uint64_t{object.model} << kGridBits;
      int turns = std::numeric_limits<int>::max();
      if (!glsl::scarp_first_voxel(all.march, begun.walk, turns)) continue;
      note_block(SimtBlock::hit);
      const double t = glsl::scarp_voxel_time(begun.walk, begun.t, turned.t_per_s);
      if (!(t < t_max || (t == t_max && (!best || object.part <= best.part)))) continue;
      t_max = t;
      best.status = HitStatus::hit;
      best.t = t;
      best.part = object.part;
      best.voxel = begun.walk.voxel;
      best.face = static_cast<VoxelFace>(glsl::scarp_voxel_face(begun.walk, begun.entered));
      boxes.end = std::min(boxes.end, boxes.end_of(t));
    }
    note_block(SimtBlock::answer);
  }
  noted = nullptr;
  return best;
}

}  // namespace scarp::bench
