// SPDX-License-Identifier: MIT
// The C interface answers as the C++ one, which other tests judge; its own parts are statuses, messages, structures and
// lifetimes.
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "scarp/field/ground_points.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/scarp.h"
#include "scarp/scarp_c.h"
#include "scarp/scene/ray_arrays.h"
#include "scarp/scene/scene_query.h"
#include "scarp/scene/tiled_terrain.h"

namespace {

constexpr int kSide = 65;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<float> hills() {
  std::vector<float> samples(kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = i % kSide, y = i / kSide;
    samples[static_cast<std::size_t>(i)] = static_cast<float>(6 * std::sin(x / 5) * std::cos(y / 7) + 0.1 * x);
  }
  samples[20 * kSide + 30] = std::numeric_limits<float>::quiet_NaN();
  return samples;
}

scarp_heights heights_of(const std::vector<float>& samples) {
  scarp_heights heights{};
  heights.struct_size = sizeof heights;
  heights.samples = samples.data();
  heights.cols = heights.rows = kSide;
  heights.cell_x = 2;
  heights.cell_y = 3;
  return heights;
}

struct Released {
  void operator()(scarp_scene* scene) const { scarp_scene_release(scene); }
};
using ScenePointer = std::unique_ptr<scarp_scene, Released>;

ScenePointer view_of(const std::vector<float>& samples) {
  const scarp_heights heights = heights_of(samples);
  scarp_scene* scene = nullptr;
  EXPECT_EQ(scarp_heights_view(&heights, &scene), SCARP_OK) << scarp_last_error();
  return ScenePointer(scene);
}

std::vector<std::uint8_t> tower() {
  std::vector<std::uint8_t> indices(8 * 8 * 16);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i % 3 == 0 ? 1 : i % 64 < 20 ? 2 : 0;
  return indices;
}
constexpr std::uint8_t kPalette[] = {0, 0, 0, 200, 10, 20, 30, 40, 50};

ScenePointer tower_of(const std::vector<std::uint8_t>& indices) {
  scarp_voxels voxels{};
  voxels.struct_size = sizeof voxels;
  voxels.indices = indices.data();
  voxels.size[0] = voxels.size[1] = 8;
  voxels.size[2] = 16;
  voxels.palette = kPalette;
  voxels.palette_count = 3;
  voxels.side = 1.5;
  scarp_scene* scene = nullptr;
  EXPECT_EQ(scarp_voxels_copy(&voxels, &scene), SCARP_OK) << scarp_last_error();
  return ScenePointer(scene);
}

std::vector<scarp_ray> random_rays(std::size_t count) {
  std::mt19937_64 bits(7);
  std::uniform_real_distribution<double> x(-20, 150), y(-20, 220), z(-10, 60);
  std::vector<scarp_ray> rays(count);
  for (scarp_ray& ray : rays) {
    ray = {{x(bits), y(bits), z(bits)}, {}, 0, kInfinity};
    const double to[] = {x(bits), y(bits), z(bits) - 20};
    for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = to[axis] - ray.origin[axis];
  }
  return rays;
}

scarp::Ray own(const scarp_ray& ray) {
  return {.origin = {ray.origin[0], ray.origin[1], ray.origin[2]},
          .direction = {ray.direction[0], ray.direction[1], ray.direction[2]},
          .t_min = ray.t_min,
          .t_max = ray.t_max};
}

// Fields of a combined scene, in C and in C++.
struct Both {
  Both() {
    scarp_scene* whole = nullptr;
    const scarp_part parts[] = {{terrain.get(), {}, 0, {}, 0, 0},
                                {voxels.get(), {0, -1, 0, 1, 0, 0, 0, 0, 1}, 2, {60, 90, 5}, 4, 0}};
    EXPECT_EQ(scarp_scene_combine(parts, 2, &whole), SCARP_OK) << scarp_last_error();
    scene.reset(whole);
  }
  std::vector<float> samples = hills();
  std::vector<std::uint8_t> indices = tower();
  ScenePointer terrain = view_of(samples), voxels = tower_of(indices), scene{};

  scarp::Terrain own_terrain = scarp::Terrain::view(samples.data(), kSide, kSide, {.cell_x = 2, .cell_y = 3});
  scarp::Voxels own_voxels = scarp::Voxels::copy(indices.data(), {8, 8, 16},
                                                 {.side = 1.5, .palette = {{0, 0, 0}, {200, 10, 20}, {30, 40, 50}}});
  scarp::Scene own_scene = scarp::combine(
      {{own_terrain},
       {own_voxels, {.turn = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, .scale = 2, .origin = {60, 90, 5}}, {}, 4}});
};

TEST(C, SingleRaysAndBatchesAnswerAsInCpp) {
  const Both both;
  const std::vector<scarp_ray> rays = random_rays(3000);
  std::vector<scarp_hit> hits(rays.size()), second(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  ASSERT_EQ(scarp_cast_batch(both.scene.get(), rays.data(), nullptr, hits.data(), rays.size()), SCARP_OK);
  ASSERT_EQ(scarp_occluded_batch(both.scene.get(), rays.data(), nullptr, blocked.data(), rays.size()), SCARP_OK);
  int per_object[2] = {};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const scarp::Hit expected = scarp::cast(both.own_scene, own(rays[i]));
    scarp_hit hit;
    std::uint8_t hidden = 2;
    ASSERT_EQ(scarp_cast(both.scene.get(), &rays[i], nullptr, &hit), SCARP_OK);
    ASSERT_EQ(scarp_occluded(both.scene.get(), &rays[i], nullptr, &hidden), SCARP_OK);
    EXPECT_EQ(std::bit_cast<scarp::Hit>(hit), expected);
    EXPECT_EQ(std::bit_cast<scarp::Hit>(hits[i]), expected);
    EXPECT_EQ(hidden, scarp::occluded(both.own_scene, own(rays[i])));
    EXPECT_EQ(blocked[i], hidden);
    if (expected) ++per_object[expected.object];
  }
  EXPECT_GT(per_object[0], 300);
  EXPECT_GT(per_object[1], 100);

  // Shadow rays from the hits; the others start anywhere.
  std::vector<scarp_ray> shadows = rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (int axis = 0; axis < 3 && hits[i].status == SCARP_HIT; ++axis)
      shadows[i].origin[axis] += hits[i].t * rays[i].direction[axis];
    shadows[i].direction[0] = 0.2, shadows[i].direction[1] = 0.3, shadows[i].direction[2] = 1;
  }
  ASSERT_EQ(scarp_cast_batch(both.scene.get(), shadows.data(), hits.data(), second.data(), rays.size()), SCARP_OK)
      << scarp_last_error();
  ASSERT_EQ(scarp_occluded_batch(both.scene.get(), shadows.data(), hits.data(), blocked.data(), rays.size()), SCARP_OK);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const scarp::Hit from = std::bit_cast<scarp::Hit>(hits[i]);
    const scarp::Hit expected = scarp::cast(both.own_scene, own(shadows[i]), from ? &from : nullptr);
    EXPECT_EQ(std::bit_cast<scarp::Hit>(second[i]), expected);
    EXPECT_EQ(blocked[i], scarp::occluded(both.own_scene, own(shadows[i]), from ? &from : nullptr));
    if (!from) continue;
    scarp_hit hit;
    ASSERT_EQ(scarp_cast(both.scene.get(), &shadows[i], &hits[i], &hit), SCARP_OK);
    EXPECT_EQ(std::bit_cast<scarp::Hit>(hit), expected);
    scarp_surface surface{};
    surface.struct_size = sizeof surface;
    ASSERT_EQ(scarp_surface_at(both.scene.get(), &rays[i], &hits[i], &surface), SCARP_OK);
    const scarp::SceneSurface own_surface = both.own_scene.surface(own(rays[i]), from);
    EXPECT_EQ(std::memcmp(surface.normal, &own_surface.normal, sizeof surface.normal), 0);
    EXPECT_EQ(std::memcmp(surface.position, &own_surface.position, sizeof surface.position), 0);
    EXPECT_EQ(std::memcmp(surface.shading_normal, &own_surface.shading_normal, sizeof surface.position), 0);
    ASSERT_EQ(surface.has_colour, own_surface.colour.has_value());
    if (own_surface.colour) {
      EXPECT_EQ(std::memcmp(surface.colour, own_surface.colour->data(), 3), 0);
    }
  }
}

TEST(C, ArraysPointsAndAllHitsAnswerAsInCpp) {
  const Both both;
  const std::vector<scarp_ray> rays = random_rays(500);
  const std::size_t count = rays.size();
  std::vector<float> values[6], t(count), expected_t(count), nx(count), ny(count), nz(count);
  for (const scarp_ray& ray : rays) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[axis].push_back(static_cast<float>(ray.origin[axis]));
      values[3 + axis].push_back(static_cast<float>(ray.direction[axis]));
    }
  }
  scarp_ray_arrays arrays{};
  arrays.struct_size = sizeof arrays;
  arrays.origin_x = values[0].data(), arrays.origin_y = values[1].data(), arrays.origin_z = values[2].data();
  arrays.direction_x = values[3].data(), arrays.direction_y = values[4].data(), arrays.direction_z = values[5].data();
  std::vector<std::uint8_t> status(count), blocked(count);
  scarp_hit_arrays hits{};
  hits.struct_size = sizeof hits;
  hits.t = t.data(), hits.status = status.data();
  hits.normal_x = nx.data(), hits.normal_y = ny.data(), hits.normal_z = nz.data();
  ASSERT_EQ(scarp_cast_arrays(both.scene.get(), &arrays, &hits, count), SCARP_OK) << scarp_last_error();
  ASSERT_EQ(scarp_occluded_arrays(both.scene.get(), &arrays, blocked.data(), count), SCARP_OK);
  const scarp::RayArrays own_arrays{values[0], values[1], values[2], values[3], values[4], values[5]};
  scarp::cast(both.own_scene, own_arrays, {.t = expected_t});
  EXPECT_EQ(t, expected_t);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(status[i] == SCARP_HIT, blocked[i] == 1);
    EXPECT_TRUE(status[i] == SCARP_HIT || (nx[i] == 0 && ny[i] == 0 && nz[i] == 0));
  }
  hits.normal_z = nullptr;
  EXPECT_EQ(scarp_cast_arrays(both.scene.get(), &arrays, &hits, count), SCARP_REFUSED);

  std::vector<double> xs, ys, heights(count), expected(count);
  for (const scarp_ray& ray : rays) xs.push_back(ray.origin[0]), ys.push_back(ray.origin[1]);
  ASSERT_EQ(scarp_heights_at(both.scene.get(), xs.data(), ys.data(), heights.data(), count), SCARP_OK);
  scarp::heights_at(both.own_scene, xs, ys, expected);
  EXPECT_EQ(std::memcmp(heights.data(), expected.data(), count * sizeof(double)), 0);

  std::size_t several = 0;
  for (const scarp_ray& ray : rays) {
    std::vector<scarp::Hit> own_hits;
    scarp::all_hits_max_mip(both.own_terrain.target(), own(ray), own_hits);
    scarp_hit found[2];
    std::size_t number = 99;
    ASSERT_EQ(scarp_all_hits(both.terrain.get(), &ray, found, 2, &number), SCARP_OK);
    ASSERT_EQ(number, own_hits.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(number, 2); ++i)
      EXPECT_EQ(std::bit_cast<scarp::Hit>(found[i]), own_hits[i]);
    several += number > 1;
  }
  EXPECT_GT(several, 3u);
  EXPECT_EQ(scarp_all_hits(both.scene.get(), &rays[0], nullptr, 0, &several), SCARP_UNSUPPORTED);
  EXPECT_STREQ(scarp_last_error(), "scene: it was not opened as heights");
}

TEST(C, FansAnswerAsInCpp) {
  const Both both;
  scarp_camera camera{};
  camera.struct_size = sizeof camera;
  camera.eye[0] = 60, camera.eye[1] = -30, camera.eye[2] = 40;
  camera.forward[1] = 1, camera.forward[2] = -0.4;
  camera.tan_half_width = 0.7;
  camera.columns = 40, camera.rows = 30;
  std::vector<float> t(1200), u(1200), nx(1200), ny(1200), nz(1200);
  std::vector<std::int32_t> col(1200);
  std::vector<std::uint8_t> status(1200);
  scarp_fan_answers answers{};
  answers.struct_size = sizeof answers;
  answers.t = t.data(), answers.u = u.data(), answers.col = col.data(), answers.status = status.data();
  answers.nx = nx.data(), answers.ny = ny.data(), answers.nz = nz.data();
  ASSERT_EQ(scarp_cast_camera(both.terrain.get(), &camera, &answers), SCARP_OK) << scarp_last_error();
  scarp::FanAnswers own_answers(40, 30, true);
  scarp::cast_from(both.own_terrain,
                   scarp::PinholeCamera{
                       .eye = {60, -30, 40}, .forward = {0, 1, -0.4}, .columns = 40, .rows = 30, .tan_half_width = 0.7},
                   own_answers);
  EXPECT_EQ(t, own_answers.t);
  EXPECT_EQ(u, own_answers.u);
  EXPECT_EQ(col, own_answers.col);
  EXPECT_EQ(nz, own_answers.nz);
  EXPECT_GT(std::count(status.begin(), status.end(), SCARP_HIT), 300);

  const std::vector<double> elevations{-0.5, -0.3, -0.1};
  scarp_scanner scanner{};
  scanner.struct_size = sizeof scanner;
  scanner.eye[0] = 60, scanner.eye[1] = 100, scanner.eye[2] = 20;
  scanner.elevations = elevations.data();
  scanner.azimuth_step = 0.01;
  scanner.columns = 400, scanner.rows = 3;
  ASSERT_EQ(scarp_cast_scanner(both.terrain.get(), &scanner, &answers), SCARP_OK) << scarp_last_error();
  scarp::FanAnswers around(400, 3);
  scarp::cast_from(both.own_terrain,
                   scarp::Scanner{.eye = {60, 100, 20}, .elevations = elevations, .columns = 400, .azimuth_step = 0.01},
                   around);
  EXPECT_EQ(t, around.t);

  std::vector<float> dx(1200), dy(1200, 1), dz(1200);
  for (std::size_t i = 0; i < 1200; ++i)
    dx[i] = 0.01f * static_cast<float>(i % 40), dz[i] = -1 + 0.02f * static_cast<float>(i / 40);
  scarp_fan fan{};
  fan.struct_size = sizeof fan;
  fan.eye[0] = 60, fan.eye[2] = 50;
  fan.dx = dx.data(), fan.dy = dy.data(), fan.dz = dz.data();
  fan.columns = 40, fan.rows = 30;
  ASSERT_EQ(scarp_cast_fan(both.terrain.get(), &fan, &answers), SCARP_OK) << scarp_last_error();
  scarp::FanAnswers directed(40, 30);
  scarp::cast_from(both.own_terrain,
                   scarp::Fan{.origin = {60, 0, 50},
                              .dx = dx.data(),
                              .dy = dy.data(),
                              .dz = dz.data(),
                              .columns = 40,
                              .rows = 30,
                              .row_stride = 40},
                   directed.hits());
  EXPECT_EQ(t, directed.t);
  EXPECT_EQ(scarp_cast_fan(both.scene.get(), &fan, &answers), SCARP_UNSUPPORTED);
  fan.columns = -1;
  EXPECT_EQ(scarp_cast_fan(both.terrain.get(), &fan, &answers), SCARP_REFUSED);
}

TEST(C, ContactsAnswerAsInCpp) {
  const Both both;
  const scarp::SceneQuery query(both.own_scene, {});
  std::mt19937_64 bits(3);
  std::uniform_real_distribution<double> x(0, 128), y(0, 190), z(0, 30);
  int contacts = 0, boxes = 0, overlaps_at_start = 0;
  for (int i = 0; i < 200; ++i) {
    const double a[3] = {x(bits), y(bits), z(bits)}, b[3] = {a[0], a[1], a[2] + 1}, motion[3] = {5, -3, -12};
    scarp_contact contact;
    ASSERT_EQ(scarp_sweep(both.scene.get(), a, b, 0.7, motion, ~0u, &contact), SCARP_OK) << scarp_last_error();
    const auto expected = query.sweep({{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, 0.7}, {5, -3, -12});
    ASSERT_EQ(contact.found, expected.has_value());
    if (expected) {
      ++contacts;
      EXPECT_EQ(contact.t, expected->t);
      EXPECT_EQ(contact.object, expected->object);
      EXPECT_EQ(contact.distance, -expected->depth);
      overlaps_at_start += expected->depth > 0;
      EXPECT_EQ(std::memcmp(contact.normal, &expected->normal, sizeof contact.normal), 0);
    }
    const double half[3] = {1, 2, 3}, turn[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    std::uint8_t overlaps = 2;
    ASSERT_EQ(scarp_overlaps(both.scene.get(), a, half, turn, ~0u, &overlaps), SCARP_OK);
    EXPECT_EQ(overlaps, query.overlaps({{a[0], a[1], a[2]}, {1, 2, 3}, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}}));
    boxes += overlaps;
    ASSERT_EQ(scarp_closest_point(both.scene.get(), a, 8, ~0u, &contact), SCARP_OK);
    const auto nearest = query.closest_point({a[0], a[1], a[2]}, 8);
    ASSERT_EQ(contact.found, nearest.has_value());
    if (nearest) {
      EXPECT_EQ(contact.distance, nearest->distance);
    }
  }
  EXPECT_GT(overlaps_at_start, 0);
  EXPECT_GT(contacts, 40);
  EXPECT_GT(boxes, 5);
  const double at[3] = {};
  scarp_contact contact;
  EXPECT_EQ(scarp_closest_point(both.scene.get(), at, 8, 2, &contact), SCARP_REFUSED);
}

TEST(C, EditsShowInTheSceneAndNotInOldCombinations) {
  Both both;
  const scarp_ray down{{80, 81, 100}, {0, 0, -1}, 0, kInfinity};
  scarp_hit hit;
  const scarp_rect rect{40, 37, 1, 1};
  both.samples[37 * kSide + 40] = 50;
  ASSERT_EQ(scarp_heights_changed(both.terrain.get(), &rect), SCARP_OK);
  ASSERT_EQ(scarp_cast(both.terrain.get(), &down, nullptr, &hit), SCARP_OK);
  EXPECT_EQ(hit.height, 50);
  EXPECT_EQ(scarp_cast(both.scene.get(), &down, nullptr, &hit), SCARP_REFUSED);
  const float value = 60;
  EXPECT_EQ(scarp_heights_set(both.terrain.get(), &rect, &value, 0), SCARP_REFUSED);

  scarp_heights heights = heights_of(both.samples);
  heights.row_stride = -kSide;  // the other way up
  heights.samples = both.samples.data() + (kSide - 1) * kSide;
  scarp_scene* scene = nullptr;
  ASSERT_EQ(scarp_heights_copy(&heights, &scene), SCARP_OK) << scarp_last_error();
  const ScenePointer copy(scene);
  double x = 80, y = 3 * 37, height = 0;
  ASSERT_EQ(scarp_heights_at(copy.get(), &x, &y, &height, 1), SCARP_OK);
  EXPECT_EQ(height, 50);
  const scarp_rect one{40, 27, 1, 1};
  ASSERT_EQ(scarp_heights_set(copy.get(), &one, &value, 0), SCARP_OK) << scarp_last_error();
  ASSERT_EQ(scarp_heights_at(copy.get(), &x, &y, &height, 1), SCARP_OK);
  EXPECT_EQ(height, 60);

  const std::int32_t low[3] = {0, 0, 0}, high[3] = {8, 8, 16};
  const double middle[3] = {4, 4, 8};
  const scarp_ray through{{6, 6, 100}, {0, 0, -1}, 0, kInfinity};
  ASSERT_EQ(scarp_voxels_set_box(both.voxels.get(), low, high, 0), SCARP_OK);
  ASSERT_EQ(scarp_cast(both.voxels.get(), &through, nullptr, &hit), SCARP_OK);
  EXPECT_EQ(hit.status, SCARP_MISS);
  ASSERT_EQ(scarp_voxels_set_sphere(both.voxels.get(), middle, 2, 1), SCARP_OK);
  ASSERT_EQ(scarp_cast(both.voxels.get(), &through, nullptr, &hit), SCARP_OK);
  EXPECT_EQ(hit.status, SCARP_HIT);
  EXPECT_EQ(hit.face, SCARP_HIGH_Z);
  EXPECT_EQ(scarp_voxels_set_box(both.voxels.get(), low, high, 256), SCARP_REFUSED);
  EXPECT_EQ(scarp_voxels_set_box(both.terrain.get(), low, high, 1), SCARP_UNSUPPORTED);
}

TEST(C, TilesAnswerAsOneField) {
  scarp_tile_layout layout{};
  layout.struct_size = sizeof layout;
  layout.cols = 2, layout.rows = 1;
  layout.cell_cols = 32, layout.cell_rows = kSide - 1;
  layout.cell_x = 2, layout.cell_y = 3;
  scarp_tiles* tiles = nullptr;
  ASSERT_EQ(scarp_tiles_create(&layout, &tiles), SCARP_OK) << scarp_last_error();
  const Both both;
  ScenePointer parts[2];
  scarp_tile_change changes[2];
  for (int i = 0; i < 2; ++i) {
    scarp_heights heights = heights_of(both.samples);
    heights.samples = both.samples.data() + 32 * i;
    heights.cols = 33;
    heights.row_stride = kSide;
    scarp_scene* scene = nullptr;
    ASSERT_EQ(scarp_heights_view(&heights, &scene), SCARP_OK) << scarp_last_error();
    parts[i].reset(scene);
    changes[i] = {i, 0, scene};
  }
  ASSERT_EQ(scarp_tiles_edit(tiles, changes, 2), SCARP_OK) << scarp_last_error();
  EXPECT_EQ(scarp_tiles_edit(tiles, changes, 1), SCARP_REFUSED);
  scarp_scene* read = nullptr;
  ASSERT_EQ(scarp_tiles_read(tiles, &read), SCARP_OK);
  const ScenePointer scene(read);
  const scarp_tile_change gone{1, 0, nullptr};
  ASSERT_EQ(scarp_tiles_edit(tiles, &gone, 1), SCARP_OK) << scarp_last_error();
  scarp_tiles_release(tiles);
  int hits = 0;
  for (const scarp_ray& ray : random_rays(1000)) {
    scarp_hit whole, hit;
    ASSERT_EQ(scarp_cast(both.terrain.get(), &ray, nullptr, &whole), SCARP_OK);
    ASSERT_EQ(scarp_cast(scene.get(), &ray, nullptr, &hit), SCARP_OK);
    EXPECT_EQ(hit.status == SCARP_HIT, whole.status == SCARP_HIT);
    if (hit.status != SCARP_HIT || whole.status != SCARP_HIT) continue;
    ++hits;
    scarp_surface surface{};
    surface.struct_size = sizeof surface;
    EXPECT_EQ(scarp_surface_at(scene.get(), &ray, &hit, &surface), SCARP_OK) << scarp_last_error();
    // In frames of their own, tiles round coordinates below 256 m some tens of times; a ray that grazes the ground
    // moves along it by more.
    constexpr double kRoundings = 64 * 256 * 0x1p-53;
    double across = 0;  // of the ray, towards the ground, per unit of t
    for (int axis = 0; axis < 3; ++axis) across += ray.direction[axis] * surface.normal[axis];
    EXPECT_LE(std::abs(hit.t - whole.t) * std::abs(across), kRoundings);
    hit.part = 2;
    EXPECT_EQ(scarp_surface_at(scene.get(), &ray, &hit, &surface), SCARP_REFUSED);
  }
  EXPECT_GT(hits, 100);
}

TEST(C, LiveScenesAreEditedUnderReaders) {
  scarp_live* live = nullptr;
  ASSERT_EQ(scarp_live_create(&live), SCARP_OK);
  Both both;
  struct Edit {
    scarp_scene* voxels;
    std::uint32_t object = 99;
    double height = 0;
  } edit{both.voxels.get()};
  const auto add = [](scarp_editor* editor, void* user_data) {
    auto& own = *static_cast<Edit*>(user_data);
    const scarp_part part{own.voxels, {}, 0, {}, 0, 0};
    EXPECT_EQ(scarp_editor_add(editor, &part, &own.object), SCARP_OK) << scarp_last_error();
  };
  const auto move = [](scarp_editor* editor, void* user_data) {
    auto& own = *static_cast<Edit*>(user_data);
    const scarp_part place{nullptr, {}, 0, {0, 0, own.height}, 0, 0};
    EXPECT_EQ(scarp_editor_move(editor, own.object, &place), SCARP_OK) << scarp_last_error();
  };
  const auto remove = [](scarp_editor* editor, void* user_data) {
    auto& own = *static_cast<Edit*>(user_data);
    EXPECT_EQ(scarp_editor_remove(editor, own.object), SCARP_OK);
    EXPECT_EQ(scarp_editor_remove(editor, own.object), SCARP_REFUSED);
  };
  const auto look = [](const scarp_scene* scene, void* user_data) {
    const scarp_ray up{{0.3, 0.3, -1e4}, {0, 0, 1}, 0, kInfinity};
    scarp_hit hit;
    EXPECT_EQ(scarp_cast(scene, &up, nullptr, &hit), SCARP_OK) << scarp_last_error();
    *static_cast<double*>(user_data) = hit.status == SCARP_HIT ? hit.t - 1e4 : -1;
    scarp_scene_release(const_cast<scarp_scene*>(scene));  // does nothing: it is not the caller's
  };
  double found = 0;
  ASSERT_EQ(scarp_live_read(live, look, &found), SCARP_OK);
  EXPECT_EQ(found, -1);
  ASSERT_EQ(scarp_live_edit(live, add, &edit), SCARP_OK);
  std::atomic<bool> done = false;
  std::atomic<int> wrong = 0;
  std::thread reader([&] {
    double z = 0;
    while (!done) {
      if (scarp_live_read(live, look, &z) != SCARP_OK || z < 0 || z > 50 || z != std::floor(z)) ++wrong;
    }
  });
  for (int i = 1; i <= 50; ++i) {
    edit.height = i;
    EXPECT_EQ(scarp_live_edit(live, move, &edit), SCARP_OK);
  }
  done = true;
  reader.join();
  EXPECT_EQ(wrong, 0);
  ASSERT_EQ(scarp_live_read(live, look, &found), SCARP_OK);
  EXPECT_EQ(found, 50);
  ASSERT_EQ(scarp_live_edit(live, remove, &edit), SCARP_OK);
  ASSERT_EQ(scarp_live_read(live, look, &found), SCARP_OK);
  EXPECT_EQ(found, -1);

  const auto nested = [](const scarp_scene*, void* user_data) {
    double z = 0;
    EXPECT_EQ(scarp_live_read(
                  static_cast<scarp_live*>(user_data), [](const scarp_scene*, void*) {}, &z),
              SCARP_REFUSED);
  };
  ASSERT_EQ(scarp_live_read(live, nested, live), SCARP_OK);
  const auto throws = [](const scarp_scene*, void*) { throw 1; };
  EXPECT_EQ(scarp_live_read(live, throws, nullptr), SCARP_FAILED);
  EXPECT_EQ(scarp_live_read(live, look, &found), SCARP_OK);
  scarp_live_release(live);
}

TEST(C, BatchesRunOnTheCallersThreads) {
  const Both both;
  const std::vector<scarp_ray> rays = random_rays(40000);
  std::vector<scarp_hit> hits(rays.size()), others(rays.size());
  ASSERT_EQ(scarp_cast_batch(both.scene.get(), rays.data(), nullptr, others.data(), rays.size()), SCARP_OK);
  std::int64_t ran = 0;
  scarp_threads threads{};
  threads.struct_size = sizeof threads;
  threads.user_data = &ran;
  threads.run = [](void* user_data, std::int64_t pieces, void (*piece)(void*, std::int64_t), void* context) {
    for (std::int64_t i = 0; i < pieces; ++i) piece(context, i);
    *static_cast<std::int64_t*>(user_data) += pieces;
  };
  ASSERT_EQ(scarp_use_threads(&threads), SCARP_OK);
  ASSERT_EQ(scarp_cast_batch(both.scene.get(), rays.data(), nullptr, hits.data(), rays.size()), SCARP_OK);
  EXPECT_GT(ran, 1);
  for (std::size_t i = 0; i < hits.size(); ++i)
    EXPECT_EQ(std::bit_cast<scarp::Hit>(hits[i]), std::bit_cast<scarp::Hit>(others[i]));
  ASSERT_EQ(scarp_use_threads(nullptr), SCARP_OK);
  ran = 0;
  ASSERT_EQ(scarp_cast_batch(both.scene.get(), rays.data(), nullptr, hits.data(), rays.size()), SCARP_OK);
  EXPECT_EQ(ran, 0);
}

TEST(C, MessagesNameWhatIsWrongPerThread) {
  const Both both;
  std::vector<scarp_ray> rays = random_rays(4);
  rays[2].direction[0] = std::numeric_limits<double>::quiet_NaN();
  scarp_hit hits[4];
  EXPECT_EQ(scarp_cast_batch(both.scene.get(), rays.data(), nullptr, hits, 4), SCARP_REFUSED);
  EXPECT_EQ(std::string(scarp_last_error()).rfind("ray 2 of 4: ", 0), 0u) << scarp_last_error();
  const std::string before = scarp_last_error();
  std::thread([] { EXPECT_STREQ(scarp_last_error(), ""); }).join();
  EXPECT_EQ(scarp_cast(nullptr, &rays[0], nullptr, hits), SCARP_REFUSED);
  EXPECT_STREQ(scarp_last_error(), "scene: is NULL");
  EXPECT_EQ(scarp_cast(both.scene.get(), &rays[0], nullptr, hits), SCARP_OK);
  EXPECT_STREQ(scarp_last_error(), "scene: is NULL");
  scarp_hit from[4]{};
  from[1].status = SCARP_HIT, from[1].object = 7;
  EXPECT_EQ(scarp_cast_batch(both.scene.get(), random_rays(4).data(), from, hits, 4), SCARP_REFUSED);
  EXPECT_STREQ(scarp_last_error(), "ray 1 of 4: this scene did not return the hit that it starts from");
}

TEST(C, StructuresGrowAtTheirEnd) {
  const std::vector<float> samples = hills();
  struct Larger {
    scarp_heights heights;
    std::uint64_t added = 0;
  } larger{heights_of(samples)};
  larger.heights.struct_size = sizeof larger;
  scarp_scene* scene = nullptr;
  EXPECT_EQ(scarp_heights_view(&larger.heights, &scene), SCARP_OK) << scarp_last_error();
  scarp_scene_release(scene);
  larger.added = 1;
  EXPECT_EQ(scarp_heights_view(&larger.heights, &scene), SCARP_REFUSED);
  EXPECT_STREQ(scarp_last_error(), "heights: a member is set that this version of Scarp does not know");
  for (const std::size_t size : {std::size_t{0}, sizeof(scarp_heights) - 1, ~std::size_t{0}}) {
    larger.heights.struct_size = size;
    EXPECT_EQ(scarp_heights_view(&larger.heights, &scene), SCARP_REFUSED);
    EXPECT_NE(std::string(scarp_last_error()).find("set it to sizeof(scarp_heights)"), std::string::npos);
  }
}

TEST(C, SamplesAreReleasedOnceWithTheirLastScene) {
  const std::vector<float> samples = hills();
  int released = 0;
  scarp_heights heights = heights_of(samples);
  heights.user_data = &released;
  heights.release = [](const void*, void* user_data) { ++*static_cast<int*>(user_data); };
  heights.cell_x = -1;
  scarp_scene *scene = nullptr, *whole = nullptr;
  EXPECT_EQ(scarp_heights_view(&heights, &scene), SCARP_REFUSED);
  EXPECT_EQ(released, 0);
  heights.cell_x = 2;
  ASSERT_EQ(scarp_heights_view(&heights, &scene), SCARP_OK);
  scarp_scene_set_user_data(scene, &heights);
  EXPECT_EQ(scarp_scene_user_data(scene), &heights);
  const scarp_part part{scene, {}, 0, {}, 0, 0};
  ASSERT_EQ(scarp_scene_combine(&part, 1, &whole), SCARP_OK);
  EXPECT_EQ(scarp_scene_objects(whole), 1u);
  scarp_scene_release(scene);
  EXPECT_EQ(released, 0);
  const scarp_ray down{{80, 81, 100}, {0, 0, -1}, 0, kInfinity};
  scarp_hit hit;
  EXPECT_EQ(scarp_cast(whole, &down, nullptr, &hit), SCARP_OK) << scarp_last_error();
  scarp_scene_release(whole);
  EXPECT_EQ(released, 1);
}

}  // namespace
