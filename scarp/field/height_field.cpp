// SPDX-License-Identifier: MIT
#include "scarp/field/height_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/base/prefetch.h"

namespace scarp {
namespace {

void require_setting(bool good, std::string_view what, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("height field: {} is {} (must be {})", what, value, range));
}

// Maximum height and length of a field, in metres; its units are at least the reciprocal. Products of three such
// numbers, as in normals and distances, stay within doubles (2^1023). Checked by settings and sample type, not by
// samples, so that edits cannot exceed it.
constexpr double kFarthest = 0x1p300;

// The largest possible magnitude of a sample.
double largest_sample(SampleType type) {
  switch (type) {
    case SampleType::int16:
      return -double{std::numeric_limits<std::int16_t>::lowest()};
    case SampleType::uint16:
      return std::numeric_limits<std::uint16_t>::max();
    case SampleType::float32:
      break;
  }
  return std::numeric_limits<float>::max();
}

void require_reach(SampleType type, int cols, int rows, const HeightFieldSettings& s) {
  const auto within = [](double unit, double most) { return unit >= 1 / kFarthest && most <= kFarthest; };
  const double cell = std::min(s.cell_x, s.cell_y), longest = std::max(s.cell_x * cols, s.cell_y * rows);
  if (!within(cell, longest)) {
    throw Error(fmt::format(
        "height field: {} x {} samples with cells of {:g} x {:g} m (cells must be at least 2^-300 m, sides at "
        "most 2^300 m)",
        cols, rows, s.cell_x, s.cell_y));
  }
  if (!within(s.scale * s.exaggeration, (largest_sample(type) * s.scale + std::abs(s.offset)) * s.exaggeration)) {
    throw Error(fmt::format(
        "height field: heights are (sample * {:g} + {:g}) * {:g} (for {} samples they must stay below 2^300 m and "
        "differ by at least 2^-300 m)",
        s.scale, s.offset, s.exaggeration, name_of(type)));
  }
}

// A nodata value that the sample type cannot represent marks nothing: no stored sample equals it.
template <class T>
bool representable(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return true;
    return std::abs(value) <= std::numeric_limits<T>::max() && (value == 0 || static_cast<T>(value) != 0);
  } else {
    return value >= std::numeric_limits<T>::lowest() && value <= std::numeric_limits<T>::max() &&
           value == std::floor(value);
  }
}

template <class T>
constexpr SampleType type_of() {
  if constexpr (std::is_same_v<T, std::int16_t>) return SampleType::int16;
  if constexpr (std::is_same_v<T, std::uint16_t>) return SampleType::uint16;
  return SampleType::float32;
}

double between(double a, double b, double f) { return a + f * (b - a); }

// Checks rows in memory, `stride` samples apart; a negative stride starts at the last row in memory.
void require_rows(const void* samples, int cols, int rows, std::ptrdiff_t stride) {
  if (!samples) throw Error("height field: the pointer to the samples is null");
  if (rows > 1 && std::abs(stride) < cols) {
    throw Error(fmt::format(
        "height field: rows of {} samples are {} samples apart and overlap (the stride counts samples, not bytes)",
        cols, stride));
  }
}

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
                         const HeightFieldSettings& settings, std::shared_ptr<void> owner)
    : type_(type), data_(data), cols_(cols), rows_(rows), row_stride_(row_stride), settings_(settings) {
  if (cols < 1 || rows < 1)
    throw Error(fmt::format("height field: {} x {} samples (at least 1 x 1 required)", cols, rows));
  require_rows(data, cols, rows, row_stride);
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  require_setting(positive(settings.cell_x), "cell_x", settings.cell_x, "finite and above 0");
  require_setting(positive(settings.cell_y), "cell_y", settings.cell_y, "finite and above 0");
  require_setting(positive(settings.scale), "scale", settings.scale, "finite and above 0");
  require_setting(std::isfinite(settings.offset), "offset", settings.offset, "finite");
  require_setting(positive(settings.exaggeration), "exaggeration", settings.exaggeration, "finite and above 0");
  require_reach(type, cols, rows, settings);
  per_cell_x_ = 1 / settings.cell_x;
  per_cell_y_ = 1 / settings.cell_y;
  z_offset_ = settings.offset * settings.exaggeration;
  per_scale_ = 1 / (settings.scale * settings.exaggeration);

  may_have_holes_ = type == SampleType::float32;
  if (may_have_holes_) nodata_ = std::numeric_limits<double>::quiet_NaN();
  visit_unknown([&](auto grid) {
    using T = std::remove_cvref_t<decltype(grid.data[0])>;
    if (settings.nodata && representable<T>(*settings.nodata)) {
      nodata_ = *settings.nodata;
      may_have_holes_ = true;
    }
  });
  state_ = visit_unknown([&](const auto& grid) {
    return std::make_shared<State>(State{std::move(owner), TileExtents(grid)});
  });
  visit_unknown(
      [&](const auto& grid) { require_shared_border(grid, [&](int col, int row) { return grid.at(col, row); }); });
}

template <class T>
HeightField HeightField::view(const T* samples, int cols, int rows, const HeightFieldSettings& settings,
                              std::ptrdiff_t row_stride, std::weak_ptr<const void> memory) {
  HeightField field(type_of<T>(), samples, cols, rows, row_stride == 0 ? cols : row_stride, settings, nullptr);
  // A weak_ptr that never had an owner, destroyed or not, is equivalent to an empty one.
  const std::weak_ptr<const void> none;
  if (memory.owner_before(none) || none.owner_before(memory)) field.state_->memory = std::move(memory);
  return field;
}

template <class T>
HeightField HeightField::own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings) {
  if (std::int64_t{cols} * rows != static_cast<std::int64_t>(samples.size())) {
    throw Error(fmt::format("height field: {} samples given for {} x {}", samples.size(), cols, rows));
  }
  auto owner = std::make_shared<std::vector<T>>(std::move(samples));
  const T* data = owner->data();
  return HeightField(type_of<T>(), data, cols, rows, cols, settings, std::move(owner));
}

void HeightField::require_inside(const SampleRect& rect) const {
  if (rect.cols < 1 || rect.rows < 1 || rect.col < 0 || rect.row < 0 || rect.cols > cols_ - rect.col ||
      rect.rows > rows_ - rect.row) {
    throw Error(
        fmt::format("height field: rectangle of {} x {} samples at column {}, row {} is not inside the {} x {} samples",
                    rect.cols, rect.rows, rect.col, rect.row, cols_, rows_));
  }
}

template <class T, class Sample>
void HeightField::require_shared_border(const SampleGrid<T>& grid, const Sample& sample) const {
  if (settings_.wrap != Wrap::shared_border) return;
  const auto require_same = [&](int col, int row, int other_col, int other_row) {
    const T a = sample(col, row), b = sample(other_col, other_row);
    if (a == b || (grid.is_nodata(a) && grid.is_nodata(b))) return;
    throw Error(fmt::format(
        "height field: the border is not shared: the sample at column {}, row {} is {}, at column {}, row {} {} "
        "(both must be equal, or the field periodic without a shared border)",
        col, row, a, other_col, other_row, b));
  };
  for (int row = 0; row < rows_; ++row) require_same(0, row, cols_ - 1, row);
  for (int col = 0; col < cols_; ++col) require_same(col, 0, col, rows_ - 1);
}

CellBox HeightField::cells_of(const SampleRect& rect) const {
  const int first = settings_.wrap == Wrap::none ? 0 : -1;
  // With a shared border the first sample is also the last; the rectangle must contain both, otherwise they would
  // differ.
  return {std::max(rect.col - 1, first), std::max(rect.row - 1, first), std::min(rect.col + rect.cols, cell_cols()),
          std::min(rect.row + rect.rows, cell_rows())};
}

CellBox HeightField::samples_changed(const SampleRect& rect) {
  require_inside(rect);
  state_->edits.add();  // the caller's memory changed, whether or not the new samples are accepted
  visit_unknown([&](const auto& grid) {
    refuse_infinite(grid, rect);
    require_shared_border(grid, [&](int col, int row) { return grid.at(col, row); });
    state_->extents.update(grid, rect);
  });
  return cells_of(rect);
}

template <class T>
CellBox HeightField::set_samples(const SampleRect& rect, const T* samples, std::ptrdiff_t stride) {
  require_inside(rect);
  if (type_of<T>() != type_) {
    throw Error(fmt::format("height field: samples of type {} given for a field of type {}", name_of(type_of<T>()),
                            name_of(type_)));
  }
  if (!state_->owner) {
    throw Error("height field: the samples are caller-owned (change them there, then call samples_changed())");
  }
  // All checks precede the first write.
  require_rows(samples, rect.cols, rect.rows, stride);
  const SampleGrid<T> grid = this->grid<T>(may_have_holes_);
  SampleGrid<T> edit = grid;
  edit.data = samples;
  edit.row_stride = stride;
  refuse_infinite(edit, {0, 0, rect.cols, rect.rows});
  require_shared_border(grid, [&](int col, int row) {
    const int c = col - rect.col, r = row - rect.row;
    return c >= 0 && c < rect.cols && r >= 0 && r < rect.rows ? edit.at(c, r) : grid.at(col, row);
  });
  T* to = static_cast<T*>(const_cast<void*>(data_));
  for (int row = 0; row < rect.rows; ++row) {
    std::copy_n(samples + row * stride, rect.cols, to + (rect.row + row) * row_stride_ + rect.col);
  }
  state_->extents.update(grid, rect);
  state_->edits.add();
  return cells_of(rect);
}

#define SCARP_INSTANTIATE(T)                                                                                \
  template HeightField HeightField::view<T>(const T*, int, int, const HeightFieldSettings&, std::ptrdiff_t, \
                                            std::weak_ptr<const void>);                                     \
  template HeightField HeightField::own<T>(std::vector<T>, int, int, const HeightFieldSettings&);           \
  template CellBox HeightField::set_samples<T>(const SampleRect&, const T*, std::ptrdiff_t);
SCARP_INSTANTIATE(std::int16_t)
SCARP_INSTANTIATE(std::uint16_t)
SCARP_INSTANTIATE(float)
#undef SCARP_INSTANTIATE

std::optional<HeightField::Place> HeightField::place(double x, double y) const {
  if (!has_cells()) return {};
  double col = col_from_x(x), row = row_from_y(y);
  const int cols = cell_cols(), rows = cell_rows();
  if (col >= 0 && row >= 0 && col < cols && row < rows && nodata_count() == 0) {
    const Cell cell{static_cast<int>(col), static_cast<int>(row)};
    return Place{cell, col - cell.col, row - cell.row};
  }
  if (wraps()) {
    col -= std::floor(col / cols) * cols;
    row -= std::floor(row / rows) * rows;
  }
  // NaN and infinity count as outside; positions within rounding of the border count as on it.
  const auto inside = [](double position, int cells) {
    if (position >= 0 && position <= cells) return true;
    if (std::isinf(position)) return false;
    const double off = rounding_of_line(position, cells);
    return position >= -off && position <= cells + off;
  };
  if (!(inside(col, cols) && inside(row, rows))) return {};
  col = std::clamp(col, 0.0, static_cast<double>(cols)), row = std::clamp(row, 0.0, static_cast<double>(rows));
  const Cell cell{std::min(static_cast<int>(col), cols - 1), std::min(static_cast<int>(row), rows - 1)};
  return ground_at({cell, col - cell.col, row - cell.row});
}

HeightField::Place HeightField::ground_at(const Place& place) const {
  if (nodata_count() == 0 || cell_heights(place.cell)) return place;
  const int cols = cell_cols(), rows = cell_rows();
  const double off_u = rounding_of_line(place.cell.col + place.u, cols),
               off_v = rounding_of_line(place.cell.row + place.v, rows);
  // Whether a step, -1, 0 or 1, leads to a cell that also has this position on its rim.
  const auto reaches = [](int step, double at, double off) {
    return step < 0 ? at <= off : step > 0 ? at >= 1 - off : true;
  };
  const auto stepped = [&](int cell, int step, int cells) {
    return wraps() ? (cell + step + cells) % cells : cell + step;
  };
  for (const auto& [east, south] : {std::pair(-1, 0), {0, -1}, {-1, -1}, {1, 0}, {0, 1}, {1, -1}, {-1, 1}, {1, 1}}) {
    if (!reaches(east, place.u, off_u) || !reaches(south, place.v, off_v)) continue;
    const Cell cell{stepped(place.cell.col, east, cols), stepped(place.cell.row, south, rows)};
    if (cell.col < 0 || cell.row < 0 || cell.col >= cols || cell.row >= rows || !cell_heights(cell)) continue;
    const auto beside = [](int step, double at) { return step < 0 ? 1.0 : step > 0 ? 0.0 : at; };
    return {cell, beside(east, place.u), beside(south, place.v)};
  }
  return place;
}

bool HeightField::has_ground() const {
  if (!has_cells() || all_nodata()) return false;
  return visit([](const auto& grid) {
    for (int row = 0; row < grid.cell_rows; ++row) {
      for (int col = 0; col < grid.cell_cols; ++col) {
        if (!grid.is_hole(col, row)) return true;
      }
    }
    return false;
  });
}

std::optional<CellHeights> HeightField::cell_heights(Cell cell) const {
  return visit([&](const auto& grid) -> std::optional<CellHeights> {
    if (grid.is_hole(cell.col, cell.row)) return {};
    return grid.cell(cell.col, cell.row);
  });
}

std::optional<double> HeightField::height(double x, double y) const {
  // The common case with one decision about the sample type: inside a field without holes that does not wrap.
  const double col = x * per_cell_x_, row = (rows_ - 1) - y * per_cell_y_;
  const int cols = cols_ - 1, rows = rows_ - 1;
  if (col >= 0 && row >= 0 && col < cols && row < rows && settings_.wrap == Wrap::none && nodata_count() == 0) {
    const int c = static_cast<int>(col), r = static_cast<int>(row);
    return visit_as(false, [&](const auto& grid) {
      return height_from_sample(height_in_cell(settings_.surface, grid.cell(c, r), col - c, row - r));
    });
  }
  const auto at = place(x, y);
  if (!at) return {};
  const auto h = cell_heights(at->cell);
  if (!h) return {};
  return height_from_sample(height_in_cell(settings_.surface, *h, at->u, at->v));
}

dvec2 HeightField::gradient(Cell cell, double u, double v) const {
  const CellHeights h = nodata_count() > 0
                            ? cell_heights(cell).value()
                            : visit_as(false, [&](const auto& grid) { return grid.cell(cell.col, cell.row); });
  const double metres = settings_.scale * settings_.exaggeration;
  // With triangles, the slope is that of one of the cell's two triangles.
  const bool south_east = u + v > 1;
  const bool flat = settings_.surface == Surface::triangles;
  const double along_row = between(h.h10 - h.h00, h.h11 - h.h01, flat ? south_east : v);
  const double along_col = between(h.h01 - h.h00, h.h11 - h.h10, flat ? south_east : u);
  // Rows run southwards: the slope northwards is the negative slope along increasing rows.
  return {along_row * metres * per_cell_x_, -along_col * metres * per_cell_y_};
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

// shading_normal(), with the same operations, for the common case that all neighbours exist.
template <class T>
dvec3 HeightField::shading_normal_inside(const SampleGrid<T>& grid, Cell cell, double u, double v) const {
  const T* rows[4];
  for (int i = 0; i < 4; ++i) rows[i] = grid.row(cell.row - 1 + i) + (cell.col - 1);
  const auto half = [](T behind, T ahead) { return (static_cast<double>(ahead) - static_cast<double>(behind)) / 2; };
  dvec2 sum(0.0);
  for (int dr = 0; dr < 2; ++dr) {
    for (int dc = 0; dc < 2; ++dc) {
      const double weight = (dc ? u : 1 - u) * (dr ? v : 1 - v);
      sum.x += weight * half(rows[dr + 1][dc], rows[dr + 1][dc + 2]);
      sum.y += weight * half(rows[dr][dc + 1], rows[dr + 2][dc + 1]);
    }
  }
  return normal_of_slopes(sum);
}

// Slopes are in sample units per cell, rows southwards.
dvec3 HeightField::normal_of_slopes(const dvec2& slopes) const {
  const double metres = settings_.scale * settings_.exaggeration;
  return normalize(dvec3(-slopes.x * metres * per_cell_x_, slopes.y * metres * per_cell_y_, 1.0));
}

dvec3 HeightField::shading_normal(Cell cell, double u, double v) const {
  return visit([&](const auto& grid) {
    if (!grid.has_holes && cell.col > 0 && cell.col + 2 < cols_ && cell.row > 0 && cell.row + 2 < rows_) {
      return shading_normal_inside(grid, cell, u, v);
    }
    // Difference over the widest span of valid samples around a node, along one axis.
    const auto slope = [&](int col, int row, int dcol, int drow) {
      // Both sides of a shared border are one node: its outer neighbour is the second node of the other side.
      const auto wrapped = [&](int i, int samples, int cells) {
        return wraps() && (i < 0 || i >= samples) ? (i + cells) % cells : i;
      };
      const auto sample = [&](int steps) -> std::optional<double> {
        const int c = wrapped(col + steps * dcol, cols_, grid.cell_cols),
                  r = wrapped(row + steps * drow, rows_, grid.cell_rows);
        if (c < 0 || c >= cols_ || r < 0 || r >= rows_ || grid.is_nodata(grid.at(c, r))) return {};
        return static_cast<double>(grid.at(c, r));
      };
      const auto ahead = sample(1), behind = sample(-1), here = sample(0);
      if (!ahead && !behind) return 0.0;
      return ((ahead ? *ahead : *here) - (behind ? *behind : *here)) / (ahead && behind ? 2 : 1);
    };
    dvec2 sum(0.0);
    for (int dr = 0; dr < 2; ++dr) {
      for (int dc = 0; dc < 2; ++dc) {
        const double weight = (dc ? u : 1 - u) * (dr ? v : 1 - v);
        sum.x += weight * slope(cell.col + dc, cell.row + dr, 1, 0);
        sum.y += weight * slope(cell.col + dc, cell.row + dr, 0, 1);
      }
    }
    return normal_of_slopes(sum);
  });
}

void HeightField::prefetch_around(Cell cell) const {
  visit([&](const auto& grid) {
    for (int row = std::max(cell.row - 1, 0); row < std::min(cell.row + 3, rows_); ++row)
      prefetch(grid.row(row) + cell.col);
  });
}

}  // namespace scarp
