// SPDX-License-Identifier: MIT
#include "scarp/output/hit_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "scarp/base/csv_text.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/output/little_endian.h"
#include "scarp/output/npy_array.h"
#include "scarp/output/output_file.h"

namespace scarp {
namespace {

// Those of HitStatus, and of rays that were not traced.
constexpr std::array<std::string_view, 5> kStatusNames = {"miss", "hit", "below", "exhausted", "invalid"};
constexpr std::size_t kInvalid = kStatusNames.size() - 1;
constexpr std::array<std::string_view, 5> kKindNames = {"heights", "function", "shape", "voxels", "mesh"};
constexpr std::array<std::string_view, 7> kFaceNames = {"low_x", "high_x", "low_y", "high_y",
                                                        "low_z", "high_z", "inside"};
// Columns of hits. The columns of tables on one height field come first.
enum HitColumn : std::uint8_t {
  kRay,
  kStatus,
  kT,
  kX,
  kY,
  kZ,
  kCol,
  kRow,
  kU,
  kV,
  kNx,
  kNy,
  kNz,
  kWall,
  kObject,
  kKind,
  kMaterial,
  kTriangle,
  kPart,
  kVoxelX,
  kVoxelY,
  kVoxelZ,
  kFace,
  kColumns
};
constexpr std::size_t kHeightColumns = kWall + 1;
constexpr std::array<std::string_view, kColumns> kHitColumns = {
    "ray", "status", "t",      "x",    "y",        "z",        "col",  "row",     "u",       "v",       "nx",  "ny",
    "nz",  "wall",   "object", "kind", "material", "triangle", "part", "voxel_x", "voxel_y", "voxel_z", "face"};
constexpr std::array<std::string_view, 2> kBlockedColumns = {"ray", "blocked"};

std::span<const std::string_view> columns_of(TableKind kind) {
  if (kind == TableKind::scene_hits) return kHitColumns;
  if (kind == TableKind::hits) return std::span(kHitColumns).first(kHeightColumns);
  return kBlockedColumns;
}

// Returns the words for the values of a column of hits; empty for columns of numbers.
std::span<const std::string_view> words_of(std::size_t column) {
  if (column == kStatus) return kStatusNames;
  if (column == kKind) return kKindNames;
  if (column == kFace) return kFaceNames;
  return {};
}

std::string npy_header(std::span<const std::string_view> names, std::int64_t rows) {
  std::vector<NpyColumn> columns;
  for (const std::string_view name : names) columns.push_back({name});
  return npy_array_header(columns, rows);
}

bool is_npy(const std::string& path) {
  if (path.empty()) return false;
  const std::string extension = extension_of(path);
  if (extension == ".npy") return true;
  if (extension == ".csv") return false;
  throw Error(fmt::format("{}: tables are CSV or NumPy files (end the name in .csv or .npy)", path));
}

}  // namespace

std::string_view name_of(HitStatus status) { return kStatusNames[static_cast<std::size_t>(status)]; }

std::optional<HitKind> find_hit_kind(std::string_view name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) return {};
  return static_cast<HitKind>(found - kKindNames.begin());
}

HitTable::HitTable(const std::string& path, TableKind kind, const TextColumns& carried)
    : kind_(kind), carried_(carried), npy_(is_npy(path)) {
  const auto columns = columns_of(kind);
  for (const std::string& name : carried.names) {
    if (!npy_ && std::find(columns.begin(), columns.end(), name) != columns.end()) {
      throw Error(fmt::format("{}: column '{}' of the rays has the name of an output column (rename it)",
                              path.empty() ? "standard output" : path, name));
    }
  }
  file_ = std::make_unique<OutputFile>(path);
  put_header();
}

HitTable::~HitTable() = default;

void HitTable::put_header() {
  const auto columns = columns_of(kind_);
  if (npy_) return file_->add(npy_header(columns, rows_));
  std::string text;
  for (const std::string& name : carried_.names) {
    append_csv_text(text, name);
    text += ',';
  }
  file_->add(text + fmt::format("{}\n", fmt::join(columns, ",")));
}

void HitTable::put(std::int64_t ray, std::span<const double> numbers) {
  ++rows_;
  if (npy_) {
    for (const double number : numbers) append_little_endian(text_, number);
  } else {
    for (std::size_t i = 0; i < carried_.names.size(); ++i) {
      append_csv_text(text_, carried_.at(static_cast<std::size_t>(ray), i));
      text_ += ',';
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (i > 0) text_ += ',';
      if (std::isnan(numbers[i])) continue;
      const auto words = kind_ == TableKind::blocked ? std::span<const std::string_view>() : words_of(i);
      if (words.empty()) {
        fmt::format_to(std::back_inserter(text_), "{}", numbers[i]);
      } else {
        text_ += words[static_cast<std::size_t>(numbers[i])];
      }
    }
    text_ += '\n';
  }
  file_->add(text_);
  text_.clear();
}

void HitTable::add(std::span<const HitRow> rows) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const HitRow& row : rows) {
    const Hit& hit = row.hit;
    std::array<double, kHitColumns.size()> numbers;
    numbers.fill(kNone);
    numbers[kRay] = static_cast<double>(row.ray);
    numbers[kStatus] = static_cast<double>(hit.status);
    if (hit.status == HitStatus::exhausted && std::isfinite(hit.t)) numbers[kT] = hit.t;
    if (hit) {
      const auto set = [&](HitColumn first, const dvec3& p) {
        for (int i = 0; i < 3; ++i) numbers[static_cast<std::size_t>(first + i)] = p[i];
      };
      numbers[kT] = hit.t;
      set(kX, row.position);
      set(kNx, row.normal);
      numbers[kObject] = hit.object;
      numbers[kKind] = static_cast<double>(row.kind);
      if (row.material) numbers[kMaterial] = *row.material;
      switch (row.kind) {
        case HitKind::heights:
          numbers[kCol] = hit.cell.col, numbers[kRow] = hit.cell.row;
          numbers[kU] = hit.u, numbers[kV] = hit.v;
          numbers[kWall] = hit.wall ? 1.0 : 0.0;
          break;
        case HitKind::mesh:
          numbers[kTriangle] = hit.cell.col;
          numbers[kU] = hit.u, numbers[kV] = hit.v;
          break;
        case HitKind::voxels:
          numbers[kPart] = hit.part;
          set(kVoxelX, dvec3(hit.voxel));
          numbers[kFace] = static_cast<double>(hit.face);
          break;
        case HitKind::function:
        case HitKind::shape:
          break;
      }
    }
    put(row.ray, std::span<const double>(numbers).first(columns_of(kind_).size()));
  }
}

void HitTable::add(std::int64_t first_ray, std::span<const std::uint8_t> blocked) {
  for (const std::uint8_t answer : blocked) {
    put(first_ray, std::array{static_cast<double>(first_ray), static_cast<double>(answer)});
    ++first_ray;
  }
}

void HitTable::add_invalid(std::int64_t ray) {
  std::array<double, kHitColumns.size()> numbers;
  numbers.fill(std::numeric_limits<double>::quiet_NaN());
  numbers[kRay] = static_cast<double>(ray);
  if (kind_ != TableKind::blocked) numbers[kStatus] = static_cast<double>(kInvalid);
  put(ray, std::span<const double>(numbers).first(columns_of(kind_).size()));
}

void HitTable::commit() { file_->commit(npy_ ? npy_header(columns_of(kind_), rows_) : std::string()); }

}  // namespace scarp
