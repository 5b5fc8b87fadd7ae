// SPDX-License-Identifier: MIT
#include "scarp/field/height_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <mutex>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr std::int64_t kRowsPerPiece = 64;

void require(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("height field: {} is {}; it must be {}", what, value, range));
}

// A nodata value that the sample type cannot hold marks nothing: no stored sample can be equal to it.
template <class T>
bool representable(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return !std::isfinite(value) || std::abs(value) <= std::numeric_limits<T>::max();
  } else {
    return value >= std::numeric_limits<T>::lowest() && value <= std::numeric_limits<T>::max() &&
           value == std::floor(value);
  }
}

struct Extent {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::int64_t nodata = 0;
};

// One pass over all samples: range, holes, and the refusal of infinities.
template <class T>
Extent scan(const SampleGrid<T>& grid) {
  Extent whole;
  std::mutex merging;
  parallel_for(grid.rows, kRowsPerPiece, [&](std::int64_t begin, std::int64_t end) {
    Extent piece;
    for (int row = static_cast<int>(begin); row < end; ++row) {
      const T* samples = grid.row(row);
      T low = std::numeric_limits<T>::max(), high = std::numeric_limits<T>::lowest();
      for (int col = 0; col < grid.cols; ++col) {
        const T sample = samples[col];
        if (grid.is_nodata(sample)) {
          ++piece.nodata;
          continue;
        }
        if constexpr (std::is_floating_point_v<T>) {
          if (std::isinf(sample)) {
            throw Error(fmt::format(
                "height field: the sample at column {}, row {} is infinite; mark such samples as nodata", col, row));
          }
        }
        low = std::min(low, sample);
        high = std::max(high, sample);
      }
      if (low <= high) {
        piece.min = std::min(piece.min, static_cast<double>(low));
        piece.max = std::max(piece.max, static_cast<double>(high));
      }
    }
    const std::scoped_lock lock(merging);
    whole.min = std::min(whole.min, piece.min);
    whole.max = std::max(whole.max, piece.max);
    whole.nodata += piece.nodata;
  });
  return whole;
}

template <class T>
constexpr SampleType type_of() {
  if constexpr (std::is_same_v<T, std::int16_t>) return SampleType::int16;
  if constexpr (std::is_same_v<T, std::uint16_t>) return SampleType::uint16;
  return SampleType::float32;
}

double lerp(double a, double b, double f) { return a + f * (b - a); }

}  // namespace

std::string_view name_of(SampleType type) {
  switch (type) {
    case SampleType::int16:
      return "int16";
    case SampleType::uint16:
      return "uint16";
    case SampleType::float32:
      break;
  }
  return "float32";
}

HeightField::HeightField(SampleType type, const void* data, int cols, int rows, std::ptrdiff_t row_stride,
                         const HeightFieldSettings& settings, std::shared_ptr<const void> owner)
    : type_(type),
      data_(data),
      owner_(std::move(owner)),
      cols_(cols),
      rows_(rows),
      row_stride_(row_stride),
      settings_(settings) {
  if (cols < 1 || rows < 1)
    throw Error(fmt::format("height field: {} x {} samples; at least 1 x 1 are needed", cols, rows));
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  require(positive(settings.cell_x), "cell_x", settings.cell_x, "finite and above 0");
  require(positive(settings.cell_y), "cell_y", settings.cell_y, "finite and above 0");
  require(positive(settings.scale), "scale", settings.scale, "finite and above 0");
  require(std::isfinite(settings.offset), "offset", settings.offset, "finite");
  require(positive(settings.exaggeration), "exaggeration", settings.exaggeration, "finite and above 0");
  per_cell_x_ = 1 / settings.cell_x;
  per_cell_y_ = 1 / settings.cell_y;
  z_offset_ = settings.offset * settings.exaggeration;
  per_scale_ = 1 / (settings.scale * settings.exaggeration);

  // With nodata_count_ above 0 the scan looks for nodata; afterwards it is the true count.
  nodata_count_ = 1;
  const Extent extent = visit([&](auto grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    grid.has_holes = std::is_floating_point_v<T>;
    if constexpr (std::is_floating_point_v<T>) nodata_ = std::numeric_limits<double>::quiet_NaN();
    if (settings.nodata && representable<T>(*settings.nodata)) {
      nodata_ = *settings.nodata;
      grid.has_holes = true;
    }
    grid.nodata = static_cast<T>(nodata_);
    return scan(grid);
  });
  nodata_count_ = extent.nodata;
  min_sample_ = extent.min;
  max_sample_ = extent.max;
}

template <class T>
HeightField HeightField::view(const T* samples, int cols, int rows, std::ptrdiff_t row_stride,
                              const HeightFieldSettings& settings) {
  return HeightField(type_of<T>(), samples, cols, rows, row_stride, settings, nullptr);
}

template <class T>
HeightField HeightField::own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings) {
  if (std::int64_t{cols} * rows != static_cast<std::int64_t>(samples.size())) {
    throw Error(fmt::format("height field: {} samples given for {} x {}", samples.size(), cols, rows));
  }
  auto owner = std::make_shared<const std::vector<T>>(std::move(samples));
  const T* data = owner->data();
  return HeightField(type_of<T>(), data, cols, rows, cols, settings, std::move(owner));
}

#define SCARP_INSTANTIATE(T)                                                                                 \
  template HeightField HeightField::view<T>(const T*, int, int, std::ptrdiff_t, const HeightFieldSettings&); \
  template HeightField HeightField::own<T>(std::vector<T>, int, int, const HeightFieldSettings&);
SCARP_INSTANTIATE(std::int16_t)
SCARP_INSTANTIATE(std::uint16_t)
SCARP_INSTANTIATE(float)
#undef SCARP_INSTANTIATE

std::optional<HeightField::Place> HeightField::place(double x, double y) const {
  if (!has_cells()) return {};
  const double col = x * per_cell_x_, row = (rows_ - 1) - y * per_cell_y_;
  // Written so that NaN is outside.
  if (!(col >= 0 && col <= cols_ - 1 && row >= 0 && row <= rows_ - 1)) return {};
  const Cell cell{std::min(static_cast<int>(col), cols_ - 2), std::min(static_cast<int>(row), rows_ - 2)};
  return Place{cell, col - cell.col, row - cell.row};
}

std::optional<CellHeights> HeightField::cell_heights(Cell cell) const {
  return visit([&](const auto& grid) -> std::optional<CellHeights> {
    if (grid.is_hole(cell.col, cell.row)) return {};
    const auto* north = grid.row(cell.row) + cell.col;
    const auto* south = grid.row(cell.row + 1) + cell.col;
    return CellHeights{static_cast<double>(north[0]), static_cast<double>(north[1]), static_cast<double>(south[0]),
                       static_cast<double>(south[1])};
  });
}

std::optional<double> HeightField::height(double x, double y) const {
  const auto at = place(x, y);
  if (!at) return {};
  const auto h = cell_heights(at->cell);
  if (!h) return {};
  return height_from_sample(lerp(lerp(h->h00, h->h10, at->u), lerp(h->h01, h->h11, at->u), at->v));
}

dvec2 HeightField::gradient(Cell cell, double u, double v) const {
  const CellHeights h = cell_heights(cell).value();
  const double metres = settings_.scale * settings_.exaggeration;
  // Rows count southwards: the slope to the north is the negative of the one along rows.
  return {lerp(h.h10 - h.h00, h.h11 - h.h01, v) * metres * per_cell_x_,
          -lerp(h.h01 - h.h00, h.h11 - h.h10, u) * metres * per_cell_y_};
}

std::optional<dvec2> HeightField::gradient(double x, double y) const {
  const auto at = place(x, y);
  if (!at || !cell_heights(at->cell)) return {};
  return gradient(at->cell, at->u, at->v);
}

dvec3 HeightField::normal(Cell cell, double u, double v) const {
  const dvec2 slope = gradient(cell, u, v);
  return normalize(dvec3(-slope.x, -slope.y, 1.0));
}

dvec3 HeightField::shading_normal(Cell cell, double u, double v) const {
  const double metres = settings_.scale * settings_.exaggeration;
  return visit([&](const auto& grid) {
    // Difference over the widest span of valid samples around a node, along one axis.
    const auto slope = [&](int col, int row, int dcol, int drow) {
      const auto valid = [&](int c, int r) {
        return c >= 0 && c < cols_ && r >= 0 && r < rows_ && !grid.is_nodata(grid.at(c, r));
      };
      const int ahead = valid(col + dcol, row + drow) ? 1 : 0, behind = valid(col - dcol, row - drow) ? 1 : 0;
      if (ahead + behind == 0) return 0.0;
      return (static_cast<double>(grid.at(col + ahead * dcol, row + ahead * drow)) -
              static_cast<double>(grid.at(col - behind * dcol, row - behind * drow))) /
             (ahead + behind);
    };
    dvec2 sum(0.0);
    for (int dr = 0; dr < 2; ++dr) {
      for (int dc = 0; dc < 2; ++dc) {
        const double weight = (dc ? u : 1 - u) * (dr ? v : 1 - v);
        sum.x += weight * slope(cell.col + dc, cell.row + dr, 1, 0);
        sum.y += weight * slope(cell.col + dc, cell.row + dr, 0, 1);
      }
    }
    return normalize(dvec3(-sum.x * metres * per_cell_x_, sum.y * metres * per_cell_y_, 1.0));
  });
}

}  // namespace scarp
