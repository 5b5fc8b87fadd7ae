// SPDX-License-Identifier: MIT
// Pictures on a Vulkan device: every ray of every look has an answer within single precision (RoundingJudge), and where
// the CPU's answer is equal, pixels are equal.
//
// A hit of the device is the CPU's when it has the same status and cell; the judge checks the position in the cell. The
// picture is rendered twice: once by the device alone; once with the CPU's hits substituted where they are equal, so
// that all further rays start where the CPU's do. The second picture is the CPU's, byte by byte, except for pixels with
// a ray that the device answers differently: these are counted, and each must be valid.
//
// The hits of the device alone are compared with rays of the CPU that are delta lower and higher (2 rho of
// doc/dev/numerics.md): a march whose clearance errs by no more stops between the hits of these two.
#include "scarp/render/frame/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cases.h"
#include "march/height/rounding_judge.h"
#include "march/height/spiteful_text.h"
#include "march/sampling_rules.h"
#include "render/terrain.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/render/frame/layers.h"
#include "scarp/scene/scene_back_end.h"
#include "scarp/scene/scene_vk.h"
#include "vk/device_under_test.h"

namespace scarp::test {
namespace {

const int kWidth = cases(80, 80, 40), kHeight = cases(48, 48, 24);
const unsigned kManyRays = static_cast<unsigned>(kWidth * kHeight / 4);
constexpr double kSideways = 0x1p-10;  // of a cell: the largest sideways error of a march in a tile

bool same(const Hit& a, const Hit& b) { return a.status == b.status && (!a || (a.wall == b.wall && a.cell == b.cell)); }

// delta of any ray over a field of one tile, in metres: the ray's height, its descent and all samples are
// within the relief of the frame's base; sideways, a ray crosses all cells along either axis.
double delta_of(const HeightField& field) {
  constexpr double kRoundings = 16, kUnit = 0x1p-24;
  const double relief = field.max_height() - field.min_height();
  double cell_relief = 0;
  for (int row = 0; row < field.cell_rows(); ++row) {
    for (int col = 0; col < field.cell_cols(); ++col) {
      const auto h = field.cell_heights({col, row});
      if (!h) continue;
      cell_relief = std::max(cell_relief,
                             std::max({h->h00, h->h10, h->h01, h->h11}) - std::min({h->h00, h->h10, h->h01, h->h11}));
    }
  }
  const double sideways = field.cell_cols() + field.cell_rows() + 1.0;
  return 2 * kRoundings * kUnit * (3 * relief + sideways * cell_relief);
}

class Judged final : public SceneBackEnd {
 public:
  // Scenes of one height field. `repairs`: whether the CPU's hits replace equal hits of the device. `plinth` answers
  // the rays of field 1; null: there is none.
  Judged(const Scene& device, const Scene& cpu, SceneFieldPtr plinth, bool repairs)
      : device_(device),
        cpu_(cpu),
        plinth_(std::move(plinth)),
        march_(find_height_march(cpu.marches())),
        repairs_(repairs),
        slope_(slope_bound(*cpu.only_heights())) {}

  void closest_hits(std::uint32_t field, std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const>) override {
    if (field == 1) return plinth_->closest_hits_on_all_threads(rays, hits, steps, {});
    device_.closest_hits(rays, hits, steps);
    std::vector<Hit> cpu(rays.size());
    std::vector<std::uint32_t> cpu_steps(steps.size());
    cpu_.closest_hits(rays, cpu, cpu_steps);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      judge(rays[i], hits[i]);
      if (!same(hits[i], cpu[i])) {
        judge(rays[i], cpu[i]);
        ++otherwise;
        continue;
      }
      if (repairs_) hits[i] = cpu[i];
      if (steps.empty()) continue;
      ++counted;
      // The first pass of max-mip tests 2 x 2 blocks at once.
      EXPECT_TRUE(steps[i] == cpu_steps[i] || march_.name == "max-mip" || counts_vary(rays[i]))
          << steps[i] << " steps, on the CPU " << cpu_steps[i] << ": " << text(rays[i]);
    }
    asked += rays.size();
  }

  void occluded(std::uint32_t, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const>) override {
    device_.occluded(rays, blocked);
    std::vector<Hit> hits(rays.size());
    device_.closest_hits(rays, hits);
    std::vector<std::uint8_t> cpu(rays.size());
    cpu_.occluded(rays, cpu);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(blocked[i] != 0, static_cast<bool>(hits[i])) << text(rays[i]);
      // A sampling march stops near the surface, not on it, so a ray that continues from its hit does not start on the
      // surface.
      if (march_.guarantee == Guarantee::exact) judge(rays[i], hits[i]);
      otherwise += (blocked[i] != 0) != (cpu[i] != 0);
    }
    asked += rays.size();
  }

  std::size_t asked = 0, otherwise = 0, counted = 0;

 private:
  // Whether the CPU's counts differ for a ray within delta: a count is a sum of decisions.
  bool counts_vary(const Ray& ray) const {
    std::vector<Ray> around(7, ray);
    const double cell = std::min((*cpu_.only_heights()).settings().cell_x, (*cpu_.only_heights()).settings().cell_y);
    const dvec3 moves(kSideways * cell, kSideways * cell, delta_of((*cpu_.only_heights())));
    for (std::size_t i = 1; i < around.size(); ++i) {
      const int axis = static_cast<int>((i - 1) / 2);
      around[i].origin[axis] += i % 2 == 0 ? moves[axis] : -moves[axis];
    }
    std::vector<Hit> hits(around.size());
    std::vector<std::uint32_t> steps(around.size());
    cpu_.closest_hits(around, hits, steps);
    return std::any_of(steps.begin(), steps.end(), [&](std::uint32_t count) { return count != steps.front(); });
  }
  void judge(const Ray& ray, const Hit& hit) const {
    if (testing::Test::HasFailure()) return;
    const HeightField& field = (*cpu_.only_heights());
    const RoundingJudge truth(field, ray);
    const std::string objection = march_.guarantee == Guarantee::exact
                                      ? truth.objection(hit)
                                      : sampling_objection(march_.name, {}, field, slope_, ray, truth, hit);
    EXPECT_EQ(objection, "") << text(ray) << "\n  " << text(hit);
  }

  Scene device_, cpu_;
  SceneFieldPtr plinth_;
  const HeightMarchEntry& march_;
  bool repairs_;
  double slope_;
};

// Ridges and valleys, 1 m cells, with a hole; solid or a sheet.
HeightField ridges(bool solid) {
  constexpr int kSide = 72;
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double x = 0.31 * col + 0.12 * row, y = 0.27 * row - 0.2 * col;
      samples.push_back(static_cast<float>(400 + 6 * std::abs(std::sin(x)) + 4 * std::sin(y) + std::sin(3 * x + y)));
    }
  }
  samples[30 * kSide + 20] = NAN;
  HeightFieldSettings settings;
  settings.solid = solid;
  return HeightField::own(std::move(samples), kSide, kSide, settings);
}

int pixels_unlike(const Image& a, const Image& b) {
  int unlike = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) unlike += !std::equal(a.pixel(x, y), a.pixel(x, y) + 3, b.pixel(x, y));
  }
  return unlike;
}

class PicturesOnDevice : public OnDevice {
 protected:
  struct Scenes {
    Scene cpu, device;
    Camera camera;
    Scene cpu_alone, device_alone;  // without the plinth
  };
  Scenes scenes(bool solid, bool plinth, std::string_view march = "max-mip") const {
    const Scene alone = test::terrain(ridges(solid), march), cpu = plinth ? with_plinth(alone) : alone;
    return {cpu, scene_on(device(), cpu), camera_of(cpu), alone, scene_on(device(), alone)};
  }
  static Camera camera_of(const Scene& scene, double raised = 0) {
    WorldBox box = picture_box(scene);
    box.low.z += raised;
    box.high.z += raised;
    return Camera::framed(box, {.elevation_deg = 20}, 0, kWidth, kHeight);
  }
  static Scene judged(const Scenes& of, std::shared_ptr<Judged>& judge, bool repairs) {
    judge = std::make_shared<Judged>(of.device_alone, of.cpu_alone,
                                     of.cpu.fields().size() > 1 ? of.cpu.fields()[1] : nullptr, repairs);
    return of.cpu.answered_by(judge);
  }
  static PictureSettings settings(Look look) {
    PictureSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.look = look;
    settings.aa = 1;
    settings.sun.altitude_deg = 25;
    return settings;
  }

  // Runs all of the above for one picture.
  static void expect_the_cpus(const Scenes& of, const PictureSettings& settings, bool device_alone_too = true) {
    const Picture cpu = render_picture(of.cpu, of.camera, settings);
    std::shared_ptr<Judged> judge;
    const Picture repaired = render_picture(judged(of, judge, true), of.camera, settings);
    EXPECT_GT(judge->asked, kManyRays);
    EXPECT_LE(pixels_unlike(cpu.image, repaired.image), static_cast<int>(judge->otherwise));
    EXPECT_LT(judge->otherwise, judge->asked / 2);
    if (!device_alone_too) return;
    const Picture alone = render_picture(of.device, of.camera, settings);
    const Picture watched = render_picture(judged(of, judge, false), of.camera, settings);
    EXPECT_EQ(alone.image.rgb, watched.image.rgb);
  }
};

// Shaded pictures by the device alone: see terrain_frame_vk_test.cpp.
TEST_F(PicturesOnDevice, MatchWithHardShadows) { expect_the_cpus(scenes(false, true), settings(Look::shaded), false); }

TEST_F(PicturesOnDevice, MatchWithSoftSunAndOcclusion) {
  PictureSettings soft = settings(Look::shaded);
  soft.samples = 3;
  soft.sun.size_deg = 5;
  expect_the_cpus(scenes(false, true), soft, false);
}

TEST_F(PicturesOnDevice, MatchOnSolidGround) {
  PictureSettings bare = settings(Look::shaded);
  bare.aa = 2;
  expect_the_cpus(scenes(true, false), bare, false);
}

TEST_F(PicturesOnDevice, MatchInHeightLook) { expect_the_cpus(scenes(false, true), settings(Look::height)); }

// The verdict depends on the position of the hit, and the tolerance is far larger than delta.
TEST_F(PicturesOnDevice, MatchInErrorLook) {
  const Scenes of = scenes(false, true);
  expect_the_cpus(of, settings(Look::error));
  const ErrorCounts counts = render_picture(of.device, of.camera, settings(Look::error)).errors.value();
  const ErrorCounts cpu = render_picture(of.cpu, of.camera, settings(Look::error)).errors.value();
  EXPECT_GT(counts[Verdict::right_hit], kWidth * kHeight / 4);
  EXPECT_EQ(counts.pixels, cpu.pixels);
}

// A sampling march decides as on the CPU except within delta, so its counts are equal.
TEST_F(PicturesOnDevice, StepsMatchTheCpu) {
  for (const HeightMarchEntry& march : height_marches()) {
    if (!march.gpu) continue;
    SCOPED_TRACE(march.name);
    const Scenes of = scenes(false, true, march.name);
    std::shared_ptr<Judged> judge;
    const Picture device = render_picture(of.device, of.camera, settings(Look::steps));
    const Picture watched = render_picture(judged(of, judge, false), of.camera, settings(Look::steps));
    EXPECT_EQ(device.image.rgb, watched.image.rgb);
    EXPECT_GT(device.steps->most, 10u);
    EXPECT_EQ(device.steps->least, 0u) << "rays that miss the plinth";
    EXPECT_GT(judge->counted, kManyRays);
  }
}

TEST_F(PicturesOnDevice, LayersMatchTheCpu) {
  const Scenes of = scenes(false, true);
  std::shared_ptr<Judged> judge;
  const PictureLayers cpu = render_layers(of.cpu, of.camera, settings(Look::shaded));
  const PictureLayers device = render_layers(of.device, of.camera, settings(Look::shaded));
  const PictureLayers repaired = render_layers(judged(of, judge, true), of.camera, settings(Look::shaded));
  const double delta = delta_of(*of.cpu.only_heights());
  const auto raised = [&](double by) { return render_layers(of.cpu, camera_of(of.cpu, by), settings(Look::shaded)); };
  const PictureLayers lower = raised(-delta), higher = raised(delta);
  std::size_t unlike = 0, moved = 0, counted = 0;
  for (std::size_t i = 0; i < cpu.depth.size(); ++i) {
    unlike += cpu.colour[i] != repaired.colour[i] || cpu.depth[i] != repaired.depth[i] ||
              cpu.normal[i] != repaired.normal[i] || cpu.position[i] != repaired.position[i];
    const dvec3 place = cpu.position[i];
    const auto away = [&](const PictureLayers& from) { return length(dvec3(from.position[i]) - place); };
    // Positions are floats: each of the four compared ones is off by its own roundoff.
    const double rounding = 4 * 0x1p-24 * length(place);
    moved += !(away(device) <= std::max(away(lower), away(higher)) + delta + rounding);
    counted += device.steps[i] > 0;
  }
  EXPECT_LE(unlike, judge->otherwise);
  EXPECT_LE(moved, judge->otherwise);
  EXPECT_GT(counted, kManyRays);
}

// Sampling marches may stop elsewhere, each ray by its own rule.
TEST_F(PicturesOnDevice, EveryMarchRenders) {
  for (const HeightMarchEntry& march : height_marches()) {
    if (!march.gpu || march.guarantee == Guarantee::exact) continue;
    const Scenes of = scenes(false, true, march.name);
    std::shared_ptr<Judged> judge;
    const Image device = render_picture(of.device, of.camera, settings(Look::shaded)).image;
    EXPECT_EQ(render_picture(judged(of, judge, false), of.camera, settings(Look::shaded)).image.rgb, device.rgb);
    EXPECT_GT(judge->asked, kManyRays) << march.name;
  }
}

}  // namespace
}  // namespace scarp::test
