// SPDX-License-Identifier: MIT
// The shader text of voxel marches, compiled as C++, on the adversarial grids and rays of the oracle: the same voxel,
// face and t as the CPU's, to the bit, with 64-bit integers and with words. Its quotients are compared with those of
// doubles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "cases.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/march/voxel/voxel_ahead.h"
#include "scarp/march/voxel/voxel_double.glsl.h"
#include "scarp/march/voxel/voxel_marches.glsl.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::glsl {

static const VoxelTarget* host_target = nullptr;
static uint host_march = 0;
static bool host_words = false;

static uvec2 halves(std::uint64_t mask) { return {static_cast<uint>(mask), static_cast<uint>(mask >> 32)}; }

bool scarp_voxel_words() { return host_words; }
uvec2 scarp_voxel_mask(const ivec3& brick) { return halves(host_target->grid->mask(brick)); }
uvec2 scarp_voxel_sector(const ivec3& sector) { return halves(host_target->bricks->sector(sector)); }
uint scarp_voxel_byte(const ivec3& voxel, uint octant) {
  if (host_march == kScarpVoxelSpheres) return static_cast<uint>(host_target->spheres->distance(voxel));
  if (host_march == kScarpVoxelCubes) return static_cast<uint>(host_target->cubes->distance(voxel));
  return static_cast<uint>(host_target->octants->side(voxel, static_cast<int>(octant)));
}

}  // namespace scarp::glsl

namespace scarp::test {
namespace {

const int kRaysPerPair = cases(20'000, 1'500, 100);
const int kQuotients = cases(10'000'000, 200'000, 20'000);
constexpr int kRaysPerGrid = 100;

struct Marched {
  std::string_view name;
  std::uint32_t number;
};
constexpr Marched kMarches[] = {{"voxel-planes", glsl::kScarpVoxelPlanes},
                                {"voxel-spheres", glsl::kScarpVoxelSpheres},
                                {"voxel-cubes", glsl::kScarpVoxelCubes},
                                {"voxel-octants", glsl::kScarpVoxelOctants},
                                {"voxel-bricks", glsl::kScarpVoxelBricks}};

// Whether the shaders receive such rays: the host scales directions that are too long or short to about 1.
bool is_usual(const VoxelRay& ray) {
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::abs(ray.direction[axis]);
    if (d != 0 && !(d > 0x1p-200 && d < 0x1p200)) return false;
  }
  return true;
}

// A ray in the memory layout of voxel_objects.glsl.h.
struct ShaderRay {
  glsl::ScarpVoxelWalk walk{};
  double t = 0, t_per_s = 0;
  std::uint32_t entered = 0;
  bool met = true;

  ShaderRay(const VoxelRay& ray, const VoxelBox& box, VoxelTies ties) {
    dvec3 inverse, origin = ray.origin;
    for (int axis = 0; axis < 3; ++axis) inverse[axis] = glsl::scarp_exact_inverse(ray.direction[axis]);
    const double per_longest = std::min({std::abs(inverse.x), std::abs(inverse.y), std::abs(inverse.z)});
    const bool has_start = ray.start_voxel.has_value();
    const ivec3 start = ray.start_voxel.value_or(ivec3(0));
    glsl::ScarpVoxelClip clip{ray.t_min, ray.t_max, -1, false};
    walk.back = ties.bits & glsl::kScarpTieBits;
    for (int axis = 0; axis < 3; ++axis) {
      walk.speed[axis] = glsl::scarp_voxel_speed(ray.direction[axis], per_longest);
      walk.back |= glsl::scarp_voxel_back(axis, ray.direction[axis], ties.bits) |
                   glsl::scarp_voxel_inexact(ray.direction[axis], per_longest, walk.speed[axis]);
      if (ray.direction[axis] == 0)
        origin[axis] = glsl::scarp_voxel_level(axis, origin[axis], ray.room, walk.back, box.low[axis], box.high[axis]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      if ((walk.back & glsl::kScarpInexact) == 0)
        walk.back |= glsl::scarp_voxel_rounded(origin[axis], ray.direction[axis], ray.t_min);
      met = glsl::scarp_voxel_clip(axis, origin[axis], ray.direction[axis], inverse[axis], ray.room, walk.speed[axis],
                                   walk.back, box.low[axis], box.high[axis], has_start, start[axis], clip) &&
            met;
    }
    met = met && clip.t <= clip.t_out;
    if (!met) return;
    for (int axis = 0; axis < 3; ++axis) {
      glsl::ScarpVoxelPlace at;
      met = glsl::scarp_voxel_place(axis, origin[axis], ray.direction[axis], walk.speed[axis], walk.back, box.low[axis],
                                    box.high[axis], has_start, start[axis], clip, at) &&
            met;
      walk.voxel[axis] = at.voxel;
      walk.left[axis] = at.left;
      walk.next[axis] = at.next;
      walk.speed[axis] = at.speed;
    }
    walk.axis = -1;
    t = clip.t;
    t_per_s = glsl::scarp_voxel_t_per_s(per_longest);
    entered = glsl::scarp_voxel_entered(clip, walk.back);
  }
};

VoxelHit marched(const ShaderRay& begin, const VoxelRay& ray, std::uint32_t& steps) {
  constexpr int kTurns = 100'000;
  int turns = kTurns;
  VoxelHit hit;
  glsl::ScarpVoxelWalk walk = begin.walk;
  const bool found = glsl::scarp_first_voxel(glsl::host_march, walk, turns);
  steps = static_cast<std::uint32_t>(kTurns - turns);
  if (!found) return hit;
  const double t = glsl::scarp_voxel_time(walk, begin.t, begin.t_per_s);
  if (t > ray.t_max) return hit;
  hit.status = HitStatus::hit;
  hit.t = t;
  hit.face = static_cast<VoxelFace>(glsl::scarp_voxel_face(walk, begin.entered));
  hit.voxel = walk.voxel;
  hit.entry = glsl::host_target->grid->entry(walk.voxel);
  return hit;
}

std::string text(const VoxelHit& hit) {
  return fmt::format("{} voxel ({}, {}, {}) face {} t={:a}", hit ? "hit" : "miss", hit.voxel.x, hit.voxel.y,
                     hit.voxel.z, static_cast<int>(hit.face), hit.t);
}

class VoxelShaders : public testing::TestWithParam<VoxelGridKind> {};

TEST_P(VoxelShaders, MatchTheCpu) {
  int hits = 0, failures = 0;
  for (const VoxelRayKind& rays : spiteful_voxel_rays()) {
    Random random(2);
    std::optional<VoxelGrid> grid;
    std::optional<EmptySpheres> spheres;
    std::optional<EmptyCubes> cubes;
    std::optional<OctantCubes> octants;
    std::optional<BrickMasks> bricks;
    VoxelTarget target;
    for (int i = 0; i < kRaysPerPair && failures < 5; ++i) {
      if (i % kRaysPerGrid == 0) {
        grid.emplace(GetParam().make(random));
        spheres.emplace(*grid);
        cubes.emplace(*grid);
        octants.emplace(*grid);
        bricks.emplace(*grid);
        target = {&*grid,  i % (2 * kRaysPerGrid) == 0 ? grid->box() : grid->bounds(), &*spheres, &*cubes, &*octants,
                  &*bricks};
        glsl::host_target = &target;
      }
      VoxelRay ray = rays.make(*grid, random);
      ray.room = i % 4 ? 0 : kSceneRoom;
      if (!is_usual(ray) || target.box.empty()) continue;
      const VoxelTies ties(random_orientation(random));
      const std::optional<QuantisedRay> expected_ray = quantise(ray, VoxelDirection(ray.direction, ties), target.box);
      glsl::host_words = i % 2 == 1;
      const ShaderRay there(ray, target.box, ties);
      ASSERT_EQ(there.met, expected_ray.has_value()) << rays.name;
      if (!expected_ray) continue;
      for (const Marched& march : kMarches) {
        const VoxelMarchEntry& entry = find_voxel_march(march.name);
        MarchStats stats;
        const VoxelHit expected = entry.cpu(target, *expected_ray, &stats);
        glsl::host_march = march.number;
        std::uint32_t steps = 0;
        const VoxelHit hit = marched(there, ray, steps);
        hits += static_cast<bool>(expected);
        // Spheres may advance slightly less.
        const bool same_steps = steps == stats.steps || march.number == glsl::kScarpVoxelSpheres;
        if (hit == expected && same_steps) continue;
        ++failures;
        ADD_FAILURE() << march.name << " on " << GetParam().name << ", " << rays.name << ": " << text(hit) << ", "
                      << steps << " steps\n  judge " << text(expected) << ", " << stats.steps << " steps";
      }
    }
  }
  // A single grid of a kind may have nothing to hit.
  if (GetParam().name != "empty or full" && kRaysPerPair > 2 * kRaysPerGrid) {
    EXPECT_GT(hits, kRaysPerPair / 10) << "rays are aimed at something";
  }
}

INSTANTIATE_TEST_SUITE_P(All, VoxelShaders, testing::ValuesIn(spiteful_voxel_grids()), [](const auto& kind) {
  std::string name(kind.param.name);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST(VoxelShaders, ComputeVoxelsAhead) {
  for (int octant = 0; octant < 8; ++octant) {
    for (int bit = 0; bit < 64; ++bit) {
      const ivec3 voxel(4 + (bit & 3), 8 + (bit >> 2 & 3), bit >> 4);
      EXPECT_EQ(glsl::scarp_ahead(voxel, static_cast<std::uint32_t>(octant)), glsl::halves(kAhead[octant][bit]));
    }
  }
}

// A long path through the largest box: distances are rebased 64 times.
TEST(VoxelShaders, MatchAtTheLargestSize) {
  constexpr int kHeight = 256;  // less memory
  VoxelGrid grid({VoxelGrid::kMaxSide, VoxelGrid::kMaxSide, kHeight}, 1);
  const ivec3 last = grid.size() - 1;
  grid.fill({{last.x - 40, last.y - 40, 0}, last + 1}, 1);
  grid.fill({{0, 0, last.z - 4}, {40, 40, last.z}}, 1);
  constexpr double kSide = VoxelGrid::kMaxSide;
  const BrickMasks bricks(grid);
  VoxelTarget target{&grid, grid.box()};
  target.bricks = &bricks;
  glsl::host_target = &target;
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    // Nearly level rays have planes that are crossed far away.
    VoxelRay ray;
    const dvec3 to(uniform(random, kSide - 48, kSide), uniform(random, kSide - 48, kSide), uniform(random, 0, kHeight));
    const dvec3 from(uniform(random, -50, 10), uniform(random, -50, 10),
                     to.z + std::ldexp(uniform(random, -1, 1), -i % 24));
    ray.origin = i % 2 ? from : to;
    ray.direction = i % 2 ? to - from : from - to;
    const VoxelTies ties(random_orientation(random));
    const std::optional<QuantisedRay> expected_ray = quantise(ray, VoxelDirection(ray.direction, ties), target.box);
    for (const Marched& march : {kMarches[0], kMarches[4]}) {
      glsl::host_march = march.number;
      glsl::host_words = i % 4 < 2;
      const ShaderRay there(ray, target.box, ties);
      ASSERT_EQ(there.met, expected_ray.has_value());
      if (!expected_ray) continue;
      std::uint32_t steps = 0;
      const VoxelHit expected = find_voxel_march(march.name).cpu(target, *expected_ray, nullptr);
      ASSERT_EQ(marched(there, ray, steps), expected) << march.name << ", ray " << i;
      hits += static_cast<bool>(expected);
    }
  }
  EXPECT_GT(hits, 100);
}

// Estimates that are off by some units, like those of drivers, must not matter: the shader code starts from the correct
// quotient here, so its corrections are tested from both sides of it.
TEST(VoxelShaders, DivideAsTheCpu) {
  Random random(4);
  for (int i = 0; i < kQuotients; ++i) {
    const auto a = static_cast<std::uint64_t>(std::exp2(uniform(random, 0, 35)));
    const glsl::uvec2 words = glsl::halves(a);
    const auto b = static_cast<std::uint32_t>(std::exp2(uniform(random, 0, 28)));
    ASSERT_EQ(glsl::scarp_exact_ratio(words, b), static_cast<double>(a) / b);
    double x = std::ldexp(uniform(random, -1, 1), whole(random, -40, 40));
    if (i % 3 == 0) x = std::ldexp(1.0, whole(random, -3, 3)) + std::ldexp(whole(random, -9, 9), -53);
    ASSERT_EQ(glsl::scarp_exact_inverse(x), 1 / x) << fmt::format("{:a}", x);
    for (const int off : {-2, -1, 1, 2}) {
      const auto moved = [&](double from) {
        for (int k = 0; k < std::abs(off); ++k) from = std::nextafter(from, off < 0 ? 0 : from * 2);
        return from;
      };
      ASSERT_EQ(glsl::scarp_corrected_ratio(moved(static_cast<double>(a) / b), words.x, b), static_cast<double>(a) / b);
      ASSERT_EQ(glsl::scarp_corrected_inverse(moved(1 / x), x), 1 / x) << fmt::format("{:a} {}", x, off);
    }
  }
  EXPECT_EQ(glsl::scarp_exact_ratio({0, 0}, 5), 0.0);
  EXPECT_EQ(glsl::scarp_exact_inverse(0.0), HUGE_VAL);
  EXPECT_EQ(glsl::scarp_exact_inverse(-0.0), -HUGE_VAL);
}

}  // namespace
}  // namespace scarp::test
