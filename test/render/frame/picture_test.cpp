// SPDX-License-Identifier: MIT
#include "scarp/render/frame/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numeric>
#include <vector>

#include "cases.h"
#include "render/map.h"
#include "render/terrain.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/plinth.h"

namespace scarp {
namespace {

using test::map_of;
using test::map_settings;
using test::red;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// side x side nodes, 1 m apart, at `ground` metres, to be changed by `edit(samples, side)`.
template <class F>
HeightField field_of(int side, float ground, F&& edit) {
  std::vector<float> samples(static_cast<std::size_t>(side * side), ground);
  edit(samples, side);
  return HeightField::own(std::move(samples), side, side);
}
void nothing(std::vector<float>&, int) {}

// The two rows of pixels next to the middle of that map. Row 1 is row 100 of 200, the lower of the two.
Image middle_of(const HeightField& field, PictureSettings settings, double grid_north = 0) {
  constexpr int kRows = 2;
  const Scene scene = test::terrain(field);
  WorldBox box = picture_box(scene);
  const double middle = box.middle().y, half = (box.high.y - middle) * kRows / settings.height;
  box.low.y = middle - half, box.high.y = middle + half;
  settings.height = kRows;
  settings.grid_north_azimuth = grid_north;
  return render_picture(scene, Camera::top(box, settings.width, settings.height), settings).image;
}

// A wall 4 m high along column 10 of 21, its flanks one cell wide.
HeightField wall() {
  return field_of(21, 0, [](std::vector<float>& samples, int side) {
    for (int row = 0; row < side; ++row) samples[static_cast<std::size_t>(row * side + 10)] = 4;
  });
}

// Brightness of level ground at x, on the map of the wall with the sun in the west at 45 degrees.
int brightness_at(double x, double grid_north, bool shadows) {
  const HeightField field = wall();
  PictureSettings settings = map_settings(field);
  settings.ramp = "viridis";
  settings.sun = {270, 45};
  settings.shadows = shadows;
  return red(middle_of(field, settings, grid_north), static_cast<int>(10 * x), 1);
}

TEST(Picture, ShadowsHaveTheRightLength) {
  // 4 m at 45 degrees: the shadow of the crest at x = 10 ends at x = 14.
  const int lit = brightness_at(17, 0, true);
  EXPECT_LT(brightness_at(13.8, 0, true), 0.8 * lit);
  EXPECT_EQ(brightness_at(14.3, 0, true), lit);
  EXPECT_EQ(brightness_at(7, 0, true), lit) << "the side towards the sun";
  EXPECT_EQ(brightness_at(13.8, 0, false), lit) << "hill shade only";
}

TEST(Picture, SunAzimuthIsMeasuredFromTrueNorth) {
  // Up in the raster is true south, so true west is its east.
  const double upside_down = glm::radians(180.0);
  const int lit = brightness_at(3, upside_down, true);
  EXPECT_LT(brightness_at(6.2, upside_down, true), 0.8 * lit);
  EXPECT_EQ(brightness_at(13.8, upside_down, true), lit);
}

TEST(Picture, SunlitLevelGroundHasItsRampColour) {
  const HeightField field = field_of(5, 30, nothing);
  PictureSettings settings = map_settings(field);
  settings.ramp = "hypsometric";
  const Image image = map_of(field, settings).image;
  EXPECT_EQ(int{image.pixel(20, 20)[0]}, 0x78);
  EXPECT_EQ(int{image.pixel(20, 20)[1]}, 0x9b);
  EXPECT_EQ(int{image.pixel(20, 20)[2]}, 0x74);
}

TEST(Picture, LightSamplesDoNotChangeSunlitLevelGround) {
  const HeightField field = field_of(5, 30, nothing);
  PictureSettings settings = map_settings(field);
  settings.ramp = "hypsometric";
  settings.samples = 16;
  const Image image = map_of(field, settings).image;
  for (const auto& [x, y] : {std::pair(20, 20), {0, 0}, {39, 39}}) {
    // The mean cosine over the samples of the sun's disc is not quite that of its middle.
    EXPECT_NEAR(image.pixel(x, y)[0], 0x78, 1);
    EXPECT_NEAR(image.pixel(x, y)[1], 0x9b, 1);
    EXPECT_NEAR(image.pixel(x, y)[2], 0x74, 1);
  }
}

TEST(Picture, SamplesDependOnlyOnPixelAndSeed) {
  const HeightField field = wall();
  PictureSettings settings = map_settings(field);
  // Several tiles.
  settings.width = settings.height = test::cases(60, 60, 20);
  settings.aa = 2;
  settings.samples = 5;
  settings.sun.size_deg = 20;
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return map_of(field, settings).image.rgb;
  };
  const auto one = with_threads(1);
  EXPECT_EQ(with_threads(4), one);
  EXPECT_EQ(with_threads(0), one);
  settings.seed = 1;
  EXPECT_NE(with_threads(1), one);
}

TEST(Picture, SamplesOfAPixelUseDifferentPoints) {
  // Where half of a wide sun is visible, a single ray either hits it or misses it. With the same ray for all four
  // samples of a pixel, half of the pixels would be dark; with separate, well distributed rays, none is.
  const HeightField field = wall();
  PictureSettings settings = map_settings(field);
  settings.ramp = "viridis";
  settings.sun = {270, 45, 20};
  settings.aa = 2;
  settings.samples = 1;
  settings.ao_distance = 0;
  const Image image = map_of(field, settings).image;
  const int dark = red(image, 122, 100);
  int found_dark = 0;
  for (int y = 50; y < 150; ++y) found_dark += red(image, 140, y) == dark;
  EXPECT_LT(found_dark, 10);
}

TEST(Picture, OcclusionDarkensTheShadowedFootOfAWall) {
  const HeightField field = wall();
  PictureSettings settings = map_settings(field);
  settings.ramp = "viridis";
  settings.sun = {270, 45};
  settings.samples = 16;
  const auto row = [&] {
    std::vector<int> reds;
    const Image image = middle_of(field, settings);
    // Beyond x = 12 m the shading normal is upright, and before 13.9 m the shadow is whole.
    for (const double x : {12.2, 13.8, 19.0}) reds.push_back(red(image, static_cast<int>(10 * x), 1));
    return reds;
  };
  const auto with = row();
  settings.ao_distance = 0;
  const auto without = row();
  EXPECT_LT(with[0], with[1]);
  EXPECT_LT(with[1], without[1]);
  EXPECT_EQ(without[0], without[1]) << "without occlusion a shadow is even";
  EXPECT_LT(without[1], with[2]) << "level ground in the sun";
}

TEST(Picture, HolesShowTheSky) {
  const HeightField field = field_of(
      9, 30, [](std::vector<float>& samples, int side) { samples[static_cast<std::size_t>(4 * side + 4)] = kNaN; });
  const Image image = map_of(field, map_settings(field)).image;
  EXPECT_NE(red(image, 40, 40), red(image, 10, 10));
  // Outside the field, a wider picture shows the same sky.
  PictureSettings wide = map_settings(field);
  wide.width *= 2;
  const Image beside = map_of(field, wide).image;
  EXPECT_EQ(red(image, 40, 40), red(beside, 1, 40));
}

// The ramp grey is linear in height, for any slope, in the shadow of the wall as in the sun.
TEST(Picture, UnlitGroundKeepsItsColours) {
  const HeightField field = wall();
  for (const Look look : {Look::shaded, Look::comanche}) {
    PictureSettings settings = map_settings(field);
    settings.look = look;
    settings.comanche.scale = 1;
    settings.sun = {270, 20};
    settings.unlit = true;
    settings.samples = 4;
    const Image image = map_of(field, settings).image;
    for (int x = 0; x < settings.width; ++x) {
      const double height = 4 * std::max(0.0, 1 - std::abs((x + 0.5) / 10 - 10));
      EXPECT_NEAR(red(image, x, 55), 255 * height / 4, 1) << name_of(look) << " " << x;
    }
  }
}

TEST(Picture, UnlitWallsHaveOneColour) {
  const Scene scene = test::terrain_on_plinth(field_of(5, 30, nothing));
  PictureSettings settings;
  settings.width = settings.height = 64;
  settings.haze = 0;
  // Towards the edge between two walls, just below the ground.
  const Camera camera = Camera::look_at({9, -5, 29.99}, {4, 0, 29.99}, 1, 64, 64);
  settings.sun = {180, 30};
  const Image lit = render_picture(scene, camera, settings).image;
  settings.unlit = true;
  const Image unlit = render_picture(scene, camera, settings).image;
  EXPECT_NE(red(lit, 24, 36), red(lit, 40, 36));
  EXPECT_EQ(red(unlit, 24, 36), red(unlit, 40, 36));
  EXPECT_GT(red(unlit, 24, 36), red(lit, 40, 36));
}

TEST(Picture, HeightIsLinearAndMissesAreBlack) {
  // Ten steps from 100 m in the west to 110 m in the east, with a hole.
  const HeightField field = field_of(11, 0, [](std::vector<float>& samples, int side) {
    for (int i = 0; i < side * side; ++i) samples[static_cast<std::size_t>(i)] = static_cast<float>(100 + i % side);
    samples[60] = kNaN;
  });
  PictureSettings settings = map_settings(field);
  settings.look = Look::height;
  const Image image = map_of(field, settings).image;
  for (const int x : {0, 20, 77, 99}) EXPECT_NEAR(red(image, x, 5), 1 + 25.4 * (x + 0.5) / 10, 0.5001) << x;
  EXPECT_EQ(red(image, 50, 50), 0);
}

TEST(Picture, StepsCountWhatTheMarchReports) {
  const Scene scene = test::terrain(wall(), "max-mip");
  PictureSettings settings;
  settings.width = 40;
  settings.height = 30;
  settings.look = Look::steps;
  settings.ramp = "grey";
  const Camera camera = Camera::framed(picture_box(scene), {.azimuth_deg = 160}, 0, 40, 30);
  const Picture picture = render_picture(scene, camera, settings);
  ASSERT_TRUE(picture.steps);
  double sum = 0;
  std::uint32_t most = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      MarchStats stats;
      scene.closest_hit(camera.ray(x + 0.5, y + 0.5), nullptr, &stats);
      sum += stats.steps;
      if (stats.steps >= most) {
        most = stats.steps;
        EXPECT_EQ(red(picture.image, x, y) == 255, most == picture.steps->most);
      }
    }
  }
  EXPECT_EQ(picture.steps->most, most);
  EXPECT_EQ(picture.steps->least, 0u) << "rays beside the field";
  EXPECT_NEAR(picture.steps->mean, sum / (40 * 30), 1e-9);
  // On a fixed scale a number of steps has the same colour in all pictures.
  settings.step_scale = StepScale{0, 2.0 * most};
  const Picture scaled = render_picture(scene, camera, settings);
  EXPECT_EQ(scaled.steps->most, most);
  EXPECT_EQ(scaled.steps->scale.high, 2.0 * most);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) EXPECT_NEAR(red(scaled.image, x, y), red(picture.image, x, y) / 2.0, 1);
  }
  settings.step_scale = StepScale{5, 5};
  EXPECT_THROW(render_picture(scene, camera, settings), Error);
}

// One read per pixel of a picture of one ray.
std::uint32_t reads(const Scene& scene, const Camera& camera, int side) {
  PictureSettings settings;
  settings.width = settings.height = side;
  settings.look = Look::cost;
  const StepRange cost = render_picture(scene, camera, settings).cost.value();
  return static_cast<std::uint32_t>(std::lround(cost.mean * side * side));
}

TEST(CostLook, CountsWhatTheMarchReads) {
  constexpr int kSide = 9;
  const HeightField field = wall();
  // Straight down: each ray tests one cell, of four heights.
  const Camera top = Camera::top(picture_box(test::terrain(field)), kSide, kSide);
  EXPECT_EQ(reads(test::terrain(field), top, kSide), 4u * kSide * kSide);
  EXPECT_EQ(reads(test::terrain_on_plinth(field), top, kSide), 4u * kSide * kSide) << "walls do not count";
  const Camera aslant = Camera::look_at({-8, 9, 12}, {12, 11, 0}, 50, kSide, kSide);
  const auto steps = [](const Scene& scene, const Camera& camera) {
    PictureSettings settings;
    settings.width = settings.height = kSide;
    settings.look = Look::steps;
    const StepRange range = render_picture(scene, camera, settings).steps.value();
    return static_cast<std::uint32_t>(std::lround(range.mean * kSide * kSide));
  };
  // A step of these is a sample in a cell.
  for (const std::string_view march : {"naive", "relaxed", "exhaustive"}) {
    const Scene scene = test::terrain(field, march);
    EXPECT_EQ(reads(scene, aslant, kSide), 4 * steps(scene, aslant)) << march;
  }
  // With walls the same rays are marched: those that a wall hides are not.
  const Scene walled = test::terrain_on_plinth(field, "naive");
  const Camera low = Camera::framed(picture_box(walled), {.azimuth_deg = 200, .elevation_deg = 10}, 0, kSide, kSide);
  EXPECT_EQ(reads(walled, low, kSide), 4 * steps(walled, low));
  EXPECT_LT(steps(walled, low), steps(test::terrain(field, "naive"), low)) << "walls hide ground";
  // One of these is a block or a cell.
  for (const std::string_view march : {"max-mip", "max-mip-easy"}) {
    const Scene scene = test::terrain(field, march);
    EXPECT_GT(reads(scene, aslant, kSide), steps(scene, aslant)) << march;
    EXPECT_LT(reads(scene, aslant, kSide), 4 * steps(scene, aslant)) << march;
  }
  // Along a column of empty voxels to the floor.
  for (const auto& [march, most] : {std::pair{"voxel-planes", 7u}, {"voxel-cubes", 3u}}) {
    VoxelGrid grid({8, 8, 8}, 24);
    grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
      return v.z == 0 || v == ivec3(7) ? VoxelGrid::Voxel(0x60a040) : VoxelGrid::Voxel();
    });
    auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march(march));
    const Scene voxels(scene_voxels({{std::move(model)}, {VoxelPlace{}}}));
    const std::uint32_t count = reads(voxels, Camera::look_at({2.5, 2.5, 20}, {2.5, 2.5, 0}, 1, 1, 1), 1);
    if (march == std::string_view("voxel-planes"))
      EXPECT_EQ(count, 8u) << "seven empty ones, and the floor";
    else
      EXPECT_LE(count, most);
  }
}

TEST(CostLook, LegendsSayWhatIsCounted) {
  const auto title = [](Look look, const Scene& scene) {
    PictureSettings settings;
    settings.width = settings.height = 8;
    settings.look = look;
    const Camera camera = Camera::look_at({10, -20, 12}, {10, 10, 8}, 25, 8, 8);
    return render_picture(scene, camera, settings).legend.value().title;
  };
  EXPECT_EQ(title(Look::steps, test::terrain_on_plinth(wall())), "steps per ray: blocks and cells");
  EXPECT_EQ(title(Look::cost, test::terrain_on_plinth(wall())), "reads per ray: heights and blocks");
  EXPECT_EQ(title(Look::steps, test::terrain(wall(), "naive")), "steps per ray: samples");
  EXPECT_EQ(title(Look::cost, test::terrain(wall(), "naive")), "reads per ray: heights");
  EXPECT_EQ(title(Look::steps, test::terrain(wall(), "exhaustive")), "steps per ray: cells");
  EXPECT_EQ(title(Look::height, test::terrain(wall())), "height, m");
  EXPECT_EQ(title(Look::error, test::terrain(wall())), "the march is");
}

// From the south, just above the ground, towards a spike in the middle of a plain.
Picture spike(Look look, std::string_view march, const MarchSettings& march_settings = {}) {
  const HeightField field = field_of(
      65, 0, [](std::vector<float>& samples, int side) { samples[static_cast<std::size_t>(32 * side + 32)] = 20; });
  PictureSettings settings;
  settings.width = settings.height = 64;
  settings.look = look;
  settings.aa = 1;
  settings.haze = 0;
  settings.ramp = "grey";
  settings.unlit = true;
  const Camera camera = Camera::look_at({32, -20, 12}, {32, 32, 8}, 25, settings.width, settings.height);
  return render_picture(test::terrain(field, march, march_settings), camera, settings);
}

MarchSettings coarse_naive() {
  MarchSettings coarse;
  coarse.naive.min_step = 0.2;
  return coarse;
}

// With the grey ramp the ground is grey, and the sky is blue.
TEST(Picture, SkyShowsWhereNaiveLosesTheGround) {
  const Image right = spike(Look::shaded, "max-mip").image, naive = spike(Look::shaded, "naive", coarse_naive()).image;
  const ErrorCounts counts = spike(Look::error, "naive", coarse_naive()).errors.value();
  std::int64_t holes = 0;
  const auto grey = [](const std::uint8_t* p) { return p[0] == p[1] && p[1] == p[2]; };
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) holes += grey(right.pixel(x, y)) && !grey(naive.pixel(x, y));
  }
  EXPECT_GT(holes, 10);
  EXPECT_EQ(holes, counts[Verdict::lost]);
}

TEST(ErrorLook, NaiveLosesASpike) {
  const Picture picture = spike(Look::error, "naive", coarse_naive());
  ASSERT_TRUE(picture.errors);
  const ErrorCounts& counts = *picture.errors;
  EXPECT_GT(counts[Verdict::lost] + counts[Verdict::late], 10);
  EXPECT_EQ(std::accumulate(counts.pixels.begin(), counts.pixels.end(), std::int64_t{0}), 64 * 64);
  // Lost ground is red.
  std::int64_t reds = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t* p = picture.image.pixel(x, y);
      reds += p[0] > 60 && p[1] < p[0] / 3 && p[2] < p[0] / 3;
    }
  }
  EXPECT_EQ(reds, counts[Verdict::lost]);
}

TEST(ErrorLook, ExactMarchHasNoErrors) {
  const Picture picture = spike(Look::error, "max-mip");
  const ErrorCounts& counts = *picture.errors;
  EXPECT_GT(counts[Verdict::right_hit], 500);
  EXPECT_GT(counts[Verdict::right_miss], 500);
  for (const Verdict wrong : {Verdict::lost, Verdict::false_hit, Verdict::early, Verdict::late, Verdict::gave_up}) {
    EXPECT_EQ(counts[wrong], 0) << name_of(wrong);
  }
}

// The errors of each pixel, from the hits themselves.
void expect_metres(std::string_view march, const MarchSettings& march_settings, const std::vector<Verdict>& found) {
  const HeightField field = field_of(65, 0, [](std::vector<float>& samples, int side) {
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>((i * 7919) % 23) / 4;
    samples[static_cast<std::size_t>(32 * side + 32)] = 20;
  });
  const Scene scene = test::terrain(field, march, march_settings), judges = test::terrain(field, "exhaustive");
  PictureSettings settings;
  settings.width = settings.height = 64;
  settings.look = Look::error;
  const Camera camera = Camera::look_at({32, -20, 12}, {32, 32, 8}, 25, settings.width, settings.height);
  const Picture picture = render_picture(scene, camera, settings);
  std::array<std::vector<double>, kVerdicts> expected;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const Hit answer = scene.closest_hit(ray), truth = judges.closest_hit(ray);
      const auto pixel = static_cast<std::size_t>(64 * y + x);
      const Verdict verdict = picture.error_map->verdicts[pixel];
      ASSERT_EQ(verdict, judge(answer, truth, settings.error.tolerance));
      const double metres = verdict == Verdict::early       ? truth.t - answer.t
                            : verdict == Verdict::late      ? answer.t - truth.t
                            : verdict == Verdict::lost      ? distance(ray.at(truth.t), camera.eye())
                            : verdict == Verdict::false_hit ? distance(ray.at(answer.t), camera.eye())
                                                            : 0;
      EXPECT_NEAR(picture.error_map->metres[pixel], metres, 0x1p-24 * metres) << "rounded to float";
      expected[static_cast<std::size_t>(verdict)].push_back(metres);
    }
  }
  for (const Verdict verdict : found) {
    std::vector<double>& all = expected[static_cast<std::size_t>(verdict)];
    ASSERT_GT(all.size(), 10u) << name_of(verdict);
    const ErrorMetres& metres = picture.errors->of(verdict);
    const double mean = std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
    EXPECT_NEAR(metres.mean, mean, 0x1p-24 * mean) << name_of(verdict);
    std::sort(all.begin(), all.end());
    // The first that at least 99 % do not exceed.
    std::size_t first = 0;
    while (100 * (first + 1) < 99 * all.size()) ++first;
    EXPECT_NEAR(metres.p99, all[first], 0x1p-24 * all[first]) << name_of(verdict);
    EXPECT_NEAR(metres.most, all.back(), 0x1p-24 * all.back()) << name_of(verdict);
  }
}

TEST(ErrorLook, MetresAreThoseOfTheHits) {
  expect_metres("naive", coarse_naive(), {Verdict::late, Verdict::lost});
  MarchSettings early;
  early.relaxed.tolerance = 0.02;
  expect_metres("relaxed", early, {Verdict::early});
}

// Under the rim of a bowl, from outside.
TEST(ErrorLook, RaysThatEnterBelowGroundAreNotLost) {
  const HeightField bowl = field_of(33, 0, [](std::vector<float>& samples, int side) {
    for (int i = 0; i < side * side; ++i)
      samples[static_cast<std::size_t>(i)] =
          static_cast<float>(0.05 * (std::pow(i % side - 16, 2) + std::pow(i / side - 16, 2)));
  });
  PictureSettings settings;
  settings.width = settings.height = 32;
  settings.look = Look::error;
  const Camera camera = Camera::look_at({16, -10, 10}, {16, 16, 6}, 20, 32, 32);
  for (const std::string_view march : {"relaxed", "lipschitz", "max-mip"}) {
    const Picture picture = render_picture(test::terrain(bowl, march), camera, settings);
    EXPECT_EQ((*picture.errors)[Verdict::lost], 0) << march;
    EXPECT_GT((*picture.errors)[Verdict::right_hit] + (*picture.errors)[Verdict::early], 500) << march;
    EXPECT_TRUE(picture.errors->caveats.empty()) << march;
  }
}

TEST(ErrorLook, NamesAnUnprovenShrinkFactor) {
  MarchSettings settings;
  settings.lipschitz.shrink = 0.7;
  const Picture picture = spike(Look::error, "lipschitz", settings);
  ASSERT_EQ(picture.errors->caveats.size(), 1u);
  EXPECT_NE(picture.errors->caveats[0].find("0.7 is approximate"), std::string::npos) << picture.errors->caveats[0];
  EXPECT_EQ((*picture.errors)[Verdict::gave_up], 0);
}

TEST(ErrorLook, VerdictComparesStatusThenDistance) {
  const auto hit = [](double t) {
    Hit h;
    h.status = HitStatus::hit;
    h.t = t;
    return h;
  };
  const auto other = [](HitStatus status) {
    Hit h;
    h.status = status;
    return h;
  };
  const Hit miss = other(HitStatus::miss), below = other(HitStatus::below), exhausted = other(HitStatus::exhausted);
  EXPECT_EQ(judge(hit(5), hit(5.1), 0.2), Verdict::right_hit);
  EXPECT_EQ(judge(hit(4.8), hit(5.1), 0.2), Verdict::early);
  EXPECT_EQ(judge(hit(5.4), hit(5.1), 0.2), Verdict::late);
  EXPECT_EQ(judge(miss, hit(5), 0.2), Verdict::lost);
  EXPECT_EQ(judge(below, hit(5), 0.2), Verdict::lost);
  EXPECT_EQ(judge(hit(5), miss, 0.2), Verdict::false_hit);
  EXPECT_EQ(judge(miss, miss, 0.2), Verdict::right_miss);
  EXPECT_EQ(judge(exhausted, hit(5), 0.2), Verdict::gave_up);
  EXPECT_EQ(judge(exhausted, miss, 0.2), Verdict::gave_up);
  EXPECT_EQ(judge(hit(5), below, 0.2), Verdict::not_judged);
}

TEST(Picture, PlinthStandsBelowTheBorder) {
  const HeightField field = field_of(21, 100, nothing);
  const Scene scene = test::terrain_on_plinth(field);
  PictureSettings settings;
  settings.width = 200;
  settings.height = 100;
  const Camera camera = Camera::framed(picture_box(scene), {.azimuth_deg = 180, .elevation_deg = 20}, 0, 200, 100);
  const auto p = camera.pixel({10, 0, 100 - 0.3}).value();
  const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
  const Image with = render_picture(scene, camera, settings).image;
  const Image without = render_picture(test::terrain(field), camera, settings).image;
  EXPECT_LT(red(with, x, y), 160) << "earth";
  EXPECT_GT(red(without, x, y), 200) << "sky";
}

TEST(Picture, UnknownLookErrorListsTheKnownOnes) {
  for (const Look look : {Look::shaded, Look::height, Look::steps, Look::cost, Look::error})
    EXPECT_EQ(find_look(name_of(look)), look);
  EXPECT_THROW(find_look("pretty"), Error);
}

TEST(Picture, RejectsSettingsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Settings = PictureSettings;
  const std::vector<std::function<void(Settings&)>> spoil = {[](Settings& s) { s.width = 0; },
                                                             [](Settings& s) { s.width = -5; },
                                                             [](Settings& s) { s.height = 0; },
                                                             [](Settings& s) { s.width = s.height = 1000000; },
                                                             [](Settings& s) { s.width = s.height = 65536; },
                                                             [](Settings& s) { s.aa = 0; },
                                                             [](Settings& s) { s.aa = 17; },
                                                             [](Settings& s) { s.ramp = "jet"; },
                                                             [=](Settings& s) { s.haze = nan; },
                                                             [](Settings& s) { s.haze = 1; },
                                                             [](Settings& s) { s.haze_distance = 0; },
                                                             [](Settings& s) { s.error.tolerance = -1; },
                                                             [=](Settings& s) { s.error.share = nan; },
                                                             [](Settings& s) { s.samples = -1; },
                                                             [](Settings& s) { s.samples = 4097; },
                                                             [](Settings& s) { s.ao_distance = -1; },
                                                             [=](Settings& s) { s.ao_distance = nan; },
                                                             [](Settings& s) {
                                                               s.sun = {315, -1};
                                                             },
                                                             [](Settings& s) {
                                                               s.sun = {315, 45, -1};
                                                             },
                                                             [=](Settings& s) {
                                                               s.sun = {315, 45, nan};
                                                             },
                                                             [](Settings& s) {
                                                               s.sun = {315, 45, 91};
                                                             }};
  for (std::size_t i = 0; i < spoil.size(); ++i) {
    PictureSettings bad;
    spoil[i](bad);
    EXPECT_THROW(validate(bad), Error) << i;
  }
  EXPECT_NO_THROW(validate(PictureSettings{}));
}

TEST(Picture, RejectsFieldsWithNothingVisible) {
  const Camera camera = Camera::look_at({0, -5, 5}, {0, 0, 0}, 30, 8, 8);
  PictureSettings settings;
  settings.width = settings.height = 8;
  EXPECT_THROW(render_picture(test::terrain(field_of(1, 5, nothing)), camera, settings), Error);
  EXPECT_THROW(render_picture(test::terrain(field_of(3, kNaN, nothing)), camera, settings), Error);
  EXPECT_THROW(render_picture(Scene({}, {}), camera, settings), Error);
}

TEST(Picture, StopsOnRequest) {
  const HeightField field = wall();
  for (const Look look : {Look::shaded, Look::height, Look::steps, Look::error}) {
    PictureSettings settings = map_settings(field);
    settings.look = look;
    const Scene scene = test::terrain(field);
    const Camera camera = Camera::top(picture_box(scene), settings.width, settings.height);
    EXPECT_THROW(render_picture(scene, camera, settings, [](double) { return false; }), Interrupted);
  }
}

}  // namespace
}  // namespace scarp
