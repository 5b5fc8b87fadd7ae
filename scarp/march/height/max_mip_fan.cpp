// SPDX-License-Identifier: MIT
#include "scarp/march/height/max_mip_fan.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "scarp/base/kept_memory.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_fan_walk.h"
#include "scarp/march/height/max_mip_resume.h"
#include "scarp/march/height/max_mip_simd.h"
#include "scarp/march/height/wall.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

using max_mip::FanRest;

constexpr std::size_t kBatch = 4096;

// From above all ground, where rays are far from the ground until they hit, the batch is as fast with fewer rows than
// this; and anywhere with fewer columns than this, which leave most lanes empty. Measured (doc/dev/decisions/march.md).
constexpr int kFewRows = 24, kFewColumns = 5;
// Lines of the grid that take a column as long as a batch takes for one ray. Over wrapped ground, walks go farther:
// strips are wider there, and from below the highest ground most lines are skipped.
constexpr double kLinesPerRow = 32, kWrappedLinesPerRow = 10, kLowLinesPerRow = 75;

// About the number of lines that a column with these ends crosses over ground that may be as high as its rays.
double lines_of(const HeightField& field, const Fan& fan, const dvec3& a, const dvec3& b) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const double z = fan.origin.z, cell = std::min(field.settings().cell_x, field.settings().cell_y);
  double begin = kFar, end = 0, reach = 0;
  for (const dvec3& d : {a, b}) {
    const double flat = std::hypot(d.x, d.y), fall = -d.z / flat;
    begin = std::min(begin, fall > 0 ? std::max(z - field.max_height(), 0.0) / fall : kFar);
    end = std::max(end, fall > 0 ? (z - field.min_height()) / fall : kFar);
    reach = std::max(reach, fan.t_max * flat);
  }
  if (!(begin < end)) return 0;
  if (!field.wraps()) return std::min(end - begin, std::hypot(field.width(), field.depth())) / cell;
  // Without a side, the walk ends with the rays, or where few come down.
  if (z > field.max_height()) {
    const double over = z - 0.5 * (field.max_height() + field.min_height());
    const double step = std::abs(a.z / std::hypot(a.x, a.y) - b.z / std::hypot(b.x, b.y)) / fan.rows;
    reach = std::min(reach, std::sqrt(static_cast<double>(max_mip::kFarthestGap) * cell * over / step));
  }
  return std::max(std::min(end, reach) - begin, 0.0) / cell;
}

// `first`, `last`: directions at opposite corners of these columns.
bool pays(const HeightField& field, const Fan& fan, int columns, const dvec3& first, const dvec3& last) {
  if (columns < kFewColumns) return false;
  const bool low = fan.origin.z <= field.max_height();
  if (low && !field.wraps()) return true;
  if (!low && fan.rows < kFewRows) return false;
  const double per_row = !field.wraps() ? kLinesPerRow : low ? kLowLinesPerRow : kWrappedLinesPerRow;
  return fan.rows * per_row >= lines_of(field, fan, first, last);
}

dvec3 direction_of(const Fan& fan, std::ptrdiff_t i) {
  return {static_cast<double>(fan.dx[i]), static_cast<double>(fan.dy[i]), static_cast<double>(fan.dz[i])};
}

thread_local FanStats t_stats;

Ray ray_of(const Fan& fan, std::ptrdiff_t i) {
  Ray ray;
  ray.origin = fan.origin;
  ray.direction = direction_of(fan, i);
  ray.t_min = fan.t_min, ray.t_max = fan.t_max;
  return ray;
}

void put_normal(const FanHits& to, std::ptrdiff_t i, const dvec3& normal) {
  to.nx[i] = static_cast<float>(normal.x), to.ny[i] = static_cast<float>(normal.y);
  to.nz[i] = static_cast<float>(normal.z);
}

// Normals of the hits of some columns, which no wall has.
void put_normals(const HeightField& field, const Fan& fan, const FanHits& to, int column_begin, int column_end) {
  for (int row = 0; row < fan.rows; ++row) {
    for (int column = column_begin; column < column_end; ++column) {
      const std::ptrdiff_t i = max_mip::place_of(fan, column, row);
      const auto normal = [&] {
        return field.normal({to.col[i], to.row[i]}, static_cast<double>(to.u[i]), static_cast<double>(to.v[i]));
      };
      put_normal(to, i, to.col[i] < 0 ? dvec3(0.0) : normal());
    }
  }
}

void put(const HeightField& field, const Ray& ray, const FanHits& to, std::ptrdiff_t i, const Hit& hit) {
  using Float = std::numeric_limits<float>;
  to.t[i] = hit ? static_cast<float>(std::min(hit.t, static_cast<double>(Float::max()))) : Float::infinity();
  to.col[i] = hit ? hit.cell.col : -1, to.row[i] = hit ? hit.cell.row : -1;
  to.u[i] = hit ? static_cast<float>(hit.u) : 0, to.v[i] = hit ? static_cast<float>(hit.v) : 0;
  if (to.status) to.status[i] = hit.status;
  if (!to.nx) return;
  const auto normal = [&] { return hit.wall ? wall_normal(ray, hit) : field.normal(hit.cell, hit.u, hit.v); };
  put_normal(to, i, hit ? normal() : dvec3(0.0));
}

// Answers rays of which nothing is known, many at once.
class Batch {
 public:
  Batch(const HeightTarget& target, const Fan& fan, const FanHits& hits) : target_(target), fan_(fan), to_(hits) {}

  void add(std::ptrdiff_t i) {
    const Ray ray = ray_of(fan_, i);
    if (!is_followable(ray)) return put(*target_.field, ray, to_, i, {});
    rays_.push_back(ray), places_.push_back(i);
    if (rays_.size() == kBatch) answer();
  }
  void answer() {
    hits_.resize(rays_.size());
    closest_hits_max_mip_simd(target_, rays_, hits_);
    for (std::size_t i = 0; i < rays_.size(); ++i) put(*target_.field, rays_[i], to_, places_[i], hits_[i]);
    rays_.clear(), places_.clear();
  }

 private:
  const HeightTarget& target_;
  const Fan& fan_;
  const FanHits& to_;
  KeptVector<Ray> rays_;
  KeptVector<std::ptrdiff_t> places_;
  KeptVector<Hit> hits_;
};

// Sides that a cell's 16-bit numbers reach, and from how far away a walk over the field makes sense.
constexpr int kMostCells = 1 << 16;
constexpr double kFarthest = 0x1p16;
// The cell of the origin and its neighbours are whole, or the origin is beside the field by more than a cell: steep
// rays cross no rim at once.
bool is_beside_no_hole(const HeightField& field, const dvec3& at) {
  const auto beside = [](double place, int cells) { return std::max(-place, place - cells); };
  const double off = std::max(beside(at.x, field.cell_cols()), beside(at.y, field.cell_rows()));
  if (!field.wraps() && off > 0) return off > 1;
  return !max_mip::any_cell_beside(field, {static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y))},
                                   [&](const Cell& cell) { return !field.cell_heights(cell); });
}

// In cells; in heights of the field.
constexpr double kOnBorder = 0x1p-20, kAboveBorder = 0x1p-12;

}  // namespace

bool max_mip::walks_fan(const HeightTarget& target, const Fan& fan) {
  const HeightField& field = *target.field;
  if (!field.has_cells() || field.all_nodata()) return false;
  if (field.cell_cols() > kMostCells || field.cell_rows() > kMostCells) return false;
  if (!(fan.t_min >= 0) || !std::isfinite(fan.t_min) || !(fan.t_max >= fan.t_min)) return false;
  if (field.wraps() && std::isinf(fan.t_max)) return false;
  Ray ray;
  ray.origin = fan.origin;
  const dvec3 at = field.grid_from_world(ray).origin;
  const auto near = [](double place, int cells) { return place > -kFarthest && place < cells + kFarthest; };
  if (!near(at.x, field.cell_cols()) || !near(at.y, field.cell_rows()) || !std::isfinite(at.z)) return false;
  if (field.nodata_count() > 0 && !is_beside_no_hole(field, at)) return false;
  const double relief = field.max_sample() - field.min_sample();
  const double tallest = std::max({std::abs(at.z), std::abs(field.min_sample()), std::abs(field.max_sample())});
  if (!(tallest < 0x1p60) || !(relief < 0x1p60)) return false;
  const auto ground = field.height(fan.origin.x, fan.origin.y);
  if (ground && !(fan.origin.z > *ground)) return false;
  if (field.wraps()) return true;
  // On the border rays may touch a rim before or behind the field, unless they are well above it.
  const auto on_border = [](double place, int cells) {
    return std::min(std::abs(place), std::abs(place - cells)) < kOnBorder;
  };
  const bool beside = on_border(at.x, field.cell_cols()) || on_border(at.y, field.cell_rows());
  const double rim = ground.value_or(field.max_height()), tall = field.max_height() - field.min_height();
  return !beside || fan.origin.z - rim > kAboveBorder * tall;
}

void closest_hits_max_mip_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int column_begin,
                              int column_end, const FanOptions& options) {
  require(target, HeightPart::pyramid);
  if (column_begin >= column_end || fan.rows <= 0) return;
  Batch batch(target, fan, hits);
  const bool walks = options.always || pays(*target.field, fan, column_end - column_begin,
                                            direction_of(fan, max_mip::place_of(fan, column_begin, 0)),
                                            direction_of(fan, max_mip::place_of(fan, column_end - 1, fan.rows - 1)));
  if (!walks || !max_mip::walks_fan(target, fan)) {
    for (int row = 0; row < fan.rows; ++row) {
      for (int column = column_begin; column < column_end; ++column) batch.add(max_mip::place_of(fan, column, row));
    }
    return batch.answer();
  }
  std::vector<FanRest> rest;
  max_mip::walk_fan(target, fan, hits, column_begin, column_end, options, rest, t_stats);
  if (hits.nx) put_normals(*target.field, fan, hits, column_begin, column_end);
  for (const FanRest& one : rest) {
    // Over holes the side of a ray depends on the rims that it has crossed.
    if (one.t_clear > 0 && target.field->nodata_count() == 0) {
      ++t_stats.resumed;
      const Ray ray = ray_of(fan, one.ray);
      put(*target.field, ray, hits, one.ray, resume_max_mip(target, ray, one.t_clear));
    } else {
      ++t_stats.from_start;
      batch.add(one.ray);
    }
  }
  batch.answer();
}

void closest_hits_max_mip_fan(const HeightTarget& target, const Fan& fan, const FanHits& hits, int column_begin,
                              int column_end) {
  closest_hits_max_mip_fan(target, fan, hits, column_begin, column_end, {});
}

bool looks_by_fan(const HeightTarget& target, const Fan& fan, const dvec3& first, const dvec3& last) {
  require(target, HeightPart::pyramid);
  return pays(*target.field, fan, fan.columns, first, last) && max_mip::walks_fan(target, fan);
}

void look_max_mip_fan(const HeightTarget& target, const Fan& fan, FanSight* sights, int column_begin, int column_end,
                      const FanOptions& options) {
  require(target, HeightPart::pyramid);
  if (column_begin >= column_end || fan.rows <= 0) return;
  if (max_mip::walks_fan(target, fan))
    return max_mip::look_fan(target, fan, sights, column_begin, column_end, options, t_stats);
  for (int row = 0; row < fan.rows; ++row) {
    for (int column = column_begin; column < column_end; ++column)
      sights[max_mip::place_of(fan, column, row)] = {-std::numeric_limits<float>::infinity(), 0};
  }
}

void look_max_mip_fan(const HeightTarget& target, const Fan& fan, FanSight* sights, int column_begin, int column_end) {
  look_max_mip_fan(target, fan, sights, column_begin, column_end, {});
}

void closest_hits_max_mip_seen(const HeightTarget& target, std::span<const Ray> rays, std::span<const FanSight> sights,
                               std::span<Hit> hits) {
  require(target, HeightPart::pyramid);
  const HeightField& field = *target.field;
  const auto unseen = [](const FanSight& sight) { return sight.clear == -std::numeric_limits<float>::infinity(); };
  if (std::all_of(sights.begin(), sights.end(), unseen)) return closest_hits_max_mip_simd(target, rays, hits);
  max_mip::answer_seen(target, rays, sights, hits);
  KeptVector<Ray> unknown;
  KeptVector<std::size_t> places;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float clear = sights[i].clear;
    const bool open = clear < 0 && clear > -std::numeric_limits<float>::infinity();
    const double t_clear = open ? max_mip::clear_time(field, rays[i], sights[i]) : 0;
    if (field.wraps() && !max_mip::countable(field.grid_from_world(rays[i]), rays[i])) {
      unknown.push_back(rays[i]), places.push_back(i);
    } else if (clear == std::numeric_limits<float>::infinity() || t_clear > rays[i].t_max) {
      hits[i] = {};
    } else if (open && field.nodata_count() == 0) {
      hits[i] = resume_max_mip(target, rays[i], t_clear);
    } else if (!(clear >= 0)) {
      unknown.push_back(rays[i]), places.push_back(i);
    }
  }
  t_stats.from_start += unknown.size();
  if (unknown.empty()) return;
  KeptVector<Hit> answers(unknown.size());
  closest_hits_max_mip_simd(target, unknown, answers);
  for (std::size_t i = 0; i < places.size(); ++i) hits[places[i]] = answers[i];
}

FanStats take_fan_stats() { return std::exchange(t_stats, {}); }

}  // namespace scarp
