// SPDX-License-Identifier: MIT
// Pictures of voxels on a Vulkan device, drawn as boxes and traced by compute: both equal the CPU's, bit for bit, for
// any eye, also where two objects are at the same depth.
#include "scarp/scene/voxel_camera_vk.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <string>

#include "base/refusal.h"
#include "cases.h"
#include "scarp/march/voxel/voxel_proxies.glsl.h"
#include "scarp/scene/scene_vk.h"
#include "vk/device_under_test.h"

namespace scarp::glsl {
bool scarp_voxel_words() { return false; }
}  // namespace scarp::glsl

namespace scarp::test {
namespace {

const int kWidth = cases(200, 96, 48), kHeight = cases(150, 70, 36);

VoxelPicture looking(const dvec3& eye, const dvec3& forward, double pixel = 0.01) {
  const dvec3 f = normalize(forward), top = std::abs(f.y) > 0.9 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
  const dvec3 right = normalize(cross(f, top)), down = -cross(right, f);
  VoxelPicture picture{static_cast<std::uint32_t>(kWidth), static_cast<std::uint32_t>(kHeight)};
  picture.origin = eye;
  picture.right = pixel * right, picture.down = pixel * down;
  picture.direction = f - 0.5 * kWidth * picture.right - 0.5 * kHeight * picture.down;
  return picture;
}
VoxelPicture along(const dvec3& eye, const dvec3& forward, double pixel) {
  VoxelPicture picture = looking(eye, forward, pixel);
  picture.origin_right = picture.right, picture.origin_down = picture.down;
  picture.origin -= 0.5 * kWidth * picture.right + 0.5 * kHeight * picture.down;
  picture.direction = normalize(forward);
  picture.right = picture.down = dvec3(0.0);
  return picture;
}
// Up to `beside` pixels off the centres.
std::vector<Ray> rays_of(const VoxelPicture& picture, double beside = 0) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> off(-beside, beside);
  std::vector<Ray> rays;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const double x = col + 0.5 + off(engine), y = row + 0.5 + off(engine);
      Ray ray;
      ray.origin = picture.origin + x * picture.origin_right + y * picture.origin_down;
      ray.direction = picture.direction + x * picture.right + y * picture.down;
      rays.push_back(ray);
    }
  }
  return rays;
}

std::shared_ptr<const VoxelModel> model_of(const ivec3& size, double share, std::string_view march, unsigned seed = 1) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> chance(0, 1);
  VoxelGrid grid(size, 8);
  grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
    return chance(engine) < share ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march(march));
}

// Touching cubes around the origin, as in C. Leak's post (bench/voxel_sets.h).
Scene touching(std::string_view march, double share = 0.1) {
  PlacedVoxels placed;
  placed.models = {model_of(ivec3(8), share, march)};
  for (int z = -2; z < 2; ++z) {
    for (int y = -2; y < 2; ++y) {
      for (int x = -2; x < 2; ++x) placed.places.push_back({0, glm::dmat3(0.25), 2.0 * dvec3(x, y, z)});
    }
  }
  return Scene(scene_voxels(std::move(placed)));
}
// Rotated, of several marches, overlapping; some twice at the same position.
Scene crowd() {
  PlacedVoxels placed;
  placed.models = {model_of({9, 7, 8}, 0.2, "voxel-bricks"), model_of(ivec3(5), 0.5, "voxel-cubes"),
                   model_of(ivec3(6), 0.3, "voxel-spheres"), model_of({20, 1, 20}, 0.9, "voxel-planes"),
                   model_of(ivec3(3), 0, "voxel-octants")};
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> at(-3, 3);
  for (std::uint32_t i = 0; i < 60; ++i) {
    const auto turn = glm::rotate(glm::dmat4(1), at(engine), dvec3(1, 2, 3));
    const dvec3 origin(at(engine), at(engine), at(engine));
    placed.places.push_back({i % 5, (i % 3 ? 0.2 : 0.07) * (i % 4 ? glm::dmat3(turn) : glm::dmat3(1)), origin});
    if (i % 6 == 0) placed.places.push_back(placed.places.back());
  }
  return Scene(scene_voxels(std::move(placed)));
}

class VoxelCameraOnDevice : public OnDevice {
 protected:
  void SetUp() override {
    OnDevice::SetUp();
    if (!IsSkipped() && !device().description().abilities.draws) GTEST_SKIP() << "the device does not draw";
  }

  // Returns the hits.
  std::size_t expect_same(const Scene& scene, VoxelCamera& camera, const VoxelPicture& picture, const std::string& what,
                          double beside = 0) {
    const std::vector<Ray> rays = rays_of(picture, beside);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    scene.closest_hits(rays, expected);
    std::size_t count = 0;
    for (const VoxelDrawing way : {VoxelDrawing::compute, VoxelDrawing::proxies}) {
      camera.look(way, picture, rays, hits);
      int failures = 0;
      for (std::size_t i = 0; i < rays.size() && failures < 3; ++i) {
        const Hit &is = hits[i], &e = expected[i];
        count += way == VoxelDrawing::proxies && is;
        if (static_cast<bool>(is) == static_cast<bool>(e) &&
            (!e || (is.t == e.t && is.voxel == e.voxel && is.face == e.face && is.part == e.part)))
          continue;
        ++failures;
        ADD_FAILURE() << fmt::format(
            "{}, {}, pixel ({}, {}): {} part {} voxel ({}, {}, {}) face {} t {:a} instead of {} part {} voxel ({}, {}, "
            "{}) face {} t {:a}",
            what, kVoxelDrawings[static_cast<std::size_t>(way)].name, i % static_cast<std::size_t>(kWidth),
            i / static_cast<std::size_t>(kWidth), is ? "hit" : "miss", is.part, is.voxel.x, is.voxel.y, is.voxel.z,
            static_cast<int>(is.face), is.t, e ? "hit" : "miss", e.part, e.voxel.x, e.voxel.y, e.voxel.z,
            static_cast<int>(e.face), e.t);
      }
    }
    return count;
  }

  void expect_same_from_everywhere(const Scene& scene, VoxelCamera& camera, const std::string& what) {
    std::size_t hits = 0;
    for (int octant = 0; octant < 8; ++octant) {
      const dvec3 side(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
      hits += expect_same(scene, camera, looking(side * dvec3(5.1, 4.3, 6.7), -side),
                          fmt::format("{}, octant {}", what, octant));
    }
    for (int face = 0; face < 6; ++face) {
      dvec3 forward(0.0);
      forward[face / 2] = face % 2 ? 1 : -1;
      const std::string name = fmt::format("{}, along {}{}", what, face % 2 ? '+' : '-', "xyz"[face / 2]);
      // Views along planes between objects, beside these planes, and from inside.
      hits += expect_same(scene, camera, looking(-7.0 * forward, forward), name);
      hits += expect_same(scene, camera, looking(dvec3(0.3, 0.2, 0.1) - 7.0 * forward, forward), name + ", beside");
      hits += expect_same(scene, camera, along(-7.0 * forward, forward, 0.0625), name + ", parallel");
      hits += expect_same(scene, camera, along(dvec3(0.1), forward, 0.05), name + ", parallel from inside");
      // With a wide angle, in the corner of objects, on faces and in the middle of one.
      for (const dvec3& eye : {dvec3(0.0), dvec3(0, 0.3, 1.9), dvec3(0.9, 0.8, 1.1), dvec3(1e-9)})
        hits += expect_same(scene, camera, looking(eye, forward + dvec3(0.1, 0, 0.05), 0.05), name + ", inside");
    }
    EXPECT_GT(hits, static_cast<std::size_t>(kWidth * kHeight));
  }
};

TEST_F(VoxelCameraOnDevice, DrawsTouchingCubesAsTheCpu) {
  for (const VoxelMarchEntry& march : voxel_marches()) {
    if (!march.gpu) continue;
    const Scene scene = touching(march.name);
    VoxelCamera camera(device(), scene, {.rays_at_once = 8192});
    if (march.name == "voxel-bricks") {
      expect_same_from_everywhere(scene, camera, std::string(march.name));
    } else {
      expect_same(scene, camera, looking({5.1, -4.3, 6.7}, {-5, 4, -6}), std::string(march.name));
    }
  }
}

TEST_F(VoxelCameraOnDevice, DrawsACrowdAsTheCpu) {
  const Scene scene = crowd();
  VoxelCamera camera(device(), scene, {.rays_at_once = 8192});
  expect_same_from_everywhere(scene, camera, "crowd");
}

TEST_F(VoxelCameraOnDevice, DrawsTheSameFromWords) {
  const Scene scene = touching("voxel-octants");
  VoxelCamera camera(device(), scene, {.rays_at_once = 8192, .words = true});
  expect_same(scene, camera, looking({5.1, -4.3, 6.7}, {-5, 4, -6}), "words");
}

// Rays of a filter are off the pixel centres; their directions may be longer than the camera's.
TEST_F(VoxelCameraOnDevice, AcceptsRaysOffThePixelCentres) {
  const Scene scene = touching("voxel-bricks", 0.01);
  VoxelCamera camera(device(), scene, {.rays_at_once = 8192});
  expect_same(scene, camera, looking({5.1, -4.3, 6.7}, {-5, 4, -6}, 0.005), "beside", 0.5);
  // Objects that cover a pixel or two, and consist only of silhouettes.
  expect_same(scene, camera, looking({51, -43, 67}, {-5, 4, -6}, 0.02), "far away", 0.5);
}

// Objects at one position have the same depth: the first counts. If depths differ by less than float precision, the
// nearer one counts, in any drawing order.
TEST_F(VoxelCameraOnDevice, ResolvesObjectsAtEqualDepth) {
  PlacedVoxels placed;
  placed.models = {model_of(ivec3(4), 1, "voxel-bricks")};
  for (int i = 0; i < 8; ++i) {
    // 2^-26 to 2^-30 of the distance.
    placed.places.push_back({0, glm::dmat3(1), dvec3(-2, -2, -2 + std::ldexp(i % 3 - 1, -24 - i))});
  }
  const Scene scene(scene_voxels(std::move(placed)));
  VoxelCamera camera(device(), scene, {.rays_at_once = 8192});
  expect_same(scene, camera, looking({0.1, 0.2, 6}, {0, 0, -1}), "at one depth");
  EXPECT_GT(camera.tied(), 100U);
  // Far apart, no ray is traced a second time.
  const Scene alone = touching("voxel-bricks", 1);
  VoxelCamera other(device(), alone, {.rays_at_once = 8192});
  expect_same(alone, other, looking({0.3, 0.7, 6}, {0.02, 0.01, -1}, 0.002), "one face");
  EXPECT_LT(other.tied(), 100U);
}

// A batch of camera rays in any order, mixed with other rays, has the CPU's answers; camera rays are answered by
// drawing.
TEST_F(VoxelCameraOnDevice, FindsCameraRaysInBatches) {
  const Scene scene = crowd();
  const auto sight = std::make_shared<VoxelSight>(VoxelSight{VoxelDrawing::proxies});
  const Scene there = scene_on(device(), scene, sight);
  std::mt19937_64 engine(7);
  for (const VoxelPicture& picture :
       {looking({5.1, -4.3, 6.7}, {-5, 4, -6}), along({4, 5, 6}, {-1, -1.2, -1.4}, 0.05)}) {
    sight->picture = picture;
    sight->drawn = 0;
    std::vector<Ray> rays = rays_of(picture, 0.45);
    if (!picture.parallel()) {
      for (Ray& ray : rays) ray.direction = normalize(ray.direction);
    }
    const std::size_t of_camera = rays.size();
    // Second rays of pixels: the same ray, a ray that starts elsewhere, and a ray that points behind the camera.
    for (std::size_t i = 0; i < of_camera; i += 7) {
      rays.push_back(rays[i]);
      if (i % 3 == 1) rays.back().origin += 0.1;
      if (i % 3 == 2) rays.back().direction = -rays.back().direction;
    }
    std::shuffle(rays.begin(), rays.end(), engine);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    scene.closest_hits(rays, expected);
    there.closest_hits(rays, hits);
    EXPECT_EQ(sight->drawn, of_camera);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      wrong += !(hits[i].status == expected[i].status && hits[i].voxel == expected[i].voxel &&
                 hits[i].part == expected[i].part && hits[i].face == expected[i].face &&
                 (!expected[i] || hits[i].t == expected[i].t));
    EXPECT_EQ(wrong, 0U);
  }
  // Few rays are not worth drawing.
  sight->drawn = 0;
  const std::vector<Ray> all = rays_of(sight->picture);
  const std::vector<Ray> corners{all.front(), all.back()};
  std::vector<Hit> hits(2);
  there.closest_hits(corners, hits);
  EXPECT_EQ(sight->drawn, 0U);
}

TEST_F(VoxelCameraOnDevice, RejectsUnsupportedScenes) {
  const Scene scene = touching("voxel-planes");
  VoxelCamera camera(device(), scene, {.rays_at_once = 1024});
  VoxelPicture flat = looking({0, 0, 9}, {0, 0, -1});
  flat.down = flat.right;
  std::vector<Ray> rays = rays_of(flat);
  std::vector<Hit> hits(rays.size());
  EXPECT_EQ(refusal([&] { camera.look(VoxelDrawing::proxies, flat, rays, hits); }),
            "voxels: a picture whose rays do not span space");
  EXPECT_NE(refusal([&] { VoxelCamera none(device(), touching("voxel-exhaustive")); }).find("voxel-exhaustive"),
            std::string::npos);
}

TEST(VoxelDepth, DecreasesWithDistance) {
  using glsl::scarp_depth_bits;
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> exponent(-70, 70), step(-60, -1);
  for (int i = 0; i < 100'000; ++i) {
    const double near = std::exp2(exponent(engine)), far = near * (1 + std::exp2(step(engine)));
    const std::uint32_t a = scarp_depth_bits(near), b = scarp_depth_bits(far);
    ASSERT_GE(a, b) << near;
    if (!glsl::scarp_depth_is_coarse(near) && far > near * (1 + 0x1p-22)) {
      ASSERT_GT(a, b) << near;
    }
    if (a == b && !glsl::scarp_depth_is_coarse(near)) {
      ASSERT_LE(glsl::scarp_least_of_depth(near), near);
      ASSERT_GE(glsl::scarp_largest_of_depth(near), far);
    }
    const float depth = std::bit_cast<float>(a);
    ASSERT_TRUE(std::isnormal(depth) && depth < 1) << near;
  }
  EXPECT_EQ(scarp_depth_bits(0), 0x3f7fffffU);
  EXPECT_EQ(scarp_depth_bits(-1), 0x3f7fffffU);
}

}  // namespace
}  // namespace scarp::test
