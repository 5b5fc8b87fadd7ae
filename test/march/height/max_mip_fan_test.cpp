// SPDX-License-Identifier: MIT
// Fans hit where the scalar march does, within the tolerance of numerics.md: over every kind of field, from eyes near,
// far, beside and below it, with fans of cameras and scanners and with spiteful ones, on every instruction set.
#include "scarp/march/height/max_mip_fan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cases.h"
#include "march/height/spiteful.h"
#include "march/instruction_sets.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/rounding.h"
#include "scarp/march/usual_ray.h"

namespace scarp::test {
namespace {

const int kFansPerField = cases(400, 40, 2);
const int kRounds = cases(40, 2, 1);
constexpr double kPi = std::numbers::pi;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The arrays of a fan, in rows or in strips.
struct Rays {
  dvec3 origin{0.0};
  int columns = 1, rows = 1;
  bool strips = false;
  std::vector<float> dx{}, dy{}, dz{};
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();

  Rays(dvec3 eye, int width, int height, bool in_strips)
      : origin(eye), columns(width), rows(height), strips(in_strips) {
    const auto count = static_cast<std::size_t>((columns + 15) / 16 * 16 * rows);
    for (std::vector<float>* numbers : {&dx, &dy, &dz}) numbers->resize(count, 1.0f);
  }
  Fan fan() const {
    Fan f;
    f.origin = origin;
    f.dx = dx.data(), f.dy = dy.data(), f.dz = dz.data();
    f.columns = columns, f.rows = rows;
    f.row_stride = strips ? 16 : columns, f.strip_stride = strips ? 16 * rows : 16;
    f.t_min = t_min, f.t_max = t_max;
    return f;
  }
  std::size_t at(int column, int row) const {
    const Fan f = fan();
    return static_cast<std::size_t>(row * f.row_stride + column / 16 * f.strip_stride + column % 16);
  }
  void put(int column, int row, dvec3 direction) {
    const std::size_t i = at(column, row);
    dx[i] = static_cast<float>(direction.x), dy[i] = static_cast<float>(direction.y);
    dz[i] = static_cast<float>(direction.z);
  }
  Ray ray(std::size_t i) const {
    Ray r;
    r.origin = origin;
    r.direction = {static_cast<double>(dx[i]), static_cast<double>(dy[i]), static_cast<double>(dz[i])};
    r.t_min = t_min, r.t_max = t_max;
    return r;
  }
};

// How far above or below the surface the place of a hit may be, in sample units: numerics.md, Fans.
double tolerance(const HeightTarget& target, const Ray& ray, double t) {
  const HeightField& field = *target.field;
  const GridRay g = field.grid_from_world(ray);
  const double relief =
      std::min(field.max_sample() - field.min_sample(), target.pyramid->cell_relief() * target.pyramid->code().step);
  const double cells = std::max(std::abs(g.direction.x), std::abs(g.direction.y)) * std::abs(t);
  return 0x1p-18 * (std::abs(g.direction.z * t) + (cells + 12) * relief) + 8 * rounding_of_clearance(field, g, t);
}

// The place of a ray from the corner of a cell, of that copy which is nearest.
dvec2 in_cell(const HeightField& field, const GridRay& g, double t, Cell cell) {
  const dvec2 off(g.origin.x + g.direction.x * t - cell.col, g.origin.y + g.direction.y * t - cell.row);
  if (!field.wraps()) return off;
  const dvec2 cells(field.cell_cols(), field.cell_rows());
  return off - glm::round((off - 0.5) / cells) * cells;
}

double height_over(const HeightField& field, const Ray& ray, double t, Cell cell) {
  const GridRay g = field.grid_from_world(ray);
  const auto h = field.cell_heights(cell);
  const dvec2 off = in_cell(field, g, t, cell);
  const double u = std::clamp(off.x, 0.0, 1.0), v = std::clamp(off.y, 0.0, 1.0);
  return g.origin.z + g.direction.z * t - height_in_cell(field.settings().surface, *h, u, v);
}

testing::AssertionResult same(const HeightTarget& target, const Ray& ray, const Hit& expected, HitStatus status,
                              double t, Cell cell, double u, double v) {
  const auto failure = [&](const char* why) {
    return testing::AssertionFailure() << why << ": status " << int(status) << ", expected " << int(expected.status)
                                       << ", t " << t << ", expected " << expected.t << ", cell " << cell.col << " "
                                       << cell.row << ", expected " << expected.cell.col << " " << expected.cell.row
                                       << ", u " << u << ", v " << v << ", direction " << ray.direction.x << " "
                                       << ray.direction.y << " " << ray.direction.z << ", origin " << ray.origin.x
                                       << " " << ray.origin.y << " " << ray.origin.z;
  };
  if (status != expected.status) return failure("status");
  if (status != HitStatus::hit) {
    const bool nothing = t == std::numeric_limits<double>::infinity() && cell == Cell{} && u == 0 && v == 0;
    return nothing ? testing::AssertionSuccess() : failure("numbers of a miss");
  }
  const HeightField& field = *target.field;
  if (!(cell.col >= 0 && cell.col < field.cell_cols() && cell.row >= 0 && cell.row < field.cell_rows()))
    return failure("no such cell");
  if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return failure("beside its cell");
  // Times of such directions are hardly floats.
  const double longest = longest_of(ray.direction);
  if (!(longest > 0x1p-60 && longest < 0x1p60)) return testing::AssertionSuccess();
  if (expected.wall) return testing::AssertionSuccess();
  const GridRay g = field.grid_from_world(ray);
  const double cells = std::max(std::abs(g.direction.x), std::abs(g.direction.y)) * std::abs(t);
  const double aside = 0x1p-19 * (cells + 4) + HeightField::rounding_of_line(g.origin.x, field.cell_cols()) +
                       HeightField::rounding_of_line(g.origin.y, field.cell_rows());
  const dvec2 off = in_cell(field, g, t, cell) - dvec2(u, v);
  // Copies that are a cell wide begin where they end.
  const auto on_ray = [&](double from, int period) {
    return std::abs(from) <= aside || (field.wraps() && std::abs(std::abs(from) - period) <= aside);
  };
  if (!on_ray(off.x, field.cell_cols()) || !on_ray(off.y, field.cell_rows())) return failure("not on the ray");
  const double most = tolerance(target, ray, std::max(std::abs(t), std::abs(expected.t)));
  if (std::abs(height_over(field, ray, t, cell)) > most) return failure("not on the surface");
  // No other hit: along the surface from one to the other.
  for (int i = 1; i < 8; ++i) {
    const double between = t + (expected.t - t) * i / 8;
    const dvec3 p = ray.at(between);
    const auto z = field.height(p.x, p.y);
    if (z && std::abs(p.z - *z) * field.grid_scales().per_scale > 2 * most) return failure("another hit");
  }
  return testing::AssertionSuccess();
}

// Hits from sights are those of march_max_mip(), for rays in double whose directions round to those of the fan.
void check_sights(const HeightTarget& target, const Rays& rays, const std::string& what, const FanOptions& options) {
  const Fan fan = rays.fan();
  std::vector<FanSight> sights(rays.dx.size(), {7, 7}), seen;
  const int middle = (rays.columns / 2 + 15) / 16 * 16;
  look_max_mip_fan(target, fan, sights.data(), 0, std::min(middle, rays.columns), options);
  look_max_mip_fan(target, fan, sights.data(), middle, rays.columns, options);
  Random random(static_cast<unsigned>(rays.columns * 64 + rays.rows));
  std::vector<Ray> precise;
  for (int c = 0; c < rays.columns; ++c) {
    for (int r = 0; r < rays.rows; ++r) {
      Ray ray = rays.ray(rays.at(c, r));
      if (!is_followable(ray)) continue;
      const double multiple = std::exp2(uniform(random, -3, 3));
      for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        const bool subnormal = std::abs(d) < static_cast<double>(std::numeric_limits<float>::min());
        ray.direction[axis] = multiple * d * (subnormal ? 1 : 1 + uniform(random, -0.99, 0.99) * 0x1p-25);
      }
      if (whole(random, 0, 2) == 0) ray.t_max = uniform(random, 0, 2) * target.field->width() / multiple;
      precise.push_back(ray), seen.push_back(sights[rays.at(c, r)]);
    }
  }
  std::vector<Hit> hits(precise.size());
  closest_hits_max_mip_seen(target, precise, seen, hits);
  for (std::size_t i = 0; i < precise.size(); ++i) {
    const Hit truth = march_max_mip(target, precise[i]);
    ASSERT_TRUE(hits[i] == truth) << what << ", sight " << seen[i].clear << " " << seen[i].cell << std::hexfloat
                                  << ", t " << hits[i].t << " for " << truth.t << ", direction "
                                  << precise[i].direction.x << " " << precise[i].direction.y << " "
                                  << precise[i].direction.z;
  }
}

void check(const HeightTarget& target, const Rays& rays, const std::string& what, const FanOptions& options = {}) {
  const Fan fan = rays.fan();
  const std::size_t count = rays.dx.size();
  std::vector<float> t(count, -7), u(count, -7), v(count, -7);
  std::vector<std::int32_t> col(count, -7), row(count, -7);
  std::vector<HitStatus> status(count, HitStatus::exhausted);
  FanOptions always = options;
  always.always = true;
  if (rays.t_min == 0) check_sights(target, rays, what, always);
  const int middle = (rays.columns / 2 + 15) / 16 * 16;
  const FanHits hits{t.data(), col.data(), row.data(), u.data(), v.data(), status.data()};
  closest_hits_max_mip_fan(target, fan, hits, 0, std::min(middle, rays.columns), always);
  closest_hits_max_mip_fan(target, fan, hits, middle, rays.columns, always);
  for (int c = 0; c < rays.columns; ++c) {
    for (int r = 0; r < rays.rows; ++r) {
      const std::size_t i = rays.at(c, r);
      const Ray ray = rays.ray(i);
      const Hit expected = is_followable(ray) ? march_max_mip(target, ray) : Hit{};
      ASSERT_TRUE(same(target, ray, expected, status[i], static_cast<double>(t[i]), {col[i], row[i]},
                       static_cast<double>(u[i]), static_cast<double>(v[i])))
          << what << ", column " << c << " of " << rays.columns << ", row " << r << " of " << rays.rows << std::hexfloat
          << ", directions " << rays.dx[i] << " " << rays.dy[i] << " " << rays.dz[i];
    }
  }
}

dvec3 direction_to(double azimuth, double altitude) {
  return {std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude), std::sin(altitude)};
}

double tall(const HeightField& f) {
  return f.all_nodata() ? 1 : std::max(f.max_height() - f.min_height(), 0.01 * f.settings().cell_x);
}

// Over nodes, edges and cells, at any height; beside the field and far from it; on its border or near its seams.
dvec3 eye(const HeightField& f, Random& random) {
  const auto along = [&](int cells) {
    const int kind = whole(random, 0, 9);
    if (f.wraps() && kind > 6)
      return whole(random, -1, 2) * cells + std::exp2(uniform(random, -60, 0)) * uniform(random, -1, 1);
    if (kind == 0) return uniform(random, -3, 0) * cells;
    if (kind == 1) return cells * uniform(random, 1, 40);
    if (kind == 2) return static_cast<double>(whole(random, 0, cells));
    return uniform(random, 0, cells);
  };
  const dvec3 at = f.world_from_grid(along(f.cell_cols()), along(f.cell_rows()), 0);
  const double low = f.all_nodata() ? 0 : f.min_height();
  const double ground = f.height(at.x, at.y).value_or(uniform(random, low, low + tall(f)));
  const int kind = whole(random, 0, 9);
  const double above = kind == 0   ? -uniform(random, 0, 1)
                       : kind == 1 ? 0
                       : kind == 2 ? uniform(random, 1, 50)
                                   : std::exp2(uniform(random, -16, 1));
  return {at.x, at.y, ground + above * tall(f)};
}

// Slopes suit the field: some rays meet the ground near and some far away.
Rays camera(const HeightField& f, Random& random, dvec3 from) {
  Rays rays(from, whole(random, 1, 40), whole(random, 1, 40), whole(random, 0, 1) == 0);
  const double yaw = uniform(random, 0, 2 * kPi), pitch = uniform(random, -1.5, 0.6);
  const double roll = whole(random, 0, 2) == 0 ? uniform(random, -0.5, 0.5) : 0;
  const dvec3 forward = direction_to(yaw, pitch), flat = normalize(cross(forward, dvec3(0, 0, 1)));
  const dvec3 tilted = cross(flat, forward);
  const dvec3 right = std::cos(roll) * flat + std::sin(roll) * tilted;
  const dvec3 up = cross(right, forward);
  const double half = uniform(random, 0.01, 1), lift = whole(random, 0, 1) ? tall(f) / (f.width() + f.depth()) : 1;
  for (int c = 0; c < rays.columns; ++c) {
    for (int r = 0; r < rays.rows; ++r) {
      const double x = (c + 0.5) / rays.columns * 2 - 1, y = 1 - (r + 0.5) / rays.rows * 2;
      dvec3 direction = forward + half * x * right + half * y * up;
      direction.z *= lift;
      rays.put(c, r, direction);
    }
  }
  return rays;
}

Rays scanner(const HeightField& f, Random& random, dvec3 from) {
  Rays rays(from, whole(random, 1, 70), whole(random, 1, 40), whole(random, 0, 1) == 0);
  const double from_azimuth = whole(random, 0, 1) ? 0 : uniform(random, 0, 7);
  const double lift = whole(random, 0, 1) ? tall(f) / (f.width() + f.depth()) : 1;
  const bool rising = whole(random, 0, 1);
  for (int c = 0; c < rays.columns; ++c) {
    for (int r = 0; r < rays.rows; ++r) {
      const double share = (r + 0.5) / rays.rows;
      dvec3 direction =
          direction_to(from_azimuth + 2 * kPi * c / rays.columns, -1.4 + 2 * (rising ? share : 1 - share));
      direction.z *= lift;
      rays.put(c, r, direction);
    }
  }
  return rays;
}

// Through nodes, edges and diagonals.
Rays aimed(const HeightField& f, Random& random, dvec3 from) {
  Rays rays(from, whole(random, 1, 33), whole(random, 1, 33), whole(random, 0, 1) == 0);
  for (int c = 0; c < rays.columns; ++c) {
    std::vector<dvec3> column;
    const int col = whole(random, 0, f.cols() - 1), row = whole(random, 0, f.rows() - 1);
    const int along = whole(random, -3, 3), across = whole(random, -3, 3);
    for (int r = 0; r < rays.rows; ++r) {
      const bool same_way = whole(random, 0, 3) != 0;
      dvec3 to = f.world_from_grid(same_way ? col : whole(random, 0, f.cols() - 1),
                                   same_way ? row : whole(random, 0, f.rows() - 1), 0);
      if (f.wraps()) to.x += along * f.width(), to.y += across * f.depth();
      to.z = f.height(to.x, to.y).value_or(0) + (whole(random, 0, 2) ? uniform(random, -0.1, 0.1) * tall(f) : 0);
      column.push_back(to - from);
    }
    const auto slope = [](const dvec3& d) { return d.z / std::hypot(d.x, d.y); };
    if (whole(random, 0, 3)) {
      std::sort(column.begin(), column.end(), [&](const dvec3& a, const dvec3& b) { return slope(a) < slope(b); });
    }
    for (int r = 0; r < rays.rows; ++r) rays.put(c, r, column[static_cast<std::size_t>(r)]);
  }
  return rays;
}

// Numbers that are none, none too many, equal slopes, slopes in any order, axes, diagonals and vertical rays.
Rays spiteful(const HeightField& f, Random& random, dvec3 from) {
  Rays rays(from, whole(random, 1, 33), whole(random, 1, 33), whole(random, 0, 1) == 0);
  const float numbers[] = {0.0f,     -0.0f,    1.0f,   -1.0f,     1e-40f,
                           -1e-45f,  1e38f,    -3e38f, kInfinity, std::numeric_limits<float>::quiet_NaN(),
                           0x1p-20f, 0x1p-30f, 1e6f};
  const auto number = [&] { return numbers[whole(random, 0, static_cast<int>(std::size(numbers)) - 1)]; };
  const double slope = uniform(random, -1, 0) * tall(f) / (f.width() + f.depth());
  for (int c = 0; c < rays.columns; ++c) {
    const double turn = c % 3 ? uniform(random, 0, 7) : whole(random, 0, 8) * kPi / 4;
    for (int r = 0; r < rays.rows; ++r) {
      const int kind = whole(random, 0, 7);
      const std::size_t i = rays.at(c, r);
      rays.put(c, r,
               {std::sin(turn), std::cos(turn),
                kind == 0  ? slope * r
                : kind < 4 ? slope
                           : uniform(random, -2, 1)});
      // Over a field that wraps round, rays must not be long.
      if (f.wraps()) continue;
      if (kind == 7) rays.dx[i] = number(), rays.dy[i] = number(), rays.dz[i] = number();
      if (kind == 6) rays.dz[i] = whole(random, 0, 1) ? number() : -1e30f;
    }
  }
  return rays;
}

template <class F>
void for_some_fans(const HeightTarget& target, Random& random, int count, const F& each) {
  for (int i = 0; i < count; ++i) {
    const HeightField& field = *target.field;
    const dvec3 from = eye(field, random);
    const int kind = whole(random, 0, 3);
    Rays rays = kind == 0   ? camera(field, random, from)
                : kind == 1 ? scanner(field, random, from)
                : kind == 2 ? aimed(field, random, from)
                            : spiteful(field, random, from);
    if (field.wraps() || whole(random, 0, 3) == 0) {
      const double most = kind == 2 ? 1 : field.width() + field.depth();
      rays.t_max = uniform(random, 0, whole(random, 0, 3) ? 2 : 12) * most;
    }
    if (whole(random, 0, 5) == 0) rays.t_min = std::min(rays.t_max, uniform(random, -0.1, 1) * field.width());
    each(rays, "fan " + std::to_string(i) + " of kind " + std::to_string(kind));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(MaxMipFan, HitsWhereTheScalarMarchDoesOverEveryKindOfField) {
  Random random(91);
  for (int round = 0; round < kRounds; ++round) {
    for (const FieldKind& kind : spiteful_fields()) {
      const HeightField field = kind.make(random);
      const MaxPyramid pyramid(field);
      const HeightTarget target{&field, &pyramid};
      if (!field.has_cells()) continue;
      for_some_fans(target, random, kFansPerField, [&](const Rays& rays, const std::string& what) {
        check(target, rays, std::string(kind.name) + ", " + what);
      });
      if (HasFatalFailure()) return;
    }
  }
}

// Sums of waves from a cell to the whole field wide.
template <class T>
HeightField terrain(Random& random, int cols, int rows, double base, double roughness, HeightFieldSettings settings) {
  std::vector<T> samples;
  const double phase = uniform(random, 0, 6);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double z = 60 * std::sin(0.011 * col + phase) * std::cos(0.013 * row) +
                       9 * std::sin(0.11 * col + 0.07 * row) + 2 * std::sin(0.9 * col) * std::cos(0.8 * row) +
                       roughness * uniform(random, 0, 1);
      samples.push_back(static_cast<T>(base + z));
    }
  }
  settings.cell_x = uniform(random, 0.5, 2), settings.cell_y = uniform(random, 0.5, 2);
  return HeightField::own(std::move(samples), cols, rows, settings);
}

TEST(MaxMipFan, HitsWhereTheScalarMarchDoesOverLargerGroundOnEveryInstructionSet) {
  Random random(92);
  const std::vector<std::int64_t> sets = instruction_sets();
  for (int round = 0; round < 3 * kRounds; ++round) {
    const int cols = whole(random, 60, 700), rows = whole(random, 60, 500);
    const double roughness = round % 3 == 0 ? 0 : std::exp2(uniform(random, -4, 5));
    const HeightFieldSettings settings{.scale = round % 2 ? 1.0 : 0.03125,
                                       .offset = round % 2 ? 0.0 : 100.0,
                                       .surface = round % 3 == 2 ? Surface::triangles : Surface::bilinear};
    const HeightField field = round % 3 == 0
                                  ? terrain<float>(random, cols, rows, round % 2 ? 0 : 8848, roughness, settings)
                              : round % 3 == 1 ? terrain<std::int16_t>(random, cols, rows, 0, roughness, settings)
                                               : terrain<std::uint16_t>(random, cols, rows, 500, roughness, settings);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    for_some_fans(target, random, 4 * kFansPerField, [&](const Rays& rays, const std::string& what) {
      for (const std::int64_t set : sets) {
        const InstructionSet only(set);
        check(target, rays, what + ", " + hwy::TargetName(set));
      }
      check(target, rays, what + ", no jumps", {.jumps = false});
    });
    if (HasFatalFailure()) return;
  }
}

// Waves that end at the seams as they begin, of both kinds of wrap.
template <class T>
HeightField wrapped(Random& random, int cols, int rows, double rough, double hole_share, HeightFieldSettings settings) {
  settings.wrap = whole(random, 0, 1) ? Wrap::periodic : Wrap::shared_border;
  settings.surface = whole(random, 0, 1) ? Surface::triangles : Surface::bilinear;
  settings.cell_x = uniform(random, 0.5, 2), settings.cell_y = uniform(random, 0.5, 2);
  if (hole_share > 0) settings.nodata = 7;
  const int shared = settings.wrap == Wrap::shared_border;
  const double across = 2 * kPi / (cols - shared), down = 2 * kPi / (rows - shared);
  const double wide = whole(random, 1, 3);
  std::vector<T> samples(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  const auto at = [&](int col, int row) -> T& { return samples[static_cast<std::size_t>(row * cols + col)]; };
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double z = 40 * std::sin(wide * across * col) * std::cos(down * row) + 9 * std::sin(7 * across * col) +
                       rough * uniform(random, 0, 1);
      at(col, row) = uniform(random, 0, 1) < hole_share ? T(7) : static_cast<T>(200 + z);
      if (shared && col == cols - 1) at(col, row) = at(0, row);
      if (shared && row == rows - 1) at(col, row) = at(col, 0);
    }
  }
  return HeightField::own(std::move(samples), cols, rows, settings);
}

TEST(MaxMipFan, HitsWhereTheScalarMarchDoesOverWrappedGroundOnEveryInstructionSet) {
  Random random(95);
  const std::vector<std::int64_t> sets = instruction_sets();
  for (int round = 0; round < 6 * kRounds; ++round) {
    const int most = round % 3 == 0 ? 20 : round % 3 == 1 ? 90 : 700;
    const int cols = whole(random, 2, most), rows = whole(random, most == 700 ? 128 : 2, most);
    const double rough = std::exp2(uniform(random, -6, 4));
    const double hole_share = whole(random, 0, 3) ? 0 : uniform(random, 0, 0.05);
    const HeightFieldSettings settings{.scale = round % 2 ? 1.0 : 0.25};
    const HeightField field = round % 4 == 0   ? wrapped<std::int16_t>(random, cols, rows, rough, hole_share, settings)
                              : round % 4 == 1 ? wrapped<std::uint16_t>(random, cols, rows, rough, hole_share, settings)
                                               : wrapped<float>(random, cols, rows, rough, hole_share, settings);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    for_some_fans(target, random, kFansPerField, [&](const Rays& rays, const std::string& what) {
      for (const std::int64_t set : sets) {
        const InstructionSet only(set);
        check(target, rays, what + ", " + hwy::TargetName(set));
      }
      check(target, rays, what + ", no jumps", {.jumps = false});
    });
    if (HasFatalFailure()) return;
  }
}

// Spikes on a plane, in several copies: rays to the plane behind and beside them, then to the spikes.
TEST(MaxMipFan, InheritsNothingAcrossSpikesOfOtherCopies) {
  Random random(97);
  for (int i = 0; i < 20 * kFansPerField; ++i) {
    const int cols = whole(random, 20, 90), rows = whole(random, 20, 90);
    std::vector<float> samples(static_cast<std::size_t>(cols * rows));
    std::vector<dvec2> spikes;
    for (int k = 0; k < 6; ++k) {
      const int col = whole(random, 0, cols - 1), row = whole(random, 0, rows - 1);
      samples[static_cast<std::size_t>(row * cols + col)] = static_cast<float>(uniform(random, 5, 30));
      spikes.emplace_back(col, rows - 1 - row);
    }
    const HeightField field = HeightField::own(std::move(samples), cols, rows, {.wrap = Wrap::periodic});
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    const dvec2 eye(uniform(random, 0, 1) * field.width(), uniform(random, 0, 1) * field.depth());
    Rays rays({eye.x, eye.y, uniform(random, 31, 60)}, 16, 24, true);
    const dvec2 copy(whole(random, -3, 3) * field.width(), whole(random, -3, 3) * field.depth());
    for (int c = 0; c < rays.columns; ++c) {
      const dvec2 spike = spikes[static_cast<std::size_t>(whole(random, 0, 5))] + copy;
      const dvec2 way = normalize(spike - eye), side(way.y, -way.x);
      std::vector<dvec3> column;
      for (int r = 0; r < rays.rows; ++r) {
        const bool behind = r % 3 != 0;
        const double aside = behind ? (r % 2 ? 1 : -1) * uniform(random, 1, 4) : 0;
        const dvec2 at = spike + (behind ? uniform(random, 1, 20) : 0) * way + aside * side;
        const double height = *field.height(spike.x, spike.y);
        column.push_back(dvec3(at, behind ? -0.01 : uniform(random, 0.1, 0.9) * height) - rays.origin);
      }
      std::sort(column.begin(), column.end(),
                [](const dvec3& a, const dvec3& b) { return a.z / std::hypot(a.x, a.y) < b.z / std::hypot(b.x, b.y); });
      for (int r = 0; r < rays.rows; ++r) rays.put(c, r, column[static_cast<std::size_t>(r)]);
    }
    rays.t_max = 2;
    check(target, rays, "fan " + std::to_string(i));
    if (HasFatalFailure()) return;
  }
}

// Rays that do not end are exhausted, as in march_max_mip(), and so are those that go farther than cells can be
// counted.
TEST(MaxMipFan, LongRaysOverWrappedGroundAreExhausted) {
  Random random(96);
  const HeightField field = wrapped<float>(random, 150, 140, 1, 0, {});
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  for (const double t_max : {1e3, 1e6, 1e12, 1e20, std::numeric_limits<double>::infinity()}) {
    Rays rays({3, 4, field.max_height() + 5}, 20, 20, true);
    for (int c = 0; c < rays.columns; ++c) {
      for (int r = 0; r < rays.rows; ++r) rays.put(c, r, direction_to(0.3 + 0.02 * c, -0.01 * r - 0.001));
    }
    rays.t_max = t_max;
    check(target, rays, "t_max " + std::to_string(t_max));
    // Sights of shorter rays.
    std::vector<FanSight> sights(rays.dx.size()), seen;
    std::vector<Ray> longer;
    FanOptions always;
    always.always = true;
    rays.t_max = 1e3;
    look_max_mip_fan(target, rays.fan(), sights.data(), 0, rays.columns, always);
    for (int i = 0; i < rays.columns * rays.rows; ++i) {
      const std::size_t at = rays.at(i % rays.columns, i / rays.columns);
      seen.push_back(sights[at]), longer.push_back(rays.ray(at)), longer.back().t_max = t_max;
    }
    std::vector<Hit> hits(longer.size());
    closest_hits_max_mip_seen(target, longer, seen, hits);
    for (std::size_t i = 0; i < hits.size(); ++i) EXPECT_TRUE(hits[i] == march_max_mip(target, longer[i])) << t_max;
  }
}

// Over a plane, at which blocks are bounded best, to places on it beside a side of the field: lower rays have left the
// field where higher ones come down.
TEST(MaxMipFan, InheritsNothingFromRaysBeyondTheSides) {
  Random random(94);
  for (int i = 0; i < 40 * kFansPerField; ++i) {
    const int cols = whole(random, 20, 90), rows = whole(random, 20, 90);
    const double along_x = uniform(random, -0.6, 0.6), along_y = uniform(random, -0.6, 0.6);
    std::vector<float> samples;
    for (int k = 0; k < cols * rows; ++k)
      samples.push_back(static_cast<float>(along_x * (k % cols) + along_y * (k / cols)));
    const HeightField field = HeightField::own(std::move(samples), cols, rows);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    const double x = uniform(random, 0.05, 0.95) * field.width(), y = uniform(random, 0.05, 0.95) * field.depth();
    Rays rays({x, y, *field.height(x, y) + std::exp2(uniform(random, 0, 7))}, 16, 24, true);
    for (int c = 0; c < rays.columns; ++c) {
      const bool side = whole(random, 0, 1);
      const dvec2 to = side ? dvec2(whole(random, 0, 1) * field.width(), whole(random, 1, rows - 2))
                            : dvec2(whole(random, 1, cols - 2), whole(random, 0, 1) * field.depth());
      std::vector<dvec3> column;
      for (int r = 0; r < rays.rows; ++r) {
        const double beside = r % 3 ? uniform(random, -1, 1) : 0;
        dvec3 at(to.x + (side ? 0 : beside), to.y + (side ? beside : 0), 0);
        at.z = *field.height(at.x, at.y) - (r % 2 ? std::exp2(uniform(random, -12, 0)) : 0);
        column.push_back(at - rays.origin);
      }
      std::sort(column.begin(), column.end(),
                [](const dvec3& a, const dvec3& b) { return a.z / std::hypot(a.x, a.y) < b.z / std::hypot(b.x, b.y); });
      for (int r = 0; r < rays.rows; ++r) rays.put(c, r, column[static_cast<std::size_t>(r)]);
    }
    check(target, rays, "fan " + std::to_string(i));
    if (HasFatalFailure()) return;
  }
}

// Most rays of a usual camera and scanner are decided by floats.
TEST(MaxMipFan, UsualFansLeaveFewRays) {
  Random random(93);
  for (const bool wraps : {false, true}) {
    const HeightField field =
        wraps ? wrapped<float>(random, 513, 513, 0.5, 0, {}) : terrain<float>(random, 513, 513, 0, 0.5, {});
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    const double x = 0.5 * field.width(), y = 0.5 * field.depth();
    Rays rays({x, y, *field.height(x, y) + 2}, 256, 128, true);
    for (int c = 0; c < rays.columns; ++c) {
      for (int r = 0; r < rays.rows; ++r)
        rays.put(c, r, direction_to(2 * kPi * c / rays.columns, 0.2 - 0.6 * r / rays.rows));
    }
    if (wraps) rays.t_max = 5 * field.width();
    take_fan_stats();
    check(target, rays, "scanner");
    const FanStats stats = take_fan_stats();
    // Once for hits, once for sights.
    EXPECT_EQ(stats.rays, 2 * static_cast<std::uint64_t>(rays.columns) * static_cast<std::uint64_t>(rays.rows));
    EXPECT_LT(stats.resumed + stats.from_start, stats.rays / 100) << wraps;
  }
}

// From above all ground a column crosses as many lines whatever its number of rows: a batch is faster with few.
TEST(MaxMipFan, FewRowsFromAboveGoToTheBatch) {
  constexpr int kSide = 1025;
  std::vector<float> samples;
  for (int i = 0; i < kSide * kSide; ++i)
    samples.push_back(8 * std::sin(0.05f * static_cast<float>(i % kSide)) *
                      std::cos(0.04f * static_cast<float>(i / kSide)));
  const HeightField field = HeightField::own(samples, kSide, kSide);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const double above = field.max_height() + 0.1 * field.width();
  const auto strips = [&](int rows, double highest, double lowest) {
    Rays rays({0, 0.5 * field.depth(), above}, 32, rows, true);
    for (int c = 0; c < rays.columns; ++c) {
      for (int r = 0; r < rows; ++r)
        rays.put(c, r, direction_to(1.2 + 0.02 * c, highest + (lowest - highest) * r / (rows - 1)));
    }
    const std::size_t count = rays.dx.size();
    std::vector<float> t(count), u(count), v(count);
    std::vector<std::int32_t> col(count), row(count);
    take_fan_stats();
    closest_hits_max_mip_fan(target, rays.fan(), {t.data(), col.data(), row.data(), u.data(), v.data()});
    return take_fan_stats().strips;
  };
  EXPECT_EQ(strips(32, 0, -0.5), 0u);
  EXPECT_GT(strips(128, 0, -0.5), 0u);
  // Less ground.
  EXPECT_GT(strips(32, -0.4, -0.5), 0u);
}

// A rolled camera that looks down from 2 cells above a slope: its rays inherit over gentle ground only.
std::uint64_t lines_of_rolled_camera(float slope, float spike) {
  constexpr int kSide = 257;
  std::vector<float> samples;
  for (int i = 0; i < kSide * kSide; ++i) samples.push_back(slope * static_cast<float>(i % kSide + i / kSide % 3));
  // In view, behind the ground that ends the rays; and a pit that lies lower than all rays get.
  samples[static_cast<std::size_t>(128 * kSide + 200)] += spike;
  samples[0] -= 1000;
  const HeightField field = HeightField::own(samples, kSide, kSide);
  const MaxPyramid pyramid(field);
  const dvec3 eye(128.5, 128.5, *field.height(128.5, 128.5) + 2);
  const dvec3 forward = direction_to(0.5 * kPi, -0.5), level(0, -1, 0), over = cross(level, forward);
  const dvec3 right = std::cos(0.3) * level + std::sin(0.3) * over, up = cross(right, forward);
  Rays rays(eye, 32, 240, true);
  for (int c = 0; c < rays.columns; ++c) {
    for (int r = 0; r < rays.rows; ++r) rays.put(c, r, forward + 0.002 * (c - 16.0) * right + 0.002 * (120.0 - r) * up);
  }
  std::vector<FanSight> sights(rays.dx.size());
  take_fan_stats();
  look_max_mip_fan({&field, &pyramid}, rays.fan(), sights.data(), 0, rays.columns);
  return take_fan_stats().lines;
}

// Steep ground breaks the links of a rolled camera's columns; steep ground that no ray reaches does not.
TEST(MaxMipFan, SteepGroundIsLeftToTheBatchWhereRaysReachIt) {
  EXPECT_GT(lines_of_rolled_camera(0.01f, 0), 0u);
  EXPECT_GT(lines_of_rolled_camera(0.01f, 500), 0u);
  EXPECT_EQ(lines_of_rolled_camera(20, 0), 0u);
}

}  // namespace
}  // namespace scarp::test
