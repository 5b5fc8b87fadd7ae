// SPDX-License-Identifier: MIT
#include "scarp/output/point_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/output/output_file.h"
#include "scarp/output/point_format.h"

namespace scarp {
namespace {

constexpr std::size_t kPointsPerText = 4096;

std::unique_ptr<PointFormat> format_of(PointKind kind, const LasSettings& las) {
  switch (kind) {
    case PointKind::npy:
      return npy_points();
    case PointKind::ply:
      return ply_points();
    case PointKind::las:
      return las_points(las);
    case PointKind::csv:
      break;
  }
  return csv_points();
}

}  // namespace

PointKind point_kind_of(const std::string& path) {
  const std::string extension = extension_of(path);
  if (path.empty() || extension == ".csv") return PointKind::csv;
  if (extension == ".npy") return PointKind::npy;
  if (extension == ".ply") return PointKind::ply;
  if (extension == ".las") return PointKind::las;
  throw Error(fmt::format(
      "{}: points of a scanner are CSV, NumPy, PLY or LAS files (end the name in .csv, .npy, .ply or .las)", path));
}

void require_hit(const ScanPoint& point) {
  if (!point.hit) throw Error("misses have no position (write them to .csv or .npy)");
}

PointFile::PointFile(const std::string& path, const LasSettings& las)
    : format_(format_of(point_kind_of(path), las)), file_(std::make_unique<OutputFile>(path)) {
  file_->add(format_->header(summary_));
}

PointFile::~PointFile() = default;

void PointFile::add(std::span<const ScanPoint> points) {
  std::vector<std::string> texts((points.size() + kPointsPerText - 1) / kPointsPerText);
  try {
    parallel_for(static_cast<std::int64_t>(texts.size()), 1, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        const std::size_t first = i * kPointsPerText;
        for (const ScanPoint& point : points.subspan(first, std::min(kPointsPerText, points.size() - first)))
          format_->append(texts[i], point);
      }
    });
  } catch (const Error& error) {
    file_->refuse(error.what());
  }
  for (const std::string& text : texts) file_->add(text);
  for (const ScanPoint& point : points) {
    ++summary_.count;
    if (!point.hit) continue;
    summary_.low = min(summary_.low, point.position), summary_.high = max(summary_.high, point.position);
  }
}

void PointFile::commit() { file_->commit(format_->header(summary_)); }

}  // namespace scarp
