// SPDX-License-Identifier: MIT
#include "scarp/scene/camera_batch.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// A picture with fewer than one ray per kMostPixelsPerRay pixels is not worth drawing, and the device has no room for
// more than kMostPixels.
constexpr std::uint64_t kMostPixelsPerRay = 4, kMostPixels = std::uint64_t{1} << 21;
constexpr std::int64_t kRaysPerPiece = 4096;
// Rounding of the rays' coordinates, relative to the largest one.
constexpr double kRounding = 0x1p-40;

struct PixelOf {
  std::int32_t col = -1, row = -1;
};

class Pixels {
 public:
  explicit Pixels(const VoxelPicture& picture) : picture_(picture) {
    const bool parallel = picture.parallel();
    to_pixels_ = inverse(glm::dmat3(parallel ? picture.origin_right : picture.right,
                                    parallel ? picture.origin_down : picture.down, picture.direction));
    off_ = kRounding * (1 + length(picture.origin));
  }

  /// For parallel rays, the maximum distance of their origins from those that the picture's form gives.
  double off() const { return off_; }

  PixelOf of(const Ray& ray) const {
    dvec3 at;
    if (picture_.parallel()) {
      if (ray.direction != picture_.direction) return {};
      at = to_pixels_ * (ray.origin - picture_.origin);
      if (std::abs(at.z) > off_) return {};
    } else {
      if (ray.origin != picture_.origin) return {};
      at = to_pixels_ * ray.direction;
      // t is no less than in the picture's form.
      if (!(at.z > 0 && at.z <= 1 + kRounding)) return {};
      at /= at.z;
    }
    if (!(at.x >= 0 && at.x < picture_.width && at.y >= 0 && at.y < picture_.height)) return {};
    return {static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y)};
  }

 private:
  const VoxelPicture& picture_;
  glm::dmat3 to_pixels_;
  double off_;
};

}  // namespace

std::optional<CameraBatch> camera_batch(const VoxelPicture& picture, std::span<const Ray> rays) {
  const Pixels pixels(picture);
  std::vector<PixelOf> cells(rays.size());
  parallel_for(static_cast<std::int64_t>(rays.size()), kRaysPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      cells[i] = pixels.of(rays[i]);
  });
  PixelOf low{static_cast<std::int32_t>(picture.width), static_cast<std::int32_t>(picture.height)}, high;
  std::uint64_t seen = 0;
  for (const PixelOf& cell : cells) {
    if (cell.col < 0) continue;
    ++seen;
    low = {std::min(low.col, cell.col), std::min(low.row, cell.row)};
    high = {std::max(high.col, cell.col), std::max(high.row, cell.row)};
  }
  if (seen == 0) return {};
  const auto width = static_cast<std::uint32_t>(high.col - low.col + 1),
             height = static_cast<std::uint32_t>(high.row - low.row + 1);
  const std::uint64_t area = std::uint64_t{width} * height;
  if (area > kMostPixels || area > kMostPixelsPerRay * seen) return {};
  CameraBatch batch{picture, std::vector<std::uint32_t>(area, CameraBatch::kNone), {}};
  batch.picture.width = width, batch.picture.height = height;
  batch.picture.direction += static_cast<double>(low.col) * picture.right + static_cast<double>(low.row) * picture.down;
  batch.picture.origin +=
      static_cast<double>(low.col) * picture.origin_right + static_cast<double>(low.row) * picture.origin_down;
  // t must be no less than in the form.
  if (picture.parallel()) batch.picture.origin += 2 * pixels.off() * picture.direction;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (cells[i].col >= 0) {
      std::uint32_t& ray = batch.ray[static_cast<std::size_t>(cells[i].row - low.row) * width +
                                     static_cast<std::size_t>(cells[i].col - low.col)];
      if (ray == CameraBatch::kNone) {
        ray = static_cast<std::uint32_t>(i);
        continue;
      }
    }
    batch.others.push_back(i);
  }
  return batch;
}

}  // namespace scarp
