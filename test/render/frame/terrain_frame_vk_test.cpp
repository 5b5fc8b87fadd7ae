// SPDX-License-Identifier: MIT
// Whole pictures rendered on a Vulkan device against those of the CPU.
//
// A ray in single precision has the hit of some ray within the bound of doc/dev/numerics.md: over these fields, less
// than 2^-15 of a cell per cell of its path. Turning the camera by kTurn of a pixel moves each ray by more than ten
// times that. A pixel of the device must therefore lie between the darkest and the brightest that the CPU's camera
// shows there, straight and turned left, right, up and down; colours are continuous except at edges, which a turned
// camera has on the pixel's other side. kRounding is added: formulas in floats are accurate to 2^-17, and a byte rounds
// either way.
#include "scarp/render/frame/terrain_frame_vk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "cases.h"
#include "render/terrain.h"
#include "scarp/march/height/ray_blocks.glsl.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/frame/terrain_frame.glsl.h"
#include "scarp/scene/scene_vk.h"
#include "scarp/source/table/ramp_file.h"
#include "test/vk/spirv_layout.h"
#include "vk/device_under_test.h"

namespace scarp::test {
namespace {

constexpr double kTurn = 1.0 / 64;
constexpr int kRounding = 1;
constexpr int kWidth = 64, kHeight = 48;
constexpr double kFov = 60;

constexpr std::uint32_t kRaysShader[] = {
#include "scarp/render/frame/terrain_frame_rays.comp.inc"
};
constexpr std::uint32_t kPaintShader[] = {
#include "scarp/render/frame/terrain_frame_paint.comp.inc"
};
constexpr std::uint32_t kResolveShader[] = {
#include "scarp/render/frame/terrain_frame_resolve.comp.inc"
};

enum class Holes { none, one, many };

constexpr int kSide = 64;

// Holes inside the field, next to one another, at borders and corners, and islands among them.
bool in_many_holes(int col, int row) {
  const bool corner = col > 54 && row > 50, border = row < 3 && col > 25 && col < 40;
  const bool ring = col >= 34 && col < 52 && row >= 34 && row < 48 && !(col > 38 && col < 48 && row > 37 && row < 45);
  const bool scattered = col < 24 && row > 36 && (col * 7 + row * 5) % 11 == 0;
  return corner || border || ring || scattered || (col > 8 && col < 16 && row > 22 && row < 30);
}

// Hills with a period of 64 cells; if the field is not wrapped, with a sea at exactly 2 in one corner and optional
// holes.
HeightField hills(const HeightFieldSettings& settings, Holes holes = Holes::one) {
  const bool wraps = settings.wrap != Wrap::none;
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double x = 2 * std::numbers::pi * col / kSide, y = 2 * std::numbers::pi * row / kSide;
      const double z =
          5 + 2 * std::sin(x + y) + 1.5 * std::sin(3 * x - y) + std::cos(2 * x + 5 * y) + 0.4 * std::sin(9 * x + 4 * y);
      samples.push_back(static_cast<float>(!wraps && col < 20 && row < 20 ? 2 : z));
      if (!wraps && holes == Holes::many && in_many_holes(col, row)) samples.back() = NAN;
    }
  }
  if (!wraps && holes == Holes::one) samples[40 * kSide + 30] = NAN;
  return HeightField::own(std::move(samples), kSide, kSide, settings);
}

struct Row {
  std::string name;
  std::string march = "max-mip";
  std::function<void(PictureSettings&)> change = [](PictureSettings&) {};
  HeightFieldSettings field{.wrap = Wrap::periodic};
  bool top = false;
  bool plinth = false;
  Holes holes = Holes::one;
  dvec3 eye{70, -30, 40};  // over a field that is not wrapped, looking north-west and down
  double down = 0.6;
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

std::vector<Row> rows() {
  const auto water = [](PictureSettings& s) { s.water = WaterSettings{.level = 4, .turbidity = 0.3, .waves = 0.03}; };
  const auto fog = [](PictureSettings& s, FogKind kind) {
    s.fog.kind = kind;
    s.fog.visibility = 90;
    s.fog.base = 3;
    s.fog.falloff = 4;
  };
  const HeightFieldSettings ends{.exaggeration = 1.5};
  std::vector<Row> all;
  const auto add = [&](const std::string& name, const std::string& march,
                       const std::function<void(PictureSettings&)>& change,
                       const HeightFieldSettings& field = {.wrap = Wrap::periodic}, bool top = false) {
    Row& row = all.emplace_back();
    row.name = name, row.march = march, row.change = change, row.field = field, row.top = top;
  };
  add("plain", "fixed-step", [=](PictureSettings& s) {
    water(s);
    fog(s, FogKind::iterations);
    s.comanche.interpolate = false;
  });
  add("interpolated", "fixed-step", [=](PictureSettings& s) {
    water(s);
    s.ground.detail = 0.5;
  });
  add("by_view", "fixed-step", [](PictureSettings& s) { s.comanche.step_by_view = true; });
  add("shells", "fixed-step", [](PictureSettings& s) {
    s.comanche.shells = true;
    s.comanche.steps = 40;
  });
  add("iterations", "fixed-step", [](PictureSettings& s) { s.comanche.iterations = true; });
  add(
      "fixed_step_ends", "fixed-step", [=](PictureSettings& s) { water(s); }, ends);
  add("exact", "max-mip", [=](PictureSettings& s) {
    water(s);
    fog(s, FogKind::distance);
  });
  add("natural", "max-mip", [=](PictureSettings& s) {
    fog(s, FogKind::height);
    s.ground.natural = true;
    s.ground.contours = 1;
  });
  add("glitter_in_fog", "max-mip", [=](PictureSettings& s) {
    water(s);
    fog(s, FogKind::height);
    s.sky.kind = SkyKind::scattering;
    s.sun = {.azimuth_deg = 330, .altitude_deg = 20, .size_deg = 8};
  });
  add("mirror_of_the_sky", "max-mip", [=](PictureSettings& s) {
    water(s);
    s.water->reflection = s.water->refraction = false;
    s.water->waves = 0;
  });
  add(
      "basin_and_sea", "max-mip",
      [=](PictureSettings& s) {
        water(s);
        s.water->level = 2;
      },
      ends);
  add(
      "basin", "max-mip", [=](PictureSettings& s) { water(s); }, ends);
  add(
      "map_of_solid_triangles", "max-mip", [=](PictureSettings& s) { water(s); },
      {.cell_x = 1.25, .cell_y = 0.75, .scale = 0.5, .offset = 3, .surface = Surface::triangles, .solid = true}, true);
  add("solid", "max-mip",
      [=](PictureSettings& s) {
        fog(s, FogKind::height);
        s.sun.azimuth_deg = 110;  // on both visible walls, differently on each
      },
      {.cell_x = 1.25, .cell_y = 0.75, .exaggeration = 1.5, .solid = true});
  add("shaded", "max-mip", [](PictureSettings& s) {
    s.look = Look::shaded;
    s.shadows = true;
    s.aa = 2;
  });
  add(
      "shaded_ends", "max-mip",
      [=](PictureSettings& s) {
        s.look = Look::shaded;
        s.shadows = true;
        water(s);
        s.haze = 0.3;
      },
      ends);
  const auto soft = [](PictureSettings& s) {
    s.shadows = true;
    s.samples = 6;
    s.aa = 2;
    s.seed = 5;
    s.sun.size_deg = 8;
    s.ao_distance = 20;
  };
  add("soft_light", "max-mip", [=](PictureSettings& s) { soft(s); });
  add(
      "soft_light_ends", "max-mip",
      [=](PictureSettings& s) {
        s.look = Look::shaded;
        soft(s);
        water(s);
      },
      ends);
  add("soft_light_of_steps", "fixed-step", [=](PictureSettings& s) { soft(s); });
  add("occlusion_alone", "max-mip", [=](PictureSettings& s) {
    soft(s);
    s.shadows = false;
    s.aa = 1;
  });
  add("soft_sun_alone", "max-mip", [=](PictureSettings& s) {
    soft(s);
    s.ao_distance = 0;
    s.samples = 1;
  });
  add("occlusion_and_a_point_of_a_sun", "max-mip", [=](PictureSettings& s) {
    soft(s);
    s.sun.size_deg = 0;
  });
  const auto plinth = [&](const std::string& name, const std::function<void(PictureSettings&)>& change,
                          const HeightFieldSettings& field) {
    add(name, "max-mip", change, field);
    all.back().plinth = true;
    all.back().holes = Holes::none;
  };
  plinth(
      "plinth", [](PictureSettings& s) { s.look = Look::shaded; }, ends);
  plinth("plinth_of_triangles",
         [](PictureSettings& s) {
           s.look = Look::shaded;
           s.haze = 0.4;
           s.aa = 2;
           s.sun.azimuth_deg = 110;
         },
         {.cell_x = 1.25, .cell_y = 0.75, .offset = -20, .exaggeration = 2, .surface = Surface::triangles});
  plinth(
      "plinth_in_water",
      [=](PictureSettings& s) {
        water(s);
        fog(s, FogKind::height);
      },
      ends);
  const auto plinth_with_holes = [&](const std::string& name, const dvec3& eye, double down,
                                     const std::function<void(PictureSettings&)>& change,
                                     const HeightFieldSettings& field) {
    plinth(name, change, field);
    all.back().holes = Holes::many;
    all.back().eye = eye;
    all.back().down = down;
  };
  plinth_with_holes(
      "plinth_with_holes", {70, -30, 40}, 0.6, [](PictureSettings& s) { s.look = Look::shaded; }, ends);
  plinth_with_holes(
      "plinth_with_holes_from_above", {52, 8, 45}, 0.95,
      [=](PictureSettings& s) {
        s.look = Look::shaded;
        soft(s);
      },
      ends);
  plinth_with_holes("plinth_with_holes_of_triangles", {70, -30, 70}, 0.75,
                    [](PictureSettings& s) {
                      s.look = Look::shaded;
                      s.haze = 0.4;
                      s.aa = 2;
                      s.sun.azimuth_deg = 110;
                    },
                    {.cell_x = 1.25, .cell_y = 0.75, .offset = -20, .exaggeration = 4, .surface = Surface::triangles});
  plinth_with_holes(
      "plinth_with_holes_in_water", {70, -30, 40}, 0.6,
      [=](PictureSettings& s) {
        water(s);
        fog(s, FogKind::height);
      },
      ends);
  // In the shaft of the hole inside, in the rock, and below the base.
  plinth_with_holes(
      "in_a_hole_of_a_plinth", {50, 22.2, 4}, -0.1, [](PictureSettings& s) { s.look = Look::shaded; }, ends);
  plinth_with_holes("in_the_rock_of_a_plinth", {52, 6, 1}, -0.2, [](PictureSettings& s) { s.look = Look::shaded; },
                    {.exaggeration = 4});
  plinth_with_holes("from_below_a_plinth", {62, -20, -30}, -0.75, [](PictureSettings& s) { s.look = Look::shaded; },
                    {.exaggeration = 4});
  plinth_with_holes("solid_plinth_with_holes", {70, -30, 40}, 0.6, [](PictureSettings& s) { s.look = Look::shaded; },
                    {.exaggeration = 1.5, .solid = true});
  constexpr double kHigh = 1e7;
  const auto high_above_zero = [&](const std::string& name, const std::function<void(PictureSettings&)>& change) {
    add(name, "max-mip",
        [=](PictureSettings& s) {
          s.look = Look::shaded;
          change(s);
        },
        {.offset = kHigh});
    all.back().eye.z += kHigh;
  };
  high_above_zero("high_above_zero", [=](PictureSettings& s) {
    fog(s, FogKind::height);
    s.fog.base += kHigh;
    s.ground.contours = 1;
  });
  high_above_zero("water_high_above_zero", [=](PictureSettings& s) {
    water(s);
    s.water->level += kHigh;
    s.ground.natural = true;
  });
  add("shadows_of_steps", "fixed-step", [](PictureSettings& s) { s.shadows = true; });
  add("draped", "max-mip", [](PictureSettings& s) {
    Drape drape{3, 2, {}};
    for (int i = 0; i < 24; ++i) drape.rgba.push_back(static_cast<std::uint8_t>(i % 4 == 3 ? 40 * i / 4 : 10 * i));
    s.ground.drape = std::make_shared<Drape>(drape);
  });
  add("draped_in_part", "max-mip", [](PictureSettings& s) {
    Drape drape{2, 2, {200, 0, 0, 255, 0, 200, 0, 255, 0, 0, 200, 255, 90, 90, 90, 100}, {0.3, 0.1}, {0.8, 0.7}, true};
    s.ground.drape = std::make_shared<Drape>(drape);
  });
  add("unlit_texture", "max-mip", [](PictureSettings& s) {
    s.unlit = s.shadows = true;
    s.samples = 4;
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 4 * 5 * 3; ++i) rgba.push_back(static_cast<std::uint8_t>(i * 37));
    s.ground.detail_texture = std::make_shared<DetailTexture>(5, 3, rgba);
    s.ground.detail = 0.7;
    s.ground.detail_size = 6;
  });
  add("ramp_of_slices", "max-mip", [](PictureSettings& s) {
    auto stops = std::make_shared<RampStops>();
    stops->slices = {{1, 3, {0, 0, 0.5f}, {0, 0.4f, 0.5f}},
                     {3, 6, {0.2f, 0.5f, 0}, {0.7f, 0.7f, 0.2f}},
                     {6, 11, {0.7f, 0.5f, 0.3f}, {1, 1, 1}}};
    s.ramp_stops = stops;
  });
  return all;
}

PictureSettings settings_of(const Row& row) {
  PictureSettings settings;
  settings.look = Look::comanche;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.aa = 1;
  settings.shadows = false;
  settings.sun.altitude_deg = 25;
  settings.comanche.scale = 1;
  settings.comanche.steps = 128;
  row.change(settings);
  return settings;
}

// Rotated by these angles in radians, to the right and up.
Camera camera_of(const Row& row, const HeightField& field, const dvec2& turn) {
  Camera camera = Camera::top({{0, 0, 0}, {field.width(), field.depth(), 10}}, kWidth, kHeight);
  if (row.top) {
    // A map has only one direction: it is moved instead.
    const dvec3 moved(turn.x * 20, turn.y * 20, 0);
    camera = Camera::top({moved, dvec3(field.width(), field.depth(), 10) + moved}, kWidth, kHeight);
  } else {
    const dvec3 eye = row.field.wrap == Wrap::none ? row.eye : dvec3(10.3, 7.1, 12.9);
    const double heading = (row.field.wrap == Wrap::none ? -0.55 : 0.35) + turn.x,
                 down = (row.field.wrap == Wrap::none ? -row.down : -0.2) + turn.y;
    const dvec3 ahead(std::cos(down) * std::sin(heading), std::cos(down) * std::cos(heading), std::sin(down));
    camera = Camera::look_at(eye, eye + ahead, kFov, kWidth, kHeight);
  }
  if (field.wraps()) camera.set_reach(100);
  return camera;
}

double pixel_angle() { return 2 * std::tan(kFov * std::numbers::pi / 360) / kHeight; }

Scene scene_of(const Row& row, const HeightField& field) {
  return row.plinth ? test::terrain_on_plinth(field, row.march) : test::terrain(field, row.march);
}

class TerrainFrames : public OnDevice, public testing::WithParamInterface<Row> {};

TEST_P(TerrainFrames, MatchTheCpu) {
  const Row& row = GetParam();
  const HeightField field = hills(row.field, row.holes);
  const PictureSettings settings = settings_of(row);
  const Scene cpu = scene_of(row, field);
  const Scene on_device = scene_on(device(), cpu);
  const Camera straight = camera_of(row, field, {0, 0});
  ASSERT_TRUE(makes_whole_frames(on_device, straight, settings));
  std::vector<std::uint8_t> low, high;
  const double turn = kTurn * pixel_angle();
  for (const dvec2& way : {dvec2(0), dvec2(turn, 0), dvec2(-turn, 0), dvec2(0, turn), dvec2(0, -turn)}) {
    const Image image = render_picture(cpu, camera_of(row, field, way), settings).image;
    if (low.empty()) low = high = image.rgb;
    for (std::size_t i = 0; i < low.size(); ++i) {
      low[i] = std::min(low[i], image.rgb[i]);
      high[i] = std::max(high[i], image.rgb[i]);
    }
  }
  const Image made = render_picture(on_device, straight, settings).image;
  int outside = 0, uniform = 0;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    int off = 0;
    for (std::size_t c = 3 * static_cast<std::size_t>(i); c < 3 * static_cast<std::size_t>(i) + 3; ++c) {
      off = std::max({off, low[c] - made.rgb[c], made.rgb[c] - high[c]});
      uniform += made.rgb[c] == made.rgb[0];
    }
    if (off <= kRounding) continue;
    if (++outside < 4) ADD_FAILURE() << "pixel " << i % kWidth << ", " << i / kWidth << " is off by " << off;
  }
  EXPECT_EQ(outside, 0);
  EXPECT_LT(uniform, 3 * kWidth * kHeight / 2) << "there is something to be seen";
}

// The driver takes nearly all of the time. `./dev test` tries each row once: every seventh row under sanitizers, the
// others in optimised builds. `./dev test --long` tries all rows in optimised builds.
std::vector<Row> tried_rows() {
  const bool all = test::cases(1, 0, 0) != 0;
#ifdef NDEBUG
  constexpr bool kWatched = false;
#else
  constexpr bool kWatched = true;
#endif
  std::vector<Row> some;
  for (std::size_t i = 0; const Row& row : rows()) {
    const bool seventh = i++ % 7 == 0;
    if (all || seventh == kWatched) some.push_back(row);
  }
  return some;
}

INSTANTIATE_TEST_SUITE_P(All, TerrainFrames, testing::ValuesIn(tried_rows()),
                         [](const auto& row) { return row.param.name; });

class TerrainFrame : public OnDevice {};

// 65,536 steps are more than a run takes.
TEST_F(TerrainFrame, ResumesWhereItWasInterrupted) {
  Row row = rows()[1];
  for (const bool stepped : {true, false}) {
    // Under sanitizers, only the shorter of the two runs.
    if (stepped && test::cases(1, 1, 0) == 0) continue;
    row.march = stepped ? "fixed-step" : "max-mip";
    const HeightField field = hills(row.field);
    PictureSettings settings = settings_of(row);
    settings.ground.detail = 0;
    settings.width = settings.height = 12;
    settings.aa = stepped ? 1 : 3;
    settings.alpha = !stepped;
    settings.shadows = !stepped;
    settings.comanche.steps = 65536;
    const Scene cpu = scene_of(row, field);
    const Scene on_device = scene_on(device(), cpu);
    Camera camera = Camera::look_at({10, 7, 12.9}, {20, 40, 4}, kFov, 12, 12);
    camera.set_reach(100);
    const Image a = render_picture(cpu, camera, settings).image, b = render_picture(on_device, camera, settings).image;
    int unlike = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) unlike += std::abs(a.rgb[i] - b.rgb[i]) > kRounding;
    EXPECT_EQ(unlike, 0) << row.march;
    EXPECT_EQ(a.alpha, b.alpha) << row.march;
    const std::set<std::uint8_t> opacities(a.alpha.begin(), a.alpha.end());
    EXPECT_EQ(opacities.size() > 2 && opacities.contains(0), settings.alpha) << "sky, crests and ground";
  }
}

// Wherever a picture is interrupted, nothing of it remains in the next picture, which is larger and uses other memory.
TEST_F(TerrainFrame, CanBeInterrupted) {
  Row row = rows()[6];
  const HeightField field = hills(row.field);
  PictureSettings settings = settings_of(row);
  settings.shadows = true;
  const Scene cpu = scene_of(row, field), on_device = scene_on(device(), cpu);
  const auto made = [&](int size, const Progress& progress) {
    settings.width = settings.height = size;
    Camera camera = Camera::look_at({10.3, 7.1, 12.9}, {20, 40, 4}, kFov, size, size);
    camera.set_reach(100);
    return render_picture(on_device, camera, settings, progress).image;
  };
  int calls = 0;
  double before = 0;
  made(8, [&](double done) {
    ++calls;
    EXPECT_GE(done, before);
    before = done;
    return true;
  });
  EXPECT_EQ(before, 1);
  ASSERT_GT(calls, 6) << "after each stage that is waited for";
  for (int last = 1; last <= calls; ++last) {
    int left = last;
    EXPECT_THROW(made(8 + 2 * last, [&](double) { return --left > 0; }), Interrupted);
    made(9 + 2 * last, {});
  }
  const Image after = made(kHeight, {});
  const Scene fresh = scene_on(device(), cpu);
  Camera camera = Camera::look_at({10.3, 7.1, 12.9}, {20, 40, 4}, kFov, kHeight, kHeight);
  camera.set_reach(100);
  EXPECT_EQ(render_picture(fresh, camera, settings).image.rgb, after.rgb);
}

// More pixels than the device holds at once.
TEST_F(TerrainFrame, RendersInParts) {
  if (test::cases(1, 1, 0) == 0) GTEST_SKIP() << "takes a minute under sanitizers";
  constexpr int kWide = 700, kHigh = 460, kEvery = 101;
  const HeightField field = hills({}, Holes::none);
  const Scene cpu = test::terrain(field, "max-mip");
  PictureSettings settings;
  settings.look = Look::shaded;
  settings.width = kWide, settings.height = kHigh;
  settings.aa = 1;
  settings.shadows = false;
  const Camera camera = Camera::top({{0, 0, 0}, {field.width(), field.depth(), 10}}, kWide, kHigh);
  FrameReport report{.tells_sightings = true};
  const Image image = render_whole_frame(scene_on(device(), cpu), camera, settings, {}, &report);
  const Image expected = render_picture(cpu, camera, settings).image;
  int unlike = 0, ground = 0;
  for (int i = 0; i < kWide * kHigh; ++i) {
    for (std::size_t c = 3 * static_cast<std::size_t>(i); c < 3 * static_cast<std::size_t>(i) + 3; ++c)
      unlike += std::abs(image.rgb[c] - expected.rgb[c]) > kRounding;
    if (i % kEvery != 0) continue;
    const FrameSighting& found = report.sightings[static_cast<std::size_t>(i)];
    const Hit hit = cpu.closest_hit(camera.ray(i % kWide + 0.5, i / kWide + 0.5));
    ASSERT_EQ(found.kind == FrameSighting::Kind::ground, static_cast<bool>(hit)) << i;
    if (!hit) continue;
    ++ground;
    EXPECT_NEAR(found.t, hit.t, 0.01) << i;
  }
  EXPECT_LE(unlike, 3) << "at edges";
  EXPECT_GT(ground, 1000);
}

TEST_F(TerrainFrame, ReportsTheHitsOfItsRays) {
  const Row row = rows()[6];
  const HeightField field = hills(row.field);
  const PictureSettings settings = settings_of(row);
  const Scene cpu = scene_of(row, field);
  const Scene on_device = scene_on(device(), cpu);
  const Camera camera = camera_of(row, field, {0, 0});
  FrameReport report{.tells_sightings = true};
  render_whole_frame(on_device, camera, settings, {}, &report);
  const std::vector<FrameSighting>& sightings = report.sightings;
  if (device().description().abilities.timestamps) {
    EXPECT_GT(report.device_s.value_or(0), 0);
  }
  ASSERT_EQ(sightings.size(), std::size_t{kWidth * kHeight});
  const Water water(*settings.water, cpu);
  std::array<int, 4> kinds{};
  int other = 0;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const FrameSighting& found = sightings[static_cast<std::size_t>(i)];
    Ray ray = camera.ray(i % kWidth + 0.5, i / kWidth + 0.5);
    const auto meeting = water.meets(ray);
    if (meeting) ray.t_max = meeting->t;
    const Hit hit = cpu.closest_hit(ray);
    const auto kind = hit       ? FrameSighting::Kind::ground
                      : meeting ? FrameSighting::Kind::water
                                : FrameSighting::Kind::nothing;
    ++kinds[static_cast<std::size_t>(kind)];
    if (found.kind != kind) {
      ++other;
      continue;
    }
    if (kind == FrameSighting::Kind::nothing) continue;
    EXPECT_NEAR(found.t, hit ? hit.t : meeting->t, 0.01) << i;
    if (hit) {
      EXPECT_GT(found.steps, 0u);
    }
  }
  EXPECT_LE(other, 2) << "at edges";
  for (const int kind : {0, 1, 3}) EXPECT_GT(kinds[static_cast<std::size_t>(kind)], 100) << kind;
}

// Grey levels match heights to within half a level; rays that just hit or miss a crest may differ.
TEST_F(TerrainFrame, MatchesTheHeightsOfSteps) {
  Row row = rows()[2];
  ASSERT_EQ(row.name, "by_view");
  const HeightField field = hills(row.field);
  PictureSettings settings = settings_of(row);
  settings.comanche.heights = true;
  settings.ground.natural = true;  // not read
  const Scene cpu = scene_of(row, field);
  const Camera camera = camera_of(row, field, {0, 0});
  const Image a = render_picture(cpu, camera, settings).image,
              b = render_picture(scene_on(device(), cpu), camera, settings).image;
  int unlike = 0, ground = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    unlike += std::abs(a.rgb[i] - b.rgb[i]) > kRounding;
    ground += a.rgb[i] > 0;
  }
  EXPECT_LE(unlike, 3);
  EXPECT_GT(ground, kWidth * kHeight / 3);
}

TEST_F(TerrainFrame, LeavesUnsupportedFramesToRounds) {
  const Row row = rows()[6];
  const HeightField endless = hills(row.field), ends = hills({});
  const auto on_device = [&](const HeightField& field, const char* march) {
    return scene_on(device(), test::terrain_on_plinth(field, march));
  };
  PictureSettings settings = settings_of(row);
  const Camera camera = camera_of(row, endless, {0, 0});
  EXPECT_FALSE(makes_whole_frames(test::terrain(endless, "max-mip"), camera, settings));
  EXPECT_FALSE(makes_whole_frames(on_device(endless, "relaxed"), camera, settings));
  EXPECT_TRUE(makes_whole_frames(on_device(endless, "max-mip"), camera, settings)) << "endless ground has none";
  const Camera far_away = Camera::look_at({1e7, 0, 100}, {0, 0, 0}, kFov, kWidth, kHeight);
  EXPECT_FALSE(makes_whole_frames(on_device(ends, "max-mip"), far_away, settings));
  EXPECT_THROW(render_picture(on_device(ends, "fixed-step"), far_away, settings), Error);
}

TEST(TerrainFrameLayout, MatchesTheShaders) {
  using glsl::FramePush, glsl::FrameSight, glsl::FrameWave, glsl::FramePatch, glsl::FrameRampPiece;
  EXPECT_TRUE(has_struct(kRaysShader,
                         {offsetof(FramePush, settings), offsetof(FramePush, ground), offsetof(FramePush, seens),
                          offsetof(FramePush, waters), offsetof(FramePush, rays), offsetof(FramePush, hits),
                          offsetof(FramePush, owners), offsetof(FramePush, grounds), offsetof(FramePush, counters),
                          offsetof(FramePush, sums), offsetof(FramePush, pixels), offsetof(FramePush, sights),
                          offsetof(FramePush, first), offsetof(FramePush, count), offsetof(FramePush, threads),
                          offsetof(FramePush, point), offsetof(FramePush, light), offsetof(FramePush, tell_sights)}));
  EXPECT_TRUE(has_struct(kResolveShader, {offsetof(FrameSight, kind), offsetof(FrameSight, t),
                                          offsetof(FrameSight, cell), offsetof(FrameSight, steps)}));
  EXPECT_TRUE(has_struct(kRaysShader, {offsetof(FrameWave, along), offsetof(FrameWave, turns),
                                       offsetof(FrameWave, turns_low), offsetof(FrameWave, metres)}));
  EXPECT_TRUE(has_struct(kRaysShader, {offsetof(FramePatch, along), offsetof(FramePatch, along_low),
                                       offsetof(FramePatch, across), offsetof(FramePatch, across_low)}));
  EXPECT_TRUE(is_laid_out_like<FrameRampPiece>(kPaintShader));
  EXPECT_TRUE(is_laid_out_like<glsl::FrameSettings>(kRaysShader));
  EXPECT_TRUE(is_laid_out_like<glsl::FrameSeen>(kRaysShader));
  EXPECT_TRUE(is_laid_out_like<glsl::FrameWater>(kRaysShader));
  EXPECT_TRUE(is_laid_out_like<glsl::RayBlock>(kRaysShader));
  EXPECT_TRUE(is_laid_out_like<glsl::FrameSum>(kResolveShader));
}

}  // namespace
}  // namespace scarp::test
