// SPDX-License-Identifier: MIT
// cast_from() with cameras, scanners and fans over a terrain has the hits of cast().
#include "scarp/scene/cast_from.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/scene/cast.h"

namespace scarp {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<float> waves(int cols, int rows) {
  std::vector<float> samples;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col)
      samples.push_back(static_cast<float>(20 * std::sin(0.05 * col) * std::cos(0.04 * row) + std::sin(0.7 * col)));
  }
  return samples;
}

Terrain terrain(const HeightFieldSettings& settings = {.cell_x = 10, .cell_y = 8}) {
  return Terrain::own(waves(201, 150), 201, 150, settings);
}

// direction(column, row): the directions of the answers.
template <class Direction>
void expect_as_cast(const Terrain& ground, const FanAnswers& answers, const dvec3& eye, double t_max,
                    const Direction& direction) {
  int hits = 0;
  for (int row = 0; row < answers.rows; ++row) {
    for (int column = 0; column < answers.columns; ++column) {
      Ray ray;
      ray.origin = eye;
      ray.t_max = t_max;
      const dvec3 d = direction(column, row);
      ray.direction = {static_cast<double>(static_cast<float>(d.x)), static_cast<double>(static_cast<float>(d.y)),
                       static_cast<double>(static_cast<float>(d.z))};
      const Hit hit = cast(ground, ray);
      const auto at = static_cast<std::size_t>(row * answers.columns + column);
      ASSERT_EQ(answers.status[at], hit.status) << column << " " << row;
      if (!hit) continue;
      ++hits;
      ASSERT_NEAR(static_cast<double>(answers.t[at]), hit.t, 1e-3 * hit.t + 1e-3) << column << " " << row;
    }
  }
  EXPECT_GT(hits, answers.columns * answers.rows / 4);
}

TEST(CastFrom, CameraMatchesItsRays) {
  const Terrain ground = terrain();
  for (const int columns : {1, 16, 77}) {
    PinholeCamera camera{.eye = {1003, 597, 45}, .forward = {0.3, 1, -0.4}, .columns = columns, .rows = 41};
    camera.t_max = 700;
    FanAnswers answers(camera.columns, camera.rows);
    cast_from(ground, camera, answers);
    const dvec3 forward = normalize(camera.forward), right = normalize(cross(forward, dvec3(0, 0, 1)));
    const dvec3 up = cross(right, forward);
    const double pixel = 2.0 / columns;
    expect_as_cast(ground, answers, camera.eye, camera.t_max, [&](int column, int row) {
      return forward + pixel * (column + 0.5 - 0.5 * columns) * right + pixel * (0.5 * camera.rows - row - 0.5) * up;
    });
  }
}

TEST(CastFrom, ScannerMatchesItsRays) {
  const Terrain ground = terrain();
  Scanner scanner{.eye = {1003, 597, 40}, .columns = 100, .first_azimuth = 0.1, .azimuth_step = 2 * kPi / 100};
  for (int row = 0; row < 30; ++row) scanner.elevations.push_back(0.1 - 0.02 * row);
  FanAnswers answers(scanner.columns, 30);
  cast_from(ground, scanner, answers);
  expect_as_cast(ground, answers, scanner.eye, std::numeric_limits<double>::infinity(), [&](int column, int row) {
    const double azimuth = scanner.first_azimuth + column * scanner.azimuth_step;
    const double elevation = scanner.elevations[static_cast<std::size_t>(row)];
    return dvec3(std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
  });
}

// With seams between any two copies, at which the samples do not match: periodic ground has a cell there.
TEST(CastFrom, WrappedGroundIsHitWhereItsRaysDo) {
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    const Terrain ground = terrain({.cell_x = 10, .cell_y = 8, .surface = surface, .wrap = Wrap::periodic});
    for (const dvec3& eye : {dvec3(1003, 597, 45), dvec3(2009, -1, 45), dvec3(-7003.5, 12003, 60), dvec3(0, 0, 30)}) {
      for (const double turn : {0.3, 2.0, 3.9, 5.5}) {
        PinholeCamera camera{.eye = eye, .forward = {std::sin(turn), std::cos(turn), -0.2}, .columns = 77, .rows = 41};
        camera.t_max = 6000;
        FanAnswers answers(camera.columns, camera.rows);
        cast_from(ground, camera, answers);
        const dvec3 forward = normalize(camera.forward), right = normalize(cross(forward, dvec3(0, 0, 1)));
        const dvec3 up = cross(right, forward);
        const double pixel = 2.0 / camera.columns;
        expect_as_cast(ground, answers, camera.eye, camera.t_max, [&](int column, int row) {
          return forward + pixel * (column + 0.5 - 0.5 * camera.columns) * right +
                 pixel * (0.5 * camera.rows - row - 0.5) * up;
        });
      }
    }
  }
}

// Those of HeightField, and of the walls of solid ground, which eyes outside see.
TEST(CastFrom, GivesNormalsOnRequest) {
  int hits = 0, walls = 0;
  for (const Wrap wrap : {Wrap::none, Wrap::periodic}) {
    const Terrain ground = terrain({.cell_x = 10, .cell_y = 8, .wrap = wrap, .solid = true});
    const HeightField& field = *ground.scene().terrain();
    for (const dvec3& eye : {dvec3(1003, 597, 45), dvec3(-200, 597, 10)}) {
      PinholeCamera camera{.eye = eye, .forward = {1, 0.2, -0.2}, .columns = 50, .rows = 41, .t_max = 5000};
      FanAnswers answers(camera.columns, camera.rows, true);
      cast_from(ground, camera, answers);
      for (std::size_t i = 0; i < answers.t.size(); ++i) {
        const dvec3 normal(dvec3(vec3(answers.nx[i], answers.ny[i], answers.nz[i])));
        if (answers.status[i] != HitStatus::hit) {
          ASSERT_EQ(normal, dvec3(0.0));
          continue;
        }
        ++hits;
        ASSERT_NEAR(length(normal), 1, 1e-6);
        if (answers.nz[i] == 0) {
          ++walls;
          continue;
        }
        const dvec3 expected = field.normal({answers.col[i], answers.row[i]}, static_cast<double>(answers.u[i]),
                                            static_cast<double>(answers.v[i]));
        ASSERT_NEAR(length(normal - expected), 0, 1e-5);
      }
    }
  }
  EXPECT_GT(hits, 2000);
  EXPECT_GT(walls, 10);
}

TEST(CastFrom, AcceptsCallerDirectionsOnAllThreads) {
  const Terrain ground = terrain();
  const int columns = 333, rows = 64;
  FanAnswers answers(columns, rows);
  std::vector<float> dx, dy, dz;
  const auto direction = [&](int column, int row) {
    return dvec3(std::sin(0.01 * column), std::cos(0.01 * column), -0.5 + 0.01 * row);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const dvec3 d = direction(column, row);
      dx.push_back(static_cast<float>(d.x)), dy.push_back(static_cast<float>(d.y));
      dz.push_back(static_cast<float>(d.z));
    }
  }
  Fan fan;
  fan.origin = {900, 100, 50};
  fan.dx = dx.data(), fan.dy = dy.data(), fan.dz = dz.data();
  fan.columns = columns, fan.rows = rows, fan.row_stride = columns;
  cast_from(ground, fan, answers.hits());
  expect_as_cast(ground, answers, fan.origin, fan.t_max, direction);
}

// Beside the border, the width of the seam decides whether a ray hits.
TEST(CastFrom, EyesBesideTheBorderMatchTheirRays) {
  int hits = 0;
  for (const double cell : {10.0, 7.7, 0.1}) {
    const Terrain ground = terrain({.cell_x = cell, .cell_y = cell});
    for (const double beside : {0.0, 1e-9, -1e-9, 1e-11, -1e-11}) {
      for (const double over : {1e-9, 0.0, -1e-9, -20.0, 1.0}) {
        const double along = 60.3 * cell, height = ground.height(0, along).value() + over;
        Scanner scanner{.eye = {beside * cell, along, height}, .columns = 40, .azimuth_step = 2 * kPi / 40};
        scanner.elevations = {-1.57, -0.9, -0.3, -0.01, 0, 0.2, 1.1, kPi / 2};
        FanAnswers answers(scanner.columns, static_cast<int>(scanner.elevations.size()));
        cast_from(ground, scanner, answers);
        for (int i = 0; i < answers.columns * answers.rows; ++i) {
          const double azimuth = i % answers.columns * scanner.azimuth_step;
          const double elevation = scanner.elevations[static_cast<std::size_t>(i / answers.columns)];
          const double flat = std::cos(elevation);
          Ray ray;
          ray.origin = scanner.eye;
          ray.direction = dvec3(vec3(dvec3(flat * std::sin(azimuth), flat * std::cos(azimuth), std::sin(elevation))));
          const Hit hit = cast(ground, ray);
          hits += static_cast<bool>(hit);
          ASSERT_EQ(answers.status[static_cast<std::size_t>(i)], hit.status)
              << "cell " << cell << ", eye " << beside << " cells beside the border, " << over << " over it, ray " << i;
        }
      }
    }
  }
  EXPECT_GT(hits, 5000);
}

TEST(CastFrom, LengthsOfDirectionsOfACameraDoNotMatter) {
  const Terrain ground = terrain();
  PinholeCamera camera{.eye = {100, 100, 50}, .forward = {1, 0.5, -1}, .columns = 32, .rows = 24};
  FanAnswers usual(32, 24), other(32, 24);
  cast_from(ground, camera, usual);
  EXPECT_GT(std::count(usual.status.begin(), usual.status.end(), HitStatus::hit), 300);
  for (const double length : {0x1p-1000, 0x1p-600, 0x1p600, 0x1p1000}) {
    camera.forward = dvec3{1, 0.5, -1} * length, camera.up = dvec3(0, 0, 1) * length;
    cast_from(ground, camera, other);
    EXPECT_TRUE(other.t == usual.t && other.status == usual.status) << length;
  }
}

TEST(CastFrom, RejectsInvalidInput) {
  const Terrain ground = terrain(), endless = terrain({.wrap = Wrap::periodic});
  PinholeCamera camera{.eye = {100, 100, 50}, .columns = 4, .rows = 3};
  FanAnswers answers(4, 3);
  EXPECT_NO_THROW(cast_from(ground, camera, answers));
  EXPECT_THROW(cast_from(endless, camera, answers), Error);
  FanAnswers other(3, 4);
  EXPECT_THROW(cast_from(ground, camera, other), Error);
  PinholeCamera bad = camera;
  bad.forward = bad.up;
  EXPECT_THROW(cast_from(ground, bad, answers), Error);
  for (const double width : {0.0, -1.0, 1e7, HUGE_VAL}) {
    bad = camera;
    bad.tan_half_width = width;
    EXPECT_THROW(cast_from(ground, bad, answers), Error) << width;
  }
  bad = camera;
  bad.eye.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(cast_from(ground, bad, answers), Error);
  bad = camera;
  bad.t_max = -1;
  EXPECT_THROW(cast_from(ground, bad, answers), Error);
  EXPECT_THROW(cast_from(ground, Fan{.columns = 1, .rows = 1}, FanHits{}), Error);
  float number = 0;
  std::int32_t cell = 0;
  FanHits torn{&number, &cell, &cell, &number, &number};
  torn.nx = &number;
  const Fan one{.dx = &number, .dy = &number, .dz = &number, .columns = 1, .rows = 1};
  EXPECT_THROW(cast_from(ground, one, torn), Error);
  auto memory = std::make_shared<std::vector<float>>(waves(9, 9));
  const Terrain view = Terrain::view(memory->data(), 9, 9, {}, 0, memory);
  EXPECT_NO_THROW(cast_from(view, camera, answers));
  memory.reset();
  EXPECT_THROW(cast_from(view, camera, answers), Error);
}

}  // namespace
}  // namespace scarp
