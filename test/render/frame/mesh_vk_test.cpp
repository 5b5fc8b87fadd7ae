// SPDX-License-Identifier: MIT
// A mesh drawn among terrain, beside double-precision rays at its triangles.
//
// What may differ follows from how the device draws. A corner is drawn up to s pixels beside its place, along either
// axis: 2^-(bits + 1) by the grid that places are rounded to, and 8 v of the terms of clip coordinates (6 roundings:
// the matrix, a product, three sums, the position). So a pixel shows what lies within s of its middle: it is judged
// where the middle and the corners of that square agree. Depths, near / z, are linear in the picture: they may differ
// by s (|g_x| + |g_y|) + 16 v (1/z + width |g_x| + height |g_y|), g being the change of 1/z per pixel on the triangle.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "scarp/render/frame/mesh_picture_vk.h"
#include "scarp/render/frame/mesh_view.glsl.h"
#include "scarp/scene/terrain_scene_vk.h"
#include "scarp/vk/raster.h"
#include "vk/device_under_test.h"
#include "vk/spirv_layout.h"

namespace scarp::test {
namespace {

constexpr std::uint32_t kVertex[] = {
#include "scarp/render/frame/mesh_raster.vert.inc"
};
constexpr std::uint32_t kFragment[] = {
#include "scarp/render/frame/mesh_raster.frag.inc"
};

constexpr double kUnit = 0x1p-24;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kWidth = 96, kHeight = 64;
constexpr vec3 kRed(0.8f, 0.2f, 0.1f);

void add(std::vector<MeshCorner>& mesh, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 across = cross(b - a, c - a);
  if (!(length(across) > 0)) return;
  for (const dvec3& p : {a, b, c}) mesh.push_back({p, vec3(normalize(across)), kRed});
}

// Of triangles, with its corners on the sphere.
std::vector<MeshCorner> ball(const dvec3& middle, double radius, int rings = 16) {
  std::vector<MeshCorner> mesh;
  const auto at = [&](int ring, int turn) {
    const double down = std::numbers::pi * ring / rings, round = std::numbers::pi * turn / rings;
    return middle + radius * dvec3(std::sin(down) * std::cos(round), std::sin(down) * std::sin(round), std::cos(down));
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int turn = 0; turn < 2 * rings; ++turn) {
      add(mesh, at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1));
      add(mesh, at(ring, turn), at(ring + 1, turn + 1), at(ring, turn + 1));
    }
  }
  return mesh;
}

std::vector<MeshCorner> plate(const dvec3& corner, const dvec3& x, const dvec3& y) {
  std::vector<MeshCorner> mesh;
  add(mesh, corner, corner + x, corner + x + y);
  add(mesh, corner, corner + x + y, corner + y);
  return mesh;
}

struct Met {
  double t = kInfinity;
  dvec3 normal{0.0};
};

// The nearest triangle, by Cramer's rule.
Met cast(const std::vector<MeshCorner>& mesh, const dvec3& origin, const dvec3& direction, double least = 0) {
  Met met;
  for (std::size_t i = 0; i < mesh.size(); i += 3) {
    const dvec3 a = mesh[i].position, ab = mesh[i + 1].position - a, ac = mesh[i + 2].position - a, from = origin - a;
    const dvec3 across = cross(direction, ac);
    const double volume = dot(ab, across);
    if (volume == 0) continue;
    const double u = dot(from, across) / volume, v = dot(direction, cross(from, ab)) / volume;
    const double t = dot(ac, cross(from, ab)) / volume;
    if (u >= 0 && v >= 0 && u + v <= 1 && t >= least && t < met.t) met = {t, normalize(cross(ab, ac))};
  }
  return met;
}

HeightField ridges(bool hole = false) {
  constexpr int kSide = 72;
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double x = 0.31 * col + 0.12 * row, y = 0.27 * row - 0.2 * col;
      samples.push_back(static_cast<float>(400 + 6 * std::abs(std::sin(x)) + 4 * std::sin(y)));
    }
  }
  if (hole) samples[30 * kSide + 20] = NAN;
  HeightFieldSettings settings;
  settings.cell_x = 2;
  settings.cell_y = 1.5;
  settings.offset = 50;
  return HeightField::own(std::move(samples), kSide, kSide, settings);
}

// Level ground at 10 m, with a wall of 30 m from west to east in its north.
HeightField walled() {
  constexpr int kSide = 65;
  std::vector<float> samples(kSide * kSide, 10);
  for (int row = 30; row < 33; ++row) {
    for (int col = 0; col < kSide; ++col) samples[row * kSide + col] = 30;
  }
  return HeightField::own(std::move(samples), kSide, kSide);
}

using test::refusal;

class MeshOnDevice : public OnDevice {
 protected:
  // Metres of all points of the mesh from its middle, at most: where floats count from.
  double snap() const { return std::ldexp(0.5, -static_cast<int>(raster_limits(device()).subpixel_bits)); }
  static double size_of(const std::vector<MeshCorner>& mesh) {
    double size = 0;
    for (const MeshCorner& corner : mesh) size = std::max(size, length(corner.position - mesh.front().position));
    return size;
  }
  // The terrain through the middles of pixels, by the CPU.
  static DrawnPoints terrain_of(const HeightField& field, const Camera& camera) {
    const TerrainScene cpu(field, find_height_march("max-mip"));
    DrawnPoints points{kWidth, kHeight, {}, {}, {}, {}};
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Ray ray = camera.ray(x + 0.5, y + 0.5);
        const Hit hit = cpu.closest_hit(ray);
        points.colour.emplace_back(0.5f);
        points.depth.push_back(
            static_cast<float>(hit ? dot(ray.at(hit.t) - camera.eye(), camera.forward()) : kInfinity));
      }
    }
    return points;
  }

  // Every pixel's order, and the depths where the mesh is seen. Returns how many were judged to show the mesh.
  void expect_order(const HeightField& field, const std::vector<MeshCorner>& mesh, const Camera& camera, int least) {
    const TerrainScene scene = terrain_scene_on(device(), field);
    MeshRaster raster(scene, mesh);
    const DrawnPoints terrain = terrain_of(field, camera), drawn = raster.draw(camera, terrain, Light({}, 0), false);
    const glm::dmat4 ndc = camera.ndc_from_world();
    const bool perspective = ndc[3][3] != 1;
    int judged = 0, seen = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
        const auto met_at = [&](double dx, double dy) {
          const Ray ray = camera.ray(x + 0.5 + dx, y + 0.5 + dy);
          return std::pair(ray, cast(mesh, ray.origin, ray.direction));
        };
        const auto straight = met_at(0, 0);
        const Ray& ray = straight.first;
        const Met& met = straight.second;
        const double z = std::isinf(met.t) ? kInfinity : dot(ray.at(met.t) - camera.eye(), camera.forward());
        // Of a place on the mesh, of which there is one where it is judged.
        const double w = perspective ? (std::isinf(z) ? 1 : z) : 1;
        const double terms = 8 * kUnit * (size_of(mesh) + length(mesh.front().position - camera.eye())) *
                             (std::abs(ndc[0][0]) + std::abs(ndc[1][0]) + std::abs(ndc[0][1]) + std::abs(ndc[1][1]) +
                              std::abs(ndc[2][0]) + std::abs(ndc[2][1]) + 3) /
                             w;
        const double s = snap() + terms * kWidth / 2 + 4 * kUnit * kWidth;
        const double gone = static_cast<double>(terrain.depth[i]);
        const auto bound_of = [&](const Met& at) {
          const dvec3 n = at.normal, forward = camera.forward();
          // Neighbouring rays meet the same plane.
          const auto inverse = [&](double dx, double dy) {
            const Ray beside = camera.ray(x + 0.5 + dx, y + 0.5 + dy);
            const double t = dot(ray.at(at.t) - beside.origin, n) / dot(beside.direction, n);
            const double depth = dot(beside.at(t) - camera.eye(), forward);
            return perspective ? 1 / depth : depth;
          };
          const double slope = std::abs(inverse(0.5, 0) - inverse(-0.5, 0)) * kWidth +
                               std::abs(inverse(0, 0.5) - inverse(0, -0.5)) * kHeight;
          const double of = perspective ? 1 / z : 4 * length(camera.eye());  // far is twice the farthest
          return s * slope / std::min(kWidth, kHeight) + 16 * kUnit * (of + slope) +
                 (perspective ? of * terms : of * 8 * kUnit);
        };
        const auto front = [&](const Met& at, const Ray& through) {
          if (std::isinf(at.t)) return 0;
          const double depth = dot(through.at(at.t) - camera.eye(), camera.forward());
          if (std::isinf(gone)) return 1;
          const double difference = perspective ? 1 / depth - 1 / gone : gone - depth;
          const double bound = bound_of(at) + (perspective ? 4 * kUnit / gone : 8 * kUnit * gone);
          return difference > bound ? 1 : difference < -bound ? 0 : 2;
        };
        const int expected = front(met, ray);
        bool sure = expected != 2;
        for (const auto& [dx, dy] : {std::pair(-s, -s), {s, -s}, {-s, s}, {s, s}}) {
          const auto [beside, other] = met_at(dx, dy);
          sure = sure && front(other, beside) == expected;
        }
        if (!sure) continue;
        ++judged;
        EXPECT_EQ(int{drawn.mesh[i]}, expected) << x << ", " << y << ": mesh " << z << ", ground " << gone;
        EXPECT_EQ(drawn.colour[i] == vec3(0.5f), expected == 0);
        if (expected != 1) {
          EXPECT_EQ(drawn.depth[i], terrain.depth[i]);
          continue;
        }
        ++seen;
        const double there = static_cast<double>(drawn.depth[i]);
        EXPECT_LE(perspective ? std::abs(1 / there - 1 / z) : std::abs(there - z),
                  bound_of(met) + (perspective ? kUnit / z : kUnit * z))
            << x << ", " << y << ": " << there << " for " << z;
        EXPECT_LT(dot(dvec3(drawn.normal[i]), ray.direction), 0.0);
      }
    }
    EXPECT_GT(judged, kWidth * kHeight * 9 / 10);
    EXPECT_GT(seen, least);
    EXPECT_LT(seen, kWidth * kHeight / 2);
  }
};

// The sphere of the issue: half in the ground, hidden by a ridge and hiding others.
TEST_F(MeshOnDevice, ASphereInTheGroundIsSeenWhereItIsNearer) {
  const HeightField field = ridges();
  const dvec3 middle(field.width() / 2, field.depth() / 2, 454);
  const Camera camera = Camera::framed(picture_box(field, false),
                                       {.azimuth_deg = 160, .elevation_deg = 20, .distance = 0.5}, 0, kWidth, kHeight);
  expect_order(field, ball(middle, 12), camera, 250);
  expect_order(field, ball(middle + dvec3(-20, 30, 0), 9), camera, 50);
}

TEST_F(MeshOnDevice, AlsoOnAMap) {
  const HeightField field = ridges();
  const dvec3 middle(field.width() / 2, field.depth() / 2, 452);
  expect_order(field, ball(middle, 10), Camera::top(picture_box(field, false), kWidth, kHeight), 50);
}

// Level to the camera's axis there is nothing that a place beside could change: depths are near / z but for rounding.
TEST_F(MeshOnDevice, DepthsOfWhatFacesTheCameraAreRounded) {
  const HeightField field = ridges();
  const Camera camera = Camera::look_at({-60, -80, 520}, {60, 70, 450}, 40, kWidth, kHeight);
  const glm::dmat4 turn = camera.camera_from_world();
  const dvec3 right(turn[0][0], turn[1][0], turn[2][0]), up(turn[0][1], turn[1][1], turn[2][1]);
  for (const double z : {0.5, 30.0, 150.0}) {
    const dvec3 middle = camera.eye() + z * camera.forward();
    expect_order(field, plate(middle - 0.2 * z * right - 0.15 * z * up, 0.4 * z * right, 0.3 * z * up), camera, 300);
  }
}

// Far from the origin of the world floats hold the mesh's size, not its place.
TEST_F(MeshOnDevice, ASmallMeshFarAway) {
  const HeightField field =
      HeightField::own(std::vector<float>(4096 * 8, 100.0f), 4096, 8, {.cell_x = 30, .cell_y = 30});
  const dvec3 middle(120000.25, 100.125, 102);
  const Camera camera = Camera::look_at(middle + dvec3(-9, -20, 6), middle, 30, kWidth, kHeight);
  expect_order(field, ball(middle, 3), camera, 500);
}

// A ball in the shadow of a wall, in part. Of each pixel that shows it the CPU asks the same ray from the same place,
// and from places as far away as the place's own error.
TEST_F(MeshOnDevice, TerrainHidesTheSunFromTheMesh) {
  const HeightField field = walled();
  const std::vector<MeshCorner> mesh = ball({30, 41, 18}, 7);
  const Camera camera = Camera::look_at({60, 80, 40}, {30, 41, 18}, 30, kWidth, kHeight);
  for (const double azimuth : {180.0, 150.0, 0.0}) {
    const TerrainScene scene = terrain_scene_on(device(), field), cpu(field, find_height_march("max-mip"));
    MeshRaster raster(scene, mesh);
    const Light light({.azimuth_deg = azimuth, .altitude_deg = 35}, 0);
    const DrawnPoints drawn = raster.draw(camera, terrain_of(field, camera), light, true);
    int lit = 0, dark = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
        const Ray through = camera.ray(x + 0.5, y + 0.5);
        const Met met = cast(mesh, through.origin, through.direction);
        if (!drawn.mesh[i] || std::isinf(met.t)) continue;
        const dvec3 n = dvec3(drawn.normal[i]), p = through.at(met.t);
        const double cosine = dot(n, light.to_sun());
        if (cosine < 0.01 || dot(met.normal, n) < 0.999) continue;
        Ray ray;
        ray.direction = light.to_sun();
        const double error = 64 * kUnit * (14 + 64 + 30) / std::abs(dot(met.normal, through.direction));
        int blocked = 0;
        for (int k = 0; k < 9; ++k) {
          const dvec3 corner(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
          ray.origin = k == 8 ? p : p + error * corner;
          blocked += cpu.occluded(ray);
        }
        if (blocked != 0 && blocked != 9) continue;
        const vec3 expected = kRed * light.on(n, blocked == 0 ? cosine : 0, 1);
        EXPECT_LT(length(drawn.colour[i] - expected), 1e-5f) << x << ", " << y << " from " << azimuth;
        ++(blocked ? dark : lit);
      }
    }
    EXPECT_GT(lit, azimuth == 0 ? 100 : 20) << azimuth;
    if (azimuth != 0) {
      EXPECT_GT(dark, 20) << azimuth;
    } else {
      EXPECT_EQ(dark, 0) << azimuth;
    }
  }
}

// Edges are right to `reach` texels along both axes, and everything else is.
TEST_F(MeshOnDevice, TheMapIsTheMeshsShadow) {
  const HeightField field = walled();
  std::vector<MeshCorner> mesh = ball({40.3, 20.7, 19}, 4);
  for (const MeshCorner& corner : plate({20, 10, 10}, {6, 1, 0}, {0, 0.5, 9})) mesh.push_back(corner);
  const TerrainScene scene = terrain_scene_on(device(), field);
  MeshRaster raster(scene, mesh);
  for (const SunSettings& sun : {SunSettings{200, 30}, SunSettings{95, 5}, SunSettings{0, 90}}) {
    const Light light(sun, 0);
    const auto shadow = raster.cast_shadow(light.to_sun());
    const SunMapFrame& frame = shadow->frame();
    int hidden = 0, judged = 0;
    for (int k = 0; k < 20000; ++k) {
      // All over the map, at heights in front of, in and behind the mesh.
      const double i = std::fmod(k * 0.754877666, 1.0) * frame.side, j = std::fmod(k * 0.569840291, 1.0) * frame.side;
      const double h = (std::fmod(k * 0.43, 1.0) * 3 - 1.5) * frame.range;
      const dvec3 p = frame.low + frame.texel * (i * frame.across + j * frame.up) + h * frame.to_sun;
      int blocked = 0;
      for (int corner = 0; corner < 5; ++corner) {
        const double move = corner == 4 ? 0 : 1.001 * frame.reach * frame.texel;
        const dvec3 from = p + (corner & 1 ? move : -move) * frame.across + (corner & 2 ? move : -move) * frame.up;
        // What is no higher than rounding is not counted as above.
        blocked += !std::isinf(cast(mesh, from, frame.to_sun, 2 * frame.rounding * frame.range).t);
      }
      if (blocked != 0 && blocked != 5) continue;
      ++judged;
      hidden += blocked == 5;
      EXPECT_EQ(shadow->hides(p), blocked == 5) << i << ", " << j << ", " << h << ", sun " << sun.altitude_deg;
    }
    EXPECT_GT(judged, 19000);
    EXPECT_GT(hidden, 200) << sun.altitude_deg;
    EXPECT_FALSE(shadow->hides(frame.low - 1000.0 * frame.across));
  }
}

// Planes do not hide themselves, however low the sun; a plate over another does.
TEST_F(MeshOnDevice, TheMeshHidesTheSunFromItself) {
  const HeightField field = walled();
  std::vector<MeshCorner> mesh = plate({10, 5, 12}, {20, 0, 2}, {0, 15, 1});
  for (const MeshCorner& corner : plate({15, 8, 19}, {6, 0, 0}, {0, 6, 0})) mesh.push_back(corner);
  const TerrainScene scene = terrain_scene_on(device(), field);
  const Camera camera = Camera::look_at({20, 6, 60}, {20, 12, 12}, 40, kWidth, kHeight);
  MeshRaster raster(scene, mesh);
  const DrawnPoints terrain = terrain_of(field, camera);
  for (const double altitude : {10.0, 45.0}) {
    const Light light({.azimuth_deg = 290, .altitude_deg = altitude}, 0);
    const auto shadow = raster.cast_shadow(light.to_sun());
    const DrawnPoints drawn = raster.draw(camera, terrain, light, true);
    const double texel = shadow->frame().reach * shadow->frame().texel * 1.01;
    int lit = 0, dark = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
        const Ray through = camera.ray(x + 0.5, y + 0.5);
        const Met met = cast(mesh, through.origin, through.direction);
        if (!drawn.mesh[i] || std::isinf(met.t)) continue;
        const dvec3 n = dvec3(drawn.normal[i]), p = through.at(met.t);
        if (std::abs(dot(met.normal, n)) < 0.999) continue;
        const double cosine = std::max(0.0, dot(n, light.to_sun()));
        int blocked = 0;
        for (int corner = 0; corner < 5; ++corner) {
          const double move = corner == 4 ? 0 : texel;
          const dvec3 from = p + (corner & 1 ? move : -move) * shadow->frame().across +
                             (corner & 2 ? move : -move) * shadow->frame().up;
          // Moved off its own plane; the plates are metres apart.
          blocked += !std::isinf(cast(mesh, from, light.to_sun(), 0.5).t);
        }
        if (blocked != 0 && blocked != 5) continue;
        const vec3 expected = kRed * light.on(n, blocked == 0 ? cosine : 0, 1);
        EXPECT_LT(length(drawn.colour[i] - expected), 1e-5f) << x << ", " << y << " at " << altitude;
        ++(blocked ? dark : lit);
      }
    }
    EXPECT_GT(lit, 300);
    if (altitude > 20) {
      EXPECT_GT(dark, 50);
    }
  }
}

PictureSettings small_picture() {
  PictureSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  return settings;
}

// Beside the picture a mesh changes nothing, byte by byte, in all of the ways to colours: where pictures without one
// are not made on the device as a whole, as by a march that is not exact.
TEST_F(MeshOnDevice, APictureWithoutTheMeshInItIsTheSame) {
  const HeightField field = ridges(true);
  const TerrainScene scene = terrain_scene_on(device(), field, find_height_march("lipschitz"));
  const Camera camera = Camera::framed(picture_box(field, true), {}, 0, kWidth, kHeight);
  MeshRaster mesh(scene, ball({-5000, -9000, 3000}, 5));
  PictureSettings settings = small_picture();
  for (const int samples : {0, 2}) {
    settings.samples = samples;
    settings.ground.natural = samples > 0;
    EXPECT_EQ(render_with_mesh(scene, mesh, camera, 0, settings).image.rgb,
              render_picture(scene, camera, 0, settings).image.rgb);
    const PictureLayers with = render_layers_with_mesh(scene, mesh, camera, 0, settings),
                        without = render_layers(scene, camera, 0, settings);
    EXPECT_EQ(with.depth, without.depth);
    EXPECT_EQ(with.normal, without.normal);
    for (std::size_t i = 0; i < with.colour.size(); ++i) EXPECT_LT(length(with.colour[i] - without.colour[i]), 1e-6f);
  }
}

TEST_F(MeshOnDevice, ItsShadowLiesOnTheGround) {
  const HeightField field = walled();
  const TerrainScene scene = terrain_scene_on(device(), field);
  PictureSettings settings = small_picture();
  settings.haze = 0;
  settings.sun = {180, 45};
  const Camera camera = Camera::top(picture_box(field, true), kWidth, kHeight);
  MeshRaster mesh(scene, ball({32, 12, 16}, 3));
  const Image with = render_with_mesh(scene, mesh, camera, 0, settings).image,
              without = render_picture(scene, camera, 0, settings).image;
  // From the south at 45 degrees: 6 m above the ground, 6 m to the north.
  const auto grey = [&](const Image& image, double x, double y) {
    const dvec2 at = camera.pixel({x, y, 10}).value();
    return int{image.pixel(static_cast<int>(at.x), static_cast<int>(at.y))[0]};
  };
  EXPECT_LT(grey(with, 32, 18), grey(without, 32, 18) - 40);
  EXPECT_EQ(grey(with, 38, 18), grey(without, 38, 18));
  EXPECT_EQ(grey(with, 32, 6), grey(without, 32, 6));
  settings.shadows = false;
  const Image plain = render_with_mesh(scene, mesh, camera, 0, settings).image;
  EXPECT_EQ(grey(plain, 32, 18), grey(render_picture(scene, camera, 0, settings).image, 32, 18));
}

TEST_F(MeshOnDevice, LayersHaveTheMesh) {
  const HeightField field = walled();
  const TerrainScene scene = terrain_scene_on(device(), field);
  const Camera camera = Camera::look_at({32, -40, 30}, {32, 12, 16}, 30, kWidth, kHeight);
  MeshRaster mesh(scene, ball({32, 12, 16}, 3, 64));
  const PictureLayers layers = render_layers_with_mesh(scene, mesh, camera, 0, small_picture());
  const std::size_t middle = kHeight / 2 * kWidth + kWidth / 2;
  EXPECT_NEAR(length(dvec3(layers.position[middle]) - dvec3(32, 12, 16)), 3, 0.01);
  EXPECT_GT(dot(dvec3(layers.normal[middle]), -camera.forward()), 0.95);
  EXPECT_NEAR(static_cast<double>(layers.depth[middle]), length(dvec3(0, 52, 14)) - 3, 0.05);
}

TEST_F(MeshOnDevice, BadRequestsAreRefused) {
  const HeightField field = walled();
  const TerrainScene cpu(field, find_height_march("max-mip")), scene = terrain_scene_on(device(), field);
  EXPECT_EQ(refusal([&] {
              MeshRaster(cpu, ball({0, 0, 0}, 1));
            }),
            "mesh: is drawn by a Vulkan device, and the scene is not on one");
  EXPECT_EQ(refusal([&] { MeshRaster(scene, {}); }), "mesh: has no triangles");
  MeshRaster mesh(scene, ball({0, 0, 20}, 1));
  const Camera camera = Camera::top(picture_box(field, true), kWidth, kHeight);
  PictureSettings settings = small_picture();
  settings.look = Look::height;
  EXPECT_EQ(refusal([&] { render_with_mesh(scene, mesh, camera, 0, settings); }),
            "mesh: goes with the look 'shaded', not with 'height'");
  settings.look = Look::shaded;
  const std::uint32_t most = raster_limits(device()).most_pixels;
  settings.width = static_cast<int>(most / 2 + 1);
  EXPECT_EQ(refusal([&] { render_with_mesh(scene, mesh, camera, 0, settings); }),
            "mesh: device '" + device().description().name + "' draws " + std::to_string(most) +
                " points a side at most, and the picture has " + std::to_string(most + 2) + " x " +
                std::to_string(2 * kHeight) + "; render it smaller or with a smaller aa");
  settings.width = kWidth;
  settings.water.emplace();
  EXPECT_EQ(refusal([&] { render_layers_with_mesh(scene, mesh, camera, 0, settings); }),
            "mesh: is not reflected by water; leave one of both out");
}

TEST(MeshLayout, IsThatOfTheShaders) {
  using glsl::MeshVertex, glsl::MeshView, glsl::SunMap;
  for (const auto& words : {std::span<const std::uint32_t>(kVertex), std::span<const std::uint32_t>(kFragment)}) {
    EXPECT_TRUE(has_struct(words, {offsetof(MeshView, corners),
                                   offsetof(MeshView, ground),
                                   offsetof(MeshView, map),
                                   offsetof(MeshView, colours),
                                   offsetof(MeshView, depths),
                                   offsetof(MeshView, clip_x),
                                   offsetof(MeshView, clip_y),
                                   offsetof(MeshView, clip_z),
                                   offsetof(MeshView, clip_w),
                                   offsetof(MeshView, eye),
                                   offsetof(MeshView, to_sun),
                                   offsetof(MeshView, sun),
                                   offsetof(MeshView, sky_side),
                                   offsetof(MeshView, sun_map),
                                   offsetof(MeshView, base_cell),
                                   offsetof(MeshView, base_place),
                                   offsetof(MeshView, base_z),
                                   offsetof(MeshView, base_z_low),
                                   offsetof(MeshView, grid_per_metre),
                                   offsetof(MeshView, width),
                                   offsetof(MeshView, shadows)}));
    EXPECT_TRUE(has_struct(words, {offsetof(SunMap, low), offsetof(SunMap, across), offsetof(SunMap, up),
                                   offsetof(SunMap, to_sun), offsetof(SunMap, texel), offsetof(SunMap, side),
                                   offsetof(SunMap, range), offsetof(SunMap, reach), offsetof(SunMap, rounding)}));
  }
  EXPECT_TRUE(has_struct(kVertex, {offsetof(MeshVertex, position), offsetof(MeshVertex, normal),
                                   offsetof(MeshVertex, plane), offsetof(MeshVertex, colour)}));
  EXPECT_TRUE(has_array_stride(kVertex, sizeof(MeshVertex)));
}

TEST(PlacedMesh, StandsOnItsFeetAndTurnsClockwise) {
  TriangleMesh mesh;
  mesh.corners = {{{1, 1, 5}, {0, 1, 0}}, {{3, 1, 5}, {0, 1, 0}}, {{1, 3, 9}, {0, 1, 0}}};
  const std::vector<MeshCorner> at = placed(mesh, {.at = {100, 200, 50}, .scale = 2, .turn_deg = 90});
  // Its middle is (2, 2), its lowest height 5: (1, 1) is 1 to the west and 1 to the south, turned 1 to the west and
  // 1 to the north.
  EXPECT_LT(length(at[0].position - dvec3(98, 202, 50)), 1e-12);
  EXPECT_LT(length(at[1].position - dvec3(98, 198, 50)), 1e-12);
  EXPECT_LT(length(at[2].position - dvec3(102, 202, 58)), 1e-12);
  EXPECT_LT(length(at[0].normal - vec3(1, 0, 0)), 1e-6f);
  EXPECT_EQ(refusal([&] { placed(mesh, {.scale = 0}); }), "mesh: the scale is 0; it must be above 0");
  EXPECT_EQ(refusal([&] { placed(mesh, {.scale = 1e308}); }), "mesh: is too large at this scale");
  EXPECT_EQ(refusal([&] { placed(mesh, {.turn_deg = INFINITY}); }),
            "mesh: its place and its turn must be finite numbers");
}

}  // namespace
}  // namespace scarp::test
