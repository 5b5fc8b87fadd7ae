// SPDX-License-Identifier: MIT
// Vectors return the answers of the scalar walk, bit for bit: over every kind of field and ray of the oracle's suite,
// on every instruction set that this machine has, in batches of odd sizes, with each optimisation disabled.
#include "scarp/march/height/max_mip_simd.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "march/instruction_sets.h"
#include "scarp/march/height/max_mip.h"

namespace scarp::test {
namespace {

const int kRaysPerPair = cases(10'000, 2000, 16);
const int kUsualRays = cases(3000, 1000, 100);
const int kRaysPerSet = cases(3000, 1000, 25);
const int kCameras = cases(60, 15, 1);
const int kFans = cases(120, 30, 1);
const std::size_t kBatchSizes = static_cast<std::size_t>(cases(3, 3, 1));
// Every 17th ray in builds with sanitizers, to find out-of-bounds accesses of a group of rays.
const std::size_t kUnusualStride = static_cast<std::size_t>(cases(1, 1, 17));
#ifdef NDEBUG
constexpr int kNodesApart = 1;
constexpr bool kAllTypes = true;
#else
constexpr int kNodesApart = 6;
constexpr bool kAllTypes = false;  // of samples with each kind of ground and surface
#endif
constexpr int kRaysPerField = 500;

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

testing::AssertionResult identical(const Hit& a, const Hit& b) {
  if (a.status == b.status && bits(a.t) == bits(b.t) &&
      (!a || (a.cell == b.cell && a.u == b.u && a.v == b.v && a.height == b.height && a.wall == b.wall))) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << std::hexfloat << "status " << int(a.status) << ", " << int(b.status) << ", t "
                                     << a.t << ", " << b.t << ", cell " << a.cell.col << " " << a.cell.row << ", "
                                     << b.cell.col << " " << b.cell.row;
}

// The whole batch, in parts of `size`.
void compare(const HeightTarget& target, const std::vector<Ray>& rays, const std::vector<Hit>& expected,
             std::size_t size, const VectorOptions& options, const std::string& what) {
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size(), 7);
  for (std::size_t begin = 0; begin < rays.size(); begin += size) {
    const std::size_t count = std::min(size, rays.size() - begin);
    const std::span<const Ray> part(rays.data() + begin, count);
    closest_hits_max_mip_simd(target, part, {hits.data() + begin, count}, options);
    occluded_max_mip_simd(target, part, {blocked.data() + begin, count}, options);
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(identical(hits[i], expected[i])) << what << ", ray " << i;
    ASSERT_EQ(blocked[i], expected[i] ? 1 : 0) << what << ", ray " << i;
  }
}

std::vector<Hit> scalar(const HeightTarget& target, const std::vector<Ray>& rays) {
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back(march_max_mip(target, ray));
  return hits;
}

TEST(MaxMipSimd, MatchesTheScalarWalkBitForBit) {
  Random random(71);
  for (const FieldKind& fields : spiteful_fields()) {
    for (int part = 0; part < kRaysPerPair; part += kRaysPerField) {
      const HeightField field = fields.make(random);
      const MaxPyramid pyramid(field);
      const HeightTarget target{&field, &pyramid};
      std::vector<Ray> rays;
      for (const RayKind& kind : spiteful_rays()) {
        if ((fields.has & kind.aims_at) != kind.aims_at) continue;
        for (int i = 0; i < std::min(kRaysPerField, kRaysPerPair); ++i) rays.push_back(kind.make(field, random));
      }
      const std::vector<Hit> expected = scalar(target, rays);
      compare(target, rays, expected, rays.size(), {}, std::string(fields.name));
      if (HasFatalFailure()) return;
    }
  }
}

// A field that is large enough for long walks, steep and gentle, as floats and as integers, with holes or without.
enum class Kind { plain, holes, endless };
template <class T>
HeightField hills(Surface surface, Kind kind, Random& random) {
  const int cols = 413, rows = 270;
  std::vector<T> samples;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double z = 400 + 90 * std::sin(0.03 * col) * std::cos(0.041 * row) + 12 * std::sin(0.31 * col + 0.2 * row) +
                       uniform(random, 0, 3);
      samples.push_back(static_cast<T>(kind == Kind::holes && uniform(random, 0, 1) < 0.002 ? 0 : z));
    }
  }
  HeightFieldSettings settings{.surface = surface};
  if (kind == Kind::holes) settings.nodata = 0;
  if (kind == Kind::endless) settings.wrap = Wrap::periodic;
  return HeightField::own(std::move(samples), cols, rows, settings);
}

// Like renderers without rays from the surface: offset by less than the margin of floats, a quarter of a code.
constexpr double kSetOff = 1e-4;  // metres
Ray next_to_the_ground(const Ray& on_surface) {
  Ray ray = on_surface;
  ray.origin.z += kSetOff;
  ray.start = RayStart::free;
  return ray;
}

// Typical rays of renderers: from a camera, from the surface to a sun and from just off it, and between random
// positions.
std::vector<Ray> usual_rays(const HeightTarget& target, Random& random, int count = kUsualRays) {
  const HeightField& field = *target.field;
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray ray;
    const double beside = field.wraps() ? 3000 : 50;
    ray.origin = {uniform(random, -beside, field.width() + beside), uniform(random, -beside, field.depth() + beside),
                  uniform(random, 350, 600)};
    ray.direction = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -0.8, 0.2)};
    if (field.wraps()) ray.t_max = uniform(random, 500, 5000);
    if (i % 7 == 0) ray.t_max = uniform(random, 0, 300);
    if (i % 11 == 0) ray.t_min = uniform(random, 0, 50);
    rays.push_back(ray);
    const Hit hit = march_max_mip(target, ray);
    if (!hit || hit.wall) continue;
    Ray on = ray;
    on.origin = ray.at(hit.t);
    on.direction = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -0.1, 0.6)};
    on.t_min = 0, on.t_max = i % 5 == 0 ? uniform(random, 0, 100) : field.wraps() ? 2000 : HUGE_VAL;
    on.start = RayStart::on_surface, on.start_cell = hit.cell;
    rays.push_back(on);
    rays.push_back(next_to_the_ground(on));
  }
  return rays;
}

TEST(MaxMipSimd, MatchesForEveryInstructionSetBatchSizeAndStrategy) {
  Random random(72);
  const std::vector<std::int64_t> sets = instruction_sets();
  ASSERT_FALSE(sets.empty());
  for (const Kind kind : {Kind::plain, Kind::holes, Kind::endless}) {
    for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
      for (int type = 0; type < 3; ++type) {
        if (!kAllTypes && type != (static_cast<int>(kind) + static_cast<int>(surface)) % 3) continue;
        const HeightField field = type == 0   ? hills<float>(surface, kind, random)
                                  : type == 1 ? hills<std::int16_t>(surface, kind, random)
                                              : hills<std::uint16_t>(surface, kind, random);
        const MaxPyramid pyramid(field);
        const HeightTarget target{&field, &pyramid};
        const std::vector<Ray> rays = usual_rays(target, random, kRaysPerSet);
        const std::vector<Hit> expected = scalar(target, rays);
        for (const std::int64_t set : sets) {
          const InstructionSet only(set);
          const std::string name = hwy::TargetName(set);
          for (const std::size_t size :
               {std::size_t{1}, std::size_t{7}, std::size_t{16}, std::size_t{33}, rays.size()}) {
            compare(target, rays, expected, size, {}, name + ", batches of " + std::to_string(size));
          }
          compare(target, rays, expected, rays.size(), {.refill = false}, name + ", no refill");
          compare(target, rays, expected, rays.size(), {.wait = false}, name + ", no waiting");
          compare(target, rays, expected, rays.size(), {.doubles = false}, name + ", no doubles");
          compare(target, rays, expected, rays.size(), {.put_off = false}, name + ", nothing put off");
          compare(target, rays, expected, rays.size(), {.find_hits = false}, name + ", no hits found");
          compare(target, rays, expected, rays.size(), {.beam = false}, name + ", no beam");
          compare(target, rays, expected, rays.size(), {.together = false}, name + ", not together");
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

// More levels than a vector has lanes.
TEST(MaxMipSimd, HandlesVeryLongFields) {
  const int cols = 131'073, rows = 3, wall = 100'000;
  std::vector<float> samples(std::size_t{cols} * rows, 0.f);
  for (int row = 0; row < rows; ++row) samples[static_cast<std::size_t>(row) * cols + wall] = 100;
  const HeightField field = HeightField::own(std::move(samples), cols, rows);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  Ray along, slanted, away;
  along.origin = slanted.origin = {-1, 0.5, 50}, away.origin = {3, 0.5, 50};
  along.direction = {1, 0, 0}, slanted.direction = {1, 1e-5, 0}, away.direction = {-1, 0, 0};
  const std::vector<Ray> rays{along, away, slanted};
  const std::vector<Hit> expected = scalar(target, rays);
  ASSERT_EQ(expected[0].t, wall + 0.5);
  for (const std::int64_t set : instruction_sets()) {
    const InstructionSet only(set);
    compare(target, rays, expected, rays.size(), {}, hwy::TargetName(set));
  }
}

// Starts outside their stated cell, far outside or by less than a millionth of a cell: over ground above and below 0,
// because a wrong start looks right if 0 is below the ground.
TEST(MaxMipSimd, HandlesStartsOutsideTheirCell) {
  Random random(76);
  for (const double base : {-100.0, 100.0}) {
    const int side = 65;
    std::vector<float> samples;
    for (int i = 0; i < side * side; ++i) samples.push_back(static_cast<float>(base + uniform(random, 0, 40)));
    const HeightField field = HeightField::own(std::move(samples), side, side);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    std::vector<Ray> rays;
    for (int i = 0; i < 20 * kUsualRays; ++i) {
      const auto aside = [&] {
        return uniform(random, -1, 1) * std::ldexp(1.0, -static_cast<int>(uniform(random, 16, 46)));
      };
      const int col = static_cast<int>(uniform(random, 1, side - 2)),
                row = static_cast<int>(uniform(random, 1, side - 2));
      const double x = col + aside(), y = side - 1 - (row + (i % 4 ? aside() : uniform(random, -0.5, 0.5)));
      Ray ray;
      ray.origin = {x, y, *field.height(x, y)};
      const double turn = uniform(random, 0, 6.3), slope = std::exp2(uniform(random, -3, 20));
      ray.direction = {std::cos(turn), std::sin(turn), i % 2 ? slope : -slope};
      ray.start = RayStart::on_surface;
      ray.start_cell = {col - i / 2 % 2, row - i / 4 % 2};
      rays.push_back(ray);
    }
    compare(target, rays, scalar(target, rays), rays.size(), {}, "base " + std::to_string(base));
  }
}

// Nearly level rays through the highest node: within rounding, they are as high as this node long before they reach it.
TEST(MaxMipSimd, TouchesTheHighestSample) {
  Random random(77);
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    const int side = 17;
    std::vector<float> samples(side * side, 0.f);
    samples[8 * side + 8] = 100;
    const HeightField field = HeightField::own(std::move(samples), side, side, {.surface = surface});
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    std::vector<Ray> rays;
    for (int i = 0; i < 5 * kUsualRays; ++i) {
      const double turn = uniform(random, 0, 1.5707), slope = std::exp2(-uniform(random, 30, 46));
      Ray ray;
      ray.direction = {std::cos(turn), std::sin(turn), i % 2 ? slope : -slope};
      ray.origin = dvec3{8, 8, 100} - uniform(random, 10, 20) * ray.direction;
      rays.push_back(ray);
    }
    compare(target, rays, scalar(target, rays), rays.size(), {}, "touches");
  }
}

// A shadow map's rays: from nodes, points of edges and others, slightly above the ground or in it, along diagonals,
// axes and other directions, over ground that is rough from sample to sample: parabolas that dip between the ends of a
// cell.
TEST(MaxMipSimd, StartsJustAboveRoughGround) {
  Random random(79);
  for (const double relief : {0.5, 40.0, 4000.0}) {
    const int side = 65;
    std::vector<float> samples;
    for (int i = 0; i < side * side; ++i) samples.push_back(static_cast<float>(uniform(random, 0, relief)));
    const HeightField field = HeightField::own(std::move(samples), side, side);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    std::vector<Ray> rays;
    for (int i = 0; i < 10 * kUsualRays; ++i) {
      const auto along = [&](int axis) {
        const double node = std::floor(uniform(random, 0, side));
        return i / (axis + 1) % 3 == 0 ? std::min(node + uniform(random, 0, 1), side - 1.0) : node;
      };
      Ray ray;
      const double x = along(0), y = along(1);
      const double lift = relief * std::exp2(-uniform(random, 1, 55));
      ray.origin = {x, y, *field.height(x, y) + (i % 7 == 0 ? -lift : lift)};
      const double turn =
          i % 3 == 2 ? uniform(random, 0, 6.3) : std::floor(uniform(random, 0, 8)) * (std::numbers::pi / 4);
      const auto exact = [&](double v) { return i % 3 == 1 ? std::round(v) : v; };  // -1, 0, 1
      ray.direction = {exact(std::cos(turn)), exact(std::sin(turn)),
                       relief * uniform(random, -1, 1) * uniform(random, 0, 1)};
      rays.push_back(ray);
    }
    const std::vector<Hit> expected = scalar(target, rays);
    for (const std::int64_t set : instruction_sets()) {
      const InstructionSet only(set);
      compare(target, rays, expected, rays.size(), {}, "relief " + std::to_string(relief));
    }
  }
}

// Rays that start within float precision in front of a line, cross it late or never, and climb with the ground.
TEST(MaxMipSimd, StartsJustBeforeAGridLine) {
  const int side = 17;
  std::vector<float> samples;
  for (int i = 0; i < side * side; ++i) samples.push_back(static_cast<float>(side - 1 - i / side));
  const HeightField field = HeightField::own(std::move(samples), side, side);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  Random random(81);
  std::vector<Ray> rays;
  for (int i = 0; i < 4 * kUsualRays; ++i) {
    const double x = 5 - std::exp2(-uniform(random, 20, 50)), y = 5 + uniform(random, 0, 1);
    Ray ray;
    ray.origin = {x, y, y + std::exp2(-uniform(random, 10, 30))};
    ray.direction = {i % 2 ? 0 : std::exp2(-uniform(random, 10, 40)), 1, 1 + uniform(random, -0.1, 1)};
    rays.push_back(ray);
  }
  const std::vector<Hit> expected = scalar(target, rays);
  for (const std::int64_t set : instruction_sets()) {
    const InstructionSet only(set);
    compare(target, rays, expected, rays.size(), {}, hwy::TargetName(set));
  }
}

// A shadow map's rays: from nodes to a sun in the north-west, or in the south.
TEST(MaxMipSimd, HandlesRaysFromNodesInVectors) {
  Random random(80);
  const HeightField field = hills<float>(Surface::bilinear, Kind::plain, random);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  for (const dvec2 to_sun : {dvec2(-1, 1), dvec2(0, -1)}) {
    std::vector<Ray> rays;
    for (int row = 1; row + 1 < field.rows(); row += kNodesApart) {
      for (int col = 1; col + 1 < field.cols(); col += kNodesApart) {
        const dvec3 node = field.world_from_grid(col, row, 0);
        Ray ray;
        ray.origin = {node.x, node.y, *field.height(node.x, node.y) + kSetOff};
        ray.direction = {to_sun, 0.36 * length(to_sun)};
        rays.push_back(ray);
      }
    }
    compare(target, rays, scalar(target, rays), rays.size(), {}, "nodes");
    take_vector_stats();
    std::vector<std::uint8_t> blocked(rays.size());
    occluded_max_mip_simd(target, rays, blocked, {});
    EXPECT_LT(take_vector_stats().handed_over, rays.size() / 10) << to_sun.x << " " << to_sun.y;
  }
}

// Preparing vectors takes longer than the walk of a ray over one cell: such rays are traced one by one, in place.
TEST(MaxMipSimd, TracesRaysOverOneCellAlone) {
  Random random(76);
  const HeightField field = hills<float>(Surface::bilinear, Kind::plain, random);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  std::vector<Ray> feet, mixed;
  for (int i = 0; i < 500; ++i) {
    const double x = uniform(random, 1, field.width() - 1), y = uniform(random, 1, field.depth() - 1);
    const double cell = field.settings().cell_x;
    const dvec3 knee(x, y, field.height(x, y).value() + 0.5);
    feet.push_back({.origin = knee, .direction = {i % 2 ? 0.0 : 0.2 * cell, 0, -1}, .t_max = 2});
    mixed.push_back(feet.back());
    if (i % 3) mixed.push_back({.origin = knee, .direction = {20 * cell, 1, -1}, .t_max = 5});
  }
  take_vector_stats();
  compare(target, feet, scalar(target, feet), feet.size(), {}, "feet");
  EXPECT_EQ(take_vector_stats().block_steps, 0);
  compare(target, mixed, scalar(target, mixed), mixed.size(), {}, "mixed");
  EXPECT_GT(take_vector_stats().block_steps, 0);
}

TEST(MaxMipSimd, HandlesRaysFromNearTheGroundInVectors) {
  Random random(75);
  const HeightField field = hills<float>(Surface::bilinear, Kind::plain, random);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  std::vector<Ray> rays;
  for (const Ray& ray : usual_rays(target, random)) {
    if (ray.start == RayStart::on_surface) rays.push_back(next_to_the_ground(ray));
  }
  std::vector<std::uint8_t> blocked(rays.size());
  std::vector<Hit> hits(rays.size());
  const auto handed_over = [&](const VectorOptions& options) {
    take_vector_stats();
    occluded_max_mip_simd(target, rays, blocked, options);
    closest_hits_max_mip_simd(target, rays, hits, options);
    return static_cast<double>(take_vector_stats().handed_over) / static_cast<double>(rays.size());
  };
  // Counts cover two queries of each ray. Rays that hit in the first cell are left to the scalar walk.
  const double in_floats = handed_over({.doubles = false}), in_doubles = handed_over({});
  EXPECT_GT(in_floats, 1.0);
  EXPECT_LT(in_doubles, in_floats / 2);
}

// Vectors traverse copies of a wrapped field, and hit ground on their seams: rays along seams, through corners of
// copies, and far away, where the scalar walk takes over.
TEST(MaxMipSimd, HandlesWrappedFields) {
  Random random(78);
  const HeightField field = hills<float>(Surface::bilinear, Kind::endless, random);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  std::vector<Ray> rays;
  for (int i = 0; i < 20 * kUsualRays; ++i) {
    const double far = i % 50 == 0 ? std::exp2(uniform(random, 15, 30)) : 4;
    const auto whole = [&](double size) { return size * std::floor(uniform(random, -far, far)); };
    const dvec3 corner = {whole(field.width()), whole(field.depth()), uniform(random, 300, 520)};
    Ray ray;
    const double turn = i % 3 ? uniform(random, 0, 6.3) : std::floor(uniform(random, 0, 4)) * 1.5707963267948966;
    ray.direction = {std::cos(turn), std::sin(turn), uniform(random, -0.3, 0.05)};
    if (i % 3 == 0) ray.direction.x = std::round(ray.direction.x), ray.direction.y = std::round(ray.direction.y);
    ray.origin = corner - std::round(uniform(random, 0, 600)) * ray.direction;
    ray.t_max = uniform(random, 100, 3000);
    rays.push_back(ray);
  }
  take_vector_stats();
  compare(target, rays, scalar(target, rays), rays.size(), {}, "seams");
  const VectorStats stats = take_vector_stats();
  EXPECT_GT(stats.block_steps, rays.size());
  // Counts cover two queries of each ray: rays along an axis and next to corners are in doubt.
  EXPECT_LT(stats.handed_over, rays.size());
}

// Rays that fall or climb so steeply that they hit in front of a seam when a rounded position is already behind it: the
// ray below passes through the ground at t = 7.75 and reaches the seam at t = 8. Also rays at u = -0, which equals 0
// and stays -0.
TEST(MaxMipSimd, StartsNextToASeam) {
  Random random(79);
  const int side = 128;
  std::vector<std::int16_t> samples(std::size_t{side} * side, 15);
  samples[static_cast<std::size_t>(8) * side + 8] = 0;
  const HeightField field = HeightField::own(std::move(samples), side, side, {.wrap = Wrap::periodic});
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  std::vector<Ray> rays(1);
  rays[0].origin = {-64 * side - 0x1p-37, 5.5, 15 + 7.75 * 0x1p-12};
  rays[0].direction = {0x1p-40, 0, -0x1p-12};
  rays[0].t_min = 7.5, rays[0].t_max = 7.9;
  ASSERT_EQ(march_max_mip(target, rays[0]).t, 7.75);
  for (int i = 0; i < 10 * kUsualRays; ++i) {
    Ray ray;
    const double seam = side * std::floor(uniform(random, -200, 200)), t = uniform(random, 1, 1000);
    const double speed = std::exp2(-uniform(random, 30, 60)) * (i % 2 ? 1 : -1);
    ray.direction = {speed, 0, std::exp2(-uniform(random, 8, 30)) * (i % 3 ? -1 : 1)};
    ray.origin = {seam - speed * t, std::floor(uniform(random, 0, 100)) + 0.5, 0};
    ray.t_min = t * uniform(random, 0.9, 1.0001), ray.t_max = t * uniform(random, 1, 1.2);
    ray.origin.z = 15 - ray.direction.z * uniform(random, 0.9, 1.2) * t;
    rays.push_back(ray);
  }
  compare(target, rays, scalar(target, rays), rays.size(), {}, "seam");

  std::vector<float> level(std::size_t{9} * 9, 1.f);
  level.front() = level.back() = 2;
  const HeightField plain = HeightField::own(std::move(level), 9, 9);
  const MaxPyramid plain_pyramid(plain);
  const HeightTarget plain_target{&plain, &plain_pyramid};
  Ray at_border;
  at_border.origin = {-0.0, 3.5, 1}, at_border.direction = {-1, 1, -0.5}, at_border.t_min = -0.5, at_border.t_max = 1;
  Hit hit;
  closest_hits_max_mip_simd(plain_target, {&at_border, 1}, {&hit, 1});
  ASSERT_TRUE(hit);
  EXPECT_EQ(bits(hit.u), bits(march_max_mip(plain_target, at_border).u));
}

// Rays of a camera that looks down at the field, in blocks of 8 x 8 pixels.
std::vector<Ray> tiles_of_a_camera(const HeightField& field, Random& random) {
  const dvec3 eye{uniform(random, -200, field.width() + 200), uniform(random, -200, field.depth() + 200),
                  uniform(random, 300, 900)};
  const dvec3 to{uniform(random, 0, field.width()), uniform(random, 0, field.depth()), 300};
  const double azimuth = std::atan2(to.y - eye.y, to.x - eye.x);
  const double fall = (eye.z - to.z) / std::hypot(to.x - eye.x, to.y - eye.y);
  std::vector<Ray> rays;
  for (int tile = 0; tile < 16; ++tile) {
    for (int pixel = 0; pixel < 64; ++pixel) {
      const double right = 0.01 * (tile % 4 * 8 + pixel % 8 - 16), up = 0.01 * (tile / 4 * 8 + pixel / 8 - 16);
      Ray ray;
      ray.origin = eye;
      ray.direction = {std::cos(azimuth) - right * std::sin(azimuth), std::sin(azimuth) + right * std::cos(azimuth),
                       up - fall};
      rays.push_back(ray);
    }
  }
  return rays;
}

TEST(MaxMipSimd, BeamsLoseNoHits) {
  Random random(74);
  std::map<std::string, std::uint64_t> in_beams;
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    const HeightField field = hills<float>(surface, Kind::plain, random);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    for (int camera = 0; camera < kCameras; ++camera) {
      const std::vector<Ray> rays = tiles_of_a_camera(field, random);
      const std::vector<Hit> expected = scalar(target, rays);
      for (const std::int64_t set : instruction_sets()) {
        const InstructionSet only(set);
        const std::string name = hwy::TargetName(set);
        take_vector_stats();
        compare(target, rays, expected, rays.size(), {}, name);
        in_beams[name] += take_vector_stats().beam_rays;
        if (HasFatalFailure()) return;
      }
    }
  }
  // Otherwise there would have been no hits to lose.
  for (const auto& [name, rays] : in_beams) EXPECT_GT(rays, 0u) << name;
}

// Fans of rays from one point: through nodes and along lines of cells, parallel to an axis, almost so, across it and
// across the border, narrow and wide, with other rays in between, with finite ends, from points over rough and smooth
// ground.
std::vector<Ray> fans(const HeightField& field, Random& random) {
  std::vector<Ray> rays;
  const auto pick = [&](double low, double high) {
    const double at = uniform(random, low, high);
    return uniform(random, 0, 1) < 0.5 ? std::floor(at) : at;
  };
  for (int fan = 0; fan < 24; ++fan) {
    const double beside = fan % 8 == 7 ? 3 : 0;
    dvec3 eye{pick(-beside, field.width() + beside), pick(-beside, field.depth() + beside), 0};
    eye.z = field.height(eye.x, eye.y).value_or(400) + std::exp2(uniform(random, -20, 6));
    // Level rays slightly below a peak: only an exact maximum stops them.
    const bool level = fan % 8 == 5;
    dvec3 peak = eye;
    if (level) {
      const double from_x = std::floor(uniform(random, 9, field.width() - 9)),
                   from_y = std::floor(uniform(random, 9, field.depth() - 9));
      peak = {from_x, from_y, 0};
      for (int i = 0; i < 81; ++i) {
        const dvec2 at{from_x + i % 9, from_y + i / 9};
        const double z = *field.height(at.x, at.y);
        if (z > peak.z) peak = {at.x, at.y, z};
      }
      eye = {peak.x + uniform(random, -4, 4), peak.y + uniform(random, -4, 4), peak.z};
      eye.z -= std::exp2(-uniform(random, 6, 20));
    }
    const double azimuth = fan % 3 == 0 ? std::floor(uniform(random, 0, 8)) * (std::numbers::pi / 4)
                                        : uniform(random, 0, 2 * std::numbers::pi);
    const double wide = std::exp2(-uniform(random, 0, fan % 2 ? 6 : 40)), slope = uniform(random, -0.5, 0.2);
    const double high = std::exp2(-uniform(random, 2, 20));
    const double node = std::floor(uniform(random, 2, 60));
    for (int i = 0; i < 64 + fan % 3; ++i) {
      Ray ray;
      ray.origin = eye;
      const double turn = azimuth + wide * (i % 8) / 8;
      ray.direction = {std::cos(turn), std::sin(turn), slope + high * (i / 8)};
      if (fan % 4 == 1) {  // through nodes
        ray.direction.x = std::floor(eye.x + node * std::cos(azimuth)) + i % 8 - eye.x;
        ray.direction.y = std::floor(eye.y + node * std::sin(azimuth)) + (i / 8) % 3 - eye.y;
        ray.direction.z *= node;
      } else if (fan % 4 == 2 && i % 2 == 0) {  // along a line
        ray.direction.x = std::round(ray.direction.x), ray.direction.y = std::round(ray.direction.y);
      }
      if (level) ray.direction = {peak.x - eye.x + 1e-3 * (i % 8), peak.y - eye.y + 1e-3 * (i / 8), 0};
      if (length(dvec2(ray.direction.x, ray.direction.y)) == 0 || (fan % 5 == 0 && i % 13 == 0)) {
        ray.direction = {0, 0, -1};
      }
      if (fan % 5 == 1 && i % 7 == 0) ray.origin.x += uniform(random, -1, 1);
      if (fan % 6 == 2 && i % 3 == 0) ray.t_max = uniform(random, 0, 100);
      if (fan % 6 == 3 && i % 3 == 0) ray.t_min = uniform(random, -5, 20);
      rays.push_back(ray);
    }
  }
  return rays;
}

TEST(MaxMipSimd, CoherentRaysLoseNoHits) {
  Random random(82);
  std::map<std::string, std::uint64_t> together;
  for (const Kind kind : {Kind::plain, Kind::endless}) {
    for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
      const HeightField field = hills<float>(surface, kind, random);
      const MaxPyramid pyramid(field);
      const HeightTarget target{&field, &pyramid};
      for (int round = 0; round < kFans; ++round) {
        const std::vector<Ray> rays = fans(field, random);
        const std::vector<Hit> expected = scalar(target, rays);
        for (const std::int64_t set : instruction_sets()) {
          const InstructionSet only(set);
          const std::string name = hwy::TargetName(set);
          take_vector_stats();
          const std::array sizes{std::size_t{65}, rays.size(), std::size_t{5}};
          for (const std::size_t size : std::span(sizes).first(kBatchSizes)) {
            compare(target, rays, expected, size, {}, name + ", fans in batches of " + std::to_string(size));
          }
          together[name] += take_vector_stats().together_rays;
          if (HasFatalFailure()) return;
        }
      }
    }
  }
  for (const auto& [name, rays] : together) EXPECT_GT(rays, 10'000u * kFans / 120) << name;
}

// Each ray is among rays that come down from outside, which form beams.
TEST(MaxMipSimd, HandlesUnusualNumbers) {
  const HeightField field = test::hills(129, 65, Surface::bilinear);
  const MaxPyramid pyramid(field);
  std::vector<Ray> rays;
  std::vector<Ray> unusual = rays_of_unusual_numbers(field);
  for (const double z : {field.max_height(), std::numeric_limits<double>::quiet_NaN()}) {
    unusual.push_back({.origin = {-50, 30, z}, .direction = {1, 0.01, -0.2}});
  }
  for (std::size_t i = 0; i < unusual.size(); i += kUnusualStride) {
    for (std::size_t j = 0; j < 64; ++j) {
      const double side = static_cast<double>(j) * 0.1;
      rays.push_back(j == i % 64
                         ? unusual[i]
                         : Ray{.origin = {-50, 28 + side, field.max_height() + 9}, .direction = {1, 0.01, -0.2}});
    }
  }
  const HeightTarget target{&field, &pyramid};
  const std::vector<Hit> expected = scalar(target, rays);
  for (const std::int64_t set : instruction_sets()) {
    const InstructionSet only(set);
    compare(target, rays, expected, 64, {}, hwy::TargetName(set));
    if (HasFatalFailure()) return;
  }
}

// Otherwise the vectors could hand over all rays to the scalar walk and still be right.
TEST(MaxMipSimd, HandsOverFewRays) {
  Random random(73);
  const HeightField field = hills<float>(Surface::bilinear, Kind::plain, random);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const std::vector<Ray> rays = usual_rays(target, random);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  take_vector_stats();
  occluded_max_mip_simd(target, rays, blocked);
  const VectorStats any = take_vector_stats();
  EXPECT_LT(any.handed_over, rays.size() / 5);
  EXPECT_GT(any.block_lanes, rays.size());
  closest_hits_max_mip_simd(target, rays, hits);
  EXPECT_LT(take_vector_stats().handed_over, rays.size() / 2);
}

// Nor do they hand over many rays that end in their first cell, which floats can decide on gentle ground.
TEST(MaxMipSimd, HandsOverFewRaysThatEndInTheirFirstCell) {
  Random random(74);
  constexpr int kSide = 33;
  std::vector<float> samples(kSide * kSide);
  for (float& sample : samples) sample = static_cast<float>(uniform(random, 0, 0.5));
  const HeightField field = HeightField::own(std::move(samples), kSide, kSide);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  std::vector<Ray> rays(4096);
  for (Ray& ray : rays) {
    const double x = uniform(random, 1, kSide - 2), y = uniform(random, 1, kSide - 2);
    ray.origin = {x, y, *field.height(x, y) + 0.1};
    ray.direction = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 0, 1)};
    ray.t_max = uniform(random, 0, 0.5);
  }
  std::vector<std::uint8_t> blocked(rays.size());
  take_vector_stats();
  occluded_max_mip_simd(target, rays, blocked);
  EXPECT_LT(take_vector_stats().handed_over, rays.size() / 5);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(blocked[i] != 0, occluded_max_mip(target, rays[i])) << i;
}

}  // namespace
}  // namespace scarp::test
