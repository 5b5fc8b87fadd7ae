// SPDX-License-Identifier: MIT
#include "scarp/march/height/fan_batch.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "scarp/base/kept_memory.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/max_mip_fan.h"
#include "scarp/march/height/max_mip_fan_walk.h"
#include "scarp/march/height/max_mip_simd.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

constexpr std::size_t kStripColumns = kFanStrip;
constexpr std::size_t kLeastRun = 16;       // shorter ones are not looked for
constexpr std::size_t kRaysPerLook = 8192;  // of several strips, for the threads
constexpr std::int64_t kFanRaysPerPiece = 2048;
constexpr std::size_t kRaysPerGroup = 1 << 19;  // whose sights, 4 MiB, a thread keeps memory for
// Copying rays into a fan takes a third of the time of a batch, so it must save time for most of them: rays that are
// worth a walk, and that neither miss nor hit within a few cells, which batches answer at once.
constexpr double kLeastWalked = 0.75, kLeastFar = 0.25;
constexpr double kFarCells = 8;
// Sine of 85 degrees. Half of the rays of a camera that looks straight down inherit nothing from one another.
constexpr double kStraightDown = 0.996;
// Slopes of a scanner's row differ by less, relative: their directions may be floats, off by 3 roundings of 2^-24.
constexpr double kSameSlope = 0x1p-22;
// Longer ones would need more memory than a group of rays has.
constexpr std::size_t kLongestRun = kRaysPerGroup / kStripColumns;

// Directions as floats lose nothing that fans promise.
bool is_plain(const dvec3& d) {
  const double longest = longest_of(d);
  return longest > 0x1p-60 && longest < 0x1p60;
}

bool starts_at(const Ray& ray, const dvec3& origin) {
  return ray.origin == origin && ray.t_min == 0 && ray.start == RayStart::free;
}

double slope(const dvec3& d) { return d.z / std::hypot(d.x, d.y); }

// The number of rays up to the first jump back, as at the end of a row, or up to the first other slope after equal
// ones, as at the end of a scanner's turn; 0 if there is none.
std::size_t first_run(std::span<const Ray> rays) {
  const double level = slope(rays[0].direction);
  const auto is_level = [&](const dvec3& d) {
    return std::abs(slope(d) - level) <= kSameSlope * (1 + std::abs(level));
  };
  const bool turns = is_level(rays[1].direction);
  dvec3 step = rays[1].direction - rays[0].direction;
  for (std::size_t i = 2; i < rays.size(); ++i) {
    const dvec3 next = rays[i].direction - rays[i - 1].direction;
    if (dot(next, step) < 0 && dot(next, next) > 4 * dot(step, step)) return i;
    if (turns && !is_level(rays[i].direction)) return i;
    step = next;
  }
  return 0;
}

// Cells that a ray crosses up to a time, along its major axis.
double cells_to(const HeightField& field, const Ray& ray, double t) {
  const HeightField::GridScales scales = field.grid_scales();
  return t * std::max(std::abs(ray.direction.x) * scales.per_cell_x, std::abs(ray.direction.y) * scales.per_cell_y);
}

// Tries some strips of a fan, and rays in the middle of each.
bool is_worth_copying(const HeightTarget& target, const FanBatch& batch, const Fan& fan, std::span<const Ray> rays) {
  const int strips = std::clamp(fan.columns / 128, 1, 4), rows = std::clamp(fan.rows / 8, 4, 24);
  const int columns = std::min<int>(kStripColumns, fan.columns);
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  KeptVector<float> dx(count), dy(count), dz(count);
  KeptVector<Ray> some;
  double walked = 0;
  for (int strip = 0; strip < strips; ++strip) {
    const int left = (2 * strip + 1) * (fan.columns - columns) / (2 * strips);
    std::size_t at = 0;
    for (int i = 0; i < rows; ++i) {
      const auto row = static_cast<std::size_t>((2 * i + 1) * fan.rows / (2 * rows));
      for (int c = 0; c < columns; ++c, ++at) {
        const auto column = static_cast<std::size_t>(left + c);
        const Ray& ray = rays[batch.columns ? column * batch.run + row : row * batch.run + column];
        const dvec3 d = ray.direction;
        dx[at] = static_cast<float>(d.x), dy[at] = static_cast<float>(d.y), dz[at] = static_cast<float>(d.z);
        if (c == columns / 2) some.push_back(ray);
      }
    }
    Fan sample = fan;
    sample.dx = dx.data(), sample.dy = dy.data(), sample.dz = dz.data();
    sample.columns = columns, sample.rows = rows, sample.row_stride = columns;
    walked += max_mip::share_to_walk(target, sample);
  }
  if (walked < kLeastWalked * strips) return false;
  KeptVector<Hit> hits(some.size());
  closest_hits_max_mip_simd(target, some, hits);
  std::size_t far = 0;
  for (std::size_t i = 0; i < some.size(); ++i)
    far += hits[i] && cells_to(*target.field, some[i], hits[i].t) > kFarCells;
  return static_cast<double>(far) >= kLeastFar * static_cast<double>(some.size());
}

// The share of its length by which a step is vertical.
double rise(const dvec3& step) { return std::abs(step.z) / std::max(length(step), 0x1p-1000); }

}  // namespace

bool is_of_fan(const Ray& ray, const dvec3& origin) { return starts_at(ray, origin) && is_plain(ray.direction); }

std::optional<FanBatch> find_fan(std::span<const Ray> rays) {
  const std::size_t n = rays.size();
  if (n < kLeastRun * kLeastRun) return {};
  const dvec3& origin = rays[0].origin;
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, n / 2, n - 1}) {
    if (!is_of_fan(rays[i], origin)) return {};
  }
  FanBatch batch;
  batch.run = first_run(rays.first(std::min(n / 2, kLongestRun) + 1));
  if (batch.run < kLeastRun) return {};
  const dvec3& first = rays[0].direction;
  batch.columns = rise(rays[1].direction - first) > rise(rays[batch.run].direction - first);
  const std::size_t runs = n / batch.run;
  const dvec3& middle = rays[runs / 2 * batch.run + batch.run / 2].direction;
  if (std::abs(middle.z) > kStraightDown * length(middle)) return {};
  return batch;
}

std::optional<FanBatch> fan_batch(const HeightTarget& target, std::span<const Ray> rays, const FanOptions& options) {
  const std::optional<FanBatch> batch = find_fan(rays);
  if (!batch) return {};
  const std::size_t n = rays.size(), runs = n / batch->run;
  Fan fan;
  fan.origin = rays[0].origin;
  fan.t_max = std::max({rays[0].t_max, rays[1].t_max, rays[n / 2].t_max, rays[n - 1].t_max});
  fan.columns = static_cast<int>(batch->columns ? runs : batch->run);
  fan.rows = static_cast<int>(batch->columns ? batch->run : runs);
  if (!looks_by_fan(target, fan, rays[0].direction, rays[runs * batch->run - 1].direction)) return {};
  if (!options.always && !is_worth_copying(target, *batch, fan, rays)) return {};
  return batch;
}

namespace {

// Whole rows or columns. Rays take most of the memory: they are read in their own order, twice.
class FanGroup {
 public:
  FanGroup(const HeightTarget& target, const FanBatch& batch, std::span<const Ray> rays, std::span<Hit> hits)
      : target_(target),
        batch_(batch),
        rays_(rays),
        hits_(hits),
        rows_(batch.columns ? batch.run : rays.size() / batch.run),
        columns_(batch.columns ? rays.size() / batch.run : batch.run),
        strips_((columns_ + kStripColumns - 1) / kStripColumns),
        dx_(strips_ * rows_ * kStripColumns),
        dy_(dx_.size()),
        dz_(dx_.size()),
        sights_(dx_.size()) {}

  void answer() {
    const auto count = static_cast<std::int64_t>(rays_.size());
    std::atomic<bool> all = true;
    parallel_for(count, kFanRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
      if (!take(static_cast<std::size_t>(begin), static_cast<std::size_t>(end))) all = false;
    });
    if (all) {
      const auto grain = static_cast<std::int64_t>(std::max<std::size_t>(1, kRaysPerLook / (kStripColumns * rows_)));
      parallel_for(static_cast<std::int64_t>(strips_), grain, [&](std::int64_t begin, std::int64_t end) {
        look(static_cast<int>(begin) * static_cast<int>(kStripColumns),
             static_cast<int>(std::min(static_cast<std::size_t>(end) * kStripColumns, columns_)));
      });
    } else {
      std::fill(sights_.begin(), sights_.end(), FanSight{-std::numeric_limits<float>::infinity(), 0});
    }
    parallel_for(count, kFanRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
      const auto first = static_cast<std::size_t>(begin), size = static_cast<std::size_t>(end - begin);
      KeptVector<FanSight> seen(size);
      for_each_place(first, first + size,
                     [&](std::size_t ray, std::size_t place) { seen[ray - first] = sights_[place]; });
      closest_hits_max_mip_seen(target_, rays_.subspan(first, size), seen, hits_.subspan(first, size));
    });
  }

 private:
  // Calls body(ray, place) for each ray; place: where the fan has it.
  template <class Body>
  void for_each_place(std::size_t begin, std::size_t end, const Body& body) const {
    std::size_t run = begin / batch_.run, in_run = begin % batch_.run;
    for (std::size_t ray = begin; ray < end;) {
      const std::size_t stop = std::min(end, ray + batch_.run - in_run);
      if (batch_.columns) {
        std::size_t place = run / kStripColumns * rows_ * kStripColumns + run % kStripColumns + in_run * kStripColumns;
        for (; ray < stop; ++ray, place += kStripColumns) body(ray, place);
      } else {
        std::size_t lane = in_run % kStripColumns;
        std::size_t strip = (in_run / kStripColumns * rows_ + run) * kStripColumns;
        while (ray < stop) {
          for (; lane < kStripColumns && ray < stop; ++lane, ++ray) body(ray, strip + lane);
          lane = 0, strip += rows_ * kStripColumns;
        }
      }
      ++run, in_run = 0;
    }
  }
  // Returns false if a ray does not belong to this fan.
  bool take(std::size_t begin, std::size_t end) {
    const dvec3 origin = rays_[0].origin;
    bool all = true;
    double longest = 0;
    for_each_place(begin, end, [&](std::size_t i, std::size_t place) {
      const Ray& ray = rays_[i];
      const dvec3 d = ray.direction;
      all = all && is_of_fan(ray, origin);
      if (std::isfinite(ray.t_max)) longest = std::max(longest, ray.t_max);
      dx_[place] = static_cast<float>(d.x), dy_[place] = static_cast<float>(d.y), dz_[place] = static_cast<float>(d.z);
    });
    for (double known = t_max_; known < longest && !t_max_.compare_exchange_weak(known, longest);) {
    }
    return all;
  }
  void look(int column_begin, int column_end) {
    Fan fan;
    fan.origin = rays_[0].origin;
    fan.dx = dx_.data(), fan.dy = dy_.data(), fan.dz = dz_.data();
    fan.columns = static_cast<int>(columns_), fan.rows = static_cast<int>(rows_);
    fan.t_max = t_max_;
    fan.row_stride = kStripColumns, fan.strip_stride = static_cast<std::ptrdiff_t>(kStripColumns * rows_);
    look_max_mip_fan(target_, fan, sights_.data(), column_begin, column_end);
  }

  const HeightTarget& target_;
  const FanBatch& batch_;
  std::span<const Ray> rays_;
  std::span<Hit> hits_;
  std::size_t rows_, columns_, strips_;
  std::atomic<double> t_max_ = 0;   // of the longest ray that ends
  KeptVector<float> dx_, dy_, dz_;  // in strips of 16 columns
  KeptVector<FanSight> sights_;
};

}  // namespace

std::optional<FanBatch> fan_batch(const HeightTarget& target, std::span<const Ray> rays) {
  return fan_batch(target, rays, {});
}

void closest_hits_in_fan(const HeightTarget& target, const FanBatch& batch, std::span<const Ray> rays,
                         std::span<Hit> hits) {
  const std::size_t runs = rays.size() / batch.run;
  const std::size_t in_group = std::max<std::size_t>(kRaysPerGroup / batch.run, kStripColumns);
  for (std::size_t first = 0; first < runs; first += in_group) {
    const std::size_t from = first * batch.run, count = std::min(in_group, runs - first) * batch.run;
    FanGroup(target, batch, rays.subspan(from, count), hits.subspan(from, count)).answer();
  }
  // An incomplete row or column.
  closest_hits_max_mip_simd(target, rays.subspan(runs * batch.run), hits.subspan(runs * batch.run));
}

}  // namespace scarp
