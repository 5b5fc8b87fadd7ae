// SPDX-License-Identifier: MIT
// The installed texts of voxel marches for WebGL 2, run as GLSL ES 3.0 by EGL without a window. Shaders compute the
// rays in single precision: each is close to the requested ray, and all marches find the voxel and face that the CPU
// finds for the same quantised ray.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cases.h"
#include "march/height/es_context.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/accel/voxel_marks.glsl.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::test {
namespace {

const std::string kHead = R"(#version 300 es
precision highp float;
precision highp int;
uniform highp usampler3D scarp_masks, scarp_sectors, scarp_bytes, scarp_octants;
uniform bool scarp_has_octants;
)";
const std::string kMain = R"(
uniform highp sampler2D origins, directions;
uniform ivec3 low, high;
uniform uint march;
uniform bool ray_only;
layout(location = 0) out uvec4 first;
layout(location = 1) out uvec4 second;
layout(location = 2) out uvec4 third;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 origin = texelFetch(origins, at, 0).xyz, direction = texelFetch(directions, at, 0).xyz;
  ScarpVoxelWalk walk;
  ScarpVoxelEntry entry;
  bool met = scarp_voxel_ray(low, high, origin, direction, 0.0, 1.0e30, false, ivec3(0), walk, entry);
  first = uvec4(walk.voxel, met ? 1u : 0u);
  second = uvec4(walk.next, walk.back);
  third = uvec4(walk.speed, entry.face);
  if (ray_only) return;
  ScarpVoxelAnswer hit = scarp_march_voxels(march, low, high, origin, direction, 0.0, 1.0e30, 10000);
  first = uvec4(hit.voxel, hit.face);
  bool blocked = hit.face != kScarpNoFace && scarp_voxels_block(march, low, high, hit, origin + hit.t * direction,
                                                                -direction, 1.0e30, 10000);
  second = uvec4(floatBitsToUint(hit.t), blocked ? 1u : 0u, uint(hit.steps), 0u);
}
)";

constexpr double kBound = 0x1p-20;  // voxel_float_ray.glsl.h: of 1 + |origin| + |path|
constexpr const char* kMarches[] = {"voxel-planes", "voxel-spheres", "voxel-cubes", "voxel-octants", "voxel-bricks"};

// Two words per mask.
template <class Mask>
void fill_masks(GLenum unit, const ivec3& size, const Mask& mask) {
  std::vector<std::uint64_t> texels;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) texels.push_back(mask({x, y, z}));
  fill_3d(unit, GL_RG32UI, {size.x, size.y, size.z}, texels.data());
}
void fill_bytes(GLenum unit, const VoxelBytes& bytes) {
  fill_3d(unit, GL_R8UI, {bytes.size().x, bytes.size().y, bytes.size().z}, bytes.data());
}

class VoxelTexturesAsEs : public EsTest {
 protected:
  void SetUp() override {
    if (!context_.why_not.empty()) GTEST_SKIP() << context_.why_not;
    use(kHead + installed_text("voxel_textures.glsl") + installed_text("voxel_marches.glsl") + kMain, GL_RGBA32UI);
    GLint unit = 0;
    for (const char* name : {"scarp_masks", "scarp_sectors", "scarp_bytes", "scarp_octants", "origins", "directions"})
      glUniform1i(at(name), unit++);
  }
};

// A quantised ray as the shader has it.
struct Made {
  bool met;
  QuantisedRay ray;

  Made(const GLuint* first, const GLuint* second, const GLuint* third) : met(first[3] != 0), ray{} {
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      ray.voxel[i] = static_cast<int>(first[i]);
      ray.direction.speed[k] = third[i];
      ray.direction.slowness[k] = 1.0 / third[i];
      ray.direction.step[k] = second[3] >> i & 1 ? -1 : 1;
      ray.to_plane[k] = third[i] == 0 ? QuantisedRay::kNever : std::int64_t{second[i]};
    }
    ray.face = static_cast<VoxelFace>(third[3]);
    ray.t_max = HUGE_VAL;
  }
  // Where it enters the box.
  double place(int axis) const {
    const auto k = static_cast<std::size_t>(axis);
    const double left = static_cast<double>(ray.to_plane[k]) / kVoxelPlaces;
    return ray.direction.step[k] > 0 ? ray.voxel[axis] + 1 - left : ray.voxel[axis] + left;
  }
};

double longest_of(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Returns "" if nothing is wrong.
std::string objection(const Made& made, const VoxelRay& ray, const VoxelBox& box) {
  const double longest = longest_of(ray.direction);
  const dvec3 slope = ray.direction / longest;  // per voxel along the longest axis
  const double path = longest_of(ray.origin) + longest_of(dvec3(box.high));
  const double bound = kBound * (1 + longest_of(ray.origin) + path);
  if (!made.met) {
    // The ray may miss the box, or enter it by no more than the bound; both ends of its path in the box are off by as
    // much.
    double t_in = 0, t_out = HUGE_VAL;
    for (int i = 0; i < 3; ++i) {
      const double low = box.low[i] + bound, high = box.high[i] - bound;
      if (ray.direction[i] == 0) {
        if (ray.origin[i] < low || ray.origin[i] > high) return {};
        continue;
      }
      const double a = (low - ray.origin[i]) / slope[i], b = (high - ray.origin[i]) / slope[i];
      t_in = std::max(t_in, std::min(a, b));
      t_out = std::min(t_out, std::max(a, b));
    }
    return t_in < t_out - 2 * bound ? "missed the box" : "";
  }
  // The point of the given ray that is nearest along its longest axis.
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(ray.direction[i]) > std::abs(ray.direction[axis])) axis = i;
  const double way = (made.place(axis) - ray.origin[axis]) / slope[axis];
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (std::abs(static_cast<double>(made.ray.direction.speed[k]) / (1 << kDirectionBits) - std::abs(slope[i])) >
        kBound)
      return "wrong direction";
    if (made.ray.direction.speed[k] == 0) continue;
    // The error along this axis, and the error along the longest axis.
    if (std::abs(ray.origin[i] + way * slope[i] - made.place(i)) > 2 * bound) return "wrong place";
  }
  return {};
}

TEST_F(VoxelTexturesAsEs, MatchTheCpu) {
  int hits = 0, blocked = 0, grids = 0;
  for (const VoxelGridKind& kind : spiteful_voxel_grids()) {
    Random random(11);
    for (int turn = 0; turn < cases(20, 1, 1); ++turn) {
      const VoxelGrid grid = kind.make(random);
      const EmptySpheres spheres(grid);
      const EmptyCubes cubes(grid);
      const OctantCubes octants(grid);
      const BrickMasks bricks(grid);
      const VoxelTarget target{&grid, grids++ % 2 ? grid.bounds() : grid.box(), &spheres, &cubes, &octants, &bricks};
      if (target.box.empty()) continue;
      fill_masks(0, grid.bricks(), [&](const ivec3& brick) { return grid.mask(brick); });
      fill_masks(1, bricks.levels()[0].size, [&](const ivec3& sector) { return bricks.sector(sector); });
      fill_masks(3, grid.size(), [&](const ivec3& voxel) {
        std::uint64_t bytes = 0;
        for (int octant = 0; octant < 8; ++octant)
          bytes |= static_cast<std::uint64_t>(octants.side(voxel, octant)) << (8 * octant);
        return bytes;
      });
      glUniform3i(at("low"), target.box.low.x, target.box.low.y, target.box.low.z);
      glUniform3i(at("high"), target.box.high.x, target.box.high.y, target.box.high.z);
      TextureLevel origins{kWidth, kHeight, {}}, directions{kWidth, kHeight, {}};
      std::vector<VoxelRay> rays;
      const auto& kinds = spiteful_voxel_rays();
      for (std::size_t k = 0; rays.size() < kPixels; ++k) {
        const VoxelRay made = kinds[k % kinds.size()].make(grid, random);
        VoxelRay ray;
        ray.origin = dvec3(glm::vec3(made.origin));
        ray.direction = dvec3(glm::vec3(made.direction));
        const double longest = longest_of(ray.direction);
        if (!(longest > 1e-10 && longest < 1e10 && longest_of(ray.origin) < 1e6)) continue;
        rays.push_back(ray);
        for (int i = 0; i < 3; ++i) origins.texels.push_back(static_cast<float>(ray.origin[i]));
        for (int i = 0; i < 3; ++i) directions.texels.push_back(static_cast<float>(ray.direction[i]));
        origins.texels.push_back(0);
        directions.texels.push_back(0);
      }
      fill(4, GL_RGBA32F, GL_RGBA, {origins});
      fill(5, GL_RGBA32F, GL_RGBA, {directions});
      glUniform1i(at("ray_only"), 1);
      glDrawArrays(GL_TRIANGLES, 0, 3);
      const auto first = words_of(GL_COLOR_ATTACHMENT0), second = words_of(GL_COLOR_ATTACHMENT1),
                 third = words_of(GL_COLOR_ATTACHMENT2);
      glUniform1i(at("ray_only"), 0);
      for (GLuint march = 0; march < glsl::kScarpVoxelMarches; ++march) {
        fill_bytes(2, march == glsl::kScarpVoxelSpheres ? spheres.distances() : cubes.distances());
        glUniform1i(at("scarp_has_octants"), march == glsl::kScarpVoxelOctants);
        glUniform1ui(at("march"), march);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        const auto answers = words_of(GL_COLOR_ATTACHMENT0), more = words_of(GL_COLOR_ATTACHMENT1);
        ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const Made made(&first[4 * i], &second[4 * i], &third[4 * i]);
          if (march == 0) {
            ASSERT_EQ(objection(made, rays[i], target.box), "") << kind.name << ", ray " << i;
          }
          VoxelHit expected;
          if (made.met) expected = find_voxel_march("voxel-planes").cpu(target, made.ray, nullptr);
          const bool hit = answers[4 * i + 3] != 7;
          ASSERT_EQ(hit, static_cast<bool>(expected)) << kMarches[march] << ", " << kind.name << ", ray " << i;
          hits += hit;
          if (!hit) continue;
          const ivec3 voxel(answers[4 * i], answers[4 * i + 1], answers[4 * i + 2]);
          ASSERT_EQ(voxel, expected.voxel) << kMarches[march] << ", " << kind.name << ", ray " << i;
          ASSERT_EQ(answers[4 * i + 3], static_cast<GLuint>(expected.face));
          blocked += static_cast<int>(more[4 * i + 1]);
          if (march == 0) {
            // At the hit, the given ray is close to the voxel: off by at most the bound plus the rounding of t.
            const double t = std::bit_cast<float>(more[4 * i]);
            const double bound = 2 * kBound * (1 + 2 * longest_of(rays[i].origin) + longest_of(dvec3(target.box.high)));
            for (int axis = 0; axis < 3; ++axis) {
              const double place = rays[i].origin[axis] + t * rays[i].direction[axis];
              EXPECT_GE(place, voxel[axis] - bound) << kind.name << ", ray " << i;
              EXPECT_LE(place, voxel[axis] + 1 + bound) << kind.name << ", ray " << i;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(blocked, 10);
}

}  // namespace
}  // namespace scarp::test
